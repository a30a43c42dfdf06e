"""The two loops that close a law: one holds the twist between samples, one acts all the time.

Below them stand the loops over many runs. With ``NUMBA_DISABLE_JIT=1`` all are plain Python, to be
stepped through. A record has a column for each sample, and the rows of a Trajectory from x to
omega.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numba
import numpy as np

from wmrlib import motion
from wmrlib._dop853 import (
    ARRIVAL_TOLERANCE,
    FIFTH,
    THIRD,
    TRIANGLE,
    growth,
    larger,
    step_error,
    until_event,
)
from wmrlib.body import Wheels, are_ideal, at_rest, hurry, last_turn, roll
from wmrlib.checks import refusal
from wmrlib.compilation import (
    compiled,
    compiled_by_its_user,
    compiled_for_now,
    formula,
    plain_python,
)
from wmrlib.elementary import between, sincos, wrap
from wmrlib.gains import GainsFields
from wmrlib.kinematics import Pose
from wmrlib.laws import command, law_name, pose_law, saturation_scale
from wmrlib.receiver import (
    BEFORE_THE_FIRST_FIX,
    Receiver,
    SampledReceiver,
    measured_pose,
    received,
)
from wmrlib.runs import ARRIVED, DIVERGED, TIMED_OUT, UNFINISHED, Arrival

MOST_TRIALS = 1_000_000  # steps of a run on its own, besides one a sample: about a second
WORKSPACE_ROWS = 16  # slopes at the start and after each stage, two for rate_of_omega, new state


class Sampling(NamedTuple):
    """The settings of sampled control: period, motion between samples, and arrival."""

    dt: float  # s
    along_arc: bool  # whether the robot moves along the arc; otherwise along the tangent
    arrival_radius: float  # m; a negative one is never reached
    hysteresis: float  # rad


@formula
def steer(polar, goal_twist, gains, law, wheels):
    """The twist (v, omega) that a law commands, within the limits of the wheels."""
    v, omega = command(*polar, *goal_twist, gains, law)  # type: ignore[call-arg]
    if wheels.min_speed > 0.0:
        more = hurry(v, polar[1], wheels.min_speed)
        v, omega = more * v, more * omega
    share = saturation_scale(v, omega, wheels)
    return share * v, share * omega


@formula
def write(record, k, pose, polar, twist):
    """Record a sample, one number at a time, because setting a column at once compiles slowly."""
    record[0, k], record[1, k], record[2, k] = pose
    record[3, k], record[4, k], record[5, k] = polar
    record[6, k], record[7, k] = twist


@compiled
def held(record, pose, path, gains, law, wheels, end, receiver, sampling):
    """Drive with sampled control: at each sample the law commands a twist, which is held for dt.

    Column k of `path` is the goal at sample k, and its last column holds from then on. `wheels` are
    Wheels or NO_LIMITS, and `end` is a LastTurn or NO_TURN. The law steers by the pose that the
    `receiver`, a SampledReceiver, measures; with None it knows the true pose, and numba compiles
    the loop without a receiver in 3 s less. The record has the true poses and polar errors.
    Returns (samples, outcome, largest |omega|, metres rolled).
    """
    dt, peak, length, rolled = sampling.dt, 0.0, 0.0, 0.0
    ideal, turns = are_ideal(wheels), end.gain > 0.0
    theta, observed_theta = math.nan, math.nan  # before the first sample
    pose = pose[0], pose[1], wrap(pose[2])
    body, turning, reception = (0.0, 0.0, 0.0, 0.0), 0.0, BEFORE_THE_FIRST_FIX
    for k in range(record.shape[1]):
        x, y, heading, v_ref, omega_ref = path[:, min(k, path.shape[1] - 1)]
        goal = x, y, heading
        rho, alpha, theta_now = motion.polar_from_pose(*pose, *goal)
        theta = motion.keep_branch(theta_now, theta, sampling.hysteresis)
        observed = polar = rho, alpha, theta
        write(record, k, pose, polar, (0.0, 0.0))  # a receiver looks there; the twist comes below
        if receiver is not None:
            reception = received(reception, record, k, receiver)
            measured = measured_pose(reception, record, k, goal, receiver)
            rho, alpha, theta_now = motion.polar_from_pose(*measured, *goal)
            observed_theta = motion.keep_branch(theta_now, observed_theta, sampling.hysteresis)
            observed = rho, alpha, observed_theta
        v, omega = steer(observed, (v_ref, omega_ref), gains, law, wheels)
        arrived = observed[0] <= sampling.arrival_radius
        if turns:
            turn = *observed, v, omega, turning, sampling.arrival_radius, dt, end
            v, omega, turning, arrived = last_turn(*turn)
            omega = omega * saturation_scale(v, omega, wheels)
        if not ideal:
            arrived = arrived and (not turns or at_rest(body))
            v, omega, body = roll(v, omega, body, wheels, dt)
        record[6, k], record[7, k] = v, omega
        if not math.isfinite(polar[0] + v + omega):
            return k, DIVERGED, peak, length
        peak, length = max(peak, abs(omega)), length + rolled
        if arrived:
            return k + 1, ARRIVED, peak, length
        rolled = dt * abs(v)
        step = *pose, v, omega, dt
        pose = motion.arc_step(*step) if sampling.along_arc else motion.euler_step(*step)
    return record.shape[1], TIMED_OUT, peak, length


_held_with_own = compiled_for_now(held)


def held_by(law):
    """`held` for a law: with one that its user has compiled, or in plain Python with a function."""
    if not callable(law):
        return held
    return _compiled_with_own if compiled_by_its_user(law) else plain_python(held)


def _compiled_with_own(record, pose, path, gains, law, *robot):
    try:
        return _held_with_own(record, pose, path, gains, law, *robot)
    except numba.core.errors.TypingError as error:
        needed = "numbers, or a tuple, NamedTuple or array of them,"
        remark = f" for {law_name(law)}, which numba has compiled: {error.msg.splitlines()[0]}"
        raise refusal("gains", gains, needed, remark) from error


@formula
def column(goals, stage):
    """The goal at a stage of a step, or None if it stands still."""
    return None if goals is None else goals[:, stage]


@compiled
def slopes_of(state, goal, numbers, law, wheels, out):
    """Write the rates of a state, and return the twist.

    A state is the polar error, or the pose if the goal moves; then the metres rolled; and, if the
    wheels lag, the twist that they have. `goal` is None if it stands still.
    """
    if goal is not None:
        polar = motion.polar_from_pose(state[0], state[1], state[2], goal[0], goal[1], goal[2])
        v, omega = steer(polar, (goal[3], goal[4]), numbers, law, wheels)
        sine, cosine = sincos(state[2])
        out[0], out[1], out[2], out[3] = v * cosine, v * sine, omega, v
        return v, omega
    rho, alpha = state[0], state[1]
    v_over_rho, omega = pose_law(rho, alpha, state[2], GainsFields(*numbers[:4]), law)
    if wheels.min_speed > 0.0:
        more = hurry(v_over_rho * rho, alpha, wheels.min_speed)
        v_over_rho, omega = more * v_over_rho, more * omega
    share = saturation_scale(v_over_rho * rho, omega, wheels)
    v_over_rho, omega = share * v_over_rho, share * omega
    v = v_over_rho * rho
    if state.size > 4:
        most, half = wheels.acceleration, 0.5 * wheels.track_width
        change, omega_rate = (v - state[4]) / wheels.lag, (omega - state[5]) / wheels.lag
        left = between(change - half * omega_rate, -most, most)
        right = between(change + half * omega_rate, -most, most)
        out[4], out[5] = 0.5 * (left + right), (right - left) / (2.0 * half)
        v, omega = state[4], state[5]
        v_over_rho = v / (rho if rho != 0.0 else 1.0)
    out[0], out[1], out[2] = motion.polar_closing_rate(rho, alpha, v_over_rho, omega)
    out[3] = v
    return v, omega


@formula
def rate_of_omega(state, slopes, goal, omega, delta, scratch, *loop):
    """The rate of omega [rad/s^2], as a difference over `delta` s; `scratch` is two free rows."""
    if goal is not None:
        x, y, heading = motion.euler_step(goal[0], goal[1], goal[2], goal[3], goal[4], delta)
        goal = np.array([x, y, heading, goal[3], goal[4]])
    for i in range(state.size):
        scratch[0, i] = state[i] + delta * slopes[i]
    return (slopes_of(scratch[0], goal, *loop, scratch[1])[1] - omega) / delta


@formula
def magnitude(state):
    """The sum of the absolute values, which is finite only if all of them are."""
    total = 0.0
    for number in state:
        total += abs(number)
    return total


@formula
def weighted(weights, slopes, i):
    """The weighted sum of the slopes of entry i of the state."""
    total = 0.0
    for j in range(weights.size):
        total += weights[j] * slopes[j, i]
    return total


@compiled
def attempt(state, dt, slopes, new, goals, begin, radius, peak, *loop):
    """Try a step: write its slopes and the new state.

    `begin` is v, omega and the rate of omega at the beginning of the step. Returns the error in
    tolerances, the time from the beginning to the first event, and the same three at the end.
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
    omega_rate = rate_of_omega(
        new, slopes[12], column(goals, 12), omega, 1e-6 * dt, slopes[13:], *loop
    )
    rho, rolled = (state[0], slopes[0, 0], new[0], slopes[12, 0]), (0.0, begin[0], new[3], v)
    event_time = until_event(rho, rolled, (*begin[1:], omega, omega_rate), dt, radius, peak)
    error = step_error(fine, coarse) if math.isfinite(magnitude(new) + omega) else math.inf
    return error, event_time, (v, omega, omega_rate)


