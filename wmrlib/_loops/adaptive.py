"""The law acting all the time, in polar coordinates and with error control.

Many runs to their ends, one run step by step, and what it does at given times: a sample is a step
of its own, from the beginning of the step that it lies in.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from wmrlib._compile import compiled
from wmrlib._loops import rows, steps
from wmrlib._loops.polar import closed_loop, polar_closing_rate
from wmrlib._vecmath import widest_vectors
from wmrlib.gains import NO_LIMITS, GainsFields
from wmrlib.motion import polar_from_pose, pose_of_error, wrap

MOST_TRIALS = 100_000.0
TOLERANCE = 1e-10  # of a step: rad, and a share of the distance
_BEYOND = 1e100  # m or rad: whoever gets so far in so many steps never ends
_LEFT, _TIME = steps.LEFT // steps.LANES, steps.TIME // steps.LANES
_ROUNDS = 4  # steps between two looks at who has finished


@compiled
def sit_back(bench, log, t, step):
    """Seat a run where it was at the beginnings of the steps that the times t lie in.

    The first lies in a given step or a later one; returns the last one's.
    """
    seats = bench.reshape(-1, steps.LANES)
    for i in range(t.size):
        while step + 2 < log.shape[1] and log[_TIME, step + 1] <= t[i]:
            step += 1
        rows.sit(seats, i, log, step)
        bench[steps.DT + i] = t[i] - bench[steps.TIME + i]
    return step


@compiled
def put_down(bench, record, first, goal):
    """Record the ends of the steps; rounding can carry rho a hair past the goal."""
    end = steps.SLOPES + steps.LAST * steps.STAGE
    for i in range(min(steps.LANES, record.shape[1] - first)):
        rho, alpha = max(bench[steps.NEW + i], 0.0), bench[steps.NEW + steps.ALPHA + i]
        seen = rho, alpha, bench[steps.NEW + steps.THETA + i]
        v, omega = bench[end + steps.ROLLED + i], bench[end + steps.TURNING + i]
        rows.write(record, first + i, pose_of_error(*seen, *goal), seen, v, omega)


@lru_cache
def loops_of(law, limited, lagging):
    """The loops for one law, compiled by themselves: asking for it would cost more than a step."""
    size = 6 if lagging else 4

    @compiled
    def slopes(bench, used, stage, wheels, lag):
        widest_vectors()
        limits = wheels if limited else NO_LIMITS
        at, out = bench[steps.source_of(stage) :], bench[steps.SLOPES + stage * steps.STAGE :]
        for i in range(used):
            gains = GainsFields(
                bench[steps.K_RHO + i],
                bench[steps.K_ALPHA + i],
                bench[steps.H + i],
                bench[steps.V_MAX + i],
            )
            loop = gains, law, limits
            r, a, t, v, omega = closed_loop((at[i], at[steps.ALPHA + i], at[steps.THETA + i]), loop)
            if lagging:
                out[steps.V + i], out[steps.OMEGA + i] = (
                    (v - at[steps.V + i]) / lag,
                    (omega - at[steps.OMEGA + i]) / lag,
                )
                v, omega = at[steps.V + i], at[steps.OMEGA + i]
                rho = at[i] if at[i] != 0.0 else 1.0  # on the goal v is 0
                r, a, t = polar_closing_rate(rho, at[steps.ALPHA + i], v / rho, omega)
            out[i], out[steps.ALPHA + i], out[steps.THETA + i] = r, a, t
            out[steps.ROLLED + i], out[steps.TURNING + i] = v, omega

    @compiled
    def begin(bench, used, wheels, lag):
        for stage in (0, steps.BEFORE):
            slopes(bench, used, stage, wheels, lag)
            steps.get_ready(bench, used, stage, 1e-300)

    @compiled
    def trial(bench, used, radius, wheels, lag):
        steps.set_steps(bench, used)
        for stage in range(1, steps.BEFORE + 1):
            steps.move(bench, used, size, stage)
            slopes(bench, used, stage, wheels, lag)
        steps.judge(bench, used, size, 1e-150, radius, TOLERANCE)

    @compiled
    def drive(states, radius, wheels, lag):
        bench, inside = np.zeros(steps.ROOM), np.zeros(steps.LANES, np.int64)
        seats, width, waiting = bench.reshape(-1, steps.LANES), 0, 0
        for first in range(0, states.shape[1], steps.LANES):
            used = min(steps.LANES, states.shape[1] - first)
            for i in range(used):
                rows.sit(seats, i, states, first + i)
            begin(bench, steps.LANES, wheels, lag)
            for i in range(used):
                rows.sit(states, first + i, seats[: steps.KEPT], i)
        while True:
            width, waiting = rows.exchange(states, seats, inside, width, waiting, _LEFT)
            if width == 0:
                return
            for _ in range(_ROUNDS):
                trial(bench, steps.LANES, radius, wheels, lag)

    @compiled
    def trace(state, radius, wheels, lag):
        """What is kept of one run at the beginning of each step, and at its end, in columns."""
        bench, log, count = np.zeros(steps.ROOM), np.empty((steps.KEPT, 64)), 0
        seats = bench.reshape(-1, steps.LANES)
        rows.sit(seats, 0, state, 0)
        begin(bench, 1, wheels, lag)
        while True:
            if count == log.shape[1]:
                log = steps.doubled(log)
            rows.sit(log, count, seats[: steps.KEPT], 0)
            if not bench[steps.LEFT] > 0.0:
                return log[:, : count + 1]
            trial(bench, 1, radius, wheels, lag)
            count += int(bench[steps.TAKEN])

    @compiled
    def sample(log, t, wheels, lag, record, goal):
        """Record the run at the times t."""
        bench, step = np.zeros(steps.ROOM), 0
        for first in range(0, t.size, steps.LANES):
            step = sit_back(bench, log, t[first : first + steps.LANES], step)
            for stage in range(1, steps.LAST + 1):
                steps.move(bench, steps.LANES, size, stage)
                slopes(bench, steps.LANES, stage, wheels, lag)
            put_down(bench, record, first, goal)

    return drive, trace, sample


@compiled
def begun(runs, whole, radius, most):
    """What is kept of runs when they begin, one a column."""
    states = np.zeros((steps.KEPT, runs.shape[1]))
    for i in range(runs.shape[1]):
        start, goal, _ = rows.run_of(runs, i)
        rho, alpha, theta = polar_from_pose(*start, *goal)
        states[steps.RHO // steps.LANES, i], states[steps.ALPHA // steps.LANES, i] = rho, alpha
        states[steps.THETA // steps.LANES, i], states[steps.TRIALS // steps.LANES, i] = theta, most
        states[_LEFT, i] = whole if rho > radius else -whole
        for k in range(4):
            states[steps.K_RHO // steps.LANES + k, i] = runs[6 + k, i]
    return states


@compiled
def summed_up(states, whole, radius):
    """What became of each run."""
    summary = np.empty((rows.DISTANCE + 1, states.shape[1]))
    for i in range(states.shape[1]):
        rho, alpha, theta = (
            states[0, i],
            states[steps.ALPHA // steps.LANES, i],
            states[steps.THETA // steps.LANES, i],
        )
        left, total = states[_LEFT, i], rho + alpha + theta
        for row in range(steps.SLOPES // steps.LANES, steps.KEPT):
            total += states[row, i]
        outcome = rows.TIMED_OUT
        far = left < 0.0 and max(abs(rho), abs(alpha), abs(theta)) > _BEYOND
        if far or not math.isfinite(total):
            outcome = rows.DIVERGED
        elif rho <= radius * (1.0 + steps.SHARP) and (rho > 0.0 or left == -whole):
            outcome = rows.ARRIVED
        elif left < 0.0:
            outcome = rows.UNFINISHED
        peak, length = states[steps.PEAK // steps.LANES, i], states[steps.LENGTH // steps.LANES, i]
        sums = wrap(theta - alpha), peak, length, rho
        rows.summarise(summary, i, outcome, states[_TIME, i], *sums)
        if outcome == rows.UNFINISHED:
            summary[rows.TIME :, i] = math.nan
    return summary


def survey(runs, law, wheels, _, dt, samples, radius, recorded):
    """As `plane.survey`; the last sample is the one before arrival."""
    drive, trace, sample = loops_of(law, wheels.max_speed < math.inf, False)
    whole = (samples - 1) * dt
    begin, how = begun(runs, whole, radius, MOST_TRIALS), (radius, wheels, 0.0)
    states = begin.copy()
    drive(states, *how)
    summary = summed_up(states, whole, radius)
    records = np.full((rows.LYAPUNOV, runs.shape[1], samples if recorded else 0), np.nan)
    going = np.isin(summary[rows.OUTCOME], (rows.ARRIVED, rows.TIMED_OUT))
    t = dt * np.arange(samples)
    for i in np.flatnonzero(going) if recorded else ():
        log = trace(begin[:, i : i + 1], *how)
        arrived = summary[rows.OUTCOME, i] == rows.ARRIVED
        count = max(1, np.searchsorted(t, summary[rows.TIME, i])) if arrived else samples
        sample(log, t[:count], wheels, 0.0, records[:, i, :count], tuple(runs[3:6, i]))
    return summary, records
