"""Chapter 13: five laws from one start, and the power that Graceful's heading follows."""

from __future__ import annotations

import math

from wmrbook.live.parts import Choice, Knob, Live, between, choose, nearest
from wmrlib import Gains, Pose, control_law, gains_for, simulate

GOAL = Pose(0.0, 0.0, 0.0)
BEHIND = Pose(2.0, 0.1, 0.0)  # the goal is behind it, a little to its right
ASIDE = Pose(-1.5, 1.0, 0.0)
DOCKING = Gains(1.0, 2.0, 3.0, 1.0)  # k_delta 2, k_phi 3
TUNED = {
    **dict.fromkeys(("corrected", "printed"), gains_for(0.8, heading_rate=1.6, damping=1.0)),
    "aicardi": Gains(0.8, 3.2, 4.0, 1.0),  # the same two numbers, kappa 4 and h 4
    "barrier": gains_for(0.8, heading_rate=1.6, damping=1.0),
    "graceful": DOCKING,
}
NAMES = {
    "corrected": "the corrected law",
    "printed": "the printed law",
    "aicardi": "Aicardi's law",
    "barrier": "the barrier law",
    "graceful": "Graceful",
}
RADII = (0.1, 0.05)  # m, where the prediction compares
SHARES = {"as much": 1.0, "half of it": 0.5, "a quarter of it": 0.25}


def race() -> Live:
    """Five laws from a start that the reader drags, with the same wheels."""
    asked = [law for law in NAMES if law != "printed"]
    speeds = [control_law(2.0, math.pi, math.pi / 2, TUNED[law], law=law)[0] for law in asked]
    names = [NAMES[law] for law in asked]
    backs_up = "The others' speeds contain cos alpha, which is negative while the goal is behind."
    return Live(
        "race",
        "From {x}, {y}, facing {heading}, {law} {ends}, {left} off; it has driven {back} "
        "backwards. To turn the rest on the spot would take {turn}.",
        {
            "x": Knob(BEHIND.x, -3.5, 3.5, 0.1, "the start's x", "m", label="start's x"),
            "y": Knob(BEHIND.y, -2.5, 2.5, 0.1, "the start's y", "m", label="start's y"),
            "heading": Knob(0.0, -180.0, 180.0, 5.0, "the start's heading", "°", label="heading"),
            "law": Choice("graceful", NAMES, "the law"),
        },
        data={
            **between(BEHIND, GOAL, tuned={law: it._asdict() for law, it in TUNED.items()}),
            **{"dt": 0.02, "seconds": 60.0, "radius": 0.05, "track": 0.4, "most": 0.5},
        },
        ask=choose(
            "The goal lies behind the robot. Which of these laws never drives backwards?",
            "The other speeds contain cos alpha, which is negative while the goal is behind.",
            answers={name: v > 0 for name, v in zip(names, speeds, strict=True)},
            wrong=(backs_up, backs_up, backs_up, ""),
        ),
    )


def heading_power() -> Live:
    """Graceful's heading error over the distance left, for k_phi, k_delta and a radius."""
    options = {"law": "graceful", "method": "continuous"}
    first, second = (
        abs(simulate(ASIDE, GOAL, DOCKING, arrival_radius=radius, **options).heading_error[-1])
        for radius in RADII
    )
    return Live(
        "heading_power",
        "With {k_phi} and {k_delta} the heading error tends to the power {power} of the distance. "
        "The robot that stops at {radius} does so after {seconds}, {left} off.",
        {
            "k_phi": Knob(3.0, 0.5, 5.0, 0.1, "Nav2's k_phi", symbol="k_phi"),
            "k_delta": Knob(2.0, 0.5, 5.0, 0.1, "Nav2's k_delta", symbol="k_delta"),
            "radius": Knob(
                0.1, 0.01, 1.0, None, "the distance at which it stops", "m", label="stops at"
            ),
        },
        data=between(
            ASIDE,
            GOAL,
            gains=DOCKING._asdict(),
            defaults={"docking (3, 2)": [3.0, 2.0], "Graceful (2, 1)": [2.0, 1.0]},
        ),
        ask=choose(
            f"With docking's gains (3, 2) the robot stops 10 cm before its goal, "
            f"{math.degrees(first):.1f}° off. How much is left at 5 cm?",
            "The error falls as a power of the distance, and the power is the smaller of the two "
            "gains.",
            answers=nearest(second / first, SHARES),
            wrong=(
                "The heading settles on the way, and this way is longer.",
                "Half would be the first power of the distance, which takes a gain of 1.",
                "",
            ),
            asked=({"radius": 0.05},),
        ),
    )
