"""Chapter 5: the paper's figures 8 to 12, the one that is missing, and the ends of many runs.

`runs` maps one to five labels to Trajectories; a label keeps its colour and line style in all
figures whose labels stand in the same order.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np
from matplotlib.patches import FancyBboxPatch

from wmrbook.figures._drawing import (
    SERIES,
    check_count,
    check_series,
    figure_legend,
    panels,
    pointer,
)
from wmrbook.figures.paths import pose_at
from wmrbook.figures.style import (
    COLOURS,
    Picture,
    equal_scales,
    new_figure,
    pose_arrow,
    robot,
)
from wmrlib.checks import real, same_shape, scalar
from wmrlib.runs import Trajectory, with_samples

_NEAREST = 0.01  # m, where a logarithmic scale of distances ends
_CLOSE = 0.3  # m, the last bit of a drive
_LEAST = 0.05  # deg, of a logarithmic scale
_ALLOWED = 5.0  # deg, of a heading
_PRINTED = {  # the paper's figure of a field over time: its number, its axis, its unit
    "v": ("Fig. 9", "v [m/s]", "m/s"),
    "omega": ("Fig. 10", "omega [rad/s]", "rad/s"),
    "x_error": ("Fig. 11", "x error [m]", "m"),
    "y_error": ("Fig. 12", "y error [m]", "m"),
}
_BOXES = (  # name, what it does, the colour's role, centre: row by row, there and back
    ("GPS", "two points,\ntwo headings", "y_error", (1.2, 4.1)),
    ("geodesy", "(11)-(17):\ngoal in metres", "y_error", (4.5, 4.1)),
    ("polar error", "Fig. 2: rho,\nalpha, theta", "path", (7.8, 4.1)),
    ("control law", "(22), (24) corrected:\nv and omega", "path", (7.8, 1.5)),
    ("wheel loop", "(1), (2): left and\nright wheel", "omega", (4.5, 1.5)),
    ("robot", "(3)-(6): x, y,\nheading", "robot", (1.2, 1.5)),
)
_SIGNALS = ("lat, lon", "goal pose", "polar error", "v, omega", "speeds")


def figures_8_to_12(runs: Mapping[str, Trajectory]) -> Picture:
    """The paper's figures of its outdoor drive: path, speed, turning rate and both errors."""
    check_series(runs, Trajectory)
    mosaic = [["path", [["v", "omega"], ["x_error", "y_error"]]]]
    figure, axes = new_figure(10.2, 4.8, mosaic=mosaic)
    axes["path"].get_gridspec().set_width_ratios([1.0, 2.0])
    series = list(zip(runs.items(), SERIES, strict=False))
    path, words = axes.pop("path"), []
    for (title, run), (role, style) in series:
        path.plot(run.x, run.y, color=COLOURS[role], ls=style, label=title)
        goal = pose_at(run.goal, -1)
        pose_arrow(path, goal, size=0.6, zorder=3)
        pose_arrow(path, pose_at(run, 0), "start", 0.6, zorder=3)
    everywhere = [np.concatenate([getattr(it, axis) for it in runs.values()]) for axis in "xy"]
    equal_scales(path, *everywhere, room=0.1)
    path.set(xlabel="x [m]", ylabel="y [m]", title="Fig. 8: path")
    for name, panel in axes.items():
        number, label, unit = _PRINTED[name]
        panel.axhline(0.0, color=COLOURS["ink"], lw=0.8)
        for (title, run), (role, style) in series:
            panel.plot(run.t, getattr(run, name), color=COLOURS[role], ls=style)
            words.append(_course_in_words(f"{number}, {title}", getattr(run, name), unit))
        panel.set(title=number, ylabel=label, xlabel="time [s]")
    for above in (axes["v"], axes["omega"]):
        above.tick_params(labelbottom=False)  # as below
        above.set_xlabel("")
    figure_legend(figure)
    return Picture(figure, f"Figures 8 to 12 of the paper, rebuilt: {'; '.join(words)}.")


