"""Chapter 3: a distance and two angles, all the way to the goal."""

from __future__ import annotations

import math

from wmrbook.live.parts import Choice
from wmrbook.stages.parts import Question, Scene, Stage, gain_knobs, off_heading
from wmrlib import GENTLE_GAINS, Gains, Pose, control_law, simulate
from wmrlib.runs import Trajectory

START = Pose(0.0, 0.0, math.radians(75.0))
GOAL = Pose(9.0, 3.0, math.radians(-50.0))
DT = 0.02  # s, of the drive with the wrong sign
SIGNS = {"right": "the right sign", "wrong": "the wrong sign"}
SEES = "*rho* = {rho} away, *alpha* = {alpha} to turn, *theta* = {theta} off the approach"
ENDS = "It {ends}."
PARKED = 5.0  # deg off the goal's heading at most


def mistaken(rho: float, alpha: float, theta: float, gains: Gains) -> tuple[float, float]:
    """Return the twist of a robot that takes theta for its opposite."""
    return control_law(rho, alpha, -theta, gains)


def three_numbers(scene: str = "whole") -> Stage:
    """Return a drive with its three polar errors drawn all the way, as one of its scenes."""
    blind = simulate(START, GOAL, GENTLE_GAINS._replace(h=0.0), method="continuous")
    wrong = simulate(START, GOAL, GENTLE_GAINS, law=mistaken, method="arc", dt=DT)
    without = "*rho* and *alpha* lead it to the place, and *theta* no longer counts. " + ENDS
    turned = "*rho* and *alpha* still lead it to the place, and *theta* leads it round. " + ENDS
    scenes = {
        "whole": Scene(
            "Which three numbers does a driver need? How far, how much to turn, and how far off "
            f"the approach. {ENDS}",
            shows=("errors",),
            until=0.2,
        ),
        "start": Scene(
            f"Drag the start and the goal, or turn them: {SEES}.", shows=("errors",), until=0.0
        ),
        "ask": Scene(
            ENDS,
            shows=("errors",),
            still=True,
            ask=_question(
                "Only *theta* knows which way the goal faces. With *h* = 0 the robot",
                blind,
                without,
                {"h": 0.0},
            ),
        ),
        "split": Scene(
            "Of *v* = {v}, {along} go along the line of sight and {across} across it. The line "
            "{swings}.",
            shows=("split",),
            until=0.0,
        ),
        "sign": Scene(
            ENDS,
            shows=("errors",),
            still=True,
            ask=_question(
                "Suppose that the law takes *theta* with the wrong sign. The robot",
                wrong,
                turned,
                {"sign": "wrong"},
            ),
        ),
        "near": Scene(
            f"The last metre, with *theta* on the way to 0. {ENDS}",
            look="near",
            moved=f"The last metre. {ENDS}",
        ),
    }
    places = {"start": START, "goal": GOAL}
    sign = Choice("right", SIGNS, "theta in the law", "The law takes θ with")
    data = {"v_max": GENTLE_GAINS.v_max, "dt": DT, "steps": round(60.0 / DT)}
    knobs = gain_knobs(GENTLE_GAINS) | {"sign": sign}
    return Stage("three_numbers", knobs, scenes, scene, **places, data=data)


def _question(says: str, run: Trajectory, verdict: str, then: dict[str, float | str]) -> Question:
    """Return the question how a run ends, whose answer is how this one does."""
    arrives, parks = run.rho[-1] < 0.06, off_heading(run) < PARKED
    answers = {
        "still arrives, but faces another way": arrives and not parks,
        "still arrives and parks": arrives and parks,
        "never arrives": not arrives,
    }
    key = next(answer for answer, right in answers.items() if right)
    return Question(says, dict.fromkeys(answers, verdict), key, then)
