"""Steps with error control for runs side by side on a bench, whatever it is that moves them.

A step may have to end on an event, and is tried again, shorter, until it does: arrival, a change
between forwards and backwards, and the largest |omega| so far.

A bench is one flat array. Its rows are named by where they begin, so that LLVM sees that they don't
overlap, and computes four or eight runs with each instruction.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from wmrlib._compile import compiled, formula
from wmrlib._loops.tableau import FIFTH, STAGES, THIRD, WEIGHTS
from wmrlib._vecmath import widest_vectors

LANES = 32  # runs side by side: a bench stays in the first-level cache
SHARP = 1e-12  # so close to the arrival radius a run ends, as a share of it
_SLACK = 1e-8  # what an event may miss of the metres rolled and of the largest |omega|
_GLIMPSE = 1e-6  # share of a step before its end at which omega is looked at too, for its rate

# A state is rho, alpha and theta, or x, y and heading; then the metres rolled in the step, signed
# as v is; with wheels that lag, their v and omega too.
RHO, ALPHA, THETA, ROLLED, V, OMEGA = range(0, 6 * LANES, LANES)
# TIME has passed, and LEFT is to go: its sign turns if the run is over before.
LEFT, TIME, PEAK, LENGTH, K_RHO, K_ALPHA, H, V_MAX, STEP, SWING, TRIALS = range(
    6 * LANES, 17 * LANES, LANES
)
SLOPES, STAGE = 17 * LANES, 7 * LANES  # of each stage, the rates of the state and then omega
TURNING = 6 * LANES
KEPT = 24  # rows: what is kept of a run between two steps
LAST, BEFORE = 12, 13  # the stages at the end of a step, and a glimpse before it
_FINE_MISS, _COARSE_MISS = 14, 15  # no stages, but Hairer's two estimates of the error
NEW, NEAR, _FINE, _COARSE, DT, ROOM = range(
    SLOPES + 14 * STAGE, SLOPES + 14 * STAGE + 36 * LANES, 6 * LANES
)

TAKEN = _FINE  # where `judge` says whether a step was taken, as 1 or 0
_TO = (*STAGES, WEIGHTS, (*WEIGHTS, -_GLIMPSE))
NODES = np.array([0.0, *map(sum, _TO)])  # when each stage is, as shares of the step


def _written_out():
    """`move`, with each sum of slopes written out: LLVM vectorises no loop that holds another."""
    yield "def move(bench, used, size, stage):"
    yield f" for first in range(0, size * {LANES}, {LANES}):\n  row = first & 255"  # see `judge`
    for stage, weights in enumerate((*_TO, FIFTH, THIRD), 1):
        slopes = ((SLOPES + j * STAGE, weight) for j, weight in enumerate(weights) if weight)
        total = " + ".join(f"{weight!r} * bench[{at} + row + i]" for at, weight in slopes)
        to = {BEFORE: NEAR, _FINE_MISS: _FINE, _COARSE_MISS: _COARSE}.get(stage, NEW)
        start = "bench[row + i] + " if stage <= BEFORE else ""
        yield f"  if stage == {stage}:\n   for i in range(used):"
        yield f"    bench[{to} + row + i] = {start}bench[{DT} + i] * ({total})"


_space: dict[str, Any] = {"__name__": __name__}
exec("\n".join(_written_out()), _space)
move = compiled(_space["move"])
"""Move states of `size` rows to the place of a stage, or find their errors by one estimate."""


@formula
def larger(one, other):
    return one if one > other else other  # `max` is not vectorised


@formula
def _until_turn(f0, rate0, f1, rate1, dt, slack):
    """How long f goes on before it turns round, if more than the slack of it is missed at the end.

    By the cubic with these values and rates at both ends.
    """
    middle = rate0 + rate1 - 3.0 * (f1 - f0) / dt
    root = np.sqrt(larger(middle * middle - rate0 * rate1, 0.0))
    root = root if rate1 > 0.0 else -root
    turn = dt - dt * (rate1 + root - middle) / (rate1 - rate0 + 2.0 * root)
    before, after = abs(rate0) * turn, abs(rate1) * (dt - turn)
    missed = before if before < after else after
    return turn if (rate0 * rate1 < 0.0) & (missed > slack) else dt


@formula
def _until_arrival(rho0, rate0, rho1, rate1, dt, radius):
    """When rho passes the radius, by the cubic for the time as a function of rho."""
    fall = rho1 - rho0
    s = (radius - rho0) / fall
    ends = (1.0 - s) * (1.0 - s) * fall / rate0 - s * (1.0 - s) * fall / rate1
    time = s * (ends + s * (3.0 - 2.0 * s) * dt)
    time = time if (time > 0.0) & (time < dt) else s * dt
    return time if rho1 < radius * (1.0 - SHARP) else dt


@compiled
def source_of(stage):
    """Where the state is whose slopes are those of a stage."""
    if stage == 0:
        return 0
    return NEAR if stage == BEFORE else NEW


@compiled
def get_ready(bench, used, stage, smallest):
    """After stage 0 the first length of a step, and where to see how omega changes, stage BEFORE.

    After that, its rate. `smallest` is as in `judge`.
    """
    for i in range(used):
        if stage == BEFORE:
            near = bench[SLOPES + BEFORE * STAGE + TURNING + i]
            bench[SWING + i] = (near - bench[SLOPES + TURNING + i]) / bench[DT + i]
            continue
        pace = abs(bench[SLOPES + i]) / larger(abs(bench[RHO + i]), smallest)
        pace += abs(bench[SLOPES + ALPHA + i]) + abs(bench[SLOPES + THETA + i])
        bench[STEP + i] = 0.1 / larger(pace, 1e-300)
        bench[PEAK + i] = abs(bench[SLOPES + TURNING + i])
        bench[DT + i] = _GLIMPSE * (bench[STEP + i] if bench[STEP + i] < 1.0 else 1.0)
        for row in range(0, TURNING, LANES):
            bench[NEAR + row + i] = bench[row + i] + bench[DT + i] * bench[SLOPES + row + i]


@compiled
def set_steps(bench, used):
    for i in range(used):
        step, left = bench[STEP + i], bench[LEFT + i]
        bench[DT + i] = step if step < left else left


@compiled
def judge(bench, used, size, smallest, radius, tolerance):
    """Take each step that is accurate and ends at its events, and say how long the next may be.

    With wheels that lag, rho may also dip below the radius and out of it again in one step.
    Errors are judged as a share of the state's size, which counts as 1 if it is less, or that of
    the first row as `smallest`.
    """
    widest_vectors()
    move(bench, used, size, _FINE_MISS)
    move(bench, used, size, _COARSE_MISS)
    for first in range(0, size * LANES, LANES):
        row = first & 255  # so that LLVM knows that no index is negative, and vectorises
        least = 1.0 if row else smallest
        for i in range(used):
            scale = larger(abs(bench[NEW + row + i]), least)
            fine = abs(bench[_FINE + row + i]) / scale
            coarse = abs(bench[_COARSE + row + i]) / scale
            bench[_FINE + i] = larger(fine, bench[_FINE + i]) if row else fine
            bench[_COARSE + i] = larger(coarse, bench[_COARSE + i]) if row else coarse
    for i in range(used):
        first, last = SLOPES + i, SLOPES + LAST * STAGE + i
        rho, dt, left, peak = bench[RHO + i], bench[DT + i], bench[LEFT + i], bench[PEAK + i]
        new, rolled, turning = bench[NEW + i], bench[NEW + ROLLED + i], abs(bench[last + TURNING])
        before = bench[SLOPES + BEFORE * STAGE + TURNING + i]
        swing, swing1 = bench[SWING + i], (bench[last + TURNING] - before) / (_GLIMPSE * dt)

        wanted = _until_arrival(rho, bench[first], new, bench[last], dt, radius)
        slack = _SLACK * (1.0 + abs(rho))
        turn = _until_turn(0.0, bench[first + ROLLED], rolled, bench[last + ROLLED], dt, slack)
        wanted = turn if turn < wanted else wanted
        ends = bench[first + TURNING], swing, bench[last + TURNING], swing1
        turn = _until_turn(*ends, dt, _SLACK * (1.0 + peak))
        highest = abs(bench[first + TURNING] + swing * turn) > peak + _SLACK
        wanted = turn if highest & (turn < wanted) else wanted
        turn = _until_turn(rho, bench[first], new, bench[last], dt, _SLACK * abs(radius))
        passing = (radius > 0.0) & (bench[first] < 0.0) & (new > radius)
        wanted = turn if passing & (turn < wanted) else wanted

        fine, coarse = bench[_FINE + i], 0.1 * bench[_COARSE + i]
        error = fine * fine / np.sqrt(fine * fine + coarse * coarse + 1e-300) / tolerance
        growth = 0.9 / np.sqrt(np.sqrt(np.sqrt(error)))
        growth = (growth if growth < 5.0 else 5.0) if growth > 0.2 else 0.2  # 0.2 for NaN too
        total = new + bench[NEW + ALPHA + i] + bench[NEW + THETA + i] + turning
        going, accurate = left > 0.0, (error <= 1.0) & (total - total == 0.0)
        taken = going & accurate & (wanted >= dt)
        bench[TAKEN + i] = 1.0 if taken else 0.0
        bench[PEAK + i] = turning if taken & (turning > peak) else peak
        bench[LENGTH + i] += abs(rolled) if taken else 0.0
        bench[TIME + i] += dt if taken else 0.0
        bench[SWING + i] = swing1 if taken else swing
        again = wanted if accurate & (wanted < dt) else growth * dt
        bench[STEP + i] = again if going else bench[STEP + i]
        bench[TRIALS + i] -= 1.0
        arrived = (radius > 0.0) & (new <= radius * (1.0 + SHARP))
        rest = left - dt if taken else left
        hopeless = (bench[TRIALS + i] <= 0.0) | (again < 1e-290)
        over = going & ((taken & arrived) | (hopeless & (rest > 0.0)))
        bench[LEFT + i] = -rest if over else rest
    for row in range(0, STAGE, LANES):
        for i in range(used):
            if row < size * LANES:
                moved = bench[NEW + row + i] if row != ROLLED else 0.0
                bench[row + i] = moved if bench[TAKEN + i] > 0.0 else bench[row + i]
            slope = bench[SLOPES + LAST * STAGE + row + i]
            bench[SLOPES + row + i] = slope if bench[TAKEN + i] > 0.0 else bench[SLOPES + row + i]


@compiled
def doubled(log):
    """The same columns, and room for as many more."""
    longer = np.empty((log.shape[0], 2 * log.shape[1]))
    for row in range(log.shape[0]):
        for k in range(log.shape[1]):
            longer[row, k] = log[row, k]
    return longer
