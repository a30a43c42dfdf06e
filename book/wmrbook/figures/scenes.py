"""What the concept questions' slides show: the angles by name, and situations, never an answer."""

from __future__ import annotations

import math
from typing import NamedTuple

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from wmrbook.figures._drawing import note, pointer
from wmrbook.figures.angles import draw_angles
from wmrbook.figures.robot import draw_robot
from wmrbook.figures.style import COLOURS, Picture, dart, new_figure
from wmrlib.kinematics import Pose

_LOOKS = {
    "robot": {"fill": "robot"},
    "goal": {"fill": "white", "edge": "goal", "lw": 2.5},
    "seen": {"fill": "white", "ls": ":", "lw": 1.8},
}
_LETTERS = 17


class Scene(NamedTuple):
    """A situation seen from above.

    said: the alternative text; darts: (role, name, where its name stands, x, y, heading in deg);
    spans: (x, y, x, y, text), with arrows at both ends; pointers: the same, with one at the end;
    lines: (x, y, x, y), dashed; circle: its radius, round the origin; north: where an arrow shows
    it, or None.
    """

    said: str
    darts: tuple
    spans: tuple = ()
    pointers: tuple = ()
    lines: tuple = ()
    circle: float = 0.0
    north: tuple[float, float] | None = None


_BELOW, _ABOVE, _RIGHT, _LEFT = (0, -38), (0, 38), (46, 0), (-46, 0)
SCENES = {
    "two-angles": Scene(
        "The robot faces north-west. The goal lies west of it and looks south. North is up.",
        (("robot", "robot", _BELOW, 0.0, 0.0, 135.0), ("goal", "goal", _RIGHT, -7.0, 0.0, -90.0)),
        north=(-3.5, 2.5),
    ),
    "level-spot": Scene(
        "The robot is almost on the goal, which lies straight ahead; the goal's heading is 60 deg "
        "to the right of the robot's.",
        (
            ("robot", "robot", (52, -10), -0.5, -0.87, 60.0),
            ("goal", "goal", (-60, 8), 0.0, 0.0, 0.0),
        ),
        pointers=((0.0, 0.0, 4.0, 0.0, "goal's heading"), (0.0, 0.0, 2.0, 3.46, "robot's heading")),
    ),
    "millimetre-beside": Scene(
        "The robot stands to the right of its goal, 1 mm away; both look the same way.",
        (("goal", "goal", _LEFT, 0.0, 0.0, 90.0), ("robot", "robot", _RIGHT, 5.0, 0.0, 90.0)),
        spans=((0.0, 1.6, 5.0, 1.6, "1 mm"),),
    ),
    "mirror": Scene(
        "A start and a goal above the x axis, and below it, dotted, their mirror images.",
        (
            ("robot", "start", _ABOVE, -3.5, 2.8, -50.0),
            ("goal", "goal", _ABOVE, 3.5, 1.8, 30.0),
            ("seen", "", _BELOW, -3.5, -2.8, 50.0),
            ("seen", "", _BELOW, 3.5, -1.8, -30.0),
        ),
        pointers=((-6.0, 0.0, 6.0, 0.0, "$x$"),),
    ),
    "how-far-behind": Scene(
        "A goal drives straight on at 1 m/s; a robot follows behind it, a distance rho away.",
        (("robot", "robot", _BELOW, -4.0, 0.0, 0.0), ("goal", "goal", _BELOW, 2.0, 0.0, 0.0)),
        spans=((-4.0, 1.4, 2.0, 1.4, r"$\rho$"),),
        pointers=((2.8, 0.0, 5.5, 0.0, "1 m/s"),),
    ),
    "nearer": Scene(
        "A goal drives round a circle; a robot follows a little behind it, on the circle too.",
        (
            ("robot", "robot", (-48, -8), 3.46, 2.0, 120.0),
            ("goal", "goal", (0, -38), 1.37, 3.76, 160.0),
        ),
        circle=4.0,
    ),
    "constant-offset": Scene(
        "The robot, and dotted, 2 m further east, where the receiver shows it; the goal is ahead.",
        (
            ("robot", "robot", _LEFT, -1.5, -3.0, 70.0),
            ("seen", "shown", (50, 0), 2.0, -3.0, 70.0),
            ("goal", "goal", _RIGHT, 1.0, 3.0, 90.0),
        ),
        spans=((-1.5, -1.4, 2.0, -1.4, "2 m"),),
        north=(-4.5, 0.5),
    ),
    "bearing-for-heading": Scene(
        "Robot and goal look east; the goal lies 10 m ahead of the robot. North is up.",
        (("robot", "robot", _BELOW, -4.0, 0.0, 0.0), ("goal", "goal", _BELOW, 4.0, 0.0, 0.0)),
        spans=((-4.0, 1.4, 4.0, 1.4, "10 m"),),
        north=(0.0, 2.6),
    ),
    "along-a-route": Scene(
        "A start and three goals in a row, joined by straight legs; the first two are only passed.",
        (
            ("robot", "start", _BELOW, -6.0, -2.0, 0.0),
            ("goal", "1", _BELOW, -2.0, -2.0, 18.0),
            ("goal", "2", _ABOVE, 2.0, 1.0, 0.0),
            ("goal", "3", _BELOW, 6.0, -2.0, -37.0),
        ),
        lines=((-6.0, -2.0, -2.0, -2.0), (-2.0, -2.0, 2.0, 1.0), (2.0, 1.0, 6.0, -2.0)),
    ),
}


