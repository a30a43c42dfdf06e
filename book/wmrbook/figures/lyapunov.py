"""Chapters 4 and 10: V and the heading error along runs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D

from wmrbook.figures._drawing import legend_above, run_list
from wmrbook.figures.style import COLOURS, LINES, Picture, new_figure
from wmrlib.runs import Trajectory

_TINTS = tuple(COLOURS[role] for role in ("ink", "omega", "path", "y_error"))


def lyapunov_runs(runs: Trajectory | Sequence[Trajectory], labels: Sequence[str] = ()) -> Picture:
    """V over time of one to four runs on a logarithmic scale, thick and red wherever V rises."""
    runs = run_list(runs)
    names = _names(runs, labels)
    figure, axes = new_figure(7.5, 4.2)
    red = {"color": COLOURS["V_rising"], "lw": 6.0, "alpha": 0.55}
    words, handles = [], []
    for run, name, style, colour in zip(runs, names, LINES, _TINTS, strict=False):
        values = np.maximum(run.V, 1e-12)
        axes.plot(run.t, values, style, color=colour)
        rising = np.diff(run.V) > 1e-9 * run.V[0]
        points = np.column_stack([run.t, values])
        pieces = np.stack([points[:-1], points[1:]], axis=1)[rising]
        axes.add_collection(LineCollection(pieces, **red))
        handles.append(Line2D([], [], color=colour, ls=style, label=name))
        ups = f"it rises, to {run.V.max():.2g} at most" if rising.any() else "it never rises"
        words.append(f"{name}: from {run.V[0]:.2g} to {run.V[-1]:.2g}, {ups}")
    handles.append(Line2D([], [], label="rising", **red))
    legend_above(axes, len(handles), handles)
    axes.set(xlabel="time [s]", ylabel="V [1]", yscale="log")
    axes.margins(x=0.01)
    return Picture(figure, f"V over time on a logarithmic scale. {'; '.join(words)}.")


def heading_errors(runs: Trajectory | Sequence[Trajectory], labels: Sequence[str] = ()) -> Picture:
    """The heading error theta - alpha of one to four runs over time, in degrees and not wrapped."""
    runs = run_list(runs)
    names = _names(runs, labels)
    figure, axes = new_figure(7.5, 3.8)
    axes.axhline(0.0, color=COLOURS["ink"], lw=0.8)
    words = []
    for run, name, style, colour in zip(runs, names, LINES, _TINTS, strict=False):
        error = np.degrees(run.theta - run.alpha)
        axes.plot(run.t, error, style, color=colour, label=name)
        words.append(f"{name}: at most {np.abs(error).max():.0f} deg off")
    legend_above(axes, len(runs))
    axes.set(xlabel="time [s]", ylabel="heading error [deg]")
    axes.margins(x=0.01)
    return Picture(figure, f"Heading error over time. {'; '.join(words)}.")


def _names(runs: list[Trajectory], labels: Sequence[str]) -> list[str]:
    names = list(labels) or [run.law for run in runs]
    if len(names) == len(runs):
        return names
    raise ValueError(
        f"labels has {len(names)} entries, which is not allowed: "
        f"one for each of the {len(runs)} runs is needed"
    )
