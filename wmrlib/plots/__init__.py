"""The figures that more than one place uses, each with its alternative text."""

from wmrlib._checks import book_extra

with book_extra("wmrlib.plots"):
    import matplotlib  # noqa: F401

from wmrlib.plots.runs import path
from wmrlib.plots.style import COLOURS, LINES, Picture

__all__ = ["COLOURS", "LINES", "Picture", "path"]
