"""Chapter 9: a robot whose receiver is wrong, each time anew."""

from __future__ import annotations

import math

import numpy as np

from wmrbook.live.parts import Knob
from wmrbook.stages.parts import Question, Scene, Stage, gain_knobs
from wmrlib import GENTLE_GAINS, Pose, Receiver, sweep

START, GOAL = Pose(0.0, 0.0, 0.0), Pose(8.0, 3.0, math.pi / 3.0)
DAYS, SEED, DT, RADIUS, SECONDS, SIGMA = 20, 9, 0.1, 0.2, 30.0, 0.3  # s, m, s, m
ENDS = "On {days} days it {ends}."


def noisy_fixes(scene: str = "whole") -> Stage:
    """Return a short drive by noisy fixes, as one of its scenes."""
    options = {"method": "arc", "dt": DT, "arrival_radius": RADIUS, "duration": SECONDS}

    def off(k_alpha: float) -> float:
        """How far off the robots of all days end, in degrees, at worst."""
        gains = GENTLE_GAINS._replace(k_alpha=k_alpha)
        noise = Receiver(sigma=np.full(DAYS, SIGMA))
        ends = sweep(START, GOAL, gains, receiver=noise, seed=SEED, **options)
        return math.degrees(np.abs(ends.heading_error).max())

    calm, eager = off(GENTLE_GAINS.k_alpha), off(3 * GENTLE_GAINS.k_alpha)
    scenes = {
        "whole": Scene("The dots are where its receiver says it is. Where does it stop? " + ENDS),
        "near": Scene("The last metre, and where it stopped on the other days. " + ENDS, "near"),
        "ask": Scene(
            ENDS,
            "near",
            still=True,
            ask=Question(
                "If it turns three times as fast towards what it sees, it stops",
                dict.fromkeys(
                    ("less crooked", "more crooked"), f"it {{ends}}. Before it was {calm:.0f}°."
                ),
                "less crooked" if eager < calm else "more crooked",
                {"k_alpha": 3 * GENTLE_GAINS.k_alpha},
            ),
        ),
    }
    knobs = gain_knobs(GENTLE_GAINS)
    knobs["sigma"] = Knob(
        SIGMA, 0.0, 0.5, 0.01, "the standard deviation of a fix, on each axis", "m", label="noise"
    )
    data = {"v_max": GENTLE_GAINS.v_max, "radius": RADIUS, "dt": DT, "seed": SEED, "days": DAYS}
    data["steps"] = round(SECONDS / DT)
    return Stage("noisy_fixes", knobs, scenes, scene, start=START, goal=GOAL, data=data)
