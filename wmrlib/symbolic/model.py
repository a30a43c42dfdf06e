"""What the functions of `laws`, `motion`, `geodesy` and `paper` return for symbols."""

from __future__ import annotations

import math
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import sympy as sp

from wmrlib import _checks, _vecmath, geodesy, laws, motion
from wmrlib._checks import choice
from wmrlib.symbolic import symbols
from wmrlib.symbolic.symbols import (
    L,
    ahead,
    alpha,
    decay,
    h,
    left,
    omega_ref,
    rho,
    theta,
    turn,
    v_ref,
    wrap,
)

LAWS = tuple(laws.LAWS)


def _sincos(angle: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    angle = angle.args[0] if isinstance(angle, wrap) else angle
    return sp.sin(angle), sp.cos(angle)


_LIBRARY = SimpleNamespace(
    **(vars(sp) | {"arctan2": sp.atan2, "mod": lambda x, turn: x, "where": lambda test, x, y: x})
)
_SYMBOLIC = {
    math: _LIBRARY,
    np: _LIBRARY,
    _vecmath.sincos: _sincos,
    _vecmath.sinc: sp.sinc,
    _vecmath.decay: decay,
    motion.wrap: wrap,
    _checks.real: lambda name, value, **bounds: value,
    _checks.reals: lambda above_0, **values: values.values(),
    geodesy._radians: lambda a, b: (a[0], b[0], b[1], b[2]),
    geodesy._number: lambda value: value,
}


def read(function: Callable, *arguments: Any) -> tuple[sp.Expr, ...]:
    """What a function of numbers returns for symbols: it runs with sympy's functions inside."""
    value = _vecmath.rebuilt(function, dict(_SYMBOLIC))(*arguments)
    return tuple(map(_exact, value if isinstance(value, tuple) else (value,)))


def _exact(expression: sp.Expr) -> sp.Expr:
    """With fractions in the places of floats that are short ones, such as 0.5."""
    expression = sp.sympify(expression)
    fractions = {each: sp.Rational(repr(float(each))) for each in expression.atoms(sp.Float)}
    return expression.xreplace({each: f for each, f in fractions.items() if f.q < 1000})


def gains_of(name: str) -> SimpleNamespace:
    """The gains of a law, each field a symbol."""
    fields = laws.LAWS[name].gains._fields
    return SimpleNamespace(**{f: vars(symbols).get(f, sp.Symbol(f, real=True)) for f in fields})


def steering(name: str) -> tuple[sp.Expr, sp.Expr]:
    """What a law's formula returns: (v/rho, omega), or (v, omega) if it needs a reference."""
    state = (rho, alpha, theta)
    if laws.LAWS[name].needs_reference:
        state = (*read(laws.body_error, *state), v_ref, omega_ref)
    return read(laws.LAWS[name].formula, *state, gains_of(name))


def law(name: str = "corrected") -> tuple[sp.Expr, sp.Expr]:
    """The twist that a law commands; finite at rho = 0 and at alpha = 0.

    Parameters
    ----------
    name : one of `LAWS`

    Returns
    -------
    v, omega : expressions in rho, alpha, theta, the law's gains and, if it needs a reference,
        v_ref and omega_ref; m/s, rad/s. ``sympy.lambdify`` of them equals `wmrlib.control_law` and
        `wmrlib.tracking_law`.

    Raises
    ------
    ValueError : for another name.
    """
    speed, turning = steering(choice("name", name, LAWS))
    return (speed if laws.LAWS[name].needs_reference else speed * rho), turning


def closed_loop(name: str = "corrected") -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """The polar error's rates under a pose law, smooth through the goal.

    Parameters
    ----------
    name : "corrected", "printed", "aicardi" or another law for a goal that stands still

    Returns
    -------
    rho', alpha', theta' : expressions; m/s, rad/s, rad/s

    Raises
    ------
    ValueError : for another name.

    Equations (7) to (9).
    """
    return read(
        motion.polar_closing_rate, rho, alpha, *steering(choice("name", name, laws.POSE_LAWS))
    )


def lyapunov(name: str = "corrected") -> sp.Expr:
    """The Lyapunov function of a law: V of (18), or its own, such as rho^2/2 + (1 - cos)/k_y.

    Parameters
    ----------
    name : one of `LAWS`

    Returns
    -------
    V : expression in rho, alpha, theta, L and the law's gains

    Raises
    ------
    ValueError : for another name.

    Equation (18).
    """
    row = laws.LAWS[choice("name", name, LAWS)]
    if row.value is laws.pose_value:
        return read(laws.lyapunov_value, rho, alpha, theta, h, L)[0]
    return read(row.value, rho, alpha, theta, gains_of(name))[0]


def lyapunov_rate(name: str = "corrected") -> sp.Expr:
    """V' along the closed loop: the gradient of V times the rates.

    For "corrected" it is -(rho/L) v_max (1 - exp(-k_rho rho)) cos^2(alpha) - k_alpha alpha^2, which
    `sympy.expand` finds after `textbook`. If the law needs a reference the rates are those of the
    error in the robot's frame.

    Parameters
    ----------
    name : one of `LAWS`

    Returns
    -------
    V' : expression, 1/s

    Raises
    ------
    ValueError : for another name.

    Equation (19).
    """
    energy, state = lyapunov(name), (rho, alpha, theta)
    if not laws.LAWS[name].needs_reference:
        rates = closed_loop(name)
        return sum(energy.diff(each) * rate for each, rate in zip(state, rates, strict=True))
    speed, turning = law(name)
    body = {ahead: rho * sp.cos(alpha), left: rho * sp.sin(alpha), turn: alpha - theta}
    rates = {
        ahead: turning * body[left] - speed + v_ref * sp.cos(body[turn]),
        left: v_ref * sp.sin(body[turn]) - turning * body[ahead],
        turn: omega_ref - turning,
    }
    energy = energy.subs({rho: sp.sqrt(ahead**2 + left**2), alpha: theta + turn})
    return sum(energy.diff(each).subs(body) * rate for each, rate in rates.items())


__all__ = ["LAWS", "closed_loop", "law", "lyapunov", "lyapunov_rate"]
