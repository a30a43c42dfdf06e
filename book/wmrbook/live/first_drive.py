"""Chapter 0 and the book's first page: it arrives, and does not park."""

from __future__ import annotations

import math

from wmrbook.live.parts import Ask, Knob, Live
from wmrlib import paper, simulate
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
    return Live(
        "last_metres",
        "With *k_rho* = {k_rho}, *k_alpha* = {k_alpha} and *h* = {h} the robot arrives after "
        "{seconds} and looks {off} past the way it should.",
        {
            "share": Knob(
                0.0, 0.0, 1.0, 0.02, "from the paper's gains to gentle ones", label="gentler"
            ),
            "time": Knob(
                1.0 if ask else 0.0,
                0.0,
                1.0,
                0.01,
                "how far on its way",
                label="on its way",
                plays=6.0,
                auto=not ask,
            ),
        },
        data={
            "start": list(start),
            "goal": list(goal),
            "paper": gains._asdict(),
            "gentle": GENTLE_GAINS._asdict(),
        },
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
