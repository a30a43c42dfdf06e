"""The two loops that close a law: one holds the twist between samples, one acts all the time.

With ``NUMBA_DISABLE_JIT=1`` both are plain Python, to be stepped through. A record has a column for
each sample, and the rows of a Trajectory from x to omega.
"""

from __future__ import annotations

import math

import numpy as np

from wmrlib import motion
from wmrlib._dop853 import FIFTH, SHARP, THIRD, TRIANGLE, growth, larger, step_error, until_event
from wmrlib.body import at_rest, hurry, last_turn, roll
from wmrlib.compilation import compiled, formula
from wmrlib.elementary import between, sincos, wrap
from wmrlib.gains import GainsFields
from wmrlib.laws import command, pose_law, saturation_scale
from wmrlib.runs import ARRIVED, DIVERGED, TIMED_OUT, UNFINISHED

MOST_TRIALS = 1_000_000  # steps
ROOM = 16  # rows: the slopes at the start and after each stage, two for swing_of, the new state


@formula
def steer(polar, goal_twist, numbers, law, wheels):
    """What a law commands, within the limits of the wheels: (v, omega)."""
    v, omega = command(*polar, *goal_twist, numbers, law)
    more = hurry(v, polar[1], wheels.min_speed)
    v, omega = more * v, more * omega
    share = saturation_scale(v, omega, wheels)
    return share * v, share * omega


@formula
def write(record, k, pose, polar, twist):
    """Write down a sample, one number at a time: to set a column at once takes long to compile."""
    record[0, k], record[1, k], record[2, k] = pose
    record[3, k], record[4, k], record[5, k] = polar
    record[6, k], record[7, k] = twist


@compiled
def held(
    record, pose, path, numbers, law, wheels, along_arc, dt, arrival_radius, hysteresis, motors, end
):
    """Hold the twist for dt, sample after sample; column k of `path` is the goal then, or its last.

    `motors` are the Wheels that have to follow, or None; `end` is a LastTurn, or None.
    Returns (samples, outcome, largest |omega|, metres rolled). A negative radius never arrives.
    """
    peak, length, rolled, before = 0.0, 0.0, 0.0, math.nan
    pose = pose[0], pose[1], wrap(pose[2])
    body, turning = (0.0, 0.0, 0.0, 0.0), 0.0
    for k in range(record.shape[1]):
        x, y, heading, v_ref, omega_ref = path[:, min(k, path.shape[1] - 1)]
        rho, alpha, theta = motion.polar_from_pose(*pose, x, y, heading)
        before = motion.keep_branch(theta, before, hysteresis)
        polar = rho, alpha, before
        v, omega = steer(polar, (v_ref, omega_ref), numbers, law, wheels)
        arrived = polar[0] <= arrival_radius
        if end is not None:
            turn = *polar, v, omega, turning, arrival_radius, dt, end
            v, omega, turning, arrived = last_turn(*turn)
            omega = omega * saturation_scale(v, omega, wheels)
        if motors is not None:
            arrived = arrived and (end is None or at_rest(body))
            v, omega, body = roll(v, omega, body, motors, dt)
        write(record, k, pose, polar, (v, omega))
        if not math.isfinite(polar[0] + v + omega):
            return k, DIVERGED, peak, length
        peak, length = max(peak, abs(omega)), length + rolled
        if arrived:
            return k + 1, ARRIVED, peak, length
        rolled = dt * abs(v)
        step = *pose, v, omega, dt
        pose = motion.arc_step(*step) if along_arc else motion.euler_step(*step)
    return record.shape[1], TIMED_OUT, peak, length


@formula
def column(goals, stage):
    return None if goals is None else goals[:, stage]


@compiled
def slopes_of(state, goal, numbers, law, wheels, motors, out):
    """Write the rates of a state, and return the twist.

    A state is the polar error, or the pose if the goal moves; then the metres rolled; and, with
    wheels that lag, their twist.
    """
    if goal is not None:
        polar = motion.polar_from_pose(state[0], state[1], state[2], goal[0], goal[1], goal[2])
        v, omega = steer(polar, (goal[3], goal[4]), numbers, law, wheels)
        sine, cosine = sincos(state[2])
        out[0], out[1], out[2], out[3] = v * cosine, v * sine, omega, v
        return v, omega
    rho, alpha = state[0], state[1]
    v_over_rho, omega = pose_law(rho, alpha, state[2], GainsFields(*numbers[:4]), law)
    more = hurry(v_over_rho * rho, alpha, wheels.min_speed)
    v_over_rho, omega = more * v_over_rho, more * omega
    share = saturation_scale(v_over_rho * rho, omega, wheels)
    v_over_rho, omega = share * v_over_rho, share * omega
    v = v_over_rho * rho
    if motors is not None:
        most, half = motors.acceleration, 0.5 * motors.track_width
        change, swing = (v - state[4]) / motors.lag, (omega - state[5]) / motors.lag
        left = between(change - half * swing, -most, most)
        right = between(change + half * swing, -most, most)
        out[4], out[5] = 0.5 * (left + right), (right - left) / (2.0 * half)
        v, omega = state[4], state[5]
        v_over_rho = v / (rho if rho != 0.0 else 1.0)
    out[0], out[1], out[2] = motion.polar_closing_rate(rho, alpha, v_over_rho, omega)
    out[3] = v
    return v, omega


