"""Checks of sampling and wheels: the longest step of Euler, a faster wheel, and gains for slow looks and slow wheels."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from wmrbook.grading._hints import (
    Passed,
    ask_number,
    ask_numbers,
    close,
    expect,
    gains_of,
    own_work,
    refuses,
)
from wmrlib import paper
from wmrlib.kinematics import Pose
from wmrlib.metrics import arrival
from wmrlib.simulation import simulate
from wmrlib.sweeping import sweep
from wmrlib.tuning import longest_step, modes

LOOK, TIME, HEADING_DEG = 0.25, 42.0, 3.0  # s, s, deg: the specification of the slow robot
TRACK_WIDTH, TOP_SPEED = 0.5, 2.0  # m, m/s at the rim


def step_real(longest_euler_step: Callable) -> Passed:
    """longest_euler_step(poles): seconds, for systems with real poles only."""
    own_work(longest_euler_step)
    random = np.random.default_rng(81)
    for count in (1, 1, 2, 3, 4):
        _check_step(longest_euler_step, random.uniform(-9.0, -0.2, count).tolist())
    return Passed(
        "Right for real poles: the fastest mode alone sets the step, however little of it is left."
    )


def step_complex(longest_euler_step: Callable) -> Passed:
    """Complex pairs, and systems with both; a pole that does not settle by itself is refused."""
    own_work(longest_euler_step)
    random = np.random.default_rng(82)
    for pairs, singles in ((1, 0), (1, 1), (2, 0), (2, 2), (1, 3)):
        found = [
            complex(*pair) for pair in random.uniform((-3.0, 0.3), (-0.2, 6.0), (pairs, 2)).tolist()
        ]
        _check_step(
            longest_euler_step,
            [
                *found,
                *(each.conjugate() for each in found),
                *random.uniform(-9.0, -0.2, singles).tolist(),
            ],
        )
    for unstable in ([1.0], [-1.0, 0.5 + 2j, 0.5 - 2j], [-1.0, 0.0]):
        refuses(
            longest_euler_step,
            "one of these modes does not fade by itself, so no step makes it fade.",
            unstable,
        )
    poles = list(modes(paper.OUTDOOR_GAINS).poles)
    value = _check_step(longest_euler_step, poles)
    expect(
        close(value, longest_step(paper.OUTDOOR_GAINS, "polar_euler"), 2e-3),
        "the paper's gains come out differently from (8.2).",
    )
    return Passed(
        f"Right for complex poles too. With the paper's gains: {value:.4f} s in polar coordinates, as by (8.2)."
    )


def wheel_speed(wheel_gains: Callable) -> Passed:
    """wheel_gains(a, g, times) -> (k_p, k_r): speed' = -a speed + g u with u = k_r command - k_p speed is `times` times as fast."""
    own_work(wheel_gains)
    for a, g, times in _motors(20):
        k_p, k_r = ask_numbers(wheel_gains, 2, a, g, times)
        rate = a + g * k_p
        expect(
            rate > 0.0, f"with your k_p the closed loop runs away: its pole is at {-rate:+.3g} 1/s."
        )
        if not close(rate, times * a):
            expect(
                not close(rate, (times + 1.0) * a),
                f"the closed loop is {rate / a:.3g} times as fast; the motor's own `a` slows the wheel, too.",
            )
            expect(
                not close(g * k_p, times * g),
                "k_p has units: it turns rad/s into volts. Where is the motor in it?",
            )
            expect(
                False,
                f"the closed loop is {rate / a:.3g} times as fast as the motor, where {times:.3g} times was asked for.",
            )
        final = g * k_r / rate
        if not close(final, 1.0):
            expect(
                not close(k_r, k_p),
                f"with k_r = k_p the wheel settles at {100 * final:.0f} % of what is commanded: a P controller's usual error.",
            )
            expect(
                False,
                f"the wheel settles at {final:.4g} times what is commanded: what must u be when the speed is right and constant?",
            )
    return Passed(
        "Twenty motors: as much faster as was asked for, and they settle at exactly what is commanded."
    )


def wheel_units(wheel_gains: Callable) -> Passed:
    """Once as fast needs no feedback, and twice the motor half the gains."""
    own_work(wheel_gains)
    for a, g, times in _motors(5):
        k_p, k_r = ask_numbers(wheel_gains, 2, a, g, 1)
        expect(
            abs(k_p) < 1e-9,
            "a loop as fast as the motor itself needs no feedback: k_p must be 0 for times = 1.",
        )
        expect(
            close(g * k_r, a),
            "for times = 1 only k_r is left: which voltage keeps a constant speed?",
        )
        gains, halved = (
            np.array(ask_numbers(wheel_gains, 2, a, each, times)) for each in (g, 2.0 * g)
        )
        expect(
            np.allclose(gains, 2.0 * halved, rtol=1e-9),
            "a motor that does twice as much per volt needs half of both gains.",
        )
    k_p, _ = ask_numbers(wheel_gains, 2, 4.93, 8.0, 10)
    return Passed(
        f"Chapter 8's motor, ten times faster: {k_p:.2f} V for each rad/s that is missing."
    )


