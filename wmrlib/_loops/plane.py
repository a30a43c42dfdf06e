"""The compiled loops over time, and nothing else: the formulas they call stand in `kinematics` and `control`."""

from __future__ import annotations

import math

from wmrlib._compile import compiled
from wmrlib._loops.rows import (
    ALPHA,
    ARRIVED,
    DIVERGED,
    HEADING,
    LYAPUNOV,
    OMEGA,
    RHO,
    THETA,
    TIMED_OUT,
    V,
    X,
    Y,
)
from wmrlib.kinematics import arc_step, euler_step, polar_from_pose, wrap
from wmrlib.laws import command, lyapunov_value_of, pose_tuning, saturation_scale

EULER, ARC = range(2)


@compiled
def observe(x, y, heading, goal, tuning, law, wheels):
    """What the controller sees and what it commands: (rho, alpha, theta, v, omega). `goal` is (x, y, heading, v, omega)."""
    rho, alpha, theta = polar_from_pose(x, y, heading, goal[0], goal[1], goal[2])
    v, omega = command(rho, alpha, theta, goal[3], goal[4], tuning, law)
    share = saturation_scale(v, omega, wheels)
    return rho, alpha, theta, share * v, share * omega


@compiled
def move(x, y, heading, v, omega, dt, step):
    return (
        arc_step(x, y, heading, v, omega, dt)
        if step == ARC
        else euler_step(x, y, heading, v, omega, dt)
    )


@compiled
def drive(start, reference, tuning, law, wheels, step, dt, arrival_radius, record):
    """One run: column k of `record` is the state at k dt, towards column k of `reference`. Returns (samples, outcome).

    Stops on arrival; a negative radius never arrives, which is how a moving reference is followed to the end.
    """
    x, y, heading = start
    for k in range(record.shape[1]):
        goal = reference[0, k], reference[1, k], reference[2, k], reference[3, k], reference[4, k]
        rho, alpha, theta, v, omega = observe(x, y, heading, goal, tuning, law, wheels)
        if not math.isfinite(rho + v + omega):
            return k, DIVERGED
        record[X, k], record[Y, k], record[HEADING, k] = x, y, heading
        record[RHO, k], record[ALPHA, k], record[THETA, k] = rho, alpha, theta
        record[V, k], record[OMEGA, k] = v, omega
        record[LYAPUNOV, k] = lyapunov_value_of(rho, alpha, theta, tuning, law)
        if rho <= arrival_radius:
            return k + 1, ARRIVED
        x, y, heading = move(x, y, heading, v, omega, dt, step)
    return record.shape[1], TIMED_OUT


@compiled
def survey(runs, law, wheels, step, dt, samples, arrival_radius, summary):
    """Many runs to goals that stand still. Column i of `runs`: start x, y, heading, goal x, y, heading, k_rho, k_alpha, h, v_max.

    Column i of `summary`: outcome, time and heading error at the last sample, peak |omega|, path length, distance left.
    """
    for i in range(runs.shape[1]):
        x, y, heading = runs[0, i], runs[1, i], runs[2, i]
        goal = runs[3, i], runs[4, i], runs[5, i], 0.0, 0.0
        tuning = pose_tuning(runs[6, i], runs[7, i], runs[8, i], runs[9, i])
        outcome, last, peak, length, rho, alpha, theta = TIMED_OUT, 0, 0.0, 0.0, 0.0, 0.0, 0.0
        for k in range(samples):
            seen = observe(x, y, heading, goal, tuning, law, wheels)
            if not math.isfinite(seen[0] + seen[3] + seen[4]):
                outcome = DIVERGED
                break
            last, (rho, alpha, theta, v, omega) = k, seen
            peak = max(peak, abs(omega))
            if rho <= arrival_radius:
                outcome = ARRIVED
                break
            if k + 1 < samples:
                length += abs(v) * dt
            x, y, heading = move(x, y, heading, v, omega, dt, step)
        summary[0, i], summary[1, i], summary[2, i] = outcome, last * dt, wrap(theta - alpha)
        summary[3, i], summary[4, i], summary[5, i] = peak, length, rho
