"""Chapter 10: where V rises beside the goal, and the verdicts of the audit."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from matplotlib.patches import Patch

from wmrbook.figures._drawing import check_count, legend_above
from wmrlib.plots.style import COLOURS, Picture, new_figure

_LOOKS = (("#56B4E9", ""), ("#F0E442", "//"), ("#D55E00", "xx"), ("#BBBBBB", ".."))

_RISING = "#F7C9A8"


def sign_of_rate(rate: Callable) -> Picture:
    """Where V rises (hatched) and falls (white) beside the goal, over alpha and theta in degrees.

    rate: a function from arrays of alpha and theta [rad] to the limit of V' [1/s] as rho goes to 0.
    """
    middles = (np.arange(361) + 0.5) / 361 * 360.0 - 180.0
    grid = np.meshgrid(middles, middles)
    values = rate(*np.radians(grid))
    share = f"{100 * np.mean(values > 0.0):.0f} %"
    figure, axes = new_figure(6.0, 5.2)
    levels = [0.0, max(1e-9, 1.01 * values.max())]
    axes.contourf(*grid, values, levels=levels, colors=[_RISING], hatches=["///"])
    axes.set(xlabel="alpha [deg]", ylabel="theta [deg]", aspect="equal")
    axes.set(xticks=range(-180, 181, 90), yticks=range(-180, 181, 90))
    looks = {"ec": COLOURS["ink"]}
    rises = Patch(fc=_RISING, hatch="///", label=f"V rises: {share}", **looks)
    legend_above(axes, 2, [rises, Patch(fc="white", label="V falls", **looks)])
    text = "Map of the sign of V' as rho goes to 0, over alpha and theta from -180 to 180 deg: "
    return Picture(figure, f"{text}V rises in the hatched {share} and falls elsewhere.")


def verdicts(counts: Mapping[str, Mapping[str, int]]) -> Picture:
    """Bars, one for each group, divided by up to four verdicts.

    counts: from a group to how many of its rows have each verdict.
    """
    names = list(next(iter(counts.values()), {}))
    check_count("counts", names, 1, len(_LOOKS))
    figure, axes = new_figure(7.5, 0.7 * len(counts) + 1.8)
    ends = dict.fromkeys(counts, 0)
    box = {"boxstyle": "round,pad=0.15", "fc": "white", "ec": "none"}
    centred = {"ha": "center", "va": "center", "bbox": box, "fontsize": 11}
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
