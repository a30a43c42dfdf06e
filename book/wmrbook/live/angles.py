"""Chapter 3: the two angles that the controller sees, and the half turn where they jump."""

from __future__ import annotations

import math

from wmrbook.live.parts import Ask, Knob, Live, between
from wmrlib import Pose, paper, polar_error, pose_from_polar, simulate

ROBOT, GOAL = Pose(1.0, 1.0, math.radians(85.0)), Pose(5.5, 4.0, math.radians(-25.0))
ORIGIN = Pose(0.0, 0.0, 0.0)
BEHIND = Pose(-10.0, 0.0, math.pi)  # of a robot with the origin straight behind it
OFF = 1.0  # deg to the right of straight behind


def polar_angles() -> Live:
    """The distance and the two angles: the robot is moved and turned, and the goal is turned."""
    error = polar_error(ROBOT, GOAL)
    heading = pose_from_polar(error, GOAL).heading
    alpha = f"{math.degrees(error.alpha):.0f}".replace("-", "\N{MINUS SIGN}")
    return Live(
        "polar_angles",
        "The goal is *rho* = {rho} away. *alpha* = {alpha}: to look at it the robot {way}. "
        "*theta* = {theta}, which other books count as *beta* = {beta}; the heading error "
        "*gamma*, *theta* less *alpha*, is {gamma}. The robot looks along {heading}, "
        "the goal along {goal_heading}.",
        {
            "x": Knob(ROBOT.x, -0.5, 7.5, 0.1, "the robot's x", "m", label="robot's x"),
            "y": Knob(ROBOT.y, -0.5, 5.5, 0.1, "the robot's y", "m", label="robot's y"),
            "heading": _heading(ROBOT, "the robot's heading"),
            "goal_heading": _heading(GOAL, "the goal's heading"),
        },
        data=between(ROBOT, GOAL),
        ask=Ask(
            "turn",
            f"The dot is a robot with alpha = {alpha} deg. Which way does it look? Turn the arrow.",
            "Alpha turns from the heading to the line of sight: where it is negative, the goal is "
            "to the robot's right.",
            key=heading,
            pane="plane",
            at=ROBOT[:2],
        ),
    )


def half_turn() -> Live:
    """A goal behind the robot, a little to one side: how it gets there."""
    aside, aside_says = math.radians(OFF), "the goal to the right of straight behind"
    start = BEHIND._replace(heading=BEHIND.heading - aside)
    run = simulate(start, ORIGIN, paper.OUTDOOR_GAINS, method="continuous")
    sets_off = "backwards" if run.v[0] < 0 else "forwards"
    turns = "left" if run.omega[0] > 0 else "right"
    return Live(
        "half_turn",
        "The goal lies {off} to the right of straight behind, so *alpha* = {alpha}. "
        "The robot sets off {sets} and turns {turns} at {omega}; it {end}.",
        {
            "off": Knob(OFF, -60.0, 60.0, 1.0, aside_says, "°", label="to the right"),
            "time": Knob(1.0, 0.0, 1.0, 0.01, "how far on its way", label="on its way", plays=6.0),
        },
        data=between(BEHIND, ORIGIN, gains=paper.OUTDOOR_GAINS._asdict()),
        ask=Ask(
            "sketch",
            f"The goal is behind the robot, {OFF:.0f} deg to the right of straight behind. "
            "Sketch the way.",
            f"It sets off {sets_off}, for cos alpha is negative, and turns {turns} at the same "
            "time.",
            pane="plane",
            at=BEHIND[:2],
        ),
    )


def _heading(pose: Pose, says: str) -> Knob:
    at = math.degrees(pose.heading)
    return Knob(at, -180.0, 180.0, 5.0, says, "°", label=says.removeprefix("the "))
