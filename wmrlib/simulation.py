"""Driving the robot on the computer: to a goal that stands still, and after one that moves."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from wmrlib._checks import choice, instance, real, scalar
from wmrlib._loops import continuous, plane, rows
from wmrlib.gains import Gains, WheelLimits, checked_wheels
from wmrlib.kinematics import Pose, Reference
from wmrlib.laws import POSE_LAWS, TRACKING_LAWS, tuning_of
from wmrlib.runs import Outcome, Trajectory, sample_count, single_pose

_STEPS = {"euler": plane.EULER, "arc": plane.ARC}
_METHODS = (*_STEPS, "continuous")
_OUTCOMES = (
    Outcome.ARRIVED,
    Outcome.TIMED_OUT,
    Outcome.DIVERGED,
    Outcome.COMPLETED,
)  # in the order of the loops' codes


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
    """Drive from `start` to `goal` (single poses) and stop within `arrival_radius` metres of it, or after `duration` seconds.

    law: "corrected", "printed" or "aicardi", see `control_law`. wheels: see `limit_wheels`.
    method: "euler", the paper's: the twist is held for dt seconds and the pose moves along its tangent; "arc": the twist is held and
    the pose moves along the exact arc; "continuous": the law acts all the time, (rho, alpha, theta) is integrated with an error
    control (Dormand-Prince 8(5,3), relative tolerance 1e-10) and recorded every dt seconds and at the moment of arrival.
    "euler" and "arc" see alpha and theta in (-pi, pi] at each sample; in "continuous" they never jump.
    wheel_lag: s; with method "continuous" the wheels start at rest and follow the command (after the limits) as first-order systems with
    this time constant, v' = (v_wanted - v)/wheel_lag and likewise omega, integrated by LSODA; the run's v and omega are then what the
    wheels do. That is an inner loop of bandwidth 1/wheel_lag rad/s. 0: wheels that follow at once.

    Raises ValueError for arguments that are not as described: a non-finite pose, dt or duration not positive, dt > duration, more
    than ten million samples, a negative radius or lag, a lag with another method than "continuous" or without an arrival radius (on the
    goal itself a robot that still rolls has no line of sight), an unknown law or method.
    """
    begin, end = single_pose("start", start), single_pose("goal", goal)
    tuning, code = tuning_of(gains, law, POSE_LAWS)
    samples, dt = sample_count(dt, duration), float(dt)
    arrival_radius = scalar("arrival_radius", arrival_radius, low=0.0)
    limits, lag = checked_wheels(wheels), scalar("wheel_lag", wheel_lag, low=0.0)
    continuously = choice("method", method, _METHODS) == "continuous"
    if lag and not (continuously and arrival_radius):
        raise ValueError(
            f'wheel_lag = {lag:g} is not allowed: 0, or method "continuous" with an arrival radius, is needed'
        )
    if continuously:
        t, record, outcome = continuous.to_goal(
            begin, end, tuning, code, limits, dt * np.arange(samples), arrival_radius, lag
        )
    else:
        reference, record = np.zeros((5, samples)), np.empty((9, samples))
        reference[0], reference[1], reference[2] = end
        count, outcome = plane.drive(
            tuple(begin),
            reference,
            tuning,
            code,
            limits,
            _STEPS[method],
            dt,
            arrival_radius,
            record,
        )
        record, t = record[:, :count], dt * np.arange(count)
    return _trajectory(t, record, outcome, end, gains, law, method)


def track(
    reference: Callable[[np.ndarray], Reference],
    start: Pose,
    gains,
    *,
    law: str = "corrected",
    method: str = "arc",
    dt: float = 0.1,
    duration: float = 60.0,
    wheels: WheelLimits | None = None,
) -> Trajectory:
    """Follow a moving goal from `start` for `duration` seconds.

    reference: a function of an array of times [s] that returns a Reference of arrays (x, y in m, heading in rad, v in m/s, omega in
    rad/s), such as `paper.circle`. gains: of the law, see `tracking_law`; "kanayama" and "linear" use the reference's twist, the others do
    not. method, dt, wheels and errors as in `simulate`, but that "continuous" integrates the pose.
    """
    begin = single_pose("start", start)
    tuning, code = tuning_of(gains, law, TRACKING_LAWS)
    samples, dt = sample_count(dt, duration), float(dt)
    limits = checked_wheels(wheels)
    t = dt * np.arange(samples)

    def path_at(times: np.ndarray) -> np.ndarray:
        rows = zip(
            Reference._fields, instance("reference(t)", reference(times), Reference), strict=True
        )
        return np.array(
            [
                np.broadcast_to(real(f"reference(t).{name}", values), times.shape)
                for name, values in rows
            ]
        )

    path = path_at(t)
    if choice("method", method, _METHODS) == "continuous":
        record, outcome = continuous.after_reference(path_at, begin, path, tuning, code, limits, t)
    else:
        record = np.empty((9, samples))
        count, outcome = plane.drive(
            tuple(begin), path, tuning, code, limits, _STEPS[method], dt, -1.0, record
        )
        record = record[:, :count]
    count, path.flags.writeable = record.shape[1], False
    outcome = rows.COMPLETED if outcome == rows.TIMED_OUT else outcome
    return _trajectory(t[:count], record, outcome, Pose(*path[:3, :count]), gains, law, method)


def _trajectory(t, record, outcome, goal, gains, law, method) -> Trajectory:
    t.flags.writeable = record.flags.writeable = False
    return Trajectory(t, *record, _OUTCOMES[outcome], goal, gains, law, method)
