"""Chapter 7: poles, gains, and the robot that has them."""

from __future__ import annotations

import math

from wmrbook.live.parts import Ask, Knob, Live
from wmrlib import Gains, Pose, modes, paper

GAINS = Gains(k_rho=0.5, k_alpha=2.0, h=0.5, v_max=4.0)
HEAVIER = 4.0  # times h, in the prediction
ASKED = (0.0, 40.0)  # deg, alpha and theta
START, GOAL = Pose(-2.0, -0.8, 0.6), Pose(0.0, 0.0, 0.0)


def poles() -> Live:
    """The poles of the angles near the goal: drag them, and the gains follow; and back."""
    pace = GAINS.k_rho * GAINS.v_max
    ratio = modes(GAINS._replace(h=HEAVIER * GAINS.h)).damping / modes(GAINS).damping
    becomes = {
        "It is halved": 0.4 < ratio < 0.6,
        "It stays: only k_alpha is a damper": 0.9 < ratio < 1.1,
        "It is doubled": 1.9 < ratio < 2.1,
        "It is a quarter of what it was": 0.2 < ratio < 0.3,
    }
    return Live(
        "poles",
        f"With [*k_rho* *v_max* = {pace:g}] per second the poles of the angles solve "
        f"[*s*² + {{k_alpha!}} *s* + {pace**2:g} · {{h!}} = 0]: a natural frequency of "
        "{frequency}, a damping ratio of {damping}. From about two metres the robot {end}.",
        {
            "k_alpha": Knob(
                GAINS.k_alpha, 0.0, 9.0, 0.1, "steering towards the goal, k_alpha", "1/s", "k_alpha"
            ),
            "h": Knob(GAINS.h, 0.05, 5.0, 0.05, "weight of the final heading, h", "", "h"),
        },
        data={"k_rho": GAINS.k_rho, "v_max": GAINS.v_max, "start": list(START), "goal": list(GOAL)},
        ask=Ask(
            "choose",
            "The weight h of the final heading is made four times as large, and the other gains "
            "stay. What becomes of the damping ratio?",
            "It is k_alpha over twice the natural frequency, which grows with the root of h. A "
            "damper that stops a slow swing is a weak one for a fast swing.",
            key=[*becomes.values()].index(True),
            options=(*becomes,),
        ),
    )


def phase() -> Live:
    """The plane of the angles near the goal: a state to drag, and its way home."""
    gains = paper.OUTDOOR_GAINS
    damping = float(modes(gains).damping)
    kept = math.exp(-math.pi * damping / math.sqrt(1.0 - damping**2))
    return Live(
        "phase",
        "With a damping of {damping}, from {alpha} and {theta}, the state "
        "{home}. Until then *theta* {turned}.",
        {
            "damping": Knob(round(damping, 3), 0.05, 2.0, 0.01, "damping ratio", "", "zeta"),
            "alpha": Knob(ASKED[0], -60.0, 60.0, 1.0, "alpha at first", "°", "alpha"),
            "theta": Knob(ASKED[1], -60.0, 60.0, 1.0, "theta at first", "°", "theta"),
            "time": Knob(1.0, 0.0, 1.0, 0.005, "how far on its way", label="moved", plays=8.0),
        },
        data={"gains": gains._asdict(), "asked": ASKED},
        ask=Ask(
            "sketch",
            f"With the paper's gains the damping is {damping:.3f}. Near the goal the state starts "
            "at alpha = 0 and theta = 40°. Sketch its way to the middle.",
            f"Each half swing keeps {kept:.0%} of the one before, on the other side of the middle. "
            "For small angles how much is kept follows from the damping ratio alone.",
            pane="plane",
            at=ASKED,
        ),
    )
