"""Chapters 4 and 10: V and the heading error along runs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from wmrbook.figures._drawing import legend_above, run_list
from wmrbook.figures.style import COLOURS, LINES, Picture, new_figure
from wmrlib.laws import law_name
from wmrlib.runs import Trajectory

_TINTS = tuple(COLOURS[role] for role in ("ink", "omega", "path", "y_error"))


def heading_errors(runs: Trajectory | Sequence[Trajectory], labels: Sequence[str] = ()) -> Picture:
    """The heading error theta - alpha of one to four runs over time, in degrees and not wrapped."""
    runs = run_list(runs, labels)
    names = list(labels) or [law_name(run.law) if run.law else "the poses given" for run in runs]
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
