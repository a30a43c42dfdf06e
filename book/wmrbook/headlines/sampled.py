"""Headlines of chapters 8 and 9: sampling, wheels, receivers, delays."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

import wmrlib as wmr
from wmrbook.headlines import ROUND, SEEDS, Before, headline
from wmrbook.headlines.field import AXES, GAINS, GENTLE, settled_deg
from wmrlib import paper

MATCHED = wmr.gains_for(0.2, natural_frequency=0.6, damping=0.5 / 0.6, v_max=4.0)


def settles(gains, dt, rho, alpha, theta):
    """Whether angles near the goal fade, sampled every dt [s], on arcs."""
    start, goal = wmr.Pose(-rho, 0.0, -alpha), wmr.Pose(0.0, 0.0, -theta)
    run = wmr.simulate(start, goal, gains, dt=dt, arrival_radius=0.0, duration=600 * dt)
    size = np.hypot(run.alpha, run.theta)[run.rho > 1e-290]
    part = size.size // 4
    return size.max() < 0.05 and size[-part:].max() < size[:part].max()


SMALL = {"rho": (1e-5, 1e-2), "alpha": (-1e-3, 1e-3), "theta": (1e-4, 1e-3)}
TEN_TIMES = "With the paper's, ten times faster still costs 12 deg"
STEPS = {"dt": (0.002, 0.01), "arrival_radius": (5e-4, 5e-3)}


@headline("08", "must be sampled every 0.022 s with the paper's gains", **SMALL)
def paper_step(rho, alpha, theta):
    return settles(GAINS, 0.0215, rho, alpha, theta) > settles(GAINS, 0.0225, rho, alpha, theta)


@headline("08", "every 0.71 s with the gentle ones", **SMALL)
def gentle_step(rho, alpha, theta):
    return settles(GENTLE, 0.70, rho, alpha, theta) > settles(GENTLE, 0.73, rho, alpha, theta)


@headline("08", TEN_TIMES, at_least=11.5, at_most=12.5, unit="deg", **STEPS)
def ten_times_faster(dt, arrival_radius):
    off = partial(settled_deg, GAINS, 0.05, dt=dt, arrival_radius=arrival_radius)
    return off(wheels=wmr.Wheels(1.0, lag=1 / 80)) - off()


def stray(way, far, theta, most, limit, dt=0.02):
    """How far a scaled drive with gentle gains strays [m]; a wheel's acceleration [m/s^2]."""
    start, goal = (
        wmr.Pose(0.0, 0.0, 0.0),
        wmr.Pose(far * math.cos(way), far * math.sin(way), way - theta),
    )
    free = wmr.simulate(start, goal, GENTLE, method="continuous", dt=0.005)
    wheels = wmr.Wheels(0.5, limit, acceleration=most)
    run = wmr.simulate(start, goal, GENTLE, dt=dt, wheels=wheels)
    places = zip(run.x[::5], run.y[::5], strict=True)
    return max(np.hypot(free.x - x, free.y - y).min() for x, y in places)


DRIVES = {"way": ROUND, "far": (3.0, 12.0), "theta": (-3.0, 3.0), "limit": (1.5, 4.0)}
# At theta = pi, the seam, a rounding decides on which side the goal is passed.
LOOKS = "Scaling keeps the path and only takes longer: the law looks only at the pose"
SLOWLY = Before(LOOKS, DRIVES | {"most": (0.5, 2.0)}, at_most=0.15)
AT_ONCE = "If the wheels accelerate at once, scaling keeps the path and only takes longer"
STRAYS = "with 1 m/s² a wheel the scaled drives stray about 1.2 and 0.5 m"


@headline("08", AT_ONCE, at_most=0.15, unit="m", most=[math.inf], before=SLOWLY, **DRIVES)
def path_kept(way, far, theta, most, limit):
    return stray(way, far, theta, most, limit)


@headline("08", STRAYS, at_least=0.45, at_most=1.3, unit="m", beside=[True, False], dt=(0.02, 0.05))
def accelerating(beside, dt):
    case = paper.outdoor()
    ten_metres = wmr.PolarError(10.0, math.pi / 2, math.pi / 2)
    far, way, theta = ten_metres if beside else wmr.polar_error(case.start, case.goal)
    return stray(way, far, theta, 1.0, 2.0, dt)


def parks(gains, axis, heading, receiver, **how):
    """A robot's, or many robots', end of the outdoor drive, sampled every 0.1 s."""
    case = paper.outdoor(x_axis=axis)
    how = {"method": "arc", "dt": 0.1, "duration": 120.0, "progress": False} | how
    return wmr.sweep(
        case.start._replace(heading=heading), case.goal, gains, receiver=receiver, **how
    )


