"""Checks of a Lyapunov proof: V' along the model, the steering, and a state where V rises.

The assignment's V is `BOWL`, a bowl without a seam: it has 1 - cos(alpha) where the paper has
alpha^2/2, so that full turns don't count.
"""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import sympy as sp

from wmrbook.equations import EQUATIONS
from wmrbook.grading._asking import expect_value, number, ordered
from wmrbook.grading._expressions import equal_at, expression, points, values
from wmrbook.grading._hints import Hint, expect, rule_out
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
_MODEL = {
    coordinate: EQUATIONS[number].rhs for coordinate, number in ((rho, 7), (alpha, 9), (theta, 8))
}
_RATE = sum(BOWL.diff(coordinate) * rate for coordinate, rate in _MODEL.items())
_WANTED = -rho * v * sp.cos(alpha) / L - k_alpha * sp.sin(alpha) ** 2
# The omega with which _RATE, which is linear in it, is _WANTED.
_TURNING = sp.expand((_WANTED - _RATE.subs(omega, 0)) / _RATE.diff(omega))
_PAPERS_TURNING = k_alpha * alpha + v * sp.sin(alpha) / (rho * alpha) * (alpha + h * theta)
_CLOSED = _WANTED.subs(v, EQUATIONS[22].rhs)
_SYMBOLS = (rho, alpha, theta, v, omega, h, L, k_alpha, k_rho, v_max)
_POINTS = points(_SYMBOLS)
_equal = partial(equal_at, _POINTS)


def rate(V_rate: Any) -> str:
    """V' of the bowl along (7) to (9), in rho, alpha, theta, v, omega, h and L."""
    value = expression("V_rate", V_rate, (rho, alpha, theta, v, omega, h, L))
    if not _equal(value, _RATE):
        hint = "this is (20), of the paper's V; here the angles stand in cosines."
        rule_out(value, {hint: EQUATIONS[20].rhs}, _equal)
        far = partial(equal_at, [point | {L: sp.Integer(10) ** 30} for point in _POINTS])
        hint = "the angles' terms have the wrong sign: what is the derivative of 1 - cos?"
        rule_out(value, {hint: -_RATE}, far)
        hint = "the term with h has the wrong sign: "
        hint += "(8) and the third row of (10) contradict each other."
        rule_out(value.diff(h), {hint: -_RATE.diff(h)}, _equal)
        hint = "the term with L is wrong: differentiate rho^2/(2 L), and put (7) in."
        expect(_equal(value.diff(L), _RATE.diff(L)), hint)
        hint = "the term with h is wrong: differentiate h (1 - cos(theta)), and put (8) in."
        expect(_equal(value.diff(h), _RATE.diff(h)), hint)
        hint = "the terms without h and L are wrong: "
        expect(False, f"{hint}differentiate 1 - cos(alpha), and put (9) in.")
    return "V' is right along the model, for whatever the wheels do."


def steering(turning: Any) -> str:
    """The omega with which V' is -rho v cos(alpha)/L - k_alpha sin^2(alpha), whatever v is."""
    value = expression("turning", turning, (rho, alpha, theta, v, h, k_alpha))
    if not _equal(value, _TURNING):
        hint = "this is the law for the paper's V; with this V something of it does not cancel."
        rule_out(value, {hint: _PAPERS_TURNING}, _equal)
        hint = "the term with k_alpha makes V rise: look at the sign of omega in your V'."
        rule_out(value.diff(k_alpha), {hint: -_TURNING.diff(k_alpha)}, _equal)
        cancelling, right = value.subs(k_alpha, 0), _TURNING.subs(k_alpha, 0)
        hint = "the terms with v double what they should cancel: a sign."
        rule_out(cancelling, {hint: -right}, _equal)
        hint = "the term with h doubles what it should cancel: a sign."
        rule_out(value.diff(h), {hint: -_TURNING.diff(h)}, _equal)
        cosine = right * sp.cos(alpha)
        mistakes = {
            "a cosine too many: v stands for the whole speed, cosine and all.": cosine,
            "this has the factor that the paper's (24) has twice: "
            "something does not cancel.": cosine * sp.sin(alpha),
        }
        rule_out(cancelling, mistakes, _equal)
        hint = "with k_alpha = 0 the second bracket of V' must vanish, and yours does not."
        expect(_equal(cancelling, right), hint)
        hint = "everything cancels but what the term with k_alpha leaves: "
        expect(False, f"{hint}which function of alpha, times the one in V', is wanted?")
    return "V' is what was asked for, at any speed."


