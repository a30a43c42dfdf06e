"""Chapter 0 and the book's first page: it arrives, and does not park."""

from __future__ import annotations

import math

from wmrbook.live.parts import Choice, Knob, Live, between, choose, nearest
from wmrlib import paper, simulate
from wmrlib.gains import GENTLE_GAINS


def last_metres(ask: bool = True) -> Live:
    """The paper's outdoor drive, its last two metres, and one slider that mends its end.

    Parameters
    ----------
    ask : whether to ask first how far off its heading the robot may stop
    """
    start, goal, gains, _ = paper.outdoor()
    run = simulate(start, goal, gains, method="continuous")
    off_deg, value = abs(math.degrees(run.heading_error[-1])), run.V[-1]
    angles = value - run.rho[-1] ** 2 / 2  # the part of V that is not distance
    # |theta - alpha| is largest, for this part, where alpha = -h theta
    most_deg = math.degrees(math.sqrt(2 * angles * (1 + 1 / gains.h)))
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
        ask=choose(
            f"With the paper's gains the robot stops 5 cm before the goal. V has fallen from "
            f"{run.V[0]:.0f} to {value:.3f}, of which rho²/2 makes up {run.rho[-1] ** 2 / 2:.3f}. "
            "Does the robot face the goal's way?",
            f"The rest of V, {angles:.3f}, is all angles. With h = {gains.h:g} it leaves room for "
            f"{most_deg:.0f} deg of heading error, and the robot stops {off_deg:.0f} deg off.",
            answers={
                "Yes, within a degree: V is down to a ten-thousandth": off_deg < 1,
                "Within a few degrees: it is on the spot": 1 <= off_deg < 10,
                "No, it may be tens of degrees off": off_deg >= 10,
            },
            wrong=(
                "V began with the square of 58 m. That is gone, and says nothing about the angles.",
                "To be on the spot is not to face the right way: what is left of V is nearly "
                "all angles.",
                "",
            ),
        )
        if ask
        else None,
        grows=ask,  # the book's first screen has no room for more
    )


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
    shares = {"a fifth of that": 0.2, "about the same": 1.0, "twice as far": 2.0}
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
            f"With {100 * radii[0]:.0f} cm to go the robot is {off_deg:.0f} deg off and turns "
            f"{way} the goal's heading, at {abs(here.omega[-1]):.0f} rad/s. It is {seconds:.1f} s "
            f"from the point where {100 * radii[1]:.0f} cm are left. How far off is it there?",
            f"{then_deg:.0f} deg, after {off_deg:.0f}: the heading swings to and fro while the "
            "last metre is driven, so where one stops decides what is left. Nearer is not better.",
            answers=nearest(then_deg / off_deg, shares),
            wrong=(
                "A fifth of the way is left, but at 4 rad/s the heading turns by tens of "
                "degrees in 0.2 s.",
                "At 4 rad/s the heading turns by tens of degrees in 0.2 s.",
                "",
            ),
            asked=({"stop": 0.01},),
        ),
    )
