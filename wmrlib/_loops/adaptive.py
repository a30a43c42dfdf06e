"""The law acting all the time, in polar coordinates and with error control.

Many runs to their ends, one run step by step, and what it does at given times: a sample is a step
of its own, from the beginning of the step that it lies in.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from wmrlib._compile import compiled, formula
from wmrlib._loops import rows, steps
from wmrlib._loops.polar import closed_loop, polar_closing_rate
from wmrlib._loops.steps import K_ALPHA, K_RHO, V_MAX, H
from wmrlib._vecmath import widest_vectors  # noqa: F401 (in `slopes`)
from wmrlib.gains import GainsFields
from wmrlib.laws import POSE_LAWS
from wmrlib.motion import polar_from_pose, pose_of_error, wrap

MOST_TRIALS = 100_000.0
TOLERANCE = 1e-10  # of a step: rad, and a share of the distance
_BEYOND = 1e100  # m or rad: whoever gets so far in so many steps never ends
_PLACES = steps.ALPHA, steps.THETA, steps.LEFT, steps.TIME, steps.PEAK, steps.LENGTH, steps.TRIALS
_ALPHA, _THETA, _LEFT, _TIME, _PEAK, _LENGTH, _TRIALS = (at // steps.LANES for at in _PLACES)
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


@formula
def _slopes(bench, used, stage, law, wheels, lag):
    """The rates of a stage: of the polar error, and with a lag of the wheels' twist too."""
    at, out = bench[steps.source_of(stage) :], bench[steps.SLOPES + stage * steps.STAGE :]
    for i in range(used):
        gains = GainsFields(bench[K_RHO + i], bench[K_ALPHA + i], bench[H + i], bench[V_MAX + i])
        polar = at[i], at[steps.ALPHA + i], at[steps.THETA + i]
        rates = closed_loop(polar, (gains, law, wheels))
        out[i], out[steps.ALPHA + i], out[steps.THETA + i] = rates[0], rates[1], rates[2]
        out[steps.ROLLED + i], out[steps.TURNING + i] = rates[3], rates[4]
    if lag > 0.0:
        for i in range(used):
            v, omega = at[steps.V + i], at[steps.OMEGA + i]
            out[steps.V + i] = (out[steps.ROLLED + i] - v) / lag
            out[steps.OMEGA + i] = (out[steps.TURNING + i] - omega) / lag
            out[steps.ROLLED + i], out[steps.TURNING + i] = v, omega
            rho = at[i] if at[i] != 0.0 else 1.0  # on the goal v is 0
            rates = polar_closing_rate(rho, at[steps.ALPHA + i], v / rho, omega)
            out[i], out[steps.ALPHA + i], out[steps.THETA + i] = rates


def _written_out():
    """`slopes`, a loop for each law: asking for it in every step would cost more than the step."""
    yield "def slopes(bench, used, stage, law, wheels, lag):\n widest_vectors()"
    for code in POSE_LAWS.values():
        yield f" if law == {code}: _slopes(bench, used, stage, {code}, wheels, lag)"


_space: dict[str, Any] = dict(globals())
exec("\n".join(_written_out()), _space)
slopes = compiled(_space["slopes"])


@compiled
def begin(bench, used, law, wheels, lag):
    for stage in (0, steps.BEFORE):
        slopes(bench, used, stage, law, wheels, lag)
        steps.get_ready(bench, used, stage, 1e-300)


@compiled
def trial(bench, used, radius, law, wheels, lag):
    size = 6 if lag > 0.0 else 4
    steps.set_steps(bench, used)
    for stage in range(1, steps.BEFORE + 1):
        steps.move(bench, used, size, stage)
        slopes(bench, used, stage, law, wheels, lag)
    steps.judge(bench, used, size, 1e-150, radius, TOLERANCE)


