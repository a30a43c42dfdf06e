"""What the figures of several chapters share."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Sized

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from wmrbook.figures.style import LINES, STYLE
from wmrlib.checks import instance, refusal
from wmrlib.runs import Trajectory, with_samples

SERIES = (  # the colour's role and the line style of each of up to five runs
    ("path", "-"),
    ("y_error", "--"),
    ("omega", "-."),
    ("ink", (0, (6, 1.5, 1, 1.5, 1, 1.5))),
    ("robot", ":"),
)


def panels(rows: int, columns: int, width: float, height: float, **options):
    """A figure outside pyplot, and the array of its axes."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(width, height), layout="constrained")
        return figure, figure.subplots(rows, columns, **options)


def note(axes: Axes, text: str, at, offset=(0, 0), **looks) -> None:
    """A text `offset` points from a place in data coordinates."""
    axes.annotate(text, at, xytext=offset, textcoords="offset points", **looks)


def pointer(axes: Axes, tail, tip, colour: str, zorder: float | None = None, **looks) -> None:
    """An arrow from tail to tip."""
    looks = {"arrowstyle": "-|>", "color": colour, "shrinkA": 0, "shrinkB": 0} | looks
    more = {} if zorder is None else {"zorder": zorder}
    axes.annotate("", tip, tail, arrowprops=looks, **more)


def legend_above(axes: Axes, columns: int, handles=None) -> None:
    above = {"loc": "lower center", "bbox_to_anchor": (0.5, 1.0), "ncols": columns}
    axes.legend(handles=handles, frameon=False, fontsize=11, **above)


def figure_legend(figure: Figure) -> None:
    """The legend of a figure's first axes above it, in as many columns as fit."""
    labels = figure.axes[0].get_legend_handles_labels()[1]
    width = 0.7 + 0.11 * max(map(len, labels))  # inches an entry, handle included
    columns = max(1, min(len(labels), int(figure.get_figwidth() / width)))
    rows = -(-len(labels) // columns)
    columns = -(-len(labels) // rows)
    figure.legend(loc="outside upper center", ncols=columns, frameon=False)


def check_count(name: str, entries: Sized, least: int, most: int) -> None:
    if not least <= len(entries) <= most:
        needed = f"{most}" if least == most else f"{least} to {most}"
        raise ValueError(
            f"{name} has {len(entries)} entries, which is not allowed: {needed} are needed"
        )


def check_series(runs: Mapping, kind: type = object) -> None:
    """One to five entries of a mapping, each a `kind`; a Trajectory has a sample."""
    check_count("runs", instance("runs", runs, Mapping), 1, len(SERIES))
    for label, run in runs.items():
        name = f"runs[{label!r}]"
        with_samples(name, run) if kind is Trajectory else instance(name, run, kind)


def run_list(
    runs: Trajectory | Sequence[Trajectory], labels: Sequence[str] = ()
) -> list[Trajectory]:
    """One run or several as a list of at most four, with one label each, or none."""
    runs = [runs] if isinstance(runs, Trajectory) else list(runs)
    check_count("runs", runs, 1, len(LINES))
    if isinstance(labels, str | Trajectory) or not all(isinstance(it, str) for it in labels):
        raise refusal("labels", labels, "a list with a str for each run, such as ['a', 'b'],")
    if len(labels) not in (0, len(runs)):
        needed = f"one for each of the {len(runs)} runs is needed"
        raise ValueError(f"labels has {len(labels)} entries, which is not allowed: {needed}")
    for k, run in enumerate(runs):
        with_samples(f"runs[{k}]", run)
    return runs
