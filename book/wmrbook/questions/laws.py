"""Concept questions on chapters 4 to 7 and 15: the proof, the drive, the gains, the circle."""

from __future__ import annotations

import math

import numpy as np

import wmrlib as wmr
from wmrbook.questions._asking import Option, cases, numbers, question, sign


@question(4, "Where could it get stuck?", "V stands still. And now?")
def level_spot() -> tuple[str, list[Option], str]:
    gains, rho, theta = wmr.GENTLE_GAINS, 1e-9, math.radians(60.0)
    here = wmr.polar_rate(rho, 0.0, *wmr.control_law(rho, 0.0, theta, gains))
    alpha = 1e-3 * here[1]  # a millisecond later
    later = wmr.lyapunov_rate(rho, alpha, theta, gains)
    computed = sign(here[1], 0.1), sign(here[2], 1e-6), sign(later, 1e-9)
    ask = """The robot is practically on its goal and looks straight at it, so $\\alpha = 0$ and
        $\\dot V = 0$. But $\\theta$ is 60 deg. It drives by the corrected law, with $h > 0$. What
        happens next?"""
    options = {
        (-1, 0, -1): ("$\\alpha$ changes, then $V$ falls again", ""),
        (0, 0, 0): ("nothing: the robot stays so", "$\\dot V = 0$ taken for rest"),
        (0, -1, -1): ("$\\theta$ falls, $\\alpha$ stays 0", "$h$ taken to act on $\\theta$ itself"),
        (1, 0, 1): ("$\\alpha$ changes, and $V$ rises", "$\\dot V$ taken to change its sign at 0"),
        (0, 1, 1): ("$\\theta$ grows, and $V$ with it", "the robot taken to leave its goal"),
    }
    why = """The state can't stay where $\\dot V = 0$: $\\dot\\alpha$ is not zero there while
        $\\theta$ is not. This is LaSalle's step."""
    return ask, cases(computed, options), why


@question(
    15, "We proved it. Brockett says impossible. Who is right?", "A millimetre beside the goal"
)
def millimetre_beside() -> tuple[str, list[Option], str]:
    place, runs = {"method": "continuous", "arrival_radius": 1e-8}, []
    for gains in (wmr.GENTLE_GAINS, wmr.paper.OUTDOOR_GAINS, wmr.paper.CIRCLE_GAINS):
        beside = wmr.Pose(0.0, -1e-3, 0.0)
        runs.append(wmr.simulate(beside, wmr.Pose(0.0, 0.0, 0.0), gains, **place))
    most = math.degrees(min(np.abs(run.heading_error).max() for run in runs))
    limits = (
        (1.0, 10.0, 45.0, 90.0, math.inf) if all(wmr.arrival(run).arrived for run in runs) else ()
    )
    computed = next((limit for limit in limits if most <= limit), None)
    ask = """A robot stands 1 mm beside its goal, abreast of it, with exactly the right heading.
        How far off does its heading get on the way (corrected law, any gains)?"""
    options = {
        math.inf: ("more than 90 deg", ""),
        90.0: ("45 to 90 deg", "a turn to the line of sight, no further"),
        45.0: ("10 to 45 deg", "a small curve is enough"),
        10.0: ("1 to 10 deg", "small start, small swing"),
        1.0: ("less than 1 deg", "stable in polar coordinates, so stable in the plane"),
    }
    why = """However near, it sees both angles at 90 deg; while $\\alpha$ falls to 0, $\\theta$
        rises further. Attractive, not stable."""
    return ask, cases(computed, options), why


