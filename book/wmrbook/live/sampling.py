"""Chapter 8: what the clock and the wheels do."""

from __future__ import annotations

import math

from wmrbook.live.parts import Choice, Knob, Live, between, choose, nearest
from wmrlib import (
    Wheels,
    arrival,
    longest_step,
    paper,
    simulate,
)
from wmrlib.gains import GENTLE_GAINS

LATE = 1.1  # times the longest step, in the question
TRACK, DT = 0.5, 0.05  # m, s


def unit_circle() -> Live:
    """The poles of one step of a sampled robot, and how its drive ends."""
    case = paper.outdoor()
    tunings = {"paper": case.gains, "gentle": GENTLE_GAINS}
    longest = {
        name: {method: longest_step(gains, method) for method in ("arc", "euler")}
        for name, gains in tunings.items()
    }
    options = {"method": "arc", "dt": LATE * longest["gentle"]["arc"], "duration": 60.0}
    end = arrival(simulate(case.start, case.goal, GENTLE_GAINS, **options))
    off = abs(math.degrees(end.heading_error))
    return Live(
        "unit_circle",
        "A robot with {gains} drives in {method}; {longest} is its longest step. Sampled every "
        "[{times!} · {longest} = {dt}], it keeps [1 - {rate} · {step} = {kept}] of the distance. "
        "The farthest pole of the angles is {size} from the middle: near the goal they {fate}. "
        "The drive {end}.",
        {
            "times": Knob(LATE, 0.2, 1.7, 0.05, "the time step over the longest", label="dt"),
            "gains": Choice(
                "gentle", {"gentle": "gentle gains", "paper": "the paper's gains"}, "the gains"
            ),
            "method": Choice("arc", {"arc": "arcs", "euler": "Euler steps"}, "the steps"),
        },
        data=between(
            *case[:2], gains={name: it._asdict() for name, it in tunings.items()}, longest=longest
        ),
        ask=choose(
            "Gentle gains, and a time step a tenth longer than the longest that settles. Where "
            "does the drive end?",
            "The distance still comes down, but the angles grow from step to step.",
            answers={
                "as it should, nearly": end.arrived and off < 10.0,
                "at the goal, looking elsewhere": end.arrived and off >= 10.0,
                "nowhere: it drives on": not end.arrived,
            },
            wrong=(
                "A tenth too long is too long: the angles grow from step to step.",
                "",
                "The distance has a limit of its own, 1.25 s: it still comes down.",
            ),
        ),
    )


def parking() -> Live:
    """Wheels that stand below a speed: where the robot stops, and what mends it."""
    dead, radius, wheels = 0.1, 0.05, Wheels(TRACK, max_speed=2.0, acceleration=1.0)
    case, options = paper.outdoor(), {"dt": DT, "duration": 60.0, "arrival_radius": radius}
    motors = wheels._replace(dead_band=dead)
    end = arrival(simulate(case.start, case.goal, GENTLE_GAINS, wheels=motors, **options))
    choices = {"5 cm": 0.05, "about 12 cm": 0.12, "half a metre": 0.5}
    return Live(
        "parking",
        "Wheels that are told less than {dead} stand. To arrive within {radius}, the robot {mend}. "
        "It {ends}, {stops} from the goal and {off} off.",
        {
            "dead": Knob(dead, 0.0, 0.2, 0.01, "what a wheel stands below", "m/s", "v_dead"),
            "mend": Choice(
                "none",
                {
                    "none": "slows down as the law says",
                    "least": "stays faster than its dead band",
                    "turn": "stays faster, then turns",
                },
                "what the robot does about it",
            ),
            "radius": Knob(radius, 0.02, 0.3, 0.01, "the arrival radius", "m", label="radius"),
            "time": Knob(
                1.0, 0.0, 1.0, 0.01, "how far through the last metre", label="on its way", plays=5.0
            ),
        },
        data=between(
            *case[:2],
            gains=GENTLE_GAINS._asdict(),
            wheels={"track_width": TRACK, "max_speed": 2.0, "acceleration": 1.0},
        ),
        ask=choose(
            "Wheels that are told less than 0.1 m/s stand. The drive should end at 5 cm. How far "
            "from the goal does it stop?",
            "The speed falls with the distance, and below 0.1 m/s the wheels stand.",
            answers=nearest(end.distance, choices),
            wrong=(
                "At 5 cm the gentle gains ask for 0.04 m/s; long before, the wheels stand.",
                "",
                "Half a metre away the gains still ask for nearly 0.4 m/s.",
            ),
        ),
    )
