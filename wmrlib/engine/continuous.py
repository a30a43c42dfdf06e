"""The law acting all the time, with error control, for many runs side by side.

Ideal wheels, and nothing recorded. 7 us a run on one core, where `simulate` takes 200.
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
_FIRST_STEP = 0.01  # s
_FIRST_PROBE = _FIRST_STEP * PROBE_STEP
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
    """Compute the slopes of stage 0, |omega| there, and its rate."""
    for stage in (0, PROBE):
        slopes(work, stage, law, limits)
        for i in range(OMEGA):
            work[PROBE_STATE + i] = work[i] + _FIRST_PROBE * work[SLOPES + i]
    for i in range(LANES):
        omega = work[SLOPES + OMEGA + i]
        change = work[SLOPES + PROBE * STAGE + OMEGA + i] - omega
        work[PEAK + i], work[OMEGA_RATE + i] = abs(omega), change / _FIRST_PROBE


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
def drive(states, work, rows, inside, counts, radius, law, limits):
    """Drive every run to its end; a run that has ended gives its lane to the next.

    `rows` is the part of `work` that a run keeps between two steps, one row of lanes a row; for the
    next two see `refill_lanes`.
    """
    total = states.shape[1]
    for first in range(0, total, LANES):
        used = min(LANES, total - first)
        for i in range(used):
            lanes.copy_column(rows, i, states, first + i)
        begin(work, law, limits)
        for i in range(used):
            lanes.copy_column(states, first + i, rows, i)
    while lanes.refill_lanes(states, rows, inside, counts, LEFT // LANES, 0.0):
        for _ in range(_ROUNDS):
            attempt(work, law, limits)
            judge(work, radius)


def initial_states(runs, whole, most_trials, radius):
    """The rows of `workspace` at the beginning of runs, one run a column."""
    states = np.zeros((RUN_ROWS, runs.shape[1]))
    with np.errstate(all="ignore"):  # infinities are answers, as in a compiled loop
        states[: ROLLED // LANES] = polar_from_pose(*runs[: loops.GAINS])
    states[LEFT // LANES] = np.where(states[0] > radius, whole, -whole)
    states[K_RHO // LANES : STEP // LANES] = runs[loops.GAINS : loops.WHEELS]
    states[STEP // LANES], states[TRIALS // LANES] = _FIRST_STEP, most_trials
    return states


def summaries(states, whole, radius):
    """The summary of each run, in the rows of an Arrival."""
    rho, alpha, theta, _, left, time, peak, length = states[:8]
    with np.errstate(all="ignore"):  # a run that diverged may have any number
        total = rho + alpha + theta + states[SLOPES // LANES :].sum(axis=0)
        heading_error = wrap(theta - alpha)
    far = (left < 0.0) & (np.abs(states[:3]).max(axis=0) > _FARTHEST)
    arrived = (rho <= radius * (1.0 + ARRIVAL_TOLERANCE)) & ((rho > 0.0) | (left == -whole))
    outcome = np.where(left < 0.0, UNFINISHED, TIMED_OUT)
    outcome[arrived] = ARRIVED
    outcome[far | ~np.isfinite(total)] = DIVERGED
    time = np.where(outcome == ARRIVED, time, math.inf)
    summary = np.array([outcome, time, heading_error, peak, length, rho])
    summary[loops.TIME :, outcome == UNFINISHED] = math.nan
    return summary


def survey(runs, law, limits, whole, most_trials, radius):
    """Sum up the runs in the columns of `runs`, all with one law, for `whole` seconds at most."""
    states = initial_states(runs, whole, most_trials, radius)
    work = np.zeros(WORKSPACE_SIZE)
    rows = work.reshape(-1, LANES)[:RUN_ROWS]
    inside, counts = np.zeros(LANES, np.int64), np.zeros(2, np.int64)
    drive(states, work, rows, inside, counts, radius, lanes.law_tuple(law), limits)
    return summaries(states, whole, radius)
