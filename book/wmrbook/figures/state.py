"""Figures over the state: where V falls and where it rises, its level sets and the flow across them, V along runs."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from wmrlib._checks import scalar
from wmrlib.control import control_law, lyapunov, lyapunov_rate
from wmrlib.gains import Gains
from wmrlib.kinematics import polar_rate
from wmrlib.plots.picture import Picture
from wmrlib.plots.style import COLOURS, LINES, new_figure
from wmrlib.runs import Trajectory

_RISING = "#D55E00"
_TINTS = (
    COLOURS["path"],
    COLOURS["goal"],
    COLOURS["omega"],
    COLOURS["ink"],
)  # one a run, each with its own line style
_CELLS = 361  # to a side of a map


def rate_sign(gains: Gains, rho: float, law: str = "printed") -> Picture:
    """Where V rises (hatched) and where it falls (white) under a pose law, over alpha and theta in degrees at one distance [m].

    The sign is that of `lyapunov_rate`, with L = 1. Raises ValueError unless rho > 0, and as `lyapunov_rate`.
    """
    rho = scalar("rho", rho, above=0.0)
    middle = (np.arange(_CELLS) + 0.5) / _CELLS * 2.0 * math.pi - math.pi
    rate = lyapunov_rate(rho, middle, middle[:, None], gains, law=law)
    share = float(np.mean(rate > 0.0))
    figure, axes = new_figure(6.8, 6.0)
    degrees = np.degrees(middle)
    if share:
        axes.contourf(
            degrees,
            degrees,
            rate,
            levels=[0.0, rate.max() * 1.01],
            colors=["#F7C9A8"],
            hatches=["///"],
        )
        axes.contour(degrees, degrees, rate, levels=[0.0], colors=[_RISING], linewidths=2.0)
    _angle_axes(axes, 180.0)
    handles = [
        Patch(fc="#F7C9A8", ec=COLOURS["ink"], hatch="///", label=f"V rises: {100 * share:.0f} %"),
        _patch("V falls"),
    ]
    axes.legend(
        handles=handles,
        fontsize=11,
        loc="lower center",
        bbox_to_anchor=(0.5, 1.0),
        ncols=2,
        frameon=False,
    )
    return Picture(
        figure,
        f"Map of the sign of V' over alpha and theta from -180 to 180 deg, {rho:.2f} m from the goal, under the {law} law: "
        + (
            f"V rises in the hatched {100 * share:.0f} % and falls elsewhere."
            if share
            else "V falls everywhere, in 100 % of the map."
        ),
    )


def level_sets(
    gains: Gains,
    rho: float = 0.01,
    law: str = "corrected",
    runs: Trajectory | Sequence[Trajectory] = (),
) -> Picture:
    """Level sets of V over alpha and theta in degrees at one distance [m], the flow across them, and the runs' courses.

    Alpha goes from -180 to 180 deg, theta, which is not wrapped, as far as the runs take it. An arrow is thin and dark where the angles'
    part of V falls along it, thick and red where it rises. All arrows have the same length.
    Raises ValueError unless rho > 0, for more than four runs, and as `control_law`.
    """
    rho = scalar("rho", rho, above=0.0)
    runs = _several(runs, fewest=0)
    reach = max(
        [180.0, *(1.08 * np.degrees(np.abs(run.theta).max()) for run in runs)]
    )  # of theta, which is not wrapped; alpha is
    figure, axes = new_figure(1.4 + 5.4 * 180.0 / reach, 6.4)
    fine_alpha, fine_theta = (np.radians(np.linspace(-each, each, 201)) for each in (180.0, reach))
    values = lyapunov(0.0, fine_alpha, fine_theta[:, None], gains.h)
    levels = (
        0.5 * max(math.pi**2, gains.h * math.radians(reach) ** 2) * np.linspace(0.15, 1.0, 6) ** 2
    )
    axes.contour(
        np.degrees(fine_alpha),
        np.degrees(fine_theta),
        values,
        levels=levels,
        colors=[COLOURS["ink"]],
        linewidths=1.2,
        alpha=0.6,
    )
    coarse = np.radians(np.linspace(-0.92, 0.92, 15))
    alpha, theta = (each.ravel() for each in np.meshgrid(180.0 * coarse, reach * coarse))
    _, alpha_rate, theta_rate = polar_rate(
        rho, alpha, *control_law(rho, alpha, theta, gains, law=law)
    )
    rising = alpha * alpha_rate + gains.h * theta * theta_rate > 1e-12
    size = np.maximum(np.hypot(alpha_rate, theta_rate), 1e-12)
    for where, colour, width in ((~rising, "#777777", 0.003), (rising, COLOURS["V_rising"], 0.006)):
        each = (
            alpha[where],
            theta[where],
            alpha_rate[where] / size[where],
            theta_rate[where] / size[where],
        )
        axes.quiver(
            *np.degrees(each[:2]),
            *each[2:],
            color=colour,
            width=width,
            scale=22.0,
            pivot="mid",
            angles="xy",
        )
    for run, style, colour in zip(runs, LINES, _TINTS, strict=False):
        axes.plot(np.degrees(run.alpha), np.degrees(run.theta), style, color=colour, lw=2.5)
        axes.plot(
            np.degrees(run.alpha[0]), np.degrees(run.theta[0]), "o", ms=9, color=COLOURS["start"]
        )
        axes.plot(np.degrees(run.alpha[-1]), np.degrees(run.theta[-1]), "s", ms=8, color=colour)
    _angle_axes(axes, reach)
    words = [f"a run goes from {_place(run, 0)} to {_place(run, -1)}" for run in runs]
    return Picture(
        figure,
        f"Level sets of V, ellipses over alpha and theta, with the flow {rho:.2f} m from the goal under the {law} law: "
        + "; ".join(
            [f"{int(rising.sum())} of {rising.size} arrows point outwards, where V rises", *words]
        )
        + ".",
    )


def lyapunov_runs(runs: Trajectory | Sequence[Trajectory], labels: Sequence[str] = ()) -> Picture:
    """V over time of up to four runs on a logarithmic scale, each with its own line style; thick and red wherever V rises."""
    runs = _several(runs)
    names = _names(runs, labels)
    figure, axes = new_figure(7.5, 4.2)
    words, handles = [], []
    for run, name, style, colour in zip(runs, names, LINES, _TINTS, strict=False):
        values = np.maximum(run.V, 1e-12)
        axes.plot(run.t, values, style, color=colour)
        rising = np.diff(run.V) > 1e-9 * run.V[0]
        points = np.column_stack([run.t, values])
        pieces = np.stack([points[:-1], points[1:]], axis=1)[rising]
        axes.add_collection(LineCollection(pieces, color=COLOURS["V_rising"], lw=6.0, alpha=0.55))
        handles.append(Line2D([], [], color=colour, ls=style, label=name))
        ups = f"it rises, to {run.V.max():.2g} at most" if rising.any() else "it never rises"
        words.append(f"{name}: from {run.V[0]:.2g} to {run.V[-1]:.2g}, {ups}")
    handles.append(Line2D([], [], color=COLOURS["V_rising"], lw=6.0, alpha=0.55, label="rising"))
    axes.legend(
        handles=handles,
        fontsize=11,
        loc="lower center",
        bbox_to_anchor=(0.5, 1.0),
        ncols=len(handles),
        frameon=False,
    )
    axes.set(xlabel="time [s]", ylabel="V [1]", yscale="log")
    axes.margins(x=0.01)
    return Picture(figure, "V over time on a logarithmic scale. " + "; ".join(words) + ".")


def heading_errors(runs: Trajectory | Sequence[Trajectory], labels: Sequence[str] = ()) -> Picture:
    """The heading error of up to four runs over time, in degrees and not wrapped (heading - goal's heading = theta - alpha)."""
    runs = _several(runs)
    names = _names(runs, labels)
    figure, axes = new_figure(7.5, 3.8)
    axes.axhline(0.0, color=COLOURS["ink"], lw=0.8)
    words = []
    for run, name, style, colour in zip(runs, names, LINES, _TINTS, strict=False):
        error = np.degrees(run.theta - run.alpha)
        axes.plot(run.t, error, style, color=colour, label=name)
        words.append(f"{name}: at most {np.abs(error).max():.0f} deg off")
    axes.legend(
        fontsize=11, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=len(runs), frameon=False
    )
    axes.set(xlabel="time [s]", ylabel="heading error [deg]")
    axes.margins(x=0.01)
    return Picture(figure, "Heading error over time. " + "; ".join(words) + ".")


def _several(runs: Trajectory | Sequence[Trajectory], fewest: int = 1) -> list[Trajectory]:
    runs = [runs] if isinstance(runs, Trajectory) else list(runs)
    if fewest <= len(runs) <= len(LINES):
        return runs
    raise ValueError(
        f"runs has {len(runs)} entries, which is not allowed: {fewest} to {len(LINES)} are needed"
    )


def _names(runs: list[Trajectory], labels: Sequence[str]) -> list[str]:
    names = list(labels) or [run.law for run in runs]
    if len(names) == len(runs):
        return names
    raise ValueError(
        f"labels has {len(names)} entries, which is not allowed: one for each of the {len(runs)} runs is needed"
    )


def _angle_axes(axes: Axes, reach: float) -> None:
    ticks = np.arange(-math.floor(reach / 90.0) * 90, reach + 1.0, 90.0)
    axes.set(
        xlim=(-180.0, 180.0),
        ylim=(-reach, reach),
        xticks=np.arange(-180.0, 181.0, 90.0),
        yticks=ticks,
        aspect="equal",
    )
    axes.set(xlabel="alpha [deg]", ylabel="theta [deg]")


def _patch(label: str) -> Patch:
    return Patch(fc="white", ec=COLOURS["ink"], label=label)


def _place(run: Trajectory, k: int) -> str:
    alpha, theta = (math.degrees(field[k]) for field in (run.alpha, run.theta))
    return f"({round(alpha)}, {round(theta)}) deg"
