"""Chapter 2: the robot's frame and wheels, how it turns, and what its moves add up to."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Arc, FancyBboxPatch, Polygon

from wmrbook.figures._drawing import note, pointer
from wmrbook.figures.style import COLOURS, Picture, dart, equal_scales, new_figure
from wmrlib._checks import instance, scalar
from wmrlib.kinematics import Pose, advance, twist_to_wheels

_BODY = ((0.85, 0.0), (0.55, 0.4), (-0.55, 0.4), (-0.55, -0.4), (0.55, -0.4))  # in track widths
_ORIGIN = Pose(0.0, 0.0, 0.0)


def coordinate_system(pose: Pose, track_width: float, wheel_radius: float) -> Picture:
    """The robot from above with its frame, heading and wheels (b and r in metres): Fig. 1."""
    instance("pose", pose, Pose)
    b = scalar("track_width", track_width, above=0.0)
    r = scalar("wheel_radius", wheel_radius, above=0.0)
    figure, axes = new_figure(6.2, 5.6)
    _draw_robot(axes, pose, b, r)
    for side, tip, role, name, offset in (
        (0.0, (1.9 * b, 0.0), "path", "$X_r$", (4, 4)),
        (0.0, (0.0, 1.4 * b), "path", "$Y_r$", (-22, 0)),
        (0.5 * b, (1.2 * b, 0.5 * b), "y_error", "$V_l$", (4, 4)),
        (-0.5 * b, (1.2 * b, -0.5 * b), "y_error", "$V_r$", (6, -8)),
    ):
        end = _placed(pose, tip)
        pointer(axes, _placed(pose, (0.0, side)), end, COLOURS[role], lw=2.2, zorder=5)
        note(axes, name, end, offset, color=COLOURS[role], fontsize=15, zorder=6)
    axes.plot([pose.x, pose.x + 1.4 * b], [pose.y, pose.y], ":", color=COLOURS["ink"], lw=1.5)
    turn = {"theta2": math.degrees(pose.heading), "color": COLOURS["ink"], "lw": 1.5}
    axes.add_patch(Arc((pose.x, pose.y), 2.3 * b, 2.3 * b, **turn))
    name_at = _placed(pose._replace(heading=0.5 * pose.heading), (1.3 * b, 0.0))
    axes.text(*name_at, r"$\theta$", fontsize=15, ha="center", va="center")
    axes.plot(pose.x, pose.y, "o", ms=7, color=COLOURS["ink"], zorder=6)
    looks = {"fontsize": 14, "arrowprops": {"arrowstyle": "-"}}
    note(axes, "$a=(x_a,y_a)$", (pose.x, pose.y), (-60, -95), **looks)
    for name, one, other in (
        ("$b$", (-0.85 * b, 0.5 * b), (-0.85 * b, -0.5 * b)),
        ("$r$", (0.0, 0.72 * b), (-r, 0.72 * b)),
    ):
        _dimension(axes, _placed(pose, one), _placed(pose, other), name)
    axes.set(xlim=(0.0, pose.x + 2.4 * b), ylim=(0.0, pose.y + 2.0 * b), aspect="equal")
    axes.set(xlabel="$X$, east [m]", ylabel="$Y$, north [m]")
    return Picture(
        figure,
        f"The robot from above at x = {pose.x:.1f} m east and y = {pose.y:.1f} m north. "
        f"Its axis X_r points ahead, {math.degrees(pose.heading):.0f} deg from east, "
        "which is theta; Y_r points to its left. Point a lies midway between two wheels "
        f"of radius r = {r:.2f} m, b = {b:.2f} m apart; "
        "arrows V_l and V_r on the left and the right wheel point ahead.",
    )


def turning_centre(v: float, omega: float, track_width: float) -> Picture:
    """The robot from above, its wheels' speeds, and the point about which it turns.

    v in m/s, omega in rad/s and not 0, track_width in metres.
    """
    v = scalar("v", v)
    omega = _turning(omega, "turns about no point")
    b = scalar("track_width", track_width, above=0.0)
    left, right = twist_to_wheels(v, omega, b)
    centre = -v / omega
    figure, axes = new_figure(7.0, 4.6)
    _draw_robot(axes, Pose(0.0, 0.0, math.pi / 2), b, 0.25 * b)
    tips = sorted([(centre, 0.0), (-0.5 * b, left), (0.5 * b, right)])
    ends, heights = (tips[0][0], tips[-1][0]), (tips[0][1], tips[-1][1])
    axes.plot(ends, [0, 0], ":", color=COLOURS["ink"], lw=1.5)
    axes.plot(ends, heights, "--", color=COLOURS["ink"], lw=1.2)
    for x, speed, role, name in (
        (-b / 2, left, "y_error", "V_l"),
        (0.0, v, "path", "v"),
        (b / 2, right, "y_error", "V_r"),
    ):
        pointer(axes, (x, 0.0), (x, speed), COLOURS[role], lw=2.2, zorder=5)
        label = f"${name}$ = {speed:.2f} m/s"
        note(axes, label, (x, speed), (-8, 6), ha="right", fontsize=12)
    axes.plot(centre, 0, "o", ms=11, color=COLOURS["ink"], zorder=5)
    note(axes, "turning centre", (centre, 0), (0, -26), ha="center", fontsize=12)
    low, high = min(0.0, left, v, right), max(0.0, left, v, right)
    axes.set(xlim=(ends[0] - 0.6 * b, ends[1] + 1.6 * b), aspect="equal")
    axes.set(ylim=(low - 0.8 * b, high + 0.6 * b))
    axes.set(xlabel="across the robot [m]", ylabel="ahead [m], speeds [m/s]")
    return Picture(
        figure,
        "The robot from above, driving upwards. Arrows show the speeds of its left wheel, "
        f"{left:.2f} m/s, of its middle, {v:.2f} m/s, and of its right wheel, {right:.2f} m/s. "
        "Their tips lie on a straight dashed line that meets the axle's line at the turning centre,"
        f" {abs(centre):.2f} m to the {'left' if centre < 0 else 'right'}.",
    )


def commutator(step: float, turn: float, times: int = 1) -> Picture:
    """Forward `step` metres, left by `turn` radians, back, right: where that leads, repeated."""
    step, turn = scalar("step", step, above=0.0), scalar("turn", turn, above=0.0)
    poses = [_ORIGIN]
    for v, omega in ((step, 0.0), (0.0, turn), (-step, 0.0), (0.0, -turn)) * times:
        poses.append(advance(poses[-1], v, omega, 1.0))
    figure, axes = new_figure(7.0, 4.8)
    x, y = np.array([(pose.x, pose.y) for pose in poses]).T
    size = 0.07 * step
    for first in range(0, 4 * times, 4):
        for name, begin, style, role in (
            ("forward", first, "-", "path"),
            ("back", first + 2, "--", "y_error"),
        ):
            move, label = slice(begin, begin + 2), None if first else name
            axes.plot(x[move], y[move], style, color=COLOURS[role], label=label)
        dart(axes, poses[first + 1], size, "none", "robot", lw=1.5, zorder=3)
        dart(axes, poses[first + 2], size, "robot", zorder=3)
        dart(axes, poses[first + 4], size, "none", lw=2.0, zorder=4)
    dart(axes, poses[0], size, "start", "start", zorder=5)
    axes.set(xlim=(x.min() - 0.2 * step, x.max() + 0.5 * step), aspect="equal")
    axes.set(ylim=(y.min() - 0.2 * step, y.max() + 0.2 * step), xlabel="x [m]", ylabel="y [m]")
    axes.legend(loc="center right", fontsize=11)
    return Picture(
        figure,
        f"Path of {times} times four moves: {step:.2f} m forward, a turn of {turn:.2f} rad "
        "to the left on the spot, as far back, and the turn undone. The robot starts at the origin "
        "(filled arrow) and ends, looking the same way, "
        f"at x = {x[-1]:.3f} m and y = {y[-1]:.3f} m (last open arrow).",
    )


_BLOCKS = {  # name: what it does, the colour's role, its centre
    "polar error": ("rho, alpha, theta\nto the goal", "path", (1.2, 3.9)),
    "control law": ("v, omega", "path", (3.8, 3.9)),
    "wheel loops": ("one a motor", "y_error", (6.4, 3.9)),
    "robot": ("moves", "robot", (9.0, 3.9)),
    "receiver": ("fix: position,\n1 to 10 a second", "omega", (9.0, 1.1)),
    "compass": ("heading", "omega", (6.4, 1.1)),
    "pose": ("fix + heading + odometry,\nin metres", "path", (2.5, 1.1)),
}


def robot_loops(time_step: float, times_faster: float) -> Picture:
    """A real robot's loops: receiver and compass stand in the way back, and so inside the loop.

    time_step: of the law, s; times_faster: how often in it the wheel loops act.
    """
    time_step = scalar("time_step", time_step, above=0.0)
    inner = time_step / scalar("times_faster", times_faster, above=0.0)
    figure, axes = new_figure(9.0, 5.0)
    axes.set_axis_off()
    axes.set(xlim=(0.0, 10.2), ylim=(0.0, 5.6))
    middle = {"ha": "center", "va": "center", "fontsize": 11}
    for name, (does, role, (x, y)) in _BLOCKS.items():
        half = 1.35 if name == "pose" else 0.95
        looks = {"boxstyle": "round,pad=0.06", "fc": "white", "ec": COLOURS[role], "lw": 2.5}
        axes.add_patch(FancyBboxPatch((x - half, y - 0.6), 2 * half, 1.2, **looks))
        axes.text(x, y + 0.33, name, weight="bold", **middle)
        axes.text(x, y - 0.2, does, **middle | {"fontsize": 10})
    ink, wheels = {"colour": COLOURS["ink"], "lw": 2.0}, {"color": COLOURS["y_error"], "lw": 2.0}
    for x0, x1, y in ((2.2, 2.8, 3.9), (4.8, 5.4, 3.9), (7.4, 8.0, 3.9), (5.4, 3.9, 1.1)):
        pointer(axes, (x0, y), (x1, y), **ink)
    for x, low, high in ((9.0, 3.25, 1.75), (1.2, 5.3, 4.55), (1.2, 1.75, 3.25)):
        pointer(axes, (x, low), (x, high), **ink)
    axes.plot([9.0, 6.4], [2.3, 2.3], color=COLOURS["ink"], lw=2.0)
    pointer(axes, (6.4, 2.32), (6.4, 1.75), **ink)
    axes.plot([9.0, 9.0, 2.9], [0.44, 0.2, 0.2], color=COLOURS["ink"], lw=2.0)
    pointer(axes, (2.9, 0.18), (2.9, 0.44), **ink)
    axes.text(1.4, 5.1, "goal: GPS point to metres, once", ha="left", va="center", fontsize=11)
    axes.text(1.35, 2.85, f"every {time_step:g} s", ha="left", va="center", fontsize=11)
    axes.plot([8.7, 8.7, 6.6], [4.55, 4.95, 4.95], ls="--", **wheels)
    pointer(axes, (6.6, 4.95), (6.6, 4.55), COLOURS["y_error"], lw=2.0, ls="--")
    axes.text(7.65, 5.15, f"wheel speeds, every {inner:g} s", **middle)
    axes.plot([6.2, 6.2], [3.25, 2.6], ls="--", **wheels)
    axes.plot([6.2, 3.2], [2.6, 2.6], ls="--", **wheels)
    pointer(axes, (3.2, 2.62), (3.2, 1.75), COLOURS["y_error"], lw=2.0, ls="--")
    axes.text(4.6, 2.8, "odometry", **middle)
    chain = " to ".join(list(_BLOCKS)[:4])
    return Picture(
        figure,
        f"Block diagram: {chain}; the way back is receiver and compass to pose, joined by the "
        f"wheels' odometry, and from there to the polar error every {time_step:g} s; the wheel "
        f"speeds are fed back to the wheel loops every {inner:g} s.",
    )


def steps(v: float, omega: float, dt: float) -> Picture:
    """One full turn at a constant twist: the exact arc, and Euler's steps of `dt` seconds.

    v in m/s, omega in rad/s and not 0.
    """
    v, dt = scalar("v", v), scalar("dt", dt, above=0.0)
    omega = _turning(omega, "makes no turn")
    turn = 2 * math.pi / (abs(omega) * dt)
    count = math.ceil(turn - 1e-9)  # a step that divides the turn is not counted once more
    paths = {}
    for method in ("arc", "euler"):
        poses = [_ORIGIN]
        for _ in range(count):
            poses.append(advance(poses[-1], v, omega, dt, method=method))
        paths[method] = np.array([(pose.x, pose.y) for pose in poses])
    times = np.linspace(0.0, count * dt, 361)
    exact = advance(_ORIGIN, v * times, omega * times, 1.0)
    figure, axes = new_figure(5.6, 5.6)
    axes.plot(exact.x, exact.y, "-", color=COLOURS["path"], label="exact")
    axes.plot(*paths["arc"].T, "o", ms=6, mfc="none", color=COLOURS["path"], label='"arc"')
    axes.plot(*paths["euler"].T, "s--", ms=5, lw=1.2, color=COLOURS["y_error"], label='"euler"')
    axes.plot(0, 0, "*", ms=15, color=COLOURS["start"])
    equal_scales(axes, *np.concatenate([*paths.values(), np.column_stack([exact.x, exact.y])]).T)
    axes.legend(loc="center", fontsize=11)
    axes.set(xlabel="x [m]", ylabel="y [m]")
    apart = np.hypot(*(paths["arc"] - paths["euler"]).T)
    return Picture(
        figure,
        f"A full turn at {v:.1f} m/s and {omega:.1f} rad/s, from the star at the origin: "
        f"a circle of {abs(v / omega):.1f} m radius, on which the arc steps of {dt:.2f} s lie, "
        f"and Euler's {count} straight steps, which end up to {apart.max():.2f} m from the arcs'.",
    )


def _turning(omega: float, straight: str) -> float:
    omega = scalar("omega", omega)
    if omega == 0:
        raise ValueError(
            "omega = 0.0 is not allowed: another number is needed, "
            f"for a robot that drives straight {straight}"
        )
    return omega


def _placed(pose: Pose, point) -> tuple[float, float]:
    """A point of the robot's frame (ahead, left) in the frame of the plane."""
    cos, sin = math.cos(pose.heading), math.sin(pose.heading)
    return pose.x + cos * point[0] - sin * point[1], pose.y + sin * point[0] + cos * point[1]


