"""Figures of gains: where the poles lie, how the angles settle, and what each choice costs."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from scipy.optimize import brentq

from wmrlib._checks import choice, instance, real
from wmrlib.gains import Gains
from wmrlib.picture import Picture
from wmrlib.plots._style import COLOURS, new_figure
from wmrlib.simulation import Arrival
from wmrlib.tuning import modes

_MARKS = ("X", "D", "P", "v")


def root_locus(gains: Gains, over: str, values: np.ndarray) -> Picture:
    """The two poles of the angles [1/s] as the gain named `over` runs through `values`; crosses: the poles of `gains` itself.

    The square is the distance's pole, the thin lines are those of equal damping. Raises ValueError for a name that is no gain.
    """
    instance("gains", gains, Gains)
    choice("over", over, Gains._fields)
    values = _with_meeting(gains, over, np.sort(real("values", values)))
    here, way = modes(gains), modes(gains._replace(**{over: values}))
    poles = np.array([way.poles[1], way.poles[2]])
    figure, axes = new_figure(6.5, 5.0)
    for pole, style, name in zip(poles, ("-", "--"), ("slow or upper pole", "fast or lower pole"), strict=True):
        axes.plot(pole.real, pole.imag, style, color=COLOURS["path"], label=name)
    at = np.array(here.poles[1:])
    axes.plot(at.real, at.imag, "x", ms=11, mew=3, color=COLOURS["goal"], label=f"{over} = {getattr(gains, over):g}")
    axes.plot(here.poles[0].real, 0.0, "s", ms=9, color=COLOURS["start"], label="the distance's pole")
    reach = 1.15 * max(np.abs(poles.imag).max(), np.abs(at.imag).max(), 0.5)
    left = 1.15 * min(poles.real.min(), at.real.min(), here.poles[0].real)
    for damping in (0.1, 0.3, 0.7):
        slope = math.sqrt(1.0 - damping**2) / damping
        x = max(left, -reach / slope)
        for side in (1, -1):
            axes.plot([0.0, x], [0.0, -side * slope * x], ":", color=COLOURS["ink"], lw=0.9)
        axes.annotate(f"{damping}", (x, -slope * x), xytext=(-4, -2), textcoords="offset points", fontsize=10, ha="right", va="top")
    axes.axvline(0.0, color=COLOURS["ink"], lw=0.8)
    axes.set(xlim=(left, -0.06 * left), ylim=(-reach, reach), xlabel="real part [1/s]", ylabel="imaginary part [rad/s]")
    figure.legend(loc="outside upper center", ncols=2, fontsize=10)
    return Picture(
        figure,
        f"Root locus of the angles for {over} from {values[0]:.2f} to {values[-1]:.2f}: at {over} = {getattr(gains, over):g} "
        f"the damping is {here.damping:.3f} and the natural frequency {here.natural_frequency:.2f} rad/s; "
        f"the distance's pole is at {here.poles[0].real:.2f}.",
    )


def phase_portrait(choices: Mapping[str, Gains], limit: float) -> Picture:
    """How (alpha, theta) flow under the corrected law in the limit rho = 0, up to `limit` rad, one panel for each of the named gains.

    Raises ValueError for no gains, or more than two.
    """
    import sympy as sp

    from wmrlib import symbolic

    if not 1 <= len(choices) <= 2:
        raise ValueError(f"choices has {len(choices)} entries, which is not allowed: 1 or 2 are needed")
    rates = [rate.subs(symbolic.rho, 0) for rate in symbolic.closed_loop()[1:]]
    flow = sp.lambdify((symbolic.alpha, symbolic.theta, symbolic.k_rho, symbolic.k_alpha, symbolic.h, symbolic.v_max), rates)
    side = np.linspace(-limit, limit, 60)  # an even number: no sample at alpha = 0
    alpha, theta = np.meshgrid(side, side)
    names = list(choices)
    figure, panels = new_figure(10.0 if len(names) == 2 else 5.2, 5.0, mosaic=[names]) if len(names) == 2 else new_figure(5.2, 5.0)
    words = []
    for name, gains in choices.items():
        axes = panels[name] if len(names) == 2 else panels
        along, across = flow(alpha, theta, *gains)
        axes.streamplot(np.degrees(side), np.degrees(side), along, across, color=COLOURS["path"], linewidth=1.1, density=1.0)
        axes.plot(0.0, 0.0, "*", ms=14, color=COLOURS["goal"])
        axes.set(xlabel="alpha [deg]", ylabel="theta [deg]", xlim=np.degrees([-limit, limit]), ylim=np.degrees([-limit, limit]))
        axes.set_title(f"{name}: damping {modes(gains).damping:.2f}", fontsize=12)
        words.append(f"with {name} gains the damping is {modes(gains).damping:.3f}")
    return Picture(
        figure, f"Flow of alpha and theta near the goal, up to {math.degrees(limit):.0f} deg around the star: {'; '.join(words)}."
    )


def front(tried: Arrival, best: np.ndarray, marked: Mapping[str, Arrival]) -> Picture:
    """Time against heading error left over, of the runs that arrived (small dots), the undominated (large dots) and the named (marks).

    best: booleans in the shape of the runs, as of `wmrlib.pareto`; the large dots are coloured by peak |omega|.
    """
    arrived, best = np.ravel(tried.arrived), np.ravel(best)
    time, error = np.ravel(tried.time), np.degrees(np.abs(np.ravel(tried.heading_error)))
    figure, axes = new_figure(7.5, 5.2)
    axes.plot(time[arrived], error[arrived], ".", ms=2, color="#BBBBBB", rasterized=True, label="tried")
    peak = np.ravel(tried.peak_omega)[best]
    dots = axes.scatter(time[best], error[best], c=peak, s=28, cmap="viridis", ec=COLOURS["ink"], lw=0.4, zorder=3, label="not dominated")
    figure.colorbar(dots, ax=axes, label="peak |omega| [rad/s]").ax.tick_params(labelbottom=False)
    for (name, run), mark in zip(marked.items(), _MARKS, strict=False):
        left = abs(math.degrees(run.heading_error))
        axes.plot(run.time, left, mark, ms=13, color=COLOURS["goal"], mec=COLOURS["ink"], ls="none", zorder=4, label=name)
    axes.set(yscale="log", xlabel="time to arrive [s]", ylabel="heading left over [deg]", ylim=(1e-2, 200.0))
    figure.legend(loc="outside upper center", ncols=4, fontsize=10)
    words = "; ".join(f"{name} {run.time:.1f} s, {abs(math.degrees(run.heading_error)):.1f} deg" for name, run in marked.items())
    return Picture(
        figure,
        f"Time against heading error of {arrived.sum()} runs that arrived, {best.sum()} of them undominated, coloured by peak turning "
        f"rate: {words}.",
    )


def _with_meeting(gains: Gains, over: str, values: np.ndarray) -> np.ndarray:
    """The values, and the one between them at which the two poles meet, so that no line cuts that corner."""
    short = modes(gains._replace(**{over: values})).damping < 1.0
    at = np.flatnonzero(short[1:] != short[:-1])
    meetings = [brentq(lambda value: modes(gains._replace(**{over: value})).damping - 1.0, values[i], values[i + 1]) for i in at]
    return np.sort(np.concatenate([values, meetings]))
