"""Figures of GPS points and runs, each with its alternative text. Colours go by role and are those of Okabe and Ito,
which colour-blind readers can tell apart; whatever a colour says, a line style, a marker or a label says too.

The functions that start with `draw_` draw into axes of the caller's and return what they drew; the others make a Picture.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon

from wmrlib._checks import instance
from wmrlib.geodesy import GeoPoint, haversine_distance, initial_bearing, local_position
from wmrlib.kinematics import Pose
from wmrlib.picture import Picture
from wmrlib.simulation import Trajectory

COLOURS = {
    "path": "#0072B2",
    "start": "#009E73",
    "goal": "#D55E00",
    "robot": "#56B4E9",
    "v": "#0072B2",
    "omega": "#CC79A7",
    "x_error": "#0072B2",
    "y_error": "#E69F00",
    "V": "#0072B2",
    "V_rising": "#D40000",
    "ink": "#222222",
}
STYLE = {
    "font.size": 12,
    "axes.grid": True,
    "grid.alpha": 0.35,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "lines.linewidth": 2.0,
}

_LINES = ("-", "--", ":", "-.")


def local_map(origin: GeoPoint, point: GeoPoint) -> Picture:
    """Two GPS points (single ones) in the local frame of the first: east to the right, north up, in metres, equal scales."""
    instance("origin", origin, GeoPoint)
    east, north = local_position(origin, point)
    distance, bearing = haversine_distance(origin, point), math.degrees(initial_bearing(origin, point))
    figure, axes = _figure(5.0, 5.5)
    axes.plot([0, east], [0, north], "--", color=COLOURS["path"])
    axes.plot(0, 0, "o", ms=10, color=COLOURS["start"])
    axes.plot(east, north, "*", ms=15, color=COLOURS["goal"])
    for name, where, at in (("start", origin, (0, 0)), ("goal", point, (east, north))):
        label = f"{name}\n{where.lat:.6f} deg N\n{where.lon:.6f} deg E"
        axes.annotate(label, at, xytext=(10, -4), textcoords="offset points", va="center", fontsize=10)
    axes.annotate(f"{distance:.2f} m at {bearing:.2f} deg", (east / 2, north / 2), xytext=(10, 0), textcoords="offset points", va="center")
    _equal_scales(axes, np.array([0, east]), np.array([0, north]), room=0.25)
    axes.set(xlabel="east [m]", ylabel="north [m]")
    return Picture(
        figure,
        f"Map in metres: from the start at the origin a dashed line leads to the goal {east:.1f} m east and {north:.1f} m north; "
        f"it is {distance:.2f} m long, at a bearing of {bearing:.2f} deg.",
    )


def path(runs: Trajectory | Sequence[Trajectory], labels: Sequence[str] = ()) -> Picture:
    """The path of one run, or of several to compare, in metres with equal scales.

    Of one run the robot is drawn about every tenth of the way, and again where it stops. Raises ValueError if there is no run,
    or more than four.
    """
    runs = [runs] if isinstance(runs, Trajectory) else list(runs)
    if not 1 <= len(runs) <= len(_LINES):
        raise ValueError(f"runs has {len(runs)} entries, which is not allowed: 1 to {len(_LINES)} are needed")
    figure, axes = _figure(5.5, 5.5)
    for run, style in zip(runs, _LINES, strict=False):
        draw_path(axes, run, style, robots=len(runs) == 1)
    if labels:
        axes.legend([Line2D([], [], color=COLOURS["path"], ls=style) for style in _LINES[: len(runs)]], labels)
    _equal_scales(axes, np.concatenate([run.x for run in runs]), np.concatenate([run.y for run in runs]))
    return Picture(figure, "Path in metres: " + "; ".join(map(_path_in_words, runs)) + ".")


def arrival(run: Trajectory, radius: float = 2.0) -> Picture:
    """The last `radius` metres before the goal: where the robot stops (filled), and how it should stand there (open)."""
    figure, axes = _figure(5.0, 5.0)
    goal = _goal(run)
    axes.plot(run.x, run.y, color=COLOURS["path"])
    size = 0.3 * radius
    axes.add_patch(_arrow(Pose(run.x[-1], run.y[-1], run.heading[-1]), size, fc=COLOURS["robot"], ec=COLOURS["ink"], zorder=3))
    axes.add_patch(_arrow(goal, size, fc="none", ec=COLOURS["goal"], lw=2.5, zorder=4))
    axes.set(
        xlim=(goal.x - radius, goal.x + radius), ylim=(goal.y - radius, goal.y + radius), aspect="equal", xlabel="x [m]", ylabel="y [m]"
    )
    error = math.degrees(run.heading_error[-1])
    axes.set_title(f"heading left over: {error:.0f} deg", fontsize=12)
    return Picture(
        figure,
        f"The last {radius:.0f} m before the goal: the robot stops {run.rho[-1]:.2f} m from it, its heading turned by {error:.0f} deg "
        "against the open arrow that marks the wanted one.",
    )


def twist(run: Trajectory) -> Picture:
    """The commanded v [m/s] and omega [rad/s] over time."""
    figure, (upper, lower) = _figure(7.0, 4.5, rows=2)
    draw_series(upper, run, "v", "v [m/s]")
    draw_series(lower, run, "omega", "omega [rad/s]")
    lower.set_xlabel("time [s]")
    figure.align_ylabels()
    return Picture(figure, f"Over time: {_range_in_words(run.v, 'v', 'm/s')}; {_range_in_words(run.omega, 'omega', 'rad/s')}.")


def errors(run: Trajectory) -> Picture:
    """The position errors goal.x - x and goal.y - y [m] over time, as in the paper's figures 11 and 12."""
    figure, axes = _figure(7.0, 3.2)
    draw_errors(axes, run)
    axes.set_xlabel("time [s]")
    return Picture(
        figure,
        f"Over time: the x error goes from {run.x_error[0]:.1f} m to {_near_zero(run.x_error[-1]):.1f} m, "
        f"the y error from {run.y_error[0]:.1f} m to {_near_zero(run.y_error[-1]):.1f} m.",
    )


