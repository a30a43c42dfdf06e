"""Chapter 13: how the heading error falls with the distance, and what a last turn saves."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from wmrbook.figures._drawing import SERIES, check_count, check_series, figure_legend, note
from wmrbook.figures.style import COLOURS, Picture, new_figure
from wmrlib.checks import real
from wmrlib.runs import Trajectory

_LEAST_DEG = 1e-3


def heading_powers(runs: Mapping[str, Trajectory], powers: Mapping[str, float]) -> Picture:
    """The heading error [deg] over the distance left [m], on logarithmic scales.

    powers: of some of the runs, the power of the distance by which the error falls at last; a thin
    line of that slope ends where the run does.
    """
    check_series(runs, Trajectory)
    figure, axes = new_figure(7.0, 4.4)
    words = []
    for (name, run), (role, style) in zip(runs.items(), SERIES, strict=False):
        off = np.maximum(np.degrees(np.abs(run.heading_error)), _LEAST_DEG)
        axes.plot(run.rho, off, color=COLOURS[role], ls=style, label=name)
        text = f"{name} ends {off[-1]:.2g} deg off at {100 * run.rho[-1]:.3g} cm"
        if name in powers:
            far = np.array([run.rho[-1], 10.0 * run.rho[-1]])
            axes.plot(far, off[-1] * (far / far[0]) ** powers[name], color=COLOURS["ink"], lw=0.9)
            text += f", by the power {powers[name]:.2g}"
        words.append(text)
    axes.set(xscale="log", yscale="log", ylim=(_LEAST_DEG, 300.0))
    axes.set(xlabel="distance left [m]", ylabel="heading error [deg]")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter("{x:g}")
    figure_legend(figure)
    what = "The heading error over the distance left on logarithmic scales"
    return Picture(figure, f"{what}: {'; '.join(words)}.")


def last_turns(seconds: Mapping[str, tuple[float, float]]) -> Picture:
    """Bars of the mean time [s] of two to five laws, without and with a last turn on the spot.

    seconds: from a law's name to both; NaN, where it does not park, is drawn as a cross.
    """
    check_count("seconds", seconds, 2, len(SERIES))
    table = real("seconds", [*seconds.values()], low=0.0, nan=True)
    figure, axes = new_figure(7.0, 3.6)
    places = np.arange(len(seconds))
    looks = (("without", "path", None, -0.2), ("with a last turn", "y_error", "//", 0.2))
    for row, (label, role, hatch, aside) in zip(np.transpose(table), looks, strict=True):
        height = np.nan_to_num(row)
        bars = {"color": COLOURS[role], "hatch": hatch, "ec": COLOURS["ink"], "label": label}
        axes.bar(places + aside, height, 0.4, **bars)
        never = places[np.isnan(row)] + aside
        axes.plot(never, np.full(never.size, 0.5), "x", color=COLOURS["ink"], ms=9, mew=2)
    for place, name in zip(places, seconds, strict=True):
        note(axes, name, (place, 0.0), (0, -6), ha="center", va="top")
    axes.tick_params(axis="x", labelbottom=False, length=0)
    axes.grid(visible=False, axis="x")
    axes.set_ylabel("mean time [s]")
    figure_legend(figure)
    words = [
        f"{name} {_seconds_text(without)} without and {_seconds_text(turned)} with a last turn"
        for name, (without, turned) in seconds.items()
    ]
    return Picture(figure, f"Mean time to park, a pair of bars for each law: {'; '.join(words)}.")


def _seconds_text(seconds: float) -> str:
    return "never" if math.isnan(seconds) else f"{seconds:.1f} s"
