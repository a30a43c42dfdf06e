"""Typo or error: whether one wrong sign, symbol or factor explains a misprint.

The search starts from the printed expression. A misprint of two slips is no typo.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import cache
from types import MappingProxyType

import numpy as np
import sympy as sp

from wmrbook.audit.row import Row, Verdict, equation, equivalent, finding, formula, latex, printed

SAME = "Our derivation leads to the same expression."


def equation_row(
    number: int,
    derived: sp.Basic,
    wanted_by: Mapping[str, bool],
    note: str = "",
    known: Mapping[sp.Basic, sp.Basic] = MappingProxyType({}),
) -> Row:
    """The row of an equation whose right side is compared with a derivation.

    known: what another printed equation says of a symbol in it.
    """
    verdict, why = judge(printed(number).subs(known), derived, wanted_by)
    if verdict is Verdict.HOLDS:
        note = note or "It is derived without the paper."
    else:
        note = f"It should be {formula(sp.Eq(equation(number).lhs, derived))}. {note}".strip()
    return finding(number, verdict, note, why)


def judge(right: sp.Basic, derived: sp.Basic, wanted_by: Mapping[str, bool]) -> tuple[Verdict, str]:
    """The verdict on a printed expression, and why.

    It holds if it is equivalent to the derived one. If not, it is a typo if one slip explains the
    difference and something else that the paper prints (a name and whether it is so) needs the
    derived form, and wrong otherwise.
    """
    if equivalent(right, derived):
        return Verdict.HOLDS, SAME
    needed = [name for name, so in wanted_by.items() if so]
    if not needed:
        return Verdict.WRONG, "It differs, and nothing else that is printed needs the derived form."
    slip = one_slip(sp.ImmutableMatrix([right]), sp.ImmutableMatrix([derived]))
    if slip is None:
        return Verdict.WRONG, "It differs, and no single slip explains how."
    listed = " and ".join(filter(None, (", ".join(needed[:-1]), needed[-1])))
    need = f"{listed} need{'' if len(needed) > 1 else 's'} the derived form"
    return Verdict.TYPO, f"One slip explains it, {slip}, and {need}."


def mended(expression: sp.Expr, meant: sp.Expr) -> Iterator[tuple[str, sp.Expr]]:
    """Every expression that is one slip away, each with the slip's name.

    A slip is a wrong sign, a term or factor too many, factors that are printed twice, a factor that
    is missing, a sine for a cosine, or a symbol that stands for another or for 1, once or
    throughout.
    """
    alphabet = expression.free_symbols | meant.free_symbols
    factors = sorted(alphabet | meant.atoms(sp.sin, sp.cos), key=str)
    for symbol in sorted(expression.free_symbols, key=str):
        yield f"${latex(symbol)}$ too many", expression.subs(symbol, 1)
        for other in sorted(alphabet - {symbol}, key=str):
            yield _stands_for(symbol, other), expression.subs(symbol, other)
    for part, put in _parts(expression):
        if not part.is_Add:  # the signs of all its terms are several
            yield f"the sign of ${latex(part)}$", put(-part)
        if isinstance(part, (sp.Add, sp.Mul)):
            for k, extra in enumerate(part.args):
                others = part.func(*part.args[:k], *part.args[k + 1 :])
                yield f"${latex(extra)}$ too many", put(others)
        powers = part.as_powers_dict() if isinstance(part, (sp.Mul, sp.Pow)) else {}
        twice = sp.Mul(*(base for base, power in powers.items() if power.is_Integer and power > 1))
        if twice != 1:
            yield f"${latex(twice)}$ printed twice", put(part / twice)
        for factor in factors:
            yield f"${latex(factor)}$ missing", put(part * factor)
            yield f"$1/{latex(factor)}$ missing", put(part / factor)
        if isinstance(part, (sp.sin, sp.cos)):
            other = (sp.cos if isinstance(part, sp.sin) else sp.sin)(*part.args)
            yield _stands_for(part, other), put(other)
        if part.is_Symbol:
            for other in sorted(alphabet - {part}, key=str):
                yield _stands_for(part, other), put(other)


def _stands_for(printed: sp.Expr, meant: sp.Expr) -> str:
    return f"${latex(printed)}$ for ${latex(meant)}$"


def _parts(expression: sp.Expr, put=lambda part: part) -> Iterator[tuple]:
    """Each part of an expression, and a function that puts another one into its place."""
    yield expression, put
    for k, part in enumerate(expression.args):

        def replace(new, k=k):
            return put(expression.func(*expression.args[:k], new, *expression.args[k + 1 :]))

        yield from _parts(part, replace)


@cache
def one_slip(right: sp.ImmutableMatrix, derived: sp.ImmutableMatrix) -> str | None:
    """Return the name of the one slip, in one entry, that explains the difference, if any."""
    wrong = [pair for pair in zip(right, derived, strict=True) if not equivalent(*pair)]
    if len(wrong) != 1:
        return None
    ((given, meant),) = wrong
    names, forms = zip(*mended(given, meant), strict=True)
    alphabet = sorted(given.free_symbols | meant.free_symbols, key=str)
    near = zip(names, forms, _agree(meant, forms, alphabet), strict=True)
    return next((name for name, form, so in near if so and equivalent(form, meant)), None)


def _agree(meant: sp.Expr, forms: tuple[sp.Expr, ...], symbols: list[sp.Symbol]) -> np.ndarray:
    """Which real forms equal the one that is meant at two random points: quick, before a proof."""
    agree = np.full(len(forms), True)
    with np.errstate(all="ignore"):
        for point in np.random.default_rng(24).uniform(0.1, 0.9, (2, len(symbols))):
            known: dict[sp.Basic, float] = dict(zip(symbols, point, strict=True))
            first, *others = (_value(form, known) for form in (meant, *forms))
            agree &= np.isclose(others, first, rtol=0.0, atol=1e-9)
    return agree


def _value(form: sp.Basic, known: dict[sp.Basic, float]) -> float:
    """The form's number, from those of its parts: thousands of forms share most of them."""
    if form not in known:
        parts = [_value(part, known) for part in form.args]
        if parts:
            known[form] = _numeric(form.func, len(parts))(*parts)
        else:
            known[form] = np.float64(form if form.is_real else np.nan)
    return known[form]


@cache
def _numeric(function: type[sp.Expr], size: int) -> Callable[..., float]:
    names = sp.symbols(f"x:{size}")
    return sp.lambdify(names, function(*names), "numpy")
