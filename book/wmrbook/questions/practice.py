"""Concept questions on chapters 8 to 10: sampling, sensors, the audit."""

from __future__ import annotations

import math

import numpy as np

import wmrlib as wmr
from wmrbook.questions._asking import Option, cases, numbers, question

_GOAL = wmr.Pose(0.0, 0.0, 0.0)


@question(8, "The goal comes nearer during the step", "Twice as fast near the goal")
def twice_as_fast() -> tuple[str, list[Option], str]:
    gains = wmr.GENTLE_GAINS
    quick = gains._replace(k_rho=2.0 * gains.k_rho, k_alpha=2.0 * gains.k_alpha)
    step, shorter = (wmr.longest_step(tuned, "arc") for tuned in (gains, quick))
    mistaken = {
        "a limit of the clock, not of the gains": step,
        "the step taken to go with the square of the rate": step / 4.0,
        "the step taken to go with the root of the rate": step / math.sqrt(2.0),
        "quicker poles taken to forgive more": 2.0 * step,
    }
    ask = f"""A robot settles with steps up to {step:.2f} s. Now $k_\\rho$ and $k_\\alpha$ are
        doubled, so that all goes twice as fast near the goal. What is the longest step?"""
    why = "Only step times rate counts: the same loop on a clock that runs twice as fast."
    return ask, numbers(shorter, mistaken, "{:.2f} s"), why


@question(8, "Wheels that can't go faster", "Too fast for the wheels")
def one_factor() -> tuple[str, list[Option], str]:
    v, omega, width, most = 2.0, 4.0, 0.5, 1.5
    limited = wmr.limit_wheels(v, omega, wmr.Wheels(track_width=width, max_speed=most))
    left, right = (min(speed, most) for speed in (v - omega * width / 2.0, v + omega * width / 2.0))
    half = most / (v + omega * width / 2.0)

    def twist(forward: float, turning: float) -> tuple[str, str]:
        return f"{forward:.4g} m/s, {turning:.4g} rad/s"

    mistakes = {
        twist(half * v, half * omega): "",
        twist((left + right) / 2.0, (right - left) / width): "each wheel clipped by itself",
        twist(most, omega): "$v$ clipped, $\\omega$ kept",
        twist(most, omega * most / v): "scaled by $v$ alone",
        twist(most - omega * width / 2.0, omega): "$\\omega$ kept, $v$ from what is left",
    }
    ask = """The law asks for 2 m/s and 4 rad/s. The wheels, 0.5 m apart, change speed at once,
        and reach 1.5 m/s. $v$ and $\\omega$ are scaled by one factor. What does the robot do?"""
    why = """The faster wheel should do 3 m/s, twice its limit. Half of both keeps the curvature,
        and with it the path; but not of wheels that take time to change speed."""
    options = {answer: (answer, mistake) for answer, mistake in mistakes.items()}
    return ask, cases(twist(*limited), options), why


def _park(goal: wmr.Pose, off_m: float) -> wmr.Pose:
    """Where a robot really parks that sees itself `off_m` too far east."""
    pose, dt = wmr.Pose(-12.0, -6.0, 0.5), 0.1
    for _ in range(600):
        error = wmr.polar_error(pose._replace(x=pose.x + off_m), goal)
        if error.rho < 0.02:
            break
        pose = wmr.advance(pose, *wmr.control_law(*error, wmr.GENTLE_GAINS), dt)
    return pose


@question(9, "An error that lasts", "Two metres off, all the way")
def constant_offset() -> tuple[str, list[Option], str]:
    end = _park(_GOAL, 2.0)
    computed = round(end.x), round(end.y), abs(end.heading) < math.radians(10.0)
    ask = """During the whole drive the receiver shows each position 2 m too far east; the
        compass is exact. Where does the robot park, with gains that park it otherwise?"""
    options = {
        (-2, 0, True): ("2 m west, heading right", ""),
        (2, 0, True): ("2 m east, heading right", "the error's sign taken over"),
        (0, 0, True): ("on the goal, heading right", "feedback taken to remove every error"),
        (0, 0, False): (
            "on the goal, heading wrong",
            "feedback taken to remove the error, and the heading to pay for it",
        ),
        (-2, 0, False): ("2 m west, heading wrong", "an offset taken for noise"),
    }
    why = """It parks where it believes the goal to be. Nothing in the loop sees a constant
        error, and no gain removes it."""
    return ask, cases(computed, options), why


