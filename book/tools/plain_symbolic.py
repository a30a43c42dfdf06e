"""Print wmrlib.symbolic as one module that needs sympy alone, for the Python of the pages.

`wmrlib.symbolic` reads its expressions off the library's own formulas, for which it needs numpy and
numba. Here they are written out: symbols, laws, closed loops, Lyapunov functions and their rates.
"""

from __future__ import annotations

import inspect

import sympy as sp

from wmrlib import symbolic
from wmrlib.laws import POSE_LAWS

# The laws that each function takes; a goal that moves has no closed loop.
BY_LAW = {
    symbolic.law: symbolic.LAWS,
    symbolic.closed_loop_rates: POSE_LAWS,
    symbolic.lyapunov: symbolic.LAWS,
    symbolic.lyapunov_rate: symbolic.LAWS,
}
COPIED = symbolic.decay, symbolic.wrap, symbolic.textbook
SYMBOLS = {name: it for name, it in vars(symbolic).items() if isinstance(it, sp.Symbol)}
NAMES = {*SYMBOLS, *(it.__name__ for it in (*COPIED, *BY_LAW))}
HEAD = '''"""wmrlib.symbolic, as book/tools/plain_symbolic.py prints it for the pages."""

import sympy as sp
from sympy import *
from sympy.codegen.cfunctions import expm1


def _by_name(rows):
    def look_up(name="corrected"):
        if name not in rows:
            raise ValueError(f"name = {name!r} is not allowed: one of {[*rows]} is needed")
        return rows[name]

    return look_up


'''


def module() -> str:
    """Return the text of the module."""
    parts = [HEAD, *(f"{inspect.getsource(it)}\n\n" for it in COPIED)]
    parts += [f"{name} = {sp.srepr(symbol)}\n" for name, symbol in SYMBOLS.items()]
    for function, laws in BY_LAW.items():
        rows = (f"    {law!r}: {sp.srepr(function(law))},\n" for law in laws)
        parts.append(f"{function.__name__} = _by_name({{\n{''.join(rows)}}})\n")
    return "".join(parts)
