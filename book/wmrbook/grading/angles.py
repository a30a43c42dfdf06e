"""Checks of polar coordinates: the polar error, the signs in its rates, a textbook's gains."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import sympy as sp

from wmrbook.conventions import gains_near_goal
from wmrbook.grading._asking import ask_numbers, expect_value, ordered
from wmrbook.grading._expressions import expression
from wmrbook.grading._hints import (
    angle_equal,
    close,
    drawn,
    expect,
    explain,
    own_work,
    rule_out,
    slip,
    spread,
)
from wmrlib.gains import Gains
from wmrlib.kinematics import PolarError, Pose, advance, polar_error, pose_from_polar, wrap_angle
from wmrlib.symbolic import angle, rho

Polar = Callable[[float, float, float, float, float, float], tuple[float, float, float]]
_ORIGIN = Pose(0.0, 0.0, 0.0)


def polar_known(polar: Polar) -> str:
    """polar(x, y, heading, x_goal, y_goal, goal_heading): (rho, alpha, theta), up to full turns."""
    own_work(polar)
    for pose, goal in _pairs(40):
        _explain_polar(ask_numbers(polar, 3, *pose, *goal), pose, goal)
    return "Distance and both angles are right, in every quadrant."


def polar_range(polar: Polar) -> str:
    """Both angles are in [-pi, pi], with the goal straight behind and after full turns too."""
    own_work(polar)
    behind = (Pose(0.0, 0.0, 0.3), Pose(-5.0 * math.cos(0.3), -5.0 * math.sin(0.3), 0.3))
    turned = [
        (pose._replace(heading=pose.heading + 9.0), goal._replace(heading=goal.heading - 7.0))
        for pose, goal in _pairs(20)
    ]
    most = 0.0
    for pose, goal in [behind, *_pairs(40), *turned]:
        for name, value in zip(("alpha", "theta"), _answered(polar, pose, goal)[1:], strict=True):
            most = max(most, abs(value))
            hint = f"{name} comes out as {math.degrees(value):.6g} deg: "
            hint += "nobody turns further than half a turn. Bring it into (-pi, pi]."
            expect(abs(value) <= math.pi + 1e-9, hint)
    hint = "some goals lie behind the robot, and no angle is larger than "
    expect(most > math.pi / 2.0, f"{hint}{math.degrees(most):.0f} deg.")
    straight = math.degrees(abs(_answered(polar, *behind)[1]))
    return f"No angle is larger than half a turn; straight behind is at {straight:.0f} deg."


def polar_properties(polar: Polar) -> str:
    """A mirrored start sees mirrored angles, and a map that is moved and turned changes nothing."""
    own_work(polar)
    for pose, goal in _pairs(20):
        distance, *both = _answered(polar, pose, goal)
        mirrored = [Pose(x, -y, -heading) for x, y, heading in (pose, goal)]
        there, *angles = _answered(polar, *mirrored)
        hint = "seen in a mirror along the x axis, "
        hint += "rho must stay and both angles change their sign."
        opposite = [-angle for angle in angles]
        expect(close(there, distance) and _angles_equal(opposite, both), hint)
        there, *angles = _answered(polar, _moved(pose), _moved(goal))
        hint = "robot and goal moved and turned together must see the same: "
        hint += "is an angle counted from east?"
        expect(close(there, distance, 1e-9) and _angles_equal(angles, both), hint)
        hint = "both angles are zero for a robot and a goal that don't face each other."
        expect(abs(both[0]) + abs(both[1]) > 0.0, hint)
    return "Left mirrors right, and where east is does not matter."


def tail_rows(tail_model: Any) -> str:
    """The rows of rho' and of the tail camera's angle', against a robot that is moved a little."""
    rows = _rows(tail_model)
    if not _fits(rows[:2], slice(2)):
        turned = [[entry.subs(angle, angle + sp.pi) for entry in row] for row in rows]
        hint = "this is what a camera on the nose sees: "
        hint += "what does half a turn do to a cosine and to a sine?"
        expect(not _fits(turned[:2], slice(2)), hint)
        for row, name in ((0, "rho'"), (1, "angle'")):
            commands = ("v", "drives ahead"), ("omega", "turns to the left")
            for column, (command, does) in enumerate(commands):
                hint = f"the entry of {name} under {command} is not what a robot measures that "
                hint += f"{does}: draw it, and look at the sign."
                expect(_fits([[rows[row][column]]], slice(row, row + 1), column), hint)
    return "A robot that is moved by a hundredth of a millimetre measures these two rows."


