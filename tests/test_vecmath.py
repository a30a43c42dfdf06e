"""The elementary functions against mpmath, the removable singularities included."""

import math

import mpmath
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wmrlib import _vecmath

mpmath.mp.dps = 40
ULP = 2.0**-52


@given(st.floats(-50.0, 50.0))
def test_sincos(angle):
    sine, cosine = _vecmath.sincos(angle)
    assert sine == pytest.approx(float(mpmath.sin(angle)), abs=ULP)
    assert cosine == pytest.approx(float(mpmath.cos(angle)), abs=ULP)


@given(st.floats(-math.pi, math.pi) | st.floats(-1e-7, 1e-7) | st.just(0.0))
def test_sinc(angle):
    truth = float(mpmath.sin(angle) / mpmath.mpf(angle)) if angle else 1.0
    assert _vecmath.sinc(angle) == pytest.approx(truth, rel=4 * ULP, abs=ULP)


@given(st.floats(0.0, 1e3) | st.floats(0.0, 1e-6) | st.just(0.0), st.floats(0.0, 50.0) | st.just(0.0))
def test_decay(rho, k_rho):
    truth = float(-mpmath.expm1(-mpmath.mpf(k_rho) * mpmath.mpf(rho)) / mpmath.mpf(rho)) if rho else k_rho
    assert _vecmath.decay(rho, k_rho) == pytest.approx(truth, rel=8 * ULP, abs=1e-300)
