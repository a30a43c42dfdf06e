"""Figures of runs.

The functions that start with `draw_` draw into axes of the caller's and return what they drew; the others make a Picture.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D

from wmrlib.kinematics import Pose, wrap_angle
from wmrlib.plots.picture import Picture
from wmrlib.plots.style import COLOURS, LINES, arrow, equal_scales, near_zero, new_figure
from wmrlib.runs import Trajectory


def path(runs: Trajectory | Sequence[Trajectory], labels: Sequence[str] = ()) -> Picture:
    """The path of one run, or of several to compare, in metres with equal scales.

    Of one run the robot is drawn about every tenth of the way, and again where it stops. Raises ValueError if there is no run,
    or more than four, or if there are labels, but not one for each.
    """
    runs = [runs] if isinstance(runs, Trajectory) else list(runs)
    if not 1 <= len(runs) <= len(LINES):
        raise ValueError(
            f"runs has {len(runs)} entries, which is not allowed: 1 to {len(LINES)} are needed"
        )
    if len(labels) not in (0, len(runs)):
        raise ValueError(
            f"labels has {len(labels)} entries, which is not allowed: one for each of the {len(runs)} runs is needed"
        )
    figure, axes = new_figure(5.5, 5.5)
    x, y = np.concatenate([run.x for run in runs]), np.concatenate([run.y for run in runs])
    size = (0.04 if len(runs) == 1 else 0.025) * max(
        np.ptp(x), np.ptp(y), 1.0
    )  # several: one size, small beside their bends
    for run, style in zip(runs, LINES, strict=False):
        draw_path(axes, run, style, robots=len(runs) == 1, size=size)
    if labels:
        axes.legend(
            [Line2D([], [], color=COLOURS["path"], ls=style) for style in LINES[: len(runs)]],
            labels,
        )
    equal_scales(axes, x, y, room=0.12)
    names = [f"{label}: " for label in labels] or [""] * len(runs)
    words = [name + _path_in_words(run) for name, run in zip(names, runs, strict=True)]
    if len(runs) == 2 and _mirrored(*runs):
        words.append("the two paths are mirror images")
    return Picture(figure, "Path in metres: " + "; ".join(words) + ".")


def arrival(run: Trajectory, radius: float = 2.0) -> Picture:
    """The last `radius` metres before the goal: where the robot stops (filled), and how it should stand there (open)."""
    figure, axes = new_figure(5.0, 5.0)
    goal = _goal(run)
    axes.plot(run.x, run.y, color=COLOURS["path"])
    size = 0.3 * radius
    axes.add_patch(
        arrow(
            Pose(run.x[-1], run.y[-1], run.heading[-1]),
            size,
            fc=COLOURS["robot"],
            ec=COLOURS["ink"],
            zorder=3,
        )
    )
    axes.add_patch(arrow(goal, size, fc="none", ec=COLOURS["goal"], lw=2.5, zorder=4))
    axes.set(
        xlim=(goal.x - radius, goal.x + radius),
        ylim=(goal.y - radius, goal.y + radius),
        aspect="equal",
        xlabel="x [m]",
        ylabel="y [m]",
    )
    error = math.degrees(run.heading_error[-1])
    axes.set_title(f"heading left over: {error:.0f} deg", fontsize=12)
    return Picture(
        figure,
        f"The last {radius:.0f} m before the goal: the robot stops {run.rho[-1]:.2f} m from it, its heading {abs(error):.0f} deg "
        f"{'clockwise' if error < 0.0 else 'counter-clockwise'} of the open arrow that marks the wanted one.",
    )


def twist(run: Trajectory) -> Picture:
    """The commanded v [m/s] and omega [rad/s] over time."""
    figure, (upper, lower) = new_figure(7.0, 4.5, rows=2)
    draw_series(upper, run, "v", "v [m/s]")
    draw_series(lower, run, "omega", "omega [rad/s]")
    lower.set_xlabel("time [s]")
    figure.align_ylabels()
    return Picture(
        figure,
        f"Over time: {_course_in_words(run, 'v', 'm/s')}; {_course_in_words(run, 'omega', 'rad/s')}.",
    )


def errors(run: Trajectory) -> Picture:
    """The position errors goal.x - x and goal.y - y [m] over time, as in the paper's figures 11 and 12."""
    figure, axes = new_figure(7.0, 3.2)
    draw_errors(axes, run)
    axes.set_xlabel("time [s]")
    return Picture(
        figure,
        f"Over time: the x error goes from {run.x_error[0]:.1f} m to {near_zero(run.x_error[-1]):.1f} m, "
        f"the y error from {run.y_error[0]:.1f} m to {near_zero(run.y_error[-1]):.1f} m.",
    )


def lyapunov(run: Trajectory) -> Picture:
    """V over time on a logarithmic scale; thick and red wherever it rises."""
    figure, axes = new_figure(7.0, 3.2)
    draw_lyapunov(axes, run)
    axes.set_xlabel("time [s]")
    return Picture(
        figure,
        f"V over time, on a logarithmic scale: from {_three_digits(run.V[0])} to {_three_digits(run.V[-1])}; {_rises_in_words(run)}.",
    )


