"""What a run is: its samples, how it ended, and what it amounts to."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Any, NamedTuple

import numpy as np

from wmrlib._checks import Real, instance, scalar
from wmrlib.kinematics import Pose, wrap_angle

MOST_SAMPLES = 10_000_000


class Outcome(Enum):
    """How a run ended; the value is a sentence for the reader."""

    ARRIVED = "arrived within the arrival radius"
    TIMED_OUT = "did not arrive within the duration"
    DIVERGED = "left the range of numbers"
    COMPLETED = "followed the reference to the end"

    @property
    def message(self) -> str:
        return self.value


@dataclass(frozen=True, eq=False, slots=True)
class Trajectory:
    """One run: arrays of equal length, one entry a sample, which can't be written to, and how it ended.

    t: s; x, y: m; heading: rad; rho: m; alpha, theta: rad; v: m/s and omega: rad/s, what the law commands at that sample (after the
    wheel limits; with a wheel lag, what the wheels do); V: the Lyapunov function, with L = 1. goal: the goal's Pose, with array fields
    if it moves.
    """

    t: np.ndarray
    x: np.ndarray
    y: np.ndarray
    heading: np.ndarray
    rho: np.ndarray
    alpha: np.ndarray
    theta: np.ndarray
    v: np.ndarray
    omega: np.ndarray
    V: np.ndarray
    outcome: Outcome
    goal: Pose
    gains: Any
    law: str
    method: str

    def __len__(self) -> int:
        return self.t.size

    def __repr__(self) -> str:
        last = (
            f"{self.rho[-1]:.4g} m from the goal after {self.t[-1]:.4g} s"
            if len(self)
            else "no sample"
        )
        return f"<Trajectory: {self.law} law, {self.method}, {len(self)} samples, {last}: {self.outcome.message}>"

    @property
    def x_error(self) -> np.ndarray:
        """goal.x - x, metres."""
        return self.goal.x - self.x

    @property
    def y_error(self) -> np.ndarray:
        """goal.y - y, metres."""
        return self.goal.y - self.y

    @property
    def heading_error(self) -> np.ndarray:
        """Theta - alpha = heading - goal.heading, radians in (-pi, pi]."""
        return wrap_angle(self.theta - self.alpha)


class Arrival(NamedTuple):
    """What a run amounts to: numbers for one run, arrays for many.

    arrived: within the arrival radius; time: s, infinite if it did not arrive; heading_error: heading - goal.heading at the last sample,
    rad; peak_omega: largest |omega|, rad/s; path_length: m, backward motion included; distance: to the goal at the last sample, m.
    """

    arrived: bool | np.ndarray
    time: Real
    heading_error: Real
    peak_omega: Real
    path_length: Real
    distance: Real


def single_pose(name: str, pose: Pose) -> Pose:
    """The pose, if its fields are numbers and not arrays; raises ValueError, which names the argument, if not."""
    for field, value in zip(("x", "y", "heading"), instance(name, pose, Pose), strict=True):
        if type(value) is not float:
            raise ValueError(
                f"{name}.{field} = {value!r} is not allowed: one number is needed; sweep takes arrays"
            )
    return pose


def sample_count(dt: float, duration: float) -> int:
    """How many samples a run of `duration` seconds has, both ends included; raises ValueError as `simulate`."""
    dt, duration = scalar("dt", dt, above=0.0), scalar("duration", duration, above=0.0)
    if dt > duration:
        raise ValueError(
            f"dt = {dt:g} is not allowed: at most the duration, {duration:g}, is needed"
        )
    if duration / dt > MOST_SAMPLES:
        raise ValueError(
            f"duration = {duration:g} is not allowed: at most {MOST_SAMPLES:,} steps of dt = {dt:g} are needed"
        )
    return int(duration / dt + 1e-9) + 1
