"""Sampled control for runs side by side: the twist is held from one sample to the next."""

from __future__ import annotations

import math

import numpy as np

from wmrlib import motion
from wmrlib.body import at_rest, last_turn, roll
from wmrlib.compilation import compiled, formula
from wmrlib.elementary import wrap
from wmrlib.engine import lanes, receivers
from wmrlib.engine.vectors import BETWEEN_DIRECTIONS, NEAREST, vectorised
from wmrlib.gains import GainsFields
from wmrlib.laws import saturation_scale
from wmrlib.loops import held, steer
from wmrlib.motion import keep_branch, polar_from_pose
from wmrlib.runs import ARRIVED, DIVERGED, TIMED_OUT

BLOCK = 256  # runs side by side: a power of two whose block stays in the first-level cache
VECTORS = 32  # the runs in use are rounded up to it: what is left over would not be vectorised
_ROUNDS = 16  # steps between two looks at who has finished
# The rows of a block. LEFT is the number of steps to go, and its sign turns on arrival, which HERE
# notes. GOING says whether the step is taken, and ALIVE whether the sample is one of the run's. The
# pose that is seen is the receiver's, where there is one.
X, Y, HEADING, GOAL_X, GOAL_Y, GOAL_HEADING, K_RHO, K_ALPHA, H, V_MAX = range(10)  # as in a sweep
LEFT, PEAK, LENGTH, RHO, ALPHA, THETA, V, OMEGA, GOING, ALIVE, HERE = range(10, 21)
SEEN = HERE + 1
BRANCH = SEEN + 3  # with hysteresis, theta as it is, and below it as it is seen
TURNING, BODY = BRANCH + 2, BRANCH + 3
ROWS = BODY + 4

_polar_from_pose = vectorised(motion.polar_from_pose, BETWEEN_DIRECTIONS)
_euler_step, _arc_step = vectorised(motion.euler_step), vectorised(motion.arc_step)


# A step is three loops, because a processor has too few registers for all their constants at once,
# and too little foresight to begin the next runs before the end of a long step.


@formula
def look(block, used, place, branch, hysteresis):
    """See the goal from the pose in the rows from `place` on.

    No hysteresis is None, by whose type numba leaves out what it would cost.
    """
    for i in range(used):
        pose = block[place, i], block[place + 1, i], block[place + 2, i]
        goal = block[GOAL_X, i], block[GOAL_Y, i], block[GOAL_HEADING, i]
        rho, alpha, theta = _polar_from_pose(*pose, *goal)
        if hysteresis is not None:
            theta = block[branch, i] = keep_branch(theta, block[branch, i], hysteresis)
        block[RHO, i], block[ALPHA, i], block[THETA, i] = rho, alpha, theta


@formula
def decide(block, used, law, wheels, dt, arrival_radius, motors, end):
    """What each run commands; a run that is over, or has arrived, takes no step.

    Ideal wheels and no last turn are None, which costs nothing, as without hysteresis.
    """
    for i in range(used):
        gains = GainsFields(block[K_RHO, i], block[K_ALPHA, i], block[H, i], block[V_MAX, i])
        polar = block[RHO, i], block[ALPHA, i], block[THETA, i]
        v_over_rho, omega = lanes.steered(polar, gains, law, wheels)
        v, left, peak = v_over_rho * polar[0], block[LEFT, i], block[PEAK, i]
        length, here = block[LENGTH, i], block[HERE, i]  # all first: loads between stores are slow
        done, far = polar[0] <= arrival_radius, polar[0] > arrival_radius
        if end is not None:
            turn = *polar, v, omega, block[TURNING, i], arrival_radius, dt, end
            v, omega, block[TURNING, i], done = last_turn(*turn)
            omega, far = omega * saturation_scale(v, omega, wheels), not done
        if motors is not None:
            rows = block[BODY, i], block[BODY + 1, i], block[BODY + 2, i], block[BODY + 3, i]
            done = done and (end is None or at_rest(rows))
            v, omega, rows = roll(v, omega, rows, motors, dt)
            block[BODY, i], block[BODY + 1, i], block[BODY + 2, i], block[BODY + 3, i] = rows
            far = far or not done
        going, arrived = (left > 0.0) & far, (left >= 0.0) & done
        block[V, i], block[OMEGA, i], block[GOING, i] = v, omega, (1.0 if going else 0.0)
        block[PEAK, i] = abs(omega) if (left >= 0.0) & (abs(omega) > peak) else peak
        block[LENGTH, i] = length + (dt * abs(v) if going else 0.0)
        over = -left - 0.5 if left >= 0.0 else left  # half a step, so that 0 has a sign too
        block[LEFT, i] = left - 1.0 if going else over
        block[HERE, i] = 1.0 if arrived else here


@formula
def move(block, used, along_arc, dt):
    for i in range(used):
        going, pose = block[GOING, i] > 0.0, (block[X, i], block[Y, i], block[HEADING, i])
        twist = (block[V, i] if going else 0.0), (block[OMEGA, i] if going else 0.0)
        step = _arc_step(*pose, *twist, dt) if along_arc else _euler_step(*pose, *twist, dt)
        block[X, i], block[Y, i], block[HEADING, i] = step


