"""Chapter 13: whether V is strict under the barrier law, which z3 decides for every state."""

from __future__ import annotations

import sympy as sp

from wmrbook.chapters.strict import K2, STRICT, P, Q, slope
from wmrbook.live.parts import Asks, Knob, Live


def _terms(polynomial: sp.Expr) -> list[list[int]]:
    """Its terms: the powers of P, Q and K2, and the factor."""
    terms = sp.Poly(polynomial, P, Q, K2).terms()
    return [[*powers, int(factor)] for powers, factor in terms]


def strict() -> Live:
    """Where V rises among the states drawn, and z3's word on all of them."""
    return Live(
        "strict",
        "With {k2}, V rises in {cells} cells drawn. Does it fall at every state?",
        {"k2": Knob(0.25, 0.05, 50.0, None, "the steering gain, scaled: k2", "", "k_2")},
        # Near enough that k2 stays what it is.
        data={"rho": 0.001, "state": [0.25, 0.25], "V": _terms(STRICT), "slope": _terms(slope())},
        asks=Asks("Prove it", "wmrbook.chapters.strict.answer", ("k2",)),
    )
