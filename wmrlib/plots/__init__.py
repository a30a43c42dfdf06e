"""Figures, each with its alternative text; one module for each kind of thing that is drawn."""

from wmrlib.plots._style import COLOURS, LINES, STYLE, arrow, equal_scales, new_figure
from wmrlib.plots.comparison import chase, heading_shares, residual_curve, snapshots, together, tradeoff
from wmrlib.plots.diagram import block_diagram
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
    "block_diagram",
    "chase",
    "dashboard",
    "draw_errors",
    "draw_lyapunov",
    "draw_path",
    "draw_series",
    "equal_scales",
    "errors",
    "heading_shares",
    "local_map",
    "lyapunov",
    "new_figure",
    "path",
    "residual_curve",
    "snapshots",
    "together",
    "tradeoff",
    "twist",
]
