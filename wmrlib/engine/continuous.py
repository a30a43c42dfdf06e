"""The law acting all the time, with error control, for runs side by side in the lanes of a bench.

A bench is one flat array. Its rows are named by where they begin, so that LLVM sees that they don't
overlap, and computes four or eight runs with each instruction: 12 us a run on two cores, where
`simulate` takes 180 on one.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from wmrlib import motion
from wmrlib._compile import compiled, formula
from wmrlib._dop853 import FIFTH, SHARP, STAGES, THIRD, WEIGHTS
from wmrlib._dop853 import growth, larger, step_error, until_event
from wmrlib._elementary import wrap
from wmrlib.engine import lanes
from wmrlib.engine.vectors import vectorised
from wmrlib.gains import GainsFields
from wmrlib.motion import polar_from_pose, pose_of_error
from wmrlib.runs import ARRIVED, DIVERGED, TIMED_OUT, UNFINISHED

LANES = 32  # runs side by side: a bench stays in the first-level cache
MOST_TRIALS = 100_000.0  # steps of a run
_BEYOND = 1e100  # m or rad: whoever gets so far in so many steps never ends
_GLIMPSE = 1e-6  # share of a step behind its end at which omega is looked at too, for its rate
_ROUNDS = 4  # steps between two looks at who has finished

# A state is rho, alpha and theta, and the metres rolled in the step, signed as v is.
RHO, ALPHA, THETA, ROLLED = range(0, 4 * LANES, LANES)
# TIME has passed, and LEFT is to go: its sign turns if the run is over before. A sample is due at
# NEXT. OMEGA is the row below a state's, among the slopes alone.
LEFT, TIME, PEAK, LENGTH, K_RHO, K_ALPHA, H, V_MAX, STEP, SWING, TRIALS, NEXT = range(
    4 * LANES, 16 * LANES, LANES
)
SLOPES, STAGE = 16 * LANES, 5 * LANES  # of each stage, the rates of the state, and then omega
OMEGA = 4 * LANES
KEPT = 21  # rows: what is kept of a run between two steps, the slopes at its beginning too
LAST, BEYOND = 12, 13  # the stages at the end of a step, and a glimpse behind it
NEW, NEAR, FINE, COARSE, DT, TAKEN, ROOM = (
    SLOPES + 14 * STAGE + rows * LANES for rows in (0, 4, 8, 12, 16, 17, 18)
)
_TO = (*STAGES, WEIGHTS, (*WEIGHTS, _GLIMPSE), FIFTH, THIRD)  # what each stage adds up
polar_closing_rate = vectorised(motion.polar_closing_rate)


def _written_out():
    """The text of `combine`: LLVM vectorises no loop that holds another, and a loop over the slopes
    outside, which keeps its sums in memory, takes 100 ns a step of a run where this takes 20.
    """
    yield "def combine(bench, used, stage):"
    yield f" for first in range(0, 4 * {LANES}, {LANES}):"
    yield "  row = first & 127"  # so that LLVM knows that no index is negative
    for stage, weights in enumerate(_TO, 1):
        slopes = ((SLOPES + j * STAGE, float(w)) for j, w in enumerate(weights) if w)
        total = " + ".join(f"{weight!r} * bench[{at} + row + i]" for at, weight in slopes)
        to = {BEYOND: NEAR, BEYOND + 1: FINE, BEYOND + 2: COARSE}.get(stage, NEW)
        start = "bench[row + i] + " if stage <= BEYOND else ""
        yield f"  if stage == {stage}:\n   for i in range(used):"
        yield f"    bench[{to} + row + i] = {start}bench[{DT} + i] * ({total})"


_space: dict[str, Any] = {"__name__": __name__}
exec(compile("\n".join(_written_out()), __file__, "exec"), _space)
combine = compiled(_space["combine"])
"""Write the state at a stage, from its sum of slopes; or one of the two errors."""


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
        bench[STEP + i], bench[DT + i] = 0.01, 0.01 * _GLIMPSE
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
        swing = (bench[SLOPES + BEYOND * STAGE + OMEGA + i] - omega) / (_GLIMPSE * dt)
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
def note(bench, width, inside, goals, dt, records):
    """Record the runs whose step has ended on a sample; rounding can carry rho past the goal."""
    for i in range(width):
        due = bench[TIME + i] == bench[NEXT + i] or bench[LEFT + i] == 0.0  # the last, if rounded
        if bench[TAKEN + i] > 0.0 and due:
            k, run = int(round(bench[NEXT + i] / dt)), inside[i]
            if bench[LEFT + i] >= 0.0:  # an arrival is none
                polar = max(bench[RHO + i], 0.0), bench[ALPHA + i], bench[THETA + i]
                pose = pose_of_error(*polar, goals[0, run], goals[1, run], goals[2, run])
                twist = bench[SLOPES + ROLLED + i], bench[SLOPES + OMEGA + i]
                for row, value in enumerate((*pose, *polar, *twist)):
                    records[row, k, run] = value
            bench[NEXT + i] = (k + 1) * dt if k + 1 < records.shape[1] else math.inf


@compiled
def drive(states, goals, radius, law, wheels, dt, records):
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
        if records.shape[1] > 0:
            note(bench, used, inside, goals, dt, records)
        for i in range(used):
            lanes.copy_column(states, first + i, kept, i)
    while True:
        width, waiting = lanes.refill_lanes(states, kept, inside, width, waiting, LEFT // LANES)
        if width == 0:
            return
        for _ in range(_ROUNDS):
            attempt(bench, LANES, law, wheels)
            judge(bench, LANES, radius)
            if records.shape[1] > 0:
                note(bench, width, inside, goals, dt, records)


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


def survey(runs, law, wheels, _, dt, samples, radius, recorded):
    """As `sampled.survey`; the last sample is the one before arrival."""
    whole = (samples - 1) * dt
    records = np.full((8, samples if recorded else 0, runs.shape[1]), np.nan)
    states = begun(runs, whole, radius, recorded)
    drive(states, runs[3:6], radius, law, wheels, dt, records)
    return summed_up(states, whole, radius), records
