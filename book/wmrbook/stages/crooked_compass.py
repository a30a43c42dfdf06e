"""Chapter 11: a robot that believes that it is parked."""

from __future__ import annotations

import math

from wmrbook.live.parts import Knob
from wmrbook.stages.parts import Question, Scene, Stage, off_heading
from wmrlib import GENTLE_GAINS, Gains, Pose, control_law, simulate

START, GOAL = Pose(0.0, 0.0, 0.0), Pose(8.0, 3.0, math.pi / 3.0)
BIAS, ARM, DT = 12.0, 0.3, 0.05  # deg, m, s


def misled(rho: float, alpha: float, theta: float, gains: Gains) -> tuple[float, float]:
    """Return the twist of a robot whose compass is BIAS off, and its antenna over its axle."""
    return control_law(rho, alpha - math.radians(BIAS), theta, gains)


def crooked_compass(scene: str = "near") -> Stage:
    """Return a drive by a compass that is off, and an antenna ahead, as one of its scenes."""
    run = simulate(START, GOAL, GENTLE_GAINS, law=misled, method="arc", dt=DT, duration=60.0)
    arrives, off = run.rho[-1] <= 0.05, off_heading(run)
    ends = "It drives until it believes it is parked. It {ends}."
    scenes = {
        "near": Scene(ends + " The law is right: what is wrong?", look="near"),
        "whole": Scene(ends),
        "ask": Scene(
            ends,
            look="near",
            still=True,
            ask=Question(
                "The compass is {bias} off. If the antenna stood over the axle, what would be "
                "right?",
                dict.fromkeys(("its place", "its heading", "neither"), "it {ends}."),
                "its place" if arrives and off > 1 else "neither" if off > 1 else "its heading",
                {"arm": 0.0},
            ),
        ),
    }
    knobs = {
        "bias": Knob(
            BIAS, -20.0, 20.0, 0.5, "how far off the compass is", "°", label="compass off"
        ),
        "arm": Knob(
            ARM, 0.0, 0.5, 0.01, "the antenna ahead of the axle", "m", label="antenna ahead"
        ),
    }
    data = {"gains": GENTLE_GAINS._asdict(), "dt": DT, "radius": 0.05, "steps": round(60.0 / DT)}
    return Stage("crooked_compass", knobs, scenes, scene, start=START, goal=GOAL, data=data)