@compiled
def drive(states, radius, law, wheels):
    """Take every run to its end; a run that is over gives its place to the next."""
    bench, inside = np.zeros(steps.ROOM), np.zeros(steps.LANES, np.int64)
    seats, width, waiting = bench.reshape(-1, steps.LANES), 0, 0
    for first in range(0, states.shape[1], steps.LANES):
        used = min(steps.LANES, states.shape[1] - first)
        for i in range(used):
            rows.sit(seats, i, states, first + i)
        begin(bench, steps.LANES, law, wheels, 0.0)
        for i in range(used):
            rows.sit(states, first + i, seats[: steps.KEPT], i)
    while True:
        width, waiting = rows.exchange(states, seats, inside, width, waiting, _LEFT)
        if width == 0:
            return
        for _ in range(_ROUNDS):
            trial(bench, steps.LANES, radius, law, wheels, 0.0)


@compiled
def trace(state, radius, law, wheels, lag):
    """What is kept of one run at the beginning of each step, and at its end, in columns."""
    bench, log, count = np.zeros(steps.ROOM), np.empty((steps.KEPT, 64)), 0
    seats = bench.reshape(-1, steps.LANES)
    rows.sit(seats, 0, state, 0)
    begin(bench, 1, law, wheels, lag)
    while True:
        if count == log.shape[1]:
            log = steps.doubled(log)
        rows.sit(log, count, seats[: steps.KEPT], 0)
        if not bench[steps.LEFT] > 0.0:
            return log[:, : count + 1]
        trial(bench, 1, radius, law, wheels, lag)
        count += int(bench[steps.TAKEN])


@compiled
def sample(log, t, law, wheels, lag, record, goal):
    """Record the run at the times t."""
    bench, step, size = np.zeros(steps.ROOM), 0, 6 if lag > 0.0 else 4
    for first in range(0, t.size, steps.LANES):
        step = sit_back(bench, log, t[first : first + steps.LANES], step)
        for stage in range(1, steps.LAST + 1):
            steps.move(bench, steps.LANES, size, stage)
            slopes(bench, steps.LANES, stage, law, wheels, lag)
        put_down(bench, record, first, goal)


@compiled
def begun(runs, whole, radius, most):
    """What is kept of runs when they begin, one a column."""
    states = np.zeros((steps.KEPT, runs.shape[1]))
    for i in range(runs.shape[1]):
        start, goal, _ = rows.run_of(runs, i)
        rho, states[_ALPHA, i], states[_THETA, i] = polar_from_pose(*start, *goal)
        states[0, i], states[_TRIALS, i] = rho, most
        states[_LEFT, i] = whole if rho > radius else -whole
        for k in range(4):
            states[K_RHO // steps.LANES + k, i] = runs[6 + k, i]
    return states


@compiled
def summed_up(states, whole, radius):
    """What became of each run."""
    summary = np.empty((rows.DISTANCE + 1, states.shape[1]))
    for i in range(states.shape[1]):
        rho, alpha, theta = states[0, i], states[_ALPHA, i], states[_THETA, i]
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
        sums = wrap(theta - alpha), states[_PEAK, i], states[_LENGTH, i], rho
        rows.summarise(summary, i, outcome, states[_TIME, i], *sums)
        if outcome == rows.UNFINISHED:
            summary[rows.TIME :, i] = math.nan
    return summary


def survey(runs, law, wheels, _, dt, samples, radius, recorded):
    """As `plane.survey`; the last sample is the one before arrival."""
    whole = (samples - 1) * dt
    states, how = begun(runs, whole, radius, MOST_TRIALS), (radius, law, wheels)
    ends = states.copy()
    drive(ends, *how)
    summary = summed_up(ends, whole, radius)
    records = np.full((rows.LYAPUNOV, runs.shape[1], samples if recorded else 0), np.nan)
    going = np.isin(summary[rows.OUTCOME], (rows.ARRIVED, rows.TIMED_OUT))
    t = dt * np.arange(samples)
    for i in np.flatnonzero(going) if recorded else ():
        log = trace(states[:, i : i + 1], *how, 0.0)
        arrived = summary[rows.OUTCOME, i] == rows.ARRIVED
        count = max(1, np.searchsorted(t, summary[rows.TIME, i])) if arrived else samples
        sample(log, t[:count], law, wheels, 0.0, records[:, i, :count], tuple(runs[3:6, i]))
    return summary, records
