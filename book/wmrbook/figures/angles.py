"""Chapter 3: which angle is which, whose sign it has, and what it does over time."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from wmrbook.conventions import CONVENTIONS, translate
from wmrbook.figures._drawing import check_count, note, panels, run_list
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
from wmrlib.checks import instance
from wmrlib.kinematics import Pose, polar_error, wrap_angle
from wmrlib.runs import Trajectory


def third_angle(pose: Pose, goal: Pose) -> Picture:
    """The third angle in both signs, theta on the left, beta = -theta on the right, with users."""
    polar = polar_error(pose, goal)
    rho, theta = polar.rho, polar.theta
    beta = translate(polar, "aicardi", "corke")[2]
    sight = math.atan2(goal.y - pose.y, goal.x - pose.x)
    figure, (left, right) = panels(1, 2, 9.2, 5.0)
    users = {
        sign: ", ".join(_people(name) for name, signs in CONVENTIONS.items() if signs.third == sign)
        for sign in (1, -1)
    }
    ours = f"the paper's (7)-(9), wmrlib,\n{users[1]}"
    theirs = users[-1].replace("gwart, ", "gwart,\n")
    for axes, begin, turn, name, title in (
        (left, goal.heading, theta, r"$\theta$", ours),
        (right, sight, beta, r"$\beta$", theirs),
    ):
        _scene(axes, pose, goal, rho, sight)
        _arc(axes, goal, begin, turn, 0.40 * rho, f"{name} = {_degrees(turn)}", "theta")
        axes.set_title(title)
    return Picture(
        figure,
        f"The same robot and goal twice. Left: theta = {_degrees(theta)}, turned from the goal's "
        f"heading to the line of sight. Right: beta = {_degrees(beta)}, turned back from the line "
        f"of sight to the goal's heading, as in {users[-1]}.",
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

    A robot stands at the last pose of each.
    """
    instance("goal", goal, Pose)
    check_count("tracks", tracks, 1, len(LINES))
    figure, axes = new_figure(6.5, 5.5)
    handles, words = [], []
    roles = "path", "y_error", "omega", "ink"
    for (label, track), style, role in zip(tracks.items(), LINES, roles, strict=False):
        axes.plot(track.x, track.y, style, color=COLOURS[role])
        path = Pose(*np.broadcast_arrays(*track))
        end = pose_at(path, -1)
        pose_arrow(axes, pose_at(path, 0), "start", 0.8)
        robot(axes, end, role)
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


def _people(name: str) -> str:
    return {"pythonrobotics": "PythonRobotics"}.get(name, name.capitalize())


def _degrees(angle: float) -> str:
    return f"{round(math.degrees(angle)):d} deg"


def _span(angle: np.ndarray) -> str:
    low, high = math.degrees(angle.min()), math.degrees(angle.max())
    return f"between {low:z.0f} and {high:z.0f} deg"
