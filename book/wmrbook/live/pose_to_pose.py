"""Chapter 5: the paper's drive, which way x points, and what is left of the heading."""

from __future__ import annotations

import math

from wmrbook.live.parts import Ask, Choice, Knob, Live, between, choose
from wmrlib import GENTLE_GAINS, gains_for, paper, polar_error, simulate

RADII = (0.05, 0.1)  # m, where the prediction compares


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
            f"The robot starts with a heading of {math.degrees(north.start.heading):.0f}°, and x "
            "is north, y east. Which way does it face on a map with north up? Turn the arrow.",
            "A heading is counted from x towards y, so from north it goes clockwise, like a "
            "bearing. The same number, counted from east, goes the other way round.",
            key=key,
            pane="whole",
            at=tuple(east.start[:2]),
        ),
    )


def heading_left() -> Live:
    """The heading error over the distance left, and the last metre, for a radius to stop at."""
    case = paper.outdoor()
    kinds = {
        "paper": case.gains,
        "gentle": GENTLE_GAINS,
        "designed": gains_for(0.8, heading_rate=1.6, damping=1.0),
    }
    how = {"method": "continuous", "dt": 0.05, "duration": 120.0}
    stops = [{"arrival_radius": radius, **how} for radius in (*RADII, 0.3)]
    runs = (simulate(case.start, case.goal, case.gains, **stop) for stop in stops)
    first, second, far = (float(run.heading_error[-1]) for run in runs)
    more, less = abs(second) > 1.2 * abs(first), abs(second) < 0.8 * abs(first)
    return Live(
        "heading_left",
        "With {choice} the robot that stops {radius} before its goal does so after {seconds}, "
        "{left} off; from there on it would be up to {largest} off.",
        {
            "choice": Choice(
                "paper",
                {
                    "paper": "the paper's gains",
                    "gentle": "gentle gains",
                    "designed": "designed gains",
                },
                "the gains",
            ),
            "radius": Knob(
                0.1, 0.005, 0.6, None, "the distance at which it stops", "m", label="stops at"
            ),
        },
        data=between(
            *case[:2], gains={name: it._asdict() for name, it in kinds.items()}, asked=RADII
        ),
        ask=choose(
            f"With the paper's gains the heading is {abs(math.degrees(far)):.0f}° off to the left "
            f"when 30 cm are left, and {abs(math.degrees(first)):.0f}° to the right when "
            f"{100 * RADII[0]:.0f} cm are. How far off is a robot that stops "
            f"{100 * RADII[1]:.0f} cm before its goal?",
            "Between the two it passes zero, and that happens near 10 cm. What is left of a swing "
            "that outlasts the distance tells where it was stopped, no more.",
            answers={
                "More than at 5 cm: there was less time to turn": more,
                "As much as at 5 cm": not more and not less,
                "Less than at 5 cm: it has swung through zero in between": less and first * far < 0,
            },
            wrong=(
                "The heading swings. On its way from 52° left to 27° right it passes through zero.",
                "Between 52° left and 27° right it passes through zero, so it is not 27° off "
                "all the way.",
                "",
            ),
        ),
    )
