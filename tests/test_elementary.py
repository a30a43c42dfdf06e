"""The elementary functions against mpmath, to two units in the last place, at 0 too.

A unit is 2^-52 of the value. The laws see angles of some turns and rho up to a few hundred metres.
"""

import math
from functools import cache

import mpmath
import numba
import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from wmrlib import elementary
from wmrlib.engine import vectors

mpmath.mp.dps = 40
TWO_ULP = 2.0 * 2.0**-52
angles = st.floats(-math.pi, math.pi) | st.floats(-1e3, 1e3) | st.floats(-1e-7, 1e-7)


def near(truth):
    return pytest.approx(float(truth), rel=TWO_ULP, abs=1e-300)


@cache
def in_lanes(function):
    """The form that the engine compiles, for one number."""
    form = vectors.vectorised(function)
    return numba.njit(error_model="numpy", fastmath={"contract"})(lambda *numbers: form(*numbers))


def numpys(function):
    def of_arrays(*numbers):
        results = elementary.elementwise(function, *map(np.atleast_1d, numbers))
        return tuple(result[0] for result in results) if len(results) == 2 else results[0]

    return of_arrays


FORMS = {"alone": lambda function: function, "in lanes": in_lanes, "arrays": numpys}
forms = pytest.mark.parametrize("form", FORMS.values(), ids=FORMS)


@forms
@given(angle=angles | st.integers(-2000, 2000).map(lambda quarters: quarters * math.pi / 2))
@example(angle=0.0)
@example(angle=-0.0)
def test_sincos(form, angle):
    sine, cosine = form(elementary.sincos)(angle)
    assert sine == near(mpmath.sin(angle))
    assert cosine == near(mpmath.cos(angle))


@given(st.floats(), st.sampled_from(["sincos", "expm1", "root", "wrap", "sinc", "whole"]))
@example(math.inf, "sincos")
@example(math.inf, "wrap")
@example(1e3, "expm1")
@example(-1.0, "root")
def test_beyond_its_range_a_number_gets_what_an_entry_of_an_array_gets(number, name):
    """And what compiled code answers, so that a run in plain Python ends as a compiled one does."""
    function = getattr(elementary, name)
    with np.errstate(all="ignore"):
        alone, entry = function(number), numpys(function)(number)
    assert alone == pytest.approx(entry, rel=TWO_ULP, abs=0.0, nan_ok=True)


@forms
@given(angle=angles)
@example(angle=0.0)
@example(angle=1e-8)
@example(angle=-1.0000001e-8)
@example(angle=5e-324)
def test_sinc(form, angle):
    truth = mpmath.sin(angle) / mpmath.mpf(angle) if angle else 1.0
    assert form(elementary.sinc)(angle) == near(truth)


@forms
@given(x=st.floats(-800.0, 1.0) | st.floats(-1e-6, 1e-6) | st.floats(-2.0, 0.0))
@example(x=0.0)
def test_expm1(form, x):
    assert form(elementary.expm1)(x) == near(mpmath.expm1(mpmath.mpf(x)))


past_the_goal = st.floats(-0.1, 0.0)  # where a step may carry rho


@forms
@given(
    rho=st.floats(0.0, 1e3) | st.floats(0.0, 1e-6) | past_the_goal,
    k_rho=st.floats(0.0, 50.0) | st.floats(0.0, 1e-6),
)
@example(rho=0.0, k_rho=0.0)
@example(rho=0.0, k_rho=2.0)
@example(rho=1e-8, k_rho=1.0)
@example(rho=5e-324, k_rho=50.0)
@example(rho=1e3, k_rho=50.0)
@example(rho=-0.095703125, k_rho=43.9461639526886)
def test_decay(form, rho, k_rho):
    truth = -mpmath.expm1(-mpmath.mpf(k_rho) * mpmath.mpf(rho)) / mpmath.mpf(rho) if rho else k_rho
    # The rounding of k_rho rho, half a unit, is made larger by as much as exp grows.
    accuracy = TWO_ULP * (1.0 + max(0.0, -k_rho * rho))
    value = form(elementary.decay)(rho, k_rho)
    assert value == pytest.approx(float(truth), rel=accuracy, abs=1e-300)


lengths = st.floats(-1e3, 1e3) | st.floats(-1e150, 1e150) | st.floats(-1e-100, 1e-100)


@forms
@given(y=lengths, x=lengths)
@example(y=1.0, x=1.0)
@example(y=math.sqrt(2.0) - 1.0, x=1.0)  # where the direction is first turned back by pi/4
@example(y=5e-324, x=-5e-324)
@example(y=1e150, x=1e-200)
def test_direction_and_distance(form, y, x):
    truth = mpmath.atan2(y, x) if y or x > 0.0 else math.atan2(y, x)  # mpmath knows no -0
    assert form(elementary.direction)(y, x) == near(truth)
    away, truth = form(elementary.distance)(x, y), mpmath.hypot(x, y)
    assert away == near(truth) or max(away, truth) < vectors.NEAREST


@given(angles | st.floats(-1e6, 1e6) | st.integers(-300_000, 300_000).map(lambda n: n * math.pi))
@example(math.pi)
@example(-math.pi)
@example(np.nextafter(math.pi, 4.0))
@example(np.nextafter(-math.pi, -4.0))
@example(1e6)
@example(3.0 * math.pi)  # of which a full turn leaves half a turn, to the last digit
def test_wrap_is_exact(angle):
    turns = mpmath.ceil((mpmath.mpf(angle) - math.pi) / mpmath.mpf(2.0 * math.pi))
    truth = float(mpmath.mpf(angle) - turns * mpmath.mpf(2.0 * math.pi))
    assert elementary.wrap(angle) == vectors.vector_wrap(angle) == truth
    if abs(angle) <= 2.0 * math.pi:
        assert vectors.vector_wrap_once(angle) == truth
