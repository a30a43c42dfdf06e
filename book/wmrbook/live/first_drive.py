"""Chapter 0 and the book's first page: it arrives, and does not park."""

from __future__ import annotations

import math

from wmrbook.live.parts import Ask, Choice, Knob, Live, between, nearest
from wmrlib import Gains, Pose, paper, simulate
from wmrlib.gains import GENTLE_GAINS


def last_metres(ask: bool = True) -> Live:
    """The paper's outdoor drive, its last two metres, and one slider that mends its end.

    Parameters
    ----------
    ask : whether to ask first which way the robot looks when it stops
    """
    start, goal, gains, _ = paper.outdoor()
    end = float(simulate(start, goal, gains, method="continuous").heading[-1])
    off_deg = math.degrees(end - goal.heading)
    shown = {"label": "on its way", "plays": 6.0, "auto": not ask}
    return Live(
        "last_metres",
        "With *k_rho* = {k_rho}, *k_alpha* = {k_alpha} and *h* = {h} the robot arrives after "
        "{seconds} and stops {off} off its heading.",
        {
            "share": Knob(
                0.0, 0.0, 1.0, 0.02, "from the paper's gains to gentle ones", label="gentler"
            ),
            "time": Knob(float(ask), 0.0, 1.0, 0.01, "how far on its way", **shown),
        },
        data=between(start, goal, paper=gains._asdict(), gentle=GENTLE_GAINS._asdict()),
        ask=Ask(
            "turn",
            "The robot drives with the paper's gains and stops 5 cm before the goal. Which way "
            "does it look there? Turn the arrow.",
            f"It stops {abs(off_deg):.0f} deg off, with the law acting all the time: the heading "
            "is late, and there are no metres left to mend it.",
            key=end,
            pane="near",
            at=goal[:2],
        )
        if ask
        else None,
    )


def stopping() -> Live:
    """The heading error over the distance to go, for a robot that stops where one wants."""
    start, goal, gains, _ = paper.outdoor()
    radii = 0.05, 0.01  # m
    here, nearer = (abs(_left_over(start, goal, gains, radius)) for radius in radii)
    shares = {"a fifth of that": 0.2, "about the same": 1.0, "twice as far": 2.0}
    return Live(
        "stopping",
        "With {gains} a robot that stops {stop} before the goal is there after {seconds} and looks "
        "{off}.",
        {
            "stop": Knob(radii[0], 0.01, 2.0, None, "where it stops", "m", label="stops at"),
            "gains": Choice(
                "paper", {"paper": "the paper's gains", "gentle": "gentle gains"}, "which gains"
            ),
        },
        data=between(start, goal, paper=gains._asdict(), gentle=GENTLE_GAINS._asdict()),
        ask=Ask(
            "choose",
            f"Stopped {100 * radii[0]:.0f} cm before the goal, the robot does not look the way it "
            f"should. How far off is it if it stops at {100 * radii[1]:.0f} cm?",
            f"{nearer:.0f} deg, and {here:.0f} before: the heading swings to and fro while the "
            "last metre is driven, so where one stops decides what is left. Nearer is not better.",
            key=nearest(nearer / here, shares.values()),
            options=(*shares,),
        ),
    )


def _left_over(start: Pose, goal: Pose, gains: Gains, radius: float) -> float:
    """The heading error where a robot stops `radius` before the goal, deg."""
    run = simulate(start, goal, gains, method="continuous", arrival_radius=radius)
    return math.degrees(run.heading_error[-1])
