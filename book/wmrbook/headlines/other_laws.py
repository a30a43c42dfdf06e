"""Headlines of chapter 13: what other laws promise, and what they cost."""

from __future__ import annotations

import math

import numpy as np
from scipy.linalg import expm

import wmrlib as wmr
from wmrbook.headlines import SEEDS, Before, headline
from wmrbook.headlines.laws import ANY, ANY_START, DESIGNED, GOAL
from wmrlib import Gains, Pose, Wheels

WALL = {"distance": (0.1, 60.0), **ANY}
WRAPS = Before("no law lets an angle cross half a turn", WALL | {"law": ["corrected"]}, at_most=180)


def _random(near, far, seed, count=1000) -> Pose:
    rng = np.random.default_rng(seed)
    aim, heading = rng.uniform(-math.pi, math.pi, (2, count))
    distance = rng.uniform(near, far, count)
    return Pose(distance * np.cos(aim), distance * np.sin(aim), heading)


@headline(
    "13", "So no angle ever crosses half a turn", at_most=180, unit="deg", before=WRAPS, **WALL
)
def widest_angle(distance, direction, heading, k_rho, k_alpha, h, v_max, law="barrier") -> float:
    """The wheels slow the clock and leave the path as it is, so that no turn is too fast."""
    start = Pose(distance * math.cos(direction), distance * math.sin(direction), heading)
    how = {"method": "continuous", "dt": 0.05, "duration": 30.0, "wheels": Wheels(0.4, 1.0)}
    run = wmr.simulate(start, GOAL, Gains(k_rho, k_alpha, h, v_max), law=law, **how)
    return math.degrees(max(np.abs(run.alpha).max(), np.abs(run.theta).max()))


APART = {"k_phi": (1.0, 2.0), "times": [0.5, 0.7, 1.4, 2.0]}  # k_delta, of k_phi
GRACEFUL = {**APART, "distance": (0.5, 3.0), **ANY_START}
EITHER = Before("falls by the power k_phi", {**GRACEFUL, "of": ["k_phi"]}, at_least=0.8)


@headline("13", "only the slower remains", at_least=0.8, at_most=1.2, before=EITHER, **GRACEFUL)
def power_over_gain(k_phi, times, distance, direction, heading, of="smaller") -> float:
    """The power between 1 mm and 0.1 mm."""
    start = Pose(distance * math.cos(direction), distance * math.sin(direction), heading)
    gains = Gains(2.0, times * k_phi, k_phi, 1.0)
    how = {"law": "graceful", "method": "continuous", "duration": 600.0}
    ends = [wmr.simulate(start, GOAL, gains, arrival_radius=at, **how) for at in (1e-3, 1e-4)]
    angles = [math.hypot(run.alpha[-1], run.theta[-1]) for run in ends]
    return math.log10(angles[0] / angles[1]) / (
        k_phi if of == "k_phi" else min(k_phi, gains.k_alpha)
    )


@headline("13", "about 0.1 deg at 5 cm", at_least=0.05, at_most=0.15, radius=[0.05], seed=SEEDS)
@headline("13", "4 to 5 deg at 25 cm", at_least=3.5, at_most=5.7, radius=[0.25], seed=SEEDS)
def docking_median(radius, seed) -> float:
    run = wmr.sweep(
        _random(0.5, 3.0, seed, 4000),
        GOAL,
        Gains(2.0, 2.0, 3.0, 1.0),
        law="graceful",
        arrival_radius=radius,
        progress=False,
    )
    return math.degrees(np.median(np.abs(run.heading_error)))


@headline("13", "fall at least by the power", c_1=(0.2, 5.0), c_2=(0.2, 5.0), s=(0.1, 6.0))
def falls_by_the_smaller(c_1, c_2, s) -> bool:
    """V of (13.3) falls by twice that power from any start, to the last digits."""
    left = np.linalg.norm(expm(np.array([[-c_1, 1.0], [-1.0, -c_2]]) * s), 2)
    return bool(left <= math.exp(-min(c_1, c_2) * s) * (1.0 + 1e-9))


LIMITS = {"track": (0.2, 0.6), "fastest": (0.3, 1.0), "dt": (0.005, 0.05)}
SOONER = "every law but the barrier law is sooner from each of these starts"


@headline("13", SOONER, law=["corrected", "printed", "aicardi", "graceful"], seed=SEEDS, **LIMITS)
def sooner_backwards(law, seed, track, fastest, dt) -> bool:
    rng = np.random.default_rng(seed)
    x, (y, heading) = rng.uniform(1.8, 2.2, 1000), rng.uniform(-0.4, 0.4, (2, 1000))
    other = {"aicardi": Gains(0.8, 3.2, 4.0, 1.0), "graceful": Gains(1.0, 2.0, 3.0, 1.0)}
    gains, wheels = other.get(law, DESIGNED), Wheels(track, fastest)
    how = {"law": law, "method": "arc", "dt": dt, "wheels": wheels, "progress": False}
    forwards, backwards = (
        wmr.sweep(Pose(x, y, heading + turn), GOAL._replace(heading=turn), gains, **how).time
        for turn in (0.0, math.pi)
    )
    return bool((backwards < forwards).all())