@question(5, "On what does a sentence depend?", "Sampled ten times a second")
def tenth_of_a_second() -> tuple[str, list[Option], str]:
    case = wmr.paper.outdoor()

    def off_deg(**options: object) -> float:
        run = wmr.simulate(case.start, case.goal, case.gains, **options)
        end = wmr.arrival(run)
        return abs(math.degrees(end.heading_error)) if end.arrived else math.nan

    smooth, sampled = off_deg(method="continuous"), off_deg(method="arc", dt=0.1)
    ratio = sampled / smooth
    computed = next((limit for limit in (0.5, 0.9, 1.1, 2.0, math.inf) if ratio <= limit), None)
    too_long = 0.1 / wmr.longest_step(case.gains, "arc")
    ask = f"""The paper's drive ($x$ east, $k_\\rho$ 2, $k_\\alpha$ 1, $h$ 0.3, $v_{{\\max}}$ 4)
        is {smooth:.0f} deg off at 5 cm in continuous time. How far off with commands held for
        0.1 s?"""
    options = {
        math.inf: ("more than twice as far", ""),
        2.0: ("a little further", "a longer step is only a little less accurate"),
        1.1: ("as far, within 10 %", "0.1 s taken for short"),
        0.9: ("a little less", "holding a command taken to smooth it"),
        0.5: ("less than half as far", "holding a command taken for damping"),
    }
    why = f"""At the end it turns at some 4 rad/s, and so by tens of degrees between two looks.
        Chapter 8 computes that this step is {too_long:.1f} times too long for these gains."""
    return ask, cases(computed, options), why


@question(5, "Which drive do they speak of?", "In the mirror")
def mirror() -> tuple[str, list[Option], str]:
    alpha, theta, gains = 0.7, -1.1, wmr.paper.OUTDOOR_GAINS
    v, omega = wmr.control_law(3.0, alpha, theta, gains)
    mirrored_v, mirrored_omega = wmr.control_law(3.0, -alpha, -theta, gains)

    def change(now: float, then: float) -> int:
        return 1 if math.isclose(now, then) else -1 if math.isclose(now, -then) else 0

    ask = """Start and goal are reflected in the $x$ axis. What do $v$ and $\\omega$ become,
        under the corrected law?"""
    options = {
        (1, -1): ("$v$ stays, $\\omega$ changes its sign", ""),
        (1, 1): ("both stay", "the law taken not to know left from right"),
        (-1, -1): ("both change their signs", "the mirror taken to turn everything round"),
        (-1, 1): ("$v$ changes its sign, $\\omega$ stays", "a mirror taken for a reverse gear"),
        (1, 0): (
            "$v$ stays, $\\omega$ changes its size",
            "$\\alpha + h\\theta$ taken to be larger there",
        ),
    }
    why = """Both angles change their signs. $v$ is even in them, $\\omega$ odd: the drive is
        mirrored."""
    return ask, cases((change(v, mirrored_v), change(omega, mirrored_omega)), options), why


@question(7, "Why it stays behind", "How far behind?")
def how_far_behind() -> tuple[str, list[Option], str]:
    speed, gains, low, high = 1.0, wmr.Gains(1.0, 1.0, 0.3, 2.0), 0.0, 50.0
    for _ in range(60):  # the distance at which the law commands this speed
        middle = 0.5 * (low + high)
        slow = wmr.control_law(middle, 0.0, 0.0, gains)[0] < speed
        low, high = (middle, high) if slow else (low, middle)
    k_rho, v_max = gains.k_rho, gains.v_max
    mistaken = {
        "feedback taken to leave nothing": 0.0,
        "the law taken for proportional": speed / (v_max * k_rho),
        "$v_{\\max}$ taken for no part of the gain": speed / k_rho,
        "log10 taken for the natural logarithm": -math.log10(1.0 - speed / v_max) / k_rho,
    }
    ask = """A goal drives straight on at 1 m/s. A robot follows it with $v = v_{\\max}(1 -
        e^{-k_\\rho\\rho})\\cos\\alpha$, $v_{\\max}$ 2 m/s, $k_\\rho$ 1 per metre. How far behind
        does it stay?"""
    why = """To keep up it must stay where the law commands 1 m/s: $e^{-k_\\rho\\rho}$ is one
        half, $\\rho = \\ln 2$."""
    return ask, numbers(low, mistaken, "{:.2f} m"), why


