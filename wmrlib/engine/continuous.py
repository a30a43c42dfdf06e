"""The law acting all the time, with error control, for many runs side by side.

Ideal wheels, and nothing recorded. 12 us a run on two cores, where `simulate` takes 180 on one.
"""

from __future__ import annotations

import math

import numpy as np

from wmrlib import loops, motion
from wmrlib._dop853 import ARRIVAL_TOLERANCE, growth, larger, step_error, until_event
from wmrlib.compilation import compiled
from wmrlib.elementary import wrap
from wmrlib.engine import lanes
from wmrlib.engine.vectors import vectorised
from wmrlib.engine.workspace import (  # fmt: skip
    ACCEPTED,
    ALPHA,
    COARSE,
    DT,
    FINE,
    K_ALPHA,
    K_RHO,
    LANES,
    LAST,
    LEFT,
    LENGTH,
    NEW,
    OMEGA,
    OMEGA_RATE,
    PEAK,
    PROBE,
    PROBE_STATE,
    PROBE_STEP,
    RHO,
    ROLLED,
    RUN_ROWS,
    SLOPES,
    STAGE,
    STEP,
    THETA,
    TIME,
    TRIALS,
    V_MAX,
    WORKSPACE_SIZE,
    H,
    combine,
)
from wmrlib.gains import GainsFields
from wmrlib.motion import polar_from_pose
from wmrlib.runs import ARRIVED, DIVERGED, TIMED_OUT, UNFINISHED

_FARTHEST = 1e100  # m or rad: a run that gets beyond this is treated as diverged
_ROUNDS = 4  # steps between two checks for runs that have ended
polar_closing_rate = vectorised(motion.polar_closing_rate)


@compiled
def slopes(work, stage, law, limits):
    """The rates of the states at a stage, and omega there."""
    stage = stage & 15  # so that LLVM knows that no index is negative
    at = PROBE_STATE if stage == PROBE else NEW if stage else 0
    out = SLOPES + stage * STAGE
    for i in range(LANES):
        gains = GainsFields(work[K_RHO + i], work[K_ALPHA + i], work[H + i], work[V_MAX + i])
        polar = work[at + i], work[at + ALPHA + i], work[at + THETA + i]
        v_over_rho, omega = lanes.steered(polar, gains, law, limits)
        rates = polar_closing_rate(polar[0], polar[1], v_over_rho, omega)
        work[out + i], work[out + ALPHA + i], work[out + THETA + i] = rates
        work[out + ROLLED + i], work[out + OMEGA + i] = v_over_rho * polar[0], omega


@compiled
def begin(work, law, limits):
    """Compute the slopes of stage 0, the rate of omega, and the length of the first step."""
    for stage in range(0, PROBE + 1, PROBE):
        slopes(work, stage, law, limits)
        for row in range(0, OMEGA if stage == 0 else 0, LANES):
            for i in range(LANES):
                work[STEP + i], work[DT + row + i] = 0.01, 0.01 * PROBE_STEP
                work[PROBE_STATE + row + i] = work[row + i] + work[DT + i] * work[SLOPES + row + i]
    for i in range(LANES):
        omega = work[SLOPES + OMEGA + i]
        change = work[SLOPES + PROBE * STAGE + OMEGA + i] - omega
        work[PEAK + i], work[OMEGA_RATE + i] = abs(omega), change / work[DT + i]


@compiled
def attempt(work, law, limits):
    """Compute a step of each run, and its two errors."""
    for row in range(0, OMEGA, LANES):
        for i in range(LANES):
            step, left = work[STEP + i], work[LEFT + i]
            work[DT + row + i] = step if step < left else left
    for stage in range(1, PROBE + 3):
        combine(work, stage)
        if stage <= PROBE:
            slopes(work, stage, law, limits)
    for row in range(0, OMEGA, LANES):
        for i in range(LANES):
            scale = larger(abs(work[NEW + row + i]), 1.0 if row else 1e-150)
            fine, coarse = abs(work[FINE + row + i]) / scale, abs(work[COARSE + row + i]) / scale
            work[FINE + i] = larger(fine, work[FINE + i]) if row else fine
            work[COARSE + i] = larger(coarse, work[COARSE + i]) if row else coarse


