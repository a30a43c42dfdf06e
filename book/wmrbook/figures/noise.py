"""Chapter 9: where robots stop, by the memory of their receivers."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from wmrbook.figures._drawing import check_count, figure_legend
from wmrbook.figures.style import COLOURS, LINES, Picture, new_figure
from wmrlib.checks import instance, real, same_shape

_ROLES = "path", "y_error", "omega", "ink"


def memories(memory: np.ndarray, series: Mapping[str, tuple[np.ndarray, np.ndarray]]) -> Picture:
    """Distance [m] and heading error [deg] at the end over the memory [s] of a receiver's error.

    series: from a name to (distance, heading error), up to four, each as long as `memory`. A memory
    of 0 is called white, one above 1e6 s constant.
    """
    memory = real("memory", memory)
    check_count("series", instance("series", series, Mapping), 1, len(LINES))
    figure, rows = new_figure(7.5, 5.6, rows=2)
    texts, at = [], np.arange(memory.size)
    looks = zip(LINES, _ROLES, "os^D", strict=True)
    for (name, left), (style, role, marker) in zip(series.items(), looks, strict=False):
        for axes, values in zip(rows, left, strict=True):
            same_shape(memory=memory, **{f"series[{name!r}]": values})
            label = name if axes is rows[0] else None  # once in the legend
            axes.plot(at, values, style, marker=marker, color=COLOURS[role], label=label)
        worst = int(np.argmax(left[1]))
        texts.append(
            f"{name}, from {left[0][0]:.1f} m and about {_fives(left[1][0])} deg to "
            f"{left[0][-1]:.1f} m and {_fives(left[1][-1])} deg, the heading worst, about "
            f"{_fives(left[1][worst])} deg, at {_named(memory[worst])}"
        )
    rows[0].set(ylabel="distance, rms [m]", ylim=(0.0, None))
    rows[1].set(ylabel="heading error, rms [deg]", ylim=(0.0, None))
    rows[1].set_xlabel("memory of the receiver's error [s]")
    rows[1].set_xticks(at, [_named(value).removesuffix(" s") for value in memory])
    figure.align_ylabels()
    figure_legend(figure)
    what = "Distance and heading error at the end over the memory, from"
    span = f"{_named(memory[0])} to {_named(memory[-1])}"
    return Picture(figure, f"{what} {span}: {'; '.join(texts)}.")


def _named(memory: float) -> str:
    return "white" if memory == 0.0 else "constant" if memory > 1e6 else f"{memory:g} s"


def _fives(value: float) -> int:
    return 5 * round(float(value) / 5)
