"""Chapter 6: four gains, and the two numbers that shape the path."""

from __future__ import annotations

import math

from wmrbook.stages.parts import GENTLE, Question, Scene, Stage, gain_knobs, off_heading
from wmrlib import Pose, paper, simulate
from wmrlib.gains import Gains

START = Pose(-3.0, -2.0, math.radians(60.0))  # in units of 1/k_rho
STOPS = 0.02  # of the same
NUMBERS = "*kappa* = {kappa} and *h* = {height}: {window}."


def two_numbers(scene: str = "whole") -> Stage:
    """Return the last metres, with 1/k_rho as the unit of length, as one of its scenes."""
    gains = paper.OUTDOOR_GAINS
    half = gains._replace(k_rho=gains.k_rho / 2, k_alpha=gains.k_alpha / 2)
    (far, left), (twice, left_now) = _drive(gains), _drive(half)
    same = abs(left_now - left) < 0.1
    answers = {
        "twice as long, of the same shape": same and abs(twice / far - 2) < 0.01,
        "as long as before, of the same shape": same and abs(twice / far - 1) < 0.01,
        "of another shape": not same,
    }
    verdict = (
        "*kappa* is still {kappa}. Only the bar in the corner has changed, and the clock: the path "
        "is {metres} long instead of " + f"{far:.1f} m."
    )
    scenes = {
        "whole": Scene(
            f"Four gains: which numbers matter? {NUMBERS} It {{ends}}.",
            look="other",
        ),
        "ask": Scene(
            f"{NUMBERS} It {{ends}}.",
            look="other",
            still=True,
            ask=Question(
                "Halve *k_rho* and *k_alpha* and start twice as far away. The path becomes",
                dict.fromkeys(answers, verdict),
                next(answer for answer, right in answers.items() if right),
                {"k_rho": half.k_rho, "k_alpha": half.k_alpha},
            ),
        ),
        "window": Scene(
            f"In the green window the heading settles first. Here, {NUMBERS} It {{ends}}.",
            look="other",
            to=GENTLE,
        ),
    }
    data = {"v_max": gains.v_max, "start": list(START), "stops": STOPS}
    return Stage(
        "two_numbers",
        gain_knobs(gains),
        scenes,
        scene,
        goal=Pose(0.0, 0.0, 0.0),
        hands=(),
        data=data,
    )


def _drive(gains: Gains) -> tuple[float, float]:
    """Return how long the path is, m, and how far off its heading it ends, degrees."""
    start = Pose(START.x / gains.k_rho, START.y / gains.k_rho, START.heading)
    options = {"method": "continuous", "arrival_radius": STOPS / gains.k_rho, "dt": 0.02}
    run = simulate(start, Pose(0.0, 0.0, 0.0), gains, **options)
    steps = zip(run.x[1:] - run.x[:-1], run.y[1:] - run.y[:-1], strict=True)
    return sum(math.hypot(*step) for step in steps), off_heading(run)
