"""Chapters 4 and 10: V as a bowl, and V and the heading error along runs."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from wmrbook.figures._drawing import legend_above, panels, run_list
from wmrbook.figures.style import COLOURS, LINES, Picture, new_figure
from wmrlib.control import lyapunov
from wmrlib.gains import Gains
from wmrlib.runs import Trajectory

_TINTS = tuple(COLOURS[role] for role in ("ink", "omega", "path", "y_error"))
_ROUND = np.linspace(0.0, 2.0 * math.pi, 61)


def bowl(gains: Gains, runs: Trajectory | Sequence[Trajectory]) -> Picture:
    """The angles' part of V as a bowl over alpha and theta [deg], and one to four runs in it."""
    runs = run_list(runs)
    heights = [lyapunov(0.0, run.alpha, run.theta, gains.h) for run in runs]
    rim = 1.05 * max(height.max() for height in heights)
    figure, axes = panels(1, 1, 6.8, 5.6, subplot_kw={"projection": "3d"})
    radius, turn = np.meshgrid(np.sqrt(2.0 * rim) * np.linspace(0, 1, 25), _ROUND)
    across = radius * np.cos(turn), radius * np.sin(turn) / math.sqrt(gains.h)
    looks = {"color": COLOURS["V"], "alpha": 0.16, "linewidth": 0, "shade": False}
    axes.plot_surface(*np.degrees(across), 0.5 * radius**2, rcount=61, ccount=25, **looks)
    for k in range(4, 25, 4):
        ring = np.degrees(across)[:, :, k]
        axes.plot(*ring, 0.5 * radius[:, k] ** 2, color=COLOURS["V"], lw=0.8, alpha=0.7)
    words = []
    for run, height, style, colour in zip(runs, heights, LINES, _TINTS, strict=False):
        way = *np.degrees([run.alpha, run.theta]), height
        axes.plot(*way, style, color=colour, lw=2.5, zorder=10)
        axes.plot(*([each[0]] for each in way), "o", ms=8, color=COLOURS["start"], zorder=11)
        falls = "falling all the way" if np.diff(height).max() < 1e-9 * rim else "rising at times"
        words.append(f"a run goes from {_place(run, 0)} to {_place(run, -1)}, {falls}")
    axes.plot([0.0], [0.0], [0.0], "s", ms=8, color=COLOURS["goal"], zorder=11)
    axes.set(xlabel="alpha [deg]", ylabel="theta [deg]", zlabel="V of the angles [1]")
    axes.set(xticks=range(-180, 181, 90), yticks=range(-90, 91, 90))
    axes.view_init(elev=38.0, azim=-60.0)
    axes.set_box_aspect((1.0, 1.0, 0.7), zoom=0.9)
    return Picture(
        figure,
        f"V of the angles as a bowl over alpha and theta, with its bottom at (0, 0) deg and its "
        f"rim at {rim:.1f}: {'; '.join(words)}.",
    )


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


def _place(run: Trajectory, k: int) -> str:
    alpha, theta = (math.degrees(field[k]) for field in (run.alpha, run.theta))
    return f"({round(alpha)}, {round(theta)}) deg"
