"""Chapter 11: a compass on a robot of steel, and a receiver that falls silent."""

from __future__ import annotations

import math

from wmrbook.live.parts import Ask, Knob, Live, choose
from wmrlib import Pose, advance, wrap_angle

FIELD = 30.0  # microtesla, the horizontal part of the Earth's


def compass_heading(heading: float, iron: float, soft: float) -> float:
    """The heading that a compass reports [rad], on a robot of steel.

    Parameters
    ----------
    heading : the true one, rad from magnetic east
    iron : what the robot's magnets add to the field ahead, microtesla
    soft : by which share the steel strengthens the field ahead, and weakens it across
    """
    north = wrap_angle(math.pi / 2 - heading)  # from ahead
    ahead = (1 + soft) * FIELD * math.cos(north) + iron
    left = (1 - soft) * FIELD * math.sin(north)
    return wrap_angle(math.pi / 2 - math.atan2(left, ahead))


def compass() -> Live:
    """Hard and soft iron: what a compass makes of the heading while the robot turns."""
    iron = 20.0
    read = compass_heading(0.0, iron, 0.0)
    return Live(
        "compass",
        "The magnets on the robot add {iron} ahead to the Earth's 30 µT, and its steel makes the "
        "field ahead {soft} stronger and the field across as much weaker. Looking to {heading}, "
        "the robot believes it looks to {read}; in a full turn the error reaches {worst}.",
        {
            "iron": Knob(iron, -25.0, 25.0, 1.0, "hard iron, ahead", "µT", "m"),
            "soft": Knob(0.0, 0.0, 30.0, 1.0, "soft iron", "%", label="soft iron"),
            "heading": Knob(
                0.0, -180.0, 180.0, 2.0, "the true heading, degrees", "°", "phi", plays=6.0
            ),
        },
        data={"field": FIELD},
        ask=Ask(
            "turn",
            "A robot looks east. The Earth's field of 30 µT points north, to its left; magnets on "
            "the robot add 20 µT ahead. The program takes the sum for north. Where does it believe "
            "it looks? Turn the arrow.",
            "The sum points between left and ahead, and the robot believes north to be there: so "
            f"it believes it looks {math.degrees(read):.1f}° to the north of east. Hard iron "
            "turns with the robot, so the error changes with the heading, and no single angle "
            "corrects it.",
            key=read,
            pane="above",
            at=(0.0, 0.0),
        ),
    )


def rolled(speed: float, timeout: float, brake: float, parts: int = 200) -> float:
    """How far a robot rolls after its last fix [m], step by step."""
    pose = Pose(0.0, 0.0, 0.0)
    for length, slows in ((timeout, 0.0), (speed / brake, brake)):
        for k in range(parts):
            now = speed - slows * (k + 0.5) * length / parts
            pose = advance(pose, now, 0.0, length / parts)
    return pose.x


def silence() -> Live:
    """How far a robot rolls when its fixes stop: on in good faith, then braking."""
    timeout, brake = 0.5, 1.0  # s, m/s^2
    times = rolled(2.0, timeout, brake) / rolled(1.0, timeout, brake)
    return Live(
        "silence",
        "A robot at {speed} hears nothing for {timeout}, then brakes at {brake}. It rolls "
        "{faith} in good faith and {braking} braking, {far} in all.",
        {
            "speed": Knob(1.0, 0.1, 4.0, 0.1, "the speed, v", "m/s", "v"),
            "timeout": Knob(timeout, 0.0, 2.0, 0.05, "the timeout, T", "s", "T"),
            "brake": Knob(brake, 1.0, 5.0, 0.1, "the braking, a", "m/s²", "a"),
        },
        ask=choose(
            "Its fixes stop. A robot drives on for half a second, then brakes at 1 m/s² and "
            "stands. Its twin comes at twice the speed, 2 m/s. How far does the twin roll?",
            "The way during the timeout grows with the speed, the way while braking with its "
            "square. The faster the robot, the more the second one counts.",
            answers={
                "twice as far": times < 2.1,
                "between two and four times as far": 2.1 <= times < 3.9,
                "four times as far": 3.9 <= times < 4.1,
                "more than four times as far": times >= 4.1,
            },
            wrong=(
                "The way while braking grows with the square of the speed.",
                "",
                "So it would be if it braked at once. Half a second is driven at full speed, "
                "and that way is doubled.",
                "No part of its way grows by more than the square of the speed.",
            ),
            asked=({"speed": 2.0},),
        ),
    )
