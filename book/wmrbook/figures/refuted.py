"""Chapter 10: where V rises under the law as printed."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from matplotlib.patches import Patch

from wmrbook.figures._drawing import legend_above
from wmrbook.figures.style import COLOURS, Picture, new_figure

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