def tail_third(tail_model: Any) -> str:
    """The row of beta'."""
    rows = _rows(tail_model)
    hint = "the third row has the opposite sign: "
    hint += "whose angle is it, theta or beta, and what does the tail do to the sine?"
    expect(not _fits([[-entry for entry in rows[2]]], slice(2, 3)), hint)
    hint = "the third row is not what a robot measures: "
    expect(_fits(rows[2:], slice(2, 3)), f"{hint}beta changes only as the line of sight swings.")
    return "And the third row too: the sign is found."


def textbook_gains(
    our_gains: Callable[[float, float, float, float], tuple[float, float, float]],
) -> str:
    """our_gains(k_rho, k_alpha, k_beta, v_max): gains that do the same near the goal."""
    own_work(our_gains)
    rows = drawn(5, 12, (0.5, 5.0), (0.2, 5.0), (-3.0, -0.2))
    stable = [(k_rho, k_rho + more, k_beta) for k_rho, more, k_beta in rows]
    for theirs in ((3.0, 8.0, -1.5), *stable):
        for v_max in (0.5, 1.0, 4.0):
            k_rho, k_alpha, h = given = ask_numbers(our_gains, 3, *theirs, v_max)
            right = theirs[0] / v_max, theirs[1] - theirs[0], -theirs[2] / theirs[0]
            slip(given, right, "(k_rho, k_alpha, h)")
            hint = "h comes out negative: how do theta and beta differ, "
            expect(h >= 0.0, f"{hint}and what does that do to their gains?")
            hint = "gains that park the robot there come out negative here: "
            expect(min(k_rho, k_alpha) >= 0.0, f"{hint}one of the differences is turned round.")
            back = gains_near_goal(Gains(k_rho, k_alpha, h, v_max), "siegwart")
            hint = f"with v_max = {v_max:g} m/s the speeds near the goal are not the same: what is "
            expect(close(back[0], theirs[0]), f"{hint}(22) for small rho? Look at the units.")
            if not close(back[1], theirs[1]):
                hint = "k_alpha is taken over as it is; "
                hint += "but our omega has alpha in its other term too."
                expect(not close(k_alpha, theirs[1]), hint)
            turn = "the two robots turn at different rates: look at"
            hint = f"near the goal, with theta = 0, {turn} alpha's gain."
            expect(close(back[1], theirs[1]), hint)
            hint = f"near the goal, with alpha = 0, {turn} h, and at its unit."
            expect(close(back[2], theirs[2]), hint)
    return "Near the goal both laws command the same: (3, 8, -1.5) is stable in both books."


def _answered(polar: Polar, pose: Pose, goal: Pose) -> tuple[float, ...]:
    return ask_numbers(polar, 3, *pose, *goal)


def _explain_polar(value: tuple[float, ...], pose: Pose, goal: Pose) -> None:
    """Raise Hint unless the value is the polar error, up to full turns."""
    distance, alpha, theta = error = polar_error(pose, goal)
    if not close(value[0], distance):
        slip(value, error, "(rho, alpha, theta)")
        mistakes = {"rho comes out squared: metres, not square metres.": distance**2}
        explain(value[0], mistakes, "rho is not the distance between robot and goal.")
    angles, right = value[1:], (alpha, theta)
    if _angles_equal(angles, right):
        return
    in_degrees = _angles_equal([math.radians(angle) for angle in angles], right)
    expect(not in_degrees, "the angles are in degrees; radians are asked for.")
    sight, minus = alpha + pose.heading, (-alpha, -theta)
    from_north = math.pi / 2.0 - sight
    back = "the line of sight goes from the robot to the goal; yours goes back."
    if goal.x <= pose.x:
        back = "with the goal in the west the line of sight points the opposite way: "
        back += "an atan of a quotient can't tell, an atan2 can."
    mistakes = {
        back: (alpha + math.pi, theta + math.pi),
        "the line of sight is counted from north, clockwise: which argument of atan2 "
        "comes first?": (from_north - pose.heading, from_north - goal.heading),
        "alpha and theta have changed places.": (theta, alpha),
        "both angles have the wrong sign: from the heading *to* the line of sight.": minus,
    }
    rule_out(angles, mistakes, _angles_equal)
    slip(value, error)
    if _angles_equal(angles[:1], right[:1]):
        error = pose.heading - goal.heading
        third = any(angle_equal(angles[1], candidate) for candidate in (error, -error))
        hint = "this third angle is between the two headings; "
        expect(not third, f"{hint}theta has the line of sight on one side.")
        mistakes = {
            "theta has the opposite sign: this is the beta of Corke and Siegwart.": -theta,
            "theta is counted from east: it is asked for from the goal's heading.": sight,
        }
        otherwise = "rho and alpha are right, theta is not: compare with (3.2)."
        explain(angles[1], mistakes, otherwise, angle_equal)
    mistakes = {"alpha has the wrong sign: with the goal on the left it is positive.": -alpha}
    otherwise = "alpha is not the angle from the robot's heading to the line of sight."
    explain(angles[0], mistakes, otherwise, angle_equal)


