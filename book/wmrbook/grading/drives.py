"""Checks of a simulation loop, and of a pose on a map with other axes."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from wmrbook.grading._asking import ask, ask_numbers, floats
from wmrbook.grading._hints import Hint, drawn, expect, explain, own_work, rule_out, same_pose, slip
from wmrlib.control import control_law
from wmrlib.gains import Gains
from wmrlib.kinematics import Pose, advance, polar_error, wrap_angle
from wmrlib.paper import outdoor
from wmrlib.simulation import simulate

Law = Callable[[float, float, float], tuple[float, float]]
Axes = Callable[[float, float, float], tuple[float, float, float]]
ARRIVAL_RADIUS = 0.05  # m
_ALLOWED = ("Pose", "polar_error", "wrap_angle")
_GAINS = Gains(k_rho=0.3, k_alpha=2.0, h=1.5, v_max=4.0)
_ORIGIN = Pose(0.0, 0.0, 0.0)


def drive_known(drive: Callable[..., Any]) -> str:
    """drive(start, goal, law, dt, duration): Euler's steps under a law, as `simulate` does them."""
    own_work(drive, *_ALLOWED)
    case = outdoor()
    for start, goal, dt in (
        (case.start, case.goal, 0.1),
        (Pose(8.0, 3.0, 3.0), Pose(-2.0, 1.0, -2.5), 0.05),
        (Pose(-6.0, 0.5, 2.0), _ORIGIN, 0.02),
    ):
        path = _path(drive, start, goal, _law, dt, 60.0)
        _explain_law(drive, path, start, goal, dt)
        for row, following in itertools.pairwise(path):
            pose = Pose(*row)
            _explain_step(following, pose, _law(*polar_error(pose, goal)), dt)
        right = simulate(start, goal, _GAINS, method="euler", dt=dt)
        left = polar_error(Pose(*path[-1]), goal).rho
        hint = f"it stops {left:.2f} m before the goal; 0.05 m are asked for."
        expect(len(path) >= len(right), hint)
        hint = "it goes on after it has come within 0.05 m of the goal; "
        expect(len(path) == len(right), hint + "that pose should be the last.")
    count = len(simulate(case.start, case.goal, _GAINS, method="euler"))
    return f"The paper's trip in {count} poses, each as `simulate` has it."


def drive_arrives(drive: Callable[..., Any]) -> str:
    """From twelve starts round the goal, the robot ends within 0.05 m and 10 deg."""
    own_work(drive, *_ALLOWED)
    worst = 0.0
    for k in range(12):
        angle = 2.0 * math.pi * k / 12 + 0.1
        start = Pose(12.0 * math.cos(angle), 12.0 * math.sin(angle), 2.0 * k)
        path = _path(drive, start, _ORIGIN, _law, 0.02, 60.0)
        rho, off = math.hypot(*path[-1, :2]), abs(math.degrees(wrap_angle(float(path[-1, 2]))))
        from_where = f"from {math.degrees(wrap_angle(angle)):.0f} deg round the goal it ends"
        expect(rho <= ARRIVAL_RADIUS, f"{from_where} {rho:.2g} m away.")
        expect(off < 10.0, f"{from_where} at the right place, {off:.0f} deg off.")
        turned = math.degrees(np.abs(wrap_angle(np.diff(path[:, 2]))).sum())
        hint = f"{from_where} well, but has turned by {turned:.0f} deg on its way: "
        expect(turned < 540.0, hint + "nobody has to. Wrap alpha and theta.")
        worst = max(worst, off)
    return f"Twelve of twelve starts park; the worst is {worst:.1f} deg off."


def drive_obeys(drive: Callable[..., Any]) -> str:
    """It does what the law says, whatever the law, and stops when the time is up."""
    own_work(drive, *_ALLOWED)
    commands = {
        "stands still": (0.0, 0.0),
        "turns on the spot": (0.0, 0.7),
        "drives in a circle": (1.0, 0.7),
        "backs": (-1.0, 0.0),
    }
    for does, command in commands.items():
        pose = Pose(3.0, 4.0, 0.5)
        path = _path(drive, pose, _ORIGIN, partial(_commanded, command), 0.125, 4.0)
        hint = "in 4 s with dt = 0.125 s there are 33 poses, the start and one after each step; "
        expect(len(path) == 33, f"{hint}a robot that {does} has {len(path)}.")
        hint = f"under a law that {does} it does not: "
        for row in path[1:]:
            pose = advance(pose, *command, 0.125, method="euler")
            obeyed = same_pose(row, pose, 1e-6)
            expect(obeyed, hint + "is the law that is passed in the one that is used?")
    there = _path(drive, Pose(0.01, 0.0, 0.5), _ORIGIN, _law, 0.1, 4.0)
    hint = "a robot that starts 1 cm from its goal has arrived, and needs no step; "
    expect(len(there) == 1, f"{hint}yours takes {len(there) - 1}.")
    return "The loop obeys any law, and ends when the time is up."


