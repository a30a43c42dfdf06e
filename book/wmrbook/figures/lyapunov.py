"""Chapters 4 and 10: V as a bowl, where it falls and rises, its level sets, and V along runs."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from wmrbook.figures._drawing import legend_above, panels, run_list
from wmrlib._checks import scalar
from wmrlib.control import control_law, lyapunov, lyapunov_rate
from wmrlib.gains import Gains
from wmrlib.kinematics import polar_rate
from wmrlib.plots.style import COLOURS, LINES, Picture, new_figure
from wmrlib.runs import Trajectory

_RISING_EDGE, _RISING_FILL = "#D55E00", "#F7C9A8"
_TINTS = tuple(COLOURS[role] for role in ("path", "goal", "omega", "ink"))
_BOWL_TINTS = tuple(COLOURS[role] for role in ("ink", "omega", "path", "y_error"))
_CELLS = 361  # to a side of a map
_ROUND = np.linspace(0.0, 2.0 * math.pi, 61)


def bowl(gains: Gains, runs: Trajectory | Sequence[Trajectory]) -> Picture:
    """The angles' part of V as a bowl over alpha and theta [deg], and one to four runs in it."""
    runs = run_list(runs)
    heights = [lyapunov(0.0, run.alpha, run.theta, gains.h) for run in runs]
    rim = 1.05 * max(height.max() for height in heights)
    figure, axes = panels(1, 1, 6.8, 5.6, subplot_kw={"projection": "3d"})
    radius, turn = np.meshgrid(np.sqrt(2.0 * rim) * np.linspace(0, 1, 25), _ROUND)
    across = radius * np.cos(turn), radius * np.sin(turn) / math.sqrt(gains.h)
    looks = {"color": COLOURS["V"], "alpha": 0.16, "linewidth": 0, "shade": False}
    axes.plot_surface(*np.degrees(across), 0.5 * radius**2, rcount=61, ccount=25, **looks)
    for k in range(4, 25, 4):
        ring = np.degrees(across)[:, :, k]
        axes.plot(*ring, 0.5 * radius[:, k] ** 2, color=COLOURS["V"], lw=0.8, alpha=0.7)
    words = []
    for run, height, style, colour in zip(runs, heights, LINES, _BOWL_TINTS, strict=False):
        way = *np.degrees([run.alpha, run.theta]), height
        axes.plot(*way, style, color=colour, lw=2.5, zorder=10)
        axes.plot(*([each[0]] for each in way), "o", ms=8, color=COLOURS["start"], zorder=11)
        falls = "falling all the way" if np.diff(height).max() < 1e-9 * rim else "rising at times"
        words.append(f"a run goes from {_place(run, 0)} to {_place(run, -1)}, {falls}")
    axes.plot([0.0], [0.0], [0.0], "s", ms=8, color=COLOURS["goal"], zorder=11)
    axes.set(xlabel="alpha [deg]", ylabel="theta [deg]", zlabel="V of the angles [1]")
    axes.set(xticks=range(-180, 181, 90), yticks=range(-90, 91, 90))
    axes.view_init(elev=38.0, azim=-60.0)
    axes.set_box_aspect((1.0, 1.0, 0.7), zoom=0.9)
    return Picture(
        figure,
        f"V of the angles as a bowl over alpha and theta, with its bottom at (0, 0) deg and its "
        f"rim at {rim:.1f}: {'; '.join(words)}.",
    )


