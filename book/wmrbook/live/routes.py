"""Chapter 12: a corner of a route, and V at each change of goal."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from wmrbook.chapters.routes import drive_route, headings_along
from wmrbook.live.parts import Ask, Choice, Knob, Live, choose
from wmrlib import Gains, Pose

GAINS = Gains(k_rho=0.4, k_alpha=2.0, h=1.0, v_max=4.0)
WALK = np.array([[0.0, 25.0, 45.0, 40.0, 5.0], [0.0, 5.0, 20.0, 45.0, 40.0]])  # m east, m north
DOOR = math.radians(-90.0)


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


def passing() -> Live:
    """The walk round the lawn, its points passed, and V over time."""
    headings = headings_along(*WALK)
    headings[-1] = DOOR
    poses = Pose(*WALK, headings)
    options = {"stop": False, "pass_radius": 5.0, "method": "continuous"}
    legs = drive_route(poses, GAINS, **options).legs
    jumps = [float(b.V[0] - a.V[-1]) for a, b in pairwise(legs)]
    return Live(
        "passing",
        "Each point but the door is passed within {radius}. The walk takes {seconds}, the fastest "
        "turn is {omega}. Here V is {V}, the speed {v}.",
        {
            "radius": Knob(5.0, 0.5, 12.0, 0.5, "how near a point is passed", "m", "R"),
            "time": Knob(1.0, 0.0, 1.0, 0.005, "how far on its way", label="on its way", plays=8.0),
        },
        data={"poses": np.transpose(poses).tolist(), "gains": GAINS._asdict()},
        ask=choose(
            "V falls on each leg. What does V do where the robot passes a point, and the next one "
            "becomes its goal?",
            "A new goal is a new error, and the next point is farther away.",
            answers={
                "it falls on": max(map(abs, jumps)) < 1e-6,
                "it jumps up": min(jumps) > 1e-6,
                "it jumps down": max(jumps) < -1e-6,
                "up at some, down at others": min(jumps) < -1e-6 and max(jumps) > 1e-6,
            },
            wrong=(
                "V measures the way to the goal, and the goal has changed.",
                "",
                "The next point is farther away than the one that is passed.",
                "It could jump down where a point lies nearer than the last; on this route none "
                "does.",
            ),
        ),
    )
