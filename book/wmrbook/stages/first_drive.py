"""Chapter 0: two points, three numbers, and a robot that has arrived and has not parked."""

from __future__ import annotations

from wmrbook.stages.parts import (
    GENTLE,
    Question,
    Scene,
    Stage,
    gain_knobs,
    off_heading,
    paper_drive,
)
from wmrlib import paper, simulate

ENDS = "It stops after {seconds}, {off} off its heading."


def first_drive(scene: str = "whole") -> Stage:
    """Return the paper's drive outdoors, as one of its scenes."""
    start, goal, gains, _ = paper.outdoor()

    def ends_off(k_alpha: float) -> float:
        tried = gains._replace(k_alpha=k_alpha)
        return off_heading(simulate(start, goal, tried, method="continuous"))

    double = 2 * gains.k_alpha
    before, after = ends_off(gains.k_alpha), ends_off(double)
    key = "better" if after < before - 1 else "worse" if after > before + 1 else "the same"
    verdict = (
        f"it is {key}, {{off}} off instead of {before:.0f}°. Does it go on like this? Move it "
        "further."
    )
    scenes = {
        "whole": Scene(
            "Two GPS points, two headings, and three numbers that you hold. Can it park? " + ENDS
        ),
        "points": Scene(
            "The start and the goal, each with its heading.",
            shows=("points",),
            still=True,
        ),
        "metres": Scene(
            "The goal lies {east} east and {north} north of the start: *rho* = {distance}.",
            shows=("map",),
            still=True,
        ),
        "sees": Scene(
            "The robot sees three numbers: the distance *rho*, the angle *alpha* to turn, and "
            "the angle *theta* off the approach.",
            shows=("errors",),
            until=0.6,
        ),
        "law": Scene(
            "From these three numbers follow its speed and its turning rate.",
            shows=("twist",),
            until=0.6,
        ),
        "gains": Scene("Move one number at a time. " + ENDS),
        "near": Scene("The last metre. " + ENDS, look="near"),
        "ask": Scene(
            ENDS,
            look="near",
            still=True,
            ask=Question(
                "If *k_alpha* doubles, how is the heading on arrival?",
                dict.fromkeys(("better", "worse", "the same"), verdict),
                key,
                {"k_alpha": double},
            ),
        ),
        "gentle": Scene(
            "With the gentle gains it slows down earlier. " + ENDS,
            look="near",
            to=GENTLE,
            moved=ENDS,
        ),
    }
    points = [paper.GPS_POINT_1, paper.GPS_POINT_2]
    rows = [[f"{point.lat:.6f}° N", f"{point.lon:.6f}° E"] for point in points]
    data = {"v_max": gains.v_max, "points": rows}
    return Stage("first_drive", gain_knobs(gains), scenes, scene, **paper_drive(), data=data)
