"""The checks of polar coordinates: other right answers pass, and what is no answer gets a clear hint."""

import cmath
import math

import numpy as np
import pytest
import sympy as sp

import wmrlib as wmr
from wmrbook.grading import Hint, angles
from wmrlib.symbolic import angle, rho


def polar(x, y, heading, x_goal, y_goal, goal_heading):
    """By complex numbers, in numpy's floats."""
    line = complex(x_goal - x, y_goal - y)
    return np.array(
        [
            abs(line),
            *(cmath.phase(line * cmath.exp(-1j * each)) for each in (heading, goal_heading)),
        ]
    )


def without_wrap(*numbers):
    return polar(*numbers) + np.array([0.0, 2 * math.pi, -4 * math.pi])


def half_open(*numbers):
    """In [-pi, pi): straight behind is -pi."""
    seen = polar(*numbers)
    return seen[0], *((each + math.pi) % (2 * math.pi) - math.pi for each in seen[1:])


MODEL = sp.Matrix([[sp.cos(angle), 0], [-sp.sin(angle) / rho, -1], [sp.sin(angle) / rho, 0]])


def test_other_forms_pass():
    for answer in (polar, half_open):
        for check in (angles.polar_known, angles.polar_range, angles.polar_properties):
            assert check(answer)
    assert angles.polar_known(without_wrap)
    for form in (
        MODEL,
        sp.ImmutableMatrix(MODEL),
        MODEL.subs(sp.cos(angle), sp.sin(angle + sp.pi / 2)),
        MODEL * 1.0,
    ):
        assert angles.tail_rows(form)
        assert angles.tail_third(form)
    assert angles.textbook_gains(lambda a, b, c, v: np.array([a / v, b - a, -c / a]))


def test_tail_by_algebra():
    """A second method for the matrix: (7) to (9) with alpha = angle + pi, at random states."""
    for distance, tail, v, omega in np.random.default_rng(1).uniform(
        [0.1, -3, -2, -2], [5, 3, 2, 2], (20, 4)
    ):
        rates = wmr.polar_rate(distance, tail + math.pi, v, omega)
        ours = np.array(MODEL.subs({rho: distance, angle: tail})).astype(float) @ [v, omega]
        assert ours == pytest.approx([rates[0], rates[1], -rates[2]], abs=1e-9)


@pytest.mark.parametrize(
    ("change", "hint"),
    [
        (lambda seen, *_: (seen[0] ** 2, *seen[1:]), "squared"),
        (lambda seen, *_: (seen[0] + 1, *seen[1:]), "not the distance"),
        (lambda seen, *_: (seen[0], *np.degrees(seen[1:])), "in degrees"),
        (lambda seen, *_: (seen[0], seen[1] + math.pi, seen[2] + math.pi), "yours goes back"),
        (lambda seen, *_: (seen[0], seen[2], seen[1]), "changed places"),
        (lambda seen, *_: (seen[0], -seen[1], -seen[2]), "both angles have the wrong sign"),
        (lambda seen, *_: (seen[0], -seen[1], seen[2]), "alpha has the wrong sign"),
        (lambda seen, *_: (seen[0], 0.0, seen[2]), "alpha is not the angle"),
        (lambda seen, *_: (seen[0], seen[1], seen[2] - seen[1]), "between the two headings"),
        (lambda seen, *_: (seen[0], seen[1], 0.0), "theta is not"),
        (
            lambda seen, x, y, h, a, b, g: (
                seen[0],
                math.pi / 2 - seen[1] - 2 * h,
                math.pi / 2 - seen[2] - 2 * g,
            ),
            "counted from north",
        ),
        (lambda seen, *_: seen[:2], "3 numbers"),
        (lambda seen, *_: None, "3 numbers"),
    ],
)
def test_polar_hints(change, hint):
    with pytest.raises(Hint, match=hint):
        angles.polar_known(lambda *numbers: change(polar(*numbers), *numbers))


def test_polar_refuses_wmrlib():
    with pytest.raises(Hint, match="of wmrlib"):
        angles.polar_known(
            lambda x, y, h, a, b, g: wmr.polar_error(wmr.Pose(x, y, h), wmr.Pose(a, b, g))
        )


def test_angles_that_never_look_back():
    with pytest.raises(Hint, match="no angle is larger than 0 deg"):
        angles.polar_range(lambda *each: (1.0, 0.0, 0.0))


@pytest.mark.parametrize(
    "answer",
    [
        lambda *each: (
            polar(*each) + np.array([0.0, 0.1, 0.0])
        ),  # right distance, angles that don't mirror
        lambda *each: (
            polar(*each) + np.array([max(each[1], 0.0), 0.0, 0.0])
        ),  # right angles, distance that does not
    ],
)
def test_what_does_not_mirror(answer):
    with pytest.raises(Hint, match="in a mirror"):
        angles.polar_properties(answer)


def test_constants_are_no_polar_error():
    with pytest.raises(Hint, match="zero"):
        angles.polar_properties(lambda *_: (1.0, 0.0, 0.0))


@pytest.mark.parametrize(
    ("model", "hint"),
    [
        (None, "no value yet"),
        ([[1, 0], [0, 1], [0, 0]], "has to be a matrix"),
        (MODEL.T, "three rows"),
        (MODEL.subs(angle, sp.Symbol("alpha", real=True)), "holds `alpha`"),
        (sp.zeros(3, 2), "drives ahead"),
        (MODEL.subs(rho, 2 * rho), "drives ahead"),
    ],
)
def test_tail_hints(model, hint):
    with pytest.raises(Hint, match=hint):
        angles.tail_rows(model)


def test_tail_third_row_is_none():
    with pytest.raises(Hint, match="only as the line of sight swings"):
        angles.tail_third(sp.Matrix([*MODEL.row(0), *MODEL.row(1), 0, -1]).reshape(3, 2))


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda a, b, c, v: (a / v, a - b, -c / a), "turned round"),
        (lambda a, b, c, v: (a * v, b - a, -c / a), "units"),
        (lambda a, b, c, v: (a / v, b / 2, -c / a), "look at alpha's gain"),
        (lambda a, b, c, v: (a / v, b - a, -c), "look at h"),
        (lambda a, b, c, v: (3.0, 5.0, 0.5), "units"),
    ],
)
def test_gains_hints(answer, hint):
    with pytest.raises(Hint, match=hint):
        angles.textbook_gains(answer)
