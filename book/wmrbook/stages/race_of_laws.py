"""Chapter 13: another law against the corrected one, with the same wheels."""

from __future__ import annotations

from wmrbook.live.other_laws import GOAL, NAMES, TUNED
from wmrbook.live.parts import Choice
from wmrbook.stages.parts import Question, Scene, Stage
from wmrlib import Pose, Wheels, arrival, simulate

START = Pose(4.0, 1.5, 0.0)  # the goal is behind it
WHEELS, DT = Wheels(track_width=0.4, max_speed=0.5), 0.05  # s
OTHERS = {law: name for law, name in NAMES.items() if law != "corrected"}


def race_of_laws(scene: str = "whole") -> Stage:
    """Return the race of two laws from one start, as one of its scenes."""

    def time(law: str) -> float:
        options = {"method": "arc", "dt": DT, "duration": 60.0, "wheels": WHEELS}
        return arrival(simulate(START, GOAL, TUNED[law], law=law, **options)).time

    first = min(NAMES, key=time)
    ends = "The corrected law {ours}; {other} {theirs}."
    scenes = {
        "whole": Scene("Is another law better? " + ends),
        "near": Scene("The last metre. " + ends, look="near"),
        "ask": Scene(
            ends,
            still=True,
            ask=Question(
                "Five laws, one start, and the same wheels. Whose robot is there first?",
                dict.fromkeys(NAMES.values(), "{other} {theirs}, and the corrected law {ours}."),
                NAMES[first],
                {"law": first} if first in OTHERS else {},
            ),
        ),
    }
    knobs = {"law": Choice("graceful", OTHERS, "the other law", "against the corrected law")}
    limits = {"b": WHEELS.track_width, "max_speed": WHEELS.max_speed, "min_speed": 0.0}
    data = {"tuned": {law: it._asdict() for law, it in TUNED.items()}, "names": OTHERS}
    data |= {"limits": limits, "dt": DT, "radius": 0.05, "steps": round(60.0 / DT)}
    return Stage("race_of_laws", knobs, scenes, scene, start=START, goal=GOAL, data=data)
