"""The symbols, named as everywhere in wmrlib, and functions that are finite where 0/0 stands."""

from __future__ import annotations

import mpmath
import numpy as np
import sympy as sp
from sympy.codegen.cfunctions import expm1

from wmrlib import _vecmath, motion

rho, alpha, theta, v, omega, v_ref, omega_ref = sp.symbols(
    "rho alpha theta v omega v_ref omega_ref", real=True
)  # alpha is the paper's A
k_rho, k_alpha, h, v_max, L, k_x, k_y, k_heading = sp.symbols(
    "k_rho k_alpha h v_max L k_x k_y k_heading", positive=True
)
x, y, heading, goal_x, goal_y, goal_heading, dt = sp.symbols(
    "x y heading goal_x goal_y goal_heading dt", real=True
)
v_over_rho, ahead, left, turn, angle, t = sp.symbols(
    "v_over_rho ahead left turn angle t", real=True
)
lat1, lat2, dlat, dlong, R = sp.symbols("lat1 lat2 Delta_lat Delta_long R", real=True)
east, north, b, fastest, max_speed = sp.symbols("east north b fastest max_speed", real=True)

_SMALL = sp.Float(_vecmath._SMALL)


class decay(sp.Function):  # noqa: N801 (sympy names its functions in lower case)
    """(1 - exp(-k_rho rho))/rho, k_rho at rho = 0; ``rewrite(sympy.exp)`` writes it out."""

    nargs = 2
    _imp_ = staticmethod(np.vectorize(_vecmath.decay, otypes=[float]))  # what lambdify calls

    @classmethod
    def eval(cls, rho, k_rho):
        return k_rho if rho.is_zero else None

    def fdiff(self, argindex=1):
        rho, k_rho = self.args
        falling = sp.exp(-k_rho * rho)
        if argindex == 2:
            return falling
        return sp.Piecewise(
            ((k_rho * falling - self) / rho, sp.Ne(rho, 0)), (-(k_rho**2) / 2, True)
        )

    def _eval_rewrite_as_exp(self, rho, k_rho, **_):
        return (1 - sp.exp(-k_rho * rho)) / rho

    def _eval_evalf(self, prec):
        if all(argument.is_number for argument in self.args):
            with mpmath.workprec(prec):
                rho, k_rho = (argument._to_mpmath(prec) for argument in self.args)
                return sp.Expr._from_mpmath(-mpmath.expm1(-k_rho * rho) / rho, prec)


class wrap(sp.Function):  # noqa: N801
    """The same direction in (-pi, pi]."""

    nargs = 1
    _imp_ = staticmethod(np.vectorize(motion.wrap, otypes=[float]))

    def fdiff(self, argindex=1):
        return sp.Integer(1)


GUARDED_SINC = sp.Piecewise((sp.sin(angle) / angle, sp.Abs(angle) > _SMALL), (1, True))
GUARDED_DECAY = sp.Piecewise(
    (-expm1(-k_rho * rho) / rho, sp.Abs(k_rho * rho) > _SMALL),
    (k_rho * (1 - k_rho * rho / 2), True),
)
TURNED_BACK = sp.Piecewise(
    (angle - 2 * sp.pi, angle > sp.pi), (angle + 2 * sp.pi, angle <= -sp.pi), (angle, True)
)
SATURATED = sp.Piecewise((max_speed / fastest, fastest > max_speed), (1, True))


def textbook(expression: sp.Expr) -> sp.Expr:
    """The expression with sinc and decay written out as in the paper: undefined at the goal."""
    return expression.replace(decay, lambda *each: decay(*each).rewrite(sp.exp)).replace(
        sp.sinc, lambda each: sp.sin(each) / each
    )


__all__ = [name for name, value in globals().items() if isinstance(value, sp.Symbol)]
__all__ += ["decay", "textbook", "wrap"]
