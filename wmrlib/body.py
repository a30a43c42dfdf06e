"""The robot's body: its two driven wheels, and the turn on the spot with which it may end a run.

The formulas compute one sampling period, in which the commanded twist is constant.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from wmrlib.checks import floats, instance, real, refusal, scalar
from wmrlib.compilation import formula
from wmrlib.elementary import between, expm1, signed, sincos, stepped, within, wrap
from wmrlib.motion import wheel_speeds
from wmrlib.records import record

_TINY = 1e-30  # added to a divisor that may be 0
_NO_LAG = 1e-15  # s, added to a lag, so that exp(-rest/lag) does not overflow for -1e-17/0
_AT_REST = 1e-3  # m/s: a slower wheel counts as standing
_AT_ONCE = 1e-9  # s: rounding error of a sum of sampling periods
_FASTEST = 1e9  # largest factor of `hurry`
_SLOWEST = 1e-12  # m/s: `hurry` leaves a far smaller speed as it is, for 0 cannot be scaled up


@record
class Wheels(NamedTuple):
    """Two driven wheels and the limits of their motors; the defaults are ideal wheels.

    Every speed is over ground. `sweep` takes arrays too.

    Parameters
    ----------
    track_width : float, m from wheel to wheel
    max_speed : float, m/s. The twist is scaled down so that no wheel is commanded to
        go faster, see `limit_wheels`.
    min_speed : float, m/s. The twist is scaled up until |v| is min_speed |cos(alpha)|: the path
        stays as it is, and the robot does not slow down until it stalls.
    acceleration : float, m/s^2. Largest change of a wheel's speed in a second.
    lag : float, s. Time constant with which a wheel follows its commanded speed.
    dead_band : float, m/s. A wheel stands while its commanded speed is below this.
    encoder_step : float, m. In each period a wheel moves by a whole number of these steps; the
        remainder is carried over to the next period.

    Raises
    ------
    ValueError : not here, but where the wheels are used, such as in `simulate`: a negative value, a
        track_width, max_speed or acceleration of 0, or a min_speed above max_speed

    Examples
    --------
    >>> import wmrlib as wmr
    >>> start, goal = wmr.Pose(0.0, 0.0, 0.0), wmr.Pose(5.0, 3.0, 0.0)
    >>> for wheels in None, wmr.Wheels(track_width=0.4, max_speed=0.5):
    ...     run = wmr.simulate(start, goal, wmr.GENTLE_GAINS, wheels=wheels)
    ...     print(f"{run.v.max():.2f} m/s at most, {run.t[-1]:.1f} s")
    2.55 m/s at most, 6.8 s
    0.50 m/s at most, 14.4 s
    """

    track_width: float
    max_speed: float = math.inf
    min_speed: float = 0.0
    acceleration: float = math.inf
    lag: float = 0.0
    dead_band: float = 0.0
    encoder_step: float = 0.0


@record
class LastTurn(NamedTuple):
    """A turn on the spot to the heading of the goal, once the robot is near enough.

    Within the arrival radius it stops, and turns at `gain` times the heading error, at least at
    `min_rate` and at most at `max_rate`, until the error is within `tolerance` and the wheels
    stand: then it has arrived. If it slips farther away than `leave` times the radius, it drives
    again; with an infinite `leave` it never does.

    Parameters
    ----------
    tolerance, gain, min_rate, max_rate, leave : float; rad, 1/s, rad/s, rad/s, no unit. With a
        gain of 2 a period or more the turn would swing for ever.
    settle : float, s. It has arrived once it has stayed within the tolerance for so long. A robot
        that sees its heading late needs as much, and the time in which its wheels stop.

    Raises
    ------
    ValueError : not here, but where it is used, such as in `simulate`: a value that is not positive
        (settle may be 0), a max_rate below min_rate, or one that swings with the step

    Examples
    --------
    >>> import math
    >>> import wmrlib as wmr
    >>> start, goal, gains, _ = wmr.paper.outdoor()
    >>> for turn in None, wmr.LastTurn():
    ...     run = wmr.simulate(start, goal, gains, last_turn=turn)
    ...     print(f"{run.t[-1]:.1f} s, {math.degrees(run.heading_error[-1]):.1f} deg off")
    15.6 s, -62.6 deg off
    17.4 s, -0.1 deg off
    """

    tolerance: float = 0.02
    gain: float = 2.0
    min_rate: float = 0.2
    max_rate: float = 1.0
    leave: float = 2.0
    settle: float = 0.0


NO_LIMITS = Wheels(1.0)
_MAY_BE_0 = ("min_speed", "lag", "dead_band", "encoder_step")
_MAY_BE_ENDLESS = ("max_speed", "acceleration")
NO_TURN = LastTurn(gain=0.0)


def checked_wheels(wheels: Wheels | None, name: str = "wheels") -> Wheels:
    """The wheels as floats, ideal ones for None; ValueError names the argument and its field."""
    if wheels is None:
        return NO_LIMITS
    checked = _sound(name, wheels, Wheels, dict.fromkeys(_MAY_BE_0, 0.0), _MAY_BE_ENDLESS)
    if checked.min_speed > checked.max_speed:
        most = f"at most max_speed, {checked.max_speed:g},"
        raise refusal(f"{name}.min_speed", checked.min_speed, most)
    return checked


def checked_wheels_of_many(wheels: Wheels | None) -> Wheels:
    """The wheels of a sweep, whose fields may be arrays; ValueError as `checked_wheels`."""
    if wheels is None or not any(map(_are_many, instance("wheels", wheels, Wheels))):
        return checked_wheels(wheels)
    fields: dict[str, Any] = {}
    for field, values in wheels._asdict().items():
        name, bound = f"wheels.{field}", {"low" if field in _MAY_BE_0 else "above": 0.0}
        endless, given = field in _MAY_BE_ENDLESS, floats(name, values, "a number")
        if given.ndim:
            real(name, given[given != math.inf] if endless else values, **bound)
            fields[field] = given
        else:
            fields[field] = scalar(name, values, endless=endless, **bound)
    checked = Wheels(**fields)
    if np.any(checked.min_speed > checked.max_speed):
        raise refusal("wheels.min_speed", wheels.min_speed, "at most max_speed")
    return checked


def _are_many(values: Any) -> bool:
    return isinstance(values, list | tuple) or np.ndim(values) > 0


def checked_turn(turn: LastTurn | None, dt: float, method: str, radius: float) -> LastTurn:
    """The last turn for steps of dt, `NO_TURN` for None; ValueError names what is not allowed."""
    if turn is None:
        return NO_TURN
    turn = sound_turn(turn, dt)
    if method == "continuous" or not radius:
        needed = "None, or method 'arc' or 'euler' with an arrival radius,"
        raise refusal("last_turn", turn, needed)
    if turn.min_rate * dt > 2.0 * turn.tolerance:  # it would swing to and fro for ever
        most = f"at most two tolerances a step, {2.0 * turn.tolerance / dt:g},"
        raise refusal("last_turn.min_rate", turn.min_rate, most)
    return turn


def sound_turn(turn: LastTurn, dt: float) -> LastTurn:
    """The last turn as floats; ValueError if its gain oscillates with a sampling period of dt."""
    turn = _sound("last_turn", turn, LastTurn, {"leave": 1.0, "settle": 0.0}, ("leave",))
    if turn.max_rate < turn.min_rate:
        raise refusal("last_turn.max_rate", turn.max_rate, f"at least min_rate, {turn.min_rate:g},")
    if turn.gain * dt >= 2.0 and turn.max_rate * dt > 2.0 * turn.tolerance:
        most = f"less than {2.0 / dt:g}, 2 a period of {dt:g} s,"
        raise refusal("last_turn.gain", turn.gain, most)
    return turn


def _sound(name: str, values: Any, kind: type, least: dict[str, float], endless: tuple) -> Any:
    """The fields as floats above 0, or at least what `least` says; some may be `endless`."""
    fields = instance(name, values, kind)._asdict()
    for field, value in fields.items():
        bound = {"low": least[field]} if field in least else {"above": 0.0}
        fields[field] = scalar(f"{name}.{field}", value, endless=field in endless, **bound)
    return kind(**fields)


@formula
def hurry(v, alpha, min_speed):
    """The factor that scales a twist up until |v| is at least min_speed |cos(alpha)|.

    A twist without a speed, a turn on the spot, stays as it is.
    """
    least = min_speed * abs(sincos(alpha)[1])
    return between(least * abs(v) / (v * v + _SLOWEST * _SLOWEST), 1.0, _FASTEST)


@formula
def are_ideal(wheels):
    """Whether the wheels reach any commanded speed within their limits at once."""
    at_once = (wheels.lag == 0.0) & (wheels.acceleration == math.inf)
    return at_once & (wheels.dead_band == 0.0) & (wheels.encoder_step == 0.0)


@formula
def turn_rate(error, gain, min_rate, max_rate):
    """Omega of a turn on the spot, rad/s; `error` is the remaining angle, rad."""
    return signed(between(gain * abs(error), min_rate, max_rate), error)


@formula
def last_turn(rho, alpha, theta, v, omega, turning, radius, dt, end):
    """The last turn at a sample: (v, omega, turning, done), from the law's twist (v, omega).

    `turning` is the turn's memory between samples: 0 while the robot drives, and 1 plus the
    seconds that it has been within the tolerance while it turns on the spot. `done` says that the
    turn is finished.
    """
    near = rho <= (radius * end.leave if turning > 0.0 else radius)
    heading_error = wrap(theta - alpha)
    faces = near & (abs(heading_error) <= end.tolerance)
    faced = turning - 1.0 if turning > 1.0 else 0.0
    rate = 0.0 if faces else turn_rate(-heading_error, end.gain, end.min_rate, end.max_rate)
    turning = (1.0 + (faced + dt if faces else 0.0)) if near else 0.0
    done = faces & (faced >= end.settle - _AT_ONCE)
    return (0.0 if near else v), (rate if near else omega), turning, done


@formula
def follow(speed, commanded, easing, lag, dt):
    """A wheel's mean speed in a period of dt, and its speed at the end of it, both in m/s.

    The speed follows the commanded one with the time constant `lag` [s], and changes by at most
    1/easing [m/s^2]: first along a straight line (the ramp), then along an exponential.
    """
    gap = commanded - speed
    ramp = between(abs(gap) * easing - lag, 0.0, dt)  # s
    ramped = speed + gap * (ramp / (abs(gap) * easing + _TINY))
    rest = dt - ramp
    closer = -expm1(-rest / (lag + _NO_LAG)) * (commanded - ramped)
    rolled = 0.5 * (speed + ramped) * ramp + commanded * rest - lag * closer
    return rolled / dt, ramped + closer


@formula
def roll(v, omega, body, wheels, dt):
    """The mean twist that the wheels drive in a period of dt, and the body's state at its end.

    The state of a body is four numbers: the speeds of the left and the right wheel [m/s], and the
    distances by which encoder steps have left each behind [m].
    """
    left, right, left_rest, right_rest = body
    commanded_left, commanded_right = wheel_speeds(v, omega, wheels.track_width)
    easing, dead = 1.0 / wheels.acceleration, wheels.dead_band
    commanded_left = commanded_left - within(commanded_left, dead, 0.0)
    commanded_right = commanded_right - within(commanded_right, dead, 0.0)
    mean_left, left = follow(left, commanded_left, easing, wheels.lag, dt)
    mean_right, right = follow(right, commanded_right, easing, wheels.lag, dt)
    due_left, due_right = left_rest + dt * mean_left, right_rest + dt * mean_right
    rolled_left = stepped(due_left, wheels.encoder_step)
    rolled_right = stepped(due_right, wheels.encoder_step)
    body = left, right, due_left - rolled_left, due_right - rolled_right
    v = 0.5 * (rolled_left + rolled_right) / dt
    return v, (rolled_right - rolled_left) / (wheels.track_width * dt), body


@formula
def at_rest(body):
    """Whether both wheels stand."""
    return (abs(body[0]) < _AT_REST) & (abs(body[1]) < _AT_REST)
