"""Sampled control of many runs side by side, with ideal wheels and nothing recorded.

2.7 ns a step of a run on one core, where `loops.held` takes 60.
"""

from __future__ import annotations

import math

import numpy as np

from wmrlib import motion
from wmrlib.body import NO_TURN
from wmrlib.compilation import compiled, formula
from wmrlib.elementary import wrap
from wmrlib.engine import lanes
from wmrlib.engine.vectors import BETWEEN_DIRECTIONS, NEAREST, vectorised
from wmrlib.gains import GainsFields
from wmrlib.loops import DISTANCE, OUTCOME, WHEELS, held_runs, steer, summarise
from wmrlib.motion import polar_from_pose
from wmrlib.runs import ARRIVED, TIMED_OUT

BLOCK = 256  # runs side by side: a power of two whose block stays in the first-level cache
VECTORS = 32  # the runs in use are rounded up to it, because a remainder is not vectorised
_ROUNDS = 16  # steps between two checks for runs that have ended
# The rows of a block, one column a run. The first are those of a sweep. LEFT is the number of steps
# to go; its sign turns when the run is over. GOING says whether this step is taken.
X, Y, HEADING, GOAL_X, GOAL_Y, GOAL_HEADING, K_RHO, K_ALPHA, H, V_MAX = range(WHEELS)
LEFT, PEAK, LENGTH, RHO, ALPHA, THETA, V, OMEGA, GOING, ROWS = range(WHEELS, WHEELS + 10)

_polar_from_pose = vectorised(motion.polar_from_pose, BETWEEN_DIRECTIONS)
_euler_step, _arc_step = vectorised(motion.euler_step), vectorised(motion.arc_step)


# A step is three loops, because a processor has too few registers for all their constants at once,
# and too little foresight to begin the next runs before the end of a long step.


@formula
def observe(block, used):
    """Compute the polar error of each pose."""
    for i in range(used):
        pose = block[X, i], block[Y, i], block[HEADING, i]
        goal = block[GOAL_X, i], block[GOAL_Y, i], block[GOAL_HEADING, i]
        block[RHO, i], block[ALPHA, i], block[THETA, i] = _polar_from_pose(*pose, *goal)


@formula
def decide(block, used, law, limits, dt, arrival_radius):
    """Compute the twist of each run; a run that has ended or arrived takes no step."""
    for i in range(used):
        gains = GainsFields(block[K_RHO, i], block[K_ALPHA, i], block[H, i], block[V_MAX, i])
        polar = block[RHO, i], block[ALPHA, i], block[THETA, i]
        v_over_rho, omega = lanes.steered(polar, gains, law, limits)
        v, left, peak = v_over_rho * polar[0], block[LEFT, i], block[PEAK, i]
        length = block[LENGTH, i]  # all loads first: one between stores costs 0.4 ns a step
        going = (left > 0.0) & (polar[0] > arrival_radius)
        block[V, i], block[OMEGA, i], block[GOING, i] = v, omega, (1.0 if going else 0.0)
        block[PEAK, i] = abs(omega) if (left >= 0.0) & (abs(omega) > peak) else peak
        block[LENGTH, i] = length + (dt * abs(v) if going else 0.0)
        over = -left - 0.5 if left >= 0.0 else left  # half a step, so that 0 has a sign too
        block[LEFT, i] = left - 1.0 if going else over


@formula
def move(block, used, along_arc, dt):
    """Move each pose by one step."""
    for i in range(used):
        going, pose = block[GOING, i] > 0.0, (block[X, i], block[Y, i], block[HEADING, i])
        twist = (block[V, i] if going else 0.0), (block[OMEGA, i] if going else 0.0)
        step = _arc_step(*pose, *twist, dt) if along_arc else _euler_step(*pose, *twist, dt)
        block[X, i], block[Y, i], block[HEADING, i] = step


@compiled
def drive(states, block, inside, counts, law, limits, along_arc, dt, arrival_radius):
    """Drive every run to its end; a run that has ended gives its lane to the next."""
    while lanes.refill_lanes(states, block, inside, counts, LEFT, -0.5):
        used = min(BLOCK, (counts[0] + VECTORS - 1) // VECTORS * VECTORS)
        for _ in range(_ROUNDS):
            observe(block, used)
            decide(block, used, law, limits, dt, arrival_radius)
            move(block, used, along_arc, dt)


@compiled
def summaries(states, runs, law, limits, samples, dt, arrival_radius):
    """The summary of each run; its outcome is NaN if it ended at once or lost a number."""
    summary = np.empty((DISTANCE + 1, runs.shape[1]))
    for i in range(runs.shape[1]):
        pose = states[X, i], states[Y, i], states[HEADING, i]
        goal = runs[GOAL_X, i], runs[GOAL_Y, i], runs[GOAL_HEADING, i]
        numbers = runs[K_RHO, i], runs[K_ALPHA, i], runs[H, i], runs[V_MAX, i], 0.0, 0.0
        rho, alpha, theta = polar_from_pose(*pose, *goal)
        v, omega = steer((rho, alpha, theta), (0.0, 0.0), numbers, law, limits)
        left, peak, length = states[LEFT, i], max(states[PEAK, i], abs(omega)), states[LENGTH, i]
        last, arrived = samples - 1 - int(abs(left)), rho <= arrival_radius
        outcome = ARRIVED if arrived else TIMED_OUT
        summarise(summary, i, outcome, last * dt, wrap(theta - alpha), peak, length, rho)
        if not (math.isfinite(rho + v + omega + peak) and last > 0 and (arrived or left > -1.0)):
            summary[OUTCOME, i] = math.nan
    return summary


def survey(runs, law, limits, samples, sampling):
    """Sum up the runs in the columns of `runs`, all with the same law and wheels.

    Runs that end at once, and runs for which the vector forms of the elementary functions have
    no number, are driven again by `held_runs`.
    """
    states = np.zeros((ROWS, runs.shape[1]))
    states[:LEFT], states[LEFT] = runs[:LEFT], samples - 1.0
    ends = sampling.dt, max(sampling.arrival_radius, NEAREST)
    block, inside = np.zeros((ROWS, BLOCK)), np.zeros(BLOCK, np.int64)
    counts = np.zeros(2, np.int64)
    drive(states, block, inside, counts, lanes.law_tuple(law), limits, sampling.along_arc, *ends)
    ends = sampling.dt, sampling.arrival_radius
    summary = summaries(states, runs[:LEFT], law, limits, samples, *ends)
    again = np.flatnonzero(np.isnan(summary[OUTCOME]))
    if again.size:
        unwritten = np.empty((8, again.size, 0))
        setting = samples, NO_TURN, None, sampling
        summary[:, again] = held_runs(runs[:, again], unwritten, 0, *setting)
    return summary
