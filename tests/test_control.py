"""The laws in 40 digits, and V' against its closed form."""

import math

import mpmath
import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st
from oracle import commanded

import wmrlib as wmr
from wmrlib import laws, symbolic
from wmrlib.laws import POSE_LAWS
from wmrlib.symbolic import symbols as s

mpmath.mp.dps = 40
angles = st.floats(-math.pi, math.pi, exclude_min=True) | st.just(0.0) | st.floats(-1e-9, 1e-9)
distances = st.floats(0.0, 100.0) | st.just(0.0) | st.floats(0.0, 1e-9)
positive = st.floats(0.01, 10.0)
gains_drawn = st.builds(wmr.Gains, positive, positive, positive, positive)
LAWS = ("corrected", "printed", "aicardi")


def law_in_40_digits(rho, alpha, theta, gains, law):
    rho, alpha, theta, k_rho, k_alpha, h, v_max = map(mpmath.mpf, (rho, alpha, theta, *gains))
    shape = mpmath.sin(alpha) / alpha if alpha else mpmath.mpf(1)
    if law == "aicardi":
        v = k_rho * rho * mpmath.cos(alpha)
        return v, k_alpha * alpha + k_rho * mpmath.cos(alpha) * shape * (alpha + h * theta)
    v = v_max * -mpmath.expm1(-k_rho * rho) * mpmath.cos(alpha)
    ratio = v / rho if rho else v_max * k_rho * mpmath.cos(alpha)
    twice = mpmath.cos(alpha) * mpmath.sin(alpha) if law == "printed" else 1
    return v, k_alpha * alpha + ratio * twice * shape * (alpha + h * theta)


@given(law=st.sampled_from(LAWS), rho=distances, alpha=angles, theta=angles, gains=gains_drawn)
def test_laws_are_the_formulas_and_finite(law, rho, alpha, theta, gains):
    v, omega = wmr.control_law(rho, alpha, theta, gains, law)
    v_true, omega_true = law_in_40_digits(rho, alpha, theta, gains, law)
    scale = 1e-14 * (1 + gains.v_max) * (1 + gains.k_rho) * (1 + abs(gains.h))
    assert v == pytest.approx(float(v_true), rel=1e-13, abs=scale)
    assert omega == pytest.approx(float(omega_true), rel=1e-13, abs=10 * scale)


@pytest.mark.parametrize(
    ("goal", "curvature"),  # of Nav2's own test, with k_phi = 1 and k_delta = 10
    [(wmr.Pose(0.0, 5.0, 0.0), 5.407042), (wmr.Pose(4.5, -2.17, -0.785), -0.416228)],
)
def test_the_graceful_law_is_that_of_nav2(goal, curvature):
    polar = wmr.polar_error(wmr.Pose(0.0, 0.0, 0.0), goal)
    v, omega = wmr.control_law(*polar, wmr.Gains(0.7, 10.0, 1.0), "graceful")
    assert omega / v == pytest.approx(curvature, abs=1e-4)


@given(st.floats(0.1, 50.0), angles, angles, gains_drawn)
def test_the_graceful_law_brings_alpha_back_to_its_path(rho, alpha, theta, gains):
    """Z = alpha + atan(k_phi theta) falls as z' = -k_delta (v/rho) z, wherever the robot looks."""
    v, omega = wmr.control_law(rho, alpha, theta, gains, "graceful")
    _, alpha_rate, theta_rate = wmr.polar_rate(rho, alpha, v, omega)
    z = alpha + math.atan(gains.h * theta)
    z_rate = alpha_rate + gains.h * theta_rate / (1.0 + (gains.h * theta) ** 2)
    assert z_rate == pytest.approx(-gains.k_alpha * v / rho * z, rel=1e-9, abs=1e-9 * (1 + abs(v)))


@given(st.floats(0.1, 50.0), st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), gains_drawn)
def test_the_barrier_law_lets_its_angles_fall(rho, alpha, theta, gains):
    """Of V, 2 (tan(alpha/2)^2 + h tan(theta/2)^2) falls by k_alpha (2 tan(alpha/2))^2."""
    v, omega = wmr.control_law(rho, alpha, theta, gains, "barrier")
    rates = wmr.polar_rate(rho, alpha, v, omega)
    tan_a, tan_t = math.tan(alpha / 2), math.tan(theta / 2)
    terms = 2 * tan_a * (1 + tan_a**2) * rates[1], 2 * gains.h * tan_t * (1 + tan_t**2) * rates[2]
    size = 1e-12 * (1 + abs(terms[0]) + abs(terms[1]))
    assert sum(terms) == pytest.approx(-gains.k_alpha * (2 * tan_a) ** 2, rel=1e-9, abs=size)
    value = laws.LAWS["barrier"].value(rho, alpha, theta, gains)
    assert value == pytest.approx(rho**2 / 2 + 2 * (tan_a**2 + gains.h * tan_t**2), rel=1e-12)


