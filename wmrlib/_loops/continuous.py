"""The law acting all the time, integrated with error control: the sampled loops' touchstone."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from wmrlib._loops import plane, polar, rows
from wmrlib.kinematics import PolarError, Pose, polar_error, pose_from_polar, wrap_angle
from wmrlib.laws import command, lyapunov_value_of, saturation_scale

_TOLERANCE = {"rtol": 1e-10, "atol": 1e-12}


def to_goal(start, goal, tuning, law, wheels, t, arrival_radius, lag):
    """(t, record, outcome) of one run in (rho, alpha, theta), at the times `t` and on arrival.

    With a lag the state is (rho, alpha, theta, v, omega), from rest, and the record's v and omega
    are what the wheels do.
    """
    loop = tuning.pose, law, wheels

    def rate(_, state):
        state = tuple(state)
        if lag:
            return polar.lagging_loop(state[:3], *state[3:], loop, lag)
        return polar.closed_loop(state, loop)[:3]

    def left_to_go(_, state):
        return state[0] - arrival_radius

    event: Any = left_to_go if arrival_radius > 0.0 else None
    if event:
        event.terminal = True
        event.direction = -1.0
    first = polar_error(start, goal)
    begin = (*first, 0.0, 0.0) if lag else first
    if first.rho <= arrival_radius:
        t, states, outcome = t[:1], np.array(begin)[:, None], rows.ARRIVED
    else:
        run, outcome = _integrated(rate, begin, t, "LSODA" if lag else "DOP853", event)
        t, states = run.t, run.y
        if run.status == 1:  # the event: its moment is the last sample
            t, outcome = np.append(t, run.t_events[0]), rows.ARRIVED
            states = np.hstack([states, run.y_events[0].T])
    states[0] = np.maximum(states[0], 0.0)  # rounding can carry rho a hair past the goal
    record = np.empty((9, t.size))
    record[: rows.RHO] = pose_from_polar(PolarError(*states[:3]), goal)
    record[rows.RHO : rows.V] = states[:3]
    _add_commands(record, np.zeros((2, t.size)), tuning, law, wheels)
    if lag:
        record[rows.V : rows.LYAPUNOV] = states[3:]
    return t, record, outcome


def after_reference(path_at, start, path, tuning, law, wheels, t):
    """(record, outcome) of one run after a moving reference, integrated in (x, y, heading).

    In the plane, because there the line of sight may pass through zero distance.
    """

    def rate(time, pose):
        x, y, heading, *twist = path_at(np.array([time]))[:, 0]
        _, _, _, v, omega = plane.observe(
            tuple(pose), (x, y, heading), tuple(twist), tuning, law, wheels
        )
        return v * math.cos(pose[2]), v * math.sin(pose[2]), omega

    run, outcome = _integrated(rate, start, t, "DOP853")
    path = path[:, : run.t.size]
    pose, record = Pose(*run.y), np.empty((9, run.t.size))
    record[: rows.RHO] = pose._replace(heading=wrap_angle(pose.heading))
    record[rows.RHO : rows.V] = polar_error(pose, Pose(*path[:3]))
    _add_commands(record, path[3:], tuning, law, wheels)
    return record, outcome


def _integrated(rate, begin, t, method, event=None):
    """The run with error control, and how it ends; LSODA is quicker where a lag is short."""
    from scipy.integrate import solve_ivp  # here, because importing it takes longer than all else

    span = 0.0, t[-1]
    run = solve_ivp(rate, span, begin, method, t_eval=t, events=event, **_TOLERANCE)
    return run, rows.TIMED_OUT if run.success else rows.DIVERGED


def _add_commands(record, goal_twist, tuning, law, wheels) -> None:
    """Fill in what the law commands at each recorded state, and V."""
    for k in range(record.shape[1]):
        rho, alpha, theta = record[rows.RHO : rows.V, k]
        v, omega = command(rho, alpha, theta, *goal_twist[:, k], tuning, law)
        share = saturation_scale(v, omega, wheels)
        record[rows.V, k], record[rows.OMEGA, k] = share * v, share * omega
        record[rows.LYAPUNOV, k] = lyapunov_value_of(rho, alpha, theta, tuning, law)
