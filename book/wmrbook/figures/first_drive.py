"""Chapter 0: speeds, position errors and V over the first drive, and how it ends."""

from __future__ import annotations

import math

import numpy as np

from wmrlib.plots.runs import (
    draw_lyapunov,
    draw_series,
    pose_at,
    range_in_words,
    rises_in_words,
    tenths,
)
from wmrlib.plots.style import COLOURS, Picture, dart, new_figure
from wmrlib.runs import Trajectory


def arrival(run: Trajectory, radius: float = 2.0) -> Picture:
    """Where the robot stops (filled arrow) and how it should stand there (open arrow).

    radius: how far around the goal to show, m.
    """
    figure, axes = new_figure(5.0, 5.0)
    goal, size = pose_at(run.goal, -1), 0.3 * radius
    axes.plot(run.x, run.y, color=COLOURS["path"])
    dart(axes, pose_at(run, -1), size, "robot", zorder=3)
    dart(axes, goal, size, "none", "goal", lw=2.5, zorder=4)
    xlim, ylim = (goal.x - radius, goal.x + radius), (goal.y - radius, goal.y + radius)
    axes.set(xlim=xlim, ylim=ylim, aspect="equal", xlabel="x [m]", ylabel="y [m]")
    error = math.degrees(run.heading_error[-1])
    axes.set_title(f"heading left over: {error:.0f} deg", fontsize=12)
    return Picture(
        figure,
        f"The last {radius:.0f} m before the goal: the robot stops {run.rho[-1]:.2f} m from it, "
        f"its heading {abs(error):.0f} deg {'clockwise' if error < 0.0 else 'counter-clockwise'} "
        "of the open arrow that marks the wanted one.",
    )


def twist(run: Trajectory) -> Picture:
    """The commanded v [m/s] and omega [rad/s] over time."""
    figure, (upper, lower) = new_figure(7.0, 4.5, rows=2)
    draw_series(upper, run, "v [m/s]", v="-")
    draw_series(lower, run, "omega [rad/s]", omega="-")
    lower.set_xlabel("time [s]")
    figure.align_ylabels()
    words = f"{_course_in_words(run, 'v', 'm/s')}; {_course_in_words(run, 'omega', 'rad/s')}"
    return Picture(figure, f"Over time: {words}.")


def position_errors(run: Trajectory) -> Picture:
    """x_error and y_error [m] over time, as in the paper's figures 11 and 12."""
    figure, axes = new_figure(7.0, 3.2)
    draw_series(axes, run, "error [m]", x_error="-", y_error="--")
    axes.set_xlabel("time [s]")
    x, y = (f"{each[0]:.1f} m to {tenths(each[-1])} m" for each in (run.x_error, run.y_error))
    return Picture(figure, f"Over time: the x error goes from {x}, the y error from {y}.")


def lyapunov_over_time(run: Trajectory) -> Picture:
    """V over time on a logarithmic scale; thick and red wherever it rises."""
    figure, axes = new_figure(7.0, 3.2)
    draw_lyapunov(axes, run)
    axes.set_xlabel("time [s]")
    ends = f"from {_three_digits(run.V[0])} to {_three_digits(run.V[-1])}"
    return Picture(figure, f"V over time, on a logarithmic scale: {ends}; {rises_in_words(run)}.")


def _course_in_words(run: Trajectory, name: str, unit: str) -> str:
    values = getattr(run, name)
    high = np.abs(values) >= 0.95 * np.abs(values).max()
    first, last = np.flatnonzero(high)[[0, -1]]
    text = f"{name} goes from {tenths(values[0])} to {tenths(values[-1])} {unit}"
    if not high[first : last + 1].all():
        return f"{text}, {range_in_words(values, unit)}"
    peak = f"{tenths(values[np.abs(values).argmax()])} {unit}"
    spell = f"from {run.t[first]:.1f} to {run.t[last]:.1f} s"
    return f"{text}, within 5 % of its peak, {peak}, {spell}"


def _three_digits(value: float) -> str:
    if value < 1e-6:
        return "less than 1e-6"
    return np.format_float_positional(value, 3, unique=False, fractional=False, trim="-")