def _draw_robot(axes: Axes, pose: Pose, b: float, r: float) -> None:
    body = [_placed(pose, (b * ahead, b * left)) for ahead, left in _BODY]
    axes.add_patch(Polygon(body, fc=COLOURS["robot"], ec=COLOURS["ink"], alpha=0.45))
    corners = (r, 0.06 * b), (-r, 0.06 * b), (-r, -0.06 * b), (r, -0.06 * b)
    for side in (0.5 * b, -0.5 * b):
        wheel = [_placed(pose, (ahead, side + left)) for ahead, left in corners]
        axes.add_patch(Polygon(wheel, fc=COLOURS["ink"], zorder=3))
    axle = _placed(pose, (0.0, 0.5 * b)), _placed(pose, (0.0, -0.5 * b))
    axes.plot(*zip(*axle, strict=True), color=COLOURS["ink"], lw=2.0)


def _dimension(axes: Axes, one, other, name: str) -> None:
    bars = {"arrowstyle": "|-|,widthA=0.3,widthB=0.3", "lw": 1.2}
    pointer(axes, other, one, COLOURS["ink"], **bars)
    middle = 0.5 * (one[0] + other[0]), 0.5 * (one[1] + other[1])
    note(axes, name, middle, (-14, 8), fontsize=15, ha="center", va="center")
