"""An estimate of the robot's pose from wheels, gyro, GNSS, compass and course.

An extended Kalman filter. Its model is `wmrrobot.sensing`; its derivatives are printed from that by
sympy, here and in the C header ``wmr_filter.h``. Each function returns a new `Estimate`. A
measurement beyond its `gate`, a chi-square bound, changes nothing but `surprise`; an infinite gate
uses everything. A ValueError names a wrong type, a number that is not finite, or one out of range.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from wmrlib.checks import instance, refusal, scalar, scalars
from wmrlib.kinematics import Pose
from wmrlib.laws import fastest_wheel
from wmrrobot import sensing
from wmrrobot.kalman import carry, see_antenna, see_heading
from wmrrobot.sensing import Noise

GATE_1, GATE_2 = 10.83, 13.82
"""Chi-square bounds that 99.9 % of good measurements pass: of one number, of a position."""
DOUBTED = 100.0  # m
LONGEST = 60.0  # s, of a step
OVER = 1.5  # times the wheels' top speed: a faster reading is an encoder's fault


class Estimate(NamedTuple):
    """The estimate of the filter: its state, and the state's covariance.

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

    @property
    def lost(self) -> bool:
        """Whether the place is uncertain by more than 100 m, so that the next fix must start it."""
        area = self.covariance[0, 0] + self.covariance[1, 1]
        return not (np.isfinite(self.state).all() and 0.0 <= area <= DOUBTED**2)


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
    >>> import wmrrobot as wr
    >>> first = wr.estimation.start(wmr.Pose(0.0, 0.0, 0.3), 2.0, 0.2)
    >>> first.sigma.tolist()
    [2.0, 2.0, 0.2, 0.02, 0.03]
    """
    state = scalars(**instance("pose", pose, Pose)._asdict())
    sigmas = {"position_sigma": position_sigma, "heading_sigma": heading_sigma}
    sigmas |= {"bias_sigma": bias_sigma, "scale_sigma": scale_sigma}
    position, *rest = scalars(sigmas, **sigmas)
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
    dt : float, s. Above 0, and at most 60.
    noise : Noise, of numbers

    Raises
    ------
    ValueError : for a twist with which a wheel would turn half as fast again as `noise.max_speed`:
        a counter of an encoder has begun anew. Leave out that step.

    Examples
    --------
    >>> import wmrlib as wmr
    >>> import wmrrobot as wr
    >>> first = wr.estimation.start(wmr.Pose(0.0, 0.0, 0.0), 0.02, 0.1)
    >>> rested = wr.estimation.predict(first, 0.0, 0.0, 0.01, 10.0, wr.estimation.Noise())
    >>> print(f"gyro bias {rested.state[3]:.3f} rad/s")
    gyro bias 0.010 rad/s
    """
    v, omega = scalars(v=v, omega=omega)
    dt = scalar("dt", dt, above=0.0, high=LONGEST)
    gyro = scalar("gyro", gyro, nan=True)
    numbers = scalars(**instance("noise", noise, Noise)._asdict())
    if (fastest := fastest_wheel(v, omega, noise.track_width)) > OVER * noise.max_speed:
        most = f"wheels of at most {OVER * noise.max_speed:g} m/s, not {fastest:g},"
        raise refusal("v, omega", (v, omega), most)
    return _used(estimate, gate, carry, v, omega, gyro, dt, tuple(numbers))


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
    >>> import wmrrobot as wr
    >>> first = wr.estimation.start(wmr.Pose(0.0, 0.0, 0.0), 1.0, 0.1)
    >>> wr.estimation.use_position(first, 1.0, 0.0, 1.0).pose.x
    0.5
    """
    fix = scalars(("sigma",), x=x, y=y, ahead=ahead, left=left, sigma=sigma)
    return _used(estimate, gate, see_antenna, *fix)


def use_heading(estimate: Estimate, heading: float, sigma: float, gate: float = GATE_1) -> Estimate:
    """Use a heading: a compass's, or a two-antenna receiver's less the baseline's angle on board.

    Parameters
    ----------
    heading : float, rad from east, counter-clockwise
    sigma : float, rad. Its standard deviation.

    Examples
    --------
    >>> import wmrlib as wmr
    >>> import wmrrobot as wr
    >>> first = wr.estimation.start(wmr.Pose(0.0, 0.0, 0.0), 1.0, 0.1)
    >>> wr.estimation.use_heading(first, 0.1, 0.1).pose.heading
    0.05
    """
    return _used(estimate, gate, see_heading, *scalars(("sigma",), heading=heading, sigma=sigma))


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
    >>> import wmrrobot as wr
    >>> first = wr.estimation.start(wmr.Pose(0.0, 0.0, 0.0), 1.0, 0.1)
    >>> back = wr.estimation.use_course(first, 3.141592653589793, 0.1, v=-1.0, omega=0.0)
    >>> back.pose.heading  # it reverses to the west, so it faces east
    0.0
    """
    course, v, omega, ahead, left = scalars(course=course, v=v, omega=omega, ahead=ahead, left=left)
    used = use_heading(estimate, course - sensing.course(0.0, v, omega, ahead, left), sigma, gate)
    slow = math.hypot(v - omega * left, omega * ahead) < scalar("slowest", slowest, low=0.0)
    return estimate if slow else used


def doubt(estimate: Estimate, factor: float) -> Estimate:
    """The same state, less certain: the covariance times a factor.

    A gate that has refused several measurements in a row may be refusing the truth, for a robot
    that was carried, or a first heading that was wrong. Multiply by 4, say, with each one that it
    refuses from then on, until one is used. A place that is uncertain by more than 100 m is not
    doubted further: it is `lost`.

    Parameters
    ----------
    factor : float, no unit. At least 1.

    Examples
    --------
    >>> import wmrlib as wmr
    >>> import wmrrobot as wr
    >>> first = wr.estimation.start(wmr.Pose(0.0, 0.0, 0.0), 1.0, 0.1)
    >>> wr.estimation.doubt(first, 4.0).sigma[:3].tolist()
    [2.0, 2.0, 0.2]
    """
    state, covariance, surprise = instance("estimate", estimate, Estimate)
    factor = scalar("factor", factor, low=1.0)
    return Estimate(state.copy(), (1.0 if estimate.lost else factor) * covariance, surprise)


def _used(estimate: Estimate, gate: float, use: Callable, *numbers) -> Estimate:
    """The estimate after a compiled function has changed copies of state and covariance."""
    state, covariance, _ = instance("estimate", estimate, Estimate)
    state, covariance = state.copy(), covariance.copy()
    bound = scalar("gate", gate, low=0.0, endless=True)
    return Estimate(state, covariance, use(state, covariance, *numbers, bound))
