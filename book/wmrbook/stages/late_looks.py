"""Chapter 8: a robot that looks, and drives with its eyes closed until it looks again."""

from __future__ import annotations

from wmrbook.live.parts import Knob
from wmrbook.stages.parts import (
    PAPER,
    Question,
    Scene,
    Stage,
    gain_knobs,
    off_heading,
    paper_drive,
)
from wmrlib import GENTLE_GAINS, paper, simulate


def late_looks(scene: str = "whole") -> Stage:
    """Return the paper's drive by a robot that acts only at its ticks, as one of its scenes."""
    start, goal, gains, dt = paper.outdoor()
    seldom, often = (
        off_heading(simulate(start, goal, gains, method="arc", dt=step)) for step in (dt, dt / 5)
    )
    key = "better" if often < seldom - 1 else "worse" if often > seldom + 1 else "the same"
    seen = f"it is {key}, {{off}} instead of {seldom:.0f}°."
    scenes = {
        "whole": Scene(
            "From one look to the next it drives blind. How long may it close its eyes? "
            "After {looks} looks it {ends}."
        ),
        "near": Scene("The last metre. After {looks} looks it {ends}.", look="near"),
        "ask": Scene(
            "With {every} between two looks it {ends}.",
            look="near",
            still=True,
            to={**PAPER, "dt": dt},
            ask=Question(
                "With the paper's gains and ten looks a second it stops {off} off. With fifty "
                "looks a second this is",
                dict.fromkeys(("better", "worse", "the same"), seen),
                key,
                {"dt": dt / 5},
            ),
        ),
    }
    knobs = gain_knobs(GENTLE_GAINS)
    knobs["dt"] = Knob(0.5, 0.02, 2.0, None, "the time between two looks", "s", label="eyes closed")
    data = {"v_max": gains.v_max, "radius": 0.05, "seconds": 60.0}
    return Stage("late_looks", knobs, scenes, scene, **paper_drive(), data=data)
