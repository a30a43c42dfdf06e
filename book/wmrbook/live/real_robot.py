"""Chapter 11: a receiver that falls silent."""

from __future__ import annotations

from wmrbook.live.parts import Knob, Live, choose
from wmrlib import Pose, advance


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
