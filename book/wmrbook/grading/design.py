"""Checks of gains by design: the angles' matrix, gains from poles, gains for a specification."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from wmrbook.grading._asking import ask, ask_array, ask_numbers, numbers
from wmrbook.grading._hints import (
    close,
    drawn,
    expect,
    explain,
    own_work,
    rule_out,
    slip,
    spread,
)
from wmrbook.grading._specification import Limits, all_parked, drive, driveable, elsewhere, exceeded
from wmrlib import paper
from wmrlib.control import control_law
from wmrlib.gains import Gains
from wmrlib.kinematics import polar_rate
from wmrlib.tuning import modes

_TUNED = Limits(time=19.0, heading_deg=2.0, omega=1.0)


def matrix_known(angle_matrix: Callable) -> str:
    """angle_matrix(rho, k_rho, k_alpha, h, v_max): of (alpha, theta), against differences."""
    own_work(angle_matrix)
    for rho, gains in _cases(20):
        value = ask_array(angle_matrix, (2, 2), rho, *gains)
        if not np.allclose(value, _differences(rho, gains), rtol=1e-5, atol=1e-6):
            _explain_matrix(value, rho, gains)
    return "Twenty matrices agree with small differences of the closed loop itself."


def matrix_goal(angle_matrix: Callable) -> str:
    """At the goal it is the limit, and just before the goal it loses no digits."""
    own_work(angle_matrix)
    for _, gains in _cases(5):
        for rho in (*spread(1e-15, 0.3, 60), 0.0):
            value = ask_array(angle_matrix, (2, 2), rho, *gains)
            if np.allclose(value, _differences(max(rho, 1e-6), gains), rtol=2e-5, atol=1e-6):
                continue
            limit = _angles(gains.k_alpha, gains.h, gains.k_rho * gains.v_max)
            hint = f"at rho = {rho:.2g} m this is the matrix at the goal, which differs by more "
            hint += "than rounding: `rho` has to be smaller for that."
            expect(rho > 0.1 or not np.allclose(value, limit, rtol=1e-9), hint)
            if rho > 1e-6:  # where no digits are lost yet
                _explain_matrix(value, rho, gains)
            question = "which number does v/rho approach at the goal?"
            if rho:
                question = "which function computes 1 - exp(-x) for a small x "
                question += "without losing its digits?"
            expect(False, f"at rho = {rho:.2g} m the matrix is off: {question}")
    poles = modes(paper.OUTDOOR_GAINS).poles[1]
    poles = f"{poles.real:.1f} +- {abs(poles.imag):.2f}i 1/s."
    return f"Finite at the goal, where the paper's gains have the poles {poles}"


def poles_placed(gains_from_poles: Callable) -> str:
    """gains_from_poles(distance_pole, pole_1, pole_2, v_max) -> (k_rho, k_alpha, h)."""
    own_work(gains_from_poles)
    for poles, v_max in _pole_cases(20):
        values = _three_gains(gains_from_poles, *poles, v_max)
        if not np.allclose(_poles(*values, v_max), _sorted(poles), rtol=1e-6, atol=1e-6):
            _explain_gains(values, poles, v_max)
    return "Twenty loops have the poles that were asked for, real and complex."


def poles_properties(gains_from_poles: Callable) -> str:
    """Swapped poles, a faster clock and another v_max change the gains as their units say."""
    own_work(gains_from_poles)
    for poles, v_max in _pole_cases(10):
        gains = np.array(_three_gains(gains_from_poles, *poles, v_max))
        hint = f"poles that settle need positive gains; yours are {gains.round(4).tolist()}."
        expect(bool((gains > 0.0).all()), hint)
        swapped = _three_gains(gains_from_poles, poles[0], poles[2], poles[1], v_max)
        hint = "the order of the two poles of the angles must not count."
        expect(np.allclose(swapped, gains, rtol=1e-9), hint)
        fast = _three_gains(gains_from_poles, *(3.0 * pole for pole in poles), v_max)
        hint = "three times faster poles: look at the units of k_rho (1/m), k_alpha (1/s) "
        hint += "and h (none). Which can change, and by what factor?"
        expect(np.allclose(fast, gains * (3.0, 3.0, 1.0), rtol=1e-9), hint)
        other = _three_gains(gains_from_poles, *poles, 2.0 * v_max)
        hint = "with the poles given, k_alpha and h must not depend on v_max."
        expect(np.allclose(other[1:], gains[1:], rtol=1e-9), hint)
        hint = "twice v_max and the same poles: look at (6.1) for what k_rho must do."
        expect(close(2.0 * other[0], gains[0]), hint)
    return "Swapped, sped up and with another v_max: the gains do what their units say."


def tuned_outdoor(gains: Any) -> str:
    """The outdoor drive keeps the specification: time, heading and turning rate."""
    gains, case = driveable("`gains`", gains), paper.outdoor()
    run, end = drive(case.start, case.goal, gains, method="continuous")
    hint = f"the robot does not arrive: after {run.t[-1]:.0f} s "
    expect(end.arrived, f"{hint}it is {end.distance:.1f} m from the goal.")
    worst, broken = int(np.abs(run.omega).argmax()), exceeded(end, _TUNED)
    if end.peak_omega > _TUNED.omega:
        place = f"{run.t[worst]:.1f} s after the start, {run.rho[worst]:.1f} m before the goal"
        fast = f"|omega| reaches {end.peak_omega:.2f} rad/s ({place})"
        broken.append(f"{fast}, where {_TUNED.omega:g} rad/s is allowed")
    expect(not broken, f"the robot arrives, but {'; and '.join(broken)}.")
    parked = f"Parked after {end.time:.1f} s, {math.degrees(abs(end.heading_error)):.1f} deg off"
    return f"{parked}, with at most {end.peak_omega:.2f} rad/s."


def tuned_elsewhere(gains: Any) -> str:
    """The same gains park the robot from other places and headings too, and from their mirrors."""
    ends = elsewhere(driveable("`gains`", gains), math.pi, duration=60.0)
    return f"{all_parked(ends, 60.0, 2.0 * _TUNED.heading_deg)}."


def _cases(count: int) -> list[tuple[float, Gains]]:
    gains = (0.3, 1.5), (0.5, 4.0), (0.2, 3.0), (1.5, 5.0)
    return [(rho, Gains(*row)) for rho, *row in drawn(71, count, (0.3, 6.0), *gains)]


def _differences(rho: float, gains: Gains) -> np.ndarray:
    """The matrix by central differences of (8) and (9) under the corrected law."""

    def rates(alpha: float, theta: float) -> np.ndarray:
        v, omega = control_law(rho, alpha, theta, gains)
        return np.array(polar_rate(rho, alpha, v, omega)[1:])

    step = 1e-6
    columns = [rates(step, 0.0) - rates(-step, 0.0), rates(0.0, step) - rates(0.0, -step)]
    return np.transpose(columns) / (2.0 * step)


def _explain_matrix(value: np.ndarray, rho: float, gains: Gains) -> None:
    k_rho, k_alpha, h, v_max = gains
    pull = -v_max * math.expm1(-k_rho * rho) / rho
    right, limit = _angles(k_alpha, h, pull), _angles(k_alpha, h, k_rho * v_max)
    (top, cross), (turning, corner) = value.tolist()
    mistakes = {
        "this is the matrix at the goal. At a distance rho, v/rho is less.": limit,
        "rows and columns are swapped: row 1 is the rate of alpha.": right.T,
        "the state is (alpha, theta), in this order.": right[::-1, ::-1],
    }
    rule_out(value, mistakes, np.allclose)
    slip(value, right, "row 1 for alpha, row 2 for theta; column 1 for alpha, column 2 for theta")

    def near(one: float, other: float) -> bool:
        return close(one, other, 1e-5)

    row = "theta's row"
    mistakes = {
        f"{row} has the sign of (10), not that of (8).": -pull,
        f"{row} holds v where (8) has v/rho.": pull * rho,
        f"{row}: what does (22) multiply by?": pull / v_max,
    }
    rule_out(turning, mistakes, near)
    hint = f"{row} is wrong where it meets alpha: linearise (8) with the v of (22)."
    expect(near(turning, pull), hint)
    expect(close(corner, 0.0), f"{row}: does theta itself stand in (8)?")
    row = "alpha's row"
    mistakes = {
        f"{row}: omega holds one more term with alpha than k_alpha alpha.": pull - k_alpha,
        f"{row}: the line of sight turns, too; (9) has two terms.": -pull - k_alpha,
    }
    rule_out(top, mistakes, near)
    hint = f"{row} is wrong in its first column: "
    hint += "put omega into (9) and collect what multiplies alpha."
    expect(near(top, -k_alpha), hint)
    mistakes = {f"{row}: with which sign does omega stand in (9)?": h * pull}
    otherwise = f"{row} is wrong in its second column: what in omega multiplies theta?"
    explain(cross, mistakes, otherwise, near)


def _angles(k_alpha: float, h: float, pull: float) -> np.ndarray:
    return np.array([[-k_alpha, -h * pull], [pull, 0.0]])


def _pole_cases(count: int) -> list[tuple[tuple, float]]:
    bounds, cases = ((-2.0, -0.3), (-4.0, -0.5), (-4.0, -0.5), (1.5, 5.0)), []
    for n, (distance, first, second, v_max) in enumerate(drawn(72, count, *bounds)):
        pair = (first, second) if n % 2 else (complex(first, second), complex(first, -second))
        cases.append(((distance, *pair), v_max))
    return cases


def _poles(k_rho: float, k_alpha: float, h: float, v_max: float) -> np.ndarray:
    return _sorted((-v_max * k_rho, *np.roots([1.0, k_alpha, h * (v_max * k_rho) ** 2])))


def _three_gains(gains_from_poles: Callable, *given: complex) -> tuple[float, ...]:
    """The answer's (k_rho, k_alpha, h), whether alone or as a whole `Gains`."""
    answer = ask(gains_from_poles, *given)
    if isinstance(answer, Gains):
        return numbers("the gains", answer[:3], 3, returned=True)
    several = isinstance(answer, (tuple, list))
    hint = "a gain is complex. The sum and the product of a conjugate pair are real: "
    hint += "take their `.real`."
    expect(not (several and any(isinstance(gain, complex) for gain in answer)), hint)
    return ask_numbers(gains_from_poles, 3, *given)


