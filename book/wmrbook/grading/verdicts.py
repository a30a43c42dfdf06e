"""Checks of auditing a paper: counterexamples, printed numbers, and a coordinate's digits."""

from __future__ import annotations

import math
from collections.abc import Callable
from decimal import ROUND_DOWN, Decimal
from functools import cache
from typing import Any

import numpy as np

from wmrbook.grading._asking import ask_number, ask_truth, numbers
from wmrbook.grading._hints import expect, own_work, spread
from wmrlib import paper
from wmrlib.geodesy import EARTH_RADIUS_M

CLEARLY = 1e-3  # 1/s: what is clearly above zero
FARTHEST = 100.0  # m
DEGREE = math.radians(1.0) * EARTH_RADIUS_M  # of latitude, m
_PRINTED = (  # numbers that were computed, and how they are printed: rounded, cut off, wrong
    *((57.2654, "57.5"), (9.5831, "9.6"), (9.5831, "9.58"), (57.2654, "57"), (9.6684, "8")),
    *((9.5831, "9.4"), (0.0900, "0.1"), (58.0758, "58.07"), (9.5831, "9.5"), (0.193, "0.1")),
    *((119.7, "119"), (4.9, "4"), (-27.17, "-27.1"), (-0.193, "-0.1"), (9.47, "9.4")),
    *((9.49, "9.5"), (101.4, "101"), (101.4, "102"), (99.2, "100"), (-9.6, "9.6")),
    *((0.0004, "0.000"), (4.1e-05, "0.00004"), (4.1e-05, "0.00007")),
)
_ZEROS = (
    *((0.0900, "0.10"), (2.04, "2.00"), (5.96, "6.00"), (0.1042, "0.10"), (2.004, "2.00")),
    (15.2, "15.0"),
)


def counterexample_23(state: Any) -> str:
    """(rho, alpha, theta, omega) that obeys (23), and where (21)'s second part is positive."""
    rho, alpha, theta, omega = numbers("`state_23`", state, 4)
    _expect_state(rho, alpha, theta)
    from wmrbook.equations import EQUATIONS
    from wmrlib import symbolic as s

    values = _values(s, rho, alpha, theta) | {s.omega: omega}
    speed = float(EQUATIONS[22].rhs.subs(values))
    steering = EQUATIONS[23]
    given, least = (float(side.subs(values)) for side in (steering.gts, steering.lts))
    hint = f"this omega does not obey (23), which asks for more than {least:.3g} rad/s: "
    expect(given > least, f"{hint}no counterexample yet.")
    second = EQUATIONS[21].rhs.coeff(s.L, 0)  # what is not divided by L
    part = float(second.subs(values | {s.v: speed}))
    question = "Which omega does (21) itself ask for, and where is that more than (23) asks for?"
    _expect_positive(part, "(23) is obeyed, but the second part of (21)", question)
    _expect_left(alpha)
    obeyed = f"omega = {omega:.3g} rad/s obeys (23), and the second part of (21) is {part:+.3g} 1/s"
    return f"{obeyed}: (23) does not do what it is for."


def counterexample_26(state: Any) -> str:
    """(rho, alpha, theta) where the right side of (26) is positive, which the paper denies."""
    rho, alpha, theta = numbers("`state_26`", state, 3)
    _expect_state(rho, alpha, theta)
    expect(abs(alpha) > 1e-6, "(26) divides by A: choose another alpha than 0.")
    from wmrbook.equations import EQUATIONS
    from wmrlib import symbolic as s

    value = float(EQUATIONS[26].rhs.subs(_values(s, rho, alpha, theta)))
    terms = "Which of its four terms can be positive at all, "
    terms += "and which of the others gets small near the goal?"
    _expect_positive(value, "here the right side of (26)", terms)
    _expect_left(alpha)
    here = f"Here the right side of (26) is {value:+.3g} 1/s"
    return f"{here}: the last line of the paper's proof is no proof."


def rule_known(agrees: Callable) -> str:
    """agrees(computed, printed): chapter 10's rule, for numbers of this paper and others."""
    own_work(agrees)
    for computed, printed in (*_PRINTED, *_printed(60)):
        _expect_verdict(agrees, computed, printed)
    numbers = f"{len(_PRINTED) + 60} numbers, printed, rounded, cut off and wrong"
    return f"{numbers}: 58.07 m holds, and 9.4 deg does not."


def rule_digits(agrees: Callable) -> str:
    """Printed zeros are digits too; and a number and its negative are treated alike."""
    own_work(agrees)
    for computed, printed in _ZEROS:
        _expect_verdict(agrees, computed, printed)
    for computed, printed in _printed(20):
        if Decimal(printed) > 0:
            verdict = ask_truth(agrees, computed, printed)
            hint = f"{computed} and '{printed}' get one verdict, "
            hint += f"{-computed} and '-{printed}' another."
            expect(verdict == ask_truth(agrees, -computed, f"-{printed}"), hint)
    return "0.10 is another claim than 0.1."


