"""Figures of the robot itself: its frame and wheels, how it turns, what its moves add up to."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Arc, Polygon

from wmrlib._checks import instance, real, scalar
from wmrlib.control import control_law
from wmrlib.gains import Gains
from wmrlib.kinematics import Pose, advance, polar_error, twist_to_wheels
from wmrlib.plots.picture import Picture
from wmrlib.plots.style import COLOURS, LINES, arrow, equal_scales, new_figure

_BODY = np.array(
    [[0.85, 0.0], [0.55, 0.4], [-0.55, 0.4], [-0.55, -0.4], [0.55, -0.4]]
)  # in track widths, its nose ahead


def coordinate_system(pose: Pose, track_width: float, wheel_radius: float) -> Picture:
    """The robot from above in the east-north frame, with its own frame, its heading theta, its wheels, b and r: the paper's Fig. 1.

    track_width and wheel_radius in metres. Raises ValueError for one that is not positive.
    """
    instance("pose", pose, Pose)
    b, r = (
        scalar("track_width", track_width, above=0.0),
        scalar("wheel_radius", wheel_radius, above=0.0),
    )
    figure, axes = new_figure(6.2, 5.6)
    _draw_robot(axes, pose, b, r)
    for tip, colour, name, offset in (
        ((1.9 * b, 0.0), "path", "$X_r$", (4, 4)),
        ((0.0, 1.4 * b), "path", "$Y_r$", (-22, 0)),
        ((1.2 * b, 0.5 * b), "goal", "$V_l$", (4, 4)),
        ((1.2 * b, -0.5 * b), "goal", "$V_r$", (6, -8)),
    ):
        _arrow(
            axes,
            _placed(pose, (0.0, tip[1] if colour == "goal" else 0.0)),
            _placed(pose, tip),
            colour,
            name,
            offset,
        )
    axes.plot([pose.x, pose.x + 1.4 * b], [pose.y, pose.y], ":", color=COLOURS["ink"], lw=1.5)
    axes.add_patch(
        Arc(
            (pose.x, pose.y),
            2.3 * b,
            2.3 * b,
            theta2=math.degrees(pose.heading),
            color=COLOURS["ink"],
            lw=1.5,
        )
    )
    half = 0.5 * pose.heading
    axes.text(
        pose.x + 1.3 * b * math.cos(half),
        pose.y + 1.3 * b * math.sin(half),
        r"$\theta$",
        fontsize=15,
        ha="center",
        va="center",
    )
    axes.plot(pose.x, pose.y, "o", ms=7, color=COLOURS["ink"], zorder=6)
    axes.annotate(
        "$a=(x_a,y_a)$",
        (pose.x, pose.y),
        (-60, -95),
        textcoords="offset points",
        fontsize=14,
        arrowprops={"arrowstyle": "-"},
    )
    _dimension(
        axes, _placed(pose, (-0.85 * b, 0.5 * b)), _placed(pose, (-0.85 * b, -0.5 * b)), "$b$"
    )
    _dimension(axes, _placed(pose, (0.0, 0.72 * b)), _placed(pose, (-r, 0.72 * b)), "$r$")
    axes.set(
        xlim=(0.0, pose.x + 2.4 * b),
        ylim=(0.0, pose.y + 2.0 * b),
        aspect="equal",
        xlabel="$X$, east [m]",
        ylabel="$Y$, north [m]",
    )
    return Picture(
        figure,
        f"The robot from above at x = {pose.x:.1f} m east and y = {pose.y:.1f} m north. Its axis X_r points ahead, "
        f"{math.degrees(pose.heading):.0f} deg from east, which is theta; Y_r points to its left. Point a lies midway between two wheels "
        f"of radius r = {r:.2f} m, b = {b:.2f} m apart; arrows V_l and V_r on the left and the right wheel point ahead.",
    )


def turning_centre(v: float, omega: float, track_width: float) -> Picture:
    """The robot from above, the speeds of its wheels, and the point about which it turns.

    v in m/s, omega in rad/s, track_width in metres. Raises ValueError for omega = 0, or a width that is not positive.
    """
    v, omega, b = (
        scalar("v", v),
        scalar("omega", omega),
        scalar("track_width", track_width, above=0.0),
    )
    if omega == 0:
        raise ValueError(
            "omega = 0.0 is not allowed: another number is needed, for a robot that drives straight turns about no point"
        )
    left, right = twist_to_wheels(v, omega, b)
    pose, centre = Pose(0.0, 0.0, math.pi / 2), -v / omega
    figure, axes = new_figure(7.0, 4.6)
    _draw_robot(axes, pose, b, 0.25 * b)
    ends = sorted([centre, -0.5 * b, 0.5 * b])
    axes.plot([ends[0], ends[-1]], [0, 0], ":", color=COLOURS["ink"], lw=1.5)
    tips = sorted([(centre, 0.0), (-0.5 * b, left), (0.5 * b, right)])
    axes.plot(
        [tips[0][0], tips[-1][0]], [tips[0][1], tips[-1][1]], "--", color=COLOURS["ink"], lw=1.2
    )
    for x, speed, role, name in (
        (-b / 2, left, "goal", "V_l"),
        (0.0, v, "path", "v"),
        (b / 2, right, "goal", "V_r"),
    ):
        _arrow(axes, (x, 0.0), (x, speed), role)
        axes.annotate(
            f"${name}$ = {speed:.2f} m/s",
            (x, speed),
            (-8, 6),
            textcoords="offset points",
            ha="right",
            fontsize=12,
        )
    axes.plot(centre, 0, "o", ms=11, color=COLOURS["start"], zorder=5)
    axes.annotate(
        "turning centre",
        (centre, 0),
        (0, -26),
        textcoords="offset points",
        ha="center",
        fontsize=12,
    )
    low, high = min(0.0, left, v, right), max(0.0, left, v, right)
    axes.set(
        xlim=(ends[0] - 0.6 * b, ends[-1] + 1.6 * b),
        ylim=(low - 0.8 * b, high + 0.6 * b),
        aspect="equal",
    )
    axes.set(xlabel="across the robot [m]", ylabel="ahead [m], speeds [m/s]")
    return Picture(
        figure,
        f"The robot from above, driving upwards. Arrows show the speeds of its left wheel, {left:.2f} m/s, of its middle, {v:.2f} m/s, and "
        f"of its right wheel, {right:.2f} m/s. Their tips lie on a straight dashed line that meets the axle's line at the turning centre, "
        f"{abs(centre):.2f} m to the {'left' if centre < 0 else 'right'}.",
    )


def commutator(step: float, turn: float, times: int = 1) -> Picture:
    """Forward `step` metres, left by `turn` radians, back, right: where that leads, done `times` times from the origin, heading east.

    Raises ValueError for a step or a turn that is not positive.
    """
    step, turn = scalar("step", step, above=0.0), scalar("turn", turn, above=0.0)
    poses = [Pose(0.0, 0.0, 0.0)]
    for v, omega in ((step, 0.0), (0.0, turn), (-step, 0.0), (0.0, -turn)) * times:
        poses.append(advance(poses[-1], v, omega, 1.0))
    figure, axes = new_figure(7.0, 4.8)
    x, y = (np.array([getattr(pose, name) for pose in poses]) for name in ("x", "y"))
    size = 0.07 * step
    for k in range(times):
        for name, first, style, role in (
            ("forward", 4 * k, "-", "path"),
            ("back", 4 * k + 2, "--", "y_error"),
        ):
            move = slice(first, first + 2)
            axes.plot(x[move], y[move], style, color=COLOURS[role], label=None if k else name)
        axes.add_patch(
            arrow(poses[4 * k + 1], size, fc="none", ec=COLOURS["robot"], lw=1.5, zorder=3)
        )
        axes.add_patch(
            arrow(poses[4 * k + 2], size, fc=COLOURS["robot"], ec=COLOURS["ink"], zorder=3)
        )
        axes.add_patch(
            arrow(poses[4 * k + 4], size, fc="none", ec=COLOURS["goal"], lw=2.0, zorder=4)
        )
    axes.add_patch(arrow(poses[0], size, fc=COLOURS["start"], ec=COLOURS["start"], zorder=5))
    equal_scales(axes, np.append(x, 0.0), np.append(y, 0.0), room=0.12)
    axes.set(
        ylim=(y.min() - 0.2 * step, y.max() + 0.2 * step),
        aspect="equal",
        xlabel="x [m]",
        ylabel="y [m]",
    )
    axes.set(xlim=(x.min() - 0.2 * step, x.max() + 0.5 * step))
    axes.legend(loc="center right", fontsize=11)
    return Picture(
        figure,
        f"Path of {times} times four moves: {step:.2f} m forward, a turn of {turn:.2f} rad to the left on the spot, as far back, and the "
        f"turn undone. The robot starts at the origin (filled arrow) and ends, looking the same way, at x = {x[-1]:.3f} m and "
        f"y = {y[-1]:.3f} m (last open arrow).",
    )


def approach(gains: Gains, distances: Sequence[float] = (10.0, 1.0, 0.001)) -> Picture:
    """The corrected law's omega over the direction in which the goal lies, at some distances in metres; the robot's heading is the goal's.

    Raises ValueError for more than four distances, or one that is not positive.
    """
    distances = np.atleast_1d(real("distances", distances, above=0.0))
    if not 1 <= distances.size <= len(LINES):
        raise ValueError(
            f"distances has {distances.size} entries, which is not allowed: 1 to {len(LINES)} are needed"
        )
    sight = np.linspace(-math.pi, math.pi, 721)[1:-1]
    figure, axes = new_figure(7.0, 3.8)
    spans = []
    for distance, style, role in zip(
        distances, LINES, ("path", "y_error", "goal", "omega"), strict=False
    ):
        pose = Pose(-distance * np.cos(sight), -distance * np.sin(sight), 0.0)
        omega = control_law(*polar_error(pose, Pose(0.0, 0.0, 0.0)), gains)[1]
        axes.plot(
            np.degrees(sight), omega, style, color=COLOURS[role], label=f"{distance:g} m away"
        )
        spans.append(f"{omega.min():.2f} to {omega.max():.2f} rad/s at {distance:g} m")
    axes.legend(loc="upper left", fontsize=11)
    axes.set(
        xlabel="direction of the goal, from its heading [deg]",
        ylabel="omega [rad/s]",
        xticks=range(-180, 181, 60),
    )
    return Picture(
        figure,
        "Commanded omega over the direction in which the goal lies: it spans "
        + ", ".join(spans)
        + ".",
    )


def steps(v: float, omega: float, dt: float) -> Picture:
    """One full turn at a constant twist: the exact arc, and Euler's steps of `dt` seconds.

    v in m/s, omega in rad/s. Raises ValueError for omega = 0, or a dt that is not positive.
    """
    v, omega, dt = scalar("v", v), scalar("omega", omega), scalar("dt", dt, above=0.0)
    if omega == 0:
        raise ValueError(
            "omega = 0.0 is not allowed: another number is needed, for a robot that drives straight makes no turn"
        )
    count = math.ceil(
        2 * math.pi / (abs(omega) * dt) - 1e-9
    )  # a step that divides the turn is not to be counted once more
    paths = {}
    for method in ("arc", "euler"):
        poses = [Pose(0.0, 0.0, 0.0)]
        for _ in range(count):
            poses.append(advance(poses[-1], v, omega, dt, method=method))
        paths[method] = np.array([(pose.x, pose.y) for pose in poses])
    times = np.linspace(0.0, count * dt, 361)
    exact = advance(Pose(0.0, 0.0, 0.0), v * times, omega * times, 1.0)
    figure, axes = new_figure(5.6, 5.6)
    axes.plot(exact.x, exact.y, "-", color=COLOURS["path"], label="exact")
    axes.plot(*paths["arc"].T, "o", ms=6, mfc="none", color=COLOURS["path"], label='"arc"')
    axes.plot(*paths["euler"].T, "s--", ms=5, lw=1.2, color=COLOURS["goal"], label='"euler"')
    axes.plot(0, 0, "*", ms=15, color=COLOURS["start"])
    equal_scales(axes, *np.concatenate([*paths.values(), np.column_stack([exact.x, exact.y])]).T)
    axes.legend(loc="center", fontsize=11)
    axes.set(xlabel="x [m]", ylabel="y [m]")
    apart = np.hypot(*(paths["arc"] - paths["euler"]).T)
    return Picture(
        figure,
        f"A full turn at {v:.1f} m/s and {omega:.1f} rad/s, from the star at the origin: a circle of {abs(v / omega):.1f} m radius, on "
        f"which the arc steps of {dt:.2f} s lie, and Euler's {count} straight steps, which end up to {apart.max():.2f} m from the arcs'.",
    )


def _placed(pose: Pose, point) -> tuple[float, float]:
    """A point of the robot's frame (ahead, left) in the frame of the plane."""
    cos, sin = math.cos(pose.heading), math.sin(pose.heading)
    return pose.x + cos * point[0] - sin * point[1], pose.y + sin * point[0] + cos * point[1]


