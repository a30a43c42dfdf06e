"""The symbols, named as everywhere in wmrlib, and functions that are finite where 0/0 stands."""

from __future__ import annotations

from functools import partial

import numpy as np
import sympy as sp
from sympy.codegen.cfunctions import expm1

from wmrlib import elementary

_real = partial(sp.symbols, real=True)
_positive = partial(sp.symbols, positive=True)

rho, alpha, theta = STATE = _real("rho alpha theta")  # alpha is the paper's A
v, omega, v_ref, omega_ref, v_over_rho = _real("v omega v_ref omega_ref v_over_rho")
k_rho, k_alpha, h, v_max, L = _positive("k_rho k_alpha h v_max L")
k_x, k_y, k_heading = _positive("k_x k_y k_heading")
x, y, heading, goal_x, goal_y, goal_heading = _real("x y heading goal_x goal_y goal_heading")
ahead, left, turn, angle, t, dt = _real("ahead left turn angle t dt")
before, hysteresis = _real("before hysteresis")
error, gain, min_rate, max_rate, min_speed = _real("error gain min_rate max_rate min_speed")
speed_left, speed_right, rest_left, rest_right = _real("left right left_rest right_rest")
acceleration, lag, dead_band, encoder_step = _real("acceleration lag dead_band encoder_step")
lat1, lat2, dlat, dlong, R = _real("lat1 lat2 Delta_lat Delta_long R")
east, north, b, fastest, max_speed = _real("east north b fastest max_speed")

_SMALL = sp.Float(elementary.SMALL)


class decay(sp.Function):  # noqa: N801 (sympy names its functions in lower case)
    """(1 - exp(-k_rho rho))/rho, k_rho at rho = 0; `textbook` writes it out."""

    nargs = 2

    @classmethod
    def eval(cls, rho, k_rho):
        return k_rho if rho.is_zero else None

    def fdiff(self, argindex=1):
        rho, k_rho = self.args
        falling = sp.exp(-k_rho * rho)
        if argindex == 2:
            return falling
        elsewhere = (k_rho * falling - self) / rho
        return sp.Piecewise((elsewhere, sp.Ne(rho, 0)), (-(k_rho**2) / 2, True))

    def _eval_evalf(self, prec):
        rho, k_rho = self.args
        return (-expm1(-k_rho * rho) / rho)._eval_evalf(prec) if self.is_number else None


class wrap(sp.Function):  # noqa: N801
    """The same direction in (-pi, pi]."""

    nargs = 1

    def fdiff(self, argindex=1):
        return sp.Integer(1)


# What lambdify calls. It stands outside the classes, which the book's pages have without numpy.
decay._imp_ = staticmethod(np.vectorize(elementary.decay, otypes=[float]))
wrap._imp_ = staticmethod(np.vectorize(elementary.wrap, otypes=[float]))

GUARDED_SINC = sp.Piecewise((sp.sin(angle) / angle, sp.Abs(angle) > _SMALL), (1, True))
_ELSEWHERE = -expm1(-k_rho * rho) / rho, sp.Abs(k_rho * rho) > _SMALL
GUARDED_DECAY = sp.Piecewise(_ELSEWHERE, (k_rho * (1 - k_rho * rho / 2), True))
TURNED_BACK = sp.Piecewise(
    (angle - 2 * sp.pi, angle > sp.pi), (angle + 2 * sp.pi, angle <= -sp.pi), (angle, True)
)
_WITHIN, _TURN = sp.And(angle > -sp.pi, angle <= sp.pi), sp.Function("fmod")(angle, 2 * sp.pi)
GUARDED_WRAP = sp.Piecewise((angle, _WITHIN), (sp.Function("turned_back")(_TURN), True))
SATURATED = sp.Piecewise((max_speed / fastest, fastest > max_speed), (1, True))


def textbook(expression: sp.Expr) -> sp.Expr:
    """The expression with sinc and decay written out as in the paper: undefined at the goal."""
    plain = expression.replace(decay, lambda rho, k_rho: (1 - sp.exp(-k_rho * rho)) / rho)
    return plain.replace(sp.sinc, lambda angle: sp.sin(angle) / angle)


__all__ = [name for name, value in globals().items() if isinstance(value, sp.Symbol)]
__all__ += ["decay", "textbook", "wrap"]
