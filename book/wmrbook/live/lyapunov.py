"""Chapter 4: a number that never rises, and the law that sees to it."""

from __future__ import annotations

import math

import numpy as np

from wmrbook.live.parts import Choice, Knob, Live, choose
from wmrlib import (
    GENTLE_GAINS,
    PolarError,
    Pose,
    polar_rate,
    pose_from_polar,
    simulate,
)
from wmrlib.control import control_law
from wmrlib.paper import OUTDOOR_GAINS

GOAL = Pose(0.0, 0.0, 0.0)
NEAR = 0.5  # m from the goal
LOOK = (-30.0, 35.0)  # deg, yaw and tilt of the bowl at first
ASKED = (0.0, 60.0)  # deg, alpha and theta


def bowl() -> Live:
    """The angles' part of V as a bowl to turn, its level sets, and a state that rolls over both."""
    error = PolarError(NEAR, math.radians(110.0), math.radians(90.0))
    start = pose_from_polar(error, GOAL)
    options = {"method": "continuous", "dt": 0.02, "duration": 12.0, "arrival_radius": 0.0}
    run = simulate(start, GOAL, GENTLE_GAINS, **options)
    h = GENTLE_GAINS.h
    heights = (run.alpha**2 + h * run.theta**2) / 2
    steepest = np.arctan2(-h * run.theta, -run.alpha)
    moves = np.arctan2(np.diff(run.theta), np.diff(run.alpha))
    early = heights[:-1] > heights[0] / 100
    aside = np.abs(np.angle(np.exp(1j * (moves - steepest[:-1]))))[early].max()
    rises = np.diff(heights).max() > 1e-9
    ways = {
        "by the steepest way": not rises and aside < math.radians(20.0),
        "down all the way, but aslant": not rises and aside > math.radians(20.0),
        "up at times": rises,
    }
    return Live(
        "bowl",
        "With {choice} the ball is {height} high after {seconds}, and was {top} high at first.",
        {
            "choice": Choice(
                "gentle",
                {"gentle": "gentle gains", "paper": "the paper's gains"},
                "the gains of the run",
            ),
            "time": Knob(
                1.0, 0.0, 1.0, 0.005, "how far the ball has rolled", label="rolled", plays=8.0
            ),
            "yaw": Knob(LOOK[0], -180.0, 180.0, 1.0, "the bowl, turned round", "°", label="turned"),
            "tilt": Knob(LOOK[1], 5.0, 85.0, 1.0, "the bowl, tilted", "°", label="tilted"),
        },
        data={
            "start": list(start),
            "goal": list(GOAL),
            "look": LOOK,
            "gains": {"gentle": GENTLE_GAINS._asdict(), "paper": OUTDOOR_GAINS._asdict()},
        },
        ask=choose(
            "This chapter designs a law for this bowl. How will the ball get to the bottom?",
            "V must not rise, but nothing is asked of its direction. The dashed way is the "
            "steepest.",
            answers=ways,
            wrong=(
                "A robot can't turn its two angles as it likes: only driving turns theta.",
                "",
                "Such a law would prove nothing: V must never rise.",
            ),
        ),
    )


def two_bars() -> Live:
    """V' as the sum of a bar for the distance and one for the angles, while the law is built."""
    alpha, theta = map(math.radians, ASKED)
    twist = control_law(NEAR, alpha, theta, OUTDOOR_GAINS)
    rates = polar_rate(NEAR, alpha, *twist)
    distance = NEAR * rates[0] < -1e-9
    angles = alpha * rates[1] + OUTDOOR_GAINS.h * theta * rates[2] < -1e-9
    return Live(
        "two_bars",
        "With {law}, 0.5 m from the goal, at {alpha} and {theta}, the part of "
        "the distance {distance} and that of the angles {angles}. V {share}.",
        {
            "law": Choice(
                "corrected",
                {
                    "nothing": "v = 1 m/s and ω = 0",
                    "speed": "v of (22) and ω = 0",
                    "corrected": "v of (22) and ω of (4.6)",
                    "printed": "v and ω as printed",
                },
                "the law so far",
            ),
            "alpha": Knob(ASKED[0], -180.0, 180.0, 1.0, "alpha", "°", "alpha"),
            "theta": Knob(ASKED[1], -180.0, 180.0, 1.0, "theta", "°", "theta"),
        },
        data={"rho": NEAR, "gains": OUTDOOR_GAINS._asdict(), "asked": ASKED},
        ask=choose(
            "The robot looks straight at its goal, but should be turned by 60°: alpha = 0, "
            "theta = 60°. Which part of V falls?",
            "The angles' part falls by what alpha is, whatever theta is: it can't see that the "
            "heading is wrong.",
            answers={
                "both": distance and angles,
                "only the distance's": distance and not angles,
                "only the angles'": angles and not distance,
                "neither": not distance and not angles,
            },
            wrong=(
                "Alpha is 0, so the angles' part stays level: it can't see that the heading is "
                "wrong.",
                "",
                "The robot drives towards its goal, so the distance's part falls; and alpha is 0.",
                "The robot drives towards its goal, so the distance's part falls.",
            ),
        ),
    )
