"""Figures of runs: each function takes a Trajectory and returns a Picture."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from wmrbook.figures._drawing import run_list
from wmrbook.figures.style import (
    COLOURS,
    LINES,
    Drive,
    Picture,
    equal_scales,
    new_figure,
    pose_arrow,
    robot,
)
from wmrlib.checks import scalar
from wmrlib.kinematics import Pose, wrap_angle
from wmrlib.runs import Trajectory


def path(
    runs: Trajectory | Sequence[Trajectory],
    labels: Sequence[str] = (),
    *,
    near: float | None = None,
) -> Picture:
    """Show the path of one run, with the robot at every tenth of the way, or of several to compare.

    Parameters
    ----------
    runs : Trajectory, or 1 to 4 of them
    labels : list of one str a run, or none
    near : m, or None; an inset shows the end of the first path so near its goal

    Returns
    -------
    Picture : in metres, with equal scales

    Raises
    ------
    ValueError : another number of runs or labels

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import wmrlib as wmr
    >>> from wmrbook import figures
    >>> start, goal, gains, _ = wmr.paper.outdoor()
    >>> runs = [wmr.simulate(start, goal, chosen) for chosen in (gains, wmr.GENTLE_GAINS)]
    >>> picture = figures.path(runs, labels=["paper", "gentle"], near=2.0)
    >>> picture.figure.savefig(Path(tempfile.mkdtemp()) / "paths.png")
    """
    runs = run_list(runs, labels)
    count, single = len(runs), len(runs) == 1
    figure, axes = new_figure(5.5, 5.5)
    x, y = np.concatenate([run.x for run in runs]), np.concatenate([run.y for run in runs])
    for run, style in zip(runs, LINES, strict=False):
        draw_path(axes, run, style, robots=single)
    if labels:
        lines = [Line2D([], [], color=COLOURS["path"], ls=style) for style in LINES[:count]]
        axes.legend(lines, labels)
    equal_scales(axes, x, y, room=0.12)
    drives = [play(axes, run) for run in runs]
    if near is not None:
        inset = _draw_end(axes, runs[0], scalar("near", near, above=0.0))
        drives.append(play(inset, runs[0]))
    names = [f"{label}: " for label in labels] or [""] * count
    words = [name + path_in_words(run) for name, run in zip(names, runs, strict=True)]
    return Picture(figure, "Path in metres: " + "; ".join(words) + ".", drives)


def play(axes: Axes, run: Trajectory, role: str = "path") -> Drive:
    """What a page needs to play a run."""
    return Drive(axes, run.t, run.x, run.y, run.heading, role)


def _draw_end(axes: Axes, run: Trajectory, near: float) -> Axes:
    """An inset with the last bit of the way, beside the path."""
    goal = pose_at(run.goal, -1)
    left = 0.57 if np.median(run.x) <= np.mean(axes.get_xlim()) else 0.04
    inset = axes.inset_axes([left, 0.05, 0.4, 0.4], aspect="equal")
    inset.plot(run.x, run.y, color=COLOURS["path"])
    pose_arrow(inset, goal, size=0.8)
    inset.set(xlim=(goal.x - near, goal.x + near), ylim=(goal.y - near, goal.y + near))
    inset.set(xticks=[], yticks=[])
    inset.set_title(f"within {near:g} m")
    return inset


def draw_path(axes: Axes, run: Trajectory, style: str = "-", *, robots: bool = True) -> None:
    """Draw the path, start and goal as arrows, and the robot on its way."""
    axes.plot(run.x, run.y, style, color=COLOURS["path"])
    way = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(run.x), np.diff(run.y)))])
    passed = np.searchsorted(way, np.linspace(0.0, 1.0, 7)[1:-1] * way[-1])
    for k in (*passed, -1) if robots else ():  # -1: the robot may turn where it stops
        robot(axes, pose_at(run, k), size=0.8)
    # A goal that moves is shown where it ends.
    pose_arrow(axes, pose_at(run.goal, -1), zorder=3)
    pose_arrow(axes, pose_at(run, 0), "start", 0.8, zorder=3)
    axes.set(xlabel="x [m]", ylabel="y [m]")


def pose_at(path: Pose | Trajectory, k: int) -> Pose:
    """Return the k-th pose of a path."""
    return Pose(*(float(np.ravel(values)[k]) for values in (path.x, path.y, path.heading)))


def path_in_words(run: Trajectory) -> str:
    error = math.degrees(run.heading_error[-1])
    heading = math.degrees(wrap_angle(run.heading[0]))
    cusp = ""
    if k := int(np.argmax(run.v >= 0.0)):  # the first sample at which it does not back up
        there = f"({run.x[k]:z.1f}, {run.y[k]:z.1f}) m"
        cusp = (
            f", backs up for the first {run.t[k]:.1f} s as far as {there}, reverses there in a cusp"
        )
    return (
        f"the robot starts at ({run.x[0]:z.1f}, {run.y[0]:z.1f}) m "
        f"heading {heading:.0f} deg{cusp} and is {run.rho[-1]:.2f} m from the goal "
        f"after {run.t[-1]:.1f} s, its heading {error:.0f} deg from the goal's"
    )