def rate_sign(gains: Gains, rho: float, law: str = "printed") -> Picture:
    """Where V rises (hatched) and falls (white) under a pose law, at one distance rho > 0 [m].

    Over alpha and theta in degrees; the sign is that of `lyapunov_rate` with L = 1.
    """
    rho = scalar("rho", rho, above=0.0)
    middle = (np.arange(_CELLS) + 0.5) / _CELLS * 2.0 * math.pi - math.pi
    rate = lyapunov_rate(rho, middle, middle[:, None], gains, law=law)
    share = float(np.mean(rate > 0.0))
    figure, axes = new_figure(6.8, 6.0)
    grid = np.degrees(middle), np.degrees(middle), rate
    if share:
        levels = [0.0, rate.max() * 1.01]
        axes.contourf(*grid, levels=levels, colors=[_RISING_FILL], hatches=["///"])
        axes.contour(*grid, levels=[0.0], colors=[_RISING_EDGE], linewidths=2.0)
    _angle_axes(axes, 180.0)
    label = f"V rises: {100 * share:.0f} %"
    rises = Patch(fc=_RISING_FILL, ec=COLOURS["ink"], hatch="///", label=label)
    falls = Patch(fc="white", ec=COLOURS["ink"], label="V falls")
    legend_above(axes, 2, [rises, falls])
    course = (
        f"V rises in the hatched {100 * share:.0f} % and falls elsewhere."
        if share
        else "V falls everywhere, in 100 % of the map."
    )
    return Picture(
        figure,
        "Map of the sign of V' over alpha and theta from -180 to 180 deg, "
        f"{rho:.2f} m from the goal, under the {law} law: {course}",
    )


def level_sets(
    gains: Gains,
    rho: float = 0.01,
    law: str = "corrected",
    runs: Trajectory | Sequence[Trajectory] = (),
) -> Picture:
    """Level sets of V over alpha and theta [deg] at one distance [m], the flow and up to four runs.

    Alpha goes from -180 to 180 deg; theta, which is not wrapped, as far as the runs take it. An
    arrow, always of one length, is thin and dark where the angles' part of V falls along it, thick
    and red where it rises.
    """
    rho = scalar("rho", rho, above=0.0)
    runs = run_list(runs, least=0)
    reach = max([180.0, *(1.08 * np.degrees(np.abs(run.theta).max()) for run in runs)])
    figure, axes = new_figure(1.4 + 5.4 * 180.0 / reach, 6.4)
    fine_alpha, fine_theta = (np.radians(np.linspace(-each, each, 201)) for each in (180.0, reach))
    values = lyapunov(0.0, fine_alpha, fine_theta[:, None], gains.h)
    highest = 0.5 * max(math.pi**2, gains.h * math.radians(reach) ** 2)
    grid = np.degrees(fine_alpha), np.degrees(fine_theta), values
    looks = {"colors": [COLOURS["ink"]], "linewidths": 1.2, "alpha": 0.6}
    axes.contour(*grid, levels=highest * np.linspace(0.15, 1.0, 6) ** 2, **looks)
    rising = _draw_flow(axes, gains, rho, law, reach)
    for run, style, colour in zip(runs, LINES, _TINTS, strict=False):
        alpha, theta = np.degrees(run.alpha), np.degrees(run.theta)
        axes.plot(alpha, theta, style, color=colour, lw=2.5)
        axes.plot(alpha[0], theta[0], "o", ms=9, color=COLOURS["start"])
        axes.plot(alpha[-1], theta[-1], "s", ms=8, color=colour)
    _angle_axes(axes, reach)
    words = [f"{rising.sum()} of {rising.size} arrows point outwards, where V rises"]
    words += [f"a run goes from {_place(run, 0)} to {_place(run, -1)}" for run in runs]
    return Picture(
        figure,
        f"Level sets of V, ellipses over alpha and theta, with the flow {rho:.2f} m from the goal "
        f"under the {law} law: {'; '.join(words)}.",
    )


