"""Chapter 14: a heading from two fixes, and a compass on a robot that leans."""

from __future__ import annotations

import math

from wmrbook.live.parts import Knob, Live, choose, nearest
from wmrlib import wrap_angle

DIP = 68.0  # degrees below the horizontal, as in central Europe
USABLE = 5.0  # degrees


def course_sigma(sigma: float, distance: float) -> float:
    """The deviation [rad] of the bearing between two fixes that err by `sigma` on each axis [m]."""
    return math.sqrt(2.0) * sigma / distance


def leaning_error(heading: float, dip: float, lean: float) -> float:
    """How far a compass is off [rad] that takes its own plane for level.

    Parameters
    ----------
    heading : rad from magnetic east; dip : of the field; lean : how far the left side is raised
    """
    north = math.pi / 2 - heading  # from ahead
    ahead, left = math.cos(dip) * math.cos(north), math.cos(dip) * math.sin(north)
    left = left * math.cos(lean) - math.sin(dip) * math.sin(lean)
    return wrap_angle(north - math.atan2(left, ahead))


def worst_leaning(dip: float, lean: float) -> float:
    """The largest such error in a full turn [rad]."""
    turn = (math.radians(each) for each in range(-180, 181))
    return max(abs(leaning_error(each, dip, lean)) for each in turn)


def course_cone() -> Live:
    """Two fixes and the cone of headings between them."""
    options, sigma = {"5 m": 5.0, "15 m": 15.0, "50 m": 50.0, "150 m": 150.0}, 3.0
    needed = math.sqrt(2.0) * sigma / math.radians(USABLE)
    return Live(
        "course_cone",
        "Two fixes that err by {sigma}, {distance} apart, give the heading to {off}. "
        f"It takes {{needed}} to reach {USABLE:g}°.",
        {
            "sigma": Knob(sigma, 0.01, 10.0, None, "the error of each fix", "m", "sigma"),
            "distance": Knob(5.0, 0.5, 200.0, None, "the distance between them", "m", "d"),
        },
        data={"usable": math.radians(USABLE)},
        ask=choose(
            "A receiver errs by 3 m to the east and to the north, each fix anew. The robot drives "
            f"straight from one fix to another. How far must it drive to know its heading to "
            f"{USABLE:g} degrees?",
            "Both fixes err across the path by 3 m, so their difference by 4.2 m, and 5 degrees "
            "are a twelfth of the distance.",
            answers=nearest(needed, options),
            wrong=(
                "After 5 m the heading is still uncertain by some 50 degrees.",
                "After 15 m the heading is still uncertain by 16 degrees.",
                "",
                "After 150 m the heading is known to less than 2 degrees.",
            ),
        ),
    )


def leaning_compass() -> Live:
    """What a compass makes of a field that dips while the robot leans."""
    options, lean = {"Not at all": 0.0, "By 3°": 3.0, "By 7°": 7.0, "By 20°": 20.0}, 3.0
    worst = math.degrees(worst_leaning(math.radians(DIP), math.radians(lean)))
    return Live(
        "leaning_compass",
        "The field dips by {dip} and the robot leans by {lean}. Facing {heading}, its compass is "
        "{off} off; in a full turn the error reaches {worst}.",
        {
            "lean": Knob(lean, -15.0, 15.0, 0.5, "how far the left side is raised", "°", "lean"),
            "dip": Knob(DIP, 0.0, 80.0, 1.0, "how far the field dips", "°", label="dip"),
            "heading": Knob(90.0, -180.0, 180.0, 2.0, "the true heading", "°", "phi", plays=6.0),
        },
        ask=choose(
            "In central Europe the magnetic field points 68 degrees below the horizontal. A robot "
            "on a slope leans 3 degrees to its side and takes its compass for level. How far can "
            "its heading be off?",
            "The steep part of the field is 2.5 times the level part, and the lean tips a "
            "twentieth of it into the compass's plane.",
            answers=nearest(worst, options),
            wrong=(
                "Only in a level field does a lean not matter.",
                "The lean tips the steep part of the field, and that is the larger one.",
                "",
                "That takes a lean of about 8 degrees.",
            ),
        ),
    )