def lyapunov(run: Trajectory) -> Picture:
    """V over time on a logarithmic scale; thick and red wherever it rises."""
    figure, axes = _figure(7.0, 3.2)
    draw_lyapunov(axes, run)
    axes.set_xlabel("time [s]")
    return Picture(figure, f"V over time, on a logarithmic scale: from {run.V[0]:.3g} to {run.V[-1]:.3g}; {_rises_in_words(run)}.")


def dashboard(run: Trajectory) -> Picture:
    """Path, v, omega, position errors and V of one run, side by side."""
    figure, axes = _figure(12.0, 6.0, mosaic=[["path", "v"], ["path", "omega"], ["path", "errors"], ["path", "V"]])
    draw_path(axes["path"], run)
    _equal_scales(axes["path"], run.x, run.y)
    draw_series(axes["v"], run, "v", "v [m/s]")
    draw_series(axes["omega"], run, "omega", "omega [rad/s]")
    draw_errors(axes["errors"], run)
    draw_lyapunov(axes["V"], run)
    for name in ("v", "omega", "errors"):
        axes[name].sharex(axes["V"])
        axes[name].tick_params(labelbottom=False)
    axes["V"].set_xlabel("time [s]")
    figure.align_ylabels()
    parts = _range_in_words(run.v, "v", "m/s"), _range_in_words(run.omega, "omega", "rad/s"), _rises_in_words(run)
    return Picture(figure, f"{_path_in_words(run)}; {'; '.join(parts)}.")


def draw_path(axes: Axes, run: Trajectory, style: str = "-", *, robots: bool = True) -> list:
    """The path, the start (filled) and the goal (open) as arrows, and the robot on the way; the caller sets the scales."""
    line = axes.plot(run.x, run.y, style, color=COLOURS["path"])
    size = 0.04 * max(np.ptp(run.x), np.ptp(run.y), 1.0)
    artists = [*line]
    if robots:
        for share in np.linspace(0.0, 1.0, 11)[1:-1]:
            k = int(np.searchsorted(_way(run), share * _way(run)[-1]))
            artists.append(axes.add_patch(_arrow(Pose(run.x[k], run.y[k], run.heading[k]), size, fc=COLOURS["robot"], ec=COLOURS["ink"])))
    goal = _goal(run)
    first = Pose(run.x[0], run.y[0], run.heading[0])
    artists.append(axes.add_patch(_arrow(goal, 1.5 * size, fc="none", ec=COLOURS["goal"], lw=2.0, zorder=4)))
    artists.append(axes.add_patch(_arrow(first, 1.5 * size, fc=COLOURS["start"], ec=COLOURS["start"], zorder=4)))
    axes.set(xlabel="x [m]", ylabel="y [m]")
    return artists


