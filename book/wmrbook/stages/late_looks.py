"""Chapter 8: a robot that looks, and drives with its eyes closed until it looks again."""

from __future__ import annotations

from wmrbook.live.parts import Choice, Knob, nearest
from wmrbook.stages.parts import (
    GENTLE,
    PAPER,
    Question,
    Scene,
    Stage,
    gain_knobs,
    off_heading,
    paper_drive,
)
from wmrlib import GENTLE_GAINS, Gains, Trajectory, Wheels, paper, simulate

RADIUS, SECONDS = 0.05, 60.0
OFTEN, LATE = 0.05, 0.8  # s between two looks: hardly felt by the gentle gains, and too long
TRACK = 0.5  # m from wheel to wheel
DEAD = 0.1  # m/s, below which a sticky wheel stands
WHEELS = {
    "ideal": Wheels(TRACK),
    "slow": Wheels(TRACK, lag=0.9),
    "sticky": Wheels(TRACK, dead_band=DEAD),
    "least": Wheels(TRACK, dead_band=DEAD, min_speed=1.1 * DEAD),
}
CHOICES = {
    "ideal": "ideal",
    "slow": "0.9 s late",
    "sticky": "sticky",
    "least": "least speed",
    "turn": "last turn",
}

ENDS = "With a look every {every} it {ends}."


def late_looks(scene: str = "whole") -> Stage:
    """Return the paper's drive by a robot that acts only at its ticks, as one of its scenes."""
    gains, dt = paper.OUTDOOR_GAINS, paper.TIME_STEP
    seldom, often = (off_heading(_drive(gains, step)) for step in (dt, dt / 5))
    late = _drive(GENTLE_GAINS, LATE)
    arrives = late.rho[-1] <= RADIUS
    stuck = _drive(GENTLE_GAINS, OFTEN, "sticky")
    scenes = {
        "whole": Scene(
            "From one look to the next it drives blind. How long may it close its eyes? "
            "After {looks} looks it {ends}.",
            handles=(*GENTLE, "dt"),
        ),
        "near": Scene(
            "The last metre, with the paper's gains and a look every {every}. It {ends}.",
            look="near",
            to={**PAPER, "dt": dt},
            moved=ENDS,
            handles=(*GENTLE, "dt"),
        ),
        "ask": _asking(
            f"With the paper's gains and ten looks a second it stops {seldom:.0f}° off its "
            "heading. With fifty looks a second the error is",
            {
                "smaller": often < seldom - 1,
                "larger": often > seldom + 1,
                "the same": abs(often - seldom) <= 1,
            },
            f"with fifty looks a second it stops {{off}} off, instead of {seldom:.0f}°.",
            {**PAPER, "dt": dt},
            {"dt": dt / 5},
        ),
        "late": _asking(
            f"With the gentle gains and a look every {OFTEN} s it parks. With only one look every "
            f"{LATE} s it",
            {
                "parks as well": arrives and off_heading(late) < 5.0,
                "faces elsewhere": arrives and off_heading(late) >= 5.0,
                "never gets there": not arrives,
            },
            f"with a look every {LATE} s it {{ends}}.",
            {"dt": OFTEN},
            {"dt": LATE},
        ),
        "slow": Scene(
            "Its wheels follow 0.9 s late, about as slowly as the law itself settles. It {ends}.",
            look="near",
            to={"dt": OFTEN, "wheels": "slow"},
            moved=ENDS,
        ),
        "sticky": _asking(
            f"A sticky wheel stands still below {DEAD} m/s. The robot is to stop within "
            f"{100 * RADIUS:.0f} cm of its goal. It stops",
            nearest(stuck.rho[-1], {"within 5 cm": 0.05, "after 12 cm": 0.12, "after 50 cm": 0.5}),
            "it {ends}.",
            {"dt": OFTEN},
            {"wheels": "sticky"},
        ),
        "least": Scene(
            "It never drives so slowly that its wheels would stand. It {ends}.",
            look="near",
            to={"dt": OFTEN, "wheels": "least"},
            moved=ENDS,
        ),
        "turn": Scene(
            "With *h* = 0 the law ignores the goal's heading, but within 5 cm the robot turns on "
            "the spot. It {ends}.",
            look="near",
            to={"dt": OFTEN, "h": 0.0, "wheels": "turn"},
            moved=ENDS,
        ),
    }
    knobs = gain_knobs(GENTLE_GAINS)
    knobs["dt"] = Knob(0.5, 0.02, 2.0, None, "the time between two looks", "s", label="eyes closed")
    knobs["wheels"] = Choice("ideal", CHOICES, "what its wheels can do", "Wheels")
    data = {"v_max": gains.v_max, "radius": RADIUS, "seconds": SECONDS}
    data["wheels"] = {
        name: {field: it for field, it in wheels._asdict().items() if it != float("inf")}
        for name, wheels in WHEELS.items()
    }
    return Stage("late_looks", knobs, scenes, scene, **paper_drive(), data=data)


def _drive(gains: Gains, dt: float, wheels: str = "ideal") -> Trajectory:
    start, goal, _, _ = paper.outdoor()
    options = {"method": "arc", "dt": dt, "duration": SECONDS, "arrival_radius": RADIUS}
    return simulate(start, goal, gains, wheels=WHEELS[wheels], **options)


def _asking(question: str, answers: dict[str, bool], verdict: str, to: dict, then: dict) -> Scene:
    """Return a scene of the last metre that asks, and whose one verdict says what happens."""
    key = next(answer for answer, right in answers.items() if right)
    ask = Question(question, dict.fromkeys(answers, verdict), key, then)
    return Scene(ENDS, look="near", still=True, to=to, ask=ask)
