"""Chapter 9: what noise, bias and delay do to positions, to arrivals and to V."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.patches import Circle

from wmrbook.figures._drawing import check_count, figure_legend, legend_above, note
from wmrbook.figures.style import COLOURS, LINES, Picture, new_figure
from wmrbook.scatter import StationaryScatter
from wmrlib._checks import instance, real, same_shape

_COUNTS = {1: "last", 2: "last two", 3: "last three", 4: "last four"}


def scatter(spread: StationaryScatter) -> Picture:
    """The positions [m] of a receiver at rest about their mean; the circle holds half of them.

    They are joined in order; if the last ones are equal, the picture says how many they are.
    """
    instance("spread", spread, StationaryScatter)
    figure, axes = new_figure(7.5, 3.9)
    east, north = spread.east, spread.north
    axes.plot(east, north, "-", color=COLOURS["path"], lw=1.2)
    axes.plot(east, north, "o", color=COLOURS["path"], ms=6, label="positions, in order")
    axes.plot(0.0, 0.0, "+", color=COLOURS["ink"], ms=16, mew=2.5, label="mean")
    axes.add_patch(Circle((0.0, 0.0), spread.cep, fill=False, ls="--", ec=COLOURS["ink"]))
    half = f"half of them within {spread.cep:.1f} m (CEP)"
    axes.plot([], [], "--", color=COLOURS["ink"], lw=1.0, label=half)
    places = np.column_stack([east, north])
    at_last = np.isclose(places, places[-1], rtol=0.0, atol=1e-3).all(axis=1)
    count = int(np.argmin([*at_last[::-1], False]))  # how many stay where the last is
    last = _COUNTS.get(count, f"last {count}")
    for k, name in ((0, "first"), (-1, last)):
        note(axes, name, places[k], (0, 9), ha="center", fontsize=11)
    left, right = min(east.min(), -spread.cep) - 1.0, max(east.max(), spread.cep) + 1.0
    height = 1.15 * max(np.abs(north).max(), spread.cep)
    axes.set(xlim=(left, right), ylim=(-height, height), aspect="equal")
    axes.set(xlabel="east of the mean [m]", ylabel="north of the mean [m]")
    legend_above(axes, 3, fontsize=10)
    dot = "" if count == 1 else f", where the {last} are one dot"
    return Picture(
        figure,
        f"{spread.n} positions about their mean, joined in order: they walk from "
        f"{_compass(*places[0])} to {_compass(*places[-1])}{dot}; "
        f"a dashed circle of {spread.cep:.1f} m holds half of them; the standard deviation is "
        f"{spread.std_east:.1f} m east and {spread.std_north:.1f} m north.",
    )


def memories(memory: np.ndarray, series: Mapping[str, tuple[np.ndarray, np.ndarray]]) -> Picture:
    """Distance [m] and heading error [deg] at the end over the memory [s] of a receiver's error.

    series: from a name to (distance, heading error), up to four, each as long as `memory`. A memory
    of 0 is called white, one above 1e6 s constant.
    """
    memory = real("memory", memory)
    check_count("series", instance("series", series, Mapping), 1, len(LINES))
    figure, rows = new_figure(7.5, 5.6, rows=2)
    texts, at = [], np.arange(memory.size)
    roles = "path", "y_error", "omega", "ink"
    for (name, left), style, role, marker in zip(
        series.items(), LINES, roles, "os^D", strict=False
    ):
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


def _compass(east: float, north: float) -> str:
    along, across = ("west" if east < 0 else "east"), ("south" if north < 0 else "north")
    return f"{abs(east):.1f} m {along} and {abs(north):.1f} m {across}"


def designs(
    memory: np.ndarray, place: Mapping[str, np.ndarray], heading: Mapping[str, np.ndarray]
) -> Picture:
    """Distance [m] and heading error [deg] of some designs, a dot for each receiver.

    memory: the receivers' memories [s], of which up to four differ. place, heading: from the
    design's name to an array as long as `memory`.
    """
    memory = real("memory", memory)
    check_count("place", instance("place", place, Mapping), 1, 9)
    check_count("heading", instance("heading", heading, Mapping), len(place), len(place))
    kinds = np.unique(memory)
    check_count("memory's values", kinds, 1, 4)
    figure, axes = new_figure(8.6, 1.6 + 0.42 * len(place), mosaic=[["place", "heading"]])
    texts = []
    for row, name in enumerate(place):
        left = place[name], instance("heading", heading.get(name), np.ndarray)
        same_shape(memory=memory, **{f"place[{name!r}]": left[0], f"heading[{name!r}]": left[1]})
        for panel, values in zip(axes.values(), left, strict=True):
            for k, (kind, role) in enumerate(zip(kinds, _ROLES, strict=False)):
                at = -row + 0.16 * (1.5 - k)
                some = values[memory == kind]
                looks = {"marker": "os^D"[k], "ms": 5, "ls": "", "color": COLOURS[role]}
                first = panel is axes["place"] and not row
                label = f"memory {_named(kind)}" if kind else "white noise"
                looks["label"] = label if first else None
                panel.plot(some, np.full(some.size, at), alpha=0.8, **looks)
        span = (f"{values.min():.1f} to {values.max():.1f}" for values in left)
        texts.append(f"{name}, {next(span)} m and {next(span)} deg")
    for panel in axes.values():
        panel.set_yticks(-np.arange(len(place)))
        panel.tick_params(labelleft=False)
    for row, name in enumerate(place):
        across = axes["place"].get_yaxis_transform()
        axes["place"].text(-0.03, -row, name, transform=across, ha="right", va="center")
    axes["place"].set(xlabel="distance, rms [m]", xlim=(0.0, None))
    axes["heading"].set(xlabel="heading error, rms [deg]", xlim=(-3.0, None))
    figure_legend(figure)
    return Picture(figure, f"What is left with {memory.size} receivers: {'; '.join(texts)}.")


_ROLES = "path", "y_error", "omega", "ink"
