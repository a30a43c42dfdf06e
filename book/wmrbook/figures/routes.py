"""Chapter 12: routes over several waypoints, and the cases of the tuning challenge."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from wmrbook.chapters.challenge import Score, drive_cases
from wmrbook.chapters.routes import Route
from wmrbook.figures._drawing import legend_above, note, panels, pointer
from wmrbook.figures.paths import play
from wmrbook.figures.style import COLOURS, Picture, equal_scales, new_figure, pose_arrow
from wmrlib.checks import instance
from wmrlib.kinematics import Pose

_STOP, _PASS = COLOURS["goal"], COLOURS["ink"]


def route(driven: Route) -> Picture:
    """The path through the waypoints, with arrows for the start and the wanted headings.

    A stop is a square, a waypoint to pass a circle, both numbered; one that was not reached is
    crossed out.
    """
    if not len(instance("driven", driven, Route)):
        raise ValueError(
            "driven has no sample: the first leg left the range of numbers at its start"
        )
    figure, axes = new_figure(7.0, 6.6)
    way = driven.waypoints
    start = _marker("start", COLOURS["start"], "o")
    handles = [Line2D([], [], color=COLOURS["path"], label="path"), start]
    x, y = (np.concatenate(parts) for parts in ([driven.x, way.x], [driven.y, way.y]))
    equal_scales(axes, x, y, room=0.14)
    axes.plot(driven.x, driven.y, color=COLOURS["path"], zorder=2)
    span = np.ptp(axes.get_xlim())
    pose_arrow(axes, driven.start, "start", 0.7)
    for k, stop in enumerate(driven.stops):
        pose = Pose(*(float(field[k]) for field in way))
        _waypoint(axes, pose, k, stop, k < driven.reached, 0.075 * span)
    if any(driven.stops):
        handles.append(_marker("stop", _STOP, "s", _STOP))
    if not all(driven.stops):
        handles.append(_marker("passed", _PASS, "o"))
    if driven.reached < len(driven.stops):
        handles.append(_marker("not reached", COLOURS["ink"], "x"))
    legend_above(axes, len(handles), handles)
    axes.set(xlabel="x, east [m]", ylabel="y, north [m]")
    return Picture(figure, f"{_in_words(driven)}.", [play(axes, driven)])


def challenge_paths(score: Score) -> Picture:
    """The paths of all cases of a `challenge.score`, each in a panel of its own scale, in metres.

    The start is a green arrow, the goal an orange one; the path of a case that got the penalty is
    dashed.
    """
    runs = drive_cases(instance("score", score, Score).gains, score.game)
    columns = min(6, len(runs))
    rows = math.ceil(len(runs) / columns)
    figure, grid = panels(rows, columns, 1.87 * columns, 1.2 + 1.8 * rows, squeeze=False)
    figure.get_layout_engine().set(h_pad=0.08)
    for axes in grid.flat[len(runs) :]:
        axes.set_axis_off()
    everything = zip(grid.flat, runs, score.cases, score.game.cases, strict=False)
    for k, (axes, run, row, case) in enumerate(everything, start=1):
        axes.plot(run.x, run.y, "--" if row.note else "-", color=COLOURS["path"])
        x, y = ([*getattr(run, axis), *(getattr(pose, axis) for pose in case[1:])] for axis in "xy")
        equal_scales(axes, np.array(x), np.array(y), room=0.15)
        pose_arrow(axes, case.goal, size=0.4)
        pose_arrow(axes, case.start, "start", 0.4)
        end = row.note or f"{row.time:.1f} s, {row.heading_error_deg:.0f} deg off"
        axes.set_title(f"{k} {row.kind}\n{row.points:.1f} points\n{end}")
        axes.locator_params(nbins=2)
    figure.supxlabel("x [m]")
    figure.supylabel("y [m]")
    handles = [Line2D([], [], color=COLOURS["path"], label="path")]
    if score.reached < len(runs):
        dashed = {"color": COLOURS["path"], "ls": "--", "label": "path that got the penalty"}
        handles.append(Line2D([], [], **dashed))
    handles.append(_marker("start", COLOURS["start"], "o"))
    handles.append(_marker("goal", COLOURS["goal"], "o"))
    looks = {"ncols": len(handles), "frameon": False}
    figure.legend(handles=handles, loc="outside upper center", **looks)
    costliest = max(range(len(runs)), key=lambda k: score.cases[k].points)
    worst = score.cases[costliest]
    return Picture(
        figure,
        f"The paths of {len(runs)} cases, the start a green arrow and the goal an orange one; "
        f"{score.reached} of them reached, with {score.total:.2f} points in the mean; the "
        f"costliest is case {costliest + 1}, {worst.kind}, with {worst.points:.1f} points.",
        [play(axes, run) for axes, run in zip(grid.flat, runs, strict=False)],
    )


def _waypoint(axes: Axes, pose: Pose, k: int, stop: bool, reached: bool, length: float) -> None:
    colour, marker = (_STOP, "s") if stop else (_PASS, "o")
    cos, sin = math.cos(pose.heading), math.sin(pose.heading)
    at = pose.x, pose.y
    tip = pose.x + length * cos, pose.y + length * sin
    pointer(axes, at, tip, colour, zorder=4, lw=2.2, mutation_scale=16)
    fill = colour if stop else "white"
    axes.plot(*at, marker, mfc=fill, mec=colour, mew=2.0, ms=10, zorder=5)
    if not reached:
        axes.plot(*at, "x", color=COLOURS["ink"], ms=16, mew=2.0, zorder=6)
    right = 17.0 * sin, -17.0 * cos  # of the robot
    note(axes, str(k + 1), at, right, ha="center", va="center", zorder=6)


def _marker(label: str, colour: str, marker: str, fill: str = "none") -> Line2D:
    return Line2D([], [], ls="", marker=marker, mec=colour, mfc=fill, mew=2.0, ms=10, label=label)


def _in_words(driven: Route) -> str:
    count, passed, way = len(driven.stops), driven.stops.count(False), driven.waypoints
    first, last = (f"({driven.x[k]:z.1f}, {driven.y[k]:z.1f}) m" for k in (0, -1))
    aside = [
        np.hypot(driven.x - way.x[k], driven.y - way.y[k]).min()
        for k in range(driven.reached)
        if not driven.stops[k]
    ]
    nearest = f" (at most {max(aside):.1f} m aside)" if aside else ""
    end = "" if driven.reached == count else " without reaching the rest"
    return (
        f"Path from {first} to {last}: {driven.reached} of {count} waypoints reached, "
        f"{count - passed} to stop at and {passed} to pass{nearest}; "
        f"{driven.length:.1f} m in {driven.t[-1]:.1f} s{end}"
    )
