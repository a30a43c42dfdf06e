"""Chapter 10: the verdicts of the audit."""

from __future__ import annotations

from collections.abc import Mapping

from wmrbook.figures._drawing import check_count
from wmrbook.figures.style import COLOURS, Picture, new_figure

_LOOKS = (("#56B4E9", ""), ("#F0E442", "//"), ("#D55E00", "xx"), ("#BBBBBB", ".."))


def verdicts(counts: Mapping[str, Mapping[str, int]]) -> Picture:
    """Bars, one for each group, divided by up to four verdicts.

    counts: from a group to how many of its rows have each verdict.
    """
    names = list(next(iter(counts.values()), {}))
    check_count("counts", names, 1, len(_LOOKS))
    figure, axes = new_figure(7.5, 0.7 * len(counts) + 1.8)
    ends = dict.fromkeys(counts, 0)
    box = {"boxstyle": "round,pad=0.15", "fc": "white", "ec": "none"}
    centred = {"ha": "center", "va": "center", "bbox": box}
    for name, (colour, hatch) in zip(names, _LOOKS, strict=False):
        widths = [counts[group][name] for group in counts]
        looks = {"color": colour, "hatch": hatch, "ec": COLOURS["ink"], "label": name}
        axes.barh(list(counts), widths, left=list(ends.values()), **looks)
        for place, (group, width) in enumerate(zip(counts, widths, strict=True)):
            if width:
                axes.text(ends[group] + width / 2, place, str(width), **centred)
            ends[group] += width
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    axes.set(xlabel="rows [number]", ylabel="what the paper says [kind]")
    figure.legend(loc="outside upper center", ncols=len(names))
    parts = [
        f"{group}: " + ", ".join(f"{n} {name}" for name, n in row.items() if n)
        for group, row in counts.items()
    ]
    return Picture(figure, f"Bars of how many rows have each verdict. {'; '.join(parts)}.")
