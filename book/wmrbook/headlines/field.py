"""Headlines of chapters 7 and 6: the circle, gains."""

from __future__ import annotations

import math
from functools import cache

import numpy as np

import wmrlib as wmr
from wmrbook.headlines import ROUND, SEEDS, Before, headline
from wmrlib import paper

CIRCLE, SPEED = paper.CIRCLE_GAINS, paper.CIRCLE_SPEED
GAINS, GENTLE = paper.OUTDOOR_GAINS, wmr.GENTLE_GAINS
AXES, AT = ["east", "north"], wmr.Pose(0.0, 0.0, 0.0)


def off_goal(far: float, aim: float, turned: float) -> wmr.Pose:
    """A start that is far [m] from the circle's first goal, turned [deg] from its heading."""
    heading = math.pi / 2 + math.radians(turned)
    return wmr.Pose(far * math.cos(aim), far * math.sin(aim), heading)


WHATEVER = (
    r"whatever $h$, $k_\alpha$ and the start, as long as the steering brings $\alpha$ near zero"
)
SETS = {"turned": (-180.0, 180.0), "h": (0.005, 0.5), "k_alpha": (1.0, 5.0), "v_max": (1.5, 8.0)}
STARTS = {"far": (0.1, 5.0), "aim": ROUND}
ROUNDED = "Everything from 2.5 to 6.9 m/s rounds to 0.1 m"


@headline("07", WHATEVER, at_most=0.004, unit="m", **STARTS, **SETS)
def residual_off(far, aim, turned, h, k_alpha, v_max):
    gains = CIRCLE._replace(h=h, k_alpha=k_alpha, v_max=v_max)
    run = wmr.track(paper.circle, off_goal(far, aim, turned), gains, dt=0.02, duration=40.0)
    off = abs(run.rho[-1] + math.log(1 - SPEED / v_max) / gains.k_rho)
    return off if abs(run.alpha[-1]) < 0.1 else 0.0  # some back after the goal, at an angle


@headline("07", ROUNDED, at_least=0.05, at_most=0.15, unit="m", v_max=(2.54, 6.9), **STARTS)
def tenth_of_a_metre(v_max, far, aim):
    gains, start = CIRCLE._replace(v_max=v_max), off_goal(far, aim, 0.0)
    return wmr.residual(wmr.track(paper.circle, start, gains, duration=40.0))


def rms_distances(law: str, seed: int, limit: float, most: float, start: wmr.Pose) -> float:
    """The smallest rms distance of 40 sets of gains that turn at most so fast [rad/s]."""
    kind, low, high = wmr.Gains, [0.3, 0.3, 0.01, 0.8], [8.0, 8.0, 3.0, 4.0]
    if law == "kanayama":
        kind, low, high = wmr.KanayamaGains, [0.3, 0.3, 0.3], [8.0, 20.0, 8.0]
    drawn = np.exp(np.random.default_rng(seed).uniform(np.log(low), np.log(high), (40, len(low))))
    best, how = math.inf, {"law": law, "wheels": wmr.Wheels(0.4, limit), "duration": 40.0}
    for gains in drawn:
        run = wmr.track(paper.circle, start, kind(*gains), **how)
        if np.abs(run.omega).max() <= most:
            best = min(best, math.sqrt(np.mean(run.rho**2)))
    return best


LIMITS = {"limit": (1.0, 2.8), "most": (2.0, 6.0), "seed": SEEDS, "aim": ROUND}
ANYWHERE = LIMITS | {"far": (0.05, 5.0), "turned": (-180.0, 180.0)}
FIRST = Before("Feed-forward comes first up to 6 rad/s", ANYWHERE, at_least=1.0)
NEARBY = "Within half a metre of the goal and 60 deg of its heading, feed-forward comes first"
NEAR = LIMITS | {"far": (0.05, 0.5), "turned": (-60.0, 60.0)}


