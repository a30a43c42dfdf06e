"""Chapter 15: two robots that start a hair apart, and turn different ways."""

from __future__ import annotations

import math

from wmrbook.live.parts import Knob
from wmrbook.stages.parts import Question, Scene, Stage
from wmrlib import GENTLE_GAINS, Pose, lyapunov, polar_error

GOAL, AWAY, HAIR, FACING = Pose(0.0, 0.0, 0.0), 5.0, 0.25, 180.0  # m, deg, deg


def seam(scene: str = "whole") -> Stage:
    """Return two robots on both sides of the seam, where theta jumps, as one of its scenes."""

    def value(side: float) -> float:
        place = AWAY * math.cos(side), AWAY * math.sin(side)
        error = polar_error(Pose(*place, math.radians(FACING)), GOAL)
        return lyapunov(*error, GENTLE_GAINS.h)

    left, right = (value(side * math.radians(HAIR)) for side in (1, -1))
    alike = abs(left - right) < 0.05 * left
    ends = "Blue {blue}, pink {pink}."
    scenes = {
        "whole": Scene(
            "They start half a degree apart and come from {ways}. Is that a problem for the "
            "proof? " + ends,
        ),
        "ask": Scene(
            ends,
            still=True,
            ask=Question(
                "Which of the two has the larger *V* at its start?",
                dict.fromkeys(
                    ("blue", "pink", "nearly the same"),
                    "*V* is {blue_value} for blue and {pink_value} for pink.",
                ),
                "nearly the same" if alike else "blue" if left > right else "pink",
            ),
        ),
    }
    knobs = {
        "side": Knob(
            0.0, -10.0, 10.0, 0.5, "the start's place round the goal", "°", label="start aside"
        ),
        "facing": Knob(FACING, 0.0, 360.0, 5.0, "the way both face at first", "°", label="facing"),
    }
    data = {"gains": GENTLE_GAINS._asdict(), "away": AWAY, "hair": HAIR}
    return Stage("seam", knobs, scenes, scene, goal=GOAL, hands=(), data=data)
