"""Figures of gains: where the poles lie, how the angles settle, and what each choice costs."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from matplotlib.colors import Normalize
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from wmrlib._checks import choice, instance, real
from wmrlib.gains import Gains
from wmrlib.plots.picture import Picture
from wmrlib.plots.style import COLOURS, new_figure
from wmrlib.runs import Arrival
from wmrlib.tuning import modes

_MARKS = ("X", "D", "P", "s")
_LEAST_DEG = 1e-2  # heading left over


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
    for pole, style, name in zip(
        poles, ("-", "--"), ("slow or upper pole", "fast or lower pole"), strict=True
    ):
        axes.plot(pole.real, pole.imag, style, color=COLOURS["path"], label=name)
    at = np.array(here.poles[1:])
    axes.plot(
        at.real,
        at.imag,
        "x",
        ms=11,
        mew=3,
        color=COLOURS["goal"],
        label=f"{over} = {getattr(gains, over):g}",
    )
    axes.plot(
        here.poles[0].real, 0.0, "s", ms=9, color=COLOURS["start"], label="the distance's pole"
    )
    reach = 1.15 * max(np.abs(poles.imag).max(), np.abs(at.imag).max(), 0.5)
    left = 1.15 * min(poles.real.min(), at.real.min(), here.poles[0].real)
    for damping in (0.1, 0.3, 0.7):
        slope = math.sqrt(1.0 - damping**2) / damping
        x = max(left, -reach / slope)
        at_side = x < 0.95 * left  # then its label stands below the line's end, inside the axes
        for side in (1, -1):
            axes.plot([0.0, x], [0.0, -side * slope * x], ":", color=COLOURS["ink"], lw=0.9)
        looks = (
            {"xytext": (6, -8), "ha": "left"} if at_side else {"xytext": (-4, -2), "ha": "right"}
        )
        axes.annotate(
            f"{damping}",
            (x, -slope * x),
            textcoords="offset points",
            fontsize=10,
            va="top",
            **looks,
        )
    axes.axvline(0.0, color=COLOURS["ink"], lw=0.8)
    axes.set(
        xlim=(left, -0.06 * left),
        ylim=(-reach, reach),
        xlabel="real part [1/s]",
        ylabel="imaginary part [rad/s]",
    )
    figure.legend(loc="outside upper center", ncols=2, fontsize=10)
    return Picture(
        figure,
        f"Root locus of the angles for {over} from {values[0]:g} to {values[-1]:g}. {_course(poles)} At {over} = "
        f"{getattr(gains, over):g} the damping is {here.damping:.3f} and the natural frequency {here.natural_frequency:.2f} rad/s; "
        f"the distance's pole is at {here.poles[0].real:.2f}.",
    )


def phase_portrait(choices: Mapping[str, Gains], limit: float) -> Picture:
    """How (alpha, theta) flow under the corrected law in the limit rho = 0, up to `limit` rad, one panel for each of the named gains.

    The text counts the turns of the way from (0, limit) to a twentieth of it. Raises ValueError for no gains, or more than two.
    """
    import sympy as sp

    from wmrlib import symbolic

    if not 1 <= len(choices) <= 2:
        raise ValueError(
            f"choices has {len(choices)} entries, which is not allowed: 1 or 2 are needed"
        )
    rates = [rate.subs(symbolic.rho, 0) for rate in symbolic.closed_loop()[1:]]
    flow = sp.lambdify(
        (
            symbolic.alpha,
            symbolic.theta,
            symbolic.k_rho,
            symbolic.k_alpha,
            symbolic.h,
            symbolic.v_max,
        ),
        rates,
    )
    side = np.linspace(-limit, limit, 60)  # an even number: no sample at alpha = 0
    alpha, theta = np.meshgrid(side, side)
    names = list(choices)
    figure, panels = (
        new_figure(10.0 if len(names) == 2 else 5.2, 5.0, mosaic=[names])
        if len(names) == 2
        else new_figure(5.2, 5.0)
    )
    words = []
    for name, gains in choices.items():
        axes = panels[name] if len(names) == 2 else panels
        along, across = flow(alpha, theta, *gains)
        axes.streamplot(
            np.degrees(side),
            np.degrees(side),
            along,
            across,
            color=COLOURS["path"],
            linewidth=1.1,
            density=1.0,
        )
        axes.plot(0.0, 0.0, "*", ms=14, color=COLOURS["goal"])
        axes.set(
            xlabel="alpha [deg]",
            ylabel="theta [deg]",
            xlim=np.degrees([-limit, limit]),
            ylim=np.degrees([-limit, limit]),
        )
        axes.set_title(f"{name}: damping {modes(gains).damping:.2f}", fontsize=12)
        turns = _turns(lambda t, state, gains=gains: flow(*state, *gains), gains.h, limit)
        shape = f"one sweep, {turns:.1f} turns" if turns < 1.0 else f"a spiral of {turns:.1f} turns"
        words.append(f"with {name} gains (damping {modes(gains).damping:.3f}) {shape}")
    flat = (
        "; at alpha = +-90 deg the flow is horizontal: there only alpha changes"
        if limit > 0.5 * math.pi
        else ""
    )
    return Picture(
        figure,
        f"Flow of alpha and theta near the goal, up to {math.degrees(limit):.0f} deg around the star; from the upper edge to a twentieth "
        f"of it, {'; '.join(words)}{flat}.",
    )


def front(tried: Arrival, best: np.ndarray, marked: Mapping[str, Arrival]) -> Picture:
    """Time against heading error left over, of the runs that arrived (small dots), the undominated (large dots) and the named (marks).

    best: booleans in the shape of the runs, as of `wmrlib.pareto`; the large dots are coloured by peak |omega|. An error below 0.01 deg is
    drawn at the lower border, as a triangle if it is undominated.
    """
    arrived, best = np.ravel(tried.arrived), np.ravel(best)
    time, error = np.ravel(tried.time), np.degrees(np.abs(np.ravel(tried.heading_error)))
    figure, axes = new_figure(7.5, 5.2)
    drawn, below = np.maximum(error, _LEAST_DEG), best & (error < _LEAST_DEG)
    axes.plot(
        time[arrived], drawn[arrived], ".", ms=2, color="#BBBBBB", rasterized=True, label="tried"
    )
    peak = np.ravel(tried.peak_omega)
    looks = {
        "cmap": "viridis",
        "norm": Normalize(peak[best].min(), peak[best].max()),
        "ec": COLOURS["ink"],
        "lw": 0.4,
        "zorder": 3,
    }
    above = best & ~below
    dots = axes.scatter(
        time[above], drawn[above], c=peak[above], s=28, label="not dominated", **looks
    )
    if below.any():
        more = {"marker": "v", "clip_on": False, "label": f"below {_LEAST_DEG:g} deg"}
        axes.scatter(time[below], drawn[below], c=peak[below], s=45, **more, **looks)
    figure.colorbar(dots, ax=axes, label="peak |omega| [rad/s]").ax.tick_params(labelbottom=False)
    for (name, run), mark in zip(marked.items(), _MARKS, strict=False):
        left = abs(math.degrees(run.heading_error))
        axes.plot(
            run.time,
            left,
            mark,
            ms=13,
            color=COLOURS["goal"],
            mec=COLOURS["ink"],
            ls="none",
            zorder=4,
            label=name,
        )
    axes.set(
        yscale="log",
        xlabel="time to arrive [s]",
        ylabel="heading left over [deg]",
        ylim=(_LEAST_DEG, 200.0),
    )
    figure.legend(loc="outside upper center", ncols=5, fontsize=10)
    words = "; ".join(
        f"{name} {run.time:.1f} s, {abs(math.degrees(run.heading_error)):.1f} deg"
        for name, run in marked.items()
    )
    return Picture(
        figure,
        f"Time against heading error of {arrived.sum()} runs that arrived, {best.sum()} of them undominated, coloured by peak turning "
        f"rate: {words}{f'; {below.sum()} triangles at the lower border are below {_LEAST_DEG:g} deg' if below.any() else ''}.",
    )


def _course(poles: np.ndarray) -> str:
    """What the pair does as the gain grows: poles has one row a pole."""
    pair = np.abs(poles.imag).max(axis=0) > 1e-9
    if not pair.any():
        return "Both poles stay real."
    size, real_part = np.abs(poles[0, pair]), poles.real[0, pair]
    if np.ptp(size) < 1e-6 * size.max():
        course = f"runs on a circle of {size[0]:.2f} rad/s"
        return f"The pair {course}" + ("." if pair[-1] else " to the real axis and parts there.")
    if np.ptp(real_part) < 1e-6 * size.max():
        course = f"runs straight up and down at {real_part[0]:.2f}"
        return (
            f"The pair {course}."
            if pair[0]
            else f"The two poles meet at {real_part[0]:.2f}, and the pair then runs straight up and down."
        )
    return f"The pair runs from {size[0]:.2f} to {size[-1]:.2f} rad/s."


def _turns(flow, h: float, limit: float) -> float:
    """How often the way from (0, limit) goes round the origin until sqrt(alpha^2/h + theta^2) is a twentieth of that."""

    def near(t, state):
        return math.hypot(state[0] / math.sqrt(h), state[1]) - limit / 20.0

    near.terminal = True
    alpha, theta = solve_ivp(
        flow, (0.0, 1000.0), [0.0, limit], events=near, rtol=1e-6, atol=1e-9, max_step=0.05
    ).y
    return float(np.ptp(np.unwrap(np.arctan2(theta, alpha)))) / (2.0 * math.pi)


def _with_meeting(gains: Gains, over: str, values: np.ndarray) -> np.ndarray:
    """The values, and the one between them at which the two poles meet, so that no line cuts that corner."""
    short = modes(gains._replace(**{over: values})).damping < 1.0
    at = np.flatnonzero(short[1:] != short[:-1])
    meetings = [
        brentq(
            lambda value: modes(gains._replace(**{over: value})).damping - 1.0,
            values[i],
            values[i + 1],
        )
        for i in at
    ]
    return np.sort(np.concatenate([values, meetings]))