@headline("07", NEARBY, at_least=1.0, before=FIRST, **NEAR)
def feed_forward_first(far, turned, limit, most, seed, aim):
    given = seed, limit, most, off_goal(far, aim, turned)
    others = min(rms_distances(law, *given) for law in ("corrected", "aicardi"))
    return others / rms_distances("kanayama", *given)


SHARP = CIRCLE._replace(k_rho=-math.log(1 - SPEED / 4.0) / 0.01)


def ahead(t: np.ndarray) -> wmr.Reference:
    return wmr.Reference(SPEED * t, 0 * t, 0 * t, SPEED + 0 * t, 0 * t)


OFF = {"off": (-3e-4, 3e-4)}
BELOW_29 = Before("A step must stay below twice that, 29 ms", OFF, at_most=29.5)
BELOW = "so it shrinks below 34.7 ms"


@headline("07", BELOW, at_least=34.5, at_most=34.8, unit="ms", before=BELOW_29, **OFF)
def longest_step_behind(off):
    low, high = 0.02, 0.05
    for _ in range(9):
        dt = 0.5 * (low + high)
        start = wmr.Pose(-0.01 + off, 0.0, 0.0)
        run = wmr.track(ahead, start, SHARP, dt=dt, duration=400 * dt)
        low, high = (dt, high) if abs(run.rho[-1] - 0.01) < abs(off) else (low, dt)
    return 1000.0 * low


@headline(
    "07",
    "A micrometre aside, the steering fails first, between 30 and 31 ms",
    straight=[True, False],
    aside=(1e-7, 1e-5),
)
def steering_fails_first(straight, aside):
    goal = ahead if straight else paper.circle
    start = wmr.Pose(*((-0.01, aside) if straight else (-aside, -0.01)), 0 if straight else 1.57)
    ends = [wmr.track(goal, start, SHARP, dt=ms / 1e3, duration=60.0).rho[-300:] for ms in (30, 31)]
    calm, shaking = (np.abs(rho - 0.01).max() < 1e-4 for rho in ends)
    return calm and not shaking


LEFT = {"at_least": 0.0595, "at_most": 0.0610}
TOLD = "with $k_x = 1$ 1/s, a speed announced 10 % too low leaves 0.060 m"
TRUTH = "if it is told the truth: a speed announced 10 % too low leaves 0.060 m"
GAIN_1 = {"k_x": [1.0], "far": (0.05, 3.0), "aim": ROUND}
ANY_GAIN = Before(TRUTH, GAIN_1 | {"k_x": (0.5, 4.0)}, **LEFT)


@headline("07", TOLD, unit="m", before=ANY_GAIN, **LEFT, **GAIN_1)
def told_too_little(k_x, far, aim):
    def announced(t):
        return (goal := paper.circle(t))._replace(v=0.9 * goal.v)

    gains, how = wmr.KanayamaGains(k_x, 2.0, 2.0), {"law": "kanayama", "dt": 0.02, "duration": 60.0}
    run = wmr.track(announced, off_goal(far, aim, 0.0), gains, **how)
    return run.rho[-1] * math.cos(run.alpha[-1])


NONE = Before("12 of the 640 beat the paper's gains at 5 cm and none", {"axis": AXES}, 12)
BEAT = "12 of the 640 beat the paper's gains at 5 cm with $x$ east, 2 with $x$ north"


@headline("06", BEAT, at_least=2, at_most=12, axis=AXES, before=NONE)
@cache
def beaten(axis):
    case, plain = paper.outdoor(x_axis=axis), {"arrival_radius": 0.05, "progress": False}
    ranges = {"k_rho": (0.1, 2, 10), "k_alpha": (0.5, 8, 8), "h": (0.1, 10, 8)}
    over = {name: np.geomspace(*ends) for name, ends in ranges.items()}
    many = wmr.gain_map(case.start, case.goal, GAINS, over, **plain)
    own = wmr.sweep(case.start, case.goal, GAINS, **plain)
    better = np.abs(many.heading_error) <= abs(own.heading_error)
    return (better & (many.time <= own.time) & (many.peak_omega <= own.peak_omega)).sum()