@question(7, "What the gap depends on", "Which gain brings it nearer?")
def nearer() -> tuple[str, list[Option], str]:
    gains = wmr.paper.CIRCLE_GAINS
    changes = {
        "none": {},
        "k_rho": {"k_rho": 2.0 * gains.k_rho},
        "k_alpha": {"k_alpha": 2.0 * gains.k_alpha},
        "h": {"h": 2.0 * gains.h},
        "v_max": {"v_max": 0.5 * gains.v_max},
        "all": {"k_alpha": 2.0 * gains.k_alpha, "h": 4.0 * gains.h},
    }
    left = {
        name: wmr.residual(
            wmr.track(wmr.paper.circle, wmr.paper.CIRCLE_START, gains._replace(**change), dt=0.02)
        )
        for name, change in changes.items()
    }
    near = [name for name in left if abs(left[name] / left["none"] - 0.5) < 0.05]
    ask = f"""A robot follows a goal round a circle at {wmr.paper.CIRCLE_SPEED:.2f} m/s,
        {100.0 * left["none"]:.0f} cm behind. The further off its goal, the faster it drives.
        Which change halves the distance?"""
    options = {
        "k_rho": ("$k_\\rho$ doubled", ""),
        "k_alpha": ("$k_\\alpha$ doubled", "quicker steering taken to catch up"),
        "h": ("$h$ doubled", "weight on the heading taken for weight on the place"),
        "v_max": ("$v_{\\max}$ halved", "a calmer robot taken for a closer one"),
        "all": (
            "$k_\\alpha$ doubled, $h$ four times as large",
            "stiffer steering taken to catch up",
        ),
    }
    why = """It keeps the distance at which its law commands the goal's speed: only $k_\\rho$,
        here doubled, and $v_{\\max}$ matter, and less $v_{\\max}$ lengthens it."""
    return ask, cases(near[0] if len(near) == 1 else None, options), why


@question(6, "How fast do the two settle?", "One gain against the swing")
def damping() -> tuple[str, list[Option], str]:
    gains = wmr.paper.OUTDOOR_GAINS
    changes = {
        ("k_alpha", 2.0): ("$k_\\alpha$ doubled", ""),
        ("h", 2.0): ("$h$ doubled", "more weight on the heading taken for damping"),
        ("k_rho", 2.0): ("$k_\\rho$ doubled", "a quicker robot taken for a calmer one"),
        ("h", 0.5): ("$h$ halved", "the root over $h$ overlooked"),
        ("v_max", 0.75): ("$v_{\\max}$ a quarter less", "the driver's remedy: slow down a little"),
    }
    before = wmr.modes(gains).damping
    ratios = {
        (name, factor): wmr.modes(gains._replace(**{name: factor * getattr(gains, name)})).damping
        for name, factor in changes
    }
    best = max(ratios, key=ratios.get)
    softer, slower = (100.0 * (ratios[it] / before - 1.0) for it in (("h", 0.5), ("v_max", 0.75)))
    ask = f"""With the paper's gains the heading swings near the goal, at a damping ratio of
        {before:.2f}. Which one of these changes raises the ratio most?"""
    why = f"""The ratio is $k_\\alpha/(2 v_{{\\max}} k_\\rho\\sqrt h)$: doubling $k_\\alpha$
        doubles it, halving $h$ raises it by {softer:.0f} %, less $v_{{\\max}}$ by {slower:.0f}
        %."""
    return ask, cases(best, changes), why


@question(6, "What can each gain do?", "More steering still")
def more_steering() -> tuple[str, list[Option], str]:
    critical = wmr.gains_for(1.0, natural_frequency=1.0)
    strong = critical._replace(k_alpha=4.0 * critical.k_alpha)
    before, after = (wmr.modes(gains).heading_rate for gains in (critical, strong))
    mistaken = {
        "more gain, more speed": 4.0,
        "a rate taken to grow with the root of the gain": 2.0,
        "only $h$ taken to count": 1.0,
        "the damping ratio taken for a time": 0.25,
    }
    ask = """Near the goal the heading is critically damped: it just does not swing. Now
        $k_\\alpha$ is made four times as large, nothing else. How many times as fast does it
        settle?"""
    why = """Beyond critical damping one pole comes back towards zero: the robot aims at the goal
        so hard that its heading waits."""
    return ask, numbers(after / before, mistaken, "{:.2f}"), why