@compiled
def write_state(record, k, state, goal, goals, twist):
    """Record a sample of a continuous run, where rounding may leave rho just below 0."""
    if goals is None:
        polar = larger(state[0], 0.0), state[1], state[2]
        pose = motion.pose_of_error(*polar, *goal)
    else:
        pose = state[0], state[1], wrap(state[2])
        polar = motion.polar_from_pose(*pose, goals[0, 12], goals[1, 12], goals[2, 12])
    write(record, k, pose, polar, twist)


def integrate(record, state, workspace, t, most_trials, radius, goal, goals_at, *loop):
    """Drive with a law that acts continuously, in steps with error control.

    Samples and events end a step. `workspace` has `WORKSPACE_ROWS` rows. `goals_at(time, dt)`
    returns a moving goal at the stages of a step, one a column; it is None for a `goal` that stands
    still. After `most_trials` steps, besides one for each sample, the run is given up.
    Returns (samples, outcome, time, largest |omega|, metres rolled).
    """
    slopes, new = workspace[:15], workspace[15]
    now, step, peak, length, trials = 0.0, 0.01, 0.0, 0.0, -t.size
    goals = None if goals_at is None else goals_at(now, 0.0)
    v, omega = slopes_of(state, column(goals, 0), *loop, slopes[0])
    if not math.isfinite(magnitude(state) + magnitude(slopes[0]) + omega):
        return 0, DIVERGED, now, peak, length
    omega_rate = rate_of_omega(state, slopes[0], column(goals, 0), omega, 1e-8, slopes[13:], *loop)
    begin, peak = (v, omega, omega_rate), abs(omega)
    arrived = goals_at is None and state[0] <= radius
    for k in range(t.size):
        while now < t[k] and not arrived:
            dt = min(step, t[k] - now)
            goals = None if goals_at is None else goals_at(now, dt)
            tried = state, dt, slopes, new, goals, begin, radius, peak
            error, event_time, end = attempt(*tried, *loop)
            trials, stuck = trials + 1, trials >= most_trials
            if not stuck and error <= 1.0 and event_time >= dt:
                now = now + dt if dt < t[k] - now else t[k]
                step = max(step, growth(error) * dt) if now == t[k] else growth(error) * dt
                length, peak, begin = length + abs(new[3]), max(peak, abs(end[1])), end
                for i in range(state.size):  # to copy at once takes long to compile
                    state[i], slopes[0, i] = new[i], slopes[12, i]
                state[3] = 0.0
                arrived = goals_at is None and state[0] <= radius * (1.0 + ARRIVAL_TOLERANCE)
                continue
            step = event_time if error <= 1.0 else growth(error) * dt
            if stuck or step < 1e-290:
                lost = not magnitude(state) < 1e100 or not math.isfinite(magnitude(slopes[0]))
                return k, (DIVERGED if lost else UNFINISHED), now, peak, length
        if not math.isfinite(magnitude(state) + begin[0] + begin[1]):
            return k, DIVERGED, now, peak, length
        write_state(record, k, state, goal, goals, begin[:2])
        if arrived:
            return k + 1, ARRIVED, now, peak, length
    return t.size, TIMED_OUT, now, peak, length