# Lyapunov


@given(distances, angles, angles, gains_drawn, positive)
def test_rate_of_the_corrected_law_is_its_closed_form(rho, alpha, theta, gains, L):
    rate = wmr.lyapunov_rate(rho, alpha, theta, gains, "corrected", L)
    speed = -gains.v_max * math.expm1(-gains.k_rho * rho)
    closed = -rho / L * speed * math.cos(alpha) ** 2 - gains.k_alpha * alpha**2
    # the terms in theta cancel: what is left of them is rounding
    turning = gains.v_max * gains.k_rho * (1 + gains.h) * 40
    assert rate == pytest.approx(closed, rel=1e-12, abs=1e-15 * turning)
    assert closed <= 0.0


# Moving references


def test_kanayama_falls_as_its_authors_say():
    """V = (e_x^2 + e_y^2)/2 + (1 - cos(e_h))/k_y, along the error's own rates."""
    ahead, turn = s.rho * sp.cos(s.alpha), s.alpha - s.theta
    expected = -s.k_x * ahead**2 - s.v_ref * s.k_heading / s.k_y * sp.sin(turn) ** 2
    assert sp.expand(symbolic.lyapunov_rate("kanayama") - expected) == 0
    along = symbolic.lyapunov("kanayama").subs({s.rho: 2, s.alpha: 0.3, s.theta: -0.4, s.k_y: 5})
    assert float(along) == pytest.approx(2.0 + (1.0 - math.cos(0.7)) / 5.0)


# Wheels


@given(st.floats(-5, 5), st.floats(-5, 5), st.floats(0.1, 2.0), st.floats(0.1, 5.0))
def test_wheel_limits_keep_the_curvature(v, omega, width, fastest):
    limited = wmr.limit_wheels(v, omega, wmr.Wheels(width, fastest))
    before, after = wmr.twist_to_wheels(v, omega, width), wmr.twist_to_wheels(*limited, width)
    assert max(map(abs, after)) <= fastest * (1 + 1e-12)
    assert limited[0] * omega == pytest.approx(limited[1] * v, abs=1e-12)  # the same curvature
    assert limited[0] * v >= 0
    if max(map(abs, before)) <= fastest:
        assert limited == (v, omega)
    else:
        assert max(map(abs, after)) == pytest.approx(fastest)


# Shapes and bad input


def test_arrays_and_arrays_of_gains_broadcast():
    rho, alpha, theta = np.linspace(0, 5, 4)[:, None], np.linspace(-3, 3, 5), 0.4
    gains = wmr.Gains(np.array([1.0, 2.0])[:, None, None], 1.0, 0.3)
    one = float(rho[3, 0]), float(alpha[1]), theta, wmr.Gains(2.0, 1.0, 0.3)
    for law in LAWS:
        v, omega = wmr.control_law(rho, alpha, theta, gains, law)
        assert v.shape == omega.shape == (2, 4, 5)
        assert (v[1, 3, 1], omega[1, 3, 1]) == wmr.control_law(*one, law)
        rate = wmr.lyapunov_rate(rho, alpha, theta, gains, law)
        assert rate.shape == (2, 4, 5)
        assert rate[1, 3, 1] == wmr.lyapunov_rate(*one, law)


def test_a_law_for_a_moving_goal_is_no_pose_law():
    allowed = rf"law = 'linear' .* one of {str(tuple(POSE_LAWS))[1:-1]} is needed"
    with pytest.raises(ValueError, match=allowed):
        wmr.control_law(1.0, 0.0, 0.0, wmr.paper.OUTDOOR_GAINS, "linear")


def test_laws_for_a_moving_goal_know_angles_up_to_full_turns_and_their_v():
    linear = wmr.LinearGains([[1.0, 0.0, 0.3], [0.0, 2.0, 1.5]])
    kanayama = wmr.KanayamaGains(1.0, 2.0, 2.0)
    for law, gains in (("linear", linear), ("kanayama", kanayama)):
        once = commanded(0.7, 3.0, -3.0, 0.6, 0.1, gains, law)
        turned = commanded(0.7, 3.0 - 2.0 * math.pi, -3.0, 0.6, 0.1, gains, law)
        assert turned == pytest.approx(once, abs=1e-12)
    run = wmr.track(wmr.paper.circle, wmr.paper.CIRCLE_START, kanayama, law="kanayama")
    value = 0.5 * run.rho**2 + (1.0 - np.cos(run.alpha - run.theta)) / kanayama.k_y
    assert pytest.approx(value, abs=1e-12) == run.V
