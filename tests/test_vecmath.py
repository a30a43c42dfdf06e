"""The elementary functions against mpmath, to two units in the last place, the removable singularities included.

A unit is 2^-52 of the value. The laws see angles of some turns and rho up to a few hundred metres.
"""

import math

import mpmath
import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from wmrlib import _vecmath
from wmrlib._compile import compiled

mpmath.mp.dps = 40
TWO_ULP = 2.0 * 2.0**-52
angles = st.floats(-math.pi, math.pi) | st.floats(-1e3, 1e3) | st.floats(-1e-7, 1e-7)


def near(truth):
    return pytest.approx(float(truth), rel=TWO_ULP, abs=1e-300)


@given(angles | st.integers(-2000, 2000).map(lambda quarters: quarters * math.pi / 2))
@example(0.0)
@example(-0.0)
def test_sincos(angle):
    sine, cosine = _vecmath.sincos(angle)
    assert sine == near(mpmath.sin(angle))
    assert cosine == near(mpmath.cos(angle))


@pytest.mark.parametrize("angle", [1e6, -999_999.25, 636_619 * math.pi / 2])
def test_sincos_up_to_a_million_radians(angle):
    assert _vecmath.sincos(angle) == (near(mpmath.sin(angle)), near(mpmath.cos(angle)))


@pytest.mark.parametrize("angle", [1.1e6, -1e300, math.inf, -math.inf, math.nan])
def test_a_direction_that_is_lost_is_not_a_number(angle):
    assert np.isnan([*_vecmath.sincos(angle), _vecmath.sinc(angle)]).all()


@given(angles)
@example(0.0)
@example(1e-8)
@example(-1.0000001e-8)
@example(5e-324)
def test_sinc(angle):
    assert _vecmath.sinc(angle) == near(mpmath.sin(angle) / mpmath.mpf(angle) if angle else 1.0)


@given(st.floats(-800.0, 1.0) | st.floats(-1e-6, 1e-6) | st.floats(-2.0, 0.0))
@example(0.0)
def test_expm1(x):
    assert _vecmath.expm1(x) == near(mpmath.expm1(mpmath.mpf(x)))


@given(
    st.floats(0.0, 1e3) | st.floats(0.0, 1e-6) | st.floats(-0.1, 0.0),  # a step may carry rho past the goal
    st.floats(0.0, 50.0) | st.floats(0.0, 1e-6),
)
@example(0.0, 0.0)
@example(0.0, 2.0)
@example(1e-8, 1.0)
@example(5e-324, 50.0)
@example(1e3, 50.0)
def test_decay(rho, k_rho):
    truth = -mpmath.expm1(-mpmath.mpf(k_rho) * mpmath.mpf(rho)) / mpmath.mpf(rho) if rho else k_rho
    assert _vecmath.decay(rho, k_rho) == near(truth)


def test_not_a_number_stays_one():
    assert np.isnan([_vecmath.expm1(math.nan), _vecmath.decay(math.nan, 1.0), _vecmath.decay(1.0, math.nan)]).all()


def test_a_loop_over_many_gives_the_same_to_the_last_digits():
    """In a loop LLVM computes several at once; what it then does in another order must not show."""

    @compiled
    def all_of(angle, sine, cosine, ratio, grown):
        for i in range(angle.size):
            sine[i], cosine[i] = _vecmath.sincos(angle[i])
            ratio[i], grown[i] = _vecmath.sinc(angle[i]), _vecmath.expm1(-abs(angle[i]))

    angle = np.linspace(-50.0, 50.0, 1001)
    results = np.empty((4, angle.size))
    all_of(angle, *results)
    for i, each in enumerate(angle):
        alone = (*_vecmath.sincos(each), _vecmath.sinc(each), _vecmath.expm1(-abs(each)))
        assert tuple(results[:, i]) == pytest.approx(alone, rel=TWO_ULP)
