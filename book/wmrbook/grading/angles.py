"""Checks of polar coordinates: the polar error, the signs in its rates, and gains out of a textbook with other signs."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import sympy as sp

from wmrbook.conventions import gains_near_goal
from wmrbook.grading._expressions import expression
from wmrbook.grading._hints import Passed, ask_numbers, close, expect, own_work
from wmrlib.gains import Gains
from wmrlib.kinematics import PolarError, Pose, advance, polar_error, pose_from_polar, wrap_angle
from wmrlib.symbolic import angle, rho

Polar = Callable[[float, float, float, float, float, float], tuple[float, float, float]]
_ORIGIN = Pose(0.0, 0.0, 0.0)


def polar_known(polar: Polar) -> Passed:
    """polar(x, y, heading, x_goal, y_goal, goal_heading): (rho, alpha, theta) in m and rad, right up to full turns."""
    own_work(polar)
    for pose, goal in _pairs(40):
        _explain_polar(ask_numbers(polar, 3, *pose, *goal), pose, goal)
    return Passed("Distance and both angles are right, in every quadrant.")


def polar_range(polar: Polar) -> Passed:
    """Both angles are between -pi and pi, also with the goal straight behind and with headings of more than a turn."""
    own_work(polar)
    straight_behind = (Pose(0.0, 0.0, 0.3), Pose(-5.0 * math.cos(0.3), -5.0 * math.sin(0.3), 0.3))
    turned = [
        (Pose(*pose[:2], pose.heading + 9.0), Pose(*goal[:2], goal.heading - 7.0))
        for pose, goal in _pairs(20)
    ]
    most = 0.0
    for pose, goal in [straight_behind, *_pairs(40), *turned]:
        for name, value in zip(
            ("alpha", "theta"), ask_numbers(polar, 3, *pose, *goal)[1:], strict=True
        ):
            most = max(most, abs(value))
            expect(
                abs(value) <= math.pi + 1e-9,
                f"{name} comes out as {math.degrees(value):.0f} deg: nobody turns further than half a turn. Bring it into (-pi, pi].",
            )
    expect(
        most > math.pi / 2.0,
        f"some goals lie behind the robot, and no angle is larger than {math.degrees(most):.0f} deg.",
    )
    behind = math.degrees(abs(ask_numbers(polar, 3, *straight_behind[0], *straight_behind[1])[1]))
    return Passed(f"No angle is larger than half a turn; straight behind is at {behind:.0f} deg.")


def polar_properties(polar: Polar) -> Passed:
    """A mirrored start sees mirrored angles, and a map that is moved and turned changes nothing."""
    own_work(polar)
    for pose, goal in _pairs(20):
        seen = ask_numbers(polar, 3, *pose, *goal)
        mirrored = ask_numbers(
            polar, 3, pose.x, -pose.y, -pose.heading, goal.x, -goal.y, -goal.heading
        )
        expect(
            close(mirrored[0], seen[0]) and _angles_equal((-mirrored[1], -mirrored[2]), seen[1:]),
            "seen in a mirror along the x axis, rho must stay and both angles change their sign.",
        )
        moved = ask_numbers(polar, 3, *_moved(pose), *_moved(goal))
        expect(
            close(moved[0], seen[0], 1e-9) and _angles_equal(moved[1:], seen[1:]),
            "robot and goal moved and turned together must see the same: is an angle counted from east?",
        )
        expect(
            abs(seen[1]) + abs(seen[2]) > 0.0,
            "both angles are zero for a robot and a goal that don't face each other.",
        )
    return Passed("Left mirrors right, and where east is does not matter.")


def tail_rows(tail_model: Any) -> Passed:
    """The rows of rho' and of the tail camera's angle', 3 x 2 in rho and angle, against the robot itself, moved a little."""
    rows, states = _rows(tail_model), _tail_states()
    if not all(_fits(rows[:2], measured[:2], where) for where, measured in states):
        turned = [[entry.subs(angle, angle + sp.pi) for entry in row] for row in rows]
        expect(
            not all(_fits(turned[:2], measured[:2], where) for where, measured in states),
            "this is what a camera on the nose sees: what does half a turn do to a cosine and to a sine?",
        )
        for row, name in ((0, "rho'"), (1, "angle'")):
            for column, command in ((0, "v"), (1, "omega")):
                expect(
                    all(
                        _fits(
                            [[rows[row][column]]],
                            measured[row : row + 1, column : column + 1],
                            where,
                        )
                        for where, measured in states
                    ),
                    f"the entry of {name} under {command} is not what a robot measures that "
                    f"{'drives ahead' if column == 0 else 'turns to the left'}: draw it, and look at the sign.",
                )
    return Passed("A robot that is moved by a hundredth of a millimetre measures these two rows.")


