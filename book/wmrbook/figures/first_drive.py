"""The front page and chapter 0: path, speeds, position errors and V of a drive."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from wmrbook.figures.paths import draw_path, path_in_words
from wmrbook.figures.style import COLOURS, Picture, equal_scales, new_figure
from wmrlib.runs import Trajectory, with_samples


def dashboard(run: Trajectory) -> Picture:
    """Show path, v, omega, position errors and V of one run side by side."""
    with_samples("run", run)
    mosaic = [["path", "v"], ["path", "omega"], ["path", "errors"], ["path", "V"]]
    figure, axes = new_figure(12.0, 6.0, mosaic=mosaic)
    draw_path(axes["path"], run)
    equal_scales(axes["path"], run.x, run.y, room=0.12)
    draw_series(axes["v"], run, "v [m/s]", v="-")
    draw_series(axes["omega"], run, "omega [rad/s]", omega="-")
    draw_series(axes["errors"], run, "error [m]", x_error="-", y_error="--")
    draw_lyapunov(axes["V"], run)
    for name in ("v", "omega", "errors"):
        axes[name].sharex(axes["V"])
        axes[name].tick_params(labelbottom=False)
    axes["V"].set_xlabel("time [s]")
    figure.align_ylabels()
    v, omega = f"v {range_in_words(run.v, 'm/s')}", f"omega {range_in_words(run.omega, 'rad/s')}"
    return Picture(figure, f"{path_in_words(run)}; {v}; {omega}; {rises_in_words(run)}.")


def twist(run: Trajectory) -> Picture:
    """The commanded v [m/s] and omega [rad/s] over time."""
    with_samples("run", run)
    figure, (upper, lower) = new_figure(7.0, 4.5, rows=2)
    draw_series(upper, run, "v [m/s]", v="-")
    draw_series(lower, run, "omega [rad/s]", omega="-")
    lower.set_xlabel("time [s]")
    figure.align_ylabels()
    words = f"{_course_in_words(run, 'v', 'm/s')}; {_course_in_words(run, 'omega', 'rad/s')}"
    return Picture(figure, f"Over time: {words}.")


def _course_in_words(run: Trajectory, name: str, unit: str) -> str:
    values = getattr(run, name)
    high = np.abs(values) >= 0.95 * np.abs(values).max()
    first, last = np.flatnonzero(high)[[0, -1]]
    text = f"{name} goes from {values[0]:z.1f} to {values[-1]:z.1f} {unit}"
    if not high[first : last + 1].all():
        return f"{text}, {range_in_words(values, unit)}"
    peak = f"{values[np.abs(values).argmax()]:z.1f} {unit}"
    spell = f"from {run.t[first]:.1f} to {run.t[last]:.1f} s"
    return f"{text}, within 5 % of its peak, {peak}, {spell}"


def draw_series(axes: Axes, run: Trajectory, label: str, **styles: str) -> None:
    """Draw the named fields over time, each in its style."""
    axes.axhline(0.0, color=COLOURS["ink"], lw=0.8)
    for name, style in styles.items():
        words = name.replace("_", " ")
        axes.plot(run.t, getattr(run, name), style, color=COLOURS[name], label=words)
    axes.set_ylabel(label)
    if len(styles) > 1:
        axes.legend(loc="upper right")


def draw_lyapunov(axes: Axes, run: Trajectory) -> None:
    values, rising = np.maximum(run.V, 1e-12), _rising(run)  # V = 0 on the goal has no logarithm
    axes.plot(run.t, values, color=COLOURS["V"], lw=2.0, label="falling")
    if rising.any():  # over it, step by step, with gaps
        gaps = np.full(len(rising), np.nan)
        t, V = (np.column_stack([line[:-1], line[1:], gaps])[rising] for line in (run.t, values))
        axes.plot(t.ravel(), V.ravel(), color=COLOURS["V_rising"], lw=5.0, label="rising")
        axes.legend(loc="upper right")
    xlim, ylim = (0.0, max(run.t[-1], 1e-9)), (values.min() / 2, values.max() * 2)
    axes.set(ylabel="V [1]", yscale="log", xlim=xlim, ylim=ylim)


def _rising(run: Trajectory) -> np.ndarray:
    return np.diff(run.V) > 1e-9 * run.V[0]


def range_in_words(values: np.ndarray, unit: str) -> str:
    return f"between {values.min():z.1f} and {values.max():z.1f} {unit}"


def rises_in_words(run: Trajectory) -> str:
    rises = int(_rising(run).sum())
    return f"V rises in {rises} of {len(run) - 1} steps" if rises else "V falls in every step"
