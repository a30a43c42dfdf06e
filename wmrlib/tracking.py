"""Driving the robot on the computer, after a goal that moves."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from wmrlib._checks import choice, instance, reals, refusal
from wmrlib._dop853 import NODES
from wmrlib.gains import Gains, KanayamaGains, LinearGains, WheelLimits, checked_wheels
from wmrlib.kinematics import Pose, Reference
from wmrlib.laws import TRACKING_LAWS, tuning_of
from wmrlib.runs import COMPLETED, TIMED_OUT, Trajectory, sample_count, single_pose
from wmrlib.simulation import METHODS, continuous_run, held_run, trajectory


def track(
    reference: Callable[[np.ndarray], Reference],
    start: Pose,
    gains: Gains | KanayamaGains | LinearGains,
    *,
    law: str = "corrected",
    method: str = "arc",
    dt: float = 0.1,
    duration: float = 60.0,
    wheels: WheelLimits | None = None,
) -> Trajectory:
    """Follow a moving goal to the end of the given time.

    Parameters
    ----------
    reference : function of an array of times [s] that returns a Reference of arrays, for example
        `paper.circle`
    start : Pose of numbers, m and rad
    gains : Gains, KanayamaGains or LinearGains, as the law needs; one number a gain
    law : as in `simulate`, or one that uses the reference's twist, v_ref and omega_ref; with the
        error e_x = rho cos(alpha), e_y = rho sin(alpha), e_h = wrap(alpha - theta),
        "kanayama": v = v_ref cos(e_h) + k_x e_x and
        omega = omega_ref + v_ref (k_y e_y + k_heading sin(e_h));
        "linear": v = v_ref cos(e_h) + K_1 e and omega = omega_ref + K_2 e
    method, dt, duration, wheels : as in `simulate`, but "continuous" integrates the pose

    Returns
    -------
    Trajectory

    Raises
    ------
    ValueError : as `simulate`
    """
    if not callable(reference):
        raise refusal("reference", reference, "a function of time")
    begin = single_pose("start", start)
    numbers, code = tuning_of(gains, law, TRACKING_LAWS)
    samples, dt = sample_count(dt, duration), float(dt)
    t, loop = dt * np.arange(samples), (numbers, code, checked_wheels(wheels))

    def path_at(times: np.ndarray) -> np.ndarray:
        seen = reference(np.minimum(times, duration))  # three times 0.1 is more than 0.3
        path = np.empty((len(Reference._fields), times.size))
        for row, values in zip(path, instance("reference(t)", seen, Reference), strict=True):
            row[:] = values
        return path

    first = instance("reference(t)", reference(np.minimum(t, duration)), Reference)._asdict()
    named = {f"reference(t).{name}": values for name, values in first.items()}
    if np.broadcast_shapes(*map(np.shape, reals(**named, t=t))) != t.shape:
        raise refusal("reference(t)", named, "one number, or one a time, in each field")
    path = path_at(t)
    if choice("method", method, METHODS) == "continuous":
        state = np.array([*begin, 0.0])  # in the plane: the line of sight may have no length

        def goals_at(now: float, dt: float) -> np.ndarray:
            return path_at(now + dt * NODES)

        run = continuous_run(t, state, -np.inf, begin, goals_at, *loop, 0.0)
    else:
        run = held_run(t, method, -1.0, begin, path, *loop)
    t, record, outcome, *sums = run
    ended = COMPLETED if outcome == TIMED_OUT else outcome
    return trajectory(t, record, ended, *sums, Pose(*path[:3, : t.size]), gains, law, method)