def steering_usable(turning: Any) -> str:
    """It is finite with the goal straight ahead, and mirrored states turn the other way."""
    value = expression("turning", turning, _SYMBOLS)
    sees = value.has(alpha) and value.has(theta)
    expect(sees, "a steering that does not see both angles can't park.")
    mirrored = value.subs({alpha: -alpha, theta: -theta}, simultaneous=True)
    hint = "in the mirror (alpha and theta negative) omega must be the opposite."
    expect(_equal(mirrored, -value), hint)
    try:
        values("turning", value, [point | {alpha: sp.Integer(0)} for point in _POINTS])
    except Hint:
        hint = "with the goal straight ahead, alpha = 0, a computer gets 0/0 from this form "
        raise Hint(f"{hint}of omega: cancel first.") from None
    mirror = "Mirrored states turn the other way"
    return f"{mirror}, and nothing is divided by zero at alpha = 0."


def closed(V_rate_closed: Any) -> str:
    """V' with the steering and (22): right, and every one of its terms never positive."""
    held = expression("V_rate_closed", V_rate_closed, _SYMBOLS).free_symbols
    hint = "theta and h still stand there: with the right omega they cancel."
    expect(theta not in held and h not in held, hint)
    value = expression("V_rate_closed", V_rate_closed, (rho, alpha, L, k_alpha, k_rho, v_max))
    if not _equal(value, _CLOSED):
        hint = "the signs are turned round: this V would rise."
        rule_out(value, {hint: -_CLOSED}, _equal)
        first, right = value.subs(k_alpha, 0), _CLOSED.subs(k_alpha, 0)
        hint = "a cosine is missing: V' has one, and the v of (22) brings another."
        rule_out(first, {hint: right / sp.cos(alpha)}, _equal)
        hint = "the first bracket is wrong: put the v of (22) into it."
        expect(_equal(first, right), hint)
        hint = "the second bracket is wrong: what is left of it is what you asked for in 4.2."
        expect(False, hint)
    terms, unclear = _terms(value), "right, but the sign can't be read off: "
    for term in terms:
        falling = all(number <= 0 for number in values("V_rate_closed", term, _POINTS))
        hint = f"{unclear}one of the terms is positive by itself. "
        expect(falling, f"{hint}Factor it, so that each term shows its sign.")
        mixed = term.has(L) and term.has(k_alpha)
        expect(not mixed, f"{unclear}write it as a sum, a term for each of the two brackets.")
    return f"V' has {len(terms)} terms, and each shows that it is never positive."


def rising(state: Any) -> str:
    """A state with the goal on the right, within 1 m, where (24) as printed makes V rise."""
    slope = float(_printed_slope(state))
    hint = f"V' is {slope:.3g} there: V falls. "
    hint += "Which sign has the extra rate with the goal on the right?"
    expect(slope > 0.0, hint)
    return f"V rises there by {slope:.2f} a second: one state is enough to refute the proof."


def rising_fast(state: Any) -> str:
    """The same, with V' more than 5 per second."""
    rising(state)
    slope = float(_printed_slope(state))
    hint = f"V' is {slope:.3g} per second there; more than 5 is asked for: "
    expect(slope > 5.0, f"{hint}what makes the extra rate large?")
    return f'V rises by {slope:.2f} a second, although (25) says "< 0".'


def _terms(value: sp.Expr) -> list[sp.Expr]:
    """The terms of a sum, also of one that something is factored out of."""
    factors = sp.Mul.make_args(value)
    (inner, *_) = *(term for term in factors if term.is_Add and term.has(k_alpha)), value
    others = sp.Mul(*(term for term in factors if term is not inner))
    return [others * term for term in sp.Add.make_args(inner)]


def _printed_slope(state: Any) -> sp.Expr:
    expect_value("`rising`", state)
    expect(ordered(state, 3), "`rising` needs three numbers: (rho, alpha, theta).")
    names = ("rho", "alpha", "theta")
    distance, *angles = map(number, [f"`{name}`" for name in names], state)
    hint = f"rho = {distance:g} m is asked to be within 1 m of the goal, and more than 0."
    expect(0.0 < distance <= 1.0, hint)
    hint = "alpha and theta are asked for in radians, from -pi to pi."
    expect(max(map(abs, angles)) <= math.pi, hint)
    hint = "the goal is asked to be on the right: on which side is it with this alpha?"
    expect(angles[0] < 0.0, hint)
    exact = [sp.nsimplify(x, rational=True) if isinstance(x, float) else x for x in state]
    gains = [sp.Rational(str(gain)) for gain in OUTDOOR_GAINS]
    given = dict(zip((k_rho, k_alpha, h, v_max), gains, strict=True)) | {L: 1}
    slope = textbook(lyapunov_rate("printed")).subs(given)
    return slope.subs(dict(zip((rho, alpha, theta), exact, strict=True))).evalf(30)
