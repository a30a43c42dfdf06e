"""Chapter 13: five laws from one start."""

from __future__ import annotations

import math

from wmrbook.live.parts import Choice, Knob, Live, between, choose
from wmrlib import Gains, Pose, control_law, gains_for

GOAL = Pose(0.0, 0.0, 0.0)
BEHIND = Pose(2.0, 0.1, 0.0)  # the goal is behind it, a little to its right
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
