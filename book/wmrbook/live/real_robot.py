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
            "At 1 m/s the robot drives on for 0.5 s without a fix, then brakes. How much farther "
            "does it roll at 2 m/s?",
            "The way before it brakes grows with the speed, the way while it brakes with the "
            "square.",
            answers={
                "twice as far": times < 2.1,
                "two to four times as far": 2.1 <= times < 3.9,
                "four times as far": 3.9 <= times < 4.1,
                "farther still": times >= 4.1,
            },
            wrong=(
                "The way while it brakes grows with the square of the speed.",
                "",
                "The half second before it brakes adds a way that is only doubled.",
                "No part of the way grows by more than the square of the speed.",
            ),
            asked=({"speed": 2.0},),
        ),
    )
