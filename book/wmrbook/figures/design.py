"""Chapter 6: where the poles of the angles lie, and where a gain moves them."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes

from wmrbook.figures._drawing import note
from wmrbook.figures.style import COLOURS, Picture, new_figure
from wmrlib.checks import choice, instance, real
from wmrlib.gains import Gains
from wmrlib.tuning import modes


def root_locus(gains: Gains, over: str, values: np.ndarray) -> Picture:
    """The two poles of the angles [1/s] as the gain named `over` runs through `values`.

    Crosses are the poles of `gains` itself, the square is the distance's pole, and the thin lines
    are those of equal damping.
    """
    instance("gains", gains, Gains)
    choice("over", over, Gains._fields)
    values = _with_meeting(gains, over, np.sort(real("values", values)))
    here, path = modes(gains), modes(gains._replace(**{over: values}))
    poles, at = np.array(path.poles[1:]), np.array(here.poles[1:])
    figure, axes = new_figure(6.5, 5.0)
    names = "slow or upper pole", "fast or lower pole"
    for pole, style, name in zip(poles, ("-", "--"), names, strict=True):
        axes.plot(pole.real, pole.imag, style, color=COLOURS["path"], label=name)
    value = f"{over} = {getattr(gains, over):g}"
    axes.plot(at.real, at.imag, "x", ms=11, mew=3, color=COLOURS["y_error"], label=value)
    distance_pole = here.poles[0].real
    square = {"ms": 9, "color": COLOURS["ink"], "label": "the distance's pole"}
    axes.plot(distance_pole, 0.0, "s", **square)
    reach = 1.15 * max(np.abs(poles.imag).max(), np.abs(at.imag).max(), 0.5)
    left = 1.15 * min(poles.real.min(), at.real.min(), distance_pole)
    _draw_dampings(axes, left, reach)
    axes.axvline(0.0, color=COLOURS["ink"], lw=0.8)
    axes.set(xlim=(left, -0.06 * left), xlabel="real part [1/s]")
    axes.set(ylim=(-reach, reach), ylabel="imaginary part [rad/s]")
    figure.legend(loc="outside upper center", ncols=2)
    return Picture(
        figure,
        f"Root locus of the angles for {over} from {values[0]:g} to {values[-1]:g}. "
        f"{_course(poles)} At {value} the damping is {here.damping:.3f} and the natural frequency "
        f"{here.natural_frequency:.2f} rad/s; the distance's pole is at {distance_pole:.2f}.",
    )


def _draw_dampings(axes: Axes, left: float, reach: float) -> None:
    """Lines of equal damping, each with its value at its lower end."""
    for damping in (0.1, 0.3, 0.7):
        slope = math.sqrt(1.0 - damping**2) / damping
        x = max(left, -reach / slope)
        for side in (1, -1):
            axes.plot([0.0, x], [0.0, -side * slope * x], ":", color=COLOURS["ink"], lw=0.9)
        at_left_axis = x < 0.95 * left  # there the label moves inside
        offset, ha = ((6, -8), "left") if at_left_axis else ((-4, -2), "right")
        note(axes, f"{damping}", (x, -slope * x), offset, ha=ha, va="top")


def _course(poles: np.ndarray) -> str:
    """What the pair does as the gain grows; poles has one row a pole."""
    pair = np.abs(poles.imag).max(axis=0) > 1e-9
    if not pair.any():
        return "Both poles stay real."
    size, real_part = np.abs(poles[0, pair]), poles.real[0, pair]
    if np.ptp(size) < 1e-6 * size.max():
        end = "." if pair[-1] else " to the real axis and parts there."
        return f"The pair runs on a circle of {size[0]:.2f} rad/s{end}"
    if np.ptp(real_part) < 1e-6 * size.max():
        place = f"{real_part[0]:.2f}"
        if pair[0]:
            return f"The pair runs straight up and down at {place}."
        return f"The two poles meet at {place}, and the pair then runs straight up and down."
    return f"The pair runs from {size[0]:.2f} to {size[-1]:.2f} rad/s."


def _with_meeting(gains: Gains, over: str, values: np.ndarray) -> np.ndarray:
    """The values, and those at which the two poles meet, so that no line cuts that corner."""
    from scipy.optimize import brentq  # here, because it takes half a second to load

    def excess(value):
        return modes(gains._replace(**{over: value})).damping - 1.0

    short = excess(values) < 0.0
    at = np.flatnonzero(short[1:] != short[:-1])
    meetings = [brentq(excess, values[i], values[i + 1]) for i in at]
    return np.sort(np.concatenate([values, meetings]))
