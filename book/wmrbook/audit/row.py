"""One line of the audit, the verdicts, and the rules by which a verdict follows."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from decimal import Decimal
from enum import Enum
from functools import cache
from itertools import product
from typing import NamedTuple

import numpy as np
import sympy as sp

from wmrbook import equations
from wmrbook.audit.published import Published
from wmrbook.equations import EQUATIONS, PRINTED
from wmrlib import symbolic


class Verdict(Enum):
    """What a comparison came to; the value is a sign and a word, so that no colour is needed."""

    HOLDS = "✓ holds"
    TYPO = "✎ typo"
    WRONG = "✗ wrong"
    OPEN = "? not decided"


THRESHOLDS = {
    "cut": 0.01,  # the share of a number that cutting its digits off may lose
    "parked": math.radians(5.0),  # a heading that is right, rad
    "arrival": 0.05,  # where a robot stops before its goal, m
    "end": 1.0,  # the end of the line to the goal, m
    "reached": 0.01,  # the share of a speed limit that may be missing
    "v_max": 4.0,  # the speed limit on the circle, m/s, which only the outdoor case states
}
"""Every number that we chose; `decide` halves and doubles each that a verdict rests on."""


def decide(test: Callable[..., bool], *names: str, over: Iterable[tuple] = ((),)) -> Verdict:
    """The verdict on what `test` finds with each named threshold halved, as it is and doubled.

    over: what nobody published, as tuples of arguments that `test` takes before the thresholds.
    It holds if every outcome is true, is wrong if none is, and is not decided if they differ.
    """
    scaled = [[factor * THRESHOLDS[name] for factor in (0.5, 1.0, 2.0)] for name in names]
    outcomes = {bool(test(*known, *chosen)) for known in over for chosen in product(*scaled)}
    if len(outcomes) > 1:
        return Verdict.OPEN
    return Verdict.HOLDS if outcomes == {True} else Verdict.WRONG


class Row(NamedTuple):
    """One thing that the paper says.

    item: the tag of the cells that show it, without "audit:"; says: what the paper says; holds:
    what was found, with its numbers; why: a sentence, the reason for the verdict.
    Texts are Markdown with $...$ for mathematics.
    """

    item: str
    title: str
    says: str
    holds: str
    verdict: Verdict
    why: str


_TOLERANCE = 1e-9
_POINTS = 20


@cache
def equivalent(first: sp.Basic, second: sp.Basic) -> bool:
    """Whether two expressions, or matrices of one shape, are equal for all values of their symbols.

    They are not if they differ at one of 20 random points. If they agree there, sympy must prove
    it: the difference simplifies to zero, or every derivative of it does (it is then a constant,
    and zero at the points). Raises ArithmeticError if it can do neither.
    """
    difference = sp.Matrix([first - second])
    symbols = sorted(difference.free_symbols, key=str)
    value, random = sp.lambdify(symbols, difference, "numpy"), np.random.default_rng(26)
    for point in random.uniform(0.1, 0.9, (_POINTS, len(symbols))):
        if not np.allclose(np.array(value(*point), dtype=float), 0.0, atol=_TOLERANCE):
            return False
    for entry in difference:
        slopes = (sp.simplify(entry.diff(symbol)) for symbol in entry.free_symbols)
        if not _vanishes(entry) and any(slope != 0 for slope in slopes):
            raise ArithmeticError(
                f"{entry} is zero at {_POINTS} points, "
                "and sympy can't prove that it is zero everywhere"
            )
    return True


def _vanishes(expression: sp.Expr) -> bool:
    """Whether sympy can prove it to be zero, first and quickly as a polynomial in sines."""
    angles = {symbol for call in expression.atoms(sp.sin, sp.cos) for symbol in call.free_symbols}
    doubled = {angle: 2 * angle for angle in angles}  # halves are whole angles then
    polynomial = sp.expand_trig(expression.subs(doubled, simultaneous=True))
    polynomial = sp.expand(sp.numer(sp.together(polynomial)))
    for angle in {call.args[0] for call in polynomial.atoms(sp.sin)}:
        identity = sp.sin(angle) ** 2 + sp.cos(angle) ** 2 - 1
        polynomial = sp.expand(sp.rem(polynomial, identity, sp.sin(angle)))
    return polynomial == 0 or sp.simplify(expression) == 0


def fits(value: float, printed: Published, cut: float = THRESHOLDS["cut"]) -> bool:
    """Whether a computed value is what the paper prints.

    It is if it rounds to the printed digits, or if cutting it off after them leaves them and no
    larger share than `cut` is lost by that. A multiple of pi is compared to rounding.
    """
    digits = Decimal(repr(printed.value))
    if len(digits.as_tuple().digits) > 12:
        return math.isclose(value, printed.value, rel_tol=1e-12)
    unit = float(Decimal(1).scaleb(Decimal(f"{digits.normalize():f}").as_tuple().exponent))
    gap = abs(value) - abs(printed.value) if value * printed.value >= 0.0 else -math.inf
    cut_off = 0.0 <= gap < unit and gap <= cut * abs(printed.value)
    return abs(gap) <= 0.5 * unit or cut_off


def equation(number: int) -> sp.Basic:
    """An equation as the paper prints it, its undefined symbols read as defined ones."""
    return EQUATIONS[number]


def as_printed(number: int) -> sp.Basic:
    """The right side of an equation with all symbols that the paper prints."""
    return PRINTED[number].rhs


def left_as_printed(number: int) -> sp.Basic:
    """The left side of an equation as the paper prints it, `equations.blank` if there is none."""
    return PRINTED[number].lhs


def printed(number: int) -> sp.Basic:
    """The right side of `equation`."""
    return equation(number).rhs


def finding(number: int, verdict: Verdict, holds: str, why: str) -> Row:
    """The row of an equation, which quotes the symbols that the paper prints."""
    return Row(f"eq-{number}", f"({number})", formula(PRINTED[number]), holds, verdict, why)


_SPEEDING = symbolic.v_max * (1 - sp.exp(-symbolic.k_rho * symbolic.rho))
_NAMES = {
    symbolic.v_max: r"v_{\max}",
    equations.br: r"\mathrm{br}",
    symbolic.lat1: r"\mathrm{lat}_{1}",
    symbolic.lat2: r"\mathrm{lat}_{2}",
    symbolic.dlat: r"\Delta\mathrm{lat}",
    symbolic.dlong: r"\Delta\mathrm{lon}",
}


def latex(expression: sp.Basic) -> str:
    """LaTeX for a cell of a Markdown table: no vertical bars, u for v_max (1 - exp(-k_rho rho))."""
    text = sp.latex(expression.subs(_SPEEDING, sp.Symbol("u")), symbol_names=_NAMES)
    for plain, typeset in (
        (r"\left|", r"\left\vert "),
        (r"\right|", r"\right\vert "),
        (r"\operatorname{atan}_{2}", r"\operatorname{atan2}"),
    ):
        text = text.replace(plain, typeset)
    return text


def formula(relation: sp.Basic) -> str:
    """An equation or sum in $...$, a part for each term, so that a narrow cell can break it."""
    total = relation.rhs if isinstance(relation, sp.Eq) else relation
    if not isinstance(total, sp.Add):
        return f"${latex(relation)}$"
    first, *others = (latex(term) for term in total.as_ordered_terms())
    first = f"{latex(relation.lhs)} = {first}" if total is not relation else first
    signed = (term if term.startswith("-") else f"+ {term}" for term in others)
    return " ".join(f"${part}$" for part in (first, *signed))
