"""The checks of the Lyapunov proof: other forms of the right expressions pass, and what is no answer gets a clear hint."""

import math

import numpy as np
import pytest
import sympy as sp

import wmrlib as wmr
from wmrbook.grading import Hint, lyapunov
from wmrlib.symbolic import L, alpha, decay, h, k_alpha, k_rho, omega, rho, theta, v, v_max

V_RATE = (
    -rho * v * sp.cos(alpha) / L
    - omega * sp.sin(alpha)
    + v * sp.sin(alpha) / rho * (sp.sin(alpha) + h * sp.sin(theta))
)
TURNING = k_alpha * sp.sin(alpha) + v / rho * (sp.sin(alpha) + h * sp.sin(theta))
CLOSED = (
    -rho / L * v_max * (1 - sp.exp(-k_rho * rho)) * sp.cos(alpha) ** 2
    - k_alpha * sp.sin(alpha) ** 2
)


def test_other_forms_pass():
    for form in (
        V_RATE,
        sp.expand(V_RATE),
        sp.expand(V_RATE).rewrite(sp.exp),
        V_RATE.subs(sp.sin(alpha), sp.cos(alpha - sp.pi / 2)),
    ):
        assert lyapunov.rate(form)
    for form in (TURNING, sp.factor(TURNING), sp.expand(TURNING)):
        assert lyapunov.steering(form)
        assert lyapunov.steering_usable(form)
    steep = rho / L * v_max * (sp.exp(-k_rho * rho) - 1) * (1 - sp.sin(alpha) ** 2)
    for form in (
        CLOSED,
        steep - k_alpha * sp.sin(alpha) ** 2,
        CLOSED.subs(1 - sp.exp(-k_rho * rho), rho * decay(rho, k_rho)),
    ):
        assert lyapunov.closed(form)
    for state in ((0.1, -0.8, -1.5), np.array([0.1, -0.8, -1.5]), (sp.Rational(1, 10), -0.8, -2)):
        assert lyapunov.rising(state)
        assert lyapunov.rising_fast(state)


def test_the_bowl_falls_along_wmrlibs_robot():
    """A second method: numbers, the robot's own rates and finite differences of V."""
    bowl = sp.lambdify((rho, alpha, theta), lyapunov.BOWL.subs({L: 1, h: 2}))
    steer = sp.lambdify((rho, alpha, theta, v), TURNING.subs({k_alpha: 1.5, h: 2}))
    for state in np.random.default_rng(7).uniform([0.1, -3, -3], [3, 3, 3], (20, 3)):
        speed = math.cos(state[1])
        rates = np.array(wmr.polar_rate(*state[:2], speed, steer(*state, speed)))
        slope = (bowl(*(state + 1e-6 * rates)) - bowl(*(state - 1e-6 * rates))) / 2e-6
        assert slope == pytest.approx(
            -state[0] * speed**2 - 1.5 * math.sin(state[1]) ** 2, abs=1e-6
        )


@pytest.mark.parametrize("value", [0, sp.Integer(-1), -(alpha**2), -omega])
def test_constants_are_wrong(value):
    for check in (lyapunov.rate, lyapunov.steering, lyapunov.steering_usable, lyapunov.closed):
        with pytest.raises(Hint):
            check(value)


@pytest.mark.parametrize(
    ("value", "hint"),
    [
        (None, "no value yet"),
        (sp.Eq(omega, V_RATE), "an equation"),
        (lambda: V_RATE, "one sympy expression"),
        ("V", "one sympy expression"),
        (V_RATE.subs(v, sp.Symbol("speed")), "holds `speed`"),
        (V_RATE.subs(alpha, sp.Symbol("alpha")), "of your own"),
        (-V_RATE, "L is wrong|wrong sign"),
        (V_RATE.subs(L, 2 * L), "term with L"),
        (V_RATE + h, "term with h"),
        (V_RATE + omega, "without h and L"),
    ],
)
def test_rate_hints(value, hint):
    with pytest.raises(Hint, match=hint):
        lyapunov.rate(value)


@pytest.mark.parametrize(
    ("value", "hint"),
    [
        (TURNING.subs(k_alpha, -k_alpha), "makes V rise"),
        (TURNING.subs(v, -v), "a sign"),
        (TURNING.subs(v, v * sp.cos(alpha)), "a cosine too many"),
        (TURNING + theta, "must vanish"),
        (TURNING + k_alpha * (alpha - sp.sin(alpha)), "which function of alpha"),
        (TURNING.subs(v, v_max), "holds `v_max`"),
    ],
)
def test_steering_hints(value, hint):
    with pytest.raises(Hint, match=hint):
        lyapunov.steering(value)


@pytest.mark.parametrize(
    ("value", "hint"),
    [
        (-CLOSED, "this V would rise"),
        (CLOSED + rho * v_max, "the first bracket"),
        (CLOSED + k_alpha, "the second bracket"),
        (sp.together(sp.expand(CLOSED)), "can't be read off"),
        (sp.simplify(CLOSED), "can't be read off"),
    ],
)
def test_closed_hints(value, hint):
    with pytest.raises(Hint, match=hint):
        lyapunov.closed(value)


@pytest.mark.parametrize(
    ("state", "hint"),
    [
        (None, "no value yet"),
        (0.5, "three numbers"),
        ("abc", "three numbers"),
        ({0.5, -1.0, 0.2}, "three numbers"),
        (dict, "three numbers"),
        ((0.5, -1.0), "three numbers"),
        ((2.0, -1.0, 0.0), "within 1 m"),
        ((0.0, -1.0, 0.0), "within 1 m"),
        ((0.1, math.nan, 0.0), "not a finite number"),
        ((0.1, alpha, 0.0), "one number is needed"),
    ],
)
def test_rising_hints(state, hint):
    with pytest.raises(Hint, match=hint):
        lyapunov.rising(state)
