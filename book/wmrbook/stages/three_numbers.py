"""Chapter 3: a distance and two angles, all the way to the goal."""

from __future__ import annotations

import math

from wmrbook.stages.parts import Question, Scene, Stage, gain_knobs, off_heading
from wmrlib import GENTLE_GAINS, Pose, simulate

START = Pose(0.0, 0.0, math.radians(75.0))
GOAL = Pose(9.0, 3.0, math.radians(-50.0))
SEES = "*rho* = {rho} away, *alpha* = {alpha} to turn, *theta* = {theta} off the approach"
ENDS = "It {ends}."


def three_numbers(scene: str = "whole") -> Stage:
    """Return a drive with its three polar errors drawn all the way, as one of its scenes."""
    blind = simulate(START, GOAL, GENTLE_GAINS._replace(h=0.0), method="continuous")
    arrives = blind.rho[-1] < 0.06
    answers = {
        "still arrives, but faces another way": arrives and off_heading(blind) > 5.0,
        "still arrives and parks": arrives and off_heading(blind) < 5.0,
        "never arrives": not arrives,
    }
    verdict = "*rho* and *alpha* lead it to the place, and *theta* no longer counts. " + ENDS
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
            ask=Question(
                "Only *theta* knows which way the goal faces. With *h* = 0 the robot",
                dict.fromkeys(answers, verdict),
                next(answer for answer, right in answers.items() if right),
                {"h": 0.0},
            ),
        ),
        "near": Scene(f"The last metre, with *theta* on the way to 0. {ENDS}", look="near"),
    }
    places = {"start": START, "goal": GOAL}
    data = {"v_max": GENTLE_GAINS.v_max}
    return Stage("three_numbers", gain_knobs(GENTLE_GAINS), scenes, scene, **places, data=data)
