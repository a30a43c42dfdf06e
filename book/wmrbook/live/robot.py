"""Chapter 2: wheels, moves, and what they add up to."""

from __future__ import annotations

from wmrbook.live.parts import Ask, Knob, Live
from wmrlib import wheels_to_twist

TRACK = 0.6  # m


def turning_centre() -> Live:
    """Two wheel speeds, the twist of (1) and (2), and the point about which the robot turns."""
    left, right = 0.5, 1.0
    v, omega = wheels_to_twist(left, right, TRACK)
    where = v / omega  # m to the left
    places = {
        "between the wheels": abs(where) < TRACK / 2,
        "to its left, beyond the slower wheel": where > TRACK / 2,
        "to its right, beyond the faster wheel": where < -TRACK / 2,
    }
    return Live(
        "turning_centre",
        "The left wheel rolls at {left}, the right one at {right}. The middle moves at {speed} and "
        "turns at {turning}: the robot {centre}.",
        {
            "left": Knob(left, -1.5, 1.5, 0.05, "speed of the left wheel", "m/s", "v_l"),
            "right": Knob(right, -1.5, 1.5, 0.05, "speed of the right wheel", "m/s", "v_r"),
        },
        data={"track": TRACK},
        ask=Ask(
            "choose",
            "The right wheel rolls twice as fast as the left one, both forward. Where is the point "
            "about which the robot turns?",
            "The slower wheel has the shorter way round, so the centre lies on its side; and both "
            "go forward, so it lies beyond it.",
            key=[*places.values()].index(True),
            options=(*places,),
        ),
    )
