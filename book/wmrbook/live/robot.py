"""Chapter 2: steps in time."""

from __future__ import annotations

import math

from wmrbook.live.parts import Knob, Live, choose, nearest
from wmrlib import Pose, advance

ORIGIN = Pose(0.0, 0.0, 0.0)
V, OMEGA, DT = 4.0, 1.0, 0.4  # m/s, rad/s and s, of Euler's steps


def one_step() -> Live:
    """Exact arcs and Euler's straight steps, over a half turn."""
    halved = _miss(DT / 2) / _miss(DT)
    shares = {"as far": 1.0, "half as far": 0.5, "a quarter as far": 0.25}
    return Live(
        "one_step",
        f"A half turn at {V:.0f} m/s and {OMEGA:.0f} rad/s takes {{count}} of {{dt}}. Euler's "
        "first misses the arc by {miss}; after the last it is {off} away.",
        {"dt": Knob(DT, 0.02, 1.5, None, "time step", "s", label="time step")},
        data={"v": V, "omega": OMEGA},
        ask=choose(
            f"In straight steps of {DT} s the robot ends {_miss(DT):.1f} m beside the half "
            "circle's end. How far with steps half as long?",
            "Each step misses a quarter as much, but there are twice as many.",
            answers=nearest(halved, shares),
            wrong=(
                "Each step misses less, and so does the end.",
                "",
                "Each step misses a quarter as much, but there are twice as many of them.",
            ),
            asked=({"dt": 0.2},),
        ),
    )


def _miss(dt: float) -> float:
    """How far Euler's steps end from the arc's, after a half turn, m."""
    whole, left = divmod(math.pi / OMEGA, dt)
    pose = ORIGIN
    for time in [dt] * int(whole) + [left]:
        pose = advance(pose, V, OMEGA, time, method="euler")
    return math.dist(pose[:2], advance(ORIGIN, V, OMEGA, math.pi / OMEGA)[:2])
