"""Stands in for numba in the page's Python, where formulas run as plain Python."""

import sys
from types import SimpleNamespace

config = SimpleNamespace(DISABLE_JIT=True, NUMBA_NUM_THREADS=1)
types = None


def intrinsic(function):
    return function


sys.modules["numba.core"] = sys.modules["numba.extending"] = sys.modules[__name__]
