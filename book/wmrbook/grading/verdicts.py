"""Checks of auditing a paper: counterexamples, the rule for a printed number, and how many digits a coordinate needs."""

from __future__ import annotations

import math
from collections.abc import Callable
from decimal import ROUND_DOWN, Decimal
from typing import Any

import numpy as np

from wmrbook.grading._hints import Passed, ask_number, ask_truth, expect, numbers, own_work
from wmrlib import paper
from wmrlib.geodesy import EARTH_RADIUS_M

GAINS = paper.OUTDOOR_GAINS
CLEARLY = 1e-3  # 1/s: what is clearly above zero
FARTHEST = 100.0  # m
DEGREE = math.radians(1.0) * EARTH_RADIUS_M  # of latitude, m


def counterexample_23(state: Any) -> Passed:
    """(rho, alpha, theta, omega): an omega that obeys (23), and with which the second part of (21) is positive all the same."""
    rho, alpha, theta, omega = numbers("`state_23`", state, 4)
    _expect_state(rho, alpha, theta)
    from wmrlib import symbolic as s

    values = _values(s, rho, alpha, theta) | {s.omega: omega}
    speed = float(s.EQUATIONS[22].rhs.subs(values))
    asked = float(s.EQUATIONS[23].gts.subs(values)), float(s.EQUATIONS[23].lts.subs(values))
    expect(
        asked[0] > asked[1],
        f"this omega does not obey (23), which asks for more than {asked[1]:.3g} rad/s: no counterexample yet.",
    )
    second = s.EQUATIONS[21].rhs.coeff(s.L, 0)  # what is not divided by L
    part = float(second.subs(values | {s.v: speed}))
    question = "Which omega does (21) itself ask for, and where is that more than (23) asks for?"
    _expect_positive(part, "(23) is obeyed, but the second part of (21)", question)
    _expect_left(alpha)
    return Passed(
        f"omega = {omega:.3g} rad/s obeys (23), and the second part of (21) is {part:+.3g} 1/s: (23) does not do what it is for."
    )


def counterexample_26(state: Any) -> Passed:
    """(rho, alpha, theta): a state at which the right side of (26), which the paper says is never positive, is positive."""
    rho, alpha, theta = numbers("`state_26`", state, 3)
    _expect_state(rho, alpha, theta)
    expect(abs(alpha) > 1e-6, "(26) divides by A: choose another alpha than 0.")
    from wmrlib import symbolic as s

    value = float(s.EQUATIONS[26].rhs.subs(_values(s, rho, alpha, theta)))
    terms = "Which of its four terms can be positive at all, and which of the others gets small near the goal?"
    _expect_positive(value, "here the right side of (26)", terms)
    _expect_left(alpha)
    return Passed(
        f"Here the right side of (26) is {value:+.3g} 1/s: the last line of the paper's proof is no proof."
    )


def rule_known(agrees: Callable) -> Passed:
    """agrees(computed, printed): chapter 10's rule, for numbers of the paper and of other papers."""
    own_work(agrees)
    for computed, printed in [
        *[
            (57.2654, "57.5"),
            (9.5831, "9.6"),
            (9.5831, "9.58"),
            (57.2654, "57"),
            (9.6684, "8"),
            (9.5831, "9.4"),
            (0.0900, "0.1"),
        ],
        *[
            (58.0758, "58.07"),
            (9.5831, "9.5"),
            (0.193, "0.1"),
            (119.7, "119"),
            (4.9, "4"),
            (-27.17, "-27.1"),
            (-0.193, "-0.1"),
        ],
        *[
            (9.47, "9.4"),
            (9.49, "9.5"),
            (101.4, "101"),
            (101.4, "102"),
            (99.2, "100"),
            (-9.6, "9.6"),
            (0.0004, "0.000"),
        ],
    ]:
        _expect_verdict(agrees, computed, printed)
    for computed, printed in _printed(60):
        _expect_verdict(agrees, computed, printed)
    return Passed(
        "81 numbers, printed, rounded, cut off and wrong: 58.07 m holds, and 9.4 deg does not."
    )


def rule_digits(agrees: Callable) -> Passed:
    """Printed zeros are digits too; and a number and its negative are treated alike."""
    own_work(agrees)
    for computed, printed in (
        (0.0900, "0.10"),
        (2.04, "2.00"),
        (5.96, "6.00"),
        (0.1042, "0.10"),
        (2.004, "2.00"),
        (15.2, "15.0"),
    ):
        _expect_verdict(agrees, computed, printed)
    for computed, printed in _printed(20):
        if Decimal(printed) > 0:
            same = ask_truth(agrees, computed, printed) == ask_truth(
                agrees, -computed, "-" + printed
            )
            expect(
                same,
                f"{computed} and '{printed}' get one verdict, {-computed} and '-{printed}' another.",
            )
    return Passed("0.10 is another claim than 0.1.")


