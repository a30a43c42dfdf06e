"""Chapter 7: poles, gains, and the robot that has them."""

from __future__ import annotations

from wmrbook.live.parts import Knob, Live
from wmrlib import Gains, Pose

GAINS = Gains(k_rho=0.5, k_alpha=2.0, h=0.5, v_max=4.0)
START, GOAL = Pose(-2.0, -0.8, 0.6), Pose(0.0, 0.0, 0.0)


def poles() -> Live:
    """The poles of the angles near the goal: drag them, and the gains follow; and back."""
    return Live(
        "poles",
        "With {k_alpha} and {h}, at *k_rho* *v_max* = 2 per second, the angles swing at "
        "{frequency} with damping {damping}. From two metres the robot {end}.",
        {
            "k_alpha": Knob(
                GAINS.k_alpha,
                0.0,
                16.0,
                0.1,
                "steering towards the goal, k_alpha",
                "1/s",
                "k_alpha",
            ),
            "h": Knob(GAINS.h, 0.0, 12.0, 0.05, "weight of the final heading, h", "", "h"),
        },
        data={"k_rho": GAINS.k_rho, "v_max": GAINS.v_max, "start": list(START), "goal": list(GOAL)},
    )
