"""Chapter 3: which angle is which, whose sign it has, and what it does over time."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from wmrbook.conventions import CONVENTIONS, translate
from wmrbook.figures._drawing import check_count, note, panels, pointer, run_list
from wmrbook.figures.paths import pose_at
from wmrbook.figures.style import (
    COLOURS,
    LINES,
    Picture,
    equal_scales,
    new_figure,
    pose_arrow,
    robot,
)
from wmrlib.checks import instance, reals, refusal
from wmrlib.kinematics import Pose, polar_error, wrap_angle
from wmrlib.runs import Trajectory

AUTHORS = {"Yousif and Ali": "aicardi", "Siegwart": "siegwart", "Corke": "corke"}
"""Whose third angle is drawn: the paper's from its (7) on is Aicardi's."""


def third_angle(pose: Pose, goal: Pose) -> Picture:
    """The third angle of the paper, of Siegwart and of Corke, one picture each, with its sign."""
    polar = polar_error(pose, goal)
    sight = math.atan2(goal.y - pose.y, goal.x - pose.x)
    figure, row = panels(1, 3, 10.0, 2.4)
    words = []
    for axes, (author, convention) in zip(row, AUTHORS.items(), strict=True):
        turn = translate(polar, "aicardi", convention)[2]
        ours = CONVENTIONS[convention].third == 1
        begin, name = (goal.heading, "theta") if ours else (sight, "beta")
        rho = polar.rho
        axes.plot([pose.x, goal.x], [pose.y, goal.y], "--", color=COLOURS["rho"])
        looks = {"color": COLOURS["rho"], "ls": "--"}
        _ray(axes, goal, sight, 0.6 * rho, "line of sight", **looks)
        _ray(axes, goal, goal.heading, 0.6 * rho, "goal's heading", color=COLOURS["goal"])
        robot(axes, pose, "path")
        pose_arrow(axes, goal, "goal")
        _arc(axes, goal, begin, turn, 0.45 * rho, rf"$\{name}$ = {_degrees(turn)}", "theta")
        axes.set_title(author)
        axes.set_axis_off()
        _frame(axes, goal.x + rho * np.array([-1.1, 1.5]), goal.y + rho * np.array([-0.65, 0.35]))
        words.append(
            f"{author}: {name} = {_degrees(turn)}, "
            + (
                "turned from the goal's heading to the line of sight"
                if ours
                else "turned back from the line of sight to the goal's heading"
            )
        )
    return Picture(figure, f"The same robot and goal three times. {'; '.join(words)}.")


def velocity_split(pose: Pose, goal: Pose, v: float) -> Picture:
    """The robot's velocity at v [m/s], split into a part along the line of sight and one across."""
    rho, alpha, _ = polar_error(pose, goal)
    (v,) = reals(v=v)
    if v == 0.0:
        raise refusal("v", v, "a speed other than 0")
    sight = math.atan2(goal.y - pose.y, goal.x - pose.x)
    along, across = v * math.cos(alpha), v * math.sin(alpha)
    figure, axes = new_figure(7.0, 3.8)
    axes.plot([pose.x, goal.x], [pose.y, goal.y], "--", color=COLOURS["rho"])
    pose_arrow(axes, goal, "goal")
    robot(axes, pose, "path")
    _arc(axes, pose, pose.heading, alpha, 0.12 * rho, r"$\alpha$", "alpha")
    scale = 0.45 * rho / abs(v)
    corner = _ahead(pose, sight, scale * along)
    tip = _ahead(pose, pose.heading, scale * v)
    for begin, end, role, label, offset in (
        (pose[:2], tip, "path", rf"$v$ = {v:.2f} m/s", (-10, 8)),
        (pose[:2], corner, "rho", rf"$v\,\cos\alpha$ = {along:.2f} m/s", (10, -20)),
        (corner, tip, "theta", rf"$v\,\sin\alpha$ = {across:.2f} m/s", (12, 6)),
    ):
        pointer(axes, begin, end, COLOURS[role], lw=2.5, mutation_scale=18)
        middle = [0.5 * (one + other) for one, other in zip(begin, end, strict=True)]
        side = "right" if offset[0] < 0 else "left"
        note(axes, label, middle, offset, ha=side, color=COLOURS[role])
    x, y = np.transpose([pose[:2], goal[:2], tip, corner])
    _frame(axes, x, y, 0.15 * rho)
    axes.set(xlabel="x [m]", ylabel="y [m]")
    return Picture(
        figure,
        f"The robot, its goal {rho:.2f} m away, and its velocity of {v:.2f} m/s, split: "
        f"{along:.2f} m/s along the line of sight and {across:.2f} m/s across it.",
    )


