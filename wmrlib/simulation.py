"""Driving the robot on the computer: to a goal that stands still, and after one that moves."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from wmrlib import runs
from wmrlib._dop853 import NODES
from wmrlib.body import NO_TURN, LastTurn, Wheels, are_ideal, checked_turn, checked_wheels
from wmrlib.checks import choice, instance, reals, refusal, scalar
from wmrlib.compilation import compiled_by_its_user
from wmrlib.elementary import wrap
from wmrlib.gains import Gains, KanayamaGains, LinearGains
from wmrlib.kinematics import Pose, Reference
from wmrlib.laws import POSE_LAWS, TRACKING_LAWS, law_name, tuning_of
from wmrlib.loops import MOST_TRIALS, WORKSPACE_ROWS, Sampling, continuous, held_by, integrate
from wmrlib.motion import polar_from_pose
from wmrlib.runs import METHODS, Trajectory


def simulate(
    start: Pose,
    goal: Pose,
    gains: Gains | Any,
    *,
    law: str | Callable = "corrected",
    method: str = "arc",
    dt: float = 0.1,
    duration: float = 60.0,
    arrival_radius: float = 0.05,
    wheels: Wheels | None = None,
    last_turn: LastTurn | None = None,
    hysteresis: float = 0.0,
) -> Trajectory:
    """Drive from one pose to another.

    Parameters
    ----------
    start, goal : Pose of numbers, m and rad
    gains : Gains of numbers; for a law of your own whatever it understands
    law : "corrected", "printed", "aicardi", "barrier" or "graceful", see `control_law`; or, with
        "arc" and "euler", a function (rho, alpha, theta, gains) -> (v, omega), in m, rad, m/s and
        rad/s. In plain Python a run takes about 20 us a step, a hundred times as long as with a
        built-in law; a function compiled by numba takes a few times as long as these, after its
        first call, which compiles it into the loop for some seconds.
    method : "euler", Euler's: the twist is held for `dt` and the pose moves along its tangent;
        "arc": the twist is held and the pose moves along the exact arc;
        "continuous": the law acts all the time; (rho, alpha, theta) is integrated by Dormand and
        Prince's method of order 8, to 1e-10 a step, in at most a million steps besides the samples.
        In the first two alpha and theta are in (-pi, pi]; in the last they never jump.
    dt : float, s, between samples; "continuous" adds the moment of arrival
    duration : float, s, within which lies the last sample, where the robot stops; at most ten
        million dt
    arrival_radius : float, m, within which it stops; 0 drives on
    wheels : Wheels, or None for ideal ones. Wheels that do not reach a commanded speed at once
        start at rest, and the run's v and omega are the driven twist ("arc" and "euler": its mean
        until the next sample). "continuous" needs an arrival radius and a lag for these, and knows
        no dead band and no encoder steps.
    last_turn : LastTurn or None; with "arc" and "euler", turn on the spot within the arrival radius
    hysteresis : float, rad; with "arc" and "euler", theta does not jump by 2 pi until its old
        branch is pi + hysteresis from 0, so the run's theta may be that large

    Returns
    -------
    Trajectory

    Raises
    ------
    ValueError : an argument is not as described; it is named with its value and what is allowed

    Examples
    --------
    With its own gains the paper's robot arrives far from the goal's heading:

    >>> import math
    >>> import wmrlib as wmr
    >>> start, goal, gains, _ = wmr.paper.outdoor()
    >>> for chosen in gains, wmr.GENTLE_GAINS:
    ...     run = wmr.simulate(start, goal, chosen, method="continuous")
    ...     print(f"{run.t[-1]:.1f} s, {math.degrees(run.heading_error[-1]):.1f} deg off")
    15.5 s, -27.2 deg off
    23.1 s, 2.1 deg off

    A law of your own, which ignores the goal's heading:

    >>> def towards(rho, alpha, theta, turn):
    ...     return min(1.0, 2.0 * rho), turn * alpha
    >>> run = wmr.simulate(start, wmr.Pose(5.0, 3.0, 0.0), 1.5, law=towards)
    >>> print(run.outcome.value)
    arrived within the arrival radius
    """
    begin, end = runs.single_pose("start", start), runs.single_pose("goal", goal)
    target = end.x, end.y, wrap(end.heading)
    samples, dt = runs.sample_count(dt, duration), float(dt)
    radius = scalar("arrival_radius", arrival_radius, low=0.0)
    continuously = choice("method", method, METHODS) == "continuous"
    hysteresis = runs.checked_hysteresis(hysteresis, method)
    turn = checked_turn(last_turn, dt, method, radius)
    robot, t = checked_wheels(wheels), dt * np.arange(samples)
    loop = *tuning_of(gains, law, POSE_LAWS), robot
    if continuously:
        _refuse_own_law(law)
        ideal = are_ideal(robot)
        if not ideal and not (radius and robot.lag):  # on the goal is no line of sight
            needed = "ideal wheels, or a lag and an arrival radius, with method 'continuous'"
            raise refusal("wheels", robot, needed)
        if robot.dead_band or robot.encoder_step:
            needed = "neither dead_band nor encoder_step with method 'continuous'"
            raise refusal("wheels", robot, needed)
        state = np.zeros(4 if ideal else 6)
        state[:3] = polar_from_pose(*begin, *target)
        run = _continuous(t, state, radius, target, None, *loop)
    else:
        path = np.array([*target, 0.0, 0.0])[:, None]
        sampling = Sampling(dt, method == "arc", radius, hysteresis)
        run = _held(t, begin, path, *loop, turn, sampling)
    return Trajectory.of(*run, end, gains, law, method)


def track(
    reference: Callable[[np.ndarray], Reference],
    start: Pose,
    gains: Gains | KanayamaGains | LinearGains | Any,
    *,
    law: str | Callable = "corrected",
    method: str = "arc",
    dt: float = 0.1,
    duration: float = 60.0,
    wheels: Wheels | None = None,
) -> Trajectory:
    """Follow a moving goal to the end of the given time.

    Parameters
    ----------
    reference : function of an array of times [s] that returns a Reference of arrays, for example
        `paper.circle`
    start : Pose of numbers, m and rad
    gains : Gains, KanayamaGains or LinearGains, as the law needs; one number a gain
    law : as in `simulate`, a function of your own included; or one that uses the reference's twist,
        v_ref and omega_ref. With the error e_x = rho cos(alpha), e_y = rho sin(alpha),
        e_h = wrap(alpha - theta),
        "kanayama": v = v_ref cos(e_h) + k_x e_x and
        omega = omega_ref + v_ref (k_y e_y + k_heading sin(e_h));
        "linear": v = v_ref cos(e_h) + K_1 e and omega = omega_ref + K_2 e
    method, dt, duration, wheels : as in `simulate`, but "continuous" integrates the pose, and its
        wheels are ideal

    Returns
    -------
    Trajectory

    Raises
    ------
    ValueError : as `simulate`

    Examples
    --------
    >>> import wmrlib as wmr
    >>> run = wmr.track(wmr.paper.circle, wmr.paper.CIRCLE_START, wmr.paper.CIRCLE_GAINS)
    >>> print(f"{wmr.residual(run):.3f} m behind")  # the paper's error "converges to 0.1 m"
    0.090 m behind
    """
    if not callable(reference):
        raise refusal("reference", reference, "a function of time")
    begin = runs.single_pose("start", start)
    samples, dt, last = runs.sample_count(dt, duration), float(dt), float(duration)
    warned_of = np.geterr()
    robot, t = checked_wheels(wheels), dt * np.arange(samples)
    loop = *tuning_of(gains, law, TRACKING_LAWS), robot

    def path_at(times: np.ndarray) -> np.ndarray:
        now = np.minimum(times, last)  # three times 0.1 is more than 0.3
        with np.errstate(**warned_of):  # the loop itself is silent
            goals = instance("reference(t)", reference(now), Reference)
        path = np.empty((len(Reference._fields), times.size))
        if all(_is_row(values, times.shape) for values in goals):
            path[:] = goals
            if np.isfinite(path).all():  # the common case, kept quick: thousands of steps
                return path
        named = {f"reference(t).{name}": values for name, values in goals._asdict().items()}
        *numbers, _ = reals(**named, t=times)
        if np.broadcast_shapes(*map(np.shape, numbers), times.shape) != times.shape:
            raise refusal("reference(t)", named, "one number, or one a time, in each field")
        for row, values in zip(path, numbers, strict=True):
            row[:] = values
        return path

    path = path_at(t)
    if choice("method", method, METHODS) == "continuous":
        _refuse_own_law(law)
        if not are_ideal(robot):
            raise refusal("wheels", robot, "ideal wheels, or method 'arc' or 'euler',")
        state = np.array([*begin, 0.0])  # in the plane: the line of sight may have no length

        def goals_at(now: float, dt: float) -> np.ndarray:
            return path_at(now + dt * NODES)

        run = _continuous(t, state, -np.inf, begin, goals_at, *loop)
    else:
        run = _held(t, begin, path, *loop, NO_TURN, Sampling(dt, method == "arc", -1.0, 0.0))
    t, record, outcome, *sums = run
    ended = runs.COMPLETED if outcome == runs.TIMED_OUT else outcome
    goal = Pose(*path[:3, : t.size])
    return Trajectory.of(t, record, ended, *sums, goal, gains, law, method)


def _is_row(values: Any, shape: tuple[int, ...]) -> bool:
    """Whether it is a plain array of floats in this shape."""
    return type(values) is np.ndarray and values.dtype == np.float64 and values.shape == shape


def _refuse_own_law(law: str | Callable) -> None:
    if callable(law):
        needed = "'arc' or 'euler'"
        raise refusal("method", "continuous", needed, f" with a law of your own, {law_name(law)}")


def _held(t, begin, path, gains, law, wheels, end, sampling) -> tuple:
    """(t, record, outcome, peak omega, path length) of a run whose twist is held."""
    record, robot = np.empty((8, t.size)), (wheels, end, None)
    if callable(law):
        path = path.astype(object) if not compiled_by_its_user(law) else path
    count, *sums = held_by(law)(record, tuple(begin), path, gains, law, *robot, sampling)
    return t[:count], record[:, :count], *sums


def _continuous(t, state, radius, goal, goals_at, *loop) -> tuple:
    """The same of a run whose law acts continuously, up to the moment of its arrival."""
    record, workspace = np.empty((8, t.size)), np.zeros((WORKSPACE_ROWS, state.size))
    drive = continuous if goals_at is None else integrate
    ends = t, MOST_TRIALS, radius, tuple(goal)
    with np.errstate(all="ignore"):  # on its way out of the range of numbers
        run = drive(record, state, workspace, *ends, goals_at, *loop)
    count, outcome, end, *sums = run
    if outcome == runs.UNFINISHED:
        words = f", or slower gains and wheels: it would take more than {MOST_TRIALS:,} steps"
        raise refusal("method", "continuous", "'arc' or 'euler'", words)
    t = np.append(t[: count - 1], end) if outcome == runs.ARRIVED else t[:count]
    return t, record[:, :count], outcome, *sums
