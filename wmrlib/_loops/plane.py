"""Sampled control in the plane: the twist is held from one sample to the next, as in the paper."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from wmrlib._compile import compiled, formula
from wmrlib._loops import rows, sight
from wmrlib._loops.polar import steered
from wmrlib._vecmath import BETWEEN_DIRECTIONS, NEAREST, vectorised, widest_vectors
from wmrlib.gains import NO_LIMITS, GainsFields
from wmrlib.laws import OTHERS, command, lyapunov_value_of, saturation_scale
from wmrlib.motion import arc_step, euler_step, polar_from_pose, wrap

EULER, ARC = range(2)
STEPS = {"arc": ARC, "euler": EULER}
BLOCK = 256  # runs side by side: a power of two whose block stays in the first-level cache
_VECTORS = 32  # the runs in use are rounded up to it: what is left over would not be vectorised
_ROUNDS = 16  # steps between two looks at who has finished
# The rows of a block. LEFT is the number of steps to go, and its sign turns on arrival; the last
# three are what a step has seen, and what it then commands.
X, Y, HEADING, GOAL_X, GOAL_Y, GOAL_HEADING, K_RHO, K_ALPHA, H, V_MAX = range(10)  # as in a sweep
LEFT, PEAK, LENGTH, RHO, ALPHA, THETA, ROWS = range(10, 17)
V, OMEGA = ALPHA, THETA


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


_seen_from, _moved = vectorised(polar_from_pose, BETWEEN_DIRECTIONS), vectorised(move)


@compiled
def drive(record, start, reference, tuning, law, wheels, step, dt, arrival_radius, eyes=None):
    """Record one run after the goal in column k of `reference`, or its last.

    Returns (samples, outcome, largest |omega|, metres rolled). Stops on arrival; a negative radius
    never arrives, so a reference is followed to its end. With `eyes` (a receiver, and the key to
    its random numbers) the robot steers by what is shown, and stops where that is near enough.
    """
    pose, peak, length, rolled = (start[0], start[1], wrap(start[2])), 0.0, 0.0, 0.0
    for k in range(record.shape[0]):
        now = min(k, reference.shape[1] - 1)
        goal = reference[rows.X, now], reference[rows.Y, now], reference[rows.HEADING, now]
        goal_twist = reference[rows.GOAL_V, now], reference[rows.GOAL_OMEGA, now]
        rho, alpha, theta, v, omega = observe(pose, goal, goal_twist, tuning, law, wheels)
        seen = rho
        if eyes is not None:
            record[k, rows.X], record[k, rows.Y], record[k, rows.HEADING] = pose
            place = sight.shown(record, k, *eyes)
            seen, _, _, v, omega = observe(place, goal, goal_twist, tuning, law, wheels)
        rows.write(record.T, k, pose, (rho, alpha, theta), v, omega)
        record[k, rows.LYAPUNOV] = lyapunov_value_of(rho, alpha, theta, tuning, law)
        if not math.isfinite(rho + v + omega):
            return k, rows.DIVERGED, peak, length
        peak, length = max(peak, abs(omega)), length + rolled
        if seen <= arrival_radius:
            return k + 1, rows.ARRIVED, peak, length
        pose, rolled = move(pose, v, omega, dt, step), dt * abs(v)
    return record.shape[0], rows.TIMED_OUT, peak, length


@formula
def hold(block, used, step, law, wheels, dt, arrival_radius):
    """Hold the twist of each run for one step, unless it is over or has arrived.

    In three loops, because a processor has too few registers for all their constants at once, and
    too little foresight to begin the next runs before the end of a long step.
    """
    for i in range(used):
        pose = block[X, i], block[Y, i], block[HEADING, i]
        seen = _seen_from(*pose, block[GOAL_X, i], block[GOAL_Y, i], block[GOAL_HEADING, i])
        block[RHO, i], block[ALPHA, i], block[THETA, i] = seen
    for i in range(used):
        gains = GainsFields(block[K_RHO, i], block[K_ALPHA, i], block[H, i], block[V_MAX, i])
        seen = block[RHO, i], block[ALPHA, i], block[THETA, i]
        v_over_rho, omega = steered(seen, (gains, law, wheels))
        left, peak = block[LEFT, i], block[PEAK, i]
        taken = (left > 0.0) & (seen[0] > arrival_radius)
        v, omega = (v_over_rho * seen[0] if taken else 0.0), (omega if taken else 0.0)
        block[V, i], block[OMEGA, i] = v, omega
        block[LEFT, i] = left - 1.0 if taken else -abs(left)
        block[PEAK, i] = abs(omega) if abs(omega) > peak else peak
        block[LENGTH, i] += dt * abs(v)
    for i in range(used):
        pose = block[X, i], block[Y, i], block[HEADING, i]
        new = _moved(pose, block[V, i], block[OMEGA, i], dt, step)
        block[X, i], block[Y, i], block[HEADING, i] = new


@lru_cache
def loop_of(step, law, limited):
    """The loop that takes every run to its end, or to its last step, for one method and law.

    Each is compiled by itself: asking for the law in every step would cost more than the step, and
    wheels without a limit a division. A run that is over gives its place to the next.
    """

    def loop(states, wheels, dt, arrival_radius):
        widest_vectors()
        block, inside = np.zeros((states.shape[0], BLOCK)), np.zeros(BLOCK, np.int64)
        limits = wheels if limited else NO_LIMITS
        waiting = width = 0
        while True:
            width, waiting = rows.exchange(states, block, inside, width, waiting, LEFT)
            if width == 0:
                return
            used = min(BLOCK, (width + _VECTORS - 1) // _VECTORS * _VECTORS)
            for _ in range(_ROUNDS):
                hold(block, used, step, law, limits, dt, arrival_radius)

    return compiled(loop)


@compiled
def conclude(states, runs, records, law, wheels, step, dt, samples, arrival_radius, receivers, key):
    """Sum up each run; those that were left out, or ended without a number, are driven alone."""
    summary = np.empty((rows.DISTANCE + 1, runs.shape[1]))
    run, reference = np.empty((samples, rows.LYAPUNOV + 1)), np.zeros((rows.GOAL_OMEGA + 1, 1))
    for i in range(runs.shape[1]):
        start, goal, gains = rows.run_of(runs, i)
        pose = states[X, i], states[Y, i], states[HEADING, i]
        left, peak, length = states[LEFT, i], states[PEAK, i], states[LENGTH, i]
        loop = (gains, *OTHERS), law, wheels
        rho, alpha, theta, v, omega = observe(pose, goal, (0.0, 0.0), *loop)
        last, arrived = samples - 1 - int(abs(left)), rho <= arrival_radius
        outcome, peak = rows.ARRIVED if arrived else rows.TIMED_OUT, max(peak, abs(omega))
        known = last > 0 and math.isfinite(rho + v + omega) and (arrived or left == 0.0)
        if not known:
            reference[rows.X, 0], reference[rows.Y, 0], reference[rows.HEADING, 0] = goal
            how = *loop, step, dt, arrival_radius
            eyes = None if key is None else (receivers[:, i], key)
            count, outcome, peak, length = drive(run, start, reference, *how, eyes)
            last = max(count - 1, 0)
            for k in range(min(count, records.shape[2])):
                for row in range(rows.LYAPUNOV):
                    records[row, i, k] = run[k, row]
            rho, alpha, theta = run[last, rows.RHO : rows.V]
        rows.summarise(summary, i, outcome, last * dt, wrap(theta - alpha), peak, length, rho)
    return summary


def survey(runs, law, wheels, step, dt, samples, arrival_radius, recorded, *key):
    """Sum up many runs to goals that stand still; their samples too, NaN after each one's end.

    With a key to random numbers, a receiver and the run's number are below each run.
    """
    receivers, wrong = sight.in_samples(runs[LEFT:], dt, samples) if key else (runs[LEFT:], False)
    states = np.zeros((ROWS, runs.shape[1]))
    states[:LEFT] = runs[:LEFT]
    states[LEFT] = np.where(recorded | wrong, -samples, samples - 1.0)  # negative: left out
    loop = loop_of(step, law, math.isfinite(wheels.max_speed))
    loop(states, wheels, dt, max(arrival_radius, NEAREST))
    records = np.full((rows.LYAPUNOV, runs.shape[1], samples if recorded else 0), np.nan)
    how = law, wheels, step, dt, samples, arrival_radius, receivers, key or None
    return conclude(states, runs[:LEFT], records, *how), records