def tail_third(tail_model: Any) -> Passed:
    """The row of beta'."""
    rows, states = _rows(tail_model), _tail_states()
    opposite = [[-entry for entry in rows[2]]]
    if not all(_fits(rows[2:], measured[2:], where) for where, measured in states):
        expect(
            not all(_fits(opposite, measured[2:], where) for where, measured in states),
            "the third row has the opposite sign: whose angle is it, theta or beta, and what does the tail do to the sine?",
        )
        expect(
            False,
            "the third row is not what a robot measures: beta changes only as the line of sight swings.",
        )
    return Passed("And the third row too: the sign is found.")


def textbook_gains(
    our_gains: Callable[[float, float, float, float], tuple[float, float, float]],
) -> Passed:
    """our_gains(k_rho, k_alpha, k_beta, v_max): (k_rho, k_alpha, h) of the corrected law that does the same near the goal."""
    own_work(our_gains)
    for theirs in ((3.0, 8.0, -1.5), *_their_gains(12)):
        for v_max in (0.5, 1.0, 4.0):
            k_rho, k_alpha, h = ask_numbers(our_gains, 3, *theirs, v_max)
            expect(
                h >= 0.0,
                "h comes out negative: how do theta and beta differ, and what does that do to their gains?",
            )
            expect(
                k_rho >= 0.0 and k_alpha >= 0.0,
                "gains that park the robot there come out negative here: one of the differences is turned round.",
            )
            back = gains_near_goal(Gains(k_rho, k_alpha, h, v_max), "siegwart")
            if not all(close(value, right) for value, right in zip(back, theirs, strict=True)):
                expect(
                    close(back[0], theirs[0]),
                    f"with v_max = {v_max:g} m/s the speeds near the goal are not the same: what is (22) for small rho? Look at the units.",
                )
                expect(
                    not close(k_alpha, theirs[1]),
                    "k_alpha is taken over as it is; but our omega has alpha in its other term too.",
                )
                expect(
                    close(back[1], theirs[1]),
                    "near the goal, with theta = 0, the two robots turn at different rates: look at alpha's gain.",
                )
                expect(
                    False,
                    "near the goal, with alpha = 0, the two robots turn at different rates: look at h, and at its unit.",
                )
    return Passed("Near the goal both laws command the same: (3, 8, -1.5) is stable in both books.")


def _explain_polar(value: tuple[float, ...], pose: Pose, goal: Pose) -> None:
    """Raises Hint unless the value is the polar error, up to full turns."""
    distance, alpha, theta = polar_error(pose, goal)
    if not close(value[0], distance):
        expect(
            not close(value[0], distance**2), "rho comes out squared: metres, not square metres."
        )
        expect(False, "rho is not the distance between robot and goal.")
    seen, right = value[1:], (alpha, theta)
    if _angles_equal(seen, right):
        return
    sight = alpha + pose.heading
    swapped = math.pi / 2.0 - sight
    expect(
        not _angles_equal([math.radians(each) for each in seen], right),
        "the angles are in degrees; radians are asked for.",
    )
    expect(
        not _angles_equal((seen[0] + math.pi, seen[1] + math.pi), right),
        "the line of sight goes from the robot to the goal; yours goes back."
        if goal.x > pose.x
        else "with the goal in the west the line of sight points the opposite way: an atan of a quotient can't tell, an atan2 can.",
    )
    expect(
        not _angles_equal(seen, (swapped - pose.heading, swapped - goal.heading)),
        "the line of sight is counted from north, clockwise: which argument of atan2 comes first?",
    )
    expect(not _angles_equal(seen, right[::-1]), "alpha and theta have changed places.")
    expect(
        not _angles_equal(seen, (-alpha, -theta)),
        "both angles have the wrong sign: from the heading *to* the line of sight.",
    )
    if _angles_equal(seen[:1], right[:1]):
        expect(
            not _angles_equal(seen[1:], (-theta,)),
            "theta has the opposite sign: this is the beta of Corke and Siegwart.",
        )
        expect(
            not _angles_equal(seen[1:], (sight,)),
            "theta is counted from east: it is asked for from the goal's heading.",
        )
        error = pose.heading - goal.heading
        expect(
            not (_angles_equal(seen[1:], (error,)) or _angles_equal(seen[1:], (-error,))),
            "this third angle is between the two headings; theta has the line of sight on one side.",
        )
        expect(False, "rho and alpha are right, theta is not: compare with (3.2).")
    expect(
        not _angles_equal(seen[:1], (-alpha,)),
        "alpha has the wrong sign: with the goal on the left it is positive.",
    )
    expect(False, "alpha is not the angle from the robot's heading to the line of sight.")


