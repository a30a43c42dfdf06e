"""Chapter 9: robots that see late."""

from __future__ import annotations

import math

import numpy as np

from wmrbook.live.parts import Knob, Live, between, choose
from wmrlib import (
    Pose,
    Receiver,
    paper,
    sweep,
)
from wmrlib.gains import GENTLE_GAINS

DT, RADIUS = 0.1, 0.2  # s, m
LOST = 60.0  # s


def _turn(pose: Pose, by: float) -> Pose:
    return pose._replace(heading=pose.heading + by)


def _turned(what: str) -> Knob:
    label = f"{what.removeprefix('the ')} turned"
    return Knob(0.0, -180.0, 180.0, 5.0, f"{what}, turned from the drive's", "°", label=label)


def late_drive(
    position: float, heading: float, set_off: float = 0.0, face: float = 0.0
) -> tuple[Pose, float]:
    """The outdoor drive with both readings late [s]: its poses, and its time, infinite if lost.

    Its start is turned by `set_off` and its goal by `face` [rad].
    """
    start, goal = map(_turn, paper.outdoor()[:2], (set_off, face))
    late = Receiver(delay=position, heading_delay=heading)
    options = {"method": "arc", "dt": DT, "duration": LOST, "arrival_radius": RADIUS}
    end, path = sweep(start, goal, GENTLE_GAINS, receiver=late, trajectories=True, **options)
    driven = np.isfinite(path.x)
    return Pose(path.x[driven], path.y[driven], path.heading[driven]), end.time


def late() -> Live:
    """Two robots race: one sees its position late, the other its heading."""
    start, goal, *_ = paper.outdoor()
    delay = 0.6
    position, heading = (
        math.isfinite(late_drive(*delays)[1]) for delays in ((delay, 0), (0, delay))
    )
    return Live(
        "late",
        "Both robots have gentle gains. One sees its position {delay} late and {position}; the "
        "other sees its heading that late and {heading}.",
        {
            "delay": Knob(delay, 0.0, 1.5, 0.1, "how late it is", "s", label="late by"),
            "set_off": _turned("the start"),
            "face": _turned("the goal"),
            "time": Knob(1.0, 0.0, 1.0, 0.005, "how far through the race", label="race", plays=12),
        },
        data=between(start, goal, gains=GENTLE_GAINS._asdict(), dt=DT, radius=RADIUS, lost=LOST),
        ask=choose(
            "One robot sees its position 0.6 s late, the other its heading. Which of them arrives "
            "within a minute?",
            "An old heading makes the law steer too far, and back; an old position does harm only "
            "near the goal.",
            answers={
                "both": position and heading,
                "the one with the late position": position and not heading,
                "the one with the late heading": heading and not position,
                "neither": not position and not heading,
            },
            wrong=(
                "An old heading lets the robot steer too far, and back, for longer than a minute.",
                "",
                "Far away the line of sight hardly turns, so an old position does little harm "
                "there.",
                "An old position does harm only near the goal, where the line of sight turns.",
            ),
        ),
    )
