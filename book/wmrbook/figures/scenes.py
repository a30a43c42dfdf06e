"""What the concept questions' slides show: the angles by name, and situations, never an answer."""

from __future__ import annotations

import math

from matplotlib.axes import Axes
from matplotlib.patches import Circle

from wmrbook.figures._drawing import note, pointer
from wmrbook.figures.angles import draw_angles
from wmrbook.figures.robot import draw_robot
from wmrbook.figures.style import COLOURS, Picture, new_figure, pose_arrow, robot
from wmrlib.kinematics import Pose

_LOOKS = {
    "robot": (robot, "path"),
    "goal": (pose_arrow, "goal"),
    "seen": (robot, "ghost"),
}
_ENDS = {"arrow": "-|>", "span": "<|-|>"}
_NAMED_AT = {  # points from the middle, and where the name is aligned
    "v": ((0, -38), "center"),
    "^": ((0, 38), "center"),
    ">": ((28, 0), "left"),
    "<": ((-28, 0), "right"),
}
_TIP = 2.2  # of the picture's units, from a goal to the tip of its arrow, or a little more
# The alternative text, and what is drawn: a robot's or a goal's x, y and heading in deg, where its
# name stands, and its name if it has another; arrows with one end or two, from x, y to x, y, and
# their text; lines and cables from point to point; names at x, y.
SCENES = {
    "two-angles": (
        "The robot faces north-west. The goal lies west of it and looks south. North is up.",
        "robot 0 0 135 v; goal -7 0 -90 >; arrow -3.5 2.5 -3.5 4.5 north",
    ),
    "level-spot": (
        "The robot is almost on the goal, which lies straight ahead; the goal's heading is 60 deg "
        "to the right of the robot's.",
        "robot -0.5 -0.87 60 >; goal 0 0 0 <; arrow 0 0 4 0 goal's heading; "
        "arrow 0 0 2 3.46 robot's heading",
    ),
    "millimetre-beside": (
        "The robot stands to the right of its goal, 1 mm away; both look the same way.",
        "goal 0 0 90 <; robot 5 0 90 >; span 0 1.6 5 1.6 1 mm",
    ),
    "mirror": (
        "A start and a goal above the x axis, and below it, dotted, their mirror images.",
        "robot -3.5 2.8 -50 ^ start; goal 3.5 1.8 30 ^; seen -3.5 -2.8 50; seen 3.5 -1.8 -30; "
        "arrow -6 0 6 0 $x$",
    ),
    "how-far-behind": (
        "A goal drives straight on at 1 m/s; a robot follows behind it, a distance rho away.",
        r"robot -4 0 0 v; goal 2 0 0 v; span -4 1.4 2 1.4 $\rho$; arrow 2.8 0 5.5 0 1 m/s",
    ),
    "nearer": (
        "A goal drives round a circle; a robot follows a little behind it, on the circle too.",
        "robot 3.46 2 120 <; goal 1.37 3.76 160 v; circle 4",
    ),
    "constant-offset": (
        "The robot, and dotted, 2 m further east, where the receiver shows it; the goal is ahead.",
        "robot -1.5 -3 70 <; seen 2 -3 70 > shown; goal 1 3 90 >; span -1.5 -1.4 2 -1.4 2 m; "
        "arrow -4.5 0.5 -4.5 2.5 north",
    ),
    "bearing-for-heading": (
        "Robot and goal look east; the goal lies 10 m ahead of the robot. North is up.",
        "robot -4 0 0 v; goal 4 0 0 v; span -4 1.4 4 1.4 10 m; arrow 0 2.6 0 4.6 north",
    ),
    "turning-centre": (
        "A robot with two wheels, 0.5 m apart, from above. The left wheel rolls ahead at 0.6 m/s, "
        "the right one at 0.2 m/s.",
        "wheels; arrow -2 0 -2 4.5 0.6 m/s; arrow 2 0 2 1.5 0.2 m/s; span -2 -3.2 2 -3.2 0.5 m",
    ),
    "four-moves": (
        "The robot before its moves, and dotted, ahead of there and turned to the left, after two "
        "of the four.",
        "robot 0 -3 90 < before; seen 0 2.5 120 > after two moves; arrow 0 -1.6 0 0.6 forward",
    ),
    "one-factor": (
        "A robot with two wheels, 0.5 m apart, from above. The law asks for 2 m/s ahead and for "
        "4 rad/s to the left.",
        "wheels; arrow 0 0 0 4.5 2 m/s, 4 rad/s; span -2 -3.2 2 -3.2 0.5 m",
    ),
    "swapped-cables": (
        "A robot from above: the cable of the left plug leads to the right wheel's motor, that of "
        "the right plug to the left one's. The goal lies ahead, to the left.",
        "wheels; goal -3.5 5.5 90 >; "
        "cable -0.7 -1.8 -0.7 -1.3 1.4 -0.6 1.8 0; "
        "cable 0.7 -1.8 0.7 -1.3 -1.4 -0.6 -1.8 0; name -0.9 -2.5 left; name 0.9 -2.5 right",
    ),
    "along-a-route": (
        "A start and three goals in a row, joined by straight legs; the first two are only passed.",
        "line -6 -2 -2 -2; line -2 -2 2 1; line 2 1 6 -2; "
        "robot -6 -2 0 v start; goal -2 -2 18 v 1; goal 2 1 0 ^ 2; goal 6 -2 -37 v 3",
    ),
}