def _sorted(poles: tuple) -> np.ndarray:
    return np.sort_complex(np.round(np.asarray(poles, dtype=complex), 7))


def _explain_gains(values: tuple, poles: tuple, v_max: float) -> None:
    (k_rho, k_alpha, h), minus = values, poles[0] / v_max
    distance, total, product = poles[0], (poles[1] + poles[2]).real, (poles[1] * poles[2]).real
    mistakes = {
        "k_rho is negative: the distance falls at a rate, its pole is minus that.": minus,
        "k_rho is the rate itself; (6.1) has one more factor.": -distance,
    }
    rule_out(k_rho, mistakes)
    right = minus * -1.0, -total, product / distance**2
    slip(values, right, "(k_rho, k_alpha, h)")
    hint = "k_rho does not put the distance's pole where it is asked for: see (6.1)."
    expect(close(k_rho, -distance / v_max), hint)
    multiply = "multiply (s - p_1)(s - p_2) out, and compare"
    hint = "k_alpha is negative: compare the sign of s in (6.2) with that in (s - p_1)(s - p_2)."
    rule_out(k_alpha, {hint: total})
    expect(close(k_alpha, -total), f"k_alpha is wrong: {multiply} with (6.2).")
    root = math.sqrt(abs(product)) / -distance
    mistakes = {
        "your h is all that (6.2) has without an s; a part of that is the distance's.": product,
        "h is the root of what it should be: see (6.3).": root,
    }
    rule_out(h, mistakes)
    hint = "h is right for a complex pair, but not for two different real poles."
    expect(not any(close(h, abs(pole) ** 2 / distance**2) for pole in poles[1:]), hint)
    expect(False, f"h is wrong: {multiply} what has no s with (6.2).")