def draw_angles(axes: Axes, pose: Pose, goal: Pose) -> None:
    """Draw robot, goal and line of sight, and name rho, alpha and theta."""
    rho, alpha, theta = polar_error(pose, goal)
    sight = math.atan2(goal.y - pose.y, goal.x - pose.x)
    _scene(axes, pose, goal, rho, sight)
    for at, turn, role in ((pose, alpha, "alpha"), (goal, theta, "theta")):
        _arc(axes, at, at.heading, turn, 0.4 * rho, rf"$\{role}$", role, fontsize=20)
    middle = 0.5 * (pose.x + goal.x), 0.5 * (pose.y + goal.y)
    note(axes, r"$\rho$", middle, (12, -14), fontsize=20, ha="center", va="center")


def path_choices(tracks: Mapping[str, Pose], goal: Pose) -> Picture:
    """The paths of one to four robots to one goal, each a Pose of arrays [m, rad] by its label.

    A robot stands at the last pose of each, the first one largest, for all may end at the goal.
    """
    instance("goal", goal, Pose)
    check_count("tracks", tracks, 1, len(LINES))
    figure, axes = new_figure(6.5, 5.5)
    handles, words = [], []
    roles = "path", "y_error", "omega", "ink"
    sizes = np.arange(len(tracks), 0, -1) * 0.7 + 0.3
    for (label, track), style, role, size in zip(tracks.items(), LINES, roles, sizes, strict=False):
        axes.plot(track.x, track.y, style, color=COLOURS[role])
        path = Pose(*np.broadcast_arrays(*track))
        end = pose_at(path, -1)
        pose_arrow(axes, pose_at(path, 0), "start", 0.8)
        robot(axes, end, role, size)
        handles.append(Line2D([], [], color=COLOURS[role], ls=style, label=label))
        left = math.degrees(wrap_angle(end.heading - goal.heading))
        distance = math.hypot(goal.x - end.x, goal.y - end.y)
        words.append(
            f"{label}: ends {distance:.2f} m from the goal, its heading {left:z.0f} deg off"
        )
    pose_arrow(axes, goal, zorder=3)
    above = {"loc": "upper center", "bbox_to_anchor": (0.5, 1.0 + 0.09 * len(handles))}
    axes.legend(handles=handles, frameon=False, **above)
    x, y = (np.concatenate([getattr(track, axis) for track in tracks.values()]) for axis in "xy")
    equal_scales(axes, x, y, 0.15)
    axes.set(xlabel="x [m]", ylabel="y [m]")
    alt = "Ways in metres, a green arrow is a start, the orange one the goal. "
    return Picture(figure, f"{alt}{'; '.join(words)}.")


def angles_over_time(
    runs: Trajectory | Sequence[Trajectory], labels: Sequence[str] = ()
) -> Picture:
    """Alpha and theta [deg] over time of one to four runs, with the half turns marked."""
    runs = run_list(runs, labels)
    figure, rows = new_figure(7.5, 5.0, rows=2)
    names = list(labels) or [f"run {k}" for k in range(1, len(runs) + 1)]
    for axes, name in zip(rows, ("alpha", "theta"), strict=True):
        for run, style, label in zip(runs, LINES, names, strict=False):
            degrees = np.degrees(getattr(run, name))
            jumps = np.flatnonzero(np.abs(np.diff(degrees)) > 180.0) + 1
            times, degrees = np.insert(run.t, jumps, np.nan), np.insert(degrees, jumps, np.nan)
            axes.plot(times, degrees, style, color=COLOURS[name], label=label)
        for half_turn in (-180.0, 180.0):
            axes.axhline(half_turn, color=COLOURS["ink"], lw=1.0, ls=":")
        axes.set(ylabel=f"{name} [deg]", yticks=np.arange(-180, 181, 90))
        axes.margins(x=0.01)
    rows[1].set_xlabel("time [s]")
    if len(runs) > 1:
        above = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0), "ncols": len(runs)}
        rows[0].legend(fontsize=11, frameon=False, **above)
    words = [
        f"{label}: alpha {_span(run.alpha)}, theta {_span(run.theta)}"
        for run, label in zip(runs, names, strict=True)
    ]
    alt = "Angles over time, in degrees; dotted lines mark the half turns. "
    return Picture(figure, f"{alt}{'; '.join(words)}.")


