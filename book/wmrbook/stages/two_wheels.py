"""Chapter 2: two motors make a speed and a turning rate, and nothing to the side."""

from __future__ import annotations

from wmrbook.live.parts import Knob
from wmrbook.stages.parts import Question, Scene, Stage
from wmrlib import Pose, advance, wheels_to_twist

TRACK_WIDTH = 0.5  # m, of the robot that is drawn
SECONDS = 3.0  # a drive
MOST = 0.6  # m/s, of a wheel
TWIST = "Two motors make two numbers, *v* = {speed} and *omega* = {turning}. "
TWICE = {"left": 0.3, "right": 0.6}  # m/s, the right one twice as fast


def two_wheels(scene: str = "arc") -> Stage:
    """Return the robot from above, with a slider for each wheel, as one of its scenes."""
    speeds = [-MOST, -MOST / 2, 0.0, MOST / 2, MOST]
    pairs = [(left, right) for left in speeds for right in speeds]
    moves = {
        "never": all(_sideways(*pair) < 1e-6 for pair in pairs),
        "if the wheels turn against each other": _sideways(-MOST, MOST) > 1e-6,
        "if one wheel stands still": _sideways(0.0, MOST) > 1e-6,
    }
    verdict = (
        "whatever the wheels do, it only moves ahead or back, and turns. Here it turns on the "
        "spot. To get to its side, it needs several moves."
    )
    beyond = (
        "both wheels turn by the same angle round that point, and the slower one has the shorter "
        "way, so the point lies beyond it. The robot {does}."
    )
    v, omega = wheels_to_twist(**TWICE, track_width=TRACK_WIDTH)
    points = {
        "one between the wheels": abs(v / omega) < TRACK_WIDTH / 2,
        "one to its left": v / omega > TRACK_WIDTH / 2,
        "one to its right": v / omega < -TRACK_WIDTH / 2,
    }
    scenes = {
        "arc": Scene(f"{TWIST}Can it move sideways?"),
        "straight": Scene(
            f"{TWIST}It {{does}}.",
            to={"left": 0.4, "right": 0.4},
        ),
        "turn": Scene(
            "In 3 s the left wheel rolls {left_way} and the right one {right_way}. "
            "The robot has turned by {turned}.",
            shows=("turn",),
        ),
        "centre": Scene(
            f"{TWIST}It {{does}}.",
            shows=("centre",),
            to=TWICE,
            ask=Question(
                "The right wheel rolls twice as fast as the left one. About which point does the "
                "robot turn?",
                dict.fromkeys(points, beyond),
                next(point for point, right in points.items() if right),
            ),
        ),
        "velocity": Scene(
            "The robot faces {heading} from east and drives at {speed}: {east} to the east and "
            "{north} to the north.",
            shows=("velocity",),
            still=True,
        ),
        "chord": Scene(
            "In 3 s it drives an arc of {arc}. The chord is {chord} long, and turned by half the "
            "turn, {half}. A straight step ends {miss} away.",
            shows=("chord",),
        ),
        "ask": Scene(
            f"{TWIST}It {{does}}.",
            still=True,
            ask=Question(
                "When does it move straight to its side?",
                dict.fromkeys(moves, verdict),
                next(answer for answer, right in moves.items() if right),
                {"left": -0.3, "right": 0.3},
            ),
        ),
        "aside": Scene(
            "{moves}. In the end it faces as before and stands {shifted}.",
            shows=("moves",),
            to={"left": 0.15, "right": 0.25},
        ),
    }
    knobs = {
        name: Knob(value, -MOST, MOST, 0.05, f"speed of the {name} wheel", "m/s", label=name)
        for name, value in (("left", 0.3), ("right", 0.5))
    }
    data = {"track_width": TRACK_WIDTH, "seconds": SECONDS}
    return Stage("two_wheels", knobs, scenes, scene, data=data)


def _sideways(left: float, right: float) -> float:
    """Return how fast the robot moves to its left or right, m/s."""
    v, omega = wheels_to_twist(left, right, TRACK_WIDTH)
    instant = 1e-9  # s
    return abs(advance(Pose(0.0, 0.0, 0.0), v, omega, instant).y) / instant
