"""Many runs of the polar closed loop, side by side in blocks, from their poses to their sums.

A run that is over gives its place to the next. `whole` is how many steps a run is given.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from wmrlib._compile import compiled
from wmrlib._loops import polar, rows
from wmrlib._loops.polar import EULER, closed_loop, finite, last_step, one_step
from wmrlib._vecmath import widest_vectors
from wmrlib.gains import NO_LIMITS
from wmrlib.motion import polar_from_pose, pose_of_error, wrap

BLOCK = 256  # runs side by side: a power of two whose block stays in the first-level cache
_VECTORS = 32  # the runs in use are rounded up to it: what is left over would not be vectorised
_ROUNDS = 16  # steps between two looks at who has finished


@compiled
def begin(runs, law, wheels, whole, arrival_radius):
    """The state of each run at its beginning, with the rows of a block."""
    states = np.empty((polar.ROWS, runs.shape[1]))
    states[polar.K_RHO : polar.ROWS] = runs[-4:]
    for i in range(runs.shape[1]):
        start, goal, gains = rows.run_of(runs, i)
        at, loop = polar_from_pose(*start, *goal), (gains, law, wheels)
        left = whole if at[0] > arrival_radius else -whole
        for row, value in enumerate((*at, left, abs(closed_loop(at, loop)[4]), 0.0)):
            states[row, i] = value
    return states


@lru_cache
def survey_of(method, law, limited, advance=polar.advance):
    """The loop that takes every run to its end, or to its last step, for one method and law.

    Each is compiled by itself: asking for the law in every step would cost more than the step.
    """

    def survey(states, wheels, dt, arrival_radius):
        widest_vectors()
        limits = wheels if limited else NO_LIMITS
        block, inside = np.zeros((states.shape[0], BLOCK)), np.zeros(BLOCK, np.int64)
        waiting = width = 0
        while True:
            width, waiting = rows.exchange(states, block, inside, width, waiting, polar.LEFT)
            if width == 0:
                return
            used = min(BLOCK, (width + _VECTORS - 1) // _VECTORS * _VECTORS)
            for _ in range(_ROUNDS):
                advance(block, used, method, law, limits, dt, arrival_radius)

    return compiled(survey)


@compiled
def conclude(states, law, wheels, method, dt, whole, arrival_radius):
    """Sum up each run; a fixed step in which it arrives is shortened to end on the radius."""
    summary = np.empty((rows.DISTANCE + 1, states.shape[1]))
    for i in range(states.shape[1]):
        at, left, peak, length, gains = polar.read(states, i)
        loop = gains, law, wheels
        outcome, time = rows.TIMED_OUT, (whole - abs(left)) * dt
        now, _, turning = one_step(EULER, at, loop, 0.0)
        started_there = left == -whole and at[0] <= arrival_radius
        if not finite(now):
            outcome = rows.DIVERGED
        elif started_there:
            outcome = rows.ARRIVED
        elif left < 0.0:
            outcome = rows.DIVERGED
            if arrival_radius > 0.0 and finite(one_step(method, at, loop, dt)[0]):
                outcome, tau = rows.ARRIVED, last_step(method, at, loop, dt, arrival_radius)
                at, rolled, _ = one_step(method, at, loop, tau)
                turning = max(turning, one_step(method, at, loop, 0.0)[2])
                time, length = time + tau, length + rolled
        peak = max(peak, turning)
        rows.summarise(summary, i, outcome, time, wrap(at[2] - at[1]), peak, length, at[0])
    return summary


@compiled
def note(records, k, runs, states, law, wheels):
    """Record sample k of each run."""
    for i in range(runs.shape[1]):
        _, goal, _ = rows.run_of(runs, i)
        at, left, _, _, gains = polar.read(states, i)
        if left < 0.0 and k > 0:
            continue
        _, _, _, v, omega = closed_loop(at, (gains, law, wheels))
        rows.write(records[:, i], k, pose_of_error(*at, *goal), at, v, omega)


def survey(runs, law, wheels, method, dt, samples, arrival_radius, recorded):
    """As `plane.survey`; the last sample is the one before arrival."""
    whole, drive = samples - 1.0, survey_of(method, law, wheels.max_speed < math.inf)
    states = begin(runs, law, wheels, whole, arrival_radius)
    drive(states, wheels, dt, arrival_radius)
    summary = conclude(states, law, wheels, method, dt, whole, arrival_radius)
    records = np.full((rows.LYAPUNOV, runs.shape[1], samples if recorded else 0), np.nan)
    states = begin(runs, law, wheels, 1.0, arrival_radius)
    for k in range(records.shape[2]):
        note(records, k, runs, states, law, wheels)
        going = states[polar.LEFT] >= 0.0
        if not going.any():
            break
        states[polar.LEFT, going] = 1.0
        drive(states, wheels, dt, arrival_radius)
    return summary, records
