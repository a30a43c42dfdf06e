"""The law acting all the time, integrated with error control: the sampled loops' touchstone."""

from __future__ import annotations

import itertools
import math

import numpy as np

from wmrlib._checks import refusal
from wmrlib._compile import compiled
from wmrlib._loops import plane, polar, rows
from wmrlib.kinematics import PolarError, Pose, polar_error, pose_from_polar, wrap_angle
from wmrlib.laws import command, lyapunov_value_of, saturation_scale
from wmrlib.motion import polar_closing_rate


def to_goal(start, goal, tuning, law, wheels, t, arrival_radius, lag):
    """One run in (rho, alpha, theta), at the times `t` and on arrival, as `_summed_up` gives it.

    With a lag the state is (rho, alpha, theta, v, omega), from rest, and the record's v and omega
    are what the wheels do.
    """
    loop = tuning.pose, law, wheels

    def rate(_, state):
        rho, alpha, theta, *twist, _ = state
        *rates, v, omega = polar.closed_loop((max(rho, 0.0), alpha, theta), loop)  # tried past it
        if lag:
            wanted, (v, omega) = np.array([v, omega]), twist
            rates = *polar_closing_rate(rho, alpha, v / rho, omega), *(wanted - twist) / lag
        return *rates, abs(v)

    def recorded(times, states):
        states[0] = np.maximum(states[0], 0.0)  # rounding can carry rho a hair past the goal
        pose = pose_from_polar(PolarError(*states[:3]), goal)
        made = _commands(states[:3], np.zeros((2, times.size)), tuning, law, wheels)
        if lag:
            made[:2] = states[3:5]
        return np.vstack([*pose, states[:3], made])

    def left_to_go(_, state):
        return state[0] - (arrival_radius or -1.0)

    left_to_go.terminal, left_to_go.direction = True, -1.0  # type: ignore[attr-defined]
    first = polar_error(start, goal)
    begin = np.array([*first, *[0.0] * (3 if lag else 1)])
    if first.rho == math.inf:
        return t[:0], np.empty((9, 0)), rows.DIVERGED, 0.0, 0.0
    if first.rho <= arrival_radius:
        return _summed_up(t[:1], t[:1], lambda _: begin[:, None], rows.ARRIVED, recorded)
    return _integrated(rate, begin, t, recorded, left_to_go, arrival_radius)


def after_reference(path_at, start, tuning, law, wheels, t):
    """One run after a moving reference, integrated in (x, y, heading), as `_summed_up` gives it.

    In the plane, because there the line of sight may pass through zero distance.
    """

    def rate(time, state):
        x, y, heading, *twist = path_at(np.array([time]))[:, 0]
        _, _, _, v, omega = plane.observe(
            tuple(state[:3]), (x, y, heading), tuple(twist), tuning, law, wheels
        )
        return v * math.cos(state[2]), v * math.sin(state[2]), omega, abs(v)

    def recorded(times, states):
        path, pose = path_at(times), Pose(*states[:3])
        error = np.array(polar_error(pose, Pose(*path[:3])))
        made = _commands(error, path[3:], tuning, law, wheels)
        return np.vstack([*pose[:2], wrap_angle(pose.heading), error, made])

    return _integrated(rate, np.array([*start, 0.0]), t, recorded)


def _integrated(rate, begin, t, recorded, event=None, nearest=1.0):
    """The run with error control, whether its motion is fast, slow or both (stiff)."""
    from scipy.integrate import solve_ivp  # here, because importing it takes longer than all else

    most = 30_000 + 100 * t.size
    count = itertools.count()

    def counted(time, state):
        if next(count) > most:
            words = f", or other gains: the law would act more than {most:,} times"
            raise refusal("method", "continuous", "'arc' or 'euler'", words)
        return rate(time, state)

    # A first step of its own: the run is then the same whatever its duration.
    more = {"first_step": min(1e-12, t[-1]), "dense_output": True, "rtol": 1e-11}
    more["atol"] = [min(1e-13, 1e-10 * (nearest or 1.0)), *[1e-13] * (begin.size - 1)]
    run = solve_ivp(counted, (0.0, t[-1]), begin, "LSODA", events=event, **more)
    outcome = (rows.TIMED_OUT, rows.ARRIVED, rows.DIVERGED)[run.status]
    end = run.t[-1]
    return _summed_up(np.append(t[t < end], end), run.t, run.sol, outcome, recorded)


def _summed_up(t, steps, state_at, outcome, recorded):
    """(t, record, outcome, peak omega, path length), as far as the run's numbers are finite.

    The last of the states is the metres rolled; the steps are those of the integrator.
    """
    states = state_at(t)
    whole = np.isfinite(states).all(axis=0)
    record = recorded(t, np.where(whole, states, 0.0))
    finite = whole & np.isfinite(record[rows.RHO : rows.LYAPUNOV]).all(axis=0)
    known = int(np.logical_and.accumulate(finite).sum())
    if known < t.size:
        t, record, outcome = t[:known], record[:, :known], rows.DIVERGED
    if not known:
        return t, record, outcome, 0.0, 0.0
    moments = np.union1d(t, steps[steps <= t[-1]])
    places = np.arange(8 * moments.size - 7) / 8.0
    times, peak = np.interp(places, np.arange(moments.size), moments), 0.0
    for _ in range(8):  # ever closer around the peak
        turning = np.abs(recorded(times, state_at(times))[rows.OMEGA])
        k, peak = int(turning.argmax()), max(peak, turning.max())
        times = np.linspace(times[max(k - 1, 0)], times[min(k + 1, times.size - 1)], 17)
    return t, record, outcome, peak, states[-1, known - 1]


@compiled
def _commands(polar, goal_twist, tuning, law, wheels):
    """What the law commands in each column of `polar`, (v, omega), and V."""
    made = np.empty((3, polar.shape[1]))
    for k in range(polar.shape[1]):
        rho, alpha, theta = polar[:, k]
        v, omega = command(rho, alpha, theta, goal_twist[0, k], goal_twist[1, k], tuning, law)
        share = saturation_scale(v, omega, wheels)
        made[:, k] = (share * v, share * omega, lyapunov_value_of(rho, alpha, theta, tuning, law))
    return made
