"""Chapter 5: several runs on one axis, moments of one run, many runs, and the block diagram.

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
    Drive,
    Picture,
    equal_scales,
    new_figure,
    pose_arrow,
    robot,
)
from wmrlib.checks import choice, real, scalar
from wmrlib.kinematics import Pose
from wmrlib.runs import Trajectories, Trajectory, with_samples

_LEAST = 1e-6  # of a logarithmic scale
_STEPS = 300  # of a line: more are smaller than a pixel, and weigh tens of kilobytes
_ALLOWED = 5.0  # deg, of a heading
_FIELDS = {
    "v": ("v [m/s]", "speed v", "m/s"),
    "omega": ("omega [rad/s]", "turning rate omega", "rad/s"),
    "rho": ("distance to the goal [m]", "distance", "m"),
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


def compare_runs(
    runs: Mapping[str, Trajectory],
    field: str,
    *,
    log: bool = False,
    level: tuple[float, str] | None = None,
) -> Picture:
    """One field of several runs over time: "v", "omega" or "rho".

    log: a logarithmic scale (values below 1e-6 are not drawn); level: a value and its name, drawn
    as a thin dotted line.
    """
    check_series(runs, Trajectory)
    label, name, unit = _FIELDS[choice("field", field, _FIELDS)]
    figure, axes = new_figure(7.5, 3.6)
    if not log:
        axes.axhline(0.0, color=COLOURS["ink"], lw=0.8)
    fields = {title: getattr(run, field) for title, run in runs.items()}
    for (title, run), (role, style) in zip(runs.items(), SERIES, strict=False):
        values = fields[title]
        drawn = np.where(values < _LEAST, np.nan, values) if log else values
        axes.plot(run.t, drawn, color=COLOURS[role], ls=style, label=title)
    mark = ""
    if level is not None:
        value = real("level", level[0])
        axes.axhline(value, color=COLOURS["ink"], lw=1.2, ls=":", label=level[1])
        number = "" if f"{value:g} {unit}" in level[1] else f", {value:g} {unit}"
        mark = f"; a dotted line marks {level[1]}{number}"
    axes.set(xlabel="time [s]", ylabel=label)
    if log:
        axes.set_yscale("log")
        if min(values.min() for values in fields.values()) < _LEAST:
            axes.set_ylim(bottom=_LEAST)
    if len(runs) > 1 or level is not None:
        figure_legend(figure)
    parts = [_course_in_words(title, values, unit, log) for title, values in fields.items()]
    scale = ", on a logarithmic scale" if log else ""
    return Picture(figure, f"The {name} over time{scale}: {'; '.join(parts)}{mark}.")


def ring(paths: Mapping[str, Trajectories], goal: Pose) -> Picture:
    """The paths of many runs to one goal, a panel for each label: the field's icon.

    Starts that face alike, on a circle round the goal, show a law's habits at a glance.
    """
    check_series(paths, Trajectories)
    figure, row = panels(1, len(paths), 3.5 * len(paths), 3.8, sharey=True, squeeze=False)
    texts, drives = [], []
    for (title, many), axes in zip(paths.items(), row[0], strict=True):
        steps = np.hypot(np.diff(many.x), np.diff(many.y))
        axes.plot(many.x.T, many.y.T, color=COLOURS["path"], lw=1.3)
        for k in range(len(many.x)):
            robot(axes, Pose(many.x[k, 0], many.y[k, 0], many.heading[k, 0]), "start", 0.5)
        pose_arrow(axes, goal, size=0.6)
        axes.set_title(title)
        equal_scales(axes, np.r_[many.x[:, 0], goal.x], np.r_[many.y[:, 0], goal.y], room=0.2)
        axes.set(xlabel="x [m]", ylabel="y [m]")
        axes.label_outer()
        for x, y, heading in zip(many.x, many.y, many.heading, strict=True):
            driven = np.isfinite(x)
            drives.append(Drive(axes, many.t[driven], x[driven], y[driven], heading[driven]))
        backing = int((many.v[:, 0] < -1e-9).sum())
        longest = np.nansum(steps, axis=1).max()
        texts.append(f"{title} {backing} set off backwards, the longest path has {longest:.1f} m")
    figure.draw_without_rendering()  # the layout knows titles beside equal scales only then
    count, far = len(many.x), many.rho[:, 0].max()
    what = f"Paths to a goal from {count} starts on a circle of {far:.0f} m"
    return Picture(figure, f"{what}: {'; '.join(texts)}.", drives)


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


def heading_shares(
    errors: Mapping[str, np.ndarray], *, of: str = "heading error at arrival"
) -> Picture:
    """The cumulative share of runs over their heading error [deg], one line for each label.

    A dotted line marks the error that is allowed; `of` says which error it is.
    """
    check_series(errors)
    figure, axes = new_figure(7.0, 3.8)
    sizes = {title: np.sort(np.abs(real(title, values))) for title, values in errors.items()}
    widest = min(180.0, 1.1 * max(values[-1] for values in sizes.values()))
    texts = []
    for (title, values), (role, style) in zip(sizes.items(), SERIES, strict=False):
        share = 100.0 * np.arange(1, values.size + 1) / values.size
        drawn = np.unique(np.linspace(0, values.size - 1, _STEPS).round().astype(int))
        steps = np.r_[0.0, values[drawn], widest], np.r_[0.0, share[drawn], 100.0]
        axes.plot(*steps, drawstyle="steps-post", color=COLOURS[role], ls=style, label=title)
        off = f"{100.0 * np.mean(values > _ALLOWED):.1f} % are more than {_ALLOWED:g} deg off"
        texts.append(f"{title} {off}, the worst {values[-1]:.1f} deg")
    axes.axvline(_ALLOWED, color=COLOURS["ink"], ls=":", lw=1.2, label=f"{_ALLOWED:g} deg")
    axes.set(xlabel=f"{of} [deg]", ylabel="share of the starts [%]")
    axes.set(xscale="log", xlim=(0.1, widest), ylim=(0, 102))
    axes.xaxis.set_major_formatter("{x:g}")
    figure_legend(figure)
    what = f"Share of many starts against the {of}"
    return Picture(figure, f"{what}: {'; '.join(texts)}.")


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


def _course_in_words(title: str, values: np.ndarray, unit: str, log: bool) -> str:
    digits = 1 if np.abs(values).max() > 5 else 2

    def rounded(value: float) -> str:
        if log:
            return f"{value:.2g}" if value >= _LEAST else "less than 1e-6"
        if abs(value) < 0.5 * 10**-digits:
            return "nearly 0" if values.min() < -1e-9 else f"less than {10**-digits:g}"
        return f"{value:.{digits}f}"

    first, last, low, high = map(rounded, (values[0], values[-1], values.min(), values.max()))
    between = "" if {low, high} == {first, last} else f", between {low} and {high} {unit}"
    return f"{title} goes from {first} to {last} {unit}{between}"


def _room(values: np.ndarray, room: float) -> tuple[float, float]:
    return float(values.min() - room), float(values.max() + room)
