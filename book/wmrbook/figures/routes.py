"""Figures of routes over several waypoints, and of the tuning challenge's cases."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from wmrbook.challenge import Score, drive
from wmrlib._checks import instance, real
from wmrlib.kinematics import Pose
from wmrlib.plots.picture import Picture
from wmrlib.plots.style import COLOURS, STYLE, arrow, equal_scales, near_zero, new_figure
from wmrlib.routes import Route

_STOP, _PASS, _TRACK = COLOURS["goal"], COLOURS["omega"], "#777777"


def route(driven: Route, background: tuple[np.ndarray, np.ndarray] | None = None) -> Picture:
    """The path through the waypoints, in metres with equal scales; arrows show the start and the headings that are wanted on the way.

    A stop is a square, a waypoint that is passed a circle, both with their number; one that was not reached is crossed out. background:
    (east, north), arrays in metres of the same local frame, such as the track of a receiver, drawn as dots.
    Raises ValueError for anything but a Route with a sample, or a background of other than two lists of finite numbers, of one length.
    """
    _with_samples(driven)
    figure, axes = new_figure(7.0, 6.6)
    x, y = [driven.x, driven.waypoints.x], [driven.y, driven.waypoints.y]
    handles = [
        Line2D([], [], color=COLOURS["path"], label="path"),
        _marker("start", COLOURS["start"], ">", COLOURS["start"]),
    ]
    if background is not None:
        east, north = _pair(background)
        axes.plot(east, north, ".", color=_TRACK, ms=5, zorder=1)
        handles.append(Line2D([], [], color=_TRACK, ls="", marker=".", label="track"))
        x, y = [*x, east], [*y, north]
    equal_scales(axes, np.concatenate(x), np.concatenate(y), room=0.14)
    axes.plot(driven.x, driven.y, color=COLOURS["path"], zorder=2)
    span = np.ptp(axes.get_xlim())
    axes.add_patch(
        arrow(driven.start, 0.025 * span, fc=COLOURS["start"], ec=COLOURS["ink"], zorder=5)
    )
    for k, (pose, stop) in enumerate(
        zip(zip(*driven.waypoints, strict=True), driven.stops, strict=True)
    ):
        _waypoint(axes, Pose(*map(float, pose)), k, stop, k < driven.reached, 0.075 * span)
    if any(driven.stops):
        handles.append(_marker("stop", _STOP, "s", _STOP))
    if not all(driven.stops):
        handles.append(_marker("passed", _PASS, "o"))
    if driven.reached < len(driven.stops):
        handles.append(_marker("not reached", COLOURS["ink"], "x"))
    axes.legend(
        handles=handles,
        loc="lower center",
        bbox_to_anchor=(0.5, 1.0),
        ncols=len(handles),
        frameon=False,
        fontsize=11,
    )
    axes.set(xlabel="x, east [m]", ylabel="y, north [m]")
    return Picture(
        figure,
        f"{_in_words(driven)}{'' if background is None else f', with {east.size} points of a track behind it'}.",
    )


def route_signals(driven: Route) -> Picture:
    """The speed v [m/s] and V [1] of the legs over time; dashed lines mark where the goal changes, and V, logarithmic, jumps.

    Each leg's V is drawn up to its arrival, where the joined arrays already have the next leg's. Raises ValueError as `route`.
    """
    _with_samples(driven)
    figure, (upper, lower) = new_figure(8.0, 5.0, rows=2)
    changes = driven.t[1:][np.diff(driven.leg) > 0]
    shown = np.unique(driven.leg)
    values = [np.maximum(driven.legs[k].V, 1e-12) for k in shown]
    upper.axhline(0.0, color=COLOURS["ink"], lw=0.8)
    for k, own_V in zip(shown, values, strict=True):
        own = driven.leg == k
        upper.plot(driven.t[own], driven.v[own], color=COLOURS["v"])
        lower.plot(
            driven.t[own][0] + driven.legs[k].t,
            own_V,
            color=COLOURS["V"],
            marker="o" if own_V.size == 1 else "",
        )
    for axes in (upper, lower):
        for time in changes:
            axes.axvline(time, color=COLOURS["goal"], ls="--", lw=1.2)
    upper.set(ylabel="v [m/s]")
    every = np.concatenate(values)
    lower.set(
        ylabel="V [1]", yscale="log", xlabel="time [s]", ylim=(0.5 * every.min(), 2.0 * every.max())
    )
    lower.minorticks_off()
    handle = Line2D([], [], color=COLOURS["goal"], ls="--", lw=1.2, label="the goal changes")
    upper.legend(
        handles=[handle], loc="lower right", bbox_to_anchor=(1.0, 1.0), frameon=False, fontsize=11
    )
    figure.align_ylabels()
    jumps = [
        driven.legs[after].V[0] > driven.legs[before].V[-1] for before, after in pairwise(shown)
    ]
    return Picture(
        figure,
        f"Over {driven.t[-1]:.1f} s and {len(driven.legs)} legs: v between {near_zero(driven.v.min()):.1f} and "
        f"{near_zero(driven.v.max()):.1f} m/s; V from {driven.V[0]:.3g} to {driven.V[-1]:.3g} on a logarithmic scale, jumping up at "
        f"{sum(jumps)} of {len(changes)} changes of the goal.",
    )


def challenge_paths(score: Score) -> Picture:
    """The paths of all cases of a `challenge.score`, each in a panel of its own scale, in metres, with its kind, its time and its points.

    The start is a filled arrow, the goal an open one, in the panels as in the legend above them; the path of a case that got the penalty
    is dashed. Raises ValueError for anything but a Score.
    """
    runs = drive(instance("score", score, Score).gains, score.game)
    columns = min(4, len(runs))
    rows = math.ceil(len(runs) / columns)
    figure, panels = _panels(rows, columns)
    for k, (axes, run, row) in enumerate(
        zip(panels.flat, runs, score.cases, strict=False), start=1
    ):
        case = score.game.cases[k - 1]
        x, y = (
            np.array([*run.x, case.start.x, case.goal.x]),
            np.array([*run.y, case.start.y, case.goal.y]),
        )
        axes.plot(run.x, run.y, "--" if row.note else "-", color=COLOURS["path"])
        equal_scales(axes, x, y, room=0.15)
        size = 0.04 * np.ptp(axes.get_xlim())
        axes.add_patch(arrow(case.goal, size, fc="none", ec=COLOURS["goal"], lw=1.6, zorder=4))
        axes.add_patch(
            arrow(case.start, size, fc=COLOURS["start"], ec=COLOURS["ink"], lw=0.8, zorder=3)
        )
        end = row.note or f"{row.time:.1f} s, {row.heading_error_deg:.0f} deg off"
        axes.set_title(f"{k} {row.kind}: {row.points:.1f} points\n{end}", fontsize=10)
        axes.locator_params(nbins=4)
        axes.tick_params(labelsize=10)
    for axes in list(panels.flat)[len(runs) :]:
        axes.set_axis_off()
    figure.supxlabel("x [m]", fontsize=12)
    figure.supylabel("y [m]", fontsize=12)
    handles = [Line2D([], [], color=COLOURS["path"], label="path")]
    if score.reached < len(runs):
        handles.append(
            Line2D([], [], color=COLOURS["path"], ls="--", label="path that got the penalty")
        )
    handles += [
        _marker("start", COLOURS["ink"], ">", COLOURS["start"]),
        _marker("goal", COLOURS["goal"], ">"),
    ]
    figure.legend(
        handles=handles, loc="outside upper center", ncols=len(handles), frameon=False, fontsize=11
    )
    dearest = max(range(len(runs)), key=lambda k: score.cases[k].points)
    return Picture(
        figure,
        f"The paths of {len(runs)} cases, the start a filled arrow and the goal an outlined one; {score.reached} of them reached, with "
        f"{score.total:.2f} points in the mean; the dearest is case {dearest + 1}, {score.cases[dearest].kind}, with "
        f"{score.cases[dearest].points:.1f} points.",
    )


def _panels(rows: int, columns: int):
    import matplotlib as mpl
    from matplotlib.figure import Figure

    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(2.9 * columns, 3.2 * rows), layout="constrained")
        return figure, figure.subplots(rows, columns, squeeze=False)


def _waypoint(axes: Axes, pose: Pose, k: int, stop: bool, reached: bool, length: float) -> None:
    colour, marker = (_STOP, "s") if stop else (_PASS, "o")
    cos, sin = math.cos(pose.heading), math.sin(pose.heading)
    looks = {
        "arrowstyle": "-|>",
        "color": colour,
        "lw": 2.2,
        "mutation_scale": 16,
        "shrinkA": 0,
        "shrinkB": 0,
    }
    axes.annotate(
        "",
        (pose.x + length * cos, pose.y + length * sin),
        (pose.x, pose.y),
        arrowprops=looks,
        zorder=4,
    )
    axes.plot(
        pose.x,
        pose.y,
        marker,
        mfc=colour if stop else "white",
        mec=colour,
        mew=2.0,
        ms=10,
        zorder=5,
    )
    if not reached:
        axes.plot(pose.x, pose.y, "x", color=COLOURS["ink"], ms=16, mew=2.0, zorder=6)
    aside = 17.0 * sin, -17.0 * cos  # points, to the right of the robot
    axes.annotate(
        str(k + 1),
        (pose.x, pose.y),
        aside,
        textcoords="offset points",
        ha="center",
        va="center",
        zorder=6,
    )


def _marker(label: str, colour: str, marker: str, fill: str = "none") -> Line2D:
    return Line2D([], [], ls="", marker=marker, mec=colour, mfc=fill, mew=2.0, ms=10, label=label)


def _in_words(driven: Route) -> str:
    count, passing = len(driven.stops), [k for k, stop in enumerate(driven.stops) if not stop]
    end = (
        f"{driven.t[-1]:.1f} s"
        if driven.reached == count
        else f"{driven.t[-1]:.1f} s without reaching the rest"
    )
    first, last = (
        f"({near_zero(driven.x[k]):.1f}, {near_zero(driven.y[k]):.1f}) m" for k in (0, -1)
    )
    way = driven.waypoints
    aside = [
        np.hypot(driven.x - way.x[k], driven.y - way.y[k]).min()
        for k in passing
        if k < driven.reached
    ]
    nearest = f" (at most {max(aside):.1f} m aside)" if aside else ""
    through = f"{driven.reached} of {count} waypoints reached, {count - len(passing)} to stop at and {len(passing)} to pass{nearest}"
    return f"Path from {first} to {last}: {through}; {driven.length:.1f} m in {end}"


def _pair(background: Any) -> tuple[np.ndarray, np.ndarray]:
    pair = tuple(background) if np.iterable(background) else ()
    if len(pair) != 2 or np.shape(pair[0]) != np.shape(pair[1]):
        raise ValueError(
            f"background = {background!r} is not allowed: (east, north), two lists of one length, is needed"
        )
    east, north = (np.ravel(real("background", values)) for values in pair)
    return east, north


def _with_samples(driven: Route) -> None:
    if not len(instance("driven", driven, Route)):
        raise ValueError(
            "driven has no sample: the first leg left the range of numbers at its start"
        )
