"""Figures of an audit."""

from __future__ import annotations

from collections.abc import Mapping

from wmrlib.plots.picture import Picture
from wmrlib.plots.style import new_figure

_LOOKS = (("#56B4E9", ""), ("#F0E442", "//"), ("#D55E00", "xx"), ("#BBBBBB", ".."))


def verdicts(counts: Mapping[str, Mapping[str, int]]) -> Picture:
    """Bars, one for each group, divided by verdict; counts: from group to (from verdict to how many rows have it).

    Each verdict has a colour and a hatching of its own, and its number stands in the bar. Raises ValueError if there is nothing to draw,
    or if there are more than four verdicts.
    """
    names = list(next(iter(counts.values()), {}))
    if not 1 <= len(names) <= len(_LOOKS):
        raise ValueError(
            f"counts has {len(names)} verdicts, which is not allowed: 1 to {len(_LOOKS)} are needed"
        )
    figure, axes = new_figure(7.5, 0.7 * len(counts) + 1.8)
    ends = dict.fromkeys(counts, 0)
    for name, (colour, hatch) in zip(names, _LOOKS, strict=False):
        widths = [counts[group][name] for group in counts]
        axes.barh(
            list(counts),
            widths,
            left=list(ends.values()),
            color=colour,
            hatch=hatch,
            ec="#222222",
            label=name,
        )
        for place, (group, width) in enumerate(zip(counts, widths, strict=True)):
            if width:
                box = {"boxstyle": "round,pad=0.15", "fc": "white", "ec": "none"}
                axes.text(
                    ends[group] + width / 2,
                    place,
                    str(width),
                    ha="center",
                    va="center",
                    bbox=box,
                    fontsize=11,
                )
            ends[group] += width
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    axes.set(xlabel="rows [number]", ylabel="what the paper says [kind]")
    figure.legend(loc="outside upper center", ncols=len(names))
    parts = [
        f"{group}: " + ", ".join(f"{n} {name}" for name, n in row.items() if n)
        for group, row in counts.items()
    ]
    return Picture(figure, "Bars of how many rows have each verdict. " + "; ".join(parts) + ".")
