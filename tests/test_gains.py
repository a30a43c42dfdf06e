"""Gains are checked where they are made."""

import math

import numpy as np
import pytest

import wmrlib as wmr
from wmrlib.body import checked_wheels


def test_a_gain_may_be_0_and_is_a_float():
    gains = wmr.Gains(2, 1, 0)
    assert gains == (2.0, 1.0, 0.0, 4.0)
    assert {*map(type, gains)} == {float}  # numba would compile all a second time for whole numbers


def test_linear_gains_from_a_matrix():
    gains = wmr.LinearGains([[1, 2, 3], [4, 5, 6]])
    assert (gains.v_x, gains.v_heading, gains.omega_x, gains.omega_heading) == (1.0, 3.0, 4.0, 6.0)


CHECKED = [
    wmr.Gains(2.0, 1.0, 0.3, 3.0),
    wmr.KanayamaGains(1.0, 2.0, 3.0),
    wmr.LinearGains([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]),
    wmr.Pose(1.0, 2.0, 3.0),
]


@pytest.mark.parametrize("one", CHECKED, ids=lambda one: type(one).__name__)
def test_what_is_replaced_is_checked_too(one):
    for name in one._fields:
        changed = one._replace(**{name: 7})
        assert type(changed) is type(one)
        assert changed._asdict() == one._asdict() | {name: 7.0}
        assert {*map(type, changed)} == {float}
        for wrong in (math.nan, math.inf, "1", None, True):
            with pytest.raises(ValueError, match=f"{name} = {wrong!r} is not allowed"):
                one._replace(**{name: wrong})
    if not isinstance(one, wmr.Pose | wmr.LinearGains):
        with pytest.raises(ValueError, match=r"= -1\.0 is not allowed"):
            one._replace(**{one._fields[1]: -1.0})


LIMITS = wmr.Wheels
BAD = [
    (lambda: wmr.Gains(2.0, 1.0, [0.3, -0.1]), r"h = \[0\.3, -0\.1\] .* at least 0"),
    (lambda: wmr.LinearGains(np.eye(2)), r"matrix has shape \(2, 2\).*\(2, 3\) is needed"),
    (lambda: checked_wheels(LIMITS(-0.5, 1.0)), r"wheels\.track_width = -0\.5 .* above 0"),
    (lambda: checked_wheels(LIMITS(0.5, 0.0), "limits"), r"limits\.max_speed = 0\.0 .* above 0"),
    (lambda: checked_wheels(LIMITS(0.5, -math.inf)), r"wheels\.max_speed = -inf .* above 0"),
    (lambda: checked_wheels(LIMITS(np.ones(2), 2.0)), r"width = .* not an array of shape \(2,\)"),
    (lambda: checked_wheels(LIMITS(0.5, np.full(2, math.inf))), r"wheels\.max_speed = .* is not"),
]


def test_bad_input_names_argument_value_and_range():
    for make, message in BAD:
        with pytest.raises(ValueError, match=message):
            make()