@compiled
def judge(work, radius):
    """Accept each step that is accurate and passes no event, and set the length of the next."""
    for i in range(LANES):
        first, last = SLOPES + i, SLOPES + LAST * STAGE + i
        dt, left, peak, time = work[DT + i], work[LEFT + i], work[PEAK + i], work[TIME + i]
        step, length = work[STEP + i], work[LENGTH + i]
        before, trials = work[OMEGA_RATE + i], work[TRIALS + i] - 1.0  # all first, see `decide`
        new, rolled, omega = work[NEW + i], work[NEW + ROLLED + i], work[last + OMEGA]
        omega_rate = (work[SLOPES + PROBE * STAGE + OMEGA + i] - omega) / (PROBE_STEP * dt)
        falling = work[RHO + i], work[first], new, work[last]
        rolling = 0.0, work[first + ROLLED], rolled, work[last + ROLLED]
        turning = work[first + OMEGA], before, omega, omega_rate
        event_time = until_event(falling, rolling, turning, dt, radius, peak)
        error = step_error(work[FINE + i], work[COARSE + i])
        total = new + work[NEW + ALPHA + i] + work[NEW + THETA + i] + omega
        going, accurate = left > 0.0, (error <= 1.0) & (total - total == 0.0)
        accepted = going & accurate & (event_time >= dt)
        work[ACCEPTED + i] = 1.0 if accepted else 0.0
        work[PEAK + i] = abs(omega) if accepted & (abs(omega) > peak) else peak
        work[LENGTH + i] = length + (abs(rolled) if accepted else 0.0)
        work[TIME + i] = time + dt if accepted else time
        work[OMEGA_RATE + i] = omega_rate if accepted else before
        again = growth(error) * dt
        again = event_time if accurate & (event_time < dt) else again
        work[STEP + i] = again if going else step
        work[TRIALS + i] = trials
        arrived = (radius > 0.0) & (new <= radius * (1.0 + ARRIVAL_TOLERANCE))
        rest = left - dt if accepted else left
        hopeless = (trials <= 0.0) | (again < 1e-290)
        over = going & ((accepted & arrived) | (hopeless & (rest > 0.0)))
        work[LEFT + i] = -rest if over else rest
    for row in range(0, STAGE, LANES):
        for i in range(LANES):
            old, new = work[SLOPES + row + i], work[SLOPES + LAST * STAGE + row + i]
            work[SLOPES + row + i] = new if work[ACCEPTED + i] > 0.0 else old
    for row in range(0, OMEGA, LANES):
        for i in range(LANES):
            old, new = work[row + i], work[NEW + row + i] if row != ROLLED else 0.0
            work[row + i] = new if work[ACCEPTED + i] > 0.0 else old


@compiled
def drive(states, radius, law, limits):
    """Drive every run to its end; a run that has ended gives its lane to the next."""
    work, inside = np.zeros(WORKSPACE_SIZE), np.zeros(LANES, np.int64)
    rows, counts = work.reshape(-1, LANES), np.zeros(2, np.int64)
    for first in range(0, states.shape[1], LANES):
        for i in range(min(LANES, states.shape[1] - first)):
            lanes.copy_column(rows, i, states, first + i)
        begin(work, law, limits)
        for i in range(min(LANES, states.shape[1] - first)):
            lanes.copy_column(states, first + i, rows, i)
    while lanes.refill_lanes(states, rows, inside, counts, LEFT // LANES, 0.0):
        for _ in range(_ROUNDS):
            attempt(work, law, limits)
            judge(work, radius)


@compiled
def initial_states(runs, whole, most_trials, radius):
    """The rows of `workspace` at the beginning of runs, one run a column."""
    states = np.zeros((RUN_ROWS, runs.shape[1]))
    for i in range(runs.shape[1]):
        x, y, heading, goal_x, goal_y, goal_heading, k_rho, k_alpha, h, v_max = runs[:, i]
        polar = polar_from_pose(x, y, heading, goal_x, goal_y, goal_heading)
        left = whole if polar[0] > radius else -whole
        gains = k_rho, k_alpha, h, v_max
        values = (*polar, 0.0, left, 0.0, 0.0, 0.0, *gains, 0.0, 0.0, float(most_trials))
        for row, value in enumerate(values):
            states[row, i] = value
    return states


@compiled
def summaries(states, whole, radius):
    """The summary of each run, in the rows of `loops.summarise`."""
    summary = np.empty((loops.DISTANCE + 1, states.shape[1]))
    for i in range(states.shape[1]):
        rho, alpha, theta, _, left, time, peak, length = states[:8, i]
        total = rho + alpha + theta
        for row in range(SLOPES // LANES, RUN_ROWS):
            total += states[row, i]
        outcome = TIMED_OUT
        far = left < 0.0 and max(abs(rho), abs(alpha), abs(theta)) > _FARTHEST
        if far or not math.isfinite(total):
            outcome = DIVERGED
        elif rho <= radius * (1.0 + ARRIVAL_TOLERANCE) and (rho > 0.0 or left == -whole):
            outcome = ARRIVED
        elif left < 0.0:
            outcome = UNFINISHED
        loops.summarise(summary, i, outcome, time, wrap(theta - alpha), peak, length, rho)
        if outcome == UNFINISHED:
            summary[loops.TIME :, i] = math.nan
    return summary


def survey(runs, law, limits, whole, most_trials, radius):
    """Sum up the runs in the columns of `runs`, all with one law, for `whole` seconds at most."""
    states = initial_states(runs[: loops.WHEELS], whole, most_trials, radius)
    drive(states, radius, lanes.law_tuple(law), limits)
    return summaries(states, whole, radius)
