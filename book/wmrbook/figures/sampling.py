"""Chapter 8: what the clock and the wheels do: time steps, inner loops, wheel limits."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from wmrbook.figures._drawing import check_count
from wmrbook.figures.style import COLOURS, Picture, new_figure, robot
from wmrlib.gains import Gains
from wmrlib.kinematics import Pose, polar_error
from wmrlib.metrics import arrival
from wmrlib.runs import Trajectory, with_samples
from wmrlib.simulation import simulate
from wmrlib.tuning import longest_step

_SERIES = (  # colour and line style of each of up to five lines
    (COLOURS["path"], "-"),
    (COLOURS["y_error"], "--"),
    (COLOURS["theta"], "-."),
    (COLOURS["omega"], ":"),
    (COLOURS["ink"], "-"),
)
_BESIDE = {"loc": "center left", "bbox_to_anchor": (1.0, 0.5)}


def time_steps(
    start: Pose, goal: Pose, gains: Mapping[str, Gains], steps: Sequence[float]
) -> Picture:
    """The heading error on arrival against the time step [s], one panel for each of two gains.

    Thin vertical lines: the longest step of each method (`longest_step`). A cross at the top is a
    run that did not arrive.
    """
    check_count("gains", gains, 2, 2)
    figure, rows = new_figure(8.6, 6.6, rows=2)
    texts = []
    for axes, (name, tried) in zip(rows, gains.items(), strict=True):
        truth = _heading_left(arrival(simulate(start, goal, tried, method="continuous")))
        axes.axhline(truth, color=COLOURS["ink"], ls=":", label=f"continuous: {truth:.1f} deg")
        for method, colour, style, marker, top in (
            ("arc", COLOURS["path"], "-", "s", 186.0),
            ("euler", COLOURS["y_error"], "--", "o", 194.0),
        ):
            runs = [
                arrival(simulate(start, goal, tried, method=method, dt=float(dt))) for dt in steps
            ]
            limit = longest_step(tried, method)
            line = {"ls": style, "marker": marker, "ms": 4, "label": method}
            text = _draw_steps(axes, np.asarray(steps), runs, limit, top, colour, line)
            label = f"its longest step:\n{limit:.3f} s"
            axes.axvline(limit, color=colour, ls=style, lw=1.0, label=label)
            texts.append(f"{name}, {method}: {text}")
        axes.set(xscale="log", ylim=(-5.0, 200.0), yticks=range(0, 181, 45))
        axes.set_ylabel("|heading error| [deg]")
        axes.set_title(name)
        axes.legend(**_BESIDE)
    rows[-1].set(xlabel="time step dt [s], crosses: did not arrive")
    rows[-1].xaxis.set_major_formatter("{x:g}")
    what = "Heading error on arrival against the time step, two panels"
    return Picture(figure, f"{what}: {'; '.join(texts)}.")


def three_steps(paths: Mapping[str, Sequence[Pose]], goal: Pose) -> Picture:
    """One step in three ways from the same start, the last one in a larger panel.

    paths: from a way's name to its poses, from the first to the last. Dashed: the line of sight
    before and after the step. Dotted: the chord. The angle chi is drawn in the larger panel.
    """
    check_count("paths", paths, 3, 3)
    top, below, large = paths
    figure, panels = new_figure(8.4, 4.4, mosaic=[[top, large], [below, large]])
    turned = {}
    for name, path in paths.items():
        axes, start, end = panels[name], path[0], path[-1]
        turned[name] = _turned_sight(start, end, goal)
        axes.plot(*np.transpose(path)[:2], color=COLOURS["path"])
        axes.plot([start.x, end.x], [start.y, end.y], ":", color=COLOURS["ink"])
        ahead = start.x + 0.75 * math.cos(start.heading), start.y + 0.75 * math.sin(start.heading)
        axes.plot([start.x, ahead[0]], [start.y, ahead[1]], color=COLOURS["soft"], lw=1)
        axes.plot([end.x, goal.x, start.x], [end.y, goal.y, start.y], "--", color=COLOURS["rho"])
        axes.plot(goal.x, goal.y, "o", color=COLOURS["goal"], ms=9)
        robot(axes, end)
        axes.set(title=f"{name}: sight turns {turned[name]}°", aspect="equal")
        axes.set(xlim=(-0.15, 1.05), ylim=(-0.15, 0.65))
        axes.tick_params(length=0, labelbottom=False, labelleft=False)
    _draw_chord_angle(panels[large], paths[large][0], paths[large][-1])
    words = ", ".join(f"{name} {angle} deg" for name, angle in turned.items())
    return Picture(figure, f"One step in three ways, and how far the line of sight turns: {words}.")


def inner_loops(cases: Mapping[str, Mapping[str, Trajectory]]) -> Picture:
    """The heading error against the distance left to the goal, one panel for each of two cases.

    cases: from a title to a mapping from an inner loop's label to its run, up to five.
    """
    check_count("cases", cases, 2, 2)
    figure, rows = new_figure(7.5, 6.8, rows=2)
    texts = []
    for axes, (title, runs) in zip(rows, cases.items(), strict=True):
        check_count("runs", runs, 1, len(_SERIES))
        for (label, run), (colour, style) in zip(runs.items(), _SERIES, strict=False):
            with_samples(f"cases[{title!r}][{label!r}]", run)
            heading = np.degrees(run.theta - run.alpha)  # "continuous" never jumps
            axes.plot(run.rho, heading, style, color=colour, label=label)
            texts.append(f"{title}, {label}: {round(heading[-1])} deg")
        axes.axhline(0.0, color=COLOURS["ink"], lw=0.8)
        least = min(float(run.rho[-1]) for runs in cases.values() for run in runs.values())
        axes.set(xscale="log", xlim=(5.0, least), ylabel="heading error [deg]")
        axes.set_title(title)
        axes.legend(title="inner loop", **_BESIDE)
    rows[-1].set_xlabel("distance left to the goal [m], the goal to the right")
    rows[-1].xaxis.set_major_formatter("{x:g}")
    what = "Heading error against the distance left to the goal; where it ends"
    return Picture(figure, f"{what}: {'; '.join(texts)}.")


def _turned_sight(start: Pose, end: Pose, goal: Pose) -> int:
    """How far the line of sight to the goal turns from start to end, in whole degrees."""
    before, after = (polar_error(pose, goal).theta for pose in (start, end))
    return round(math.degrees(math.remainder(after - before, math.tau)))


def _draw_chord_angle(axes: Axes, start: Pose, end: Pose) -> None:
    """The angle chi from the heading at the start to the chord."""
    chi = math.remainder(math.atan2(end.y - start.y, end.x - start.x) - start.heading, math.tau)
    angles = start.heading + np.linspace(0.0, chi, 20)
    x, y = start.x + 0.4 * np.cos(angles), start.y + 0.4 * np.sin(angles)
    axes.plot(x, y, color=COLOURS["ink"], lw=1.5)
    axes.text(x[0] + 0.02, y[0] + 0.02, r"$\chi$", fontsize=15)


def _heading_left(run) -> float:
    return abs(math.degrees(run.heading_error))


def _draw_steps(axes: Axes, steps, runs, limit: float, top: float, colour: str, line) -> str:
    """The errors of one method, and crosses at `top` for runs that did not arrive; in words."""
    error = np.array([_heading_left(run) for run in runs])
    lost = ~np.array([run.arrived for run in runs])
    axes.plot(steps, np.where(lost, np.nan, error), color=colour, **line)
    axes.plot(steps[lost], np.full(lost.sum(), top), "x", color=colour, ms=6)
    below = np.flatnonzero((steps < limit) & ~lost)
    known = ""
    if below.size and below[-1]:
        known = f", {error[below[-1]]:.0f} deg at {steps[below[-1]]:.2g} s"
    first = f"{error[0]:.0f} deg at {steps[0]:g} s{known}"
    return f"{first}, longest step {limit:.3f} s, {lost.sum()} of {len(runs)} runs lost"