def heading_to_go(runs: Mapping[str, Trajectory]) -> Picture:
    """The heading error [deg] over the distance that is still to go, on a logarithmic scale."""
    check_series(runs, Trajectory)
    figure, axes = new_figure(7.5, 4.2)
    axes.axhline(0.0, color=COLOURS["ink"], lw=0.8)
    words = []
    for (title, run), (role, style) in zip(runs.items(), SERIES, strict=False):
        near = run.rho >= _NEAREST
        error = np.degrees(run.theta - run.alpha)
        axes.plot(run.rho[near], error[near], color=COLOURS[role], ls=style, label=title)
        largest = np.abs(error[run.rho <= _CLOSE]).max(initial=0.0)
        words.append(f"{title}: at most {largest:.0f} deg off within {_CLOSE:g} m of the goal")
    axes.set(xscale="log", xlabel="distance to go [m]", ylabel="heading error [deg]")
    axes.invert_xaxis()  # as time runs
    axes.xaxis.set_major_formatter("{x:g}")
    figure_legend(figure)
    return Picture(figure, f"The heading error over the distance to go: {'; '.join(words)}.")


def endpoints(distance: np.ndarray, errors: Mapping[str, np.ndarray]) -> Picture:
    """The heading error [deg] on arrival of many runs over their first distance [m].

    errors: from a label to those of its runs, a panel each; drawn without their signs, on a
    logarithmic scale, where the least stand on the edge. A dotted line marks what is allowed.
    """
    distance = real("distance", distance, above=0.0)
    check_series(errors)
    figure, row = panels(1, len(errors), 4.5 * len(errors), 4.2, sharey=True, squeeze=False)
    words = []
    for (title, values), axes in zip(errors.items(), row[0], strict=True):
        off = real(title, values)
        same_shape(distance=distance, **{title: off})
        size = np.maximum(np.abs(off), _LEAST)
        axes.plot(distance, size, ".", ms=3, color=COLOURS["path"], rasterized=True)  # lighter
        axes.axhline(_ALLOWED, color=COLOURS["goal"], ls=":", lw=2.0)
        axes.set(title=title, xscale="log", yscale="log", xlabel="distance of the start [m]")
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_formatter("{x:g}")
        good = 100.0 * np.mean(np.abs(off) <= _ALLOWED)
        words.append(f"{title}: {good:.0f} % are within {_ALLOWED:g} deg")
    row[0, 0].set(ylabel="heading error on arrival [deg]")
    return Picture(figure, f"Where {distance.size} runs end, a dot each: {'; '.join(words)}.")


def snapshots(run: Trajectory, times: Sequence[float]) -> Picture:
    """The robot at two to six moments [s] of its run, one panel each, with the path so far."""
    with_samples("run", run)
    times = real("times", list(times), low=0.0, high=float(run.t[-1]))
    check_count("times", times, 2, 6)
    if np.ptp(run.y) > np.ptp(run.x):
        figure, row = panels(1, times.size, 9.0, 5.4, sharey=True)
    else:
        figure, row = panels(times.size, 1, 8.0, 1.75 * times.size + 0.6, sharex=True)
    size = 0.045 * max(np.ptp(run.x), np.ptp(run.y), 1.0)
    goal = pose_at(run.goal, -1)
    texts = []
    for letter, axes, moment in zip("abcdef", row, times, strict=False):
        k = int(np.abs(run.t - moment).argmin())
        axes.plot(run.x, run.y, color=COLOURS["ink"], lw=0.8, ls=":")
        axes.plot(run.x[: k + 1], run.y[: k + 1], color=COLOURS["path"], lw=2.5)
        pose_arrow(axes, goal, size=0.6, zorder=3)
        robot(axes, pose_at(run, k), size=0.8)
        to_go = f"{run.rho[k]:.1f}" if run.rho[k] >= 1 else f"{run.rho[k]:.2f}"
        axes.set_title(f"{letter}) {run.t[k]:.1f} s, {to_go} m to go")
        axes.set(aspect="equal", xlabel="x [m]", ylabel="y [m]")
        axes.set(xlim=_room(run.x, 2.2 * size), ylim=_room(run.y, 2.2 * size))
        axes.label_outer()
        heading = f"heading {math.degrees(run.heading[k]):.0f} deg"
        texts.append(f"{letter} after {run.t[k]:.1f} s, {to_go} m to go, {heading}")
    goal_text = f"the goal's heading is {math.degrees(goal.heading):.0f} deg"
    return Picture(figure, f"Snapshots of one drive: {'; '.join(texts)}; {goal_text}.")


