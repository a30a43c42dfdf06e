"""The expressions against wmrlib's compiled formulas, against the paper's equations, and the committed JavaScript against both."""

from __future__ import annotations

import math

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

import wmrlib as wmr
from wmrlib import symbolic
from wmrlib.symbolic import (
    EQUATIONS,
    L,
    alpha,
    decay,
    h,
    k_alpha,
    k_heading,
    k_rho,
    k_x,
    k_y,
    omega_ref,
    rho,
    textbook,
    theta,
    v_max,
    v_ref,
)

POSE_LAWS = ("corrected", "printed", "aicardi")
ARGUMENTS = (rho, alpha, theta, k_rho, k_alpha, h, v_max, L)
EXACT = {"rtol": 1e-12, "atol": 1e-12}


def numbers(low, high, *special):
    drawn = st.floats(low, high, allow_subnormal=False)
    return st.one_of(drawn, st.sampled_from(special)) if special else drawn


distances = numbers(0.0, 100.0, 0.0, 1e-300, 1e-12, 9.9e-9, 1.1e-8, 1e-4)
angles = numbers(-math.pi, math.pi, 0.0, 1e-300, -1e-12, 9.9e-9, -1.1e-8, math.pi / 2.0, math.pi)
gain = numbers(0.01, 5.0)
states = st.tuples(distances, angles, angles, gain, gain, gain, gain, gain)


def lambdified(*expressions):
    return sp.lambdify(ARGUMENTS, expressions, "numpy")


LAWS = {name: lambdified(*symbolic.law(name)) for name in POSE_LAWS}
LOOPS = {name: lambdified(*symbolic.closed_loop(name)) for name in POSE_LAWS}
ENERGY = lambdified(symbolic.lyapunov())
SLOPES = {name: lambdified(symbolic.lyapunov_rate(name)) for name in POSE_LAWS}
KANAYAMA = sp.lambdify(
    (rho, alpha, theta, v_ref, omega_ref, k_x, k_y, k_heading), symbolic.law("kanayama"), "numpy"
)


@pytest.mark.parametrize("name", POSE_LAWS)
@settings(deadline=None)  # the first call compiles
@given(state=states)
def test_laws_rates_and_lyapunov_functions_equal_wmrlib(name, state):
    *polar, a, b, c, d, weight = state
    gains = wmr.Gains(a, b, c, d)
    twist = wmr.control_law(*polar, gains, law=name)
    np.testing.assert_allclose(LAWS[name](*state), twist, **EXACT)
    if polar[0] > 1e-200:
        np.testing.assert_allclose(
            LOOPS[name](*state), wmr.polar_rate(polar[0], polar[1], *twist), **EXACT
        )
    np.testing.assert_allclose(ENERGY(*state)[0], wmr.lyapunov(*polar, c, weight), **EXACT)
    np.testing.assert_allclose(
        SLOPES[name](*state)[0], wmr.lyapunov_rate(*polar, gains, law=name, L=weight), **EXACT
    )


@settings(deadline=None)  # the first call compiles
@given(
    state=st.tuples(
        distances, angles, angles, numbers(-2.0, 2.0), numbers(-2.0, 2.0), gain, gain, gain
    )
)
def test_kanayama_equals_wmrlib(state):
    expected = wmr.tracking_law(*state[:5], wmr.KanayamaGains(*state[5:]), law="kanayama")
    np.testing.assert_allclose(KANAYAMA(*state), expected, **EXACT)


def test_arrays_go_through_the_singularities_without_a_warning():
    distance, angle = np.array([0.0, 1e-12, 1.0]), np.array([0.0, 1e-12, 1.0])
    for name in POSE_LAWS:
        v, omega = LAWS[name](distance, angle, 0.5, 2.0, 1.0, 0.3, 4.0, 1.0)
        expected = wmr.control_law(distance, angle, 0.5, wmr.Gains(2.0, 1.0, 0.3, 4.0), law=name)
        np.testing.assert_allclose((v, omega), expected, **EXACT)