def digits_needed(decimals_needed: Callable) -> Passed:
    """decimals_needed(metres): against rounding many latitudes to so many decimals, and to one fewer."""
    own_work(decimals_needed)
    random = np.random.default_rng(101)
    lats = random.uniform(-80.0, 80.0, 20_000)
    for metres in (0.01, 0.05, 0.1, 0.002, 0.8, 5.0, 6.0, 50.0, 600.0, 7000.0, 60_000.0, 2e6):
        count = ask_number(decimals_needed, metres)
        expect(count == round(count), f"{count:.3f} decimals: a whole number is needed.")
        expect(
            count <= 20, f"for {metres:g} m you want {count:.3g} decimals, more than a float has."
        )
        expect(
            count >= 0,
            f"for {metres:g} m you want {count:.0f} decimals; there are none before the point.",
        )
        moved = [
            float(np.abs(np.round(lats, n) - lats).max()) * DEGREE
            for n in (int(count), int(count) - 1)
        ]
        hint = f"with {count:.0f} decimals a latitude moves by up to {moved[0]:.3g} m, where {metres:g} m are allowed."
        expect(moved[0] <= metres, hint)
        if count:
            hint = f"for {metres:g} m one decimal fewer than your {count:.0f} does: how far does *rounding* move a number at the most?"
            expect(moved[1] > 0.999 * metres, hint)
    return Passed(
        f"The paper's six decimals leave {50 * 1e-6 * DEGREE:.1f} cm; for one centimetre it takes seven."
    )


def _expect_state(rho: float, alpha: float, theta: float) -> None:
    expect(
        0.0 < rho <= FARTHEST,
        f"rho is {rho:g} m; more than 0 and at most {FARTHEST:g} m is needed.",
    )
    for name, angle in (("alpha", alpha), ("theta", theta)):
        expect(
            -math.pi <= angle <= math.pi,
            f"{name} is {angle:g} rad, which is not between -pi and pi. Are these degrees?",
        )


def _expect_positive(value: float, what: str, question: str) -> None:
    """Clearly positive; that a negative one is what the paper claims, and that 0 or a trace is no refutation, is said."""
    expect(value >= 0.0, f"{what} is {value:.3g} 1/s, as the paper says. {question}")
    expect(value > 0.0, f"{what} is 0, not positive. {question}")
    expect(
        value > CLEARLY,
        f"{what} is positive by {value:.2g} 1/s only; more than {CLEARLY:g} 1/s is needed. {question}",
    )


def _expect_left(alpha: float) -> None:
    expect(
        alpha > 0.0,
        "right, but this is chapter 4's side: find a state with alpha > 0, the goal to the left.",
    )


def _values(symbolic, rho: float, alpha: float, theta: float) -> dict:
    state = {symbolic.rho: rho, symbolic.alpha: alpha, symbolic.theta: theta, symbolic.L: 1}
    return state | {getattr(symbolic, name): value for name, value in GAINS._asdict().items()}


def _verdict(computed: Decimal, printed: str) -> tuple[bool, bool, bool]:
    """Whether it rounds to the printed digits; whether these are what is left if it is cut off; whether less than 1 % is lost by that."""
    claim = Decimal(printed)
    unit = Decimal(1).scaleb(claim.as_tuple().exponent)
    loss = abs(computed - claim)
    return (
        loss <= unit / 2,
        computed.quantize(unit, rounding=ROUND_DOWN) == claim,
        loss < abs(computed) / 100,
    )


def _expect_verdict(agrees: Callable, computed: float, printed: str) -> None:
    told = ask_truth(agrees, computed, printed)
    rounds, cuts, close = _verdict(Decimal(repr(computed)), printed)
    holds = rounds or (cuts and close)
    if told == holds:
        return
    place = f"{computed} was computed, '{printed}' is printed, and you say {told}. "
    digits = len(printed.partition(".")[2])
    if holds:
        expect(
            not rounds,
            place
            + f"How many decimals does '{printed}' have, and what is {computed} rounded to as many?",
        )
        expect(
            False,
            place + "It does not round to that, but what if somebody just cut the digits off?",
        )
    expect(not cuts, place + "Cut off it is, but how much is lost by that?")
    zeros = printed.endswith("0") and digits > 0
    expect(not zeros, place + "The zeros at the end are printed digits, too: a float forgets them.")
    expect(
        not (close and not rounds),
        place + "That it is near is not the question: do the printed digits come out?",
    )
    expect(False, place + f"What is {computed} rounded to {digits} decimals?")


def _printed(count: int) -> list[tuple[float, str]]:
    """Numbers and how they might be printed: rounded, cut off, and wrong by one or two in the last digit; none on the edge of the rule."""
    random, found = np.random.default_rng(102), []
    while len(found) < count:
        digits, size = int(random.integers(0, 4)), 10.0 ** random.integers(-1, 3)
        computed = float(f"{random.uniform(1.0, 10.0) * size * random.choice((-1, 1)):.6f}")
        exact, unit = Decimal(repr(computed)), Decimal(1).scaleb(-digits)
        claim = exact.quantize(unit, rounding=ROUND_DOWN) + unit * int(random.integers(-1, 3))
        loss = abs(exact - claim)
        if (
            claim
            and abs(loss / unit - Decimal("0.5")) > Decimal("0.02")
            and not Decimal("0.95") < 100 * loss / abs(exact) < Decimal("1.05")
        ):
            found.append((computed, str(claim)))
    return found