def _draw_robot(axes: Axes, pose: Pose, b: float, r: float) -> None:
    axes.add_patch(
        Polygon(
            [_placed(pose, b * corner) for corner in _BODY],
            fc=COLOURS["robot"],
            ec=COLOURS["ink"],
            alpha=0.45,
        )
    )
    for side in (0.5 * b, -0.5 * b):
        corners = ((r, 0.06 * b), (-r, 0.06 * b), (-r, -0.06 * b), (r, -0.06 * b))
        axes.add_patch(
            Polygon(
                [_placed(pose, (ahead, side + left)) for ahead, left in corners],
                fc=COLOURS["ink"],
                zorder=3,
            )
        )
    axes.plot(
        *zip(_placed(pose, (0.0, 0.5 * b)), _placed(pose, (0.0, -0.5 * b)), strict=True),
        color=COLOURS["ink"],
        lw=2.0,
    )


def _arrow(axes: Axes, tail, tip, role: str, name: str = "", offset=(0, 0)) -> None:
    axes.annotate(
        "",
        tip,
        tail,
        arrowprops={
            "arrowstyle": "-|>",
            "color": COLOURS[role],
            "lw": 2.2,
            "shrinkA": 0,
            "shrinkB": 0,
        },
        zorder=5,
    )
    axes.annotate(
        name, tip, offset, textcoords="offset points", color=COLOURS[role], fontsize=15, zorder=6
    )


def _dimension(axes: Axes, one, other, name: str) -> None:
    looks = {
        "arrowstyle": "|-|,widthA=0.3,widthB=0.3",
        "color": COLOURS["ink"],
        "lw": 1.2,
        "shrinkA": 0,
        "shrinkB": 0,
    }
    axes.annotate("", one, other, arrowprops=looks)
    middle = 0.5 * (one[0] + other[0]), 0.5 * (one[1] + other[1])
    axes.annotate(
        name, middle, (-14, 8), textcoords="offset points", fontsize=15, ha="center", va="center"
    )