@compiled
def drive(states, law, wheels, along_arc, dt, arrival_radius, hysteresis, motors, end):
    """Take every run to its end, or to its last step; then it gives its lane to the next."""
    block, inside = np.zeros((ROWS, BLOCK)), np.zeros(BLOCK, np.int64)
    waiting = width = 0
    while True:
        width, waiting = lanes.refill_lanes(states, block, inside, width, waiting, LEFT, -0.5)
        if width == 0:
            return
        used = min(BLOCK, (width + VECTORS - 1) // VECTORS * VECTORS)
        for _ in range(_ROUNDS):
            look(block, used, X, BRANCH, hysteresis)
            decide(block, used, law, wheels, dt, arrival_radius, motors, end)
            move(block, used, along_arc, dt)


@compiled
def drive_all(
    states, law, wheels, arc, dt, radius, hysteresis, motors, end, samples, key, records, place,
    eyes, depth,
):  # fmt: skip
    """The same, sample after sample, because each is recorded, or steered by what a receiver shows.

    `records` has an axis for the rows, one for the runs, and one for the samples.
    """
    block, past = np.zeros((ROWS, BLOCK)), np.zeros((3, depth, BLOCK))
    shown = np.zeros((receivers.ROWS, BLOCK))
    for first in range(0, states.shape[1], BLOCK):
        width = min(BLOCK, states.shape[1] - first)
        used = (width + VECTORS - 1) // VECTORS * VECTORS
        for i in range(width):
            lanes.copy_column(block, i, states, first + i)
            lanes.copy_column(shown, i, eyes, first + i)
        for k in range(samples):
            for i in range(used):
                block[ALIVE, i] = 1.0 if block[LEFT, i] >= 0.0 else 0.0
            if not block[ALIVE, :used].any():
                break
            look(block, used, X, BRANCH, hysteresis)
            if records.shape[2] > 0:
                for row, at in enumerate((X, Y, HEADING, RHO, ALPHA, THETA)):
                    _note(records[row], k, block, width, place + first, at)
            if key is not None:
                receivers.show(block, SEEN, GOAL_X, shown, past, k, used, key)
                look(block, used, SEEN, BRANCH + 1, hysteresis)
            decide(block, used, law, wheels, dt, radius, motors, end)
            if records.shape[2] > 0:
                _note(records[6], k, block, width, place + first, V)
                _note(records[7], k, block, width, place + first, OMEGA)
            move(block, used, arc, dt)
        for i in range(width):
            lanes.copy_column(states, first + i, block, i)


@formula
def _note(record, k, block, width, first, row):
    for i in range(width):
        if block[ALIVE, i] > 0.0:
            record[first + i, k] = block[row, i]


@compiled
def conclude(states, runs, law, wheels, arc, dt, radius, hysteresis, motors, end, samples, *rest):
    """Sum up each run. One that ended without a number is driven alone, by the C library.

    With a receiver it is left, because there the pose is hardly one that a receiver could show.
    """
    key, records, place = rest
    summary = np.empty((lanes.DISTANCE + 1, runs.shape[1]))
    alone, path = np.empty((8, samples)), np.zeros((5, 1))
    for i in range(runs.shape[1]):
        start, goal, gains = lanes.run_of(runs, i)
        pose = states[X, i], states[Y, i], states[HEADING, i]
        left, peak, length = states[LEFT, i], states[PEAK, i], states[LENGTH, i]
        loop = (*gains, 0.0, 0.0), len(law), wheels
        rho, alpha, theta = polar_from_pose(*pose, *goal)
        polar = rho, alpha, keep_branch(theta, states[BRANCH, i], hysteresis)
        v, omega = steer(polar, (0.0, 0.0), *loop)
        last, arrived = samples - 1 - int(abs(left)), polar[0] <= radius
        if key is not None or motors is not None or end is not None:
            arrived = states[HERE, i] > 0.0
        else:
            peak = max(peak, abs(omega))
        outcome = ARRIVED if arrived else TIMED_OUT
        known = math.isfinite(polar[0] + v + omega + peak)
        if key is not None and not known:
            outcome, peak, length = DIVERGED, math.nan, math.nan
            polar = math.nan, math.nan, math.nan
        elif not (key is not None or (known and last > 0 and (arrived or left > -1.0))):
            path[0, 0], path[1, 0], path[2, 0] = goal
            how = path, *loop, arc, dt, radius, hysteresis, motors, end
            count, outcome, peak, length = held(alone, start, *how)
            last = max(count - 1, 0)
            polar = alone[3, last], alone[4, last], alone[5, last]
            for k in range(records.shape[2]):
                for row in range(records.shape[0]):
                    records[row, place + i, k] = alone[row, k] if k < count else math.nan
        heading_error = wrap(polar[2] - polar[1])
        lanes.summarise(summary, i, outcome, last * dt, heading_error, peak, length, polar[0])
    return summary


def survey(runs, records, place, law, task):
    """Sum up many runs to goals that stand still.

    Their samples go into `records`, which are NaN, from run `place` on. With a key to random
    numbers, a receiver and the run's number are below each run.
    """
    states, key = np.zeros((ROWS, runs.shape[1])), task.key or None
    states[:LEFT], states[LEFT], states[BRANCH:TURNING] = runs[:LEFT], task.samples - 1.0, math.nan
    how = law, task.limits, task.method == "arc", task.dt
    ends = max(task.arrival_radius, NEAREST), task.hysteresis or None, task.motors, task.end
    rest = task.samples, key, records, place
    if task.recorded or key:
        drive_all(states, *how, *ends, *rest, *receivers.in_samples(runs[LEFT:], task))
    else:
        drive(states, *how, *ends)
    ends = task.arrival_radius, task.hysteresis, *ends[2:]
    return conclude(states, runs[:LEFT], *how, *ends, *rest)