def _scene(axes: Axes, pose: Pose, goal: Pose, rho: float, sight: float) -> None:
    """Robot, goal, their headings and the line of sight, with room for the angles."""
    for at, role, name, draw in (
        (pose, "path", "robot", robot),
        (goal, "goal", "goal", pose_arrow),
    ):
        style = {"color": COLOURS[role], "lw": 2.0, "ls": "-"}
        _ray(axes, at, at.heading, 0.62 * rho, f"{name}'s heading", **style)
        draw(axes, at, role)
        # square to the line of sight, away from the heading
        aside = sight + math.copysign(math.pi / 2, math.sin(sight - at.heading))
        offset = 36.0 * math.cos(aside), 28.0 * math.sin(aside)
        note(axes, name, (at.x, at.y), offset, ha="center", va="center")
    axes.plot([pose.x, goal.x], [pose.y, goal.y], "--", color=COLOURS["rho"])
    _ray(axes, goal, sight, 0.62 * rho, "line of sight", color=COLOURS["rho"], lw=1.2, ls="--")
    axes.set(xlabel="x [m]", ylabel="y [m]")
    x = np.add.outer([pose.x, goal.x], rho * np.array([-0.32, 0.98]))
    y = np.add.outer([pose.y, goal.y], rho * np.array([-0.25, 0.62]))
    equal_scales(axes, x, y, 0.0)


def _ray(axes: Axes, at: Pose, heading: float, length: float, label: str, **looks) -> None:
    """A line that begins at `at`, with its name at its end."""
    end = at.x + length * math.cos(heading), at.y + length * math.sin(heading)
    axes.plot([at.x, end[0]], [at.y, end[1]], **looks)
    note(axes, label, end, (4, 0), va="center", color=looks["color"])


def _arc(
    axes: Axes,
    at: Pose,
    begin: float,
    turn: float,
    radius: float,
    label: str,
    role: str,
    fontsize: float = 15,
) -> None:
    """An arc with an arrowhead where it ends, which shows its sign, and its name outside."""
    colour = COLOURS[role]
    angles = begin + turn * np.linspace(0.0, 1.0, 60)
    x, y = at.x + radius * np.cos(angles), at.y + radius * np.sin(angles)
    axes.plot(x[:-2], y[:-2], color=colour, lw=2.2, zorder=3)
    head = {"arrowstyle": "-|>", "color": colour, "lw": 0.0, "mutation_scale": 20}
    axes.annotate("", (x[-1], y[-1]), xytext=(x[-5], y[-5]), arrowprops=head, zorder=4)
    cos, sin = math.cos(begin + 0.5 * turn), math.sin(begin + 0.5 * turn)
    x, y = at.x + 1.08 * radius * cos, at.y + 1.08 * radius * sin
    side = "left" if cos > 0.0 else "right"
    axes.text(x, y, label, color=colour, fontsize=fontsize, ha=side, va="center")


def _frame(axes: Axes, x: np.ndarray, y: np.ndarray, room: float = 0.0) -> None:
    """Show the points in equal scales, with `room` around them, as wide and high as they are."""
    xlim, ylim = ((it.min() - room, it.max() + room) for it in (x, y))
    axes.set(xlim=xlim, ylim=ylim, aspect="equal")


def _ahead(pose: Pose, direction: float, length: float) -> tuple[float, float]:
    return pose.x + length * math.cos(direction), pose.y + length * math.sin(direction)


def _degrees(angle: float) -> str:
    return f"{round(math.degrees(angle)):d} deg"


def _span(angle: np.ndarray) -> str:
    low, high = math.degrees(angle.min()), math.degrees(angle.max())
    return f"between {low:z.0f} and {high:z.0f} deg"
