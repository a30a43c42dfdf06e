"""Chapter 9: a robot whose receiver is wrong, each time anew, for minutes, or late."""

from __future__ import annotations

import math

import numpy as np

from wmrbook.live.parts import Choice, Knob
from wmrbook.stages.parts import GENTLE, Question, Scene, Stage, gain_knobs
from wmrlib import GENTLE_GAINS, LastTurn, Pose, Receiver, sweep

START, GOAL = Pose(0.0, 0.0, 0.0), Pose(8.0, 3.0, math.pi / 3.0)
DAYS, SEED, DT, RADIUS, SECONDS, SIGMA = 20, 9, 0.1, 0.2, 60.0, 0.3  # s, m, s, m
LATE, MEMORIES = 0.6, {"new": 0.0, "lasting": 300.0}  # s
EARLY = {"k_rho": 0.05, "k_alpha": 0.7, "h": 4.0, "radius": 0.6}
TURN = LastTurn(leave=1e9)
ENDS = "On {days} days it {ends}."
NOISE, HELD = (*GENTLE, "sigma"), (*GENTLE, "radius")  # what a hand moves: the gains, and one more


def noisy_fixes(scene: str = "whole") -> Stage:
    """Return a short drive by noisy fixes, as one of its scenes."""
    options = {"method": "arc", "dt": DT, "arrival_radius": RADIUS, "duration": SECONDS}

    def off(k_alpha: float, **receiver: float) -> float:
        """How far off its heading a robot ends at worst, in degrees; infinite if it never stops."""
        gains = GENTLE_GAINS._replace(k_alpha=k_alpha)
        ends = sweep(START, GOAL, gains, receiver=Receiver(**receiver), seed=SEED, **options)
        worst = math.degrees(np.abs(ends.heading_error).max())
        return worst if np.all(ends.arrived) else math.inf

    k_alpha, noise = GENTLE_GAINS.k_alpha, np.full(DAYS, SIGMA)
    calm, eager = off(k_alpha, sigma=noise), off(3 * k_alpha, sigma=noise)
    position, heading = off(k_alpha, delay=LATE), off(k_alpha, heading_delay=LATE)
    stops = f"stops, but {position:.0f}° off" if position < math.inf else "never stops"
    late = {
        "both": max(position, heading) < math.inf,
        "the one with the late position": position < math.inf == heading,
        "the one with the late heading": heading < math.inf == position,
        "neither": min(position, heading) == math.inf,
    }
    scenes = {
        "whole": Scene(
            "The dots are where its receiver says it is. Where does it stop? " + ENDS,
            handles=NOISE,
        ),
        "sight": Scene(
            "Twenty fixes that it could have had here, and from each the line of sight. The nearer "
            "the goal, the wider they fan out.",
            "near",
            shows=("sight",),
            until=0.8,
            handles=NOISE,
        ),
        "ask": Scene(
            ENDS,
            "near",
            still=True,
            handles=NOISE,
            ask=Question(
                "If it turns three times as fast towards what it sees, how crooked does it stop?",
                dict.fromkeys(
                    ("less crooked than before", "more crooked than before"),
                    f"it now {{ends}}. Before, it was up to {calm:.0f}° off.",
                ),
                "less crooked than before" if eager < calm else "more crooked than before",
                {"k_alpha": 3 * k_alpha},
            ),
        ),
        "lasting": Scene(
            "Now every error lasts for minutes. " + ENDS,
            "near",
            to={"memory": "lasting"},
            moved=ENDS,
            handles=("memory", "sigma", "radius"),
        ),
        "early": Scene(
            "It slows down early and stops within 0.6 m. " + ENDS,
            "near",
            to=EARLY,
            moved=ENDS,
            handles=HELD,
        ),
        "late": Scene(
            "It {one}.",
            still=True,
            to={"sigma": 0.0},
            handles=("late", *GENTLE),
            ask=Question(
                f"One robot sees its position {LATE} s late, another its heading. Which of them "
                "stops within a minute?",
                dict.fromkeys(
                    late,
                    f"this one sees its heading late, and it {{one}}. With a late position it "
                    f"{stops}.",
                ),
                next(answer for answer, right in late.items() if right),
                {"late": "heading"},
            ),
        ),
        "turn": Scene("Where it stops, it turns by its compass. " + ENDS, "near", handles=HELD),
    }
    knobs = gain_knobs(GENTLE_GAINS)
    knobs["sigma"] = Knob(
        SIGMA, 0.0, 0.5, 0.01, "the standard deviation of a fix, on each axis", "m", label="noise"
    )
    knobs["radius"] = Knob(
        RADIUS, 0.05, 1.0, 0.05, "the distance at which it believes to be there", "m", label="stop"
    )
    errors = {"new": "is new in every fix", "lasting": "lasts for minutes"}
    knobs["memory"] = Choice("new", errors, "how long an error lasts", "An error")
    sensors = {"none": "nothing", "position": "the position", "heading": "the heading"}
    knobs["late"] = Choice("none", sensors, "what comes late", f"{LATE} s late is")
    kept = {name: math.exp(-DT / it) if it else 0.0 for name, it in MEMORIES.items()}
    data = {"v_max": GENTLE_GAINS.v_max, "dt": DT, "seed": SEED, "days": DAYS, "keep": kept}
    data |= {"steps": round(SECONDS / DT), "back": round(LATE / DT), "turn": TURN._asdict()}
    return Stage("noisy_fixes", knobs, scenes, scene, start=START, goal=GOAL, data=data)
