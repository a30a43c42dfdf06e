"""Chapter 6: the plane of the two numbers, and the robot that has them."""

from __future__ import annotations

from wmrbook.live.parts import Knob, Live, choose, nearest
from wmrlib import GENTLE_GAINS, Gains, gains_for, modes, paper

CRITICAL = {"kappa": 1.0, "h": 0.25}  # damping 1, outside the window
SIEGWART = (3.0, 8.0, -1.5)  # k_rho, k_alpha, k_beta of Siegwart et al. (2011), section 3.6.2


def window() -> Live:
    """The plane of kappa and h, the window in it, and what a robot with such gains does."""
    named = {
        "paper": paper.OUTDOOR_GAINS,
        "gentle": GENTLE_GAINS,
        "designed": gains_for(0.8, heading_rate=1.6),
    }
    points = [(name, modes(it).kappa, it.h) for name, it in named.items()]
    # near the goal alpha' = -(k_alpha - k_rho) alpha + k_beta theta, and theta' = k_rho alpha
    k_rho, k_alpha, k_beta = SIEGWART
    points.append(("Siegwart", (k_alpha - k_rho) / k_rho, -k_beta / k_rho))
    critical = modes(Gains(k_rho=1.0, k_alpha=CRITICAL["kappa"], h=CRITICAL["h"], v_max=1.0))
    return Live(
        "window",
        "With {kappa} and {h} the gains are {place}: near the goal the heading settles {compared} "
        "than the distance. Over the last tenth of 1/*k_rho*, here of 1 m, it is up to {late} off, "
        "over the last hundredth up to {later}.",
        {
            "kappa": Knob(0.125, 0.05, 6.0, 0.05, "kappa, k_alpha/(v_max k_rho)", "", "kappa"),
            "h": Knob(0.3, 0.05, 6.0, 0.05, "weight of the final heading, h", "", "h"),
        },
        data={"named": points, "start": [-1.0, -4.5, 0.6]},
        ask=choose(
            "With kappa = 1 and h = 0.25 the damping is critical: the heading does not swing. How "
            "fast does it settle, compared with the distance?",
            "Both poles of the heading are -0.5, and the distance's is -1. Without a swing, and "
            "yet too late.",
            answers=nearest(
                1 / critical.slower,
                {"twice as fast": 2.0, "just as fast": 1.0, "half as fast": 0.5},
            ),
            wrong=(
                "Critical damping is the fastest for this h, but this h is too small: both poles "
                "are -0.5, and the distance's is -1.",
                "Damping says whether the heading swings, and not how fast it is beside the "
                "distance: both poles are -0.5, and the distance's is -1.",
                "",
            ),
            asked=(CRITICAL,),
        ),
    )
