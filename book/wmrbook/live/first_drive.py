"""Chapter 0: where the robot stops, and how far off its heading it is there."""

from __future__ import annotations

import math

from wmrbook.live.parts import Choice, Knob, Live, between, choose, nearest
from wmrlib import paper, simulate
from wmrlib.gains import GENTLE_GAINS


def stopping() -> Live:
    """The heading error over the distance to go, for a robot that stops where one wants."""
    start, goal, gains, _ = paper.outdoor()
    radii = 0.05, 0.01  # m
    here, nearer = (
        simulate(start, goal, gains, method="continuous", arrival_radius=radius) for radius in radii
    )
    off_deg, then_deg = (abs(math.degrees(it.heading_error[-1])) for it in (here, nearer))
    way = "away from" if here.omega[-1] * here.heading_error[-1] > 0 else "back to"
    seconds = nearer.t[-1] - here.t[-1]
    shares = {"a fifth of that": 0.2, "about the same": 1.0, "twice as much": 2.0}
    return Live(
        "stopping",
        "With {gains} a robot that stops {stop} before the goal is there after {seconds} and faces "
        "{off}.",
        {
            "stop": Knob(radii[0], 0.01, 2.0, None, "where it stops", "m", label="stops at"),
            "gains": Choice(
                "paper", {"paper": "the paper's gains", "gentle": "gentle gains"}, "which gains"
            ),
        },
        data=between(start, goal, paper=gains._asdict(), gentle=GENTLE_GAINS._asdict()),
        ask=choose(
            f"With {100 * radii[0]:.0f} cm to go the robot is {off_deg:.0f} deg off, and turns "
            f"{way} the goal's heading at {abs(here.omega[-1]):.0f} rad/s. How far off is it at "
            f"{100 * radii[1]:.0f} cm?",
            f"It is {then_deg:.0f} deg off, after {off_deg:.0f}: the heading swings while the last "
            "metre is driven, so nearer is not better.",
            answers=nearest(then_deg / off_deg, shares),
            wrong=(
                "A fifth of the way is left, but at 4 rad/s the heading turns by tens of degrees.",
                f"In the {seconds:.1f} s that are left, 4 rad/s turn the heading by tens of "
                "degrees.",
                "",
            ),
            asked=({"stop": 0.01},),
        ),
    )
