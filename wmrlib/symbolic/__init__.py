"""The model as sympy expressions, and the same formulas printed as JavaScript and as C.

The expressions are the results of the functions of `laws`, `motion` and `geodesy` for symbols, so
that no formula is typed twice. ``python -m wmrlib.symbolic`` prints `c_formulas` into the C header
``wmr_law.h``; `javascript` prints `panel_formulas` for the book's panels. Formulas of your own go
through the same printers: `formula_of` a function, then `c_function`.
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
    Formula,
    c_formulas,
    c_laws,
    formula_of,
    panel_formulas,
    shared,
)
from wmrlib.symbolic.javascript import javascript, javascript_name  # noqa: F401
from wmrlib.symbolic.model import (  # noqa: F401
    LAWS,
    closed_loop_rates,
    law,
    lyapunov,
    lyapunov_rate,
    read,
)
from wmrlib.symbolic.symbols import *  # noqa: F403