continuous = compiled(integrate)  # for a goal that stands still; a moving one is a Python function


# Many runs, one after the other -----------------------------------------------------------------

# Many runs are a table with one run a column: start, goal, gains, wheels, receiver, the number of
# the run, and its law. Here is where the rows of each begin.
GOAL = len(Pose._fields)
GAINS = GOAL + len(Pose._fields)
WHEELS = GAINS + len(GainsFields._fields)
RECEIVER = WHEELS + len(Wheels._fields)
NUMBER = RECEIVER + len(Receiver._fields)
LAW = NUMBER + 1
OUTCOME, TIME, *_, DISTANCE = range(len(Arrival._fields))  # rows of a summary


@formula
def summarise(summary, i, outcome, time, heading_error, peak_omega, path_length, distance):
    """Write the summary of run i; the time of a run that does not arrive is infinite."""
    time = time if outcome == ARRIVED else math.inf
    sums = float(outcome), time, heading_error, peak_omega, path_length, distance
    for row, value in enumerate(sums):
        summary[row, i] = value


@formula
def wheels_of(runs, i):
    """The wheels of run i."""
    width, fastest, slowest, acceleration, lag, dead, step = runs[WHEELS:RECEIVER, i]
    return Wheels(width, fastest, slowest, acceleration, lag, dead, step)


