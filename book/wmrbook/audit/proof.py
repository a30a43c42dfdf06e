"""The paper's proof, (18) to (26): each against V differentiated along the robot's motion.

What is refuted is refuted for all positive gains and every L: by a limit or a slope, not a number.
"""

from __future__ import annotations

import sympy as sp

from wmrbook import equations
from wmrbook.audit.equations import polar_rates
from wmrbook.audit.row import (
    Row,
    Verdict,
    as_printed,
    equation,
    equivalent,
    finding,
    formula,
    latex,
    left_as_printed,
    printed,
)
from wmrbook.audit.slips import SAME, equation_row, judge
from wmrlib.symbolic import L, alpha, h, k_alpha, k_rho, omega, rho, theta, v, v_max

_COSINE, _SINE, _STATE = sp.cos(alpha), sp.sin(alpha), (rho, alpha, theta)
CLOSED = -rho / L * v_max * (1 - sp.exp(-k_rho * rho)) * _COSINE**2 - k_alpha * alpha**2
"""The V' that the proof needs, never positive: what (26) prints, less its last two terms."""
_SLIPS = {Verdict.TYPO: "the typo", Verdict.WRONG: "the error"}
_WISH = 'Judged as an equality: its "< 0" is a wish, for $v$ and $\\omega$ are not chosen yet.'


def steering() -> sp.Expr:
    """The omega that turns the second bracket of (21) into -k_alpha alpha^2, with (22)'s speed.

    It is solved for, not taken from (24).
    """
    _, turning, sweeping = polar_rates()
    # the bracket is this - alpha omega
    others = sp.factor((alpha * turning + h * theta * sweeping).subs(omega, 0))
    return k_alpha * alpha + (others / alpha).subs(v, printed(22))


def slope(turning: sp.Expr) -> sp.Expr:
    """V' = (18) differentiated along (7) to (9), with the speed of (22) and this omega."""
    V = rho**2 / (2 * L) + (alpha**2 + h * theta**2) / 2
    along = sum(V.diff(symbol) * rate for symbol, rate in zip(_STATE, polar_rates(), strict=True))
    return along.subs({omega: turning, v: printed(22)}, simultaneous=True)


def near_goal(rate: sp.Expr) -> sp.Expr:
    """The limit of V' as rho -> 0, where the distance's part and with it L are gone.

    In exp(-k_rho rho) = 1 - k_rho rho u, u tends to 1. A V' that is a polynomial in rho and u has
    its value there as its limit, which sympy finds sooner than the limit of an exponential.
    """
    u, distance = sp.Symbol("u"), sp.Symbol("d", positive=True)
    polynomial = sp.expand(rate.subs(sp.exp(-k_rho * rho), 1 - k_rho * rho * u))
    if polynomial.is_polynomial(rho, u):
        return sp.factor(polynomial.subs({rho: 0, u: 1}))
    return sp.factor(sp.limit(rate.subs(rho, distance), distance, 0))


def rising(rate: sp.Expr) -> sp.Expr | None:
    """Why V' is positive somewhere: its first coefficient in alpha near the goal, odd in theta.

    A V' that is never positive has an even one. None if this one is even.
    """
    here = near_goal(rate)
    first = sp.limit(here, alpha, 0)
    if first == 0:
        first = sp.factor(sp.limit(here / alpha, alpha, 0))
    odd = first != 0 and sp.expand(first + first.subs(theta, -theta)) == 0
    return first if odd else None


def energy_rows() -> list[Row]:
    """(18) to (23), and the brackets above and below (22)."""
    dots = equations.rho_rate, equations.alpha_rate, equations.theta_rate
    chain = sum(printed(18).diff(symbol) * dot for symbol, dot in zip(_STATE, dots, strict=True))
    along = chain.subs(dict(zip(dots, polar_rates(), strict=True)))
    in_20, in_21 = equivalent(printed(20), along), equivalent(printed(21), along)
    sign = "(7) to (9) put into (19). It has the sign of (8), not that of (10)."
    return [
        _bowl_row({"(19)": equation(19).lhs == equations.V_rate}),
        equation_row(19, chain, {"(20)": in_20}, f"The chain rule on (18). {_WISH}"),
        equation_row(20, along, {"(21)": in_21}, f"{sign} {_WISH}"),
        equation_row(21, along, {"(20)": in_20}, f"(20) with its terms collected. {_WISH}"),
        _first_part_row(),
        _speed_row(),
        _second_part_row(),
        _inequality_row(),
    ]


