"""Chapter 7: a goal that drives round a circle, and a robot that stays behind it."""

from __future__ import annotations

from wmrbook.live.parts import Choice
from wmrbook.stages.parts import Question, Scene, Stage, gain_knobs
from wmrlib import KanayamaGains, paper, residual, track

DURATION = 40.0  # s
STAYS = "In the last five seconds the gap is {gap}."
LAWS = {"corrected": "only the goal's place", "kanayama": "its speed too"}


def moving_goal(scene: str = "whole") -> Stage:
    """Return the paper's circle with a robot that follows, as one of its scenes."""
    gains = paper.CIRCLE_GAINS
    names = "k_rho", "k_alpha", "h"
    gaps = {name: _gap(**{name: 2 * getattr(gains, name)}) for name in names}
    best = min(names, key=lambda name: gaps[name])
    verdict = f"with *{best}* doubled the gap is {{gap}} instead of {100 * _gap():.1f} cm."
    scenes = {
        "whole": Scene(
            f"The goal drives round and never stops. Does the robot catch it? {STAYS}",
            look="other",
        ),
        "goal": Scene(
            f"The goal drives once round in {DURATION:.0f} seconds, and the robot follows it. "
            "Could a robot drive exactly as this goal does?",
            look="other",
            shows=("goal",),
        ),
        "speeds": Scene(
            "In the corner: the speed that the law asks for at each distance, and the goal's. "
            "Where they cross, the gap stays: {gap}.",
            look="other",
            shows=("speeds",),
        ),
        "ask": Scene(
            STAYS,
            look="other",
            still=True,
            ask=Question(
                "Which gain, doubled, shortens the gap most?",
                {f"*{name}*": verdict for name in names},
                f"*{best}*",
                {best: 2 * getattr(gains, best)},
            ),
        ),
        "frame": Scene(
            "Seen from the robot, the goal is {ahead} and {aside}, and it faces {turned}. Drag "
            "the robot, or turn it.",
            look="other",
            shows=("frame",),
            handles=(),
            still=True,
            until=0.0,
        ),
        "speed": Scene(
            f"Now it also knows how fast the goal drives and turns. {STAYS}",
            look="other",
            to={"law": "kanayama"},
            moved=STAYS,
        ),
    }
    law = Choice("corrected", LAWS, "what the robot knows", "The robot knows")
    data = {
        "v_max": gains.v_max,
        "feedback": KanayamaGains(k_x=1.0, k_y=2.0, k_heading=2.0)._asdict(),
        "duration": DURATION,
        "radius": paper.CIRCLE_RADIUS,
        "speed": paper.CIRCLE_SPEED,
    }
    knobs = gain_knobs(gains) | {"law": law}
    return Stage("moving_goal", knobs, scenes, scene, start=paper.CIRCLE_START, data=data)


def _gap(**changed: float) -> float:
    """Return how far behind the robot stays with some gains changed, m."""
    gains = paper.CIRCLE_GAINS._replace(**changed)
    return residual(track(paper.circle, paper.CIRCLE_START, gains, duration=DURATION))
