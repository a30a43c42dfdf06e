"""Chapter 14: what a filter believes about a heading, and how wrong it is."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from wmrbook.figures._drawing import check_count
from wmrbook.figures.style import COLOURS, Picture, new_figure
from wmrlib.checks import instance, real, same_shape


def beliefs(time: np.ndarray, runs: Mapping[str, tuple[np.ndarray, np.ndarray]]) -> Picture:
    """The heading error [deg] over time [s] within twice the deviation [deg] that a filter claims.

    runs: from a name to (error, deviation), one to four, a row of axes each.
    """
    time = real("time", time)
    check_count("runs", instance("runs", runs, Mapping), 1, 4)
    figure, rows = new_figure(7.5, 1.2 + 1.5 * len(runs), rows=len(runs))
    words = []
    for axes, (name, (error, deviation)) in zip(np.atleast_1d(rows), runs.items(), strict=True):
        same_shape(time=time, **{f"runs[{name!r}]": error, f"{name} deviation": deviation})
        band = {"color": COLOURS["robot"], "alpha": 0.4, "lw": 0}
        axes.fill_between(time, -2.0 * deviation, 2.0 * deviation, **band)
        axes.plot(time, error, color=COLOURS["path"], lw=1.4)
        axes.set_title(name, loc="left")
        axes.set(ylabel="error [deg]")
        ends = f"{deviation[0]:.1f} to {deviation[-1]:.1f} deg"
        inside = np.mean(np.abs(error) <= 2.0 * deviation)
        words.append(f"{name}: {ends}, error inside {100 * inside:.0f} % of the time")
    np.atleast_1d(rows)[-1].set_xlabel("time [s]")
    what = "The heading error over time in a band of twice the deviation that the filter claims"
    return Picture(figure, f"{what}. {'; '.join(words)}.")