@question(9, "Exercise 9.3: A compass that is off", "A compass that is off")
def crooked_compass() -> tuple[str, list[Option], str]:
    gains, delta = wmr.Gains(0.2, 2.0, 2.0, 4.0), math.radians(4.0)
    turning = [wmr.control_law(1e-9, -delta, theta, gains)[1] for theta in (0.0, 1.0)]
    rest = math.degrees(turning[0] / (turning[0] - turning[1]))  # omega is linear in theta
    lam, delta_deg = gains.k_rho * gains.v_max, math.degrees(delta)
    mistaken = {
        "feedback taken to remove it": 0.0,
        "the error taken to be passed on as it is": delta_deg,
        "$h$ taken to divide it, nothing else": delta_deg / gains.h,
        "the turning line of sight forgotten": delta_deg * gains.k_alpha / (gains.h * lam),
    }
    ask = """The compass reads 4 deg too much, the position is exact. With $v_{\\max} k_\\rho$
        0.8 and $k_\\alpha$ 2 per s, $h$ 2, the robot finds the place. How far off is its
        heading?"""
    why = """Driving straight in, it believes $\\alpha$ is -4 deg. Only a $\\theta$ that cancels
        this in $\\omega$ lets it rest: $4(2 + 0.8)/(2 \\cdot 0.8)$ deg."""
    return ask, numbers(rest, mistaken, "{:.1f} deg"), why


@question(10, "One factor too many", "The law as printed")
def as_printed() -> tuple[str, list[Option], str]:
    gains, rho, alpha = wmr.paper.OUTDOOR_GAINS, 1e-9, 1e-4
    twist = wmr.control_law(rho, alpha, 0.0, gains, "printed")
    rate = wmr.polar_rate(rho, alpha, *twist)[1] / alpha
    lam = gains.k_rho * gains.v_max
    mistaken = {
        "the corrected law's rate": -gains.k_alpha,
        "the line of sight turned the wrong way": -lam - gains.k_alpha,
        "the steering forgotten": lam,
        "a sign lost": gains.k_alpha - lam,
    }
    ask = f"""Near its goal a robot drives at {lam:.0f} times its distance a second, and turns at
        {gains.k_alpha:.0f} rad/s for each rad of $\\alpha$, which is small. What is
        $\\dot\\alpha/\\alpha$?"""
    why = """The line of sight runs away at 8 per s, and the steering takes back 1: $\\alpha$
        grows. So does (24) as printed: the factor too many switches the rest off."""
    return ask, numbers(rate, mistaken, "{:.0f} per s"), why


@question(10, "Decide: parked, or not?", "Is it parked?")
def is_it_parked() -> tuple[str, list[Option], str]:
    outcomes = {}
    for axis in ("east", "north"):
        case = wmr.paper.outdoor(axis)
        fine = {"method": "continuous", "dt": 0.05, "arrival_radius": 0.02}
        run = wmr.simulate(case.start, case.goal, case.gains, **fine)
        for radius in (0.025, 0.05, 0.1):
            error = abs(math.degrees(np.interp(radius, run.rho[::-1], run.heading_error[::-1])))
            for most in (2.5, 5.0, 10.0):
                outcomes[axis, radius, most] = error <= most
    east, north = (
        {value for (axis, *_), value in outcomes.items() if axis == name}
        for name in ("east", "north")
    )
    computed = "open"
    for verdict, holds in (("holds", True), ("wrong", False)):
        if east | north == {holds}:
            computed = verdict
    if len(east) == len(north) == 1 and east != north:
        computed = "axis"
    ask = """Parked: within 5 cm and 5 deg. An audit halves and doubles both thresholds, and
        tries $x$ east and north, with the gains 2, 1, 0.3, 4 in continuous time. What does it
        report?"""
    options = {
        "open": ("not decided", ""),
        "wrong": ("wrong", "one radius taken for a verdict"),
        "holds": ("it holds", "on the spot is parked"),
        "axis": ("it holds for one of the axes", "one drive taken for the law"),
        "typo": ("a typo in the gains", "a bad result taken for a misprint"),
    }
    why = """The heading swings through zero near 10 cm, so the verdict flips with our
        thresholds. The heading still settles 16 times slower than the distance."""
    return ask, cases(computed, options), why
