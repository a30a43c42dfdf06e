"""Checks of a Lyapunov proof: the rate of V along the model, the steering that makes it negative, and a state where it is not.

The assignment's V is a bowl without a seam, `BOWL`: it has 1 - cos(alpha) where the paper has alpha^2/2, so that full turns don't count.
"""

from __future__ import annotations

import math
from typing import Any

import sympy as sp

from wmrbook.equations import EQUATIONS
from wmrbook.grading._expressions import expression, points, same, values
from wmrbook.grading._hints import Hint, Passed, expect, number, ordered
from wmrlib.paper import OUTDOOR_GAINS
from wmrlib.symbolic import (
    L,
    alpha,
    h,
    k_alpha,
    k_rho,
    lyapunov_rate,
    omega,
    rho,
    textbook,
    theta,
    v,
    v_max,
)

BOWL = rho**2 / (2 * L) + (1 - sp.cos(alpha)) + h * (1 - sp.cos(theta))
_MODEL = {each: EQUATIONS[number].rhs for each, number in ((rho, 7), (alpha, 9), (theta, 8))}
_RATE = sum(BOWL.diff(each) * rate for each, rate in _MODEL.items())
_WANTED = -rho * v * sp.cos(alpha) / L - k_alpha * sp.sin(alpha) ** 2
(_TURNING,) = (sp.expand(each) for each in sp.solve(_RATE - _WANTED, omega))
_CLOSED = _WANTED.subs(v, EQUATIONS[22].rhs)
_SYMBOLS = (rho, alpha, theta, v, omega, h, L, k_alpha, k_rho, v_max)
_POINTS = points(_SYMBOLS)


def rate(V_rate: Any) -> Passed:
    """V' of the bowl along (7) to (9), in rho, alpha, theta, v, omega, h and L."""
    value = expression("V_rate", V_rate, (rho, alpha, theta, v, omega, h, L))
    if not same(value, _RATE, _POINTS):
        expect(
            not same(value, EQUATIONS[20].rhs, _POINTS),
            "this is (20), of the paper's V; here the angles stand in cosines.",
        )
        angles, right_angles = (sp.expand(each).subs(L, sp.oo) for each in (value, _RATE))
        expect(
            not same(angles, -right_angles, _POINTS),
            "the angles' terms have the wrong sign: what is the derivative of 1 - cos?",
        )
        by_h, right_by_h = value.diff(h), _RATE.diff(h)
        expect(
            not same(by_h, -right_by_h, _POINTS),
            "the term with h has the wrong sign: (8) and the third row of (10) contradict each other.",
        )
        expect(
            same(value.diff(L), _RATE.diff(L), _POINTS),
            "the term with L is wrong: differentiate rho^2/(2 L), and put (7) in.",
        )
        expect(
            same(by_h, right_by_h, _POINTS),
            "the term with h is wrong: differentiate h (1 - cos(theta)), and put (8) in.",
        )
        expect(
            False,
            "the terms without h and L are wrong: differentiate 1 - cos(alpha), and put (9) in.",
        )
    return Passed("V' is right along the model, for whatever the wheels do.")


def steering(turning: Any) -> Passed:
    """The omega with which V' is -rho v cos(alpha)/L - k_alpha sin^2(alpha), whatever v is."""
    value = expression("turning", turning, (rho, alpha, theta, v, h, k_alpha))
    if not same(value, _TURNING, _POINTS):
        by_k, right_by_k = value.diff(k_alpha), _TURNING.diff(k_alpha)
        expect(
            not same(value, _papers_turning(), _POINTS),
            "this is the law for the paper's V; with this V something of it does not cancel.",
        )
        expect(
            not same(by_k, -right_by_k, _POINTS),
            "the term with k_alpha makes V rise: look at the sign of omega in your V'.",
        )
        cancelling, right = value.subs(k_alpha, 0), _TURNING.subs(k_alpha, 0)
        expect(
            not same(cancelling, -right, _POINTS),
            "the terms with v double what they should cancel: a sign.",
        )
        expect(
            not same(value.diff(h), -_TURNING.diff(h), _POINTS),
            "the term with h doubles what it should cancel: a sign.",
        )
        expect(
            not same(cancelling, right * sp.cos(alpha), _POINTS),
            "a cosine too many: v stands for the whole speed, cosine and all.",
        )
        twice = right * sp.cos(alpha) * sp.sin(alpha)
        expect(
            not same(cancelling, twice, _POINTS),
            "this has the factor that the paper's (24) has twice: something does not cancel.",
        )
        expect(
            same(cancelling, right, _POINTS),
            "with k_alpha = 0 the second bracket of V' must vanish, and yours does not.",
        )
        expect(
            False,
            "everything cancels but what the term with k_alpha leaves: which function of alpha, times the one in V', is wanted?",
        )
    return Passed("V' is what was asked for, at any speed.")