def test_decay_is_finite_and_smooth_at_the_goal():
    assert decay(0, k_rho) == k_rho
    for order in (0, 1):
        derivative = decay(rho, k_rho).diff(rho, order) if order else decay(rho, k_rho)
        written = ((1 - sp.exp(-k_rho * rho)) / rho).diff(rho, order)
        assert sp.simplify(derivative.subs(rho, 0) - sp.limit(written, rho, 0)) == 0
        assert derivative.subs({rho: 0.7, k_rho: 2}).evalf() == pytest.approx(
            float(written.subs({rho: 0.7, k_rho: 2})), rel=1e-12
        )
    assert decay(rho, k_rho).diff(k_rho) == sp.exp(-k_rho * rho)
    tiny = sp.Float("1e-30", 40)
    assert (
        abs(decay(tiny, sp.Integer(2)).evalf(40) - 2 * (1 - tiny)) < 1e-38
    )  # digits that 1 - exp(-2e-30) has lost
    assert decay(rho, k_rho).rewrite(sp.exp) == (1 - sp.exp(-k_rho * rho)) / rho


# The paper's equations ------------------------------------------------------------------------------------------------


def same(a, b):
    return sp.expand(textbook(a) - textbook(b)) == 0


def test_every_equation_is_there_and_can_not_be_changed():
    assert list(EQUATIONS) == list(range(1, 27))
    with pytest.raises(TypeError):
        EQUATIONS[24] = EQUATIONS[22]


def test_the_model_is_equations_7_to_9():
    v, omega = symbolic.law()
    twist = {symbolic.v: v, symbolic.omega: omega}
    for number, rate in zip((7, 9, 8), symbolic.closed_loop(), strict=True):
        assert same(EQUATIONS[number].rhs.subs(twist), rate)
    assert sp.Matrix([EQUATIONS[n].rhs for n in (3, 4, 5)]) == EQUATIONS[6].rhs


def test_equation_10_contradicts_8_and_agrees_with_7_and_9():
    distance, steering, sight = EQUATIONS[10].rhs
    assert distance == EQUATIONS[7].rhs
    assert steering == EQUATIONS[9].rhs
    assert sight == -EQUATIONS[8].rhs


def test_the_laws_are_equations_22_and_24():
    v, omega = symbolic.law("printed")
    assert same(v, EQUATIONS[22].rhs)
    assert same(omega, EQUATIONS[24].rhs)
    assert not same(symbolic.law("corrected")[1], EQUATIONS[24].rhs)


def test_the_proof_up_to_21_and_with_the_corrected_law():
    polar = {EQUATIONS[n].lhs: EQUATIONS[n].rhs for n in (7, 8, 9)}
    assert same(EQUATIONS[19].rhs.subs(polar), EQUATIONS[20].rhs)
    assert same(EQUATIONS[20].rhs, EQUATIONS[21].rhs)
    v, omega = symbolic.law()
    assert same(
        EQUATIONS[21].rhs.subs({symbolic.v: v, symbolic.omega: omega}), symbolic.lyapunov_rate()
    )
    promised = (
        -rho / L * v_max * (1 - sp.exp(-k_rho * rho)) * sp.cos(alpha) ** 2 - k_alpha * alpha**2
    )
    assert same(symbolic.lyapunov_rate(), promised)
    assert same(symbolic.lyapunov(), EQUATIONS[18].rhs)


def test_25_follows_from_21_and_26_does_not_follow_from_25():
    printed = {symbolic.v: EQUATIONS[22].rhs, symbolic.omega: EQUATIONS[24].rhs}
    assert same(EQUATIONS[21].rhs.subs(printed), EQUATIONS[25].rhs)
    assert same(symbolic.lyapunov_rate("printed"), EQUATIONS[25].rhs)
    point = {rho: 0.5, alpha: 0.4, theta: -2.0, k_rho: 2, k_alpha: 1, h: 0.3, v_max: 4, L: 1}
    assert abs((EQUATIONS[25].rhs - EQUATIONS[26].rhs).subs(point)) > 0.1


def test_kanayama_falls_as_its_authors_say():
    expected = (
        -k_x * (rho * sp.cos(alpha)) ** 2 - v_ref * k_heading / k_y * sp.sin(alpha - theta) ** 2
    )
    assert sp.expand(symbolic.lyapunov_rate("kanayama") - expected) == 0
    along = symbolic.lyapunov("kanayama").subs({rho: 2, alpha: 0.3, theta: -0.4, k_y: 5})
    assert float(along) == pytest.approx(2.0 + (1.0 - math.cos(0.7)) / 5.0)


