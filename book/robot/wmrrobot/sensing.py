"""The model behind the filter: how the state moves on, what each sensor should read, and the noise.

The state is x, y, heading, gyro_bias [rad/s] and wheel_scale, the true speed over the one that the
wheels report. `wmrrobot.printing` prints these formulas and their derivatives.
"""

from __future__ import annotations

from typing import NamedTuple

from wmrlib.checks import checked
from wmrlib.compilation import formula
from wmrlib.elementary import direction, distance, sincos
from wmrlib.motion import euler_step


@checked("at_least_0", above_0=("gyro", "track_width"))
class Noise(NamedTuple):
    """The noise of wheels and gyro.

    Parameters
    ----------
    wheels : float, m. Standard deviation of a wheel's distance after 1 m; over d m, sqrt(d) times.
    gyro : float, rad/sqrt(s). White noise: standard deviation of the angle after 1 s.
    bias_walk : float, rad/s/sqrt(s). Standard deviation of the gyro bias's change in 1 s.
    scale_walk : float, 1/sqrt(s). Standard deviation of the wheel scale's change in 1 s.
    track_width : float, m. Distance between the wheels.
    max_speed : float, m/s. The wheels' top speed: a reading of half as much again is no speed.

    Raises
    ------
    ValueError : for a negative field, a gyro or track width of 0, or NaN.
    """

    wheels: float = 0.03
    gyro: float = 1e-3
    bias_walk: float = 1e-5
    scale_walk: float = 1e-5
    track_width: float = 0.5
    max_speed: float = 100.0


@formula
def moved(x, y, heading, speed, turn, dt):
    """A step along the heading at half time, which is second-order accurate."""
    return euler_step(x, y, heading + 0.5 * turn * dt, speed, 0.5 * turn, dt)


@formula
def speed_and_turn(gyro_bias, wheel_scale, v, omega, gyro, share):
    """The true twist; `share` weights the wheels' turning rate against the gyro's."""
    return wheel_scale * v, share * wheel_scale * omega + (1.0 - share) * (gyro - gyro_bias)


@formula
def gyro_reading(gyro_bias, wheel_scale, omega):
    """The reading of the gyro while the wheels roll without slip; at rest, its bias."""
    return gyro_bias + wheel_scale * omega


@formula
def wheel_noise(v, omega, track_width, noise):
    """Variance rates of the speed [m^2/s] and the turning rate [rad^2/s]; none at rest.

    Each wheel strays by `noise` [m] in the first metre, independently in the next.
    """
    rate = noise * noise * distance(v, 0.5 * track_width * omega)
    return 0.5 * rate, 2.0 * rate / (track_width * track_width)


@formula
def antenna(x, y, heading, ahead, left):
    """The position of an antenna `ahead` and `left` of the middle between the wheels [m]."""
    sine, cosine = sincos(heading)
    return x + ahead * cosine - left * sine, y + ahead * sine + left * cosine


@formula
def course(heading, v, omega, ahead, left):
    """The direction in which the antenna moves, from east; behind the robot if it reverses."""
    return heading + direction(omega * ahead, v - omega * left)