@formula
def receiver_of(runs, i, key):
    """The receiver of run i, or None without a key to its random numbers."""
    if key is None:
        return None
    sigma, fading, period, delay, late, sight, bias, drops, outage, jump, jumps, compass = runs[
        RECEIVER:NUMBER, i
    ]
    times = sigma, fading, period, delay, late, sight, bias, drops, outage, jump, jumps, compass
    return SampledReceiver(*times, int(runs[NUMBER, i]), key)


@formula
def sum_up(summary, i, record, run, dt):
    """Write the summary of the run in a record."""
    count, outcome, peak, length = run
    last = max(count - 1, 0)
    heading_error = wrap(record[5, last] - record[4, last])
    summarise(summary, i, outcome, last * dt, heading_error, peak, length, record[3, last])


@compiled
def held_runs(runs, records, first, samples, end, key, sampling):
    """Drive the runs in the columns of `runs` with sampled control, and return their summary.

    If `records` has columns for samples, those of run i are written to its run first + i.
    """
    summary, record = np.empty((DISTANCE + 1, runs.shape[1])), np.empty((8, samples))
    path = np.zeros((5, 1))
    for i in range(runs.shape[1]):
        x, y, heading, path[0, 0], path[1, 0], path[2, 0], k_rho, k_alpha, h, v_max = runs[:10, i]
        gains, law = (k_rho, k_alpha, h, v_max, 0.0, 0.0), int(runs[LAW, i])
        robot = wheels_of(runs, i), end, receiver_of(runs, i, key)
        run = held(record, (x, y, heading), path, gains, law, *robot, sampling)
        sum_up(summary, i, record, run, sampling.dt)
        copy_samples(records, first + i, record, run[0])
    return summary


def held_runs_by(law, gains, runs, records, first, samples, end, key, sampling):
    """`held_runs` with a law of a user's own; `gains` lists the gains of each run.

    :meta private:
    """
    summary, record = np.empty((DISTANCE + 1, runs.shape[1])), np.empty((8, samples))
    drive, path = held_by(law), np.zeros((5, 1), float if compiled_by_its_user(law) else object)
    for i in range(runs.shape[1]):
        start, path[:3, 0] = tuple(runs[:GOAL, i].tolist()), runs[GOAL:GAINS, i].tolist()
        robot = Wheels(*runs[WHEELS:RECEIVER, i].tolist()), end, receiver_of(runs, i, key)
        run = drive(record, start, path, gains[i], law, *robot, sampling)
        sum_up(summary, i, record, run, sampling.dt)
        copy_samples(records, first + i, record, run[0])
    return summary


@compiled
def continuous_runs(runs, records, first, t, most_trials, radius):
    """`held_runs` with a law that acts continuously, whose arrival may lie between two samples."""
    summary, record = np.empty((DISTANCE + 1, runs.shape[1])), np.empty((8, t.size))
    workspace, state = np.empty((WORKSPACE_ROWS, 4)), np.empty(4)
    for i in range(runs.shape[1]):
        x, y, heading, goal_x, goal_y, goal_heading, k_rho, k_alpha, h, v_max = runs[:10, i]
        goal = goal_x, goal_y, goal_heading
        rho, alpha, theta = motion.polar_from_pose(x, y, heading, *goal)
        state[0], state[1], state[2], state[3] = rho, alpha, theta, 0.0
        gains, law = (k_rho, k_alpha, h, v_max, 0.0, 0.0), int(runs[LAW, i])
        loop = gains, law, wheels_of(runs, i)
        run = continuous(record, state, workspace, t, most_trials, radius, goal, None, *loop)
        count, outcome, time, peak, length = run
        heading_error = wrap(state[2] - state[1])
        summarise(summary, i, outcome, time, heading_error, peak, length, max(state[0], 0.0))
        if outcome == UNFINISHED:
            summary[TIME:, i] = math.nan
        else:
            copy_samples(records, first + i, record, count if t[count - 1] <= time else count - 1)
    return summary


@formula
def copy_samples(records, run, record, count):
    """Copy the first samples of a record to those of a run."""
    for row in range(record.shape[0]):
        for k in range(min(count, records.shape[2])):
            records[row, run, k] = record[row, k]
