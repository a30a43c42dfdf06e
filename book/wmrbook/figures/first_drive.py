"""Chapter 0: the speeds of a drive."""

from __future__ import annotations

import numpy as np

from wmrbook.figures.style import COLOURS, Picture, new_figure
from wmrlib.runs import Trajectory, with_samples


def twist(run: Trajectory) -> Picture:
    """The commanded v [m/s] and omega [rad/s] over time."""
    with_samples("run", run)
    figure, (upper, lower) = new_figure(7.0, 4.5, rows=2)
    for axes, name, unit in ((upper, "v", "m/s"), (lower, "omega", "rad/s")):
        axes.axhline(0.0, color=COLOURS["ink"], lw=0.8)
        axes.plot(run.t, getattr(run, name), color=COLOURS[name])
        axes.set_ylabel(f"{name} [{unit}]")
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
        return f"{text}, {_range_in_words(values, unit)}"
    peak = f"{values[np.abs(values).argmax()]:z.1f} {unit}"
    spell = f"from {run.t[first]:.1f} to {run.t[last]:.1f} s"
    return f"{text}, within 5 % of its peak, {peak}, {spell}"


def _range_in_words(values: np.ndarray, unit: str) -> str:
    return f"between {values.min():z.1f} and {values.max():z.1f} {unit}"
