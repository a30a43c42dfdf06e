"""The robot and where its goal lies: wheels, twist, pose and polar error; equations (1) to (10) of the paper.

The local frame has x east and y north, in metres. Headings are radians, counter-clockwise from east. The signs of the polar
error are Aicardi's: Corke and Siegwart write beta = -theta, so that their k_beta < 0 is h > 0 here.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from wmrlib._checks import Real, choice, instance, real, same_shape
from wmrlib._compile import compiled, elementwise, formula
from wmrlib._vecmath import sinc, sincos

_TURN = 2.0 * math.pi


class _PoseFields(NamedTuple):
    x: Real
    y: Real
    heading: Real


class Pose(_PoseFields):
    """Where the robot is and where it looks, or many such poses.

    x, y: metres east and north; heading: radians from east, counter-clockwise. Numbers or arrays that broadcast together.
    Raises ValueError for a value that is not finite, or mismatched lengths.
    """

    __slots__ = ()

    def __new__(cls, x: Real, y: Real, heading: Real) -> Pose:
        if not type(x) is type(y) is type(heading) is float:
            same_shape(x=x, y=y, heading=heading)
        return super().__new__(cls, real("x", x), real("y", y), real("heading", heading))

    @classmethod
    def _make(
        cls, fields: Iterable[Real]
    ) -> Pose:  # what `_replace` calls; the namedtuple's own would check nothing
        return cls(*fields)


class PolarError(NamedTuple):
    """The goal as seen from the robot.

    rho: distance, metres; alpha: line of sight from the robot's heading, the paper's A, radians; theta: line of sight from the
    goal's heading, radians; both angles in (-pi, pi].
    """

    rho: Real
    alpha: Real
    theta: Real


class Reference(NamedTuple):
    """A goal that moves: its pose (x, y in metres, heading in radians) and its twist (v in m/s, omega in rad/s)."""

    x: Real
    y: Real
    heading: Real
    v: Real
    omega: Real


# The formulas, once each, one number at a time ------------------------------------------------------------------------


@compiled
def wrap(angle):
    if -math.pi < angle <= math.pi:
        return angle
    angle = np.fmod(angle, _TURN)  # exact, and so is what follows
    if angle > math.pi:
        return angle - _TURN
    return angle + _TURN if angle <= -math.pi else angle


@compiled
def polar_from_pose(x, y, heading, goal_x, goal_y, goal_heading):
    east, north = goal_x - x, goal_y - y
    sight = math.atan2(north, east)
    return math.sqrt(east * east + north * north), wrap(sight - heading), wrap(sight - goal_heading)


@formula
def polar_closing_rate(rho, alpha, pull, omega):
    """(7)-(9) with pull = v/rho, so that nothing is divided by zero at the goal."""
    sin_alpha, cos_alpha = sincos(alpha)
    turning = pull * sin_alpha
    return -pull * rho * cos_alpha, turning - omega, turning


@compiled
def euler_step(x, y, heading, v, omega, dt):
    sin_heading, cos_heading = sincos(heading)
    return x + v * cos_heading * dt, y + v * sin_heading * dt, wrap(heading + omega * dt)


@compiled
def arc_step(x, y, heading, v, omega, dt):
    """The chord of the arc points half the turn away from the heading and is sinc(half the turn) times as long as the arc."""
    half_turn = 0.5 * omega * dt
    sin_chord, cos_chord = sincos(heading + half_turn)
    chord = v * dt * sinc(half_turn)
    return x + chord * cos_chord, y + chord * sin_chord, wrap(heading + 2.0 * half_turn)


# The same for users: checked, broadcast, described --------------------------------------------------------------------


def wheels_to_twist(left: Real, right: Real, track_width: float) -> tuple[Real, Real]:
    """Twist (v, omega) in m/s and rad/s from the ground speeds of the left and right wheel in m/s.

    v = (V_r + V_l)/2 and omega = (V_r - V_l)/b with b = `track_width`, the distance between the wheels in metres; equations (1)
    and (2), where a wheel's ground speed is its radius times its angular speed. Speeds may be arrays that broadcast.
    Raises ValueError for NaN, a track width that is not positive, or mismatched lengths.
    """
    left, right = real("left", left), real("right", right)
    width = real("track_width", track_width, above=0.0)
    same_shape(left=left, right=right, track_width=width)
    return (left + right) / 2.0, (right - left) / width


def twist_to_wheels(v: Real, omega: Real, track_width: float) -> tuple[Real, Real]:
    """Ground speeds (left, right) in m/s from the twist: the inverse of `wheels_to_twist`, with the same shapes and errors."""
    v, omega = real("v", v), real("omega", omega)
    half_width = real("track_width", track_width, above=0.0) / 2.0
    same_shape(v=v, omega=omega, track_width=half_width)
    return v - omega * half_width, v + omega * half_width


def wrap_angle(angle: Real) -> Real:
    """The same direction in (-pi, pi] (radians, any shape). Exact: no digit of `angle` modulo 2 pi is lost.

    Raises ValueError if an angle is not finite.
    """
    return elementwise(_wrap_all, 1, real("angle", angle))[0]


def pose_rate(heading: Real, v: Real, omega: Real) -> tuple[Real, Real, Real]:
    """Rate of the pose (x', y', heading') in m/s, m/s, rad/s; equations (3)-(6).

    x' = v cos(heading), y' = v sin(heading), heading' = omega. heading in radians, v in m/s, omega in rad/s,
    arrays that broadcast. Raises ValueError for NaN or mismatched lengths.
    """
    heading, v, omega = real("heading", heading), real("v", v), real("omega", omega)
    same_shape(heading=heading, v=v, omega=omega)
    return v * np.cos(heading), v * np.sin(heading), omega


def advance(pose: Pose, v: Real, omega: Real, dt: float, method: str = "arc") -> Pose:
    """The pose after `dt` seconds of a constant twist; the heading comes back in (-pi, pi].

    method "arc": the exact solution of (3)-(5), an arc of a circle or a straight line. "euler": the paper's, along the tangent.
    Shapes broadcast. Raises ValueError for NaN, a negative dt, an unknown method or mismatched lengths.
    """
    instance("pose", pose, Pose)
    step = _STEPS[choice("method", method, _STEPS)]
    v, omega, dt = real("v", v), real("omega", omega), real("dt", dt, low=0.0)
    same_shape(pose=pose.x, heading=pose.heading, v=v, omega=omega, dt=dt)
    return Pose(*elementwise(step, 3, *pose, v, omega, dt))


def polar_error(pose: Pose, goal: Pose) -> PolarError:
    """The goal as seen from the robot: (rho, alpha, theta) in metres and radians.

    psi = atan2(goal.y - y, goal.x - x), the line of sight; rho is the distance, alpha = wrap(psi - heading) is the paper's A
    (Fig. 2), theta = wrap(psi - goal.heading). On the goal psi = atan2(0, 0) = 0. Poses may hold arrays that broadcast.
    Raises ValueError for mismatched lengths.
    """
    instance("pose", pose, Pose)
    instance("goal", goal, Pose)
    same_shape(
        **{
            "pose.x": pose.x,
            "pose.heading": pose.heading,
            "goal.x": goal.x,
            "goal.heading": goal.heading,
        }
    )
    return PolarError(*elementwise(_polar_from_pose_all, 3, *pose, *goal))


def pose_from_polar(polar: PolarError, goal: Pose) -> Pose:
    """The pose from which `goal` is seen as `polar`: the inverse of `polar_error`, with the heading in (-pi, pi].

    x = goal.x - rho cos(psi), y = goal.y - rho sin(psi), heading = psi - alpha, with psi = theta + goal.heading.
    """
    instance("goal", goal, Pose)
    rho, alpha, theta = (
        real("rho", polar[0], low=0.0),
        real("alpha", polar[1]),
        real("theta", polar[2]),
    )
    same_shape(
        rho=rho, alpha=alpha, theta=theta, **{"goal.x": goal.x, "goal.heading": goal.heading}
    )
    sight = theta + goal.heading
    return Pose(
        goal.x - rho * np.cos(sight), goal.y - rho * np.sin(sight), wrap_angle(sight - alpha)
    )


def polar_rate(rho: Real, alpha: Real, v: Real, omega: Real) -> tuple[Real, Real, Real]:
    """Rate of the polar error (rho', alpha', theta') in m/s, rad/s, rad/s under the twist (v, omega); equations (7)-(9).

    rho' = -v cos(alpha), alpha' = -omega + v sin(alpha)/rho, theta' = v sin(alpha)/rho. Equation (10) of the paper has the
    opposite sign in its theta row, which contradicts (8). Shapes broadcast. Raises ValueError unless rho > 0: at the goal
    itself the line of sight has no direction.
    """
    rho, alpha = real("rho", rho, above=0.0), real("alpha", alpha)
    v, omega = real("v", v), real("omega", omega)
    same_shape(rho=rho, alpha=alpha, v=v, omega=omega)
    return elementwise(_polar_closing_rate_all, 3, rho, alpha, v / rho, omega)


@compiled
def _wrap_all(angle, wrapped):
    for i in range(angle.size):
        wrapped[i] = wrap(angle[i])


@compiled
def _polar_from_pose_all(x, y, heading, goal_x, goal_y, goal_heading, rho, alpha, theta):
    for i in range(x.size):
        rho[i], alpha[i], theta[i] = polar_from_pose(
            x[i], y[i], heading[i], goal_x[i], goal_y[i], goal_heading[i]
        )


@compiled
def _polar_closing_rate_all(rho, alpha, pull, omega, rho_rate, alpha_rate, theta_rate):
    for i in range(rho.size):
        rho_rate[i], alpha_rate[i], theta_rate[i] = polar_closing_rate(
            rho[i], alpha[i], pull[i], omega[i]
        )


@compiled
def _euler_step_all(x, y, heading, v, omega, dt, new_x, new_y, new_heading):
    for i in range(x.size):
        new_x[i], new_y[i], new_heading[i] = euler_step(
            x[i], y[i], heading[i], v[i], omega[i], dt[i]
        )


@compiled
def _arc_step_all(x, y, heading, v, omega, dt, new_x, new_y, new_heading):
    for i in range(x.size):
        new_x[i], new_y[i], new_heading[i] = arc_step(x[i], y[i], heading[i], v[i], omega[i], dt[i])


_STEPS = {"euler": _euler_step_all, "arc": _arc_step_all}