def slow_outdoor(gains: Any) -> Passed:
    """The outdoor drive with a look every 0.25 s and wheels of 2 m/s: in time, straight, and nothing asked that the wheels have not."""
    gains = gains_of("`gains`", gains)
    case = paper.outdoor()
    run = simulate(case.start, case.goal, gains, dt=LOOK)
    end, rim = arrival(run), _rim(run.v, run.omega)
    broken = []
    if (most := rim.max()) > TOP_SPEED:
        when = int((rim > TOP_SPEED).argmax())
        turning = abs(run.omega[when]) * TRACK_WIDTH / 2.0
        broken.append(
            f"{run.t[when]:.2f} s after the start a wheel is asked for {rim[when]:.2f} m/s ({turning:.2f} m/s of it for turning), and "
            f"in all for up to {most:.2f} m/s, where it has {TOP_SPEED:g} m/s"
        )
    heading = abs(math.degrees(end.heading_error))
    if not end.arrived:
        broken.append(
            f"it has not arrived after {run.t[-1]:.0f} s, and is {end.distance:.1f} m from the goal"
        )
    else:
        if end.time > TIME:
            broken.append(f"it takes {end.time:.1f} s, where {TIME:g} s are allowed")
        if heading > HEADING_DEG:
            broken.append(
                f"the heading is {heading:.2f} deg off, where {HEADING_DEG:g} deg are allowed"
            )
    hint = "; and ".join(broken)
    if (longest := longest_step(gains)) < LOOK:
        hint += f" (near the goal these gains want a look every {longest:.3f} s, and get one every {LOOK:g} s)"
    expect(not broken, f"{hint}.")
    return Passed(
        f"Parked after {end.time:.1f} s, {heading:.1f} deg off, and no wheel was asked for more than {most:.2f} m/s."
    )


def slow_elsewhere(gains: Any) -> Passed:
    """The same from 40 other starts that look at most 60 deg beside the goal."""
    gains = gains_of("`gains`", gains)
    random = np.random.default_rng(8)
    far, sight = random.uniform(20.0, 60.0, 20), random.uniform(-math.pi, math.pi, 20)
    x, y, heading = (
        -far * np.cos(sight),
        -far * np.sin(sight),
        sight + random.uniform(-math.pi / 3.0, math.pi / 3.0, 20),
    )
    starts = Pose(
        np.concatenate([x, x]), np.concatenate([y, -y]), np.concatenate([heading, -heading])
    )
    options = {"dt": LOOK, "duration": 80.0, "trajectories": True, "progress": False}
    ends, runs = sweep(starts, Pose(0.0, 0.0, 0.0), gains, **options)
    expect(
        bool(ends.arrived.all()),
        f"of 40 other starts, {np.sum(~ends.arrived)} have not arrived after 80 s.",
    )
    rim = np.nan_to_num(_rim(runs.v, runs.omega)).max(axis=1)
    bad = np.sum(rim > TOP_SPEED)
    expect(
        bad == 0,
        f"of 40 other starts, {bad} ask a wheel for more than {TOP_SPEED:g} m/s, the worst for {rim.max():.2f} m/s.",
    )
    off = np.abs(np.degrees(ends.heading_error))
    bad = np.sum(off > 2.0 * HEADING_DEG)
    expect(
        bad == 0,
        f"of 40 other starts, {bad} end more than {2 * HEADING_DEG:g} deg off, the worst {off.max():.0f} deg.",
    )
    return Passed(
        f"40 other starts, 20 and their mirror images: at most {rim.max():.2f} m/s at a wheel and {off.max():.1f} deg off."
    )


def _rim(v: np.ndarray, omega: np.ndarray) -> np.ndarray:
    """The speed of the faster wheel."""
    return np.abs(v) + 0.5 * TRACK_WIDTH * np.abs(omega)


def _check_step(longest_euler_step: Callable, poles: Sequence[complex]) -> float:
    """The answer, where 0.999 times it lets every mode fade and 1.001 times it one of them grow; a Hint otherwise."""
    value, table = ask_number(longest_euler_step, list(poles)), np.array(poles, dtype=complex)
    expect(
        value > 0.0,
        f"a step of {value:.4g} s: a step must be positive; mind the signs of the real parts.",
    )
    each = -2.0 * table.real / np.abs(table) ** 2
    if not close(value, each.min()):
        size = np.abs(table)
        expect(
            not close(value, each.max()) or close(value, 1.0 / size.max()),
            "this step is the longest for one mode; all modes have to fade.",
        )
        expect(
            not close(value, 1.0 / size.max()),
            "a mode at -1/dt is gone after one step. It may overshoot, though: how far, before it grows?",
        )
        hint = "this is the step of the mode with the largest pole alone. One that is slower, but swings, may need a shorter one."
        expect(not close(value, each[size.argmax()]), hint)
        hint = "this is right for real poles. With a complex pole s, when is the *size* of 1 + dt s less than 1?"
        expect(
            not any(close(value, 2.0 / most) for most in (size.max(), np.abs(table.real).max())),
            hint,
        )
    with np.errstate(over="ignore"):
        growth = np.abs(1.0 + 0.999 * value * table)
    worst = int(growth.argmax())
    place = f"{table[worst].real:.3g}" + (f"{table[worst].imag:+.3g}i" if table[worst].imag else "")
    expect(
        growth[worst] < 1.0,
        f"with a slightly shorter step than yours the mode at {place} 1/s grows by {growth[worst]:.5g} in each step.",
    )
    expect(
        np.abs(1.0 + 1.001 * value * table).max() > 1.0,
        "with a slightly longer step than yours all modes still fade: it is not the longest.",
    )
    return value


def _motors(count: int) -> list[tuple[float, float, float]]:
    return [
        tuple(row)
        for row in np.random.default_rng(83)
        .uniform((1.0, 0.5, 2.0), (9.0, 12.0, 20.0), (count, 3))
        .tolist()
    ]
