"""Gains are checked where they are made."""

import math

import numpy as np
import pytest

import wmrlib as wmr
from wmrlib.gains import checked_wheels


def test_fields_defaults_and_floats():
    gains = wmr.Gains(2, 1, 0.3)
    assert gains == (2.0, 1.0, 0.3, 4.0)
    assert {type(field) for field in gains} == {float}  # whole numbers would make numba compile everything a second time


def test_zero_shows_what_a_gain_does():
    assert wmr.Gains(0, 0, 0).h == 0.0


def test_linear_gains_from_a_matrix():
    gains = wmr.LinearGains([[1, 2, 3], [4, 5, 6]])
    assert (gains.v_x, gains.v_heading, gains.omega_x, gains.omega_heading) == (1.0, 3.0, 4.0, 6.0)


def test_no_wheel_limits_never_bind():
    assert checked_wheels(None).max_speed == math.inf


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: wmr.Gains(-2.0, 1.0, 0.3), r"k_rho = -2\.0 is not allowed: a finite number at least 0 is needed"),
        (lambda: wmr.Gains(2.0, math.nan, 0.3), r"k_alpha = nan"),
        (lambda: wmr.Gains(2.0, 1.0, [0.3, -0.1]), r"h = \[0\.3, -0\.1\] .* at least 0"),
        (lambda: wmr.Gains(2.0, 1.0, 0.3, v_max=0.0), r"v_max = 0\.0 is not allowed: a finite number above 0 is needed"),
        (lambda: wmr.Gains(np.ones(2), np.ones(3), 1.0), r"mismatched lengths: k_rho has shape \(2,\), k_alpha has shape \(3,\)"),
        (lambda: wmr.KanayamaGains(1.0, 0.0, 1.0), r"k_y = 0\.0 .* above 0"),
        (lambda: wmr.LinearGains([[1.0, 2.0], [3.0, 4.0]]), r"matrix has shape \(2, 2\).*\(2, 3\) is needed"),
        (lambda: checked_wheels(wmr.WheelLimits(-0.5, 1.0)), r"track_width = -0\.5 .* above 0"),
        (lambda: checked_wheels(wmr.WheelLimits(0.5, 0.0)), r"max_speed = 0\.0 .* above 0"),
        (lambda: checked_wheels(2.0), r"limits = 2\.0 .* a WheelLimits is needed, not a float"),
    ],
)
def test_bad_input_names_argument_value_and_range(make, message):
    with pytest.raises(ValueError, match=message):
        make()
