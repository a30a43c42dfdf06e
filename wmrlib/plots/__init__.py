"""Figures, each with its alternative text; one module for each kind of thing that is drawn."""

from wmrlib.plots._style import COLOURS, LINES, STYLE, arrow, equal_scales, new_figure
from wmrlib.plots.earth import local_map, rounding_errors, sphere_error_map, spherical_triangle
from wmrlib.plots.robot import approach, commutator, coordinate_system, steps, turning_centre
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
    "approach",
    "arrival",
    "arrow",
    "commutator",
    "coordinate_system",
    "dashboard",
    "draw_errors",
    "draw_lyapunov",
    "draw_path",
    "draw_series",
    "equal_scales",
    "errors",
    "local_map",
    "lyapunov",
    "new_figure",
    "path",
    "rounding_errors",
    "sphere_error_map",
    "spherical_triangle",
    "steps",
    "turning_centre",
    "twist",
]
