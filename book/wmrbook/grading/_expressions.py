"""Asking for sympy expressions: in the right symbols, and equal to what is wanted in any form."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from contextlib import suppress
from functools import lru_cache
from itertools import islice
from typing import Any

import mpmath
import numpy as np
import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.core.relational import Relational
from sympy.functions.elementary.piecewise import ExprCondPair

from wmrbook.grading._asking import expect_value
from wmrbook.grading._hints import expect
from wmrlib.symbolic import textbook

Point = dict[sp.Symbol, sp.Rational]
_DIGITS = 50
_TOLERANCE = 1e-12  # of equality: a student may write 0.3 for 3/10
_MOST_PARTS = 3000
_FUNCTIONS = "Add Mul Pow Abs sign sinc sin cos tan cot sec csc exp log asin acos atan atan2"
_FUNCTIONS = frozenset(f"{_FUNCTIONS} sinh cosh tanh UnevaluatedExpr decay".split())
_CASES = (sp.Piecewise, ExprCondPair, Relational)


def expression(name: str, value: Any, symbols: Iterable[sp.Symbol]) -> sp.Expr:
    """Return the value if it is a sympy expression in only these symbols; else raise Hint."""
    name = f"`{name}`"
    expect_value(name, value)
    equation = isinstance(value, sp.Equality)
    expect(not equation, f"{name} is an equation; only its right-hand side is wanted.")
    if isinstance(value, (int, float, np.number)) and not isinstance(value, bool):
        value = sp.sympify(value)
    kind = f"{name} is of the type {type(value).__name__}"
    expect(isinstance(value, sp.Expr), f"{kind}; one sympy expression is needed.")
    parts = list(islice(sp.preorder_traversal(value), _MOST_PARTS))
    expect(len(parts) < _MOST_PARTS, f"{name} is far too long: simplify it.")
    hint = f"{name} still holds a derivative or an unknown function: put the rates in."
    expect(not any(isinstance(part, (sp.Derivative, AppliedUndef)) for part in parts), hint)
    allowed = {symbol.name: symbol for symbol in symbols}
    for symbol in sorted({part for part in parts if isinstance(part, sp.Symbol)}, key=str):
        hint = f"{name} holds `{symbol}`; it is wanted in {', '.join(allowed)}."
        expect(symbol.name in allowed, hint)
    for part in parts:
        kind = part.func.__name__
        hint = f"{name} holds `{kind}`: write it with sums, products, sin, cos and exp."
        expect(not part.args or kind in _FUNCTIONS or isinstance(part, _CASES), hint)
    # A symbol of the student's own may have other assumptions: its name tells what it means.
    names = {symbol: allowed[symbol.name] for symbol in parts if isinstance(symbol, sp.Symbol)}
    return value.replace(sp.UnevaluatedExpr, lambda inner: inner).xreplace(names)


def points(symbols: Iterable[sp.Symbol]) -> list[Point]:
    """Random exact values, 12 of each: gains and rho from 0.1 to 3, the others from -3 to 3."""
    random, chosen = np.random.default_rng(4), list(symbols)
    lowest = {
        symbol: 100 if symbol.is_positive or symbol.name == "rho" else -3000 for symbol in chosen
    }
    return [
        {symbol: sp.Rational(int(random.integers(lowest[symbol], 3000)), 1000) for symbol in chosen}
        for _ in range(12)
    ]


def values(name: str, expected: sp.Expr, where: Sequence[Point]) -> list[mpmath.mpf]:
    """Return the expression's values to 50 digits; raise Hint if one is not finite and real."""
    results = []
    for point in where:
        value = _value_at(point, expected)
        held = [f"{key} = {float(point[key]):g}" for key in point if expected.has(key)]
        hint = f"`{name}` is not a finite real number at {', '.join(held)}."
        expect(value is not None, hint)
        results.append(value)
    return results


def equal_at(where: Sequence[Point], value: sp.Expr, right: sp.Expr) -> bool:
    """Whether two expressions are equal at all these points, to 12 digits.

    Two different formulas can't agree at a dozen random points, and unlike `sympy.simplify`
    numbers never miss that two forms are the same.
    """
    for point in where:
        one, other = _value_at(point, value), _value_at(point, right)
        if one is None or other is None or abs(one - other) > _TOLERANCE * (1 + abs(other)):
            return False
    return True


def _value_at(point: Point, expected: sp.Expr) -> mpmath.mpf | None:
    """Return its value there, None if it is not finite and real."""
    with mpmath.workdps(_DIGITS), suppress(ArithmeticError, TypeError, ValueError):
        numbers = [mpmath.mpf(coordinate.p) / coordinate.q for coordinate in point.values()]
        value = mpmath.mpmathify(_function(expected, *point)(*numbers))
        if mpmath.isfinite(value) and abs(value.imag) <= _TOLERANCE * abs(value):
            return value.real
    return None


@lru_cache(maxsize=256)
def _function(expected: sp.Expr, *symbols: sp.Symbol) -> Any:
    """Return the expression as a function of numbers of any precision."""
    return sp.lambdify(symbols, textbook(expected), "mpmath")
