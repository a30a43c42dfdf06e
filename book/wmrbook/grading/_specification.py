"""A drive with limits that a student tunes gains for, and the same gains from other starts."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from wmrbook.grading._asking import gains_of
from wmrbook.grading._hints import expect
from wmrlib.gains import Gains
from wmrlib.kinematics import Pose
from wmrlib.metrics import arrival
from wmrlib.paper import OUTDOOR_GAINS
from wmrlib.runs import Arrival, Trajectory
from wmrlib.simulation import simulate
from wmrlib.sweeping import sweep


class Limits(NamedTuple):
    """What a drive may take at most."""

    time: float  # s
    heading_deg: float
    omega: float = math.inf  # rad/s


def driveable(name: str, value: Any) -> Gains:
    """Return the value if it is gains that the paper's robot can have, or raise Hint."""
    gains, most = gains_of(name, value), OUTDOOR_GAINS.v_max
    hint = f"v_max = {gains.v_max:g} m/s: the robot can do no more than {most:g} m/s."
    expect(gains.v_max <= most, hint)
    return gains


def drive(start: Pose, goal: Pose, gains: Gains, **options: Any) -> tuple[Trajectory, Arrival]:
    """Return the run with these gains, and its arrival."""
    run = simulate(start, goal, gains, **options)
    return run, arrival(run)


def exceeded(end: Arrival, limits: Limits) -> list[str]:
    """Return the limits of time and heading that an arrival does not keep."""
    off, sentences = abs(math.degrees(end.heading_error)), []
    if end.time > limits.time:
        sentences = [f"it takes {end.time:.1f} s, where {limits.time:g} s are allowed"]
    if off > limits.heading_deg:
        allowed = f"where {limits.heading_deg:g} deg are allowed"
        sentences += [f"the heading is {off:.2f} deg off, {allowed}"]
    return sentences


def elsewhere(gains: Gains, side: float, **options: Any) -> Any:
    """Sweep over 20 starts that face at most `side` rad beside the goal, and their mirrors."""
    low, high = (20.0, -math.pi, -side), (60.0, math.pi, side)
    far, sight, beside = np.random.default_rng(7).uniform(low, high, (20, 3)).T
    x, y, heading = -far * np.cos(sight), -far * np.sin(sight), sight + beside
    starts = Pose(np.append(x, x), np.append(y, -y), np.append(heading, -heading))
    return sweep(starts, Pose(0.0, 0.0, 0.0), gains, progress=False, **options)


def all_parked(ends: Arrival, seconds: float, heading_deg: float) -> str:
    """Say how the other starts ended; raise Hint unless they all parked."""
    late = np.sum(~ends.arrived)
    expect(late == 0, f"of 40 other starts, {late} have not arrived after {seconds:.0f} s.")
    off = np.abs(np.degrees(ends.heading_error))
    hint = (
        f"of 40 other starts, {np.sum(off > heading_deg)} end more than {heading_deg:g} deg off, "
    )
    expect(off.max() <= heading_deg, f"{hint}the worst {off.max():.0f} deg.")
    starts = "40 other starts, 20 and their mirror images"
    return f"{starts}: all arrive, the worst {off.max():.1f} deg off"
