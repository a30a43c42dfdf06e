"""Chapter 6: the plane of the two numbers, and the robot that has them."""

from __future__ import annotations

from wmrbook.live.parts import Knob, Live, choose
from wmrlib import GENTLE_GAINS, Gains, Pose, arrival, gains_for, modes, paper, simulate

GAINS = Gains(k_rho=0.5, k_alpha=2.0, h=0.5, v_max=4.0)
SIEGWART = (3.0, 8.0, -1.5)  # k_rho, k_alpha, k_beta of Siegwart et al. (2011), section 3.6.2
START, GOAL = Pose(-2.0, -0.8, 0.6), Pose(0.0, 0.0, 0.0)


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
    twice = GAINS._replace(k_alpha=2 * GAINS.k_alpha, v_max=2 * GAINS.v_max)
    options = {"method": "continuous", "arrival_radius": 0.01}
    one, two = (arrival(simulate(START, GOAL, gains, **options)) for gains in (GAINS, twice))
    longer, time = two.path_length / one.path_length, two.time / one.time
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
            "v_max and k_alpha are doubled; k_rho and h stay. What becomes of the path?",
            "The path has only two numbers, kappa = k_alpha/(v_max k_rho) and h, and neither has "
            "changed.",
            answers={
                "it gets wider": longer > 1.01,
                "it gets tighter": longer < 0.99,
                "the same, in half the time": 0.99 < longer < 1.01 and 0.45 < time < 0.55,
                "the same, in the same time": 0.99 < longer < 1.01 and 0.95 < time < 1.05,
            },
            wrong=(
                "It would be wider with v_max alone; with k_alpha doubled too, kappa stays.",
                "It would be tighter with k_alpha alone; with v_max doubled too, kappa stays.",
                "",
                "The path stays, but the robot is twice as fast on it.",
            ),
        ),
    )
