"""Chapter 6: four gains, and the two numbers that shape the path."""

from __future__ import annotations

import math

from wmrbook.stages.parts import GENTLE, Question, Scene, Stage, gain_knobs, off_heading
from wmrlib import Pose, paper, simulate
from wmrlib.gains import Gains
from wmrlib.tuning import modes

START = Pose(-3.0, -2.0, math.radians(60.0))  # in units of 1/k_rho
STOPS = 0.02  # of the same
DESIGNED = {"k_rho": 0.2, "k_alpha": 3.2, "h": 4.0}  # the heading settles twice as fast
SEARCHED = {"k_rho": 0.33, "k_alpha": 2.64, "h": 3.98}  # the calm set that the search finds
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
    ways = _ways(gains)
    way = next(way for way, right in ways.items() if right)
    scenes = {
        "whole": Scene(
            f"Four gains: which numbers matter? {NUMBERS} The robot {{ends}}.",
            look="other",
        ),
        "settle": Scene(
            "The distance and the heading error over time, in the corner: which of them settles "
            "first? The robot {ends}.",
            look="other",
            shows=("curves",),
        ),
        "poles": Scene(
            "The poles near the goal: a dot for the distance and crosses for the heading. In the "
            "green part the heading settles first. Move *k_alpha* and *h*. The robot {ends}.",
            look="other",
            shows=("poles",),
        ),
        "higher": Scene(
            "The poles near the goal. The robot {ends}.",
            look="other",
            shows=("poles",),
            still=True,
            ask=Question(
                "If *h* is four times as large, where do the two crosses go?",
                dict.fromkeys(
                    ways, f"they go {way}. The heading swings faster, and settles no sooner."
                ),
                way,
                {"h": 4 * gains.h},
            ),
        ),
        "ask": Scene(
            f"{NUMBERS} The robot {{ends}}.",
            look="other",
            still=True,
            ask=Question(
                "Halve *k_rho* and *k_alpha*, and start twice as far away. What becomes of the "
                "path?",
                dict.fromkeys(answers, verdict),
                next(answer for answer, right in answers.items() if right),
                {"k_rho": half.k_rho, "k_alpha": half.k_alpha},
            ),
        ),
        "window": Scene(
            f"In the green window the heading settles first. Here, {NUMBERS} The robot {{ends}}.",
            look="other",
            to=GENTLE,
        ),
        "close": Scene(
            "In the corner, *v*/*rho* at small angles, as a share of its value at the goal. At the "
            "start it is {share}, so the poles at the goal do not hold there yet. The robot "
            "{ends}.",
            look="other",
            shows=("share",),
        ),
        "designed": Scene(
            f"Gains from a specification. {NUMBERS} The robot {{ends}}.",
            look="other",
            to=DESIGNED,
            moved=f"{NUMBERS} The robot {{ends}}.",
        ),
        "searched": Scene(
            "A search found *k_rho* = 0.33, *k_alpha* = 2.64 and *h* = 3.98. Here, "
            f"{NUMBERS} The robot {{ends}}.",
            look="other",
            to=SEARCHED,
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


def _ways(gains: Gains) -> dict[str, bool]:
    """Return where the poles of the heading may go as h grows, and which way they do go."""
    here, there = (modes(it).poles[1] for it in (gains, gains._replace(h=4 * gains.h)))
    moved = there.real - here.real
    return {
        "to the left": moved < -1e-6,
        "straight up and down": abs(moved) <= 1e-6 and there.imag > here.imag,
        "to the right": moved > 1e-6,
    }


def _drive(gains: Gains) -> tuple[float, float]:
    """Return how long the path is, m, and how far off its heading it ends, degrees."""
    start = Pose(START.x / gains.k_rho, START.y / gains.k_rho, START.heading)
    options = {"method": "continuous", "arrival_radius": STOPS / gains.k_rho, "dt": 0.02}
    run = simulate(start, Pose(0.0, 0.0, 0.0), gains, **options)
    steps = zip(run.x[1:] - run.x[:-1], run.y[1:] - run.y[:-1], strict=True)
    return sum(math.hypot(*step) for step in steps), off_heading(run)