def lyapunov_runs(runs: Trajectory | Sequence[Trajectory], labels: Sequence[str] = ()) -> Picture:
    """V over time of one to four runs on a logarithmic scale, thick and red wherever V rises."""
    runs = run_list(runs)
    names = _names(runs, labels)
    figure, axes = new_figure(7.5, 4.2)
    red = {"color": COLOURS["V_rising"], "lw": 6.0, "alpha": 0.55}
    words, handles = [], []
    for run, name, style, colour in zip(runs, names, LINES, _TINTS, strict=False):
        values = np.maximum(run.V, 1e-12)
        axes.plot(run.t, values, style, color=colour)
        rising = np.diff(run.V) > 1e-9 * run.V[0]
        points = np.column_stack([run.t, values])
        pieces = np.stack([points[:-1], points[1:]], axis=1)[rising]
        axes.add_collection(LineCollection(pieces, **red))
        handles.append(Line2D([], [], color=colour, ls=style, label=name))
        ups = f"it rises, to {run.V.max():.2g} at most" if rising.any() else "it never rises"
        words.append(f"{name}: from {run.V[0]:.2g} to {run.V[-1]:.2g}, {ups}")
    handles.append(Line2D([], [], label="rising", **red))
    legend_above(axes, len(handles), handles)
    axes.set(xlabel="time [s]", ylabel="V [1]", yscale="log")
    axes.margins(x=0.01)
    return Picture(figure, f"V over time on a logarithmic scale. {'; '.join(words)}.")


def heading_errors(runs: Trajectory | Sequence[Trajectory], labels: Sequence[str] = ()) -> Picture:
    """The heading error theta - alpha of one to four runs over time, in degrees and not wrapped."""
    runs = run_list(runs)
    names = _names(runs, labels)
    figure, axes = new_figure(7.5, 3.8)
    axes.axhline(0.0, color=COLOURS["ink"], lw=0.8)
    words = []
    for run, name, style, colour in zip(runs, names, LINES, _TINTS, strict=False):
        error = np.degrees(run.theta - run.alpha)
        axes.plot(run.t, error, style, color=colour, label=name)
        words.append(f"{name}: at most {np.abs(error).max():.0f} deg off")
    legend_above(axes, len(runs))
    axes.set(xlabel="time [s]", ylabel="heading error [deg]")
    axes.margins(x=0.01)
    return Picture(figure, f"Heading error over time. {'; '.join(words)}.")


def _draw_flow(axes: Axes, gains: Gains, rho: float, law: str, reach: float) -> np.ndarray:
    """Arrows of one length along (alpha', theta'); returns which of them rise."""
    coarse = np.radians(np.linspace(-0.92, 0.92, 15))
    alpha, theta = (each.ravel() for each in np.meshgrid(180.0 * coarse, reach * coarse))
    twist = control_law(rho, alpha, theta, gains, law=law)
    _, alpha_rate, theta_rate = polar_rate(rho, alpha, *twist)
    rising = alpha * alpha_rate + gains.h * theta * theta_rate > 1e-12
    size = np.maximum(np.hypot(alpha_rate, theta_rate), 1e-12)
    places = np.degrees([alpha, theta])
    arrows = np.array([alpha_rate / size, theta_rate / size])
    looks = {"scale": 22.0, "pivot": "mid", "angles": "xy"}
    for some, colour, width in ((~rising, "#777777", 0.003), (rising, COLOURS["V_rising"], 0.006)):
        axes.quiver(*places[:, some], *arrows[:, some], color=colour, width=width, **looks)
    return rising


def _names(runs: list[Trajectory], labels: Sequence[str]) -> list[str]:
    names = list(labels) or [run.law for run in runs]
    if len(names) == len(runs):
        return names
    raise ValueError(
        f"labels has {len(names)} entries, which is not allowed: "
        f"one for each of the {len(runs)} runs is needed"
    )


def _angle_axes(axes: Axes, reach: float) -> None:
    ticks = np.arange(-math.floor(reach / 90.0) * 90, reach + 1.0, 90.0)
    axes.set(xlim=(-180.0, 180.0), xticks=np.arange(-180.0, 181.0, 90.0), xlabel="alpha [deg]")
    axes.set(ylim=(-reach, reach), yticks=ticks, ylabel="theta [deg]", aspect="equal")


def _place(run: Trajectory, k: int) -> str:
    alpha, theta = (math.degrees(field[k]) for field in (run.alpha, run.theta))
    return f"({round(alpha)}, {round(theta)}) deg"
