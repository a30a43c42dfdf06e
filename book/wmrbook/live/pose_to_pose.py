"""Chapter 5: which way x points."""

from __future__ import annotations

import math

from wmrbook.live.parts import Ask, Choice, Knob, Live
from wmrlib import paper, polar_error


def x_axis() -> Live:
    """The same numbers read with x east and with x north: two drives on one map."""
    cases = {axis: paper.outdoor(axis) for axis in ("east", "north")}
    east, north = cases["east"], cases["north"]
    sight = math.atan2(east.goal.y - east.start.y, east.goal.x - east.start.x)
    # as far to the left of the line of sight as it was to the right: the map mirrors that frame
    key = sight + polar_error(north.start, north.goal).alpha
    return Live(
        "x_axis",
        "With x {axis} the robot starts {alpha} off the line of sight, and stops after {seconds}, "
        "{off} off.",
        {
            "axis": Choice("north", {"east": "east", "north": "north"}, "where x points"),
            "time": Knob(1.0, 0.0, 1.0, 0.005, "how far on its way", label="on its way", plays=6.0),
        },
        data={
            "starts": {axis: list(case.start) for axis, case in cases.items()},
            "goals": {axis: list(case.goal) for axis, case in cases.items()},
            "gains": east.gains._asdict(),
        },
        ask=Ask(
            "turn",
            f"The robot's heading is {math.degrees(north.start.heading):.0f}°, x is north, y is "
            "east. Which way does it face, with north up? Turn the arrow.",
            "A heading is counted from x towards y: from north it goes clockwise, as a bearing "
            "does.",
            key=key,
            pane="whole",
            at=tuple(east.start[:2]),
        ),
    )
