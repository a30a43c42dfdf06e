"""What z3 proves of a Lyapunov function, and where it says that there is nothing to prove."""

import pytest
import sympy as sp

from wmrbook.chapters.strict import K2, STRICT, P, Q, counterexample, rates, slope
from wmrlib import symbolic

WINDOW = K2**2 - 16 * K2 + 4 <= 0


def test_the_function_is_strict_in_the_window_and_nowhere_else():
    falls = slope()
    assert counterexample(falls, WINDOW) is None
    for k2 in (sp.Rational(13, 64), sp.Rational(127, 500), sp.Rational(63, 4), 100):
        state = counterexample(falls.subs(K2, k2))
        assert set(state) == {P, Q}
        assert any(state.values())
        # As exact fractions, from the law itself: z3 need not be believed.
        p_rate, q_rate = (rate.subs({K2: k2, **state}) for rate in rates())
        V_rate = STRICT.diff(P).subs(state) * p_rate + STRICT.diff(Q).subs(state) * q_rate
        assert V_rate.is_Rational
        assert V_rate >= 0
    for k2 in (sp.Rational(51, 200), sp.Rational(1, 2), 2, sp.Rational(1574, 100)):
        assert counterexample(falls.subs(K2, k2)) is None
    # Near the goal the quadratic part decides: it is negative exactly in the window.
    bent = sp.hessian(falls, (P, Q)).subs({P: 0, Q: 0})
    assert sp.expand(bent.det() + 64 * WINDOW.lhs) == 0


def test_a_question_that_takes_too_long_ends_with_a_sentence(monkeypatch):
    monkeypatch.setattr("wmrbook.chapters.strict.PATIENCE", 0.2)
    falls = slope((1 + 4 * P**2 + 4 * Q**2) ** 4 - 1 + 4 * (P + Q) ** 2)
    with pytest.raises(TimeoutError, match=r"no answer within 0.2 s: neither a proof nor"):
        counterexample(falls, WINDOW)


def test_the_polynomial_is_the_laws_own_rate():
    values = {"rho": 0.7, "alpha": 0.9, "theta": -2.1, "k_rho": 1.3, "h": 1.0, "v_max": 0.8}
    clock = 0.8 * symbolic.decay(0.7, 1.3).evalf()
    at = {getattr(symbolic, name): value for name, value in values.items()}
    at[symbolic.k_alpha] = 0.6 * clock
    half = {P: sp.tan(symbolic.theta / 2), Q: sp.tan(symbolic.alpha / 2)}
    V = STRICT.subs(half)
    loop = zip(
        (symbolic.alpha, symbolic.theta), symbolic.closed_loop_rates("barrier")[1:], strict=True
    )
    rate = sum(V.diff(angle) * turning for angle, turning in loop).subs(at)
    here = {x: tangent.subs(at) for x, tangent in half.items()} | {K2: 0.6}
    wanted = rate / clock * (1 + here[Q] ** 2) ** 2
    assert float(slope().subs(here)) == pytest.approx(float(wanted), rel=1e-9)


def test_the_laws_own_function_falls_but_not_strictly():
    falls = slope(4 * P**2 + 4 * Q**2)
    assert counterexample(falls, K2 > 0, Q > 0) is None
    assert counterexample(falls, K2 > 0, Q < 0) is None
    state = counterexample(falls, K2 > 0)
    assert (state[Q], falls.subs(Q, 0)) == (0, 0)
