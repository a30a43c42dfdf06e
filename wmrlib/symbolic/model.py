"""The formulas of `laws`, `motion` and `geodesy` as sympy expressions."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import sympy as sp
from sympy.codegen.cfunctions import expm1

from wmrlib import elementary, laws, motion
from wmrlib.checks import choice
from wmrlib.symbolic import symbols as s

LAWS = tuple(laws.LAWS)


@elementary.sincos.register(sp.Expr)
def _(angle):
    angle = angle.args[0] if isinstance(angle, s.wrap) else angle
    return sp.sin(angle), sp.cos(angle)


for _function, _symbols in {
    elementary.sinc: sp.sinc,
    elementary.decay: s.decay,
    elementary.wrap: s.wrap,
    elementary.root: sp.sqrt,
    elementary.expm1: expm1,
    elementary.whole: lambda x: sp.floor(x + sp.S.Half),
    elementary.between: lambda x, low, high: sp.Piecewise(
        (low, x < low), (high, x > high), (x, True)
    ),
    elementary.signed: lambda size, like: sp.Piecewise((-size, like < 0), (size, True)),
    elementary.stepped: lambda x, step: sp.Piecewise(
        (step * sp.floor(x / step + sp.S.Half), step > 0), (x, True)
    ),
    elementary.within: lambda x, limit, other: sp.Piecewise((x, abs(x) < limit), (other, True)),
    elementary.direction: sp.atan2,
    elementary.distance: lambda x, y: sp.sqrt(x**2 + y**2),
}.items():
    _function.register(sp.Expr, _symbols)


def read(function: Callable, *arguments: Any) -> tuple[sp.Expr, ...]:
    """The expressions that a formula returns for symbols, as a tuple."""
    value = function(*arguments)
    return tuple(map(exact, value if isinstance(value, tuple) else (value,)))


def exact(expression: sp.Expr) -> sp.Expr:
    """The expression with short fractions in place of floats such as 0.5."""
    expression = sp.sympify(expression)
    fractions = {number: sp.Rational(repr(float(number))) for number in expression.atoms(sp.Float)}
    return expression.xreplace({number: f for number, f in fractions.items() if f.q < 1000})


def gains_of(name: str) -> SimpleNamespace:
    """The gains of a law, each field a symbol."""
    fields = laws.LAWS[name].gains._fields
    return SimpleNamespace(**{f: vars(s).get(f, sp.Symbol(f, real=True)) for f in fields})


def steering(name: str) -> tuple[sp.Expr, sp.Expr]:
    """The result of a law's formula: (v/rho, omega), or (v, omega) if it needs a reference."""
    state = s.STATE
    if laws.LAWS[name].needs_reference:
        state = *read(laws.body_error, *s.STATE), s.v_ref, s.omega_ref
    return read(laws.LAWS[name].formula, *state, gains_of(name))


def law(name: str = "corrected") -> tuple[sp.Expr, sp.Expr]:
    """The twist that a law commands; finite at rho = 0 and at alpha = 0.

    Parameters
    ----------
    name : one of `LAWS`

    Returns
    -------
    v, omega : expressions, m/s, rad/s; by ``sympy.lambdify`` they equal `wmrlib.control_law`

    Raises
    ------
    ValueError : for another name.
    """
    speed, turning = steering(choice("name", name, LAWS))
    return (speed if laws.LAWS[name].needs_reference else speed * s.rho), turning


def closed_loop_rates(name: str = "corrected") -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """The rates (7) to (9) of the polar error under a pose law, smooth through the goal.

    Parameters
    ----------
    name : "corrected", "printed", "aicardi" or another law for a goal that stands still

    Returns
    -------
    rho', alpha', theta' : expressions; m/s, rad/s, rad/s

    Raises
    ------
    ValueError : for another name.
    """
    twist = steering(choice("name", name, laws.POSE_LAWS))
    return read(motion.polar_closing_rate, s.rho, s.alpha, *twist)


def lyapunov(name: str = "corrected") -> sp.Expr:
    """The Lyapunov function of a law: V of (18), or its own.

    Parameters
    ----------
    name : one of `LAWS`

    Returns
    -------
    V : expression in rho, alpha, theta, L and the law's gains

    Raises
    ------
    ValueError : for another name.
    """
    row = laws.LAWS[choice("name", name, LAWS)]
    if row.value is laws.pose_value:
        return read(laws.lyapunov_value, *s.STATE, s.h, s.L)[0]
    return read(row.value, *s.STATE, gains_of(name))[0]


def lyapunov_rate(name: str = "corrected") -> sp.Expr:
    """V' of (19) along the closed loop: the gradient of V times the rates.

    `sympy.expand` after `textbook` gives it as in `wmrlib.lyapunov_rate`. If the law needs a
    reference the rates are those of the error in the robot's frame.

    Parameters
    ----------
    name : one of `LAWS`

    Returns
    -------
    V' : expression, 1/s

    Raises
    ------
    ValueError : for another name.
    """
    energy, (speed, turning) = lyapunov(name), law(name)
    if not laws.LAWS[name].needs_reference:
        rates = zip(s.STATE, closed_loop_rates(name), strict=True)
        return sum(energy.diff(error) * rate for error, rate in rates)
    ahead, left, turn = s.rho * sp.cos(s.alpha), s.rho * sp.sin(s.alpha), s.alpha - s.theta
    body_rates = {
        s.ahead: turning * left - speed + s.v_ref * sp.cos(turn),
        s.left: s.v_ref * sp.sin(turn) - turning * ahead,
        s.turn: s.omega_ref - turning,
    }
    body = {s.ahead: ahead, s.left: left, s.turn: turn}
    energy = energy.subs({s.rho: sp.sqrt(s.ahead**2 + s.left**2), s.alpha: s.theta + s.turn})
    return sum(energy.diff(error).subs(body) * rate for error, rate in body_rates.items())