NARROW = 4.6  # inches, beside five options


def scene_of(question: str) -> Picture | None:
    """Return the picture of a question's situation; None if it has none."""
    if question not in SCENES:
        return None
    alt, drawn = SCENES[question]
    figure, axes = new_figure(5.0, 5.0)
    axes.set_axis_off()
    axes.set_aspect("equal")
    for kind, *given in (part.split(" ") for part in drawn.split("; ")):
        count = {"wheels": 0, "circle": 1, "name": 2, "arrow": 4, "span": 4}.get(kind, len(given))
        count = 3 if kind in _LOOKS else count
        _draw(axes, kind, [*map(float, given[:count])], given[count:])
    axes.autoscale_view()
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    axes.set(xlim=(left - 0.9, right + 0.9), ylim=(low - 1.0, high + 0.6))
    shape = (high - low + 1.6) / (right - left + 1.8)
    figure.set_size_inches(5.6, 5.6 * min(max(shape, 0.68), 1.0))
    return Picture(figure, alt, narrowest=NARROW)


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
        narrowest=NARROW,
    )


def _draw(axes: Axes, kind: str, numbers: list[float], words: list[str]) -> None:
    letters = {"ha": "center", "va": "center", "fontsize": 17}
    if kind in _LOOKS:
        x, y, heading = numbers
        draw, role = _LOOKS[kind]
        draw(axes, Pose(x, y, math.radians(heading)), role, 1.4, zorder=5)
        angle, reach = math.radians(heading), _TIP * (kind == "goal")
        axes.plot(  # so that there is room for it
            [x, x + reach * math.cos(angle)], [y, y + reach * math.sin(angle)], alpha=0.0
        )
        if words:
            name = " ".join(words[1:]) or kind
            offset, side = _NAMED_AT[words[0]]
            note(axes, name, (x, y), offset, **letters | {"ha": side})
    elif kind == "circle":
        axes.add_patch(Circle((0.0, 0.0), *numbers, fill=False, ls="--", lw=1.5))
    elif kind == "wheels":
        draw_robot(axes, Pose(0.0, 0.0, math.pi / 2), 4.0, 0.8)
    elif kind == "name":
        axes.text(*numbers, *words, **letters)
    elif kind in ("line", "cable"):
        looks = (
            {"ls": "--", "color": COLOURS["ink"]} if kind == "line" else {"color": COLOURS["goal"]}
        )
        axes.plot(numbers[::2], numbers[1::2], lw=2.0, **looks)
    else:
        tail, tip = numbers[:2], numbers[2:]
        pointer(axes, tail, tip, COLOURS["ink"], lw=1.8, arrowstyle=_ENDS[kind])
        axes.plot(*zip(tail, tip, strict=True), alpha=0.0)  # so that there is room for it
        at = tip if kind == "arrow" else [0.5 * (a + b) for a, b in zip(tail, tip, strict=True)]
        note(axes, " ".join(words), at, (0, 14), **letters)
