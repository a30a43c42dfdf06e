"""Sympy expressions as plain data and back, without a `sympify`, which runs what a text says."""

from __future__ import annotations

from itertools import islice
from typing import Any

import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.functions.elementary.piecewise import ExprCondPair

from wmrbook.grading._expressions import FUNCTIONS, MOST_PARTS
from wmrlib import symbolic

_RELATIONS = sp.Eq, sp.Ne, sp.Lt, sp.Le, sp.Gt, sp.Ge
_HEADS = {each.__name__: each for each in (*_RELATIONS, sp.Piecewise, symbolic.decay)}
_HEADS |= {name: getattr(sp, name) for name in FUNCTIONS if hasattr(sp, name)}
_UNEVALUATED = {each.__name__: each for each in (ExprCondPair, sp.Tuple, sp.Derivative)}
_CONSTANTS = (sp.pi, sp.E, sp.I, sp.oo, -sp.oo, sp.zoo, sp.nan, sp.true, sp.false)
_CONSTANTS += (sp.EulerGamma, sp.GoldenRatio, sp.Catalan, sp.TribonacciConstant)
_CONSTANTS_BY_NAME = {type(each).__name__: each for each in _CONSTANTS}


def tree(value: sp.Basic) -> list:
    """Return the expression as [head, *arguments]; one that is far too long as none."""
    if len(list(islice(sp.preorder_traversal(value), MOST_PARTS + 1))) > MOST_PARTS:
        return ["too long"]
    return _tree(value)


def _tree(value: sp.Basic) -> list:
    name = type(value).__name__
    if isinstance(value, sp.Symbol):
        return ["symbol", value.name]  # `expression` knows what a name stands for
    if isinstance(value, sp.Rational):
        return ["rational", str(value.p), str(value.q)]
    if isinstance(value, sp.Float):
        return ["float", repr(float(value)) if value._prec == 53 else str(value), value._prec]
    if not value.args:
        return ["constant", name]
    if isinstance(value, AppliedUndef):
        return ["unknown", name, *map(_tree, value.args)]
    return [name, *map(_tree, value.args)]


def grown(data: Any) -> sp.Basic:
    """Return the expression of a tree; nothing in it is evaluated."""
    head, *arguments = data
    if head == "too long":
        return sp.Add(*sp.symbols(f"x:{MOST_PARTS}"), evaluate=False)
    if head == "symbol":
        return sp.Symbol(str(*arguments))
    if head == "rational":
        return sp.Rational(*(int(each[:1000]) for each in arguments))
    if head == "float":
        text, precision = arguments
        return sp.Float(text[:200], precision=min(int(precision), 400))
    if head == "constant":
        return _CONSTANTS_BY_NAME.get(*arguments) or _foreign(*arguments)()
    if head == "unknown":
        return sp.Function(str(arguments[0]))(*map(grown, arguments[1:]))
    parts = [grown(each) for each in arguments]
    if head in _UNEVALUATED:
        return sp.Basic.__new__(_UNEVALUATED[head], *parts)
    return _HEADS[head](*parts, evaluate=False) if head in _HEADS else _foreign(head)(*parts)


def _foreign(head: str) -> type:
    """A kind that no check knows, by its name."""
    name = str(head)
    return type(name if name.isidentifier() else "Basic", (sp.Expr,), {})