def block_diagram(time_step: float, times_faster: float) -> Picture:
    """The controller's structure from GPS to the robot, with the pose fed back: Fig. 3.

    time_step: of the outer loop, s; times_faster: how often in it the wheel loop acts.
    """
    time_step = scalar("time_step", time_step, above=0.0)
    inner = time_step / scalar("times_faster", times_faster, above=0.0)
    figure, axes = new_figure(8.6, 5.2)
    axes.set_axis_off()
    axes.set(xlim=(0.0, 9.0), ylim=(0.0, 5.0))
    centred = {"ha": "center", "va": "center"}
    for name, does, role, (x, y) in _BOXES:
        looks = {"boxstyle": "round,pad=0.06", "fc": "white", "ec": COLOURS[role], "lw": 2.5}
        axes.add_patch(FancyBboxPatch((x - 1.0, y - 0.6), 2.0, 1.2, **looks))
        axes.text(x, y + 0.32, name, weight="bold", **centred)
        axes.text(x, y - 0.2, does, **centred)
    ink = {"colour": COLOURS["ink"], "lw": 2.0}
    ends = pairwise(centre for *_, centre in _BOXES)
    for signal, ((x0, y0), (x1, y1)) in zip(_SIGNALS, ends, strict=True):
        if y0 == y1:
            gap = math.copysign(1.08, x1 - x0)
            pointer(axes, (x0 + gap, y0), (x1 - gap, y1), **ink)
            axes.text((x0 + x1) / 2, y0 + 0.2, signal, **centred)
        else:
            pointer(axes, (x0, y0 - 0.68), (x1, y1 + 0.68), **ink)
            axes.text(x0 + 0.12, (y0 + y1) / 2, signal, ha="left", va="center")
    # the pose goes back to where the error is formed
    axes.plot([1.2, 1.2, 7.2, 7.2], [2.18, 2.8, 2.8, 3.0], color=COLOURS["ink"], lw=2.0)
    pointer(axes, (7.2, 2.98), (7.2, 3.42), **ink)
    axes.text(4.2, 3.0, f"pose, fed back every {time_step:g} s", **centred)
    axes.plot([1.2, 1.2, 4.5], [0.82, 0.4, 0.4], color=COLOURS["omega"], lw=2.0, ls="--")
    pointer(axes, (4.5, 0.4), (4.5, 0.82), COLOURS["omega"], lw=2.0, ls="--")
    axes.text(2.85, 0.15, f"wheel speeds, fed back every {inner:g} s", **centred)
    return Picture(
        figure,
        f"Block diagram: {' to '.join(name for name, *_ in _BOXES)}; the pose is fed back to the "
        f"polar error every {time_step:g} s, the wheel speeds to the wheel loop every {inner:g} s.",
    )


def _course_in_words(title: str, values: np.ndarray, unit: str) -> str:
    first, last, low, high = values[0], values[-1], values.min(), values.max()
    between = f"between {low:z.2f} and {high:z.2f}"
    return f"{title} goes from {first:z.2f} to {last:z.2f} {unit}, {between}"


def _room(values: np.ndarray, room: float) -> tuple[float, float]:
    return float(values.min() - room), float(values.max() + room)
