"""Chapter 4: many starts, one goal, and a number that falls whatever the start."""

from __future__ import annotations

import math

from wmrbook.stages.parts import Question, Scene, Stage, gain_knobs, off_heading
from wmrlib import GENTLE_GAINS, Pose, lyapunov, simulate

GOAL = Pose(0.0, 0.0, math.radians(90.0))
OWN = Pose(-1.2, -4.4, math.radians(160.0))
OTHERS = [
    Pose(4 * math.cos(angle), 4 * math.sin(angle), math.remainder(2.4 * angle, 2 * math.pi))
    for angle in (math.radians(105 + 60 * k) for k in range(6))
]
RADIUS, NEAR_DEG = 0.01, 5.0  # m and degrees: parked
SECONDS = 30.0
CAME = f"{{parked}} of 7 park within {SECONDS:.0f} seconds, and *V* {{rises}}."


def downhill(scene: str = "whole") -> Stage:
    """Return seven robots on their way to one goal, as one of its scenes."""
    rises, all_park = _outcome(GENTLE_GAINS._replace(h=0.0))
    answers = {
        "*V* never rises, but not all of them park": not rises and not all_park,
        "*V* rises, and not all of them park": rises and not all_park,
        "*V* never rises, and all of them park": not rises and all_park,
    }
    verdict = f"{CAME} With *h* = 0, *V* and the law no longer know the goal's heading."
    scenes = {
        "whole": Scene(
            f"Does it park from everywhere, or only from where we tried? {CAME}", look="other"
        ),
        "drag": Scene(
            f"Drag the start, and turn it: is there one from which *V* rises? {CAME}",
            look="other",
        ),
        "bowl": Scene(
            "*rho* = {distance}, *alpha* = {alpha}, *theta* = {theta}, and so *V* = {value}. "
            "Drag the start, and turn it: where is *V* small?",
            look="other",
            shows=("errors",),
            still=True,
        ),
        "parts": Scene(
            "One robot, and the two parts of its *V*: that of the distance and that of the "
            "angles. Neither ever rises. Drag the start.",
            look="other",
            shows=("parts",),
        ),
        "ask": Scene(
            CAME,
            look="other",
            still=True,
            ask=Question(
                "If we set *h* = 0, what do *V* and the seven robots do?",
                dict.fromkeys(answers, verdict),
                next(answer for answer, right in answers.items() if right),
                {"h": 0.0},
            ),
        ),
    }
    data = {
        "v_max": GENTLE_GAINS.v_max,
        "others": [list(pose) for pose in OTHERS],
        "radius": RADIUS,
        "seconds": SECONDS,
        "near": math.radians(NEAR_DEG),
    }
    places = {"start": OWN, "goal": GOAL, "hands": ("start",)}
    return Stage("downhill", gain_knobs(GENTLE_GAINS), scenes, scene, **places, data=data)


def _outcome(gains) -> tuple[bool, bool]:
    """Return whether V rises in any of the drives, and whether all of them park."""
    options = {"method": "continuous", "arrival_radius": RADIUS, "duration": SECONDS}
    runs = [simulate(start, GOAL, gains, **options) for start in (OWN, *OTHERS)]
    values = [lyapunov(run.rho, run.alpha, run.theta, gains.h) for run in runs]
    rises = any((value[1:] > value[:-1] + 1e-9).any() for value in values)
    return rises, all(run.rho[-1] < 2 * RADIUS and off_heading(run) < NEAR_DEG for run in runs)
