"""Chapter 11: a robot that believes that it is parked."""

from __future__ import annotations

import math
from collections.abc import Callable

from wmrbook.live.parts import Choice, Knob, nearest
from wmrbook.stages.parts import Question, Scene, Stage, off_heading
from wmrlib import GENTLE_GAINS, Gains, Pose, Trajectory, control_law, simulate, wrap_angle

START, GOAL = Pose(0.0, 0.0, 0.0), Pose(8.0, 3.0, math.pi / 3.0)
BIAS, ARM, DT, RADIUS, SECONDS = 12.0, 0.3, 0.05, 0.05, 60.0  # deg, m, s, m, s
ENDS = "It drives until it believes it is parked. It {ends}."


def misled(bias: float = 0.0, arm: float = 0.0, bearing: bool = False) -> Callable:
    """Return the law of a robot whose compass is off [deg], and whose antenna is ahead [m].

    It drives until it believes that it is within RADIUS of the goal. With `bearing`, it takes the
    angle from north, clockwise, for the one from east.
    """

    def law(rho: float, alpha: float, theta: float, gains: Gains) -> tuple[float, float]:
        ahead, left = rho * math.cos(alpha) - arm, rho * math.sin(alpha)
        distance, sight = math.hypot(ahead, left), math.atan2(left, ahead)
        if distance <= RADIUS:
            return 0.0, 0.0
        heading = theta + GOAL.heading - alpha
        wrong = math.pi / 2 - 2 * heading if bearing else math.radians(bias)
        turn = wrap_angle(theta + sight - alpha)
        return control_law(distance, wrap_angle(sight - wrong), turn, gains)

    return law


def driven(**wrong: float) -> Trajectory:
    """Return the drive of such a robot."""
    options = {"method": "arc", "dt": DT, "duration": SECONDS, "arrival_radius": 1e-9}
    return simulate(START, GOAL, GENTLE_GAINS, law=misled(**wrong), **options)


def crooked_compass(scene: str = "near") -> Stage:
    """Return a drive by a compass that is off, and an antenna ahead, as one of its scenes."""
    turned, ahead, lost = driven(bias=BIAS), driven(arm=ARM), driven(bearing=True)
    place, heading = turned.rho[-1] < 2 * RADIUS, off_heading(turned) < 5.0
    short = nearest(ahead.rho[-1], {"5 cm": 0.05, "15 cm": 0.15, "35 cm": 0.35})
    reached = "reaches it all the same" if lost.rho[-1] < 2 * RADIUS else "never gets there"
    scenes = {
        "near": Scene(
            ENDS + " The law is right: what is wrong?",
            look="near",
            moved=ENDS,
            handles=("bias", "arm"),
        ),
        "whole": Scene(ENDS, handles=("bias", "arm")),
        "right": Scene(
            "Compass and antenna are where the program believes them. It {ends}.",
            look="near",
            to={"bias": 0.0, "arm": 0.0},
            moved="It {ends}.",
            handles=("bias", "arm"),
        ),
        "arm": Scene(
            "It {ends}.",
            look="near",
            still=True,
            to={"bias": 0.0, "arm": 0.0},
            handles=("arm",),
            ask=Question(
                f"The antenna stands {100 * ARM:.0f} cm ahead of the axle, and the program does "
                "not know. How far from its goal does the middle of the axle stop?",
                dict.fromkeys(short, "it {ends}."),
                next(answer for answer, right in short.items() if right),
                {"arm": ARM},
            ),
        ),
        "compass": Scene(
            "The antenna is over the axle, and the compass is {bias} off. It {ends}.",
            look="near",
            to={"arm": 0.0},
            moved="The compass is {bias} off. It {ends}.",
            handles=("bias",),
        ),
        "ask": Scene(
            ENDS,
            look="near",
            still=True,
            handles=("bias", "arm"),
            ask=Question(
                "The compass is {bias} off. If the antenna stood over the axle, what would be "
                "right?",
                dict.fromkeys(("its place", "its heading", "neither"), "it {ends}."),
                "its place" if place and not heading else "its heading" if heading else "neither",
                {"arm": 0.0},
            ),
        ),
        "bearing": Scene(
            "It {ends}.",
            still=True,
            to={"bias": 0.0, "arm": 0.0},
            handles=("takes",),
            ask=Question(
                "Its program takes the bearing, which counts clockwise from north, for the "
                "heading, which counts from east. Does it get there?",
                dict.fromkeys(("reaches it all the same", "never gets there"), "it {ends}."),
                reached,
                {"takes": "bearing"},
            ),
        ),
    }
    knobs = {
        "bias": Knob(
            BIAS, -20.0, 20.0, 0.5, "how far off the compass is", "°", label="compass off"
        ),
        "arm": Knob(
            ARM, 0.0, 0.5, 0.01, "the antenna ahead of the axle", "m", label="antenna ahead"
        ),
        "takes": Choice(
            "heading",
            {"heading": "the heading", "bearing": "the bearing"},
            "the angle that its program takes for its heading",
            "It takes",
        ),
    }
    data = {"gains": GENTLE_GAINS._asdict(), "dt": DT, "radius": RADIUS}
    data["steps"] = round(SECONDS / DT)
    return Stage("crooked_compass", knobs, scenes, scene, start=START, goal=GOAL, data=data)