def draw_series(axes: Axes, run: Trajectory, name: str, label: str) -> list:
    """One field of the run over time."""
    axes.set_ylabel(label)
    axes.axhline(0.0, color=COLOURS["ink"], lw=0.8)
    return axes.plot(run.t, getattr(run, name), color=COLOURS[name])


def draw_errors(axes: Axes, run: Trajectory) -> list:
    """Both position errors over time, with a legend."""
    axes.axhline(0.0, color=COLOURS["ink"], lw=0.8)
    lines = axes.plot(run.t, run.x_error, "-", color=COLOURS["x_error"], label="x error")
    lines += axes.plot(run.t, run.y_error, "--", color=COLOURS["y_error"], label="y error")
    axes.set_ylabel("error [m]")
    axes.legend(loc="upper right", fontsize=10)
    return lines


def draw_lyapunov(axes: Axes, run: Trajectory) -> list:
    """V over time on a logarithmic scale, falling thin and blue, rising thick and red."""
    values = np.maximum(run.V, 1e-12)  # V = 0 on the goal has no logarithm
    rising = np.diff(run.V) > 1e-9 * run.V[0]
    points = np.column_stack([run.t, values])
    pieces = np.stack([points[:-1], points[1:]], axis=1)
    artists = [axes.add_collection(LineCollection(pieces[~rising], color=COLOURS["V"], lw=2.0, label="falling"))]
    if rising.any():
        artists.append(axes.add_collection(LineCollection(pieces[rising], color=COLOURS["V_rising"], lw=5.0, label="rising")))
    axes.set(ylabel="V", yscale="log", xlim=(0.0, max(run.t[-1], 1e-9)), ylim=(values.min() / 2, values.max() * 2))
    axes.legend(loc="upper right", fontsize=10)
    return artists


def _figure(width: float, height: float, rows: int = 1, mosaic=None):
    """A figure outside pyplot, so that nothing is shown twice or kept alive."""
    import matplotlib as mpl

    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(width, height), layout="constrained")
        if mosaic:
            return figure, figure.subplot_mosaic(mosaic, width_ratios=[1.0, 1.1])
        return figure, figure.subplots(rows, sharex=True)


def _arrow(pose: Pose, size: float, **looks) -> Polygon:
    """A dart as long as 2 `size` whose tip shows the heading."""
    shape = np.array([[1.3, 0.0], [-0.9, 0.6], [-0.5, 0.0], [-0.9, -0.6]]) * size
    cos, sin = math.cos(pose.heading), math.sin(pose.heading)
    return Polygon(shape @ np.array([[cos, sin], [-sin, cos]]) + [pose.x, pose.y], closed=True, **looks)


def _equal_scales(axes: Axes, x: np.ndarray, y: np.ndarray, room: float = 0.08) -> None:
    half = 0.5 * max(np.ptp(x), np.ptp(y), 1.0) * (1.0 + 2.0 * room)
    middle_x, middle_y = 0.5 * (x.min() + x.max()), 0.5 * (y.min() + y.max())
    axes.set(xlim=(middle_x - half, middle_x + half), ylim=(middle_y - half, middle_y + half), aspect="equal")


def _way(run: Trajectory) -> np.ndarray:
    return np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(run.x), np.diff(run.y)))])


def _goal(run: Trajectory) -> Pose:
    return Pose(*(float(np.ravel(field)[-1]) for field in run.goal))  # of a moving goal, where it ends


def _near_zero(value: float) -> float:
    return value if abs(value) >= 0.05 else 0.0  # no "-0.0" in a text


def _range_in_words(values: np.ndarray, name: str, unit: str) -> str:
    return f"{name} between {_near_zero(values.min()):.1f} and {_near_zero(values.max()):.1f} {unit}"


def _rises_in_words(run: Trajectory) -> str:
    rising = int((np.diff(run.V) > 1e-9 * run.V[0]).sum())
    return f"V rises in {rising} of {len(run) - 1} steps" if rising else "V falls in every step"


def _path_in_words(run: Trajectory) -> str:
    error = math.degrees(run.heading_error[-1])
    return (
        f"the robot starts at ({_near_zero(run.x[0]):.1f}, {_near_zero(run.y[0]):.1f}) m heading {math.degrees(run.heading[0]):.0f} deg "
        f"and is {run.rho[-1]:.2f} m from the goal after {run.t[-1]:.1f} s, its heading {error:.0f} deg from the goal's"
    )
