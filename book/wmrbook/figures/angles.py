"""Figures of angles: which one is which, whose sign it has, and what it does over time."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from wmrbook.conventions import CONVENTIONS, translate
from wmrlib._checks import instance
from wmrlib.kinematics import Pose, polar_error, wrap_angle
from wmrlib.plots.picture import Picture
from wmrlib.plots.style import COLOURS, LINES, STYLE, arrow, equal_scales, near_zero, new_figure
from wmrlib.runs import Trajectory


def polar_angles(pose: Pose, goal: Pose) -> Picture:
    """rho, alpha, theta, the headings and gamma = heading - goal.heading of one robot and one goal (single poses), in metres.

    The dotted lines through robot and goal point east, the dashed line is the line of sight, the thin orange line through the robot is
    parallel to the goal's heading, the two black arcs turn from east to the headings. Raises ValueError for what is not a Pose.
    """
    rho, alpha, theta = polar_error(pose, goal)
    sight, gamma = (
        math.atan2(goal.y - pose.y, goal.x - pose.x),
        wrap_angle(pose.heading - goal.heading),
    )
    figure, axes = new_figure(7.5, 7.0)
    _scene(axes, pose, goal, rho, sight)
    for at, heading in ((pose, 0.0), (goal, 0.0), (pose, goal.heading)):
        looks = (
            {"color": COLOURS["goal"], "lw": 1.2, "ls": "-"}
            if heading
            else {"color": COLOURS["ink"], "lw": 1.0, "ls": ":"}
        )
        _ray(axes, at, heading, 0.62 * rho, "goal's heading, moved" if heading else "east", **looks)
    _arc(axes, pose, 0.0, pose.heading, 0.28 * rho, _degrees(pose.heading), COLOURS["ink"], 11)
    _arc(axes, pose, pose.heading, alpha, 0.38 * rho, r"$\alpha$", COLOURS["v"])
    _arc(axes, pose, goal.heading, gamma, 0.50 * rho, r"$\gamma$", COLOURS["omega"])
    _arc(axes, goal, 0.0, goal.heading, 0.28 * rho, _degrees(goal.heading), COLOURS["ink"], 11)
    _arc(axes, goal, goal.heading, theta, 0.48 * rho, r"$\theta$", COLOURS["goal"])
    axes.annotate(
        r"$\rho$",
        (0.5 * (pose.x + goal.x), 0.5 * (pose.y + goal.y)),
        xytext=(-16, 8),
        textcoords="offset points",
        fontsize=16,
    )
    _room(axes, pose, goal, rho * np.array([-0.25, 0.98]), rho * np.array([-0.35, 0.62]))
    return Picture(
        figure,
        f"Robot and goal, {rho:.1f} m apart: the line of sight is at {_degrees(sight)} from east, the robot heads "
        f"{_degrees(pose.heading)}, the goal {_degrees(goal.heading)}, each marked by a black arc from east; "
        f"so alpha, from heading to sight, is {_degrees(alpha)}, theta, "
        f"from the goal's heading to sight, is {_degrees(theta)}, and gamma, from the goal's heading to the robot's, is {_degrees(gamma)}.",
    )


def third_angle(pose: Pose, goal: Pose) -> Picture:
    """The third angle of one robot and one goal in both signs: theta on the left, beta = -theta on the right, and who writes which."""
    polar = polar_error(pose, goal)
    rho, theta = polar.rho, polar.theta
    beta = translate(polar, "aicardi", "corke")[2]
    sight = math.atan2(goal.y - pose.y, goal.x - pose.x)
    import matplotlib as mpl
    from matplotlib.figure import Figure

    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(10.5, 5.6), layout="constrained")
        panels = dict(zip(("theta", "beta"), figure.subplots(1, 2), strict=True))
    users = {
        sign: ", ".join(_people(name) for name, how in CONVENTIONS.items() if how.third == sign)
        for sign in (1, -1)
    }
    texts = (
        (
            "theta",
            goal.heading,
            theta,
            rf"$\theta$ = {_degrees(theta)}",
            f"the paper's (7)-(9), wmrlib,\n{users[1]}",
        ),
        (
            "beta",
            sight,
            beta,
            rf"$\beta$ = {_degrees(beta)}",
            users[-1].replace("gwart, ", "gwart,\n"),
        ),
    )
    for name, begin, turn, label, title in texts:
        axes = panels[name]
        _scene(axes, pose, goal, rho, sight)
        _arc(axes, goal, begin, turn, 0.40 * rho, label, COLOURS["goal"])
        axes.set_title(title, fontsize=12)
        _room(axes, pose, goal, rho * np.array([-0.32, 0.98]), rho * np.array([-0.25, 0.62]))
    return Picture(
        figure,
        f"The same robot and goal twice. Left: theta = {_degrees(theta)}, turned from the goal's heading to the line of sight. Right: "
        f"beta = {_degrees(beta)}, turned back from the line of sight to the goal's heading, as in {users[-1]}.",
    )


def ways(tracks: Mapping[str, Pose], goal: Pose) -> Picture:
    """The ways of several robots to one goal, each a Pose of arrays named by its label, with the last pose of each as a filled arrow.

    In metres, with equal scales. Raises ValueError unless there are one to four.
    """
    instance("goal", goal, Pose)
    if not 1 <= len(tracks) <= len(LINES):
        raise ValueError(
            f"tracks has {len(tracks)} entries, which is not allowed: 1 to {len(LINES)} are needed"
        )
    figure, axes = new_figure(6.5, 5.5)
    colours, handles, words = (
        (COLOURS["v"], COLOURS["goal"], COLOURS["omega"], COLOURS["ink"]),
        [],
        [],
    )
    size = 0.07 * max(max(np.ptp(track.x), np.ptp(track.y)) for track in tracks.values())
    for (label, track), style, colour in zip(tracks.items(), LINES, colours, strict=False):
        x, y, heading = (np.broadcast_to(field, np.shape(track.x)) for field in track)
        axes.plot(x, y, style, color=colour)
        axes.add_patch(
            arrow(
                Pose(x[0], y[0], heading[0]),
                size,
                fc=COLOURS["start"],
                ec=COLOURS["start"],
                zorder=4,
            )
        )
        axes.add_patch(
            arrow(Pose(x[-1], y[-1], heading[-1]), size, fc=colour, ec=COLOURS["ink"], zorder=3)
        )
        handles.append(Line2D([], [], color=colour, ls=style, label=label))
        left = near_zero(math.degrees(wrap_angle(heading[-1] - goal.heading)))
        words.append(
            f"{label}: ends {math.hypot(goal.x - x[-1], goal.y - y[-1]):.2f} m from the goal, its heading {left:.0f} deg off"
        )
    axes.add_patch(arrow(goal, 1.3 * size, fc="none", ec=COLOURS["goal"], lw=2.0, zorder=5))
    axes.legend(
        handles=handles,
        fontsize=11,
        loc="upper center",
        bbox_to_anchor=(0.5, 1.0 + 0.09 * len(handles)),
        frameon=False,
    )
    equal_scales(
        axes,
        np.concatenate([t.x for t in tracks.values()]),
        np.concatenate([t.y for t in tracks.values()]),
        0.15,
    )
    axes.set(xlabel="x [m]", ylabel="y [m]")
    return Picture(
        figure,
        "Ways in metres, green arrow the start, open arrow the goal. " + "; ".join(words) + ".",
    )


def angles_over_time(
    runs: Trajectory | Sequence[Trajectory], labels: Sequence[str] = ()
) -> Picture:
    """Alpha and theta in degrees over time, of one run or up to four, with the half turns +-180 deg marked."""
    runs = [runs] if isinstance(runs, Trajectory) else list(runs)
    if not 1 <= len(runs) <= len(LINES):
        raise ValueError(
            f"runs has {len(runs)} entries, which is not allowed: 1 to {len(LINES)} are needed"
        )
    figure, panels = new_figure(7.5, 5.0, rows=2)
    names = list(labels) or [f"run {k}" for k in range(1, len(runs) + 1)]
    for axes, name, colour in zip(
        panels, ("alpha", "theta"), (COLOURS["v"], COLOURS["goal"]), strict=True
    ):
        for run, style, label in zip(runs, LINES, names, strict=False):
            axes.plot(run.t, np.degrees(getattr(run, name)), style, color=colour, label=label)
        for half_turn in (-180.0, 180.0):
            axes.axhline(half_turn, color=COLOURS["ink"], lw=1.0, ls=":")
        axes.set_ylabel(f"{name} [deg]")
        axes.set_yticks(np.arange(-180, 181, 90))
        axes.margins(x=0.01)
    panels[1].set_xlabel("time [s]")
    if len(runs) > 1:
        panels[0].legend(
            fontsize=11,
            loc="lower right",
            bbox_to_anchor=(1.0, 1.0),
            ncols=len(runs),
            frameon=False,
        )
    words = [
        f"{label}: alpha {_span(run.alpha)}, theta {_span(run.theta)}"
        for run, label in zip(runs, names, strict=False)
    ]
    return Picture(
        figure,
        "Angles over time, in degrees; dotted lines mark the half turns. " + "; ".join(words) + ".",
    )


def _scene(axes: Axes, pose: Pose, goal: Pose, rho: float, sight: float) -> None:
    size = 0.09 * rho
    for at, colour, name in ((pose, COLOURS["start"], "robot"), (goal, COLOURS["goal"], "goal")):
        _ray(axes, at, at.heading, 0.62 * rho, f"{name}'s heading", color=colour, lw=2.0, ls="-")
        looks = (
            {"fc": COLOURS["robot"], "ec": COLOURS["ink"]}
            if name == "robot"
            else {"fc": "white", "ec": colour, "lw": 2.5}
        )
        axes.add_patch(arrow(at, size, zorder=5, **looks))
        aside = sight + math.copysign(
            math.pi / 2, math.sin(sight - at.heading)
        )  # square to the line of sight, away from the heading
        offset = 36.0 * math.cos(aside), 28.0 * math.sin(aside)
        axes.annotate(
            name,
            (at.x, at.y),
            xytext=offset,
            textcoords="offset points",
            ha="center",
            va="center",
            fontsize=12,
        )
    axes.plot([pose.x, goal.x], [pose.y, goal.y], "--", color=COLOURS["path"])
    _ray(axes, goal, sight, 0.62 * rho, "line of sight", color=COLOURS["path"], lw=1.2, ls="--")
    axes.set(xlabel="x [m]", ylabel="y [m]")


def _room(axes: Axes, pose: Pose, goal: Pose, reach_x: np.ndarray, reach_y: np.ndarray) -> None:
    equal_scales(
        axes,
        np.add.outer([pose.x, goal.x], reach_x).ravel(),
        np.add.outer([pose.y, goal.y], reach_y).ravel(),
        0.0,
    )


def _ray(axes: Axes, at: Pose, heading: float, length: float, label: str, **looks) -> None:
    """A line that begins at `at`, with its name at its end."""
    end = at.x + length * math.cos(heading), at.y + length * math.sin(heading)
    axes.plot([at.x, end[0]], [at.y, end[1]], **looks)
    axes.annotate(
        label,
        end,
        xytext=(4, 0),
        textcoords="offset points",
        va="center",
        fontsize=10,
        color=looks["color"],
    )


def _arc(
    axes: Axes,
    at: Pose,
    begin: float,
    turn: float,
    radius: float,
    label: str,
    colour: str,
    fontsize: float = 15,
) -> None:
    """An arc with an arrowhead where it ends, so that its sign is seen, and its name outside."""
    angles = begin + turn * np.linspace(0.0, 1.0, 60)
    x, y = at.x + radius * np.cos(angles), at.y + radius * np.sin(angles)
    axes.plot(x[:-2], y[:-2], color=colour, lw=2.2, zorder=3)
    head = {"arrowstyle": "-|>", "color": colour, "lw": 0.0, "mutation_scale": 20}
    axes.annotate("", (x[-1], y[-1]), xytext=(x[-5], y[-5]), arrowprops=head, zorder=4)
    middle, far = begin + 0.5 * turn, 1.08 * radius
    place = at.x + far * math.cos(middle), at.y + far * math.sin(middle)
    axes.text(
        *place,
        label,
        color=colour,
        fontsize=fontsize,
        ha="left" if math.cos(middle) > 0.0 else "right",
        va="center",
    )


def _people(name: str) -> str:
    return {"pythonrobotics": "PythonRobotics"}.get(name, name.capitalize())


def _degrees(angle: float) -> str:
    return f"{round(math.degrees(angle)):d} deg"


def _span(angle: np.ndarray) -> str:
    low, high = (near_zero(math.degrees(value)) for value in (angle.min(), angle.max()))
    return f"between {low:.0f} and {high:.0f} deg"
