"""The law acting all the time, with error control, for runs side by side in the lanes of a bench.

12 us a run on two cores, where `simulate` takes 180 on one.
"""

from __future__ import annotations

import math

import numpy as np

from wmrlib import motion
from wmrlib._dop853 import SHARP, growth, larger, step_error, until_event
from wmrlib.compilation import compiled, formula
from wmrlib.elementary import wrap
from wmrlib.engine import lanes
from wmrlib.engine.bench import (  # fmt: skip
    ALPHA,
    BEYOND,
    COARSE,
    DT,
    FINE,
    GLIMPSE,
    K_ALPHA,
    K_RHO,
    KEPT,
    LANES,
    LAST,
    LEFT,
    LENGTH,
    NEAR,
    NEW,
    NEXT,
    OMEGA,
    PEAK,
    RHO,
    ROLLED,
    ROOM,
    SLOPES,
    STAGE,
    STEP,
    SWING,
    TAKEN,
    THETA,
    TIME,
    TRIALS,
    V_MAX,
    H,
    combine,
)
from wmrlib.engine.vectors import vectorised
from wmrlib.gains import GainsFields
from wmrlib.motion import polar_from_pose, pose_of_error
from wmrlib.runs import ARRIVED, DIVERGED, TIMED_OUT, UNFINISHED

MOST_TRIALS = 100_000.0  # steps of a run
_BEYOND = 1e100  # m or rad: whoever gets so far in so many steps never ends
_ROUNDS = 4  # steps between two looks at who has finished
polar_closing_rate = vectorised(motion.polar_closing_rate)


@formula
def slopes(bench, used, stage, at, law, wheels):
    """The rates of the state in the rows from `at` on, and omega, as those of a stage."""
    out = SLOPES + stage * STAGE
    for i in range(used):
        gains = GainsFields(bench[K_RHO + i], bench[K_ALPHA + i], bench[H + i], bench[V_MAX + i])
        polar = bench[at + i], bench[at + ALPHA + i], bench[at + THETA + i]
        v_over_rho, omega = lanes.steered(polar, gains, law, wheels)
        rates = polar_closing_rate(polar[0], polar[1], v_over_rho, omega)
        bench[out + i], bench[out + ALPHA + i], bench[out + THETA + i] = rates
        bench[out + ROLLED + i], bench[out + OMEGA + i] = v_over_rho * polar[0], omega


@compiled
def begin(bench, used, law, wheels):
    """The slopes of stage 0, the first length of a step, and how omega changes."""
    slopes(bench, used, 0, 0, law, wheels)
    for i in range(used):
        bench[STEP + i], bench[DT + i] = 0.01, 0.01 * GLIMPSE
        bench[PEAK + i] = abs(bench[SLOPES + OMEGA + i])
        for row in range(0, OMEGA, LANES):
            bench[NEAR + row + i] = bench[row + i] + bench[DT + i] * bench[SLOPES + row + i]
    slopes(bench, used, BEYOND, NEAR, law, wheels)
    for i in range(used):
        change = bench[SLOPES + BEYOND * STAGE + OMEGA + i] - bench[SLOPES + OMEGA + i]
        bench[SWING + i] = change / bench[DT + i]


@compiled
def attempt(bench, used, law, wheels):
    """Compute a step of each run, up to the next sample at most, and its two errors."""
    for i in range(used):
        step, left = bench[STEP + i], bench[LEFT + i]
        step, due = (step if step < left else left), bench[NEXT + i] - bench[TIME + i]
        bench[DT + i] = step if step < due else due
    for stage in range(1, BEYOND):
        combine(bench, used, stage)
        slopes(bench, used, stage, NEW, law, wheels)
    combine(bench, used, BEYOND)
    slopes(bench, used, BEYOND, NEAR, law, wheels)
    combine(bench, used, BEYOND + 1)
    combine(bench, used, BEYOND + 2)
    for row in range(0, OMEGA, LANES):
        for i in range(used):
            scale = larger(abs(bench[NEW + row + i]), 1.0 if row else 1e-150)
            fine, coarse = abs(bench[FINE + row + i]) / scale, abs(bench[COARSE + row + i]) / scale
            bench[FINE + i] = larger(fine, bench[FINE + i]) if row else fine
            bench[COARSE + i] = larger(coarse, bench[COARSE + i]) if row else coarse


@compiled
def judge(bench, used, radius):
    """Take each step that is accurate and ends at its events, and say how long the next may be."""
    for i in range(used):
        first, last = SLOPES + i, SLOPES + LAST * STAGE + i
        dt, left, peak, time = bench[DT + i], bench[LEFT + i], bench[PEAK + i], bench[TIME + i]
        step, due, length = bench[STEP + i], bench[NEXT + i], bench[LENGTH + i]
        before, trials = bench[SWING + i], bench[TRIALS + i] - 1.0  # all first, see `decide`
        new, rolled, omega = bench[NEW + i], bench[NEW + ROLLED + i], bench[last + OMEGA]
        swing = (bench[SLOPES + BEYOND * STAGE + OMEGA + i] - omega) / (GLIMPSE * dt)
        falling = bench[RHO + i], bench[first], new, bench[last]
        rolling = 0.0, bench[first + ROLLED], rolled, bench[last + ROLLED]
        turning = bench[first + OMEGA], before, omega, swing
        wanted = until_event(falling, rolling, turning, dt, radius, peak)
        error = step_error(bench[FINE + i], bench[COARSE + i])
        total = new + bench[NEW + ALPHA + i] + bench[NEW + THETA + i] + omega
        going, accurate = left > 0.0, (error <= 1.0) & (total - total == 0.0)
        taken = going & accurate & (wanted >= dt)
        bench[TAKEN + i] = 1.0 if taken else 0.0
        bench[PEAK + i] = abs(omega) if taken & (abs(omega) > peak) else peak
        bench[LENGTH + i] = length + (abs(rolled) if taken else 0.0)
        at = due if dt >= due - time else time + dt
        bench[TIME + i] = at if taken else time
        bench[SWING + i] = swing if taken else before
        again = growth(error) * dt
        again = larger(step, again) if taken & (dt < step) else again  # it was cut, at a sample
        again = wanted if accurate & (wanted < dt) else again
        bench[STEP + i] = again if going else step
        bench[TRIALS + i] = trials
        arrived = (radius > 0.0) & (new <= radius * (1.0 + SHARP))
        rest = left - dt if taken else left
        hopeless = (trials <= 0.0) | (again < 1e-290)
        over = going & ((taken & arrived) | (hopeless & (rest > 0.0)))
        bench[LEFT + i] = -rest if over else rest
    for row in range(0, STAGE, LANES):
        for i in range(used):
            old, new = bench[SLOPES + row + i], bench[SLOPES + LAST * STAGE + row + i]
            bench[SLOPES + row + i] = new if bench[TAKEN + i] > 0.0 else old
    for row in range(0, OMEGA, LANES):
        for i in range(used):
            old, new = bench[row + i], bench[NEW + row + i] if row != ROLLED else 0.0
            bench[row + i] = new if bench[TAKEN + i] > 0.0 else old