def steering_usable(turning: Any) -> Passed:
    """It is finite with the goal straight ahead, and mirrored states turn the other way."""
    value = expression("turning", turning, _SYMBOLS)
    expect(
        value.has(alpha) and value.has(theta),
        "a steering that does not see both angles can't park.",
    )
    mirror = {alpha: -alpha, theta: -theta}
    expect(
        same(value.subs(mirror, simultaneous=True), -value, _POINTS),
        "in the mirror (alpha and theta negative) omega must be the opposite.",
    )
    ahead = [point | {alpha: sp.Integer(0)} for point in _POINTS]
    try:
        values("turning", value, ahead)
    except Hint:
        raise Hint(
            "with the goal straight ahead, alpha = 0, a computer gets 0/0 from this form of omega: cancel first."
        ) from None
    return Passed(
        "Mirrored states turn the other way, and nothing is divided by zero at alpha = 0."
    )


def closed(V_rate_closed: Any) -> Passed:
    """V' with the steering and (22): right, and every one of its terms never positive."""
    held = getattr(V_rate_closed, "free_symbols", set())
    expect(
        theta not in held and h not in held,
        "theta and h still stand there: with the right omega they cancel.",
    )
    value = expression("V_rate_closed", V_rate_closed, (rho, alpha, L, k_alpha, k_rho, v_max))
    if not same(value, _CLOSED, _POINTS):
        expect(not same(value, -_CLOSED, _POINTS), "the signs are turned round: this V would rise.")
        first, right = value.subs(k_alpha, 0), _CLOSED.subs(k_alpha, 0)
        expect(
            not same(first, right / sp.cos(alpha), _POINTS),
            "a cosine is missing: V' has one, and the v of (22) brings another.",
        )
        expect(
            same(first, right, _POINTS), "the first bracket is wrong: put the v of (22) into it."
        )
        expect(
            False, "the second bracket is wrong: what is left of it is what you asked for in 4.2."
        )
    for term in sp.Add.make_args(value):
        expect(
            all(each <= 0 for each in values("V_rate_closed", term, _POINTS)),
            "right, but the sign can't be read off: one of the terms is positive by itself. Factor it, so that each term shows its sign.",
        )
        sums = [each for each in sp.fraction(term)[0].atoms(sp.Add) if len(each.args) > 2]
        expect(
            not sums,
            "right, but the sign can't be read off: write it as a sum of terms that each show their sign.",
        )
    return Passed(
        f"V' has {len(sp.Add.make_args(value))} terms, and each shows that it is never positive."
    )


def rising(state: Any) -> Passed:
    """A state (rho, alpha, theta) with the goal on the right, within 1 m, where V' of the paper's V is positive under (24) as printed."""
    slope = _printed_slope(state)
    expect(
        slope > 0,
        f"V' is {float(slope):.3g} there: V falls. Which sign has the extra term of (4.11) with the goal on the right?",
    )
    return Passed(
        f"V rises there by {float(slope):.2f} a second: one state is enough to refute the proof."
    )


def rising_fast(state: Any) -> Passed:
    """The same, with V' more than 5 per second."""
    slope = _printed_slope(state)
    expect(
        slope > 5,
        f"V' is {float(slope):.3g} per second there; more than 5 is asked for: what makes the extra term of (4.11) large?",
    )
    return Passed(f'V rises by {float(slope):.2f} a second, although (25) says "< 0".')


def _printed_slope(state: Any) -> sp.Expr:
    expect(state is not None and state is not ..., "`rising` has no value yet.")
    expect(ordered(state, 3), "`rising` needs three numbers: (rho, alpha, theta).")
    distance, angle, third = (
        number(f"`{name}`", each)
        for name, each in zip(("rho", "alpha", "theta"), state, strict=True)
    )
    expect(
        0.0 < distance <= 1.0,
        f"rho = {distance:g} m is asked to be within 1 m of the goal, and more than 0.",
    )
    expect(
        max(abs(angle), abs(third)) <= math.pi,
        "alpha and theta are asked for in radians, from -pi to pi.",
    )
    expect(
        angle < 0.0, "the goal is asked to be on the right: on which side is it with this alpha?"
    )
    exact = dict(
        zip(
            (rho, alpha, theta),
            (
                sp.nsimplify(each, rational=True) if isinstance(each, float) else each
                for each in state
            ),
            strict=True,
        )
    )
    gains = {
        key: sp.Rational(str(each))
        for key, each in zip((k_rho, k_alpha, h, v_max), OUTDOOR_GAINS, strict=True)
    }
    return textbook(lyapunov_rate("printed")).subs({**gains, L: 1}).subs(exact).evalf(30)


def _papers_turning() -> sp.Expr:
    """The corrected law for any speed."""
    return k_alpha * alpha + v * sp.sin(alpha) / (rho * alpha) * (alpha + h * theta)
