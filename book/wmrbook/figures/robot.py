"""Chapter 2, the robot's frame and wheels; and chapter 11, a real robot's loops."""

from __future__ import annotations

import math

from matplotlib.axes import Axes
from matplotlib.patches import Arc, FancyBboxPatch, PathPatch
from matplotlib.transforms import Affine2D

from wmrbook import face
from wmrbook.figures._drawing import note, pointer
from wmrbook.figures.style import COLOURS, Picture, icon, new_figure
from wmrlib.checks import instance, scalar
from wmrlib.kinematics import Pose


def coordinate_system(pose: Pose, track_width: float, wheel_radius: float) -> Picture:
    """The robot from above with its frame, heading and wheels (b and r in metres): Fig. 1."""
    instance("pose", pose, Pose)
    b = scalar("track_width", track_width, above=0.0)
    r = scalar("wheel_radius", wheel_radius, above=0.0)
    figure, axes = new_figure(6.2, 5.6)
    draw_robot(axes, pose, b, r)
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
        ends = _placed(pose, other), _placed(pose, one)
        bars = {"arrowstyle": "|-|,widthA=0.3,widthB=0.3", "lw": 1.2}
        pointer(axes, *ends, COLOURS["ink"], **bars)
        middle = 0.5 * sum(x for x, _ in ends), 0.5 * sum(y for _, y in ends)
        note(axes, name, middle, (-14, 8), fontsize=15, ha="center", va="center")
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
    figure, axes = new_figure(8.6, 5.0)
    axes.set_axis_off()
    axes.set(xlim=(0.0, 10.2), ylim=(0.0, 5.6))
    middle = {"ha": "center", "va": "center"}
    for name, (does, role, (x, y)) in _BLOCKS.items():
        half = 1.35 if name == "pose" else 0.95
        looks = {"boxstyle": "round,pad=0.06", "fc": "white", "ec": COLOURS[role], "lw": 2.5}
        axes.add_patch(FancyBboxPatch((x - half, y - 0.6), 2 * half, 1.2, **looks))
        axes.text(x, y + 0.33, name, weight="bold", **middle)
        axes.text(x, y - 0.2, does, **middle)
    ink, wheels = {"colour": COLOURS["ink"], "lw": 2.0}, {"color": COLOURS["y_error"], "lw": 2.0}
    for x0, x1, y in ((2.2, 2.8, 3.9), (4.8, 5.4, 3.9), (7.4, 8.0, 3.9), (5.4, 3.9, 1.1)):
        pointer(axes, (x0, y), (x1, y), **ink)
    for x, low, high in ((9.0, 3.25, 1.75), (1.2, 5.3, 4.55), (1.2, 1.75, 3.25)):
        pointer(axes, (x, low), (x, high), **ink)
    axes.plot([9.0, 6.4], [2.3, 2.3], color=COLOURS["ink"], lw=2.0)
    pointer(axes, (6.4, 2.32), (6.4, 1.75), **ink)
    axes.plot([9.0, 9.0, 2.9], [0.44, 0.2, 0.2], color=COLOURS["ink"], lw=2.0)
    pointer(axes, (2.9, 0.18), (2.9, 0.44), **ink)
    axes.text(1.4, 5.1, "goal: GPS point to metres, once", ha="left", va="center")
    axes.text(1.35, 2.85, f"every {time_step:g} s", ha="left", va="center")
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


def _placed(pose: Pose, point) -> tuple[float, float]:
    """A point of the robot's frame (ahead, left) in the frame of the plane."""
    cos, sin = math.cos(pose.heading), math.sin(pose.heading)
    return pose.x + cos * point[0] - sin * point[1], pose.y + sin * point[0] + cos * point[1]


def draw_robot(axes: Axes, pose: Pose, b: float, r: float) -> None:
    """Draw the robot from above; b between its wheels, whose radius is r, in metres."""
    ink = COLOURS["ink"]
    scale, turned = b / face.TRACK, Affine2D().rotate(pose.heading).translate(pose.x, pose.y)
    body, nose = (icon(part).transformed(Affine2D().scale(scale)) for part in ("body", "nose"))
    looks = {"fc": COLOURS["robot"], "ec": ink, "lw": 1.5, "alpha": 0.6}
    for part in (body, nose):
        axes.add_patch(PathPatch(part.transformed(turned), **looks))
    # a wheel is 16 px long, and here as long as it is
    wheels = icon("wheels").transformed(Affine2D().scale(r / 8.0, scale) + turned)
    axes.add_patch(PathPatch(wheels, fc=ink, lw=0, zorder=3))
    axle = _placed(pose, (0.0, 0.5 * b)), _placed(pose, (0.0, -0.5 * b))
    axes.plot(*zip(*axle, strict=True), color=ink, lw=2.0)
