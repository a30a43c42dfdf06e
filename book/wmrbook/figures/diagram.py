"""The block diagram: from GPS points to the turning of wheels and back."""

from __future__ import annotations

from itertools import pairwise

from matplotlib.patches import FancyBboxPatch

from wmrlib._checks import scalar
from wmrlib.plots.picture import Picture
from wmrlib.plots.style import COLOURS, new_figure

# name, what it does, colour
_BOXES = (
    ("GPS", "two points,\ntwo headings", "start"),
    ("geodesy", "(11)-(17):\ngoal in metres", "start"),
    ("polar error", "Fig. 2: rho,\nalpha, theta", "path"),
    ("control law", "(22), (24) corrected:\nv and omega", "path"),
    ("wheel loop", "(1), (2): left and\nright wheel", "goal"),
    ("robot", "(3)-(6): x, y,\nheading", "robot"),
)
_SIGNALS = ("lat, lon", "goal pose", "polar error", "v, omega", "wheel speeds")


def block_diagram(time_step: float, times_faster: float) -> Picture:
    """The controller's structure: GPS, geodesy, polar error, law, inner wheel loop and robot, with the pose fed back (the paper's Fig. 3).

    time_step: of the outer loop, s; times_faster: how many times in it the wheel loop acts. Raises ValueError unless both are positive.
    """
    time_step, times_faster = (
        scalar("time_step", time_step, above=0.0),
        scalar("times_faster", times_faster, above=0.0),
    )
    inner = time_step / times_faster
    figure, axes = new_figure(9.0, 5.2)
    axes.set_axis_off()
    axes.set(xlim=(0.0, 9.0), ylim=(0.0, 5.0))
    width, height = 2.0, 1.2
    centres = [
        (1.2, 4.1),
        (4.5, 4.1),
        (7.8, 4.1),
        (7.8, 1.5),
        (4.5, 1.5),
        (1.2, 1.5),
    ]  # row by row, there and back
    for (name, does, colour), (x, y) in zip(_BOXES, centres, strict=True):
        corner = (x - width / 2, y - height / 2)
        axes.add_patch(
            FancyBboxPatch(
                corner,
                width,
                height,
                boxstyle="round,pad=0.06",
                fc="white",
                ec=COLOURS[colour],
                lw=2.5,
            )
        )
        axes.text(x, y + 0.32, name, ha="center", va="center", weight="bold", fontsize=13)
        axes.text(x, y - 0.2, does, ha="center", va="center", fontsize=11)
    ends = list(pairwise(centres))
    for signal, ((x0, y0), (x1, y1)) in zip(_SIGNALS, ends, strict=True):
        across = y0 == y1
        side = 1.0 if x1 > x0 else -1.0
        tail, tip = (
            ((x0 + side * 1.08, y0), (x1 - side * 1.08, y1))
            if across
            else ((x0, y0 - 0.68), (x1, y1 + 0.68))
        )
        _arrow(axes, tail, tip)
        label = ((x0 + x1) / 2, y0 + 0.2) if across else (x0 + 0.12, (y0 + y1) / 2)
        axes.text(*label, signal, ha="center" if across else "left", va="center", fontsize=10.5)
    # the pose goes back to where the error is formed
    axes.plot([1.2, 1.2, 7.2, 7.2], [2.18, 2.8, 2.8, 3.0], color=COLOURS["ink"], lw=2.0)
    _arrow(axes, (7.2, 2.98), (7.2, 3.42))
    axes.text(
        4.2, 3.0, f"pose, fed back every {time_step:g} s", ha="center", va="center", fontsize=11
    )
    axes.plot([1.2, 1.2, 4.5], [0.82, 0.4, 0.4], color=COLOURS["goal"], lw=2.0, ls="--")
    _arrow(axes, (4.5, 0.4), (4.5, 0.82), colour="goal", style="--")
    axes.text(
        2.85,
        0.15,
        f"wheel speeds, fed back every {inner:g} s",
        ha="center",
        va="center",
        fontsize=11,
    )
    alt = (
        "Block diagram: "
        + " to ".join(name for name, _, _ in _BOXES)
        + f"; the pose is fed back to the polar error every {time_step:g} s, "
        f"the wheel speeds to the wheel loop every {inner:g} s."
    )
    return Picture(figure, alt)


def _arrow(axes, tail, tip, colour: str = "ink", style: str = "-") -> None:
    axes.annotate(
        "",
        tip,
        tail,
        arrowprops={
            "arrowstyle": "-|>",
            "color": COLOURS[colour],
            "lw": 2.0,
            "ls": style,
            "shrinkA": 0,
            "shrinkB": 0,
        },
    )
