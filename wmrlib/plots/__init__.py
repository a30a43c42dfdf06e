"""Figures, each with its alternative text; one module for each kind of thing that is drawn."""

from wmrlib.plots._style import COLOURS, LINES, STYLE, arrow, equal_scales, new_figure
from wmrlib.plots.earth import local_map
from wmrlib.plots.noise import end_poses, near_goal, rise_map, rising, scatter, trade_off
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
    "end_poses",
    "equal_scales",
    "errors",
    "local_map",
    "lyapunov",
    "near_goal",
    "new_figure",
    "path",
    "rise_map",
    "rising",
    "scatter",
    "trade_off",
    "twist",
]
