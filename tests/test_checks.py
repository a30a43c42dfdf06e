"""The checks that every public function leans on."""

import math

import numpy as np
import pytest

from wmrlib import checks


def test_real_keeps_numbers_and_shapes_and_copies_arrays():
    for value in (3, np.float32(3.0), np.array(3), 3.0):
        assert (type(checks.real("x", value)), checks.real("x", value)) == (float, 3.0)
    mine = np.array([[1, 2]])
    checked = checks.real("x", mine)
    mine[0] = 7
    assert (checked.dtype, checked.tolist()) == (np.float64, [[1.0, 2.0]])
    np.testing.assert_equal(checks.real("t", [1, math.nan], low=1.0, nan=True), [1.0, math.nan])
    for bounds in ({"low": 1.0}, {"high": 1.0}, {"above": 0.9}):  # a bound itself is allowed
        assert checks.real("x", 1.0, **bounds) == checks.real("x", [1], **bounds) == 1.0


def test_the_other_checks_say_what_is_wrong():
    ragged = [[1], [2, 3]]
    for check, message in (
        (lambda: checks.real("x", [math.nan] * 1000), r"^x = .{77}\.\.\. is not allowed"),
        (lambda: checks.real("x", [1, 10**400]), r"^x = .{77}\.\.\. .* a finite number is needed$"),
        (lambda: checks.real("x", ragged), "is needed, not rows of different lengths$"),
        (lambda: checks.scalar("dt", [0.1]), r"one number .*, not an array of shape \(1,\)"),
        (lambda: checks.scalar("dt", 0.0, above=0.0), "above 0 is needed"),
        (lambda: checks.choice("law", ["a"], "ab"), r"law = \['a'\] .* one of 'a', 'b' is needed"),
        (lambda: checks.choice("law", "c", ("a", "b")), "law = 'c' is not allowed: one of 'a'"),
        (lambda: checks.instance("n", 1.0, int), "n = 1.0 .*: an int is needed, not a float$"),
        (
            lambda: checks.same_shape(a=1.0, b=np.ones(2), c=np.ones(3)),
            r"^mismatched lengths: b has shape \(2,\), c has shape \(3,\); shapes that broadcast",
        ),
        (
            lambda: checks.same_shape(a=1.0, b=ragged),
            r"^b = \[\[1\], \[2, 3\]\] .* an array with rows of one length, is needed$",
        ),
    ):
        with pytest.raises(ValueError, match=message):
            check()
