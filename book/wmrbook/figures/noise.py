"""Chapter 9: what noise, bias and delay do to positions, to arrivals and to V."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from wmrbook.figures._drawing import check_count, figure_legend
from wmrbook.figures.style import COLOURS, LINES, Picture, new_figure
from wmrlib.checks import instance, real, same_shape

_ROLES = "path", "y_error", "omega", "ink"


def at_rest(
    times: np.ndarray,
    logs: Mapping[str, tuple[np.ndarray, np.ndarray]],
    bands: Mapping[str, tuple[np.ndarray, np.ndarray]],
) -> Picture:
    """Allan deviation [m] and autocorrelation of logs at rest, and bands of autocorrelations.

    times: spans and lags [s]. logs: from a name to both, each as long as `times`; bands: from a
    name to the lowest and the highest autocorrelation. Both have up to four.
    """
    times = real("times", times, above=0.0)
    for name, given in (("logs", logs), ("bands", bands)):
        check_count(name, instance(name, given, Mapping), 1, len(LINES))
    figure, rows = new_figure(7.5, 5.6, rows=2)
    texts = []
    for (name, curves), style, role in zip(logs.items(), LINES, _ROLES, strict=False):
        for axes, values in zip(rows, curves, strict=True):
            same_shape(times=times, **{f"logs[{name!r}]": values})
            label = name if axes is rows[0] else None  # once in the legend
            axes.plot(times, values, style, color=COLOURS[role], lw=2.2, label=label)
        allan, alike = curves
        texts.append(
            f"{name}, Allan deviation from {allan[0]:.2f} m over {times[0]:g} s to at most "
            f"{allan.max():.2f} m over {times[allan.argmax()]:.0f} s, autocorrelation "
            f"{alike[-1]:.1f} after {times[-1]:.0f} s"
        )
    white = rows[0].get_lines()[0].get_ydata()[0] * np.sqrt(times[0] / times)
    rows[0].plot(times, white, color=COLOURS["start"], lw=1.0, label="slope of white noise")
    for (name, (low, high)), style, role in zip(
        bands.items(), LINES, ("alpha", "robot", "ink", "goal"), strict=False
    ):
        same_shape(times=times, low=low, high=high)
        style_options = {"color": COLOURS[role], "lw": 1.3}
        rows[0].plot([], [], style, **style_options, label=name)
        rows[1].plot(times, low, style, times, high, style, **style_options)
        ends = f"from {low[-1]:.1f} to {high[-1]:.1f}"
        texts.append(f"{name}, autocorrelation {ends} after {times[-1]:.0f} s")
    rows[0].set(xscale="log", yscale="log", ylabel="Allan deviation [m]")
    rows[1].set(ylabel="autocorrelation [1]", xlabel="span, or lag [s]")
    figure.align_ylabels()
    figure_legend(figure)
    over = f"Over spans and lags of {times[0]:g} to {times[-1]:g} s"
    return Picture(figure, f"{over}: {'; '.join(texts)}.")


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
