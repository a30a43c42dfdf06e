"""Asking for sympy expressions: in the right symbols, and equal to what is wanted, in whatever form they are written."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import sympy as sp
from sympy.core.function import AppliedUndef

from wmrbook.grading._hints import expect

Point = dict[sp.Symbol, sp.Rational]
_DIGITS = 30
_TOLERANCE = sp.Float("1e-12")  # of equality: a student may write 0.3 for 3/10


def expression(name: str, value: Any, symbols: Iterable[sp.Symbol]) -> sp.Expr:
    """The value as a sympy expression in no other than these symbols; a Hint if it is none."""
    expect(value is not None and value is not ..., f"`{name}` has no value yet.")
    expect(
        not isinstance(value, sp.Equality),
        f"`{name}` is an equation; only its right-hand side is wanted.",
    )
    if isinstance(value, (int, float, np.number)) and not isinstance(value, bool):
        value = sp.sympify(value)
    expect(
        isinstance(value, sp.Expr),
        f"`{name}` is of the type {type(value).__name__}; one sympy expression is needed.",
    )
    expect(
        not value.atoms(sp.Derivative, AppliedUndef),
        f"`{name}` still holds a derivative or an unknown function: put the rates in.",
    )
    allowed = {each.name: each for each in symbols}
    for each in sorted(value.free_symbols, key=str):
        expect(
            each.name in allowed, f"`{name}` holds `{each}`; it is wanted in {', '.join(allowed)}."
        )
        expect(
            each == allowed[each.name],
            f"`{name}` holds a `{each}` of your own: take the one that is imported above.",
        )
    return value


def points(symbols: Iterable[sp.Symbol], count: int = 12) -> list[Point]:
    """Random exact values, the same each time: gains and rho between 0.1 and 3, angles and other numbers between -3 and 3."""
    random, chosen = np.random.default_rng(4), list(symbols)
    lowest = {each: 100 if each.is_positive or each.name == "rho" else -3000 for each in chosen}
    return [
        {each: sp.Rational(int(random.integers(lowest[each], 3000)), 1000) for each in chosen}
        for _ in range(count)
    ]


def values(name: str, wanted: sp.Expr, where: Sequence[Point]) -> list[sp.Expr]:
    """The expression's values to 30 digits; a Hint if one is not a finite real number."""
    found = []
    for point in where:
        value = wanted.xreplace(point).evalf(_DIGITS)
        shown = ", ".join(
            f"{key} = {float(each):g}" for key, each in point.items() if key in wanted.free_symbols
        )
        expect(
            bool(value.is_number and value.is_finite and value.is_real),
            f"`{name}` is {value} at {shown}.",
        )
        found.append(value)
    return found


def same(value: sp.Expr, right: sp.Expr, where: Sequence[Point]) -> bool:
    """Whether two expressions are equal at all these points, to 12 digits.

    Two different formulas of this kind can't agree at a dozen random points, and unlike `sympy.simplify` numbers never fail to notice
    that two forms are the same.
    """
    for point in where:
        one, other = value.xreplace(point).evalf(_DIGITS), right.xreplace(point).evalf(_DIGITS)
        if not (one - other).is_finite or abs(one - other) > _TOLERANCE * (1 + abs(other)):
            return False
    return True
