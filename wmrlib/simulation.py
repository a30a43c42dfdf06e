"""Driving the robot on the computer: the two loops that close a law.

One holds the twist between samples, and one acts all the time. With ``NUMBA_DISABLE_JIT=1`` both
are plain Python, to be stepped through.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from wmrlib._checks import choice, refusal, scalar
from wmrlib._compile import compiled, formula
from wmrlib._dop853 import FIFTH, SHARP, THIRD, TRIANGLE, growth, larger, step_error, until_event
from wmrlib._elementary import sincos, wrap
from wmrlib.gains import Gains, WheelLimits, checked_wheels
from wmrlib.kinematics import Pose
from wmrlib.laws import POSE_LAWS, command, pose_gains, pose_law
from wmrlib.laws import saturation_scale, tuning_of, value_of
from wmrlib.motion import arc_step, euler_step, polar_closing_rate, polar_from_pose, pose_of_error
from wmrlib.runs import ARRIVED, DIVERGED, OUTCOMES, TIMED_OUT, UNFINISHED
from wmrlib.runs import Trajectory, sample_count, single_pose

METHODS = ("arc", "euler", "continuous")
MOST_TRIALS = 1_000_000  # steps


def simulate(
    start: Pose,
    goal: Pose,
    gains: Gains,
    *,
    law: str = "corrected",
    method: str = "arc",
    dt: float = 0.1,
    duration: float = 60.0,
    arrival_radius: float = 0.05,
    wheels: WheelLimits | None = None,
    wheel_lag: float = 0.0,
) -> Trajectory:
    """Drive from one pose to another.

    Parameters
    ----------
    start, goal : Pose of numbers, m and rad
    gains : Gains of numbers
    law : "corrected", "printed" or "aicardi", see `control_law`
    method : "euler", the paper's: the twist is held for `dt` and the pose moves along its tangent;
        "arc": the twist is held and the pose moves along the exact arc;
        "continuous": the law acts all the time; (rho, alpha, theta) is integrated by Dormand and
        Prince's method of order 8, to 1e-10 a step.
        The first two see alpha and theta in (-pi, pi]; in the last these never jump.
    dt : float, s, between samples; "continuous" adds the moment of arrival
    duration : float, s, within which lies the last sample, where the robot stops; at most ten
        million dt
    arrival_radius : float, m, within which it stops; 0 drives on
    wheels : WheelLimits or None, see `limit_wheels`
    wheel_lag : float, s; with "continuous" and an arrival radius, the wheels start at rest and
        follow the limited command as first-order systems with this time constant (an inner loop
        with a bandwidth of 1/wheel_lag rad/s); the run's v and omega are then what the wheels do

    Returns
    -------
    Trajectory

    Raises
    ------
    ValueError : an argument is not as described; it is named with its value and what is allowed
    """
    begin, end = single_pose("start", start), single_pose("goal", goal)
    numbers, code = tuning_of(gains, law, POSE_LAWS)
    samples, dt = sample_count(dt, duration), float(dt)
    radius = scalar("arrival_radius", arrival_radius, low=0.0)
    limits, lag = checked_wheels(wheels), scalar("wheel_lag", wheel_lag, low=0.0)
    continuously = choice("method", method, METHODS) == "continuous"
    if lag and not (continuously and radius):  # on the goal itself there is no line of sight
        raise refusal("wheel_lag", lag, '0, or method "continuous" with an arrival radius,')
    t, loop = dt * np.arange(samples), (numbers, code, limits)
    if continuously:
        state = np.zeros(6 if lag else 4)
        state[:3] = polar_from_pose(*begin, *end)
        run = continuous_run(t, state, radius, end, None, *loop, lag)
    else:
        path = np.array([*end, 0.0, 0.0])[:, None]
        run = held_run(t, method, radius, begin, path, *loop)
    return trajectory(*run, end, gains, law, method)


def held_run(t, method, radius, begin, path, *loop) -> tuple:
    """(t, record, outcome, peak omega, path length) of a run whose twist is held."""
    record, dt = np.empty((9, t.size)), t[1]
    count, *sums = held(record, tuple(begin), path, *loop, method == "arc", dt, radius)
    return t[:count], record[:, :count], *sums


def continuous_run(t, state, radius, goal, goals_at, *loop) -> tuple:
    """The same of a run whose law acts all the time, to its arrival too."""
    record = np.empty((9, t.size))
    drive = continuous if goals_at is None else _continuous
    count, outcome, end, *sums = drive(record, state, t, radius, tuple(goal), goals_at, *loop)
    if outcome == UNFINISHED:
        words = f", or slower gains and wheels: it would take more than {MOST_TRIALS:,} steps"
        raise refusal("method", "continuous", "'arc' or 'euler'", words)
    t = np.append(t[: count - 1], end) if outcome == ARRIVED else t[:count]
    return t, record[:, :count], outcome, *sums


def trajectory(t, record, outcome, peak, length, *setting) -> Trajectory:
    return Trajectory(*(t, *record, OUTCOMES[outcome], *setting, peak, length))


# The loops. A record has a column for each sample, and the rows of a Trajectory from x to V.


@formula
def steer(polar, goal_twist, numbers, law, wheels):
    """What a law commands, within the limits of the wheels: (v, omega)."""
    v, omega = command(*polar, *goal_twist, numbers, law)
    share = saturation_scale(v, omega, wheels)
    return share * v, share * omega


@formula
def write(record, k, pose, polar, twist, numbers, law):
    """Write down a sample, one number at a time: to set a column at once takes long to compile."""
    record[0, k], record[1, k], record[2, k] = pose
    record[3, k], record[4, k], record[5, k] = polar
    record[6, k], record[7, k] = twist
    record[8, k] = value_of(*polar, numbers, law)


@compiled
def held(record, pose, path, numbers, law, wheels, along_arc, dt, arrival_radius):
    """Hold the twist for dt, sample after sample; column k of `path` is the goal then, or its last.

    Returns (samples, outcome, largest |omega|, metres rolled). A negative radius never arrives.
    """
    peak, length, rolled = 0.0, 0.0, 0.0
    pose = pose[0], pose[1], wrap(pose[2])
    for k in range(record.shape[1]):
        x, y, heading, v_ref, omega_ref = path[:, min(k, path.shape[1] - 1)]
        polar = polar_from_pose(*pose, x, y, heading)
        v, omega = steer(polar, (v_ref, omega_ref), numbers, law, wheels)
        write(record, k, pose, polar, (v, omega), numbers, law)
        if not math.isfinite(polar[0] + v + omega):
            return k, DIVERGED, peak, length
        peak, length = max(peak, abs(omega)), length + rolled
        if polar[0] <= arrival_radius:
            return k + 1, ARRIVED, peak, length
        rolled = dt * abs(v)
        if along_arc:
            pose = arc_step(*pose, v, omega, dt)
        else:
            pose = euler_step(*pose, v, omega, dt)
    return record.shape[1], TIMED_OUT, peak, length


@formula
def slopes_of(state, goal, numbers, law, wheels, lag, out):
    """Write the rates of a state, and return the twist.

    A state is the polar error, or the pose if the goal moves; then the metres rolled; and, with
    wheels that lag, their twist.
    """
    if goal is not None:
        polar = polar_from_pose(state[0], state[1], state[2], goal[0], goal[1], goal[2])
        v, omega = steer(polar, (goal[3], goal[4]), numbers, law, wheels)
        sine, cosine = sincos(state[2])
        out[0], out[1], out[2], out[3] = v * cosine, v * sine, omega, v
        return v, omega
    rho, alpha = state[0], state[1]
    v_over_rho, omega = pose_law(rho, alpha, state[2], pose_gains(numbers), law)
    share = saturation_scale(v_over_rho * rho, omega, wheels)
    v_over_rho, omega = share * v_over_rho, share * omega
    v = v_over_rho * rho
    if lag > 0.0:
        out[4], out[5] = (v - state[4]) / lag, (omega - state[5]) / lag
        v, omega = state[4], state[5]
        v_over_rho = v / (rho if rho != 0.0 else 1.0)
    out[0], out[1], out[2] = polar_closing_rate(rho, alpha, v_over_rho, omega)
    out[3] = v
    return v, omega


@formula
def swing_of(state, slopes, goal, omega, later, out, *loop):
    """How fast omega changes, by how it is a little later."""
    if goal is not None:
        x, y, heading = euler_step(goal[0], goal[1], goal[2], goal[3], goal[4], later)
        goal = np.array([x, y, heading, goal[3], goal[4]])
    return (slopes_of(state + later * slopes, goal, *loop, out)[1] - omega) / later


@compiled
def attempt(state, dt, slopes, new, goals, before, radius, peak, *loop):
    """Try a step: write its slopes and the new state.

    `before` is v, omega, and how fast that changes. Returns the error in tolerances, how much of
    the step ends on its first event, and the same three at its end.
    """
    v = omega = 0.0
    for stage in range(1, 13):
        for i in range(state.size):
            total = 0.0
            for j in range(stage):
                total += TRIANGLE[stage, j] * slopes[j, i]
            new[i] = state[i] + dt * total
        goal = None if goals is None else goals[:, stage]
        v, omega = slopes_of(new, goal, *loop, slopes[stage])
    fine = coarse = 0.0
    for i in range(state.size):
        fifth = third = 0.0
        for j in range(12):
            fifth += FIFTH[j] * slopes[j, i]
            third += THIRD[j] * slopes[j, i]
        scale = larger(abs(new[i]), 1e-150 if goals is None and i == 0 else 1.0)
        fine, coarse = larger(abs(dt * fifth) / scale, fine), larger(abs(dt * third) / scale, coarse)
    goal = None if goals is None else goals[:, 12]
    swing = swing_of(new, slopes[12], goal, omega, 1e-6 * dt, slopes[13], *loop)
    rho, rolled = (state[0], slopes[0, 0], new[0], slopes[12, 0]), (0.0, before[0], new[3], v)
    turning = before[1], before[2], omega, swing
    wanted = until_event(rho, rolled, turning, dt, radius, peak)
    error = step_error(fine, coarse) if math.isfinite(new.sum() + omega) else math.inf
    return error, wanted, (v, omega, swing)


@compiled
def note(record, k, state, goal, goals, stage, twist, numbers, law, wheels, lag):
    """Write down a sample; rounding can carry rho a hair past the goal."""
    if goals is None:
        polar = larger(state[0], 0.0), state[1], state[2]
        pose = pose_of_error(*polar, *goal)
    else:
        pose = state[0], state[1], wrap(state[2])
        polar = polar_from_pose(*pose, goals[0, stage], goals[1, stage], goals[2, stage])
    write(record, k, pose, polar, twist, numbers, law)


def _continuous(record, state, t, radius, goal, goals_at, *loop):
    """Act all the time, in steps with error control; a sample ends a step, and so do events.

    `goals_at(time, dt)` gives a moving goal at the stages of a step, one a column; it is None for a
    `goal` that stands still. Returns (samples, outcome, time, largest |omega|, metres rolled).
    """
    slopes, new = np.empty((14, state.size)), np.empty(state.size)
    now, step, peak, length, trials = 0.0, 0.01, 0.0, 0.0, 0
    goals = None if goals_at is None else goals_at(now, 0.0)
    now_goal = None if goals is None else goals[:, 0]
    v, omega = slopes_of(state, now_goal, *loop, slopes[0])
    if not math.isfinite(state.sum() + slopes[0].sum() + omega):
        return 0, DIVERGED, now, peak, length
    here = v, omega, swing_of(state, slopes[0], now_goal, omega, 1e-8, slopes[13], *loop)
    note(record, 0, state, goal, goals, 0, here[:2], *loop)
    peak = abs(omega)
    if goals_at is None and state[0] <= radius:
        return 1, ARRIVED, now, peak, length
    for k in range(1, t.size):
        while now < t[k]:
            dt = min(step, t[k] - now)
            goals = None if goals_at is None else goals_at(now, dt)
            tried = state, dt, slopes, new, goals, here, radius, peak
            error, wanted, there = attempt(*tried, *loop)
            trials, stuck = trials + 1, trials >= MOST_TRIALS
            if not stuck and error <= 1.0 and wanted >= dt:
                now = now + dt if dt < t[k] - now else t[k]
                step = max(step, growth(error) * dt) if now == t[k] else growth(error) * dt
                length, peak, here = length + abs(new[3]), max(peak, abs(there[1])), there
                state[:], slopes[0], state[3] = new, slopes[12], 0.0
                if goals_at is None and state[0] <= radius * (1.0 + SHARP):
                    note(record, k, state, goal, goals, 12, here[:2], *loop)
                    return k + 1, ARRIVED, now, peak, length
                continue
            step = wanted if error <= 1.0 else growth(error) * dt
            if stuck or step < 1e-290:
                lost = not np.abs(state).max() < 1e100 or not math.isfinite(slopes[0].sum())
                return k, (DIVERGED if lost else UNFINISHED), now, peak, length
        if not math.isfinite(state.sum() + here[0] + here[1]):
            return k, DIVERGED, now, peak, length
        note(record, k, state, goal, goals, 12, here[:2], *loop)
    return t.size, TIMED_OUT, now, peak, length


continuous = compiled(_continuous)
