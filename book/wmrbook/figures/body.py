"""Chapter 11: which gains still park once the robot has a body."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from wmrbook.figures._drawing import panels
from wmrbook.figures.style import COLOURS, Picture

_PARKED, _NEAR = 5.0, 15.0  # deg
_MARKS = (  # up to which heading error, deg, and how it is drawn
    (_PARKED, f"within {_PARKED:.0f} deg", {"marker": "o", "color": COLOURS["path"]}),
    (_NEAR, f"within {_NEAR:.0f} deg", {"marker": "o", "mfc": "none", "color": COLOURS["path"]}),
    (np.inf, "farther off, or nowhere", {"marker": "x", "color": COLOURS["y_error"]}),
)


def body_windows(
    kappas: Sequence[float], weights: Sequence[float], off_deg: Mapping[str, np.ndarray]
) -> Picture:
    """For each robot, its heading error [deg] at each of the `kappas` and of the `weights`, h.

    NaN stands where it does not arrive. The lines enclose the window, 2 < kappa < 1 + h.
    """
    figure, row = panels(1, len(off_deg), 2.5 * len(off_deg) + 0.4, 3.9, sharey=True)
    kappa, h = np.meshgrid(kappas, weights, indexing="ij")
    inside = (kappa > 2.0) & (kappa < 1.0 + h)
    told = []
    for axes, (name, error) in zip(row, off_deg.items(), strict=True):
        size, low = np.nan_to_num(np.abs(error), nan=np.inf), -1.0
        for high, words, looks in _MARKS:
            drawn = (size > low) & (size <= high)
            axes.plot(kappa[drawn], h[drawn], ls="none", ms=6, label=words, **looks)
            low = high
        edge = np.array([2.0, max(kappas) + 0.3])
        axes.plot([2.0, *edge], [max(weights) + 0.3, *(edge - 1.0)], color=COLOURS["ink"], lw=1.2)
        axes.set(title=name, xlabel="kappa [1]", xlim=(0.0, edge[1]))
        axes.set(ylim=(-0.3, max(weights) + 0.3))
        parked = np.count_nonzero(size[inside] <= _PARKED)
        told.append(f"{name} {parked} of the {np.count_nonzero(inside)} gains inside")
    row[0].set_ylabel("h [1]")
    figure.legend(*row[0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    return Picture(
        figure,
        f"Which gains end within {_PARKED:.0f} deg of the goal's heading, over kappa and h, with "
        f"the window 2 < kappa < 1 + h as lines: {'; '.join(told)}.",
    )