def dashboard(run: Trajectory) -> Picture:
    """Path, v, omega, position errors and V of one run, side by side."""
    figure, axes = new_figure(
        12.0, 6.0, mosaic=[["path", "v"], ["path", "omega"], ["path", "errors"], ["path", "V"]]
    )
    draw_path(axes["path"], run)
    equal_scales(axes["path"], run.x, run.y, room=0.12)
    draw_series(axes["v"], run, "v", "v [m/s]")
    draw_series(axes["omega"], run, "omega", "omega [rad/s]")
    draw_errors(axes["errors"], run)
    draw_lyapunov(axes["V"], run)
    for name in ("v", "omega", "errors"):
        axes[name].sharex(axes["V"])
        axes[name].tick_params(labelbottom=False)
    axes["V"].set_xlabel("time [s]")
    figure.align_ylabels()
    parts = (
        _range_in_words(run.v, "v", "m/s"),
        _range_in_words(run.omega, "omega", "rad/s"),
        _rises_in_words(run),
    )
    return Picture(figure, f"{_path_in_words(run)}; {'; '.join(parts)}.")


def draw_path(
    axes: Axes, run: Trajectory, style: str = "-", *, robots: bool = True, size: float | None = None
) -> list:
    """The path, the start (filled) and the goal (open) as arrows, the robot on its way and at its end; the caller sets the scales.

    size: half the length of a robot's arrow in metres, a twenty-fifth of the path's width or height if not given.
    """
    line = axes.plot(run.x, run.y, style, color=COLOURS["path"])
    size = 0.04 * max(np.ptp(run.x), np.ptp(run.y), 1.0) if size is None else size
    artists = [*line]
    if robots:
        for share in np.linspace(0.0, 1.0, 11)[1:]:
            k = (
                int(np.searchsorted(_way(run), share * _way(run)[-1])) if share < 1.0 else -1
            )  # it may turn where it stops
            artists.append(
                axes.add_patch(
                    arrow(
                        Pose(run.x[k], run.y[k], run.heading[k]),
                        size,
                        fc=COLOURS["robot"],
                        ec=COLOURS["ink"],
                    )
                )
            )
    goal = _goal(run)
    first = Pose(run.x[0], run.y[0], run.heading[0])
    artists.append(
        axes.add_patch(arrow(goal, 1.5 * size, fc="none", ec=COLOURS["goal"], lw=2.0, zorder=4))
    )
    artists.append(
        axes.add_patch(arrow(first, 1.5 * size, fc=COLOURS["start"], ec=COLOURS["start"], zorder=4))
    )
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
    artists = [
        axes.add_collection(
            LineCollection(pieces[~rising], color=COLOURS["V"], lw=2.0, label="falling")
        )
    ]
    if rising.any():
        artists.append(
            axes.add_collection(
                LineCollection(pieces[rising], color=COLOURS["V_rising"], lw=5.0, label="rising")
            )
        )
    axes.set(
        ylabel="V [1]",
        yscale="log",
        xlim=(0.0, max(run.t[-1], 1e-9)),
        ylim=(values.min() / 2, values.max() * 2),
    )
    axes.legend(loc="upper right", fontsize=10)
    return artists


def _way(run: Trajectory) -> np.ndarray:
    return np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(run.x), np.diff(run.y)))])


def _goal(run: Trajectory) -> Pose:
    return Pose(
        *(float(np.ravel(field)[-1]) for field in run.goal)
    )  # of a moving goal, where it ends


def _range_in_words(values: np.ndarray, name: str, unit: str) -> str:
    return f"{name} between {near_zero(values.min()):.1f} and {near_zero(values.max()):.1f} {unit}"


def _course_in_words(run: Trajectory, name: str, unit: str) -> str:
    values = getattr(run, name)
    high = np.abs(values) >= 0.95 * np.abs(values).max()
    first, last = np.flatnonzero(high)[[0, -1]]
    text = f"{name} goes from {near_zero(values[0]):.1f} to {near_zero(values[-1]):.1f} {unit}"
    if high[first : last + 1].all():
        peak = values[np.abs(values).argmax()]
        return f"{text}, within 5 % of its peak, {near_zero(peak):.1f} {unit}, from {run.t[first]:.1f} to {run.t[last]:.1f} s"
    return f"{text}, between {near_zero(values.min()):.1f} and {near_zero(values.max()):.1f} {unit}"


def _three_digits(value: float) -> str:
    return (
        np.format_float_positional(value, 3, unique=False, fractional=False, trim="-")
        if value >= 1e-6
        else "less than 1e-6"
    )


def _rises_in_words(run: Trajectory) -> str:
    rising = int((np.diff(run.V) > 1e-9 * run.V[0]).sum())
    return f"V rises in {rising} of {len(run) - 1} steps" if rising else "V falls in every step"


def _path_in_words(run: Trajectory) -> str:
    error = math.degrees(run.heading_error[-1])
    heading = math.degrees(wrap_angle(run.heading[0]))
    backs = int(np.argmax(run.v >= 0.0))  # the first sample at which it does not back up
    cusp = (
        f", backs up for the first {run.t[backs]:.1f} s as far as ({near_zero(run.x[backs]):.1f}, {near_zero(run.y[backs]):.1f}) m, "
        "reverses there in a cusp"
    )
    return (
        f"the robot starts at ({near_zero(run.x[0]):.1f}, {near_zero(run.y[0]):.1f}) m heading {heading:.0f} deg{cusp if backs else ''} "
        f"and is {run.rho[-1]:.2f} m from the goal after {run.t[-1]:.1f} s, its heading {error:.0f} deg from the goal's"
    )


def _mirrored(one: Trajectory, other: Trajectory) -> bool:
    """Whether one path is the other's mirror image in the line from its start to its goal."""
    if len(one) != len(other):
        return False
    seen = []
    for run in (one, other):
        goal = _goal(run)
        along = complex(goal.x - run.x[0], goal.y - run.y[0])
        seen.append(
            (run.x - run.x[0] + 1j * (run.y - run.y[0])) / along if along else np.zeros(len(run))
        )
    return bool(
        np.allclose(seen[0], seen[1].conj(), atol=1e-3) and np.abs(seen[0].imag).max() > 1e-2
    )
