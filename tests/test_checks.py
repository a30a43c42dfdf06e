"""The checks that every public function leans on."""

import math

import numpy as np
import pytest

from wmrlib import _checks


def test_real_keeps_numbers_and_shapes():
    assert _checks.real("x", 3) == 3.0
    assert type(_checks.real("x", np.float32(0.5))) is float
    assert _checks.real("x", [[1, 2]]).tolist() == [[1.0, 2.0]]
    assert _checks.real("x", np.array(2)) == 2.0


def test_an_array_is_copied_so_that_the_callers_later_changes_do_not_reach_us():
    mine = np.array([1.0, 2.0])
    checked = _checks.real("x", mine)
    mine[0] = math.nan
    assert checked[0] == 1.0


@pytest.mark.parametrize(
    "value",
    [
        math.nan,
        math.inf,
        -math.inf,
        "1",
        None,
        True,
        1j,
        [1.0, math.nan],
        [None],
        object(),
        [[1], [2, 3]],
        {},
    ],
)
def test_real_refuses_what_is_no_finite_number(value):
    with pytest.raises(ValueError, match=r"^x = .* is not allowed: a finite number is needed$"):
        _checks.real("x", value)


def test_nan_is_allowed_only_where_it_is_asked_for():
    found = _checks.real("t", [1, math.nan], low=0.0, above=-1.0, nan=True)
    assert found.tolist() == [1.0, pytest.approx(math.nan, nan_ok=True)]
    assert math.isnan(_checks.real("t", math.nan, nan=True))
    for value in (math.inf, [math.nan, -1.0], ["a"], [True, False], [[math.nan], [1, 2]], None):
        with pytest.raises(
            ValueError,
            match=r"^t = .* is not allowed: a finite number at least 0 or NaN is needed$",
        ):
            _checks.real("t", value, low=0.0, nan=True)


@pytest.mark.parametrize(
    ("bounds", "value", "words"),
    [
        ({"low": 0.0}, -0.1, "at least 0"),
        ({"high": 90.0}, 90.1, "at most 90"),
        ({"above": 0.0}, 0.0, "above 0"),
        ({"low": -1.0, "high": 1.0}, [0.0, 2.0], "at least -1 and at most 1"),
    ],
)
def test_bounds_are_named(bounds, value, words):
    with pytest.raises(ValueError, match=f"a finite number {words} is needed"):
        _checks.real("x", value, **bounds)
    _checks.real(
        "x", bounds.get("low", bounds.get("high", 1.0)), **bounds
    )  # the bound itself is allowed, but for `above`


def test_long_values_are_cut_in_messages():
    with pytest.raises(ValueError, match=r"\.\.\. is not allowed") as raised:
        _checks.real("x", [math.nan] * 1000)
    assert len(str(raised.value)) < 160


def test_scalar_choice_and_instance():
    with pytest.raises(ValueError, match=r"one number is needed, not an array of shape \(2,\)"):
        _checks.scalar("dt", [0.1, 0.2])
    with pytest.raises(
        ValueError, match=r"law = \['a'\] is not allowed: one of 'a', 'b' is needed"
    ):
        _checks.choice("law", ["a"], ("a", "b"))
    with pytest.raises(ValueError, match=r"n = 1\.0 is not allowed: a int is needed, not a float"):
        _checks.instance("n", 1.0, int)


def test_same_shape_names_each_shape():
    assert _checks.same_shape(a=1.0, b=np.ones((3, 1)), c=np.ones(2)) == (3, 2)
    with pytest.raises(
        ValueError,
        match=r"mismatched lengths: b has shape \(2,\), c has shape \(3,\); shapes that broadcast",
    ):
        _checks.same_shape(a=1.0, b=np.ones(2), c=np.ones(3))


def test_same_shape_names_what_has_no_shape():
    with pytest.raises(
        ValueError,
        match=r"^b = \[\[1\], \[2, 3\]\] is not allowed: a number, or an array with rows of one length, is needed$",
    ):
        _checks.same_shape(a=1.0, b=[[1], [2, 3]])
