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
def drive(start, reference, tuning, law, wheels, step, dt, arrival_radius):
    """One run after the goal in column k of `reference` at k dt: (record, outcome).

    Stops on arrival; a negative radius never arrives, so a reference is followed to its end.
    """
    pose = start[0], start[1], wrap(start[2])
    record = np.empty((rows.LYAPUNOV + 1, reference.shape[1]))
    for k in range(reference.shape[1]):
        goal = reference[rows.X, k], reference[rows.Y, k], reference[rows.HEADING, k]
        goal_twist = reference[rows.GOAL_V, k], reference[rows.GOAL_OMEGA, k]
        rho, alpha, theta, v, omega = observe(pose, goal, goal_twist, tuning, law, wheels)
        if not math.isfinite(rho + v + omega):
            return record[:, :k], rows.DIVERGED
        record[rows.X, k], record[rows.Y, k], record[rows.HEADING, k] = pose
        record[rows.RHO, k], record[rows.ALPHA, k], record[rows.THETA, k] = rho, alpha, theta
        record[rows.V, k], record[rows.OMEGA, k] = v, omega
        record[rows.LYAPUNOV, k] = lyapunov_value_of(rho, alpha, theta, tuning, law)
        if rho <= arrival_radius:
            return record[:, : k + 1], rows.ARRIVED
        pose = move(pose, v, omega, dt, step)
    return record[:, :], rows.TIMED_OUT


@compiled
def survey(runs, law, wheels, step, dt, samples, arrival_radius):
    """Sum up many runs to goals that stand still, without recording them."""
    summary = np.empty((rows.DISTANCE + 1, runs.shape[1]))
    for i in range(runs.shape[1]):
        start, goal, gains = rows.run_of(runs, i)
        pose, tuning = (start[0], start[1], wrap(start[2])), pose_tuning(*gains)
        outcome, last, peak, length = rows.TIMED_OUT, 0, 0.0, 0.0
        rho, alpha, theta = polar_from_pose(*pose, *goal)
        for k in range(samples):
            seen = observe(pose, goal, (0.0, 0.0), tuning, law, wheels)
            broken = not math.isfinite(seen[0] + seen[3] + seen[4])
            if k == 0 or not broken:
                last, (rho, alpha, theta, v, omega) = k, seen
            if broken:
                outcome = rows.DIVERGED
                break
            peak = max(peak, abs(omega))
            if rho <= arrival_radius:
                outcome = rows.ARRIVED
                break
            if k + 1 < samples:
                length += abs(v) * dt
            pose = move(pose, v, omega, dt, step)
        rows.summarise(summary, i, outcome, last * dt, wrap(theta - alpha), peak, length, rho)
    return summary


@compiled
def record(runs, law, wheels, step, dt, samples, arrival_radius):
    """The same runs sample by sample, NaN after each one's end."""
    records = np.full((rows.LYAPUNOV, runs.shape[1], samples), np.nan)
    reference = np.zeros((rows.GOAL_OMEGA + 1, samples))
    for i in range(runs.shape[1]):
        start, goal, gains = rows.run_of(runs, i)
        for row in range(3):
            reference[row] = goal[row]
        tuning = pose_tuning(*gains)
        run, _ = drive(start, reference, tuning, law, wheels, step, dt, arrival_radius)
        records[:, i, : run.shape[1]] = run[: rows.LYAPUNOV]
    return records
