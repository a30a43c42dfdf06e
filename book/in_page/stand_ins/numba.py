"""Stands in for numba in the page's Python, where formulas run as plain Python."""

from types import SimpleNamespace

config = SimpleNamespace(NUMBA_NUM_THREADS=1)