def test_near_the_goal_the_poles_are_those_of_tuning():
    s, rate = sp.Symbol("s"), v_max * k_rho
    state = sp.Matrix([rho, alpha, theta])

    def polynomial(name):
        matrix = sp.Matrix(symbolic.closed_loop(name)).jacobian(state).subs({rho: 0, theta: 0})
        return sp.expand(
            matrix.applyfunc(lambda entry: sp.limit(textbook(entry), alpha, 0))
            .charpoly(s)
            .as_expr()
        )

    assert sp.expand(polynomial("corrected") - (s + rate) * (s**2 + k_alpha * s + h * rate**2)) == 0
    assert sp.expand(polynomial("aicardi") - (s + k_rho) * (s**2 + k_alpha * s + h * k_rho**2)) == 0
    assert sp.expand(polynomial("printed") - (s + rate) * s * (s + k_alpha - rate)) == 0


def test_the_geodesy_is_equations_11_to_17():
    a, b = wmr.paper.GPS_POINT_1, wmr.paper.GPS_POINT_2
    values = {
        symbolic.lat1: math.radians(a.lat),
        symbolic.lat2: math.radians(b.lat),
        symbolic.R: wmr.EARTH_RADIUS_M,
    }
    values |= {
        symbolic.dlat: math.radians(b.lat - a.lat),
        symbolic.dlong: math.radians(b.lon - a.lon),
    }
    for number in (13, 12, 16, 17, 15):
        values[EQUATIONS[number].lhs] = float(EQUATIONS[number].rhs.subs(values))
    assert float(EQUATIONS[11].rhs.subs(values)) == pytest.approx(
        wmr.haversine_distance(a, b), rel=1e-9
    )
    assert values[symbolic.br] == pytest.approx(wmr.initial_bearing(a, b), rel=1e-9)
    sight = math.atan2(*reversed(wmr.local_position(a, b)))
    assert float(EQUATIONS[14].rhs.subs(values)) == pytest.approx(sight, abs=1e-5)


def test_wheels_are_equations_1_and_2():
    left, right, width, radius = 0.7, 1.2, 0.4, 0.1
    values = {
        symbolic.V_l: left,
        symbolic.V_r: right,
        symbolic.left_wheel: left / radius,
        symbolic.right_wheel: right / radius,
    }
    values |= {symbolic.r: radius, symbolic.b: width}
    twist = [float(EQUATIONS[number].rhs.subs(values)) for number in (1, 2)]
    assert twist == pytest.approx(wmr.wheels_to_twist(left, right, width))


@pytest.mark.parametrize(
    "function", [symbolic.law, symbolic.closed_loop, symbolic.lyapunov, symbolic.lyapunov_rate]
)
def test_an_unknown_law_is_a_value_error(function):
    with pytest.raises(
        ValueError, match=r"name = 'lqr' is not allowed: one of 'corrected', 'printed', 'aicardi'"
    ):
        function("lqr")


# Printing -------------------------------------------------------------------------------------------------------------


def test_the_committed_javascript_is_what_is_printed():
    assert symbolic.MODEL_JS.read_text(encoding="utf-8") == symbolic.javascript(), (
        "run python -m wmrlib.symbolic"
    )


def test_the_printed_circle_and_modes_are_those_of_wmrlib():
    def number(name, *values):
        arguments, expression, _ = symbolic.FORMULAS[name]
        return sp.lambdify(arguments, expression, "math")(*values)

    for time in (0.0, 3.7, 41.0):
        reference, angle = wmr.paper.circle(time), number("circle_angle", time)
        printed = [number(f"circle_{name}", angle) for name in ("x", "y", "heading")]
        assert printed == pytest.approx(reference[:3], abs=1e-12)
        assert [number("circle_speed"), number("circle_turn")] == pytest.approx(
            reference[3:], rel=1e-12
        )
    for gains in (wmr.Gains(2.0, 1.0, 0.3), wmr.Gains(0.2, 4.0, 0.1)):
        ours = wmr.modes(gains)
        assert number("mode_frequency", ours.distance_rate, gains.h) == pytest.approx(
            ours.natural_frequency
        )
        assert number("mode_damping", ours.distance_rate, gains.k_alpha, gains.h) == pytest.approx(
            ours.damping
        )
        assert number("mode_settling", ours.distance_rate, gains.k_alpha, gains.h) == pytest.approx(
            ours.heading_rate
        )


@pytest.mark.parametrize(("name", "function"), [("small_sinc", np.sinc), ("small_cos", np.cos)])
def test_the_printed_series_are_good_to_rounding(name, function):
    angles = np.linspace(1e-6, 0.1, 1001)
    expected = function(angles / np.pi) if function is np.sinc else function(angles)
    arguments, series, _ = symbolic.FORMULAS[name]
    np.testing.assert_allclose(
        sp.lambdify(arguments, series, "numpy")(angles**2), expected, rtol=4e-16
    )