@formula
def swing_of(state, slopes, goal, omega, later, free, *loop):
    """How fast omega changes, by how it is a little later; `free` is two rows to write to."""
    if goal is not None:
        x, y, heading = motion.euler_step(goal[0], goal[1], goal[2], goal[3], goal[4], later)
        goal = np.array([x, y, heading, goal[3], goal[4]])
    for i in range(state.size):
        free[0, i] = state[i] + later * slopes[i]
    return (slopes_of(free[0], goal, *loop, free[1])[1] - omega) / later


@formula
def magnitude(state):
    total = 0.0
    for number in state:
        total += abs(number)
    return total


@formula
def weighted(weights, slopes, i):
    """What the slopes of one number of the state add up to."""
    total = 0.0
    for j in range(weights.size):
        total += weights[j] * slopes[j, i]
    return total


@compiled
def attempt(state, dt, slopes, new, goals, before, radius, peak, *loop):
    """Try a step: write its slopes and the new state.

    `before` is v, omega, and how fast that changes. Returns the error in tolerances, how much of
    the step ends on its first event, and the same three at its end.
    """
    v = omega = fine = coarse = 0.0
    for stage in range(1, 13):
        for i in range(state.size):
            new[i] = state[i] + dt * weighted(TRIANGLE[stage, :stage], slopes, i)
        v, omega = slopes_of(new, column(goals, stage), *loop, slopes[stage])
    for i in range(state.size):
        scale = larger(abs(new[i]), 1e-150 if goals is None and i == 0 else 1.0)
        fine = larger(abs(dt * weighted(FIFTH, slopes, i)) / scale, fine)
        coarse = larger(abs(dt * weighted(THIRD, slopes, i)) / scale, coarse)
    swing = swing_of(new, slopes[12], column(goals, 12), omega, 1e-6 * dt, slopes[13:], *loop)
    rho, rolled = (state[0], slopes[0, 0], new[0], slopes[12, 0]), (0.0, before[0], new[3], v)
    wanted = until_event(rho, rolled, (*before[1:], omega, swing), dt, radius, peak)
    error = step_error(fine, coarse) if math.isfinite(magnitude(new) + omega) else math.inf
    return error, wanted, (v, omega, swing)


@compiled
def note(record, k, state, goal, goals, twist):
    """Write down a sample; rounding can carry rho a hair past the goal."""
    if goals is None:
        polar = larger(state[0], 0.0), state[1], state[2]
        pose = motion.pose_of_error(*polar, *goal)
    else:
        pose = state[0], state[1], wrap(state[2])
        polar = motion.polar_from_pose(*pose, goals[0, 12], goals[1, 12], goals[2, 12])
    write(record, k, pose, polar, twist)


def integrate(record, state, room, t, radius, goal, goals_at, *loop):
    """Act all the time, in steps with error control; a sample ends a step, and so do events.

    `room` is `ROOM` rows to work in. `goals_at(time, dt)` gives a moving goal at the stages of a
    step, one a column; it is None for a `goal` that stands still. Returns (samples, outcome, time,
    largest |omega|, metres rolled).
    """
    slopes, new = room[:15], room[15]
    now, step, peak, length, trials = 0.0, 0.01, 0.0, 0.0, 0
    goals = None if goals_at is None else goals_at(now, 0.0)
    v, omega = slopes_of(state, column(goals, 0), *loop, slopes[0])
    if not math.isfinite(magnitude(state) + magnitude(slopes[0]) + omega):
        return 0, DIVERGED, now, peak, length
    swing = swing_of(state, slopes[0], column(goals, 0), omega, 1e-8, slopes[13:], *loop)
    here, peak = (v, omega, swing), abs(omega)
    arrived = goals_at is None and state[0] <= radius
    for k in range(t.size):
        while now < t[k] and not arrived:
            dt = min(step, t[k] - now)
            goals = None if goals_at is None else goals_at(now, dt)
            tried = state, dt, slopes, new, goals, here, radius, peak
            error, wanted, there = attempt(*tried, *loop)
            trials, stuck = trials + 1, trials >= MOST_TRIALS
            if not stuck and error <= 1.0 and wanted >= dt:
                now = now + dt if dt < t[k] - now else t[k]
                step = max(step, growth(error) * dt) if now == t[k] else growth(error) * dt
                length, peak, here = length + abs(new[3]), max(peak, abs(there[1])), there
                for i in range(state.size):  # to copy at once takes long to compile
                    state[i], slopes[0, i] = new[i], slopes[12, i]
                state[3] = 0.0
                arrived = goals_at is None and state[0] <= radius * (1.0 + SHARP)
                continue
            step = wanted if error <= 1.0 else growth(error) * dt
            if stuck or step < 1e-290:
                lost = not magnitude(state) < 1e100 or not math.isfinite(magnitude(slopes[0]))
                return k, (DIVERGED if lost else UNFINISHED), now, peak, length
        if not math.isfinite(magnitude(state) + here[0] + here[1]):
            return k, DIVERGED, now, peak, length
        note(record, k, state, goal, goals, here[:2])
        if arrived:
            return k + 1, ARRIVED, now, peak, length
    return t.size, TIMED_OUT, now, peak, length


continuous = compiled(integrate)  # goals that move are asked for in Python