def _bowl_row(needed: dict[str, bool]) -> Row:
    """(18): a bowl, under the name that its left side has."""
    energy, state = printed(18), sp.Matrix([_STATE])
    hessian = sp.hessian(energy, _STATE)
    quadratic = (state * hessian * state.T)[0] / 2
    is_bowl = (
        energy.subs(dict.fromkeys(_STATE, 0)) == 0
        and equivalent(energy, quadratic)
        and all(value.is_positive for value in hessian.eigenvals())
    )
    if is_bowl:
        bowl = "Zero at the goal, positive elsewhere: a sum of squares with positive weights."
        why = "Each eigenvalue of its second derivatives is positive, so it is a bowl."
        if left_as_printed(18) == equations.V:
            return finding(18, Verdict.HOLDS, bowl, why)
        bowl = f"The right side is sound. {bowl} {why}"
        missing = "It has no left side"
        wanting = [name for name, so in needed.items() if so]
        if not wanting:
            why = f"{missing}, and nothing else that is printed needs one."
            return finding(18, Verdict.WRONG, bowl, why)
        why = f"{missing}: one symbol is missing, $V$, and {wanting[0]} needs it for its $\\dot V$."
        return finding(18, Verdict.TYPO, bowl, why)
    why = "An eigenvalue of its second derivatives is not positive."
    return finding(18, Verdict.WRONG, "Not positive definite.", why)


def _speed_row() -> Row:
    first = sp.simplify(-rho / L * printed(22) * _COSINE)
    push = sp.simplify(-first * L / (rho * _COSINE**2))
    far = sp.Symbol("d", positive=True)
    falls = push.subs(rho, 0) == 0 and bool(push.diff(rho).is_positive)
    if falls and sp.limit(push.subs(rho, far), far, sp.oo) == v_max:
        text = (
            "The first bracket of (21) is then never positive, but zero at "
            "$\\alpha = \\pm 90°$; the paper asks for negative, and speaks of a square of $\\rho$ "
            "that is not there. The speed is never above $v_{\\max}$."
        )
        why = f"${latex(push)}$ is 0 at the goal and grows to $v_{{\\max}}$ far away."
        return finding(22, Verdict.HOLDS, text, why)
    why = "The factor of $-\\rho\\cos^2\\alpha/L$ is not positive."
    return finding(22, Verdict.WRONG, "The first bracket of (21) can be positive.", why)


def _first_part_row() -> Row:
    """The first part of V' as it is printed once more, without a number, above (22)."""
    part = rho / L * polar_rates()[0]
    needed = {f"({n})": equivalent(printed(n).coeff(1 / L), L * part) for n in (20, 21)}
    verdict, why = judge(equations.FIRST_PART, part, needed)
    says = f"The first part, to be negative: {formula(equations.FIRST_PART)}"
    holds = f"By (7) and (18) it is {formula(part)}. As $L > 0$, its sign is the same."
    return Row("first-part", "Above (22)", says, holds, verdict, why)


def _second_part_row() -> Row:
    """The second part of V' as it is printed once more, without a number, below (22)."""
    _, turning, sweeping = polar_rates()
    part = alpha * turning + h * theta * sweeping
    substituted = part.subs({omega: printed(24), v: printed(22)}, simultaneous=True)
    needed = {
        "(21)": equivalent(printed(21).coeff(L, 0), part),
        "(25)": equivalent(printed(25).coeff(L, 0), substituted),
    }
    verdict, why = judge(equations.SECOND_PART, part, needed)
    says = f"The second part, to be negative: {formula(equations.SECOND_PART)}"
    holds = f"By (8), (9) and (18) it is {formula(sp.expand(part))}."
    if equivalent(equations.SECOND_PART * L, part):
        holds += " As $L > 0$, its sign is the same."
    return Row("second-part", "Below (22)", says, holds, verdict, why)


