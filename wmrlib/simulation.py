"""Driving the robot on the computer: to a goal that stands still, and after one that moves."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from wmrlib._checks import choice, instance, reals, refusal, scalar
from wmrlib._loops import alone, plane, rows
from wmrlib.gains import Gains, KanayamaGains, LinearGains, WheelLimits, checked_wheels
from wmrlib.kinematics import Pose, Reference
from wmrlib.laws import POSE_LAWS, TRACKING_LAWS, tuning_of
from wmrlib.motion import wrap
from wmrlib.runs import Outcome, Trajectory, sample_count, single_pose

_METHODS = (*plane.STEPS, "continuous")
_OUTCOMES = tuple(Outcome)  # in the order of the loops' codes


def simulate(
    start: Pose,
    goal: Pose,
    gains: Gains,
    *,
    law: str = "corrected",
    method: str = "arc",
    dt: float = 0.1,
    duration: float = 60.0,
    arrival_radius: float = 0.05,
    wheels: WheelLimits | None = None,
    wheel_lag: float = 0.0,
) -> Trajectory:
    """Drive from one pose to another.

    Parameters
    ----------
    start, goal : Pose of numbers, m and rad
    gains : Gains of numbers
    law : "corrected", "printed" or "aicardi", see `control_law`
    method : "euler", the paper's: the twist is held for `dt` and the pose moves along its tangent;
        "arc": the twist is held and the pose moves along the exact arc;
        "continuous": the law acts all the time; (rho, alpha, theta) is integrated by Dormand and
        Prince's method of order 8, to 1e-10 a step.
        The first two see alpha and theta in (-pi, pi]; in the last these never jump.
    dt : float, s, between samples; "continuous" adds the moment of arrival
    duration : float, s, within which lies the last sample, where the robot stops; at most ten
        million dt
    arrival_radius : float, m, within which it stops; 0 drives on
    wheels : WheelLimits or None, see `limit_wheels`
    wheel_lag : float, s; with "continuous" and an arrival radius, the wheels start at rest and
        follow the limited command as first-order systems with this time constant (an inner loop
        with a bandwidth of 1/wheel_lag rad/s); the run's v and omega are then what the wheels do

    Returns
    -------
    Trajectory

    Raises
    ------
    ValueError : an argument is not as described; it is named with its value and what is allowed

    Examples
    --------
    With its own gains the paper's robot arrives far from the goal's heading:

    >>> import math
    >>> import wmrlib as wmr
    >>> start, goal, gains, _ = wmr.paper.outdoor()
    >>> for chosen in gains, wmr.GENTLE_GAINS:
    ...     run = wmr.simulate(start, goal, chosen, method="continuous")
    ...     print(f"{run.t[-1]:.1f} s, {math.degrees(run.heading_error[-1]):.1f} deg off")
    15.5 s, -27.2 deg off
    23.1 s, 2.1 deg off
    """
    begin, end = single_pose("start", start), single_pose("goal", goal)
    tuning, code = tuning_of(gains, law, POSE_LAWS)
    samples, dt = sample_count(dt, duration), float(dt)
    radius = scalar("arrival_radius", arrival_radius, low=0.0)
    limits, lag = checked_wheels(wheels), scalar("wheel_lag", wheel_lag, low=0.0)
    continuously = choice("method", method, _METHODS) == "continuous"
    if lag and not (continuously and radius):  # on the goal itself there is no line of sight
        raise refusal("wheel_lag", lag, '0, or method "continuous" with an arrival radius,')
    t = dt * np.arange(samples)
    if continuously:
        run = alone.to_goal(begin, end, tuning, code, limits, t, radius, lag)
    else:
        path = np.array([end.x, end.y, wrap(end.heading), 0.0, 0.0])[:, None]
        run = _held(t, method, dt, radius, begin, path, tuning, code, limits)
    return _trajectory(*run, end, gains, law, method)


def track(
    reference: Callable[[np.ndarray], Reference],
    start: Pose,
    gains: Gains | KanayamaGains | LinearGains,
    *,
    law: str = "corrected",
    method: str = "arc",
    dt: float = 0.1,
    duration: float = 60.0,
    wheels: WheelLimits | None = None,
) -> Trajectory:
    """Follow a moving goal to the end of the given time.

    Parameters
    ----------
    reference : function of an array of times [s] that returns a Reference of arrays, for example
        `paper.circle`
    start : Pose of numbers, m and rad
    gains : Gains, KanayamaGains or LinearGains, as the law needs; one number a gain
    law : as in `simulate`, or one that uses the reference's twist, v_ref and omega_ref; with the
        error e_x = rho cos(alpha), e_y = rho sin(alpha), e_h = wrap(alpha - theta),
        "kanayama": v = v_ref cos(e_h) + k_x e_x and
        omega = omega_ref + v_ref (k_y e_y + k_heading sin(e_h));
        "linear": v = v_ref cos(e_h) + K_1 e and omega = omega_ref + K_2 e
    method, dt, duration, wheels : as in `simulate`, but "continuous" integrates the pose

    Returns
    -------
    Trajectory

    Raises
    ------
    ValueError : as `simulate`

    Examples
    --------
    >>> import wmrlib as wmr
    >>> run = wmr.track(wmr.paper.circle, wmr.paper.CIRCLE_START, wmr.paper.CIRCLE_GAINS)
    >>> print(f"{wmr.residual(run):.3f} m behind")  # the paper's error "converges to 0.1 m"
    0.090 m behind
    """
    if not callable(reference):
        raise refusal("reference", reference, "a function of time")
    begin = single_pose("start", start)
    tuning, code = tuning_of(gains, law, TRACKING_LAWS)
    samples, dt = sample_count(dt, duration), float(dt)
    limits = checked_wheels(wheels)
    t = dt * np.arange(samples)

    def path_at(times: np.ndarray) -> np.ndarray:
        seen = reference(np.minimum(times, duration))  # three times 0.1 is more than 0.3
        fields = instance("reference(t)", seen, Reference)._asdict()
        named = {f"reference(t).{name}": values for name, values in fields.items()}
        path = np.array(np.broadcast_arrays(*reals(**named, t=times))[:-1])
        if path.shape[1:] != times.shape:
            raise refusal("reference(t)", named, "one number, or one a time, in each field")
        return path

    path = path_at(t)
    if choice("method", method, _METHODS) == "continuous":
        run = alone.after_reference(path_at, begin, tuning, code, limits, t)
    else:
        run = _held(t, method, dt, -1.0, begin, path, tuning, code, limits)
    t, record, outcome, *sums = run
    ended = rows.COMPLETED if outcome == rows.TIMED_OUT else outcome
    return _trajectory(t, record, ended, *sums, Pose(*path[:3, : t.size]), gains, law, method)


def _held(t, method, dt, radius, start, path, *loop) -> tuple:
    """(t, record, outcome, peak omega, path length) of a run whose twist is held for dt."""
    record = np.empty((rows.LYAPUNOV + 1, t.size))
    steps = plane.STEPS[method], dt, radius
    count, *sums = plane.drive(record.T, tuple(start), path, *loop, *steps)
    return t[:count], record[:, :count], *sums


def _trajectory(t, record, outcome, peak, length, *setting) -> Trajectory:
    return Trajectory(*(t, *record, _OUTCOMES[outcome], *setting, peak, length))
