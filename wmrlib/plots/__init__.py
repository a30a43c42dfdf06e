"""Figures, each with its alternative text; one module for each kind of thing that is drawn."""

from wmrlib.plots._style import COLOURS, LINES, STYLE, arrow, equal_scales, new_figure
from wmrlib.plots.angles import angles_over_time, polar_angles, third_angle, ways
from wmrlib.plots.comparison import chase, heading_shares, residual_curve, snapshots, together, tradeoff
from wmrlib.plots.design import front, phase_portrait, root_locus
from wmrlib.plots.diagram import block_diagram
from wmrlib.plots.earth import local_map, rounding_errors, sphere_error_map, spherical_triangle
from wmrlib.plots.noise import arrival_radii, end_poses, near_goal, rise_map, rising, scatter
from wmrlib.plots.robot import approach, commutator, coordinate_system, steps, turning_centre
from wmrlib.plots.routes import challenge_paths, route, route_signals
from wmrlib.plots.runs import arrival, dashboard, draw_errors, draw_lyapunov, draw_path, draw_series, errors, lyapunov, path, twist
from wmrlib.plots.sampling import driven, inner_loops, orders, responses, time_steps
from wmrlib.plots.state import heading_errors, level_sets, lyapunov_runs, rate_sign
from wmrlib.plots.verdicts import verdicts

__all__ = [
    "COLOURS",
    "LINES",
    "STYLE",
    "angles_over_time",
    "approach",
    "arrival",
    "arrival_radii",
    "arrow",
    "block_diagram",
    "challenge_paths",
    "chase",
    "commutator",
    "coordinate_system",
    "dashboard",
    "draw_errors",
    "draw_lyapunov",
    "draw_path",
    "draw_series",
    "driven",
    "end_poses",
    "equal_scales",
    "errors",
    "front",
    "heading_errors",
    "heading_shares",
    "inner_loops",
    "level_sets",
    "local_map",
    "lyapunov",
    "lyapunov_runs",
    "near_goal",
    "new_figure",
    "orders",
    "path",
    "phase_portrait",
    "polar_angles",
    "rate_sign",
    "residual_curve",
    "responses",
    "rise_map",
    "rising",
    "root_locus",
    "rounding_errors",
    "route",
    "route_signals",
    "scatter",
    "snapshots",
    "sphere_error_map",
    "spherical_triangle",
    "steps",
    "third_angle",
    "time_steps",
    "together",
    "tradeoff",
    "turning_centre",
    "twist",
    "verdicts",
    "ways",
]
