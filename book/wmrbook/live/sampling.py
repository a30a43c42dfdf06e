"""Chapter 8: what the clock and the wheels do."""

from __future__ import annotations

import math

import numpy as np

from wmrbook.live.parts import Ask, Choice, Knob, Live, between, choose, nearest
from wmrlib import (
    Pose,
    Wheels,
    advance,
    arrival,
    control_law,
    longest_step,
    paper,
    polar_error,
    simulate,
    twist_to_wheels,
    wheels_to_twist,
)
from wmrlib.gains import GENTLE_GAINS

LATE = 1.1  # times the longest step, in the question
TRACK, DT = 0.5, 0.05  # m, s
START, BESIDE = Pose(0.0, 0.0, 0.0), Pose(0.0, 10.0, 0.0)


def unit_circle() -> Live:
    """The poles of one step of a sampled robot, and how its drive ends."""
    case = paper.outdoor()
    tunings = {"paper": case.gains, "gentle": GENTLE_GAINS}
    longest = {
        name: {method: longest_step(gains, method) for method in ("arc", "euler")}
        for name, gains in tunings.items()
    }
    how = {"method": "arc", "dt": LATE * longest["gentle"]["arc"], "duration": 60.0}
    end = arrival(simulate(case.start, case.goal, GENTLE_GAINS, **how))
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
            "The outdoor drive, x east, in arcs: gentle gains, and a time step a tenth longer than "
            "the longest with which the angles near the goal settle. Where does it end?",
            "Here the distance still comes down, so the robot reaches the goal. The angles grow "
            "from step to step, and it stops at whatever heading it has by then.",
            answers={
                "as it should, but for a few degrees": end.arrived and off < 10.0,
                "at the goal, looking elsewhere": end.arrived and off >= 10.0,
                "nowhere: it drives on and on": not end.arrived,
            },
            wrong=(
                "A tenth too long is too long: the angles grow from step to step.",
                "",
                "The distance has a limit of its own, 1.25 s. It still comes down.",
            ),
        ),
    )


def clipped_wheels(limit: float) -> list[Pose]:
    """The drive to the goal beside the start, each wheel clipped on its own."""
    poses = [START]
    while (seen := polar_error(poses[-1], BESIDE)).rho > 0.05 and len(poses) < 1500:
        wheels = twist_to_wheels(*control_law(*seen, GENTLE_GAINS), TRACK)
        twist = wheels_to_twist(*np.clip(wheels, -limit, limit), TRACK)
        poses.append(advance(poses[-1], *twist, DT))
    return poses


def wheel_limit() -> Live:
    """Wheels that can't go faster: three rules, and the paths that they leave."""
    limit = 2.0
    free = simulate(START, BESIDE, GENTLE_GAINS, method="continuous", dt=0.02)
    x, _, _ = np.transpose(clipped_wheels(limit))
    swing = "swings wide ahead" if x.max() > 2.0 * free.x.max() else "keeps to the free path"
    return Live(
        "wheel_limit",
        "No wheel can go faster than {limit}, and {rule}. The robot parks after {seconds} and "
        "strays {strays} from its path without a limit and in continuous time.",
        {
            "limit": Knob(limit, 1.2, 4.0, 0.1, "the fastest that a wheel goes", "m/s", "v_w"),
            "rule": Choice(
                "wheels",
                {
                    "wheels": "each is clipped by itself",
                    "apart": "v and ω are clipped one by one",
                    "both": "both are scaled alike",
                },
                "the rule",
            ),
            "time": Knob(1.0, 0.0, 1.0, 0.01, "how far on its way", label="on its way", plays=5.0),
        },
        data=between(START, BESIDE, gains=GENTLE_GAINS._asdict(), track=TRACK, dt=DT),
        ask=Ask(
            "sketch",
            "The goal is 10 m to the robot's left. Each wheel does 2 m/s at most and is clipped by "
            "itself, half of what the law asks for. Sketch the path from the robot on.",
            f"It {swing}, {x.max():.1f} m: the faster wheel loses more than the slower one, so "
            "little is left to turn with. The lower the limit, the wider the path.",
            pane="plane",
            at=START[:2],
        ),
    )


def parking() -> Live:
    """Wheels that stand below a speed: where the robot stops, and what mends it."""
    dead, radius, wheels = 0.1, 0.05, Wheels(TRACK, max_speed=2.0, acceleration=1.0)
    case, how = paper.outdoor(), {"dt": DT, "duration": 60.0, "arrival_radius": radius}
    motors = wheels._replace(dead_band=dead)
    end = arrival(simulate(case.start, case.goal, GENTLE_GAINS, wheels=motors, **how))
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
            "The outdoor drive with gentle gains should end at 5 cm. A wheel that is told less "
            "than 0.1 m/s stands. How far from the goal does the robot stop?",
            "The speed falls with the distance, and the wheels stand as soon as it is below "
            "0.1 m/s. The slower the gains brake, the farther away that is.",
            answers=nearest(end.distance, choices),
            wrong=(
                "5 cm away the gentle gains ask for 0.04 m/s. Long before, the wheels stand.",
                "",
                "Half a metre away they still ask for nearly 0.4 m/s.",
            ),
        ),
    )