SPIRAL = (
    "the gentle gains, in steps of 0.1 s and from this start, already spiral for minutes at 0.6 s"
)
LATE = {"axis": AXES, "heading": (1.4, 1.75)}
IN_120_S = Before("matched position 0 s, heading 0.9 s late: never in 120 s", LATE, at_most=0)
NEVER = "0 s | 0.9 s | never / never | never / 0 deg"


@headline("09", SPIRAL, at_most=0, axis=AXES, heading=(1.1, 1.4), delay=(0.6, 1.5))
def arrives_late(axis, heading, delay, gains=GENTLE):
    receiver = wmr.Receiver(heading_delay=delay)
    return parks(gains, axis, heading, receiver, arrival_radius=0.2).arrived


@headline("09", NEVER, at_most=0, before=IN_120_S, **LATE | {"axis": ["east"]})
def matched_late(axis, heading):
    return arrives_late(axis, heading, 0.9, gains=MATCHED)


RECEIVERS = {"seed": SEEDS, "axis": AXES, "memory": (0.1, 1e4), "period": [0.1, 1.0]}
LESS = "At 0.5 m, with each memory and both rates, the matched gains leave less heading error"
APART = r"the gentle gains park about $\sqrt2\,\sigma$ off (rms)"
LONG = {"seed": SEEDS, "axis": AXES, "memory": (300.0, 1e4), "sigma": (0.5, 1.0)}
RECORDED = "memory 300 s, goal recorded 60 s before: 0.85 sigma off"
BEFORE = "Only a second receiver at rest nearby (differential GPS) or a mark at the goal can"
ONLY = Before(BEFORE, {"seed": SEEDS, "dt": [1.0]}, at_least=math.sqrt(2))
STEP = {"seed": SEEDS, "dt": [1.0, 10.0, 60.0]}


def two_designs(seed, axis, memory, sigma=0.5, period=0.1):
    """Rms place [m] and heading error [rad] of 200 robots: gentle gains, then the matched ones."""
    receiver = wmr.Receiver(np.full(200, sigma), memory, period)
    for gains, radius in ((GENTLE, 0.2), (MATCHED, 2 * sigma)):
        heading = paper.outdoor(x_axis=axis).start.heading
        end = parks(gains, axis, heading, receiver, arrival_radius=radius, seed=seed)
        yield np.sqrt(np.mean(np.square([end.distance, end.heading_error]), axis=-1))


@headline("09", LESS, **RECEIVERS)
def matched_turn_less(seed, axis, memory, period):
    gentle, matched = two_designs(seed, axis, memory, period=period)
    return matched[1] < gentle[1] and matched[0] > gentle[0]


@headline("09", APART, at_least=1.2, at_most=1.65, unit="sigma", **LONG)
def root_two(seed, axis, memory, sigma):
    return next(two_designs(seed, axis, memory, sigma))[0] / sigma


TURNS = "A last turn beats every design that does without: it leaves the heading to the compass"
PATIENCE = "through white noise of 1 m at 1 Hz, a fifth of the robots see no fix within 0.2 m"
TURN = {"last_turn": wmr.LastTurn(leave=math.inf), "duration": 900.0, "arrival_radius": 0.2}


@headline("09", TURNS, **RECEIVERS | {"sigma": (0.3, 1.0), "h": [0.0, 2.0]})
def turned_at_last(seed, axis, memory, period, sigma, h):
    heading = paper.outdoor(x_axis=axis).start.heading
    receiver, gains = wmr.Receiver(np.full(200, sigma), memory, period), GENTLE._replace(h=h)
    end = parks(gains, axis, heading, receiver, seed=seed, **TURN)
    _, matched = two_designs(seed, axis, memory, sigma, period)
    place = np.sqrt(np.mean(end.distance**2))
    return end.arrived.all() and np.abs(end.heading_error).max() < 0.02 and place < matched[0]


@headline("09", PATIENCE, at_least=0.15, at_most=0.28, seed=SEEDS, axis=AXES)
def without_a_fix(seed, axis):
    heading, receiver = paper.outdoor(x_axis=axis).start.heading, wmr.Receiver(np.ones(900), 0, 1.0)
    return (
        1.0 - parks(GENTLE, axis, heading, receiver, seed=seed, arrival_radius=0.2).arrived.mean()
    )


@headline("09", RECORDED, at_least=0.83, at_most=0.87, unit="sigma", before=ONLY, **STEP)
def recorded_goal(seed, dt):
    normal, kept = np.random.default_rng(seed).standard_normal, math.exp(-dt / 300.0)
    now = then = normal((2, 10_000))
    for _ in range(round(60.0 / dt)):
        now = kept * now + math.sqrt(1 - kept**2) * normal(now.shape)
    return math.sqrt(np.mean(np.sum((now - then) ** 2, axis=0)))
