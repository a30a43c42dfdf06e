"""Figures, each with its alternative text; one module for each kind of thing that is drawn."""

from wmrlib.plots._style import COLOURS, LINES, STYLE, arrow, equal_scales, new_figure
from wmrlib.plots.design import front, phase_portrait, root_locus
from wmrlib.plots.earth import local_map
from wmrlib.plots.runs import (
    arrival,
    dashboard,
    draw_errors,
    draw_lyapunov,
    draw_path,
    draw_series,
    errors,
    lyapunov,
    path,
    twist,
)

__all__ = [
    "COLOURS",
    "LINES",
    "STYLE",
    "arrival",
    "arrow",
    "dashboard",
    "draw_errors",
    "draw_lyapunov",
    "draw_path",
    "draw_series",
    "equal_scales",
    "errors",
    "front",
    "local_map",
    "lyapunov",
    "new_figure",
    "path",
    "phase_portrait",
    "root_locus",
    "twist",
]
