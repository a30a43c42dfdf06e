"""Chapter 15: how soon, which way at the seam, with noise, and a millimetre beside the goal."""

from __future__ import annotations

import math

import numpy as np

from wmrbook.live.parts import Choice, Knob
from wmrbook.stages.parts import Question, Scene, Stage
from wmrlib import GENTLE_GAINS, Pose, Receiver, lyapunov, polar_error, sweep
from wmrlib.paper import OUTDOOR_GAINS

GOAL, AWAY, HAIR, FACING = Pose(0.0, 0.0, 0.0), 5.0, 0.25, 180.0  # m, deg, deg
CLOSE, NOISE = 0.5, 2.0  # m and deg, of the robots that see their goal through noise
SWARM = {"robots": 40, "dt": 0.01, "radius": 0.05, "seed": 5, "steps": 1000}
AIDE = ("gains", "facing")
BESIDE = {"1 m": 1.0, "1 mm": 1e-3, "1 µm": 1e-6}
PARK = "With {noise} of noise and {hysteresis} of hysteresis {lost} robots (red) park over 90° off."
CAME = "Blue {blue}, pink {pink}."


def seam(scene: str = "whole") -> Stage:
    """Return the robots with which chapter 15 takes up the proof again, as one of its scenes."""

    def value(side: float) -> float:
        place = AWAY * math.cos(side), AWAY * math.sin(side)
        error = polar_error(Pose(*place, math.radians(FACING)), GOAL)
        return lyapunov(*error, GENTLE_GAINS.h)

    left, right = (value(side * math.radians(HAIR)) for side in (1, -1))
    alike = abs(left - right) < 0.05 * left
    share = _lost()
    answers = {
        "fewer than 4 of 40": share < 0.1,
        "over half, but not all": 0.5 < share < 1.0,
        "all 40": share == 1.0,
    }
    scenes = {
        "whole": Scene(
            "They start half a degree apart and come from {ways}. Is that a problem for the "
            f"proof? {CAME}",
            handles=("side", "facing"),
        ),
        "soon": Scene(
            "Grey need not turn and is within 1 cm of the goal after {straight}. Blue is there "
            "after {seconds}.",
            "other",
            handles=AIDE,
        ),
        "level": Scene(
            "*W*, in the corner, never rises. At the dots it is level: there the robot looks "
            "straight at its goal.",
            "other",
            to={"gains": "paper", "facing": 90.0},
            handles=AIDE,
        ),
        "cusp": Scene(
            "At first the goal is {alpha} off its nose, and it {cusps}. In the corner: *alpha*, "
            "and where it is 90°. Turn the robot.",
            "other",
            to={"facing": 30.0},
            handles=AIDE,
        ),
        "ask": Scene(
            CAME,
            still=True,
            handles=("side", "facing"),
            ask=Question(
                "Which of the two has the larger *V* at its start?",
                dict.fromkeys(
                    ("blue", "pink", "nearly the same"),
                    "*V* is {blue_value} for blue and {pink_value} for pink.",
                ),
                "nearly the same" if alike else "blue" if left > right else "pink",
            ),
        ),
        "noise": Scene(
            PARK,
            "other",
            still=True,
            empty=True,
            to={"noise": 0.0},
            handles=("noise", "hysteresis"),
            ask=Question(
                "40 robots face their goal, but should face the other way. Without noise all turn "
                "to one side. With 2° of noise, how many park over 90° off?",
                dict.fromkeys(answers, "with {noise} of noise {lost} park over 90° off (red)."),
                next(answer for answer, right in answers.items() if right),
                {"noise": NOISE},
            ),
        ),
        "hysteresis": Scene(
            PARK,
            "other",
            empty=True,
            to={"hysteresis": 0.2},
            handles=("noise", "hysteresis"),
        ),
        "beside": Scene(
            "It starts {apart} beside its goal, with the right heading. On its way the heading is "
            "up to {swing} off.",
            "other",
            empty=True,
            handles=("apart", "gains"),
        ),
    }
    knobs = {
        "gains": Choice(
            "gentle",
            {"gentle": "the gentle gains", "paper": "the paper's gains"},
            "the gains of the law",
            "It drives with",
        ),
        "apart": Choice(
            "1 mm", {name: name for name in BESIDE}, "how far beside its goal it starts", "Beside"
        ),
        "side": Knob(
            0.0, -10.0, 10.0, 0.5, "the start's place round the goal", "°", label="start aside"
        ),
        "facing": Knob(FACING, 0.0, 360.0, 5.0, "the way it faces at first", "°", label="facing"),
        "noise": Knob(NOISE, 0.0, 5.0, 0.1, "noise on the line of sight", "°", label="noise"),
        "hysteresis": Knob(0.0, 0.0, 0.4, 0.05, "hysteresis", "rad", label="hysteresis"),
    }
    both = {"gentle": GENTLE_GAINS, "paper": OUTDOOR_GAINS}
    data = {
        "gains": {name: gains._asdict() for name, gains in both.items()},
        "away": AWAY,
        "hair": HAIR,
        "beside": BESIDE,
        "swarm": {**SWARM, "distance": CLOSE},
    }
    return Stage("seam", knobs, scenes, scene, goal=GOAL, hands=(), data=data)


def _lost() -> float:
    """Return the share of the robots that see their goal through noise and park over 90 deg off."""
    sight = np.full(SWARM["robots"], math.radians(NOISE))
    options = {"method": "arc", "dt": SWARM["dt"], "arrival_radius": SWARM["radius"]}
    options |= {"receiver": Receiver(sight=sight), "seed": SWARM["seed"]}
    ends = sweep(Pose(CLOSE, 0.0, math.pi), GOAL, OUTDOOR_GAINS, **options)
    return float(np.mean(np.abs(ends.heading_error) > math.pi / 2))
