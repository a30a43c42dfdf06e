"""Figures that compare: several runs on one axis, moments of one run, and what many runs amount to.

`runs` is a dictionary from a label to a Trajectory, up to five; the same label has the same colour and line style in all figures that
are given the labels in the same order.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from wmrlib._checks import choice, instance, real
from wmrlib.kinematics import Pose
from wmrlib.plots.picture import Picture
from wmrlib.plots.style import COLOURS, STYLE, arrow, equal_scales, near_zero, new_figure
from wmrlib.runs import Trajectory

_LOOKS = (
    ("path", "-"),
    ("goal", "--"),
    ("start", "-."),
    ("omega", ":"),
    ("y_error", (0, (6, 1.5, 1, 1.5, 1, 1.5))),
)
_MARKERS = ("o", "s", "^", "D", "v")
_LEAST = 1e-6  # of a logarithmic scale
_FIELDS = {
    "v": ("v [m/s]", "speed v", "m/s"),
    "omega": ("omega [rad/s]", "turning rate omega", "rad/s"),
    "x_error": ("x error [m]", "x error", "m"),
    "y_error": ("y error [m]", "y error", "m"),
    "rho": ("distance to the goal [m]", "distance", "m"),
}


def together(
    runs: Mapping[str, Trajectory],
    field: str,
    *,
    log: bool = False,
    level: tuple[float, str] | None = None,
    until: float | None = None,
) -> Picture:
    """One field of several runs over time: "v", "omega", "x_error", "y_error" or "rho", the distance to the goal.

    log: a logarithmic scale (values below 1e-6 are not drawn); level: a value and its name, drawn as a thin dotted line; until: the last
    second shown. Raises ValueError for no run, more than five, another field, or a level that is not a number.
    """
    _checked(runs)
    label, name, unit = _FIELDS[choice("field", field, _FIELDS)]
    figure, axes = new_figure(7.5, 3.6)
    if not log:
        axes.axhline(0.0, color=COLOURS["ink"], lw=0.8)
    for (title, run), (colour, style) in zip(runs.items(), _LOOKS, strict=False):
        values = getattr(run, field)
        axes.plot(
            run.t,
            np.where(values < _LEAST, np.nan, values) if log else values,
            color=COLOURS[colour],
            ls=style,
            label=title,
        )
    said = ""
    if level is not None:
        value = real("level", level[0])
        axes.axhline(value, color=COLOURS["ink"], lw=1.2, ls=":", label=level[1])
        said = f"; a dotted line marks {level[1]}" + (
            "" if f"{value:g} {unit}" in level[1] else f", {value:g} {unit}"
        )
    axes.set(xlabel="time [s]", ylabel=label)
    if until is not None:
        axes.set_xlim(0.0, until)
    if log:
        axes.set_yscale("log")
        if min(getattr(run, field).min() for run in runs.values()) < _LEAST:
            axes.set_ylim(bottom=_LEAST)
    if len(runs) > 1 or level is not None:
        _legend(figure)
    parts = [_course_in_words(title, getattr(run, field), unit, log) for title, run in runs.items()]
    return Picture(
        figure,
        f"The {name} over time{', on a logarithmic scale' if log else ''}: {'; '.join(parts)}{said}.",
    )


def snapshots(run: Trajectory, times: Sequence[float]) -> Picture:
    """The robot at some moments of its run, one panel each with the way so far, and the goal as an open arrow.

    times: s, two to six, within the run. Raises ValueError for other times.
    """
    instance("run", run, Trajectory)
    times = real("times", list(times), low=0.0, high=float(run.t[-1]))
    if not 2 <= times.size <= 6:
        raise ValueError(f"times has {times.size} entries, which is not allowed: 2 to 6 are needed")
    import matplotlib as mpl
    from matplotlib.figure import Figure

    tall = np.ptp(run.y) > np.ptp(run.x)
    with mpl.rc_context(STYLE):
        figure = Figure(
            figsize=(9.0, 5.4) if tall else (8.0, 1.75 * times.size + 0.6), layout="constrained"
        )
        panels = (
            figure.subplots(1, times.size, sharey=True)
            if tall
            else figure.subplots(times.size, 1, sharex=True)
        )
    size = 0.045 * max(np.ptp(run.x), np.ptp(run.y), 1.0)
    goal = Pose(*(float(np.ravel(each)[-1]) for each in run.goal))
    said = []
    for letter, axes, moment in zip("abcdef", panels, times, strict=False):
        k = int(np.abs(run.t - moment).argmin())
        axes.plot(run.x, run.y, color=COLOURS["ink"], lw=0.8, ls=":")
        axes.plot(run.x[: k + 1], run.y[: k + 1], color=COLOURS["path"], lw=2.5)
        axes.add_patch(arrow(goal, size, fc="none", ec=COLOURS["goal"], lw=2.5, zorder=5))
        axes.add_patch(
            arrow(
                Pose(run.x[k], run.y[k], run.heading[k]),
                size,
                fc=COLOURS["robot"],
                ec=COLOURS["ink"],
                zorder=4,
            )
        )
        to_go = f"{run.rho[k]:.1f}" if run.rho[k] >= 1 else f"{run.rho[k]:.2f}"
        axes.set_title(f"{letter}) {run.t[k]:.1f} s, {to_go} m to go", fontsize=11)
        axes.set(
            aspect="equal",
            xlim=_room(run.x, 2.2 * size),
            ylim=_room(run.y, 2.2 * size),
            xlabel="x [m]",
            ylabel="y [m]",
        )
        axes.label_outer()
        said.append(
            f"{letter} after {run.t[k]:.1f} s, {to_go} m to go, heading {math.degrees(run.heading[k]):.0f} deg"
        )
    return Picture(
        figure,
        f"Snapshots of one drive: {'; '.join(said)}; the goal's heading is {math.degrees(goal.heading):.0f} deg.",
    )


def chase(runs: Mapping[str, Trajectory]) -> Picture:
    """The paths of several runs after the same moving reference, which is drawn grey and wide; equal scales.

    The open arrow is the goal at the first moment, the filled one the robot.
    Raises ValueError for no run or more than five.
    """
    _checked(runs)
    figure, axes = new_figure(6.4, 6.4)
    first = next(iter(runs.values()))
    goal_x, goal_y, goal_heading = (np.broadcast_to(each, first.t.shape) for each in first.goal)
    axes.plot(goal_x, goal_y, color="0.75", lw=7.0, label="reference", solid_capstyle="round")
    for (title, run), (colour, style) in zip(runs.items(), _LOOKS, strict=False):
        axes.plot(run.x, run.y, color=COLOURS[colour], ls=style, label=title)
    every_x = np.concatenate([goal_x, *(run.x for run in runs.values())])
    every_y = np.concatenate([goal_y, *(run.y for run in runs.values())])
    start = Pose(first.x[0], first.y[0], first.heading[0])
    size = 0.03 * max(np.ptp(every_x), np.ptp(every_y))
    axes.add_patch(arrow(start, size, fc=COLOURS["robot"], ec=COLOURS["ink"], zorder=4))
    axes.add_patch(
        arrow(
            Pose(goal_x[0], goal_y[0], goal_heading[0]),
            size,
            fc="white",
            ec=COLOURS["goal"],
            lw=2.0,
            zorder=3,
        )
    )
    equal_scales(axes, every_x, every_y)
    side = -1 if goal_x[0] > sum(axes.get_xlim()) / 2 else 1  # inside the axes
    looks = {
        "textcoords": "offset points",
        "ha": "left" if side > 0 else "right",
        "va": "center",
        "fontsize": 11,
    }
    axes.annotate("goal at 0 s", (goal_x[0], goal_y[0]), xytext=(12 * side, 0), **looks)
    axes.set(xlabel="x [m]", ylabel="y [m]")
    _legend(figure)
    parts = [
        f"{title} {f'{run.rho[-1]:.3f}' if run.rho[-1] >= 5e-4 else 'less than 0.001'} m"
        for title, run in runs.items()
    ]
    return Picture(
        figure,
        f"{_course_of_goal(goal_x, goal_y)}, and {'the robot that starts' if len(runs) == 1 else f'{len(runs)} robots that start'} at "
        f"({start.x:g}, {start.y:g}) m; distance from the goal at the end: {'; '.join(parts)}.",
    )


def residual_curve(v_max, simulated, predict: Callable, *, published: float) -> Picture:
    """What is left of the distance against v_max: simulated as circles, predicted as a line, and the paper's value.

    v_max in m/s, increasing, and simulated in metres, arrays of one length; predict: a function from an array of v_max to metres;
    published: metres. Raises ValueError for mismatched lengths.
    """
    v_max, simulated = real("v_max", v_max, above=0.0), real("simulated", simulated, low=0.0)
    if np.shape(v_max) != np.shape(simulated) or np.ndim(v_max) != 1:
        raise ValueError(
            f"mismatched lengths: v_max {np.shape(v_max)}, simulated {np.shape(simulated)}; equal ones are needed"
        )
    fine = np.linspace(v_max[0], v_max[-1], 300)
    figure, axes = new_figure(7.0, 3.6)
    axes.plot(fine, predict(fine), color=COLOURS["path"], label="predicted")
    axes.plot(
        v_max, simulated, "o", color=COLOURS["goal"], mfc="none", mew=2.0, ms=8, label="simulated"
    )
    axes.axhline(
        published, color=COLOURS["ink"], ls=":", lw=1.2, label=f"the paper's {published:g} m"
    )
    axes.set(
        xlabel="v_max [m/s]",
        ylabel="distance left behind [m]",
        ylim=(0.0, 1.08 * max(simulated.max(), predict(fine).max())),
    )
    axes.legend()
    return Picture(
        figure,
        f"The distance left behind falls from {simulated[0]:.3f} m at v_max {v_max[0]:g} m/s to {simulated[-1]:.3f} m at "
        f"{v_max[-1]:g} m/s; prediction and simulation differ by at most {np.abs(simulated - predict(v_max)).max():.4f} m; "
        f"a dotted line marks the paper's {published:g} m.",
    )


def heading_shares(errors: Mapping[str, np.ndarray], *, allowed: float = 5.0) -> Picture:
    """How many of many runs end with at most so many degrees of heading error: the cumulative share, one line for each label.

    errors: |heading error| in degrees of each run; allowed: deg, marked by a dotted line. Raises ValueError for NaN or no run.
    """
    _checked(errors, None)
    figure, axes = new_figure(7.0, 3.8)
    widest = min(
        180.0, 1.1 * max(np.abs(real(title, values)).max() for title, values in errors.items())
    )
    said = []
    for (title, values), (colour, style) in zip(errors.items(), _LOOKS, strict=False):
        values = np.sort(np.abs(real(title, values)))
        share = 100.0 * np.arange(1, values.size + 1) / values.size
        axes.plot(
            np.r_[0.0, values, widest],
            np.r_[0.0, share, 100.0],
            drawstyle="steps-post",
            color=COLOURS[colour],
            ls=style,
            label=title,
        )
        said.append(
            f"{title} {100.0 * np.mean(values > allowed):.1f} % end more than {allowed:g} deg off, the worst {values[-1]:.1f} deg"
        )
    axes.axvline(allowed, color=COLOURS["ink"], ls=":", lw=1.2, label=f"{allowed:g} deg")
    axes.set(
        xlabel="heading error at arrival [deg]",
        ylabel="share of the starts [%]",
        xlim=(0, widest),
        ylim=(0, 102),
    )
    _legend(figure)
    return Picture(
        figure, f"Share of many starts against the heading error at arrival: {'; '.join(said)}."
    )


def tradeoff(
    groups: Mapping[str, tuple], mark: tuple[float, float, str], *, xlabel: str, ylabel: str
) -> Picture:
    """Many runs as points, one marker for each group: groups maps a label to (x, y) arrays; mark is one run (x, y, name), drawn as a star.

    Logarithmic scales. Raises ValueError for values that are not positive, or more than five groups.
    """
    _checked(groups, None)
    figure, axes = new_figure(7.0, 5.0)
    said = []
    for (title, (x, y)), (colour, _), marker in zip(groups.items(), _LOOKS, _MARKERS, strict=False):
        x, y = real(f"{title} x", x, above=0.0), real(f"{title} y", y, above=0.0)
        axes.plot(x, y, marker, color=COLOURS[colour], ms=5, mfc="none", mew=1.2, label=title)
        said.append(f"{title} from {y.min():.2g} to {y.max():.2g}")
    axes.plot(
        *mark[:2], "*", ms=20, color=COLOURS["V_rising"], mec="white", label=mark[2], zorder=5
    )
    axes.axvline(mark[0], color=COLOURS["ink"], lw=1.0, ls=":")
    axes.axhline(mark[1], color=COLOURS["ink"], lw=1.0, ls=":")
    axes.set(xscale="log", yscale="log", xlabel=xlabel, ylabel=ylabel)
    _plain_ticks(axes)
    _legend(figure)
    return Picture(
        figure,
        f"{ylabel} against {xlabel}, a point for each run: {'; '.join(said)}; {mark[2]} at ({mark[0]:.2f}, {mark[1]:.2f}).",
    )


def _plain_ticks(axes) -> None:
    from matplotlib.ticker import FuncFormatter, LogLocator

    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_locator(LogLocator(subs=()))


def _legend(figure) -> None:
    labels = figure.axes[0].get_legend_handles_labels()[1]
    width = 0.7 + 0.095 * max(map(len, labels))  # inches an entry, handle included
    columns = max(1, min(len(labels), int(figure.get_figwidth() / width)))
    rows = -(-len(labels) // columns)
    figure.legend(
        loc="outside upper center", ncols=-(-len(labels) // rows), fontsize=11, frameon=False
    )


def _checked(runs: Mapping, kind: type | None = Trajectory) -> None:
    if not 1 <= len(instance("runs", runs, Mapping)) <= len(_LOOKS):
        raise ValueError(
            f"runs has {len(runs)} entries, which is not allowed: 1 to {len(_LOOKS)} are needed"
        )
    if kind is not None:
        for title, run in runs.items():
            instance(f"runs[{title!r}]", run, kind)


def _course_in_words(title: str, values: np.ndarray, unit: str, log: bool) -> str:
    digits = 1 if np.abs(values).max() > 5 else 2

    def said(value: float) -> str:
        if log:
            return f"{value:.2g}" if value >= _LEAST else "less than 1e-6"
        if abs(value) < 0.5 * 10**-digits:
            return "nearly 0" if values.min() < -1e-9 else f"less than {10**-digits:g}"
        return f"{value:.{digits}f}"

    first, last, low, high = map(said, (values[0], values[-1], values.min(), values.max()))
    between = "" if {low, high} == {first, last} else f", between {low} and {high} {unit}"
    return f"{title} goes from {first} to {last} {unit}{between}"


def _course_of_goal(x: np.ndarray, y: np.ndarray) -> str:
    begin, end = (f"({near_zero(x[k]):.3g}, {near_zero(y[k]):.3g})" for k in (0, -1))
    far = max(np.ptp(x), np.ptp(y))
    (a, b, c), *_ = np.linalg.lstsq(
        np.column_stack([2.0 * x, 2.0 * y, np.ones_like(x)]), x**2 + y**2, rcond=None
    )
    radius = math.sqrt(max(c + a**2 + b**2, 0.0))
    if far < 1e-9:
        return f"A goal that stands still at {begin} m"
    if np.abs(np.hypot(x - a, y - b) - radius).max() > 1e-6 * far:
        return f"A grey reference from {begin} m to {end} m"
    turns = np.ptp(np.unwrap(np.arctan2(y - b, x - a))) / (2.0 * math.pi)
    driven = "once round" if abs(turns - 1.0) < 0.005 else f"{turns:.2g} times round"
    way = "counter-clockwise" if (x[0] - a) * (y[1] - b) > (y[0] - b) * (x[1] - a) else "clockwise"
    centre = f"({near_zero(a):.3g}, {near_zero(b):.3g})"
    return f"A grey reference circle of radius {radius:.3g} m about {centre} m, driven {driven} {way} from {begin} m"


def _room(values: np.ndarray, room: float) -> tuple[float, float]:
    return float(values.min() - room), float(values.max() + room)
