"""Chapter 7: robots that follow a moving reference, and what is left of their distance from it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np
from matplotlib.ticker import LogLocator

from wmrbook.figures._drawing import SERIES, check_series, figure_legend, note
from wmrbook.figures.paths import play, pose_at
from wmrbook.figures.style import COLOURS, Drive, Picture, equal_scales, new_figure, pose_arrow
from wmrlib.checks import real
from wmrlib.kinematics import Pose
from wmrlib.runs import Trajectory

_MARKERS = ("o", "s", "^", "D", "v")


def chase(runs: Mapping[str, Trajectory]) -> Picture:
    """The paths of one to five runs after one moving reference, which is drawn grey and wide.

    The orange arrow is the goal at the first moment, the green one the robot.
    """
    check_series(runs, Trajectory)
    figure, axes = new_figure(6.4, 6.4)
    first = next(iter(runs.values()))
    goal = Pose(*(np.broadcast_to(field, first.t.shape) for field in first.goal))
    wide = {"color": "0.75", "lw": 7.0, "solid_capstyle": "round"}
    axes.plot(goal.x, goal.y, label="reference", **wide)
    drives = [Drive(axes, first.t, goal.x, goal.y, goal.heading, "goal")]
    for (title, run), (role, style) in zip(runs.items(), SERIES, strict=False):
        axes.plot(run.x, run.y, color=COLOURS[role], ls=style, label=title)
        drives.append(play(axes, run, role))
    every_x = np.concatenate([goal.x, *(run.x for run in runs.values())])
    every_y = np.concatenate([goal.y, *(run.y for run in runs.values())])
    start, target = pose_at(first, 0), pose_at(goal, 0)
    pose_arrow(axes, start, "start", 0.8)
    pose_arrow(axes, target, size=0.8)
    equal_scales(axes, every_x, every_y)
    inward, ha = (-12, "right") if target.x > sum(axes.get_xlim()) / 2 else (12, "left")
    note(axes, "goal at 0 s", target[:2], (inward, 0), ha=ha, va="center")
    axes.set(xlabel="x [m]", ylabel="y [m]")
    figure_legend(figure)
    left = (
        f"{run.rho[-1]:.3f}" if run.rho[-1] >= 5e-4 else "less than 0.001" for run in runs.values()
    )
    parts = [f"{title} {distance} m" for title, distance in zip(runs, left, strict=True)]
    who = "the robot that starts" if len(runs) == 1 else f"{len(runs)} robots that start"
    return Picture(
        figure,
        f"{_course_of_goal(goal.x, goal.y)}, and {who} at ({start.x:g}, {start.y:g}) m; "
        f"distance from the goal at the end: {'; '.join(parts)}.",
        drives,
    )


def residual_curve(v_max, simulated, predict: Callable, *, published: float) -> Picture:
    """The distance left behind [m] against v_max [m/s]: simulated, predicted and the paper's.

    v_max increases; predict is a function from an array of v_max to metres.
    """
    v_max, simulated = real("v_max", v_max, above=0.0), real("simulated", simulated, low=0.0)
    if np.shape(v_max) != np.shape(simulated) or np.ndim(v_max) != 1:
        shapes = f"v_max {np.shape(v_max)}, simulated {np.shape(simulated)}"
        raise ValueError(f"mismatched lengths: {shapes}; equal ones are needed")
    fine = np.linspace(v_max[0], v_max[-1], 300)
    figure, axes = new_figure(7.0, 3.6)
    axes.plot(fine, predict(fine), color=COLOURS["path"], label="predicted")
    circles = {"color": COLOURS["ink"], "mfc": "none", "mew": 2.0, "ms": 8}
    axes.plot(v_max, simulated, "o", label="simulated", **circles)
    label = f"the paper's {published:g} m"
    axes.axhline(published, color=COLOURS["ink"], ls=":", lw=1.2, label=label)
    axes.set(xlabel="v_max [m/s]", ylabel="distance left behind [m]")
    axes.set_ylim(0.0, 1.08 * max(simulated.max(), predict(fine).max()))
    axes.legend()
    worst = np.abs(simulated - predict(v_max)).max()
    return Picture(
        figure,
        f"The distance left behind falls from {simulated[0]:.3f} m at v_max {v_max[0]:g} m/s "
        f"to {simulated[-1]:.3f} m at {v_max[-1]:g} m/s; prediction and simulation differ by "
        f"at most {worst:.4f} m; a dotted line marks the paper's {published:g} m.",
    )


def tradeoff(
    groups: Mapping[str, tuple], mark: tuple[float, float, str], *, xlabel: str, ylabel: str
) -> Picture:
    """Many runs as points on logarithmic scales, one marker for each of up to five groups.

    groups: from a label to (x, y), positive arrays; mark: one run (x, y, name), drawn as a star.
    """
    check_series(groups)
    figure, axes = new_figure(7.0, 5.0)
    texts = []
    for (title, (x, y)), (role, _), marker in zip(groups.items(), SERIES, _MARKERS, strict=False):
        x, y = real(f"{title} x", x, above=0.0), real(f"{title} y", y, above=0.0)
        axes.plot(x, y, marker, color=COLOURS[role], ms=5, mfc="none", mew=1.2, label=title)
        texts.append(f"{title} from {y.min():.2g} to {y.max():.2g}")
    star = {"ms": 20, "color": COLOURS["ink"], "mec": "white", "zorder": 5}
    axes.plot(*mark[:2], "*", label=mark[2], **star)
    axes.axvline(mark[0], color=COLOURS["ink"], lw=1.0, ls=":")
    axes.axhline(mark[1], color=COLOURS["ink"], lw=1.0, ls=":")
    axes.set(xscale="log", yscale="log", xlabel=xlabel, ylabel=ylabel)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_locator(LogLocator(subs=()))
    figure_legend(figure)
    return Picture(
        figure,
        f"{ylabel} against {xlabel}, a point for each run: {'; '.join(texts)}; "
        f"{mark[2]} at ({mark[0]:.2f}, {mark[1]:.2f}).",
    )


def _near_zero(value: float) -> float:
    return value if abs(value) >= 0.05 else 0.0


def _course_of_goal(x: np.ndarray, y: np.ndarray) -> str:
    """Where the goal stands or goes; a circle is found by least squares."""
    begin, end = (f"({_near_zero(x[k]):.3g}, {_near_zero(y[k]):.3g})" for k in (0, -1))
    far = max(np.ptp(x), np.ptp(y))
    if far < 1e-9:
        return f"A goal that stands still at {begin} m"
    rows = np.column_stack([2.0 * x, 2.0 * y, np.ones_like(x)])
    (a, b, c), *_ = np.linalg.lstsq(rows, x**2 + y**2, rcond=None)
    radius = math.sqrt(max(c + a**2 + b**2, 0.0))
    if np.abs(np.hypot(x - a, y - b) - radius).max() > 1e-6 * far:
        return f"A grey reference from {begin} m to {end} m"
    turns = np.ptp(np.unwrap(np.arctan2(y - b, x - a))) / (2.0 * math.pi)
    driven = "once round" if abs(turns - 1.0) < 0.005 else f"{turns:.2g} times round"
    left = (x[0] - a) * (y[1] - b) > (y[0] - b) * (x[1] - a)
    return (
        f"A grey reference circle of radius {radius:.3g} m "
        f"about ({_near_zero(a):.3g}, {_near_zero(b):.3g}) m, "
        f"driven {driven} {'counter-clockwise' if left else 'clockwise'} from {begin} m"
    )