def axes_known(with_x_north: Axes) -> str:
    """with_x_north(x, y, heading): the pose on the map with x north and y east."""
    own_work(with_x_north)
    for pose in _poses(20):
        value = ask_numbers(with_x_north, 3, *pose)
        x, y, heading = right = pose.y, pose.x, math.pi / 2.0 - pose.heading
        if same_pose(value, right):
            continue
        hint = "x and y are as they were; which of the two is metres north on the new map?"
        expect(math.dist(value[:2], pose[:2]) > 1e-9, hint)
        slip(value, right, "(x, y, heading)")
        hint = "the place is wrong: one number is metres north, the other metres east, "
        expect(math.dist(value[:2], right[:2]) < 1e-9, hint + "and the new x is north.")
        mistakes = {
            "the heading is as it was: a robot that looks north has 90 deg on the old map, "
            "and on the new one?": (x, y, pose.heading),
            "the heading is turned, but goes round the wrong way: "
            "where do you get from x towards y on the new map?": (x, y, -heading),
        }
        otherwise = "the heading is wrong: try robots that look north, east and south-east."
        explain(value, mistakes, otherwise, same_pose)
    return "A robot that looks north has the heading 90 deg on one map, and 0 on the other."


def axes_properties(with_x_north: Axes) -> str:
    """Twice leads back, and a left bend on one map is a right bend on the other."""
    own_work(with_x_north)
    for pose in _poses(20):
        new = Pose(*ask_numbers(with_x_north, 3, *pose))
        twice = ask_numbers(with_x_north, 3, *new)
        hint = "done twice it must lead back: x east and y north are the first map again."
        expect(same_pose(twice, pose), hint)
        after = ask_numbers(with_x_north, 3, *advance(pose, 1.5, 0.8, 0.5))
        hint = "this map is turned, not flipped: on the new one a left bend must look like "
        hint += "a right bend."
        expect(not same_pose(after, advance(new, 1.5, 0.8, 0.5)), hint)
        hint = "a robot that drives where it looks on one map does not do so on the other."
        expect(same_pose(after, advance(new, 1.5, -0.8, 0.5)), hint)
    left = "Twice leads back; left on one map is right on the other,"
    return f"{left} so alpha, theta and omega change their signs."


def _explain_law(
    drive: Callable[..., Any], path: np.ndarray, start: Pose, goal: Pose, dt: float
) -> None:
    """Raise Hint if a step is one for something other than the polar error."""
    still = _path(drive, start, goal, partial(_commanded, (0.0, 0.0)), dt, 4.0 * dt)
    moved = len(path) < 2 or not same_pose(still[-1], start)
    expect(not moved, "the law that is passed in is never asked.")
    for row, following in itertools.pairwise(path):
        pose = Pose(*row)
        rho, alpha, theta = polar_error(pose, goal)
        sight = math.atan2(goal.y - pose.y, goal.x - pose.x)
        wide, sign = (rho, sight - pose.heading, sight - goal.heading), (rho, alpha, -theta)
        mistakes = {
            "the law is given theta and alpha in the wrong order.": (rho, theta, alpha),
            "the law is given a theta that is counted from east, not from the goal's heading.": (
                rho,
                alpha,
                sight,
            ),
            "the law is given angles of more than half a turn: wrap alpha and theta.": wide,
            "the law is given something other than (rho, alpha, theta): a sign?": sign,
        }
        step = partial(advance, pose, dt=dt, method="euler")
        if not same_pose(following, step(*_law(rho, alpha, theta))):
            steps = {hint: step(*_law(*seen)) for hint, seen in mistakes.items()}
            rule_out(following, steps, same_pose)


def _explain_step(value: np.ndarray, pose: Pose, command: tuple[float, float], dt: float) -> None:
    """Raise Hint unless the value is Euler's step from the pose."""
    v, omega = command
    right = advance(pose, v, omega, dt, method="euler")
    if same_pose(value, right):
        return
    arc, long, turned = (
        advance(pose, v, side * omega, seconds, method=method)
        for side, seconds, method in ((1, dt, "arc"), (1, 1.0, "euler"), (-1, dt, "euler"))
    )
    late = advance(pose._replace(heading=pose.heading + omega * dt), v, 0.0, dt)
    mistakes = {
        "x and y move along the *new* heading: Euler's step takes all rates at the old pose.": late,
        "this step is an arc; Euler's, along the old heading, is asked for.": arc,
        "this step takes a second: a rate times dt is wanted.": long,
        "the heading turns the wrong way: (5).": turned,
    }
    rule_out(value, mistakes, same_pose)
    near = math.dist(value[:2], right[:2]) < 1e-9
    expect(near, "a step leads to the wrong place: (3) and (4), times dt.")
    expect(False, "a step ends with the wrong heading: (5), times dt.")


def _path(
    drive: Callable[..., Any], start: Pose, goal: Pose, law: Law, dt: float, duration: float
) -> np.ndarray:
    """The student's run as rows (x, y, heading), the first of which is the start."""
    answer = ask(drive, start, goal, law, dt, duration)
    three = "`drive` has to return x, y and heading, as three lists or arrays of the same length."
    try:
        x, y, heading = map(floats, answer.tolist() if hasattr(answer, "tolist") else answer)
    except (TypeError, ValueError):
        raise Hint(three) from None
    expect(not any(values is None for values in (x, y, heading)), three)
    expect(x.ndim == 1 and x.shape == y.shape == heading.shape and len(x) > 0, three)
    path = np.column_stack([x, y, heading])
    expect(bool(np.isfinite(path).all()), "the run has numbers in it that are not finite.")
    slip(path[0], start, "(x, y, heading)")
    expect(same_pose(path[0], start), "the first pose has to be the start.")
    return path


def _commanded(command: tuple[float, float], *_: float) -> tuple[float, float]:
    return command


def _law(rho: float, alpha: float, theta: float) -> tuple[float, float]:
    return control_law(float(rho), float(alpha), float(theta), _GAINS)


def _poses(count: int) -> list[Pose]:
    return [Pose(*row) for row in drawn(13, count, (-50.0, 50.0), (-50.0, 50.0), (-3.0, 3.0))]
