"""The model as sympy expressions, and the same formulas printed as JavaScript and as C.

The expressions are what the functions of `laws`, `motion` and `geodesy` return for symbols, so that
no formula is typed twice. ``python -m wmrlib.symbolic`` prints `C_FORMULAS` into the C header
``wmr_law.h``; `javascript` prints `FORMULAS` for the book's panels. Formulas of your own go through
the same printers: `formula_of` a function, then `c_function`.
"""

from wmrlib.checks import book_extra

with book_extra("wmrlib.symbolic"):
    import sympy  # noqa: F401

from wmrlib.symbolic.c_header import (  # noqa: F401
    C_HEADER,
    c_function,
    c_functions,
    c_header,
    filled,
    wrapped,
)
from wmrlib.symbolic.formulas import (  # noqa: F401
    C_FORMULAS,
    C_LAWS,
    FORMULAS,
    Formula,
    formula_of,
    shared,
)
from wmrlib.symbolic.javascript import javascript, javascript_name  # noqa: F401
from wmrlib.symbolic.model import (  # noqa: F401
    LAWS,
    closed_loop,
    law,
    lyapunov,
    lyapunov_rate,
    read,
)
from wmrlib.symbolic.symbols import *  # noqa: F403
