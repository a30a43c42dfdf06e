"""Chapter 13: another law against the corrected one, with the same wheels."""

from __future__ import annotations

from wmrbook.live.parts import Choice
from wmrbook.stages.parts import Question, Scene, Stage
from wmrlib import Gains, Pose, Wheels, arrival, gains_for, simulate

START, GOAL = Pose(4.0, 1.5, 0.0), Pose(0.0, 0.0, 0.0)  # the goal is behind it
WHEELS, DT = Wheels(track_width=0.4, max_speed=0.5), 0.05  # s
DESIGNED = gains_for(0.8, heading_rate=1.6, damping=1.0)
TUNED = {
    **dict.fromkeys(("corrected", "printed", "barrier"), DESIGNED),
    "aicardi": Gains(0.8, 3.2, 4.0, 1.0),  # the same two numbers, kappa 4 and h 4
    "graceful": Gains(1.0, 2.0, 3.0, 1.0),  # k_delta 2, k_phi 3
}
NAMES = {
    "corrected": "the corrected law",
    "printed": "the printed law",
    "aicardi": "Aicardi's law",
    "barrier": "the barrier law",
    "graceful": "Graceful",
}
OTHERS = {law: name for law, name in NAMES.items() if law != "corrected"}
DRIVES = {
    "forwards": "forwards",
    "turn": "with a last turn",
    "backwards": "backwards",
    "hurried": "by a given time",
}
SPEEDS = {"own": "its own", "0.1": "0.1 m/s", "0.2": "0.2 m/s", "0.4": "0.4 m/s"}
SETTLES = 2.0  # c_1 and c_2 of the law for a given speed
BY = 5.0  # s


def race_of_laws(scene: str = "whole") -> Stage:
    """Return the race of two laws from one start, as one of its scenes."""

    def time(law: str) -> float:
        options = {"method": "arc", "dt": DT, "duration": 60.0, "wheels": WHEELS}
        return arrival(simulate(START, GOAL, TUNED[law], law=law, **options)).time

    first = min(NAMES, key=time)
    ends = "The corrected law {ours}; {other} {theirs}."

    def of_law(law: str, claim: str) -> Scene:
        return Scene(f"{claim} {ends}", to={"law": law}, moved=ends, handles=("law",))

    scenes = {
        "whole": Scene("Is another law better? " + ends, handles=("law", "drives")),
        "ask": Scene(
            ends,
            still=True,
            ask=Question(
                "Five laws, one start, and the same wheels. Whose robot is there first?",
                dict.fromkeys(NAMES.values(), "{other} {theirs}, and the corrected law {ours}."),
                NAMES[first],
                {"law": first} if first in OTHERS else {},
            ),
            handles=("law",),
        ),
        "aicardi": of_law(
            "aicardi",
            "Aicardi's law asks for more speed the farther away its goal is, but the wheels "
            f"drive at no more than {WHEELS.max_speed} m/s.",
        ),
        "barrier": of_law(
            "barrier",
            "No angle crosses half a turn under the barrier law. "
            "Its robot drives {back} backwards.",
        ),
        "graceful": of_law(
            "graceful", "Graceful never drives backwards, because its speed is never negative."
        ),
        "near": Scene("The last metre. " + ends, look="near", handles=("law",)),
        "speed": Scene(
            "The law (13.3) drives the same path at every given speed. " + ends,
            to={"drives": "backwards", "speed": "0.4"},
            moved=ends,
            handles=("speed",),
        ),
        "time": Scene(
            f"With clocks that run ahead, and ideal wheels, both arrive before {BY:.0f} s. " + ends,
            to={"drives": "hurried"},
            moved=ends,
            handles=("law", "drives"),
        ),
        "spot": Scene(
            "Both robots turn on the spot at the end, as fast as their wheels allow. " + ends,
            to={"law": "printed", "drives": "turn"},
            moved=ends,
            handles=("law", "drives"),
        ),
        "dock": Scene(
            "Both robots back into the dock, so neither has to turn round. " + ends,
            to={"drives": "backwards"},
            moved=ends,
            handles=("law", "drives"),
        ),
    }
    knobs = {
        "law": Choice("graceful", OTHERS, "the other law", "against the corrected law"),
        "drives": Choice("forwards", DRIVES, "the way of driving", "both drive"),
        "speed": Choice("own", SPEEDS, "the speed of the other robot", "speed of the other"),
    }
    limits = {"b": WHEELS.track_width, "max_speed": WHEELS.max_speed, "min_speed": 0.0}
    data = {"tuned": {law: it._asdict() for law, it in TUNED.items()}, "names": OTHERS}
    data |= {"limits": limits, "dt": DT, "radius": 0.05, "steps": round(60.0 / DT)}
    data |= {"settles": SETTLES, "by": BY}
    return Stage("race_of_laws", knobs, scenes, scene, start=START, goal=GOAL, data=data)