def _inequality_row() -> Row:
    """(23) is to make the second bracket of (21), b - alpha omega, negative."""
    proved, given = equation(23).gts, equation(23).lts
    bracket = alpha * (-omega) + printed(22) * _SINE / rho * (h * theta + alpha)
    if equivalent(given - proved, bracket):
        text = "It says what the bracket says."
        return finding(23, Verdict.HOLDS, text, SAME)
    push = bracket.diff(omega)
    text = (
        f"The bracket's slope in $\\omega$ is ${latex(push)}$. With the goal on the right, "
        "$\\alpha < 0$, a larger $\\omega$ obeys (23) all the more and makes the bracket larger, "
        "without bound, whatever the gains."
    )
    why = "There is a counterexample: an $\\omega$ that obeys (23) and lets $V$ rise."
    return finding(23, Verdict.WRONG, text, why)


def law_rows() -> list[Row]:
    """(24) to (26), and the symbols in them that the paper does not define."""
    law = law_row()
    substituted = _substitution_row(law.verdict)
    # (21) has the same quotient over rho, and (24) the same gain, under defined names
    denominator = equivalent(
        printed(21).coeff(L, 0).coeff(1 / rho), v * _SINE * (h * theta + alpha)
    )
    gain = printed(24).has(k_alpha)
    return [
        _symbol_row("rho-i", equations.rho_i, 24, {"(21)": denominator}),
        law,
        substituted,
        _symbol_row("k-A", equations.k_A, 26, {"(24)": gain, "(25)": printed(25).has(k_alpha)}),
        _last_row(substituted.verdict),
    ]


def _symbol_row(item: str, symbol: sp.Symbol, number: int, needed: dict[str, bool]) -> Row:
    """A symbol that an equation uses and the paper never defines."""
    meant, given = equations.UNDEFINED[symbol], as_printed(number)
    verdict, why = judge(given, given.subs(symbol, meant), needed)
    using = [f"({n})" for n in (24, 25, 26) if as_printed(n).has(symbol)]
    title, says = (
        f"${latex(symbol)}$",
        f"Used in {' and '.join(using) or 'no equation'}, undefined.",
    )
    holds = f"We read it as ${latex(meant)}$. The rest of ({number}) is judged in its own row."
    return Row(item, title, says, holds, verdict, why)


def law_row() -> Row:
    """(24). What needs its derived form is (26): it prints the two terms which that form leaves."""
    law, terms = steering(), (set(sp.expand(side).args) for side in (CLOSED, _last()))
    left, there = terms
    needed = {"(26)": left <= there}
    needed = {name: so and equivalent(slope(law), CLOSED) for name, so in needed.items()}
    return equation_row(
        24,
        law,
        needed,
        "With it $\\dot V$ is never positive, and (26) prints both terms that it leaves.",
    )


def _last() -> sp.Expr:
    return printed(26).subs(sp.Abs(rho), rho)  # rho is a distance


def _not_below(rate: sp.Expr) -> str:
    first = rising(rate)
    if first is None:
        return ""
    return (
        f" Near the goal its first term in $\\alpha$ has the factor ${latex(first)}$, "
        "which changes sign with $\\theta$: it is positive somewhere for all gains and every $L$."
    )


def _substitution_row(law: Verdict) -> Row:
    ours, theirs = slope(steering()), slope(printed(24))
    if equivalent(printed(25), ours):
        return finding(25, Verdict.HOLDS, "(22) and (24) put into (21).", SAME)
    text = f"With the factor of (24) removed it is ${latex(CLOSED)}$, never positive."
    text += _not_below(printed(25))
    if equivalent(printed(25), theirs) and equivalent(ours, CLOSED):
        why = (
            f"It follows from (21), (22) and (24) as printed, so it repeats {_SLIPS[law]} of (24)."
        )
        return finding(25, law, text, why)
    why = "Neither (24) as printed nor the derived law gives it."
    return finding(25, Verdict.WRONG, text, why)


def _last_row(before: Verdict) -> Row:
    last = _last()
    if equivalent(last, CLOSED):
        left = "What the derived law leaves of (25)."
        return finding(26, Verdict.HOLDS, left, SAME)
    text = f"The derived law leaves ${latex(CLOSED)}$.{_not_below(last)}"
    if equivalent(last, printed(25)):
        return finding(26, before, text, f"It follows from (25), and repeats {_SLIPS[before]}.")
    why = "It does not follow from (25), neither with (24) as printed nor with the derived law."
    return finding(26, Verdict.WRONG, text, why)


def rows() -> list[Row]:
    """The 13 rows, in order."""
    return [*energy_rows(), *law_rows()]
