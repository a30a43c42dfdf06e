"""Checks of sampling and wheels: Euler's longest step, a faster wheel, gains for slow sampling."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from wmrbook.grading._asking import ask_number, ask_numbers, gains_of, refuses
from wmrbook.grading._hints import close, drawn, expect, explain, own_work, rule_out, slip
from wmrbook.grading._specification import Limits, all_parked, drive, elsewhere, exceeded
from wmrlib import paper
from wmrlib.tuning import longest_step, modes

_SLOW = Limits(time=42.0, heading_deg=3.0)
_SAMPLING, _TRACK_WIDTH, _TOP_SPEED = 0.25, 0.5, 2.0  # s, m, m/s of a wheel
_MOTOR = (1.0, 9.0), (0.5, 12.0), (2.0, 20.0)  # a, g, times


def step_real(longest_euler_step: Callable) -> str:
    """longest_euler_step(poles): seconds, for systems with real poles only."""
    own_work(longest_euler_step)
    random = np.random.default_rng(81)
    for count in (1, 1, 2, 3, 4):
        _check_step(longest_euler_step, random.uniform(-9.0, -0.2, count).tolist())
    fastest = "Right for real poles: the fastest mode alone sets the step,"
    return f"{fastest} however little of it is left."


def step_complex(longest_euler_step: Callable) -> str:
    """Complex pairs, and systems with both; a pole that does not settle is refused."""
    own_work(longest_euler_step)
    random = np.random.default_rng(82)
    for pairs, singles in ((1, 0), (1, 1), (2, 0), (2, 2), (1, 3)):
        rows = random.uniform((-3.0, 0.3), (-0.2, 6.0), (pairs, 2)).tolist()
        poles = [complex(*row) for row in rows]
        poles += [pole.conjugate() for pole in poles]
        poles += random.uniform(-9.0, -0.2, singles).tolist()
        _check_step(longest_euler_step, poles)
    for unstable in ([1.0], [-1.0, 0.5 + 2j, 0.5 - 2j], [-1.0, 0.0]):
        hint = "one of these modes does not fade by itself, so no step makes it fade."
        refuses(longest_euler_step, hint, unstable)
    gains = paper.OUTDOOR_GAINS
    value = _check_step(longest_euler_step, list(modes(gains).poles))
    same = close(value, longest_step(gains, "polar_euler"), 2e-3)
    expect(same, "the paper's gains come out differently from (8.2).")
    paper_s = f"With the paper's gains: {value:.4f} s in polar coordinates, as by (8.2)."
    return f"Right for complex poles too. {paper_s}"


def wheel_speed(wheel_gains: Callable) -> str:
    """wheel_gains(a, g, times) -> (k_p, k_r): the wheel is `times` times as fast.

    speed' = -a speed + g u, with u = k_r command - k_p speed.
    """
    own_work(wheel_gains)
    for a, g, times in drawn(83, 20, *_MOTOR):
        k_p, k_r = ask_numbers(wheel_gains, 2, a, g, times)
        rate = a + g * k_p
        slip((k_p, k_r), ((times - 1.0) * a / g, times * a / g), "(k_p, k_r)")
        hint = f"with your k_p the closed loop runs away: its pole is at {-rate:+.3g} 1/s."
        expect(rate > 0.0, hint)
        if not close(rate, times * a):
            loop = f"the closed loop is {rate / a:.3g} times as fast"
            own = f"{loop}; the motor's own `a` slows the wheel, too."
            rule_out(rate, {own: (times + 1.0) * a})
            hint = "k_p has units: it turns rad/s into volts. Where is the motor in it?"
            otherwise = f"{loop} as the motor, where {times:.3g} times was asked for."
            explain(k_p, {hint: times}, otherwise)
        final = g * k_r / rate
        if not close(final, 1.0):
            hint = f"with k_r = k_p the wheel settles at {100 * final:.0f} % of what is commanded: "
            hint += "a P controller's usual error."
            otherwise = f"the wheel settles at {final:.4g} times what is commanded: "
            otherwise += "what must u be when the speed is right and constant?"
            explain(k_r, {hint: k_p}, otherwise)
    fast = "Twenty motors: as much faster as was asked for,"
    return f"{fast} and they settle at exactly what is commanded."


def wheel_units(wheel_gains: Callable) -> str:
    """Once as fast needs no feedback, and twice the motor half the gains."""
    own_work(wheel_gains)
    for a, g, times in drawn(83, 5, *_MOTOR):
        k_p, k_r = ask_numbers(wheel_gains, 2, a, g, 1)
        hint = "a loop as fast as the motor itself needs no feedback: k_p must be 0 for times = 1."
        expect(abs(k_p) < 1e-9, hint)
        hint = "for times = 1 only k_r is left: which voltage keeps a constant speed?"
        expect(close(g * k_r, a), hint)
        gains = np.array(ask_numbers(wheel_gains, 2, a, g, times))
        strong = np.array(ask_numbers(wheel_gains, 2, a, 2.0 * g, times))
        hint = "a motor that does twice as much per volt needs half of both gains."
        expect(np.allclose(gains, 2.0 * strong, rtol=1e-9), hint)
    k_p, _ = ask_numbers(wheel_gains, 2, 4.93, 8.0, 10)
    ten = "Chapter 8's motor, ten times faster:"
    return f"{ten} {k_p:.2f} V for each rad/s that is missing."


def slow_outdoor(gains: Any) -> str:
    """The outdoor drive, sampled every 0.25 s, with slow wheels: in time, straight, feasible."""
    gains, case = gains_of("`gains`", gains), paper.outdoor()
    run, end = drive(case.start, case.goal, gains, dt=_SAMPLING)
    rim, broken = _rim(run), []
    if (most := rim.max()) > _TOP_SPEED:
        when = int((rim > _TOP_SPEED).argmax())
        turning = abs(run.omega[when]) * _TRACK_WIDTH / 2.0
        broken.append(
            f"{run.t[when]:.2f} s after the start a wheel is asked for {rim[when]:.2f} m/s "
            f"({turning:.2f} m/s of it for turning), and in all for up to {most:.2f} m/s, "
            f"where it has {_TOP_SPEED:g} m/s"
        )
    late = f"it has not arrived after {run.t[-1]:.0f} s, and is {end.distance:.1f} m from the goal"
    broken += exceeded(end, _SLOW) if end.arrived else [late]
    hint = "; and ".join(broken)
    if (longest := longest_step(gains)) < _SAMPLING:
        hint += f" (near the goal these gains have to be sampled every {longest:.3f} s, "
        hint += f"and are every {_SAMPLING:g} s)"
    expect(not broken, f"{hint}.")
    parked = f"Parked after {end.time:.1f} s, {math.degrees(abs(end.heading_error)):.1f} deg off"
    return f"{parked}, and no wheel was asked for more than {most:.2f} m/s."


def slow_elsewhere(gains: Any) -> str:
    """The same from 40 other starts that face at most 60 deg beside the goal."""
    options = {"method": "arc", "dt": _SAMPLING, "duration": 80.0, "trajectories": True}
    ends, runs = elsewhere(gains_of("`gains`", gains), math.pi / 3.0, **options)
    parked = all_parked(ends, 80.0, 2.0 * _SLOW.heading_deg)
    rim = np.nan_to_num(_rim(runs)).max(axis=1)
    bad = np.sum(rim > _TOP_SPEED)
    hint = f"of 40 other starts, {bad} ask a wheel for more than {_TOP_SPEED:g} m/s, "
    expect(bad == 0, f"{hint}the worst for {rim.max():.2f} m/s.")
    return f"{parked}, with at most {rim.max():.2f} m/s at a wheel."


def _rim(run: Any) -> np.ndarray:
    """The speed of the faster wheel."""
    return np.abs(run.v) + 0.5 * _TRACK_WIDTH * np.abs(run.omega)


def _check_step(longest_euler_step: Callable, poles: Sequence[complex]) -> float:
    """Return the answer if 0.999 times it lets every mode fade and 1.001 times it does not."""
    value, table = ask_number(longest_euler_step, list(poles)), np.array(poles, dtype=complex)
    hint = f"a step of {value:.4g} s: a step must be positive; "
    expect(value > 0.0, f"{hint}mind the signs of the real parts.")
    size = np.abs(table)
    steps = -2.0 * table.real / size**2
    if not close(value, steps.min()):
        one = close(value, steps.max()) and not close(value, 1.0 / size.max())
        expect(not one, "this step is the longest for one mode; all modes have to fade.")
        real = "this is right for real poles. "
        real += "With a complex pole s, when is the *size* of 1 + dt s less than 1?"
        mistakes = {
            "a mode at -1/dt is gone after one step. "
            "It may overshoot, though: how far, before it grows?": 1.0 / size.max(),
            "this is the step of the mode with the largest pole alone. "
            "One that is slower, but swings, may need a shorter one.": steps[size.argmax()],
            real: 2.0 / size.max(),
        }
        rule_out(value, mistakes)
        rule_out(value, {real: 2.0 / np.abs(table.real).max()})
        slip(value, steps.min(), within=0.0)
    with np.errstate(over="ignore"):
        growth = np.abs(1.0 + 0.999 * value * table)
    worst = int(growth.argmax())
    swing = f"{table[worst].imag:+.3g}i" if table[worst].imag else ""
    mode = f"the mode at {table[worst].real:.3g}{swing} 1/s grows by {growth[worst]:.5g}"
    expect(growth[worst] < 1.0, f"with a slightly shorter step than yours {mode} in each step.")
    hint = "with a slightly longer step than yours all modes still fade: it is not the longest."
    expect(np.abs(1.0 + 1.001 * value * table).max() > 1.0, hint)
    return value
