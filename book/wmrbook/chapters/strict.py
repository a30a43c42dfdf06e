"""Is a Lyapunov function strict? z3 proves it for every state, or names one where it is not.

z3 decides polynomial inequalities over the real numbers, and with half-angle tangents the barrier
law makes V' a polynomial.
"""

from __future__ import annotations

import math
import operator
from fractions import Fraction

import sympy as sp

from wmrlib import symbolic

P, Q, K2 = sp.symbols("p q k2", real=True)
"""tan(theta/2), tan(alpha/2) and k_alpha/(v_max decay(rho, k_rho))."""
STRICT = (1 + 4 * P**2 + 4 * Q**2) ** 3 - 1 + (2 * P + 2 * Q) ** 2
"""V of (13.4)."""
PATIENCE = 60.0  # s; the theorem takes about two where nothing else runs
_COMPARED = {"<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge}


def rates() -> tuple[sp.Expr, sp.Expr]:
    """Return p' and q' with h = 1, in a time that runs v_max decay(rho, k_rho) times as fast."""
    _, alpha_rate, theta_rate = symbolic.closed_loop_rates("barrier")
    clock = symbolic.v_max * symbolic.decay(symbolic.rho, symbolic.k_rho)
    scaled = {symbolic.h: 1, symbolic.k_alpha: K2 * clock}
    half = {symbolic.theta: 2 * sp.atan(P), symbolic.alpha: 2 * sp.atan(Q)}

    def of(tangent: sp.Symbol, rate: sp.Expr) -> sp.Expr:
        turning = sp.expand_trig(sp.cancel(rate.subs(scaled) / clock).subs(half))
        return sp.factor(turning * (1 + tangent**2) / 2)

    return of(P, theta_rate), of(Q, alpha_rate)


def slope(function: sp.Expr = STRICT) -> sp.Expr:
    """Return V' (1 + q^2)^2, a polynomial with the sign of V', of a function of p and q.

    Raises sympy's PolynomialError for a function of which it is none.
    """
    falling = sum(function.diff(x) * rate for x, rate in zip((P, Q), rates(), strict=True))
    return sp.Poly(sp.cancel(falling * (1 + Q**2) ** 2), P, Q, K2).as_expr()


def counterexample(polynomial: sp.Expr, *given: sp.Rel) -> dict[sp.Symbol, sp.Rational] | None:
    """Return a state other than the goal where a polynomial is not negative.

    polynomial: in P, Q and K2, with rational coefficients; `given`: inequalities that the state
    meets too. None says that there is no such state: z3 has proved the polynomial negative.
    Raises TimeoutError if z3 decides neither within PATIENCE.
    """
    import z3

    names = {symbol: z3.Real(symbol.name) for symbol in (P, Q, K2)}

    def in_z3(expression: sp.Expr) -> z3.ArithRef:
        terms = sp.Poly(expression, *names, domain="QQ").terms()
        return z3.Sum([z3.Q(factor.p, factor.q) * product(powers) for powers, factor in terms])

    def product(powers: tuple[int, ...]) -> z3.ArithRef:
        return math.prod([x**n for x, n in zip(names.values(), powers, strict=True) if n])

    solver = z3.Tactic("qfnra-nlsat").solver()
    solver.set("timeout", round(1000 * PATIENCE))
    solver.add(in_z3(polynomial) >= 0, z3.Or(names[P] != 0, names[Q] != 0))
    solver.add(*(_COMPARED[term.rel_op](in_z3(term.lhs - term.rhs), 0) for term in given))
    answer = solver.check()
    if answer == z3.unknown:
        raise TimeoutError(
            f"z3 found no answer within {PATIENCE:g} s: neither a proof nor a counterexample. "
            "It may find one for a single value of k2"
        )
    if answer == z3.unsat:
        return None
    model, asked = (
        solver.model(),
        polynomial.free_symbols.union(*(term.free_symbols for term in given)),
    )
    values = {x: model.eval(names[x], model_completion=True) for x in names if x in asked}
    return {x: sp.Rational(Fraction(value.as_fraction())) for x, value in values.items()}
