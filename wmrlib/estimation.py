"""Where the robot is and where it faces, estimated from wheels, gyro, GNSS, compass and course.

An extended Kalman filter. Its model is `wmrlib.sensing`; its derivatives are printed from that by
sympy, here and in the C header ``wmr_filter.h``. Each function returns a new `Estimate`. A
measurement beyond its `gate`, a chi-square bound, changes nothing but `surprise`; an infinite gate
uses everything. A ValueError names a wrong type, a number that is not finite, or one out of range.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from wmrlib import sensing
from wmrlib._checks import checked, instance, scalar
from wmrlib._filter import carry, see_antenna, see_heading
from wmrlib.kinematics import Pose

GATE_1, GATE_2 = 10.83, 13.82
"""Chi-square bounds that 99.9 % of good measurements pass: of one number, of a position."""
DOUBTED = 100.0  # m


@checked(at_least_0=("wheels", "bias_walk", "scale_walk"), above_0=("gyro", "track_width"))
class Noise(NamedTuple):
    """How far wheels and gyro can be trusted.

    Parameters
    ----------
    wheels : float, m. Standard deviation of a wheel's distance after 1 m; over d m, sqrt(d) times.
    gyro : float, rad/sqrt(s). White noise: standard deviation of the angle after 1 s.
    bias_walk : float, rad/s/sqrt(s). How far the gyro's bias wanders in 1 s.
    scale_walk : float, 1/sqrt(s). How far the wheel scale wanders in 1 s.
    track_width : float, m. Distance between the wheels.

    Raises
    ------
    ValueError : for a negative field, a gyro or track width of 0, or NaN.
    """

    wheels: float = 0.03
    gyro: float = 1e-3
    bias_walk: float = 1e-5
    scale_walk: float = 1e-5
    track_width: float = 0.5


class Estimate(NamedTuple):
    """What the filter believes.

    state: x, y [m], heading [rad], gyro_bias [rad/s], wheel_scale; covariance: (5, 5); surprise:
    the last measurement's normalised innovation squared, which was used if within its gate.
    """

    state: np.ndarray
    covariance: np.ndarray
    surprise: float = 0.0

    @property
    def pose(self) -> Pose:
        """The pose, as the laws take it."""
        return Pose(*map(float, self.state[:3]))

    @property
    def sigma(self) -> np.ndarray:
        """The standard deviation of each entry of the state."""
        return np.sqrt(np.diag(self.covariance))


def start(
    pose: Pose,
    position_sigma: float,
    heading_sigma: float,
    bias_sigma: float = 0.02,
    scale_sigma: float = 0.03,
) -> Estimate:
    """Return the first estimate: a pose, no gyro bias, a wheel scale of 1.

    Parameters
    ----------
    pose : Pose of numbers
    position_sigma, heading_sigma, bias_sigma, scale_sigma : float; m, rad, rad/s, ratio. Standard
        deviations. An antenna off the middle does not tell where the middle is until the heading is
        known: allow for the arm. The filter is linear in the heading error: begin within 0.1 rad
        with an arm of 0.3 m, closer with a longer one, from a compass, a course or two antennas.

    Raises
    ------
    ValueError : for a sigma that is not positive, or a pose of arrays.

    Examples
    --------
    >>> import wmrlib as wmr
    >>> first = wmr.estimation.start(wmr.Pose(0.0, 0.0, 0.3), 2.0, 0.2)
    >>> first.sigma.tolist()
    [2.0, 2.0, 0.2, 0.02, 0.03]
    """
    fields = instance("pose", pose, Pose)._asdict()
    state = [scalar(name, value) for name, value in fields.items()]
    sigmas = {"position_sigma": position_sigma, "heading_sigma": heading_sigma}
    sigmas |= {"bias_sigma": bias_sigma, "scale_sigma": scale_sigma}
    position, *rest = (scalar(name, value, above=0.0) for name, value in sigmas.items())
    return Estimate(np.array([*state, 0.0, 1.0]), np.diag([position, position, *rest]) ** 2)


def predict(
    estimate: Estimate,
    v: float,
    omega: float,
    gyro: float,
    dt: float,
    noise: Noise,
    gate: float = GATE_1,
) -> Estimate:
    """Carry the estimate on for a step, by wheels and gyro.

    Their turning rates' difference measures the bias, at rest exactly the gyro's reading; then
    their mean, weighted by their noise, turns the robot. A difference beyond the gate is slip, and
    the gyro alone counts.

    Parameters
    ----------
    v, omega : float; m/s, rad/s. Twist of the wheels.
    gyro : float, rad/s, counter-clockwise; NaN if there is none.
    dt : float, s. Above 0.
    noise : Noise, of numbers

    Examples
    --------
    >>> import wmrlib as wmr
    >>> first = wmr.estimation.start(wmr.Pose(0.0, 0.0, 0.0), 0.02, 0.1)
    >>> rested = wmr.estimation.predict(first, 0.0, 0.0, 0.01, 10.0, wmr.estimation.Noise())
    >>> print(f"gyro bias {rested.state[3]:.3f} rad/s")
    gyro bias 0.010 rad/s
    """
    state, covariance = _parts(estimate)
    twist = scalar("v", v), scalar("omega", omega), scalar("gyro", gyro, nan=True)
    fields = instance("noise", noise, Noise)._asdict().items()
    values = tuple(scalar(name, value) for name, value in fields)
    step = scalar("dt", dt, above=0.0)
    surprise = carry(state, covariance, *twist, step, values, _gate(gate))
    return Estimate(state, covariance, surprise)


def use_position(
    estimate: Estimate,
    x: float,
    y: float,
    sigma: float,
    ahead: float = 0.0,
    left: float = 0.0,
    gate: float = GATE_2,
) -> Estimate:
    """Use the position of an antenna; off the middle of the wheels, it tells of the heading too.

    Parameters
    ----------
    x, y : float, m. East and north of the antenna, in the frame of the pose.
    sigma : float, m. Standard deviation of each.
    ahead, left : float, m. Where the antenna stands on the robot.

    Examples
    --------
    >>> import wmrlib as wmr
    >>> first = wmr.estimation.start(wmr.Pose(0.0, 0.0, 0.0), 1.0, 0.1)
    >>> wmr.estimation.use_position(first, 1.0, 0.0, 1.0).pose.x
    0.5
    """
    state, covariance = _parts(estimate)
    numbers = {"x": x, "y": y, "ahead": ahead, "left": left}
    fix = [scalar(name, value) for name, value in numbers.items()]
    sigma = scalar("sigma", sigma, above=0.0)
    return Estimate(state, covariance, see_antenna(state, covariance, *fix, sigma, _gate(gate)))


def use_heading(estimate: Estimate, heading: float, sigma: float, gate: float = GATE_1) -> Estimate:
    """Use a heading: a compass's, or a two-antenna receiver's less the baseline's angle on board.

    Parameters
    ----------
    heading : float, rad from east, counter-clockwise
    sigma : float, rad. Its standard deviation.

    Examples
    --------
    >>> import wmrlib as wmr
    >>> first = wmr.estimation.start(wmr.Pose(0.0, 0.0, 0.0), 1.0, 0.1)
    >>> wmr.estimation.use_heading(first, 0.1, 0.1).pose.heading
    0.05
    """
    state, covariance = _parts(estimate)
    value, sigma = scalar("heading", heading), scalar("sigma", sigma, above=0.0)
    return Estimate(state, covariance, see_heading(state, covariance, value, sigma, _gate(gate)))


def use_course(
    estimate: Estimate,
    course: float,
    sigma: float,
    v: float,
    omega: float,
    ahead: float = 0.0,
    left: float = 0.0,
    slowest: float = 0.3,
    gate: float = GATE_1,
) -> Estimate:
    """Use the antenna's course over ground, unless the antenna is slower than `slowest`.

    Parameters
    ----------
    course : float, rad from east, counter-clockwise
    sigma : float, rad. Its standard deviation, about that of the velocity over the speed.
    v, omega : float; m/s, rad/s. Twist of the wheels; v < 0 where the robot reverses.
    ahead, left : float, m. Where the antenna stands on the robot.
    slowest : float, m/s.

    Examples
    --------
    >>> import wmrlib as wmr
    >>> first = wmr.estimation.start(wmr.Pose(0.0, 0.0, 0.0), 1.0, 0.1)
    >>> back = wmr.estimation.use_course(first, 3.141592653589793, 0.1, v=-1.0, omega=0.0)
    >>> back.pose.heading  # it reverses to the west, so it faces east
    0.0
    """
    state, covariance = _parts(estimate)
    numbers = {"course": course, "v": v, "omega": omega, "ahead": ahead, "left": left}
    value, v, omega, ahead, left = (scalar(name, number) for name, number in numbers.items())
    sigma, slowest = scalar("sigma", sigma, above=0.0), scalar("slowest", slowest, low=0.0)
    bound = _gate(gate)
    if math.hypot(v - omega * left, omega * ahead) < slowest:
        return estimate
    side = sensing.course(0.0, v, omega, ahead, left)
    return Estimate(state, covariance, see_heading(state, covariance, value - side, sigma, bound))


def doubt(estimate: Estimate, factor: float) -> Estimate:
    """The same state, less certain: the covariance times a factor.

    A gate that has refused several measurements in a row may be refusing the truth, for a robot
    that was carried, or a first heading that was wrong. Multiply by 4, say, with each one that it
    refuses from then on, until one is used. A place that is uncertain by more than 100 m is not
    doubted further: what is refused then has no number, or another fault.

    Parameters
    ----------
    factor : float, no unit. At least 1.

    Examples
    --------
    >>> import wmrlib as wmr
    >>> first = wmr.estimation.start(wmr.Pose(0.0, 0.0, 0.0), 1.0, 0.1)
    >>> wmr.estimation.doubt(first, 4.0).sigma[:3].tolist()
    [2.0, 2.0, 0.2]
    """
    state, covariance = _parts(estimate)
    factor = scalar("factor", factor, low=1.0)
    if covariance[0, 0] + covariance[1, 1] > DOUBTED**2:
        factor = 1.0
    return Estimate(state, factor * covariance, estimate.surprise)


def _parts(estimate: Estimate) -> tuple[np.ndarray, np.ndarray]:
    """Copies, which the compiled functions change."""
    state, covariance, _ = instance("estimate", estimate, Estimate)
    return state.copy(), covariance.copy()


def _gate(gate: float) -> float:
    return math.inf if gate == math.inf else scalar("gate", gate, low=0.0)
