"""Chapter 10: two robots, two formulas for the turning rate, and one of them is a misprint."""

from __future__ import annotations

from wmrbook.stages.parts import Question, Scene, Stage, gain_knobs, off_heading, paper_drive
from wmrlib import paper, simulate

ROBOTS = {"pink": "printed", "blue": "corrected"}


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
        "whole": Scene("The whole way. " + ends),
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
    }
    knobs = {"h": gain_knobs(gains)["h"]}
    data = {"gains": gains._asdict(), "laws": ROBOTS}
    return Stage("as_printed", knobs, scenes, scene, **paper_drive(), data=data)
