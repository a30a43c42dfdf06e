"""The law acting all the time, integrated with an error control: what the sampled loops are tested against."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from wmrlib._loops import plane, polar, rows
from wmrlib.gains import Tuning, WheelLimits
from wmrlib.kinematics import Pose, polar_error, polar_from_pose, pose_from_polar, wrap_angle
from wmrlib.laws import command, lyapunov_value_of, saturation_scale

_TOLERANCE = {"method": "DOP853", "rtol": 1e-10, "atol": 1e-12}  # Dormand and Prince, order 8
_STIFF = _TOLERANCE | {
    "method": "LSODA"
}  # for wheels whose lag is short against the rest: five times as fast there


def to_goal(
    start: Pose,
    goal: Pose,
    tuning: Tuning,
    law: int,
    wheels: WheelLimits,
    t: np.ndarray,
    arrival_radius: float,
    lag: float = 0.0,
):
    """(t, record, outcome) of one run in (rho, alpha, theta), recorded at the times `t` and at the moment of arrival.

    With a lag the state is (rho, alpha, theta, v, omega), from rest, and what is recorded of v and omega is what the wheels do.
    """
    from scipy.integrate import (
        solve_ivp,
    )  # here, because importing it takes longer than everything else

    def rate(_, state):
        if lag:
            return polar.lagging_loop(*state, tuning.pose, law, wheels, lag)
        return polar.closed_loop(*state, tuning.pose, law, wheels)[:3]

    def left_to_go(_, state):
        return state[0] - arrival_radius

    left_to_go.terminal, left_to_go.direction = True, -1.0
    first = polar_error(start, goal)
    begin = (*first, 0.0, 0.0) if lag else first
    if first.rho <= arrival_radius:
        t, states, outcome = t[:1], np.array(begin)[:, None], rows.ARRIVED
    else:
        events, accuracy = (
            left_to_go if arrival_radius > 0.0 else None,
            _STIFF if lag else _TOLERANCE,
        )
        run = solve_ivp(rate, (0.0, t[-1]), begin, t_eval=t, events=events, **accuracy)
        t, states, outcome = run.t, run.y, rows.TIMED_OUT if run.success else rows.DIVERGED
        if run.status == 1:  # the event: its moment is the last sample
            t, states, outcome = (
                np.append(t, run.t_events[0]),
                np.hstack([states, run.y_events[0].T]),
                rows.ARRIVED,
            )
    states[0] = np.maximum(states[0], 0.0)  # rounding can carry rho a hair past the goal
    record = np.empty((9, t.size))
    record[: rows.RHO] = pose_from_polar(states[:3], goal)
    record[rows.RHO : rows.V] = states[:3]
    record = _with_commands(record, np.zeros((2, t.size)), tuning, law, wheels)
    if lag:
        record[rows.V : rows.LYAPUNOV] = states[3:]
    return t, record, outcome


def after_reference(
    path_at: Callable[[np.ndarray], np.ndarray],
    start: Pose,
    path: np.ndarray,
    tuning: Tuning,
    law: int,
    wheels: WheelLimits,
    t: np.ndarray,
):
    """(record, outcome) of one run after a moving reference, in (x, y, heading): the line of sight may pass through zero distance."""
    from scipy.integrate import solve_ivp

    def rate(time, state):
        x, y, heading = state
        _, _, _, v, omega = plane.observe(
            x, y, heading, tuple(path_at(np.array([time]))[:, 0]), tuning, law, wheels
        )
        return v * math.cos(heading), v * math.sin(heading), omega

    run = solve_ivp(rate, (0.0, t[-1]), start, t_eval=t, **_TOLERANCE)
    record = np.empty((9, run.t.size))
    record[: rows.RHO] = run.y[0], run.y[1], wrap_angle(run.y[2])
    for k, (x, y, heading) in enumerate(run.y.T):
        record[rows.RHO : rows.V, k] = polar_from_pose(x, y, heading, *path[:3, k])
    return _with_commands(
        record, path[3:], tuning, law, wheels
    ), rows.TIMED_OUT if run.success else rows.DIVERGED


def _with_commands(record, reference_twist, tuning, law, wheels):
    """Fill in what the law commands at each recorded state, and V."""
    for k in range(record.shape[1]):
        rho, alpha, theta = record[rows.RHO : rows.V, k]
        v, omega = command(rho, alpha, theta, *reference_twist[:, k], tuning, law)
        share = saturation_scale(v, omega, wheels)
        record[rows.V, k], record[rows.OMEGA, k] = share * v, share * omega
        record[rows.LYAPUNOV, k] = lyapunov_value_of(rho, alpha, theta, tuning, law)
    return record