def digits_needed(decimals_needed: Callable) -> str:
    """decimals_needed(metres): against rounding latitudes to so many decimals, and one fewer."""
    own_work(decimals_needed)
    lats = np.random.default_rng(101).uniform(-80.0, 80.0, 20_000)
    off = cache(lambda n: float(np.abs(np.round(lats, n) - lats).max()) * DEGREE)
    edges = [0.5 * DEGREE * 10.0**-n * side for n in range(6) for side in (0.9995, 1.0005)]
    for metres in (0.01, 5.0, 6.0, 2e6, *edges, *spread(1e-3, 1e5, 30)):
        count = ask_number(decimals_needed, metres)
        expect(count == round(count), f"{count:.3f} decimals: a whole number is needed.")
        hint = f"for {metres:.4g} m you want {count:.3g} decimals"
        expect(count <= 20, f"{hint}, more than a float has.")
        expect(count >= 0, f"{hint}; there are none before the point.")
        moved, coarser = off(int(count)), off(int(count) - 1)
        hint = f"with {count:.0f} decimals a latitude moves by up to {moved:.3g} m, "
        expect(moved <= metres, f"{hint}where {metres:.4g} m are allowed.")
        hint = f"for {metres:.4g} m one decimal fewer than your {count:.0f} does: "
        hint += "how far does *rounding* move a number at the most?"
        expect(not count or coarser > 0.999 * metres, hint)
    six = f"The paper's six decimals leave {50 * 1e-6 * DEGREE:.1f} cm"
    return f"{six}; for one centimetre it takes seven."


def _expect_state(rho: float, alpha: float, theta: float) -> None:
    hint = f"rho is {rho:g} m; more than 0 and at most {FARTHEST:g} m is needed."
    expect(0.0 < rho <= FARTHEST, hint)
    for name, angle in (("alpha", alpha), ("theta", theta)):
        hint = f"{name} is {angle:g} rad, which is not between -pi and pi. Are these degrees?"
        expect(-math.pi <= angle <= math.pi, hint)


def _expect_positive(value: float, what: str, question: str) -> None:
    """Raise Hint unless the value is clearly positive; 0 or a trace refutes nothing."""
    expect(value >= 0.0, f"{what} is {value:.3g} 1/s, as the paper says. {question}")
    expect(value > 0.0, f"{what} is 0, not positive. {question}")
    trace = f"{what} is positive by {value:.2g} 1/s only; more than {CLEARLY:g} 1/s is needed."
    expect(value > CLEARLY, f"{trace} {question}")


def _expect_left(alpha: float) -> None:
    hint = "right, but this is chapter 10's side: "
    expect(alpha > 0.0, f"{hint}find a state with alpha > 0, the goal to the left.")


def _values(symbolic, rho: float, alpha: float, theta: float) -> dict:
    state = {symbolic.rho: rho, symbolic.alpha: alpha, symbolic.theta: theta, symbolic.L: 1}
    gains = paper.OUTDOOR_GAINS._asdict()
    return state | {getattr(symbolic, name): value for name, value in gains.items()}


def _verdict(computed: Decimal, printed: str) -> tuple[bool, bool, bool]:
    """Whether it rounds to the digits, is cut off to them, and then loses less than 1 %."""
    claim = Decimal(printed)
    unit = Decimal(1).scaleb(claim.as_tuple().exponent)
    loss, cut = abs(computed - claim), computed.quantize(unit, rounding=ROUND_DOWN)
    return loss <= unit / 2, cut == claim, loss < abs(computed) / 100


def _expect_verdict(agrees: Callable, computed: float, printed: str) -> None:
    verdict = ask_truth(agrees, computed, printed)
    rounds, cuts, near = _verdict(Decimal(repr(computed)), printed)
    holds = rounds or (cuts and near)
    if verdict == holds:
        return
    digits = len(printed.partition(".")[2])
    if rounds:
        hint = f"How many decimals does '{printed}' have, "
        hint += f"and what is {computed} rounded to as many?"
    elif holds:
        hint = "It does not round to that, but what if somebody just cut the digits off?"
    elif cuts:
        hint = "Cut off it is, but how much is lost by that?"
    elif printed.endswith("0") and digits > 0:
        hint = "The zeros at the end are printed digits, too: a float forgets them."
    elif near:
        hint = "That it is near is not the question: do the printed digits come out?"
    else:
        hint = f"What is {computed} rounded to {digits} decimals?"
    expect(False, f"{computed} was computed, '{printed}' is printed, and you say {verdict}. {hint}")


def _printed(count: int) -> list[tuple[float, str]]:
    """Numbers as they may be printed: rounded, cut off or wrong, none on the rule's edge."""
    random, pairs = np.random.default_rng(102), []
    while len(pairs) < count:
        digits, size = int(random.integers(0, 4)), 10.0 ** random.integers(-1, 3)
        computed = float(f"{random.uniform(1.0, 10.0) * size * random.choice((-1, 1)):.6f}")
        exact, unit = Decimal(repr(computed)), Decimal(1).scaleb(-digits)
        claim = exact.quantize(unit, rounding=ROUND_DOWN) + unit * int(random.integers(-1, 3))
        loss = abs(exact - claim)
        half = abs(loss / unit - Decimal("0.5")) <= Decimal("0.02")
        if claim and not half and not Decimal("0.95") < 100 * loss / abs(exact) < Decimal("1.05"):
            pairs.append((computed, str(claim)))
    return pairs