def _angles_equal(one, other) -> bool:
    """Up to full turns."""
    return all(
        abs(math.remainder(a - b, 2.0 * math.pi)) < 1e-9 for a, b in zip(one, other, strict=True)
    )


def _moved(pose: Pose) -> Pose:
    """The map is turned by 100 deg and moved."""
    turn = math.radians(100.0)
    place = complex(pose.x, pose.y) * complex(math.cos(turn), math.sin(turn)) + complex(30.0, -20.0)
    return Pose(place.real, place.imag, pose.heading + turn)


def _pairs(count: int) -> list[tuple[Pose, Pose]]:
    """Random robots and goals; the first goals lie in the north-east."""
    random = np.random.default_rng(3)
    rows = random.uniform([-10.0, -10.0, -3.0] * 2, [10.0, 10.0, 3.0] * 2, (count, 6))
    rows[:4, :2], rows[:4, 3:5] = -np.abs(rows[:4, :2]), np.abs(rows[:4, 3:5])
    return [(Pose(*row[:3]), Pose(*row[3:])) for row in rows.tolist()]


def _rows(model: Any) -> list[list[sp.Expr]]:
    expect(model is not None and model is not ..., "`tail_model` has no value yet.")
    expect(
        isinstance(model, sp.MatrixBase),
        "`tail_model` has to be a matrix: `sp.Matrix([[..., ...], [..., ...], [..., ...]])`.",
    )
    expect(
        model.shape == (3, 2),
        f"`tail_model` has the shape {model.shape}; three rows (rho', angle', beta') by two columns (v, omega) are needed.",
    )
    return [
        [expression("tail_model", entry, (rho, angle)) for entry in model.row(k)] for k in range(3)
    ]


def _tail_states() -> list[tuple[tuple[float, float], np.ndarray]]:
    """(rho, angle), and the 3 x 2 rates there by central differences of what the robot sees."""
    random, dt = np.random.default_rng(6), 1e-5
    found = []
    for distance, alpha, theta in random.uniform(
        [0.5, -3.0, -3.0], [5.0, 3.0, 3.0], (12, 3)
    ).tolist():
        pose = pose_from_polar(PolarError(distance, alpha, theta), _ORIGIN)
        columns = []
        for v, omega in ((1.0, 0.0), (0.0, 1.0)):
            before, after = (
                polar_error(advance(pose, sign * v, sign * omega, dt), _ORIGIN)
                for sign in (-1.0, 1.0)
            )
            swings = [wrap_angle(b - a) for a, b in zip(before[1:], after[1:], strict=True)]
            columns.append(
                [(after.rho - before.rho) / (2 * dt), swings[0] / (2 * dt), -swings[1] / (2 * dt)]
            )
        found.append(((distance, wrap_angle(alpha - math.pi)), np.array(columns).T))
    return found


def _fits(rows: list[list[sp.Expr]], measured: np.ndarray, where: tuple[float, float]) -> bool:
    values = [
        [complex(entry.subs({rho: where[0], angle: where[1]}).evalf()) for entry in row]
        for row in rows
    ]
    return bool(np.allclose(values, measured, atol=1e-6))


def _their_gains(count: int) -> list[list[float]]:
    random = np.random.default_rng(5)
    k_rho, more, k_beta = random.uniform([0.5, 0.2, -3.0], [5.0, 5.0, -0.2], (count, 3)).T
    return np.transpose([k_rho, k_rho + more, k_beta]).tolist()