def _angles_equal(some, others) -> bool:
    return all(angle_equal(one, other) for one, other in zip(some, others, strict=True))


def _moved(pose: Pose) -> Pose:
    """The map is turned by 100 deg and moved."""
    turn = math.radians(100.0)
    place = complex(pose.x, pose.y) * complex(math.cos(turn), math.sin(turn)) + complex(30.0, -20.0)
    return Pose(place.real, place.imag, pose.heading + turn)


def _pairs(count: int) -> list[tuple[Pose, Pose]]:
    """Robots and goals: the first goals lie in the north-east, the last due east, north, ..."""
    random = np.random.default_rng(3)
    rows = random.uniform([-10.0, -10.0, -3.0] * 2, [10.0, 10.0, 3.0] * 2, (count, 6))
    rows[:4, :2], rows[:4, 3:5] = -np.abs(rows[:4, :2]), np.abs(rows[:4, 3:5])
    for row, far in zip(rows[count // 2 :], spread(1e-3, 1e3, count - count // 2), strict=True):
        row[3:5] = row[:2] + far * random.permutation([random.choice([-1.0, 1.0]), 0.0])
    return [(Pose(*row[:3]), Pose(*row[3:])) for row in rows.tolist()]


def _rows(model: Any) -> list[list[sp.Expr]]:
    expect_value("`tail_model`", model)
    rows = model.tolist() if hasattr(model, "tolist") else model
    hint = "`tail_model` has to be a matrix, `sp.Matrix([[..., ...], [..., ...], [..., ...]])`: "
    hint += "three rows (rho', angle', beta') by two columns (v, omega)."
    expect(ordered(rows, 3) and all(ordered(row, 2) for row in rows), hint)
    return [[expression("tail_model", entry, (rho, angle)) for entry in row] for row in rows]


def _tail_states() -> list[tuple[tuple[float, float], np.ndarray]]:
    """(rho, angle), and the 3 x 2 rates there by central differences of what the robot sees."""
    dt, states = 1e-5, []
    for distance, alpha, theta in drawn(6, 12, (0.5, 5.0), (-3.0, 3.0), (-3.0, 3.0)):
        pose = pose_from_polar(PolarError(distance, alpha, theta), _ORIGIN)
        columns = []
        for v, omega in ((1.0, 0.0), (0.0, 1.0)):
            before, after = (
                polar_error(advance(pose, sign * v, sign * omega, dt), _ORIGIN)
                for sign in (-1.0, 1.0)
            )
            rho, nose, line = np.subtract(after, before)
            columns.append([rho, wrap_angle(nose), -wrap_angle(line)])
        rates = np.transpose(columns) / (2.0 * dt)
        states.append(((distance, wrap_angle(alpha - math.pi)), rates))
    return states


def _fits(rows: list[list[sp.Expr]], which: slice, column: int | None = None) -> bool:
    """Whether these rows (or one column of them) are what the robot measures, in all states."""
    entries = sp.lambdify((rho, angle), rows)
    columns = slice(None) if column is None else slice(column, column + 1)
    with np.errstate(all="ignore"):
        return all(
            np.allclose(np.array(entries(*where), complex), rates[which, columns], atol=1e-6)
            for where, rates in _tail_states()
        )
