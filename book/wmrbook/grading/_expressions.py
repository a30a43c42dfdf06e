"""Asking for sympy expressions: in the right symbols, and equal to what is wanted in any form.

What sympy's own `evalf`, `subs` or `expand` would never finish gets a hint: a value is computed
from its parts, of which there may not be too many, and only as far as they stay finite.
"""

from __future__ import annotations

import operator
from collections.abc import Iterable, Sequence
from contextlib import suppress
from itertools import islice
from typing import Any

import mpmath
import numpy as np
import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.core.relational import Relational

from wmrbook.grading._asking import expect_value
from wmrbook.grading._hints import Hint, expect

Point = dict[sp.Symbol, sp.Rational]
_DIGITS = 50
_TOLERANCE = 1e-12  # of equality: a student may write 0.3 for 3/10
MOST_PARTS = 3000
_LARGEST, _FARTHEST = 1e6, 1e100  # of a number that stands there, of one that comes out
FUNCTIONS = {
    **{"Add": lambda *terms: mpmath.fsum(terms), "Mul": lambda *terms: mpmath.fprod(terms)},
    **{"Pow": mpmath.power, "Abs": mpmath.fabs, "sign": mpmath.sign, "sinc": mpmath.sinc},
    **{"sin": mpmath.sin, "cos": mpmath.cos, "tan": mpmath.tan, "cot": mpmath.cot},
    **{"sec": mpmath.sec, "csc": mpmath.csc, "exp": mpmath.exp, "log": mpmath.log},
    **{"asin": mpmath.asin, "acos": mpmath.acos, "atan": mpmath.atan, "atan2": mpmath.atan2},
    "UnevaluatedExpr": lambda inner: inner,
    "decay": lambda rho, k_rho: -mpmath.expm1(-k_rho * rho) / rho,
    **{"sinh": mpmath.sinh, "cosh": mpmath.cosh, "tanh": mpmath.tanh},
}
_RELATIONS = {
    **{"<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge},
    **{"==": operator.eq, "!=": operator.ne},
}
_FAILS = ArithmeticError, LookupError, RecursionError, TypeError, ValueError
_CASES = (sp.Piecewise, sp.functions.elementary.piecewise.ExprCondPair, Relational)


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
    parts = _parts(name, value)
    hint = f"{name} still holds a derivative or an unknown function: put the rates in."
    expect(not any(isinstance(each, (sp.Derivative, AppliedUndef)) for each in parts), hint)
    allowed = {each.name: each for each in symbols}
    for each in sorted({it for it in parts if isinstance(it, sp.Symbol)}, key=str):
        hint = f"{name} holds `{each}`; it is wanted in {', '.join(allowed)}."
        expect(each.name in allowed, hint)
    for each in parts:
        large = isinstance(each, sp.Rational) and abs(each) > _LARGEST
        expect(not large, f"{name} holds a number that is far too large.")
        kind = each.func.__name__
        hint = f"{name} holds `{kind}`: write it with sums, products, sin, cos and exp."
        expect(not each.args or kind in FUNCTIONS or isinstance(each, _CASES), hint)
    # A symbol of the student's own may have other assumptions: its name tells what it means.
    names = {each: allowed[each.name] for each in parts if isinstance(each, sp.Symbol)}
    return value.replace(sp.UnevaluatedExpr, lambda inner: inner).xreplace(names)


def _parts(name: str, value: sp.Basic) -> list[sp.Basic]:
    """Return all that it is made of; raise Hint if that is too much."""
    with suppress(RecursionError):
        parts = list(islice(sp.preorder_traversal(value), MOST_PARTS + 1))
        if len(parts) <= MOST_PARTS:
            return parts
    raise Hint(f"{name} is far too long: simplify it.")


def points(symbols: Iterable[sp.Symbol], count: int = 12) -> list[Point]:
    """Random exact values: gains and rho between 0.1 and 3, the others between -3 and 3."""
    random, chosen = np.random.default_rng(4), list(symbols)
    lowest = {each: 100 if each.is_positive or each.name == "rho" else -3000 for each in chosen}
    return [
        {each: sp.Rational(int(random.integers(lowest[each], 3000)), 1000) for each in chosen}
        for _ in range(count)
    ]


def values(name: str, wanted: sp.Expr, where: Sequence[Point]) -> list[mpmath.mpf]:
    """Return the expression's values to 50 digits; raise Hint if one is not finite and real."""
    found = []
    for point in where:
        value = _value_at(point, wanted)
        held = [f"{key} = {float(point[key]):g}" for key in point if wanted.has(key)]
        hint = f"`{name}` is not a finite real number at {', '.join(held)}."
        expect(value is not None, hint)
        found.append(value)
    return found


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


def _value_at(point: Point, wanted: sp.Expr) -> mpmath.mpf | None:
    """Return its value there, None if it is not finite and real."""
    with mpmath.workdps(_DIGITS), suppress(*_FAILS):
        value = _value(wanted, point)
        return value.real if abs(value.imag) <= _TOLERANCE * abs(value) else None
    return None


def _value(part: sp.Basic, point: Point) -> Any:
    if isinstance(part, sp.Piecewise):
        held = (case for case, when in part.args if _holds(when, point))
        return _value(next(held, sp.nan), point)
    if part.args:
        value = FUNCTIONS[part.func.__name__](*(_value(each, point) for each in part.args))
    else:
        value = mpmath.mpmathify(point.get(part, part).evalf(_DIGITS))
    if not abs(value) < _FARTHEST:  # of a sine of more, mpmath would need pi to as many digits
        raise OverflowError
    return value


def _holds(condition: Any, point: Point) -> bool:
    if not condition.args:
        return bool(condition)
    return _RELATIONS[condition.rel_op](*(_value(each, point) for each in condition.args))
