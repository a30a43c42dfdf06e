"""Chapter 10: two robots, two formulas for the turning rate, and one of them is a misprint."""

from __future__ import annotations

import math

from wmrbook.stages.parts import Question, Scene, Stage, gain_knobs, off_heading, paper_drive
from wmrlib import paper, simulate

ROBOTS = {"pink": "printed", "blue": "corrected"}
BLIND = {  # a robot in a polar error (m, rad, rad), with commands (m/s, rad/s) that never change
    "sight": {"error": (10.0, math.radians(45.0), 0.0), "twist": (1.0, 0.0), "seconds": 6.0},
    "inequality": {"error": (10.0, math.radians(-45.0), 0.0), "twist": (0.5, 0.5), "seconds": 3.0},
}
NEAR_GOAL = {"error": (0.35, math.radians(45.0), 0.0), "seconds": 2.0}


def as_printed(scene: str = "near") -> Stage:
    """Return the race of the law as printed and as derived, as one of its scenes."""
    start, goal, gains, _ = paper.outdoor()
    more = 10 * gains.h

    def moved(law: str) -> float:
        """By how many degrees a robot ends otherwise if h is larger."""
        small, large = (
            off_heading(simulate(start, goal, gains._replace(h=h), law=law, method="continuous"))
            for h in (gains.h, more)
        )
        return abs(large - small)

    deaf = [robot for robot, law in ROBOTS.items() if moved(law) < 1]
    (key,) = deaf
    ends = "Blue {blue}, pink {pink}."
    seen = "only pink ends the same as before: its *h* does nothing. " + ends
    scenes = {
        "near": Scene(
            "Two formulas for the turning rate, and one is a misprint. Move *h*, by which the "
            "final heading should count: can you see which? " + ends,
            look="near",
        ),
        "whole": Scene("The whole drive, by both formulas. " + ends),
        "sight": Scene(
            "This robot drives straight ahead, and its goal is on the left. The line of sight "
            "turns to the left, by {turned} so far.",
            look="other",
        ),
        "inequality": Scene(
            "The goal is on the right, and the robot turns to the left. That obeys the paper's "
            "inequality, and *alpha* goes from \N{MINUS SIGN}45° to {alpha}.",
            look="other",
        ),
        "ask": Scene(
            ends,
            look="near",
            still=True,
            ask=Question(
                "The larger *h*, the more the final heading should count. Whose formula is the "
                "misprint?",
                dict.fromkeys(ROBOTS, seen),
                key,
                {"h": more},
            ),
        ),
        "rises": Scene(
            "Both robots start 35 cm from the goal. In the corner is V over time: by the pink "
            "formula it rises to {most} times its first value, by the blue one it only falls.",
            look="other",
        ),
        "circle": Scene(
            "A goal that drives round a circle, and a speed limit of 4 m/s. In the end blue is "
            "{blue_gap} from the goal, pink {pink_gap}.",
            look="other",
            to={"h": paper.CIRCLE_GAINS.h},
        ),
    }
    knobs = {"h": gain_knobs(gains)["h"]}
    data = {
        "gains": gains._asdict(),
        "laws": ROBOTS,
        "blind": BLIND,
        "nearGoal": NEAR_GOAL,
        "circle": {
            "gains": paper.CIRCLE_GAINS._asdict(),
            "start": list(paper.CIRCLE_START),
            "radius": paper.CIRCLE_RADIUS,
            "seconds": paper.CIRCLE_PERIOD,
        },
    }
    return Stage("as_printed", knobs, scenes, scene, **paper_drive(), data=data)
