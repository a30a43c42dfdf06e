"""Chapter 14: a receiver tells where a robot is, and a drive tells which way it faces."""

from __future__ import annotations

import math

import numpy as np

from wmrbook.live.parts import Knob
from wmrbook.stages.parts import Question, Scene, Stage
from wmrlib import Pose, polar_error

SIGMA, FAR, PAIRS, SEED = 0.5, 3.0, 60, 14  # m, m


def off(sigma: float, far: float) -> float:
    """Return how far off the bearing between two fixes is, in degrees, as a root mean square."""
    x, y, to_x, to_y = np.random.default_rng(SEED).normal(0.0, sigma, (4, 10_000))
    bearing = polar_error(Pose(x, y, 0.0), Pose(far + to_x, to_y, 0.0)).alpha
    return math.degrees(np.sqrt(np.mean(bearing**2)))


def course_from_gps(scene: str = "whole") -> Stage:
    """Return a straight drive, and the headings that its two fixes allow, as one scene."""
    before, after = off(SIGMA, FAR), off(SIGMA, 2 * FAR)
    shares = {"a quarter of it": 0.25, "half of it": 0.5, "as much": 1.0}
    ends = "After {far} two fixes that err by {sigma} tell it to {off}, or so."
    scenes = {
        "whole": Scene(
            "A receiver says where the robot is. Who says where it looks? " + ends, look="other"
        ),
        "ask": Scene(
            ends,
            look="other",
            still=True,
            ask=Question(
                "{far} apart, two fixes leave its heading open by {off}. How much do they leave "
                "at twice the distance?",
                dict.fromkeys(shares, "two fixes {far} apart leave it open by {off}."),
                min(shares, key=lambda answer: abs(shares[answer] - after / before)),
                {"far": 2 * FAR},
            ),
        ),
    }
    knobs = {
        "sigma": Knob(
            SIGMA, 0.01, 3.0, None, "the standard deviation of a fix", "m", label="fixes err by"
        ),
        "far": Knob(FAR, 0.5, 20.0, 0.5, "the way between two fixes", "m", label="apart"),
    }
    return Stage("course_from_gps", knobs, scenes, scene, data={"pairs": PAIRS, "seed": SEED})
