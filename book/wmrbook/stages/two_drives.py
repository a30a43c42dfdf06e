"""Chapter 5: the paper's drive beside one of your own, and where both are stopped."""

from __future__ import annotations

from wmrbook.live.parts import Knob
from wmrbook.stages.parts import Question, Scene, Stage, gain_knobs, off_heading, paper_drive
from wmrlib import GENTLE_GAINS, paper, simulate

RADIUS, WIDER = 0.05, 0.1  # m
CAME = "With the paper's gains (grey) it {theirs}; with yours (blue) it {yours}."


def two_drives(scene: str = "whole") -> Stage:
    """Return the paper's drive outdoors beside one with other gains, as one of its scenes."""
    before, after = _left(RADIUS), _left(WIDER)
    answers = {
        "almost nothing": after < 0.2 * before,
        "about as much": 0.2 * before <= after < 1.2 * before,
        "more": after >= 1.2 * before,
    }
    verdict = (
        f"with the paper's gains (grey) it {{theirs}}, not {before:.0f}°. Did the gains "
        "get better, or did we only stop earlier? Move the distance."
    )
    scenes = {
        "whole": Scene(f"Both arrive. Which one parks? {CAME}"),
        "given": Scene(
            "All that the paper gives: a start that faces {from} from east, a goal {distance} away "
            "that should be reached facing {to}, a speed limit, three gains and a time step.",
            still=True,
        ),
        "drives": Scene(
            "The paper's gains (grey): *v* stays below 4 m/s by itself. The robot turns at "
            "{sharpest} at most. Look where.",
            shows=("twist",),
        ),
        "errors": Scene(
            "The goal lies {east} east and {north} north. Both errors of the grey robot shrink to "
            "nearly nothing. So what is missing?",
            shows=("legs",),
        ),
        "near": Scene(CAME, look="near"),
        "ask": Scene(
            CAME,
            look="near",
            still=True,
            ask=Question(
                f"At {100 * RADIUS:.0f} cm the paper's gains leave {before:.0f}°. If we stop both "
                f"at {100 * WIDER:.0f} cm, they leave",
                dict.fromkeys(answers, verdict),
                next(answer for answer, right in answers.items() if right),
                {"radius": WIDER},
            ),
        ),
    }
    stops = Knob(RADIUS, 0.01, 0.3, 0.01, "how far from the goal they stop", "m", label="stop at")
    knobs = gain_knobs(GENTLE_GAINS) | {"radius": stops}
    data = {"v_max": GENTLE_GAINS.v_max, "gains": paper.OUTDOOR_GAINS._asdict()}
    return Stage("two_drives", knobs, scenes, scene, **paper_drive(), data=data)


def _left(radius: float) -> float:
    """Return the heading that the paper's gains leave at this distance, in degrees."""
    start, goal, gains, _ = paper.outdoor()
    options = {"method": "continuous", "arrival_radius": radius}
    return off_heading(simulate(start, goal, gains, **options))
