"""One run with the law acting all the time: to a goal that stands still, or after one that moves.

Each gives (t, record, outcome, peak omega, path length), as far as the run's numbers are finite.
"""

from __future__ import annotations

import math

import numpy as np

from wmrlib._checks import refusal
from wmrlib._compile import compiled
from wmrlib._loops import adaptive, plane, rows, steps
from wmrlib._vecmath import sincos
from wmrlib.laws import lyapunov_value_of
from wmrlib.motion import polar_from_pose, wrap

_MOST_TRIALS = 1_000_000.0


def to_goal(start, goal, tuning, law, wheels, t, radius, lag):
    """At the times `t` and on arrival.

    With a lag the wheels begin at rest, and the record's v and omega are what they do.
    """
    run = np.array([*start, *goal, *tuning[0]])[:, None]
    state = adaptive.begun(run, t[-1], radius, _MOST_TRIALS)
    log = adaptive.trace(state, radius, law, wheels, lag)

    def recorded(record, times):
        adaptive.sample(log, times, law, wheels, lag, record, tuple(goal))

    return _finished(t, log, radius, recorded, tuning, law)


@compiled
def _see(bench, used, stage, goals, tuning, law, wheels):
    """The slopes in the plane; column i of `goals` is the goal of run i, and its twist."""
    at, out = bench[steps.source_of(stage) :], bench[steps.SLOPES + stage * steps.STAGE :]
    for i in range(used):
        x, y, heading, goal_v, goal_omega = goals[:, i]
        pose, goal = (at[i], at[steps.ALPHA + i], at[steps.THETA + i]), (x, y, heading)
        _, _, _, v, omega = plane.observe(pose, goal, (goal_v, goal_omega), tuning, law, wheels)
        sine, cosine = sincos(at[steps.THETA + i])
        out[i], out[steps.ALPHA + i], out[steps.THETA + i] = v * cosine, v * sine, omega
        out[steps.ROLLED + i], out[steps.TURNING + i] = v, omega


@compiled
def _trials_after(bench, path, log, *loop):
    """Try steps of one length: how many are taken, as the columns of `log` before each.

    path[:, stage, k] is the goal at a stage of step k, and its twist. The next steps are of another
    length if one is refused, or could well be longer.
    """
    seats = bench.reshape(-1, steps.LANES)
    for k in range(path.shape[2]):
        dt = bench[steps.DT]
        rows.sit(log, k, seats[: steps.KEPT], 0)
        for stage in range(1, steps.BEFORE + 1):
            steps.move(bench, 1, 4, stage)
            _see(bench, 1, stage, path[:, stage, k : k + 1], *loop)
        steps.judge(bench, 1, 4, 1.0, -np.inf, adaptive.TOLERANCE)
        steps.set_steps(bench, 1)
        if bench[steps.TAKEN] == 0.0:
            return k
        if bench[steps.LEFT] < dt or not 0.8 * dt <= bench[steps.DT] <= 1.3 * dt:
            return k + 1
        bench[steps.DT] = dt
    return path.shape[2]


@compiled
def _sample_after(bench, path, record, first, *loop):
    """Record the ends of the steps; path[:, stage, i] is the goal of run i, and its twist."""
    for stage in range(1, steps.LAST + 1):
        steps.move(bench, steps.LANES, 4, stage)
        _see(bench, path.shape[2], stage, path[:, stage], *loop)
    for i in range(path.shape[2]):
        x, y = bench[steps.NEW + i], bench[steps.NEW + steps.ALPHA + i]
        pose, goal = (x, y, wrap(bench[steps.NEW + steps.THETA + i])), path[:3, steps.LAST, i]
        seen = polar_from_pose(*pose, goal[0], goal[1], goal[2])
        end = steps.SLOPES + steps.LAST * steps.STAGE + i
        v, omega = bench[end + steps.ROLLED], bench[end + steps.TURNING]
        rows.write(record, first + i, pose, seen, v, omega)


def after_reference(path_at, start, tuning, law, wheels, t):
    """In the plane, because there the line of sight may pass through zero distance."""
    bench, loop, taken, whole = np.zeros(steps.ROOM), (tuning, law, wheels), [], t[-1]
    kept = bench.reshape(-1, steps.LANES)[: steps.KEPT, :1]

    def path(begin, dt):
        times = np.clip(begin + np.multiply.outer(steps.NODES, dt), 0.0, whole)
        return path_at(times.ravel()).reshape(5, *times.shape)

    kept[:3, 0], bench[steps.LEFT], bench[steps.TRIALS] = start, whole, _MOST_TRIALS
    for stage in (0, steps.BEFORE):
        _see(bench, 1, stage, path_at(bench[steps.DT : steps.DT + 1]), *loop)
        steps.get_ready(bench, 1, stage, 1.0)
    bench[steps.DT] = min(bench[steps.STEP], whole)
    many = 1
    while bench[steps.LEFT] > 0.0:
        dt, log = np.full(many, bench[steps.DT]), np.empty((steps.KEPT, many))
        goals = path(bench[steps.TIME] + dt * np.arange(many), dt)
        count = _trials_after(bench, goals, log, *loop)
        taken.append(log[:, :count])
        many = min(2 * many, 16) if count == many else 1
    log = np.hstack([*taken, kept])

    def recorded(record, times):
        step = 0
        for first in range(0, times.size, steps.LANES):
            some = times[first : first + steps.LANES]
            step = adaptive.sit_back(bench, log, some, step)
            dt = bench[steps.DT : steps.DT + some.size]
            _sample_after(bench, path(some - dt, dt), record, first, *loop)

    return _finished(t, log, -math.inf, recorded, tuning, law)


@compiled
def _values(record, tuning, law):
    for k in range(record.shape[1]):
        rho, alpha, theta = record[rows.RHO, k], record[rows.ALPHA, k], record[rows.THETA, k]
        record[rows.LYAPUNOV, k] = lyapunov_value_of(rho, alpha, theta, tuning, law)


def _finished(t, log, radius, recorded, tuning, law):
    outcome, *_, peak, length, _ = adaptive.summed_up(log[:, -1:], t[-1], radius)[:, 0].tolist()
    if outcome == rows.UNFINISHED:
        words = f", or slower gains and wheels: it would take more than {_MOST_TRIALS:,.0f} steps"
        raise refusal("method", "continuous", "'arc' or 'euler'", words)
    end = t[-1] if outcome == rows.TIMED_OUT else log[steps.TIME // steps.LANES, -1]
    t = np.append(t[t < end], end)
    record = np.empty((rows.LYAPUNOV + 1, t.size))
    recorded(record, t)
    _values(record, tuning, law)
    if outcome == rows.DIVERGED:
        finite = np.isfinite(record[: rows.LYAPUNOV]).all(axis=0)
        known = int(np.logical_and.accumulate(finite).sum())
        t, record = t[:known], record[:, :known]
        peak, length = (peak, length) if known else (0.0, 0.0)
    return t, record, int(outcome), peak, length