@compiled
def note(bench, width, inside, goals, dt, records, place):
    """Record the runs whose step has ended on a sample; rounding can carry rho past the goal."""
    for i in range(width):
        due = bench[TIME + i] == bench[NEXT + i] or bench[LEFT + i] == 0.0  # the last, if rounded
        if bench[TAKEN + i] > 0.0 and due and bench[NEXT + i] < math.inf:
            k, run = round(bench[NEXT + i] / dt), inside[i]
            if bench[LEFT + i] >= 0.0:  # an arrival is none
                polar = max(bench[RHO + i], 0.0), bench[ALPHA + i], bench[THETA + i]
                pose = pose_of_error(*polar, goals[0, run], goals[1, run], goals[2, run])
                twist = bench[SLOPES + ROLLED + i], bench[SLOPES + OMEGA + i]
                for row, value in enumerate((*pose, *polar, *twist)):
                    records[row, place + run, k] = value
            bench[NEXT + i] = (k + 1) * dt if k + 1 < records.shape[2] else math.inf


@compiled
def drive(states, goals, radius, law, wheels, dt, records, place):
    """Take every run to its end; a run that is over gives its lane to the next."""
    bench, inside = np.zeros(ROOM), np.zeros(LANES, np.int64)
    rows, width, waiting = bench.reshape(-1, LANES), 0, 0
    kept = rows[:KEPT]
    for first in range(0, states.shape[1], LANES):
        used = min(LANES, states.shape[1] - first)
        for i in range(used):
            lanes.copy_column(kept, i, states, first + i)
            inside[i], bench[TAKEN + i] = first + i, 1.0
        begin(bench, LANES, law, wheels)
        if records.shape[2] > 0:
            note(bench, used, inside, goals, dt, records, place)
        for i in range(used):
            lanes.copy_column(states, first + i, kept, i)
    while True:
        width, waiting = lanes.refill_lanes(states, kept, inside, width, waiting, LEFT // LANES)
        if width == 0:
            return
        for _ in range(_ROUNDS):
            attempt(bench, LANES, law, wheels)
            judge(bench, LANES, radius)
            if records.shape[2] > 0:
                note(bench, width, inside, goals, dt, records, place)


@compiled
def begun(runs, whole, radius, recorded):
    """What is kept of runs when they begin, one a column."""
    states = np.zeros((KEPT, runs.shape[1]))
    for i in range(runs.shape[1]):
        start, goal, gains = lanes.run_of(runs, i)
        polar = polar_from_pose(*start, *goal)
        left = whole if polar[0] > radius else -whole
        kept = (*polar, 0.0, left, 0.0, 0.0, 0.0, *gains, 0.0, 0.0, MOST_TRIALS)
        for row, value in enumerate(kept):
            states[row, i] = value
        states[NEXT // LANES, i] = 0.0 if recorded else math.inf
    return states


@compiled
def summed_up(states, whole, radius):
    """What became of each run."""
    summary = np.empty((lanes.DISTANCE + 1, states.shape[1]))
    for i in range(states.shape[1]):
        rho, alpha, theta, _, left, time, peak, length = states[:8, i]
        total = rho + alpha + theta
        for row in range(SLOPES // LANES, KEPT):
            total += states[row, i]
        outcome = TIMED_OUT
        far = left < 0.0 and max(abs(rho), abs(alpha), abs(theta)) > _BEYOND
        if far or not math.isfinite(total):
            outcome = DIVERGED
        elif rho <= radius * (1.0 + SHARP) and (rho > 0.0 or left == -whole):
            outcome = ARRIVED
        elif left < 0.0:
            outcome = UNFINISHED
        lanes.summarise(summary, i, outcome, time, wrap(theta - alpha), peak, length, rho)
        if outcome == UNFINISHED:
            summary[lanes.TIME :, i] = math.nan
    return summary


def survey(runs, records, place, law, task):
    """As `sampled.survey`; the last sample is the one before arrival."""
    whole, radius = (task.samples - 1) * task.dt, task.arrival_radius
    states = begun(runs, whole, radius, task.recorded)
    drive(states, runs[3:6], radius, law, task.limits, task.dt, records, place)
    summary = summed_up(states, whole, radius)
    unfit = np.flatnonzero(~np.isin(summary[lanes.OUTCOME], (ARRIVED, TIMED_OUT)))
    records[:, place + unfit] = np.nan
    return summary
