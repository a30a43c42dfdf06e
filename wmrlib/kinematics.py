"""The pose of the robot, its motion and its polar error; equations (1) to (10) of the paper.

The local frame has x east and y north. Headings are counter-clockwise from east. The signs of the
polar error are Aicardi's: Corke and Siegwart write beta = -theta, and k_beta < 0 for h > 0. The
formulas stand in `wmrlib.motion`; here they take arrays.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wmrlib import motion
from wmrlib.checks import Real, checked, choice, instance, real, reals
from wmrlib.elementary import elementwise, wrap
from wmrlib.records import record


@record
@checked()
class Pose(NamedTuple):
    """A position and a heading in the plane, or many of them.

    Parameters
    ----------
    x, y : float or array, m. East and north.
    heading : float or array, rad from east, counter-clockwise; pi/2 - bearing.

    Raises
    ------
    ValueError : for a value that is not finite, or mismatched lengths.

    Examples
    --------
    >>> import math
    >>> import wmrlib as wmr
    >>> parked = wmr.Pose(x=2.0, y=1.0, heading=math.radians(90))  # to the north
    >>> wmr.Pose([0.0, 1.0, 2.0], 0.0, 0.0).x  # three poses side by side
    array([0., 1., 2.])
    """

    x: Real
    y: Real
    heading: Real


@record
class PolarError(NamedTuple):
    """The position of the goal as the robot sees it, in polar coordinates.

    rho: the distance, m; alpha (the paper's A), theta: the line of sight counted from the robot's
    and from the goal's heading, rad, in (-pi, pi].

    Examples
    --------
    >>> import wmrlib as wmr
    >>> wmr.polar_error(wmr.Pose(0.0, 0.0, 0.5), goal=wmr.Pose(2.0, 0.0, 0.25))
    PolarError(rho=2.0, alpha=-0.5, theta=-0.25)
    """

    rho: Real
    alpha: Real
    theta: Real


@record
class Reference(NamedTuple):
    """A moving goal: its pose (m, m, rad) and its twist (m/s, rad/s).

    Examples
    --------
    >>> import numpy as np
    >>> import wmrlib as wmr
    >>> def eastwards(t):  # at 0.5 m/s, for `wmr.track`
    ...     still = np.zeros_like(t)
    ...     return wmr.Reference(0.5 * t, still, still, 0.5 + still, still)
    >>> run = wmr.track(eastwards, wmr.Pose(0.0, 1.0, 0.0), wmr.GENTLE_GAINS)
    >>> print(f"{wmr.residual(run):.2f} m behind")
    0.67 m behind
    """

    x: Real
    y: Real
    heading: Real
    v: Real
    omega: Real


def wheels_to_twist(left: Real, right: Real, track_width: float) -> tuple[Real, Real]:
    """The twist of a robot whose wheels roll: (1) v = (V_r + V_l)/2, (2) omega = (V_r - V_l)/b.

    Parameters
    ----------
    left, right : float or array, m/s. Ground speeds: a wheel's radius times its angular speed.
    track_width : float, m. The distance b between the wheels.

    Returns
    -------
    v, omega : float or array; m/s, rad/s

    Raises
    ------
    ValueError : for NaN, a width that is not positive, or mismatched lengths.

    Examples
    --------
    >>> import wmrlib as wmr
    >>> wmr.wheels_to_twist(left=1.0, right=2.0, track_width=0.5)  # a turn to the left
    (1.5, 2.0)
    """
    wheels = {"left": left, "right": right, "track_width": track_width}
    left, right, width = reals(above_0=("track_width",), **wheels)
    return (left + right) / 2.0, (right - left) / width


def twist_to_wheels(v: Real, omega: Real, track_width: float) -> tuple[Real, Real]:
    """The wheels' ground speeds for a twist: the inverse of `wheels_to_twist`.

    Parameters
    ----------
    v, omega : float or array; m/s, rad/s
    track_width : float, m. The distance b between the wheels.

    Returns
    -------
    left, right : float or array, m/s; (1) and (2) solved for V_l = v - omega b/2 and
        V_r = v + omega b/2

    Raises
    ------
    ValueError : for NaN, a width that is not positive, or mismatched lengths.

    Examples
    --------
    >>> import wmrlib as wmr
    >>> wmr.twist_to_wheels(v=0.0, omega=2.0, track_width=0.5)  # a turn on the spot
    (-0.5, 0.5)
    """
    v, omega, width = reals(above_0=("track_width",), v=v, omega=omega, track_width=track_width)
    return motion.wheel_speeds(v, omega, width)


def wrap_angle(angle: Real) -> Real:
    """The same direction in (-pi, pi], exact in every digit.

    Parameters
    ----------
    angle : float or array, rad

    Returns
    -------
    float or array, rad

    Raises
    ------
    ValueError : if an angle is not finite.

    Examples
    --------
    >>> import math
    >>> import wmrlib as wmr
    >>> wmr.wrap_angle(1.5 * math.pi) == -0.5 * math.pi  # three quarters left: one quarter right
    True
    """
    return elementwise(wrap, real("angle", angle))


def pose_rate(heading: Real, v: Real, omega: Real) -> tuple[Real, Real, Real]:
    """The pose's rate, (3) to (6): x' = v cos(heading), y' = v sin(heading), heading' = omega.

    Parameters
    ----------
    heading, v, omega : float or array; rad, m/s, rad/s

    Returns
    -------
    x', y', heading' : float or array; m/s, m/s, rad/s

    Raises
    ------
    ValueError : for NaN or mismatched lengths.

    Examples
    --------
    >>> import wmrlib as wmr
    >>> east, north, turn = wmr.pose_rate(heading=0.0, v=2.0, omega=0.5)
    >>> print(east, north, turn)
    2.0 0.0 0.5
    """
    heading, v, omega = reals(heading=heading, v=v, omega=omega)
    return v * np.cos(heading), v * np.sin(heading), omega


def advance(pose: Pose, v: Real, omega: Real, dt: float, method: str = "arc") -> Pose:
    """The pose after `dt` seconds of a constant twist.

    Parameters
    ----------
    pose, v, omega, dt : Pose; float or array; m/s, rad/s, s
    method : "arc", the exact solution of (3)-(5), or "euler", Euler's step along the tangent.

    Returns
    -------
    Pose, with its heading in (-pi, pi].

    Raises
    ------
    ValueError : for NaN, a negative dt, an unknown method or mismatched lengths.

    Examples
    --------
    >>> import math
    >>> import wmrlib as wmr
    >>> pose = wmr.advance(wmr.Pose(0.0, 0.0, 0.0), v=math.pi / 2, omega=math.pi / 2, dt=1.0)
    >>> print(f"{pose.x:.2f}, {pose.y:.2f}")  # a quarter of a circle with radius 1 m
    1.00, 1.00
    """
    instance("pose", pose, Pose)
    step = motion.STEPS[choice("method", method, motion.STEPS)]
    state = reals(at_least_0=("dt",), **pose._asdict(), v=v, omega=omega, dt=dt)
    return Pose(*elementwise(step, *state))


def polar_error(pose: Pose, goal: Pose) -> PolarError:
    """The polar error of a pose: distance and direction of the goal.

    With the line of sight psi = atan2(goal.y - y, goal.x - x), 0 on the goal itself,
    alpha = wrap(psi - heading) and theta = wrap(psi - goal.heading).

    Parameters
    ----------
    pose, goal : Pose, whose fields may be arrays that broadcast.

    Returns
    -------
    PolarError

    Raises
    ------
    ValueError : for mismatched lengths.

    Examples
    --------
    >>> import math
    >>> import wmrlib as wmr
    >>> error = wmr.polar_error(wmr.Pose(0.0, 0.0, 0.0), goal=wmr.Pose(3.0, 4.0, math.pi / 2))
    >>> rho, alpha, theta = error.rho, math.degrees(error.alpha), math.degrees(error.theta)
    >>> print(f"{rho:.1f} m away, alpha = {alpha:.1f} deg, theta = {theta:.1f} deg")
    5.0 m away, alpha = 53.1 deg, theta = -36.9 deg
    """
    fields = reals(**_fields(pose=pose, goal=goal))
    return PolarError(*elementwise(motion.polar_from_pose, *fields))


def pose_from_polar(polar: PolarError, goal: Pose) -> Pose:
    """The pose whose polar error is `polar`: the inverse of `polar_error`.

    Parameters
    ----------
    polar : PolarError; m, rad, rad
    goal : Pose; fields of both may be arrays that broadcast

    Returns
    -------
    Pose, with its heading in (-pi, pi]

    Raises
    ------
    ValueError : for rho < 0, NaN or mismatched lengths.

    Examples
    --------
    >>> import wmrlib as wmr
    >>> goal = wmr.Pose(3.0, 4.0, 0.0)
    >>> ahead = wmr.PolarError(rho=2.0, alpha=0.0, theta=0.0)
    >>> wmr.pose_from_polar(ahead, goal)  # 2 m before the goal, and it faces the goal
    Pose(x=1.0, y=4.0, heading=0.0)
    """
    named = instance("polar", polar, PolarError)._asdict() | _fields(goal=goal)
    return Pose(*elementwise(motion.pose_of_error, *reals(at_least_0=("rho",), **named)))


def polar_rate(rho: Real, alpha: Real, v: Real, omega: Real) -> tuple[Real, Real, Real]:
    """The polar error's rate, (7) to (9), under the twist (v, omega).

    rho' = -v cos(alpha), theta' = v sin(alpha)/rho and alpha' = theta' - omega. The theta row of
    (10) has the other sign and contradicts (8).

    Parameters
    ----------
    rho, alpha, v, omega : float or array; m, rad, m/s, rad/s

    Returns
    -------
    rho', alpha', theta' : float or array; m/s, rad/s, rad/s

    Raises
    ------
    ValueError : unless rho > 0 (the goal has no direction when on it), NaN, mismatched lengths.

    Examples
    --------
    >>> import math
    >>> import wmrlib as wmr
    >>> rates = wmr.polar_rate(rho=2.0, alpha=math.pi / 2, v=1.0, omega=0.0)  # the goal abeam
    >>> print([round(rate, 3) for rate in rates])  # the line of sight turns at 0.5 rad/s
    [-0.0, 0.5, 0.5]
    """
    rho, alpha, v, omega = reals(above_0=("rho",), rho=rho, alpha=alpha, v=v, omega=omega)
    return elementwise(motion.polar_closing_rate, rho, alpha, v / rho, omega)


def _fields(**poses: Pose) -> dict[str, Real]:
    named = [(name, instance(name, pose, Pose)._asdict()) for name, pose in poses.items()]
    return {f"{name}.{field}": pose[field] for name, pose in named for field in pose}