def scene_of(question: str) -> Picture | None:
    """Return the picture of a question's situation; None if it has none."""
    if question in _ROBOTS:
        return _ROBOTS[question]()
    return situation(SCENES[question]) if question in SCENES else None


def names_of_angles() -> Picture:
    """A robot and its goal with rho, alpha and theta, and beta = -theta."""
    figure, axes = new_figure(4.6, 4.2)
    draw_angles(axes, Pose(0.0, 0.0, math.radians(115.0)), Pose(4.0, 3.0, math.radians(-25.0)))
    axes.set_axis_off()
    return Picture(
        figure,
        "A robot and its goal, rho apart. Alpha turns from the robot's heading to the line of "
        "sight, here to the right and so negative; theta from the goal's heading to the line of "
        "sight, here to the left and positive.",
    )


def situation(scene: Scene) -> Picture:
    """Draw a scene."""
    figure, axes = _sheet()
    for x0, y0, x1, y1, text in scene.spans:
        _named_arrow(axes, (x0, y0), (x1, y1), text, arrowstyle="<|-|>")
    for x0, y0, x1, y1, text in scene.pointers:
        _named_arrow(axes, (x0, y0), (x1, y1), text, at_end=True)
    for x0, y0, x1, y1 in scene.lines:
        axes.plot([x0, x1], [y0, y1], "--", color=COLOURS["ink"], lw=1.5)
    if scene.circle:
        axes.add_patch(Circle((0.0, 0.0), scene.circle, fill=False, ls="--", lw=1.5))
    if scene.north:
        x, y = scene.north
        _named_arrow(axes, (x, y), (x, y + 2.0), "north", at_end=True)
    for role, name, offset, x, y, heading in scene.darts:
        dart(axes, Pose(x, y, math.radians(heading)), 0.8, zorder=5, **_LOOKS[role])
        note(axes, name, (x, y), offset, ha="center", va="center", fontsize=_LETTERS)
    return _fitted(figure, axes, scene.said)


def _two_speeds() -> Picture:
    figure, axes = _sheet()
    draw_robot(axes, Pose(0.0, 0.0, math.pi / 2), 4.0, 0.8)
    for x, length, speed in ((-2.0, 4.5, "0.6 m/s"), (2.0, 1.5, "0.2 m/s")):
        _named_arrow(axes, (x, 0.0), (x, length), speed, at_end=True)
    _named_arrow(axes, (-2.0, -3.2), (2.0, -3.2), "0.5 m", arrowstyle="<|-|>")
    return _fitted(
        figure,
        axes,
        "A robot with two wheels, 0.5 m apart, from above. The left wheel rolls ahead at 0.6 m/s, "
        "the right one at 0.2 m/s.",
    )


def _crossed_cables() -> Picture:
    figure, axes = _sheet()
    draw_robot(axes, Pose(0.0, 0.0, math.pi / 2), 4.0, 0.8)
    for x, name in ((-0.7, "left"), (0.7, "right")):
        axes.plot(x, -1.8, "s", ms=11, color=COLOURS["ink"])
        note(axes, name, (x, -1.8), (math.copysign(14, x), -26), ha="center", fontsize=_LETTERS)
        axes.plot([x, x, -2 * x, -2.6 * x], [-1.8, -1.3, -0.6, 0.0], color=COLOURS["goal"], lw=2.5)
    dart(axes, Pose(-3.5, 5.5, math.pi / 2), 0.7, zorder=5, **_LOOKS["goal"])
    note(axes, "goal", (-3.5, 5.5), _RIGHT, ha="center", va="center", fontsize=_LETTERS)
    return _fitted(
        figure,
        axes,
        "A robot from above: the cable of the left plug leads to the right wheel's motor, that of "
        "the right plug to the left one's. The goal lies ahead, to the left.",
    )


_ROBOTS = {"turning-centre": _two_speeds, "swapped-cables": _crossed_cables}
QUESTIONS = frozenset((*SCENES, *_ROBOTS))
"""Those that have a picture, by id."""


def _sheet() -> tuple:
    figure, axes = new_figure(5.0, 5.0)
    axes.set_axis_off()
    axes.set_aspect("equal")
    return figure, axes


def _fitted(figure: Figure, axes: Axes, said: str) -> Picture:
    """Give the figure the shape of what it shows, with room for the names."""
    axes.autoscale_view()
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    axes.set(xlim=(left - 0.9, right + 0.9), ylim=(low - 1.0, high + 0.6))
    shape = (high - low + 1.6) / (right - left + 1.8)
    figure.set_size_inches(5.6, 5.6 * min(max(shape, 0.68), 1.0))
    return Picture(figure, said)


def _named_arrow(axes: Axes, tail, tip, text: str, at_end: bool = False, **looks) -> None:
    pointer(axes, tail, tip, COLOURS["ink"], lw=1.8, **looks)
    axes.plot(*zip(tail, tip, strict=True), alpha=0.0)  # so that there is room for it
    (x0, y0), (x1, y1) = tail, tip
    at, up = (tip, (0, 14)) if at_end else ((0.5 * (x0 + x1), 0.5 * (y0 + y1)), (0, 14))
    note(axes, text, at, up, ha="center", va="center", fontsize=_LETTERS)
