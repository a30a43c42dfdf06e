"""Chapter 12: a corner of a route."""

from __future__ import annotations

import numpy as np

from wmrbook.chapters.routes import headings_along
from wmrbook.live.parts import Ask, Choice, Knob, Live
from wmrlib import Gains

GAINS = Gains(k_rho=0.4, k_alpha=2.0, h=1.0, v_max=4.0)


def corners() -> Live:
    """A route with one corner to drag, and the heading that is chosen there."""
    first, corner, last = (0.0, 0.0), (22.0, 2.0), (8.0, 24.0)
    heading = float(headings_along(*np.transpose([first, corner, last]))[1])
    return Live(
        "corners",
        "At the corner, {x} and {y} from the start, the robot is to look to {heading}, and {stop}. "
        "It turns at up to {omega} and takes {seconds}.",
        {
            "x": Knob(corner[0], -30.0, 30.0, 0.5, "the corner, east", "m", "x"),
            "y": Knob(corner[1], -30.0, 30.0, 0.5, "the corner, north", "m", "y"),
            "stop": Choice(
                "pass", {"pass": "it is passed within 5 m", "stop": "the robot stops there"}, "how"
            ),
        },
        data={"first": first, "last": last, "gains": GAINS._asdict(), "pass": 5.0, "stop": 0.05},
        ask=Ask(
            "turn",
            "Which heading at the corner leaves the robot the same small turn before it and after "
            "it? Turn the arrow.",
            "It lies halfway between the two legs' directions, counted along the shorter turn.",
            key=heading,
            pane="plane",
            at=corner,
        ),
    )
