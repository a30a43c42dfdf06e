"""Sampled control in the plane: the twist is held from one sample to the next, as in the paper."""

from __future__ import annotations

import math

import numpy as np

from wmrlib._compile import compiled
from wmrlib._loops import rows
from wmrlib.laws import command, lyapunov_value_of, pose_tuning, saturation_scale
from wmrlib.motion import arc_step, euler_step, polar_from_pose, wrap

EULER, ARC = range(2)


@compiled
def observe(pose, goal, goal_twist, tuning, law, wheels):
    """What the controller sees and commands: (rho, alpha, theta, v, omega)."""
    rho, alpha, theta = polar_from_pose(*pose, *goal)
    v, omega = command(rho, alpha, theta, *goal_twist, tuning, law)
    share = saturation_scale(v, omega, wheels)
    return rho, alpha, theta, share * v, share * omega


@compiled
def move(pose, v, omega, dt, step):
    """The pose after dt seconds of one twist."""
    if step == ARC:
        return arc_step(*pose, v, omega, dt)
    return euler_step(*pose, v, omega, dt)


@compiled
def drive(record, start, reference, tuning, law, wheels, step, dt, arrival_radius):
    """Record one run after the goal in column k of `reference`, or its last: (samples, outcome).

    Stops on arrival; a negative radius never arrives, so a reference is followed to its end.
    """
    pose = start[0], start[1], wrap(start[2])
    for k in range(record.shape[0]):
        now = min(k, reference.shape[1] - 1)
        goal = reference[rows.X, now], reference[rows.Y, now], reference[rows.HEADING, now]
        goal_twist = reference[rows.GOAL_V, now], reference[rows.GOAL_OMEGA, now]
        rho, alpha, theta, v, omega = observe(pose, goal, goal_twist, tuning, law, wheels)
        value = lyapunov_value_of(rho, alpha, theta, tuning, law)
        record[k, rows.X], record[k, rows.Y], record[k, rows.HEADING] = pose
        record[k, rows.RHO], record[k, rows.ALPHA], record[k, rows.THETA] = rho, alpha, theta
        record[k, rows.V], record[k, rows.OMEGA], record[k, rows.LYAPUNOV] = v, omega, value
        if not math.isfinite(rho + v + omega):
            return k, rows.DIVERGED
        if rho <= arrival_radius:
            return k + 1, rows.ARRIVED
        pose = move(pose, v, omega, dt, step)
    return record.shape[0], rows.TIMED_OUT


@compiled
def survey(runs, law, wheels, step, dt, samples, arrival_radius, recorded):
    """Sum up many runs to goals that stand still; their samples too, NaN after each one's end."""
    summary = np.empty((rows.DISTANCE + 1, runs.shape[1]))
    records = np.full((rows.LYAPUNOV, runs.shape[1], samples if recorded else 0), np.nan)
    run = np.empty((samples, rows.LYAPUNOV + 1))
    reference = np.zeros((rows.GOAL_OMEGA + 1, 1))
    for i in range(runs.shape[1]):
        start, goal, gains = rows.run_of(runs, i)
        reference[: rows.GOAL_V, 0] = goal
        loop = pose_tuning(*gains), law, wheels, step, dt, arrival_radius
        count, outcome = drive(run, start, reference, *loop)
        last, peak, length = max(count - 1, 0), 0.0, 0.0
        for k in range(count):
            peak = max(peak, abs(run[k, rows.OMEGA]))
            length += abs(run[k, rows.V]) * dt if k < last else 0.0
        rho, alpha, theta = run[last, rows.RHO : rows.V]
        rows.summarise(summary, i, outcome, last * dt, wrap(theta - alpha), peak, length, rho)
        if recorded:
            records[:, i, :count] = run[:count, : rows.LYAPUNOV].T
    return summary, records
