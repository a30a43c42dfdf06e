"""Checks of gains by design: the angles' matrix, gains from poles, and gains for a specification."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from wmrbook.grading._hints import (
    Passed,
    ask,
    ask_array,
    ask_numbers,
    close,
    expect,
    gains_of,
    own_work,
)
from wmrlib import paper
from wmrlib.control import control_law
from wmrlib.gains import Gains
from wmrlib.kinematics import Pose, polar_rate
from wmrlib.metrics import arrival
from wmrlib.simulation import simulate
from wmrlib.sweeping import sweep
from wmrlib.tuning import modes

TIME, HEADING_DEG, OMEGA = 19.0, 2.0, 1.0  # s, deg, rad/s: the specification for the outdoor case
ELSEWHERE_DEG = 4.0


def matrix_known(angle_matrix: Callable) -> Passed:
    """angle_matrix(rho, k_rho, k_alpha, h, v_max): the 2 x 2 matrix of (alpha, theta), against differences of the closed loop."""
    own_work(angle_matrix)
    for rho, gains in _cases(20):
        value, right = ask_array(angle_matrix, (2, 2), rho, *gains), _differences(rho, gains)
        if not np.allclose(value, right, rtol=1e-5, atol=1e-6):
            _explain_matrix(value, rho, gains)
    return Passed("Twenty matrices agree with small differences of the closed loop itself.")


def matrix_goal(angle_matrix: Callable) -> Passed:
    """At the goal it is the limit, and just before the goal it loses no digits."""
    own_work(angle_matrix)
    for _, gains in _cases(5):
        right = _differences(1e-6, gains)
        for rho in (1e-3, 1e-9, 1e-14, 0.0):
            value = ask_array(angle_matrix, (2, 2), rho, *gains)
            near = _differences(rho, gains) if rho > 1e-6 else right
            hint = f"at rho = {rho:g} m the matrix is off: " + (
                "which function computes 1 - exp(-x) for a small x without losing its digits?"
                if rho
                else "which number does v/rho approach at the goal?"
            )
            if not np.allclose(value, near, rtol=2e-5, atol=1e-6):
                if rho == 1e-3:  # where no digits are lost yet
                    _explain_matrix(value, rho, gains)
                expect(False, hint)
    poles = modes(paper.OUTDOOR_GAINS).poles[1]
    return Passed(
        f"Finite at the goal, where the paper's gains have the poles {poles.real:.1f} +- {abs(poles.imag):.2f}i 1/s."
    )


def poles_placed(gains_from_poles: Callable) -> Passed:
    """gains_from_poles(distance_pole, pole_1, pole_2, v_max) -> (k_rho, k_alpha, h): the loop then has these poles."""
    own_work(gains_from_poles)
    for poles, v_max in _pole_cases(20):
        answer = ask(gains_from_poles, *poles, v_max)
        if isinstance(answer, (tuple, list)) and any(isinstance(each, complex) for each in answer):
            expect(
                False,
                "a gain is complex. The sum and the product of a conjugate pair are real: take their `.real`.",
            )
        k_rho, k_alpha, h = values = ask_numbers(gains_from_poles, 3, *poles, v_max)
        found = _poles(k_rho, k_alpha, h, v_max)
        if not np.allclose(found, _sorted(poles), rtol=1e-6, atol=1e-6):
            _explain_gains(values, poles, v_max)
    return Passed("Twenty loops have the poles that were asked for, real and complex.")


def poles_properties(gains_from_poles: Callable) -> Passed:
    """The order of the pair does not count, a faster clock scales the gains as their units say, and v_max only k_rho."""
    own_work(gains_from_poles)
    for poles, v_max in _pole_cases(10):
        gains = np.array(ask_numbers(gains_from_poles, 3, *poles, v_max))
        expect(
            bool((gains > 0.0).all()),
            f"poles that settle need positive gains; yours are {gains.round(4).tolist()}.",
        )
        swapped = ask_numbers(gains_from_poles, 3, poles[0], poles[2], poles[1], v_max)
        expect(
            np.allclose(swapped, gains, rtol=1e-9),
            "the order of the two poles of the angles must not count.",
        )
        fast = ask_numbers(gains_from_poles, 3, *(3.0 * each for each in poles), v_max)
        hint = "three times faster poles: look at the units of k_rho (1/m), k_alpha (1/s) and h (none). Which can change, and by what factor?"
        expect(np.allclose(fast, gains * (3.0, 3.0, 1.0), rtol=1e-9), hint)
        other = ask_numbers(gains_from_poles, 3, *poles, 2.0 * v_max)
        expect(
            np.allclose(other[1:], gains[1:], rtol=1e-9),
            "with the poles given, k_alpha and h must not depend on v_max.",
        )
        expect(
            close(2.0 * other[0], gains[0]),
            "twice v_max and the same poles: look at (7.1) for what k_rho must do.",
        )
    return Passed("Swapped, sped up and with another v_max: the gains do what their units say.")


def tuned_outdoor(gains: Any) -> Passed:
    """The outdoor drive keeps the specification: time, heading and turning rate."""
    gains = _tunable(gains)
    case = paper.outdoor()
    run = simulate(case.start, case.goal, gains, method="continuous")
    end = arrival(run)
    expect(
        end.arrived,
        f"the robot does not arrive: after {run.t[-1]:.0f} s it is {end.distance:.1f} m from the goal.",
    )
    heading = abs(math.degrees(end.heading_error))
    broken = []
    if end.time > TIME:
        broken.append(f"it takes {end.time:.1f} s, where {TIME:g} s are allowed")
    if heading > HEADING_DEG:
        broken.append(
            f"the heading is {heading:.2f} deg off, where {HEADING_DEG:g} deg are allowed"
        )
    if end.peak_omega > OMEGA:
        worst = int(np.abs(run.omega).argmax())
        place = f"{run.t[worst]:.1f} s after the start, {run.rho[worst]:.1f} m before the goal"
        broken.append(
            f"|omega| reaches {end.peak_omega:.2f} rad/s ({place}), where {OMEGA:g} rad/s is allowed"
        )
    expect(not broken, f"the robot arrives, but {'; and '.join(broken)}.")
    return Passed(
        f"Parked after {end.time:.1f} s, {heading:.1f} deg off, with at most {end.peak_omega:.2f} rad/s."
    )


def tuned_elsewhere(gains: Any) -> Passed:
    """The same gains park the robot from other places and headings too, and mirrored starts mirror."""
    gains = _tunable(gains)
    random = np.random.default_rng(7)
    far, sight = random.uniform(20.0, 60.0, 20), random.uniform(-math.pi, math.pi, 20)
    x, y, heading = far * np.cos(sight), far * np.sin(sight), random.uniform(-math.pi, math.pi, 20)
    starts = Pose(
        np.concatenate([x, x]), np.concatenate([y, -y]), np.concatenate([heading, -heading])
    )
    ends = sweep(starts, Pose(0.0, 0.0, 0.0), gains, dt=0.02, duration=60.0, progress=False)
    expect(
        bool(ends.arrived.all()),
        f"of 40 other starts, {np.sum(~ends.arrived)} have not arrived after 60 s.",
    )
    off = np.abs(np.degrees(ends.heading_error))
    bad = np.sum(off > ELSEWHERE_DEG)
    expect(
        bad == 0,
        f"of 40 other starts, {bad} end more than {ELSEWHERE_DEG:g} deg off, the worst {off.max():.0f} deg.",
    )
    return Passed(
        f"40 other starts, 20 and their mirror images: all arrive, the worst {off.max():.1f} deg off."
    )


def _tunable(value: Any) -> Gains:
    gains = gains_of("`gains`", value)
    expect(
        gains.v_max <= paper.OUTDOOR_GAINS.v_max,
        f"v_max is {gains.v_max:g} m/s; this robot can drive 4 m/s at the most.",
    )
    return gains


def _cases(count: int) -> list[tuple[float, Gains]]:
    random = np.random.default_rng(71)
    table = random.uniform(
        (0.3, 0.3, 0.5, 0.2, 1.5), (6.0, 1.5, 4.0, 3.0, 5.0), (count, 5)
    ).tolist()
    return [(row[0], Gains(*row[1:])) for row in table]


def _differences(rho: float, gains: Gains) -> np.ndarray:
    """The matrix by central differences of (8) and (9) under the corrected law."""
    step, columns = 1e-6, []
    for way in ((step, 0.0), (0.0, step)):
        ends = [
            polar_rate(rho, sign * way[0], *control_law(rho, sign * way[0], sign * way[1], gains))
            for sign in (1.0, -1.0)
        ]
        columns.append([(ends[0][row] - ends[1][row]) / (2.0 * step) for row in (1, 2)])
    return np.array(columns).T


def _explain_matrix(value: np.ndarray, rho: float, gains: Gains) -> None:
    k_rho, k_alpha, h, v_max = gains
    pull = -v_max * math.expm1(-k_rho * rho) / rho
    (top, cross), (turning, corner) = value.tolist()
    expect(
        not np.allclose(value, _angles(k_alpha, h, k_rho * v_max)),
        "this is the matrix at the goal. At a distance rho, v/rho is less.",
    )
    expect(
        not np.allclose(value, _angles(k_alpha, h, pull).T),
        "rows and columns are swapped: row 1 is the rate of alpha.",
    )
    expect(
        not np.allclose(value, _angles(k_alpha, h, pull)[::-1, ::-1]),
        "the state is (alpha, theta), in this order.",
    )
    expect(not close(turning, -pull, 1e-5), "theta's row has the sign of (10), not that of (8).")
    expect(not close(turning, pull * rho, 1e-5), "theta's row holds v where (8) has v/rho.")
    expect(not close(turning, pull / v_max, 1e-5), "theta's row: what does (22) multiply by?")
    expect(
        close(turning, pull, 1e-5),
        "theta's row is wrong where it meets alpha: linearise (8) with the v of (22).",
    )
    expect(close(corner, 0.0), "theta's row: does theta itself stand in (8)?")
    expect(
        not close(top, pull - k_alpha, 1e-5),
        "alpha's row: omega holds one more term with alpha than k_alpha alpha.",
    )
    expect(
        not close(top, -pull - k_alpha, 1e-5),
        "alpha's row: the line of sight turns, too; (9) has two terms.",
    )
    expect(
        close(top, -k_alpha, 1e-5),
        "alpha's row is wrong in its first column: put omega into (9) and collect what multiplies alpha.",
    )
    expect(
        not close(cross, h * pull, 1e-5), "alpha's row: with which sign does omega stand in (9)?"
    )
    expect(False, "alpha's row is wrong in its second column: what in omega multiplies theta?")


def _angles(k_alpha: float, h: float, pull: float) -> np.ndarray:
    return np.array([[-k_alpha, -h * pull], [pull, 0.0]])


def _pole_cases(count: int) -> list[tuple[tuple, float]]:
    random, cases = np.random.default_rng(72), []
    for n in range(count):
        distance, first, second, v_max = random.uniform(
            (-2.0, -4.0, -4.0, 1.5), (-0.3, -0.5, -0.5, 5.0)
        ).tolist()
        pair = (first, second) if n % 2 else (complex(first, second), complex(first, -second))
        cases.append(((distance, *pair), v_max))
    return cases


def _poles(k_rho: float, k_alpha: float, h: float, v_max: float) -> np.ndarray:
    return _sorted((-v_max * k_rho, *np.roots([1.0, k_alpha, h * (v_max * k_rho) ** 2])))


def _sorted(poles: tuple) -> np.ndarray:
    return np.sort_complex(np.round(np.asarray(poles, dtype=complex), 7))


def _explain_gains(values: tuple, poles: tuple, v_max: float) -> None:
    k_rho, k_alpha, h = values
    distance, total, product = poles[0], (poles[1] + poles[2]).real, (poles[1] * poles[2]).real
    expect(
        not close(k_rho, distance / v_max),
        "k_rho is negative: the distance falls at a rate, its pole is minus that.",
    )
    expect(not close(k_rho, -distance), "k_rho is the rate itself; (7.1) has one more factor.")
    expect(
        close(k_rho, -distance / v_max),
        "k_rho does not put the distance's pole where it is asked for: see (7.1).",
    )
    expect(
        not close(k_alpha, total),
        "k_alpha is negative: compare the sign of s in (7.2) with that in (s - p_1)(s - p_2).",
    )
    expect(
        close(k_alpha, -total),
        "k_alpha is wrong: multiply (s - p_1)(s - p_2) out, and compare with (7.2).",
    )
    expect(
        not close(h, product),
        "your h is all that (7.2) has without an s; a part of that is the distance's.",
    )
    expect(
        not close(h, math.sqrt(abs(product)) / -distance),
        "h is the root of what it should be: see (7.3).",
    )
    mistaken = [abs(pole) ** 2 / distance**2 for pole in poles[1:]]
    expect(
        not any(close(h, each) for each in mistaken),
        "h is right for a complex pair, but not for two different real poles.",
    )
    expect(
        False, "h is wrong: multiply (s - p_1)(s - p_2) out, and compare what has no s with (7.2)."
    )
