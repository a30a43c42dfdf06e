"""The model as sympy expressions, and the same formulas printed as JavaScript and as C.

The expressions are what the functions of `laws`, `motion` and `geodesy` return for symbols, so that
no formula is typed twice. ``python -m wmrlib.symbolic`` prints `C_FORMULAS` into the C header
``wmr_law.h``, `C_FILTER` into ``wmr_filter.h`` and `JACOBIANS` into ``wmrlib/_jacobians.py``;
`javascript` prints `FORMULAS` for the book's panels.
"""

from wmrlib.checks import book_extra

with book_extra("wmrlib.symbolic"):
    import sympy  # noqa: F401

from wmrlib.symbolic.c_drive import C_DRIVE, c_drive  # noqa: F401
from wmrlib.symbolic.c_header import (  # noqa: F401
    C_FILTER_HEADER,
    C_HEADER,
    c_filter_header,
    c_function,
    c_header,
)
from wmrlib.symbolic.formulas import (  # noqa: F401
    C_FILTER,
    C_FORMULAS,
    C_LAWS,
    FORMULAS,
    JACOBIANS,
    Formula,
)
from wmrlib.symbolic.javascript import javascript, javascript_name  # noqa: F401
from wmrlib.symbolic.model import LAWS, closed_loop, law, lyapunov, lyapunov_rate  # noqa: F401
from wmrlib.symbolic.python import PYTHON_MODULE, python_module  # noqa: F401
from wmrlib.symbolic.symbols import *  # noqa: F403