POSITIVE = {"k_rho": (0.05, 5.0), "k_alpha": (0.05, 20.0), "h": (0.01, 20.0), "v_max": (0.2, 8.0)}
NO_FASTER = r"with $k_\alpha = 1$ no $h$ settles it faster than 0.5 per second"
FROM_THERE = "For the paper's gains that is 60 deg, from 30 cm on as from 1 cm on"
WITHIN_1 = (
    r"with $v_{\max} = 4$ m/s and $\lambda = 0.8$ 1/s, $m = 2$ settles within 1 deg from 5 cm on"
)
WAYS = {"axis": AXES, "radius": (0.01, 0.05), "heading": (0.5, 2.5)}


@headline("06", r"it does exactly when $2 < k_\alpha/\lambda < 1 + h$", **POSITIVE)
def heading_first(k_rho, k_alpha, h, v_max):
    slower = wmr.modes(wmr.Gains(k_rho, k_alpha, h, v_max)).slower
    return (2 < k_alpha / (v_max * k_rho) < 1 + h) == (slower < 1)


SAME_PATH = "any gains that agree in both drive the same path from the same scaled start"
SCALED = {"distance": (0.5, 20.0), "alpha": ROUND, "theta": ROUND, "kappa": (0.3, 6.0)}
SCALES = {"h": (0.1, 6.0), "k_rho": (0.1, 5.0), "v_max": (0.2, 8.0)}


@headline("06", SAME_PATH, at_most=1e-6, **SCALED, **SCALES)
def scaled_apart(distance, alpha, theta, kappa, h, k_rho, v_max):
    ends = []
    for size, speed in ((1.0, 1.0), (1 / k_rho, v_max)):
        error, time = wmr.PolarError(distance * size, alpha, theta), size / speed
        start, gains = wmr.pose_from_polar(error, AT), wmr.Gains(1 / size, kappa / time, h, speed)
        how = {"duration": 500 * time, "dt": 0.05 * time, "arrival_radius": 0.01 * size}
        end = wmr.arrival(wmr.simulate(start, AT, gains, method="continuous", **how))
        ends.append([end.path_length / size, end.time / time, end.peak_omega * time])
    return np.abs(np.divide(*ends) - 1).max()


@headline("06", r"$h = \kappa^2/4$, enters it at $\kappa = 2$ only", kappa=(0.01, 20.0))
def enters_at_two(kappa):
    at = wmr.modes(wmr.Gains(1.0, kappa, kappa**2 / 4, 1.0))
    return math.isclose(at.damping, 1.0) and (at.slower < 1) == (kappa > 2)


@headline("06", NO_FASTER, at_most=0.5 + 1e-9, unit="1/s", **POSITIVE | {"k_alpha": [1.0]})
def no_h_is_faster(k_rho, k_alpha, h, v_max):
    return wmr.modes(wmr.Gains(k_rho, k_alpha, h, v_max)).heading_rate


def settled_deg(gains, radius, case=None, **how):
    """The largest heading error [deg] from the radius on, down to a millimetre."""
    case = case or paper.outdoor()
    how = {"method": "continuous", "dt": 0.005, "arrival_radius": 1e-3, "duration": 120.0} | how
    run = wmr.simulate(case.start, case.goal, gains, **how)
    return np.degrees(np.abs(run.theta - run.alpha)[run.rho <= radius].max())


@headline(
    "06", FROM_THERE, at_least=59.0, at_most=60.5, unit="deg", radius=(0.01, 0.3), dt=(0.002, 0.01)
)
def sixty_degrees(radius, dt):
    return settled_deg(GAINS, radius, dt=dt)


@headline("06", WITHIN_1, at_most=1.0, unit="deg", **WAYS)
def twice_as_fast(axis, radius, heading):
    case = paper.outdoor(x_axis=axis)
    case = case._replace(start=case.start._replace(heading=heading))
    return settled_deg(wmr.gains_for(0.8, heading_rate=1.6, damping=1.0), radius, case)
