"""The symbols, and what wmrlib computes as sympy expressions that are finite at the goal."""

from __future__ import annotations

import mpmath
import numpy as np
import sympy as sp
from sympy.codegen.cfunctions import expm1

from wmrlib._checks import choice

# The state, the twist and the gains, named as everywhere in wmrlib; alpha is the paper's A.
rho, alpha, theta, v, omega, v_ref, omega_ref = sp.symbols(
    "rho alpha theta v omega v_ref omega_ref", real=True
)
k_rho, k_alpha, h, v_max, L, k_x, k_y, k_heading = sp.symbols(
    "k_rho k_alpha h v_max L k_x k_y k_heading", positive=True
)
pull = sp.Symbol("pull", real=True)  # v/rho, which is finite at the goal
ahead, left, turn, t, rate, angle, square = sp.symbols(
    "ahead left turn t rate angle square", real=True
)
sine, sin_alpha, cos_alpha, sinc_alpha = sp.symbols(
    "sine sin_alpha cos_alpha sinc_alpha", real=True
)  # computed once, used often

# Rates, whose names sympy typesets with a dot, and what only the paper's first equations need.
rho_rate, alpha_rate, theta_rate, V_rate, x_rate, y_rate = sp.symbols(
    "rhodot alphadot thetadot Vdot xdot ydot", real=True
)
V, V_r, V_l, right_wheel, left_wheel, r, b, R, c, epsilon, br = sp.symbols(
    "V V_r V_l w_R w_L r b R c epsilon br", real=True
)
lat1, lat2, dlat, dlong, zeta_x, zeta_y = sp.symbols(
    "lat1 lat2 Delta_lat Delta_long zeta_x zeta_y", real=True
)
east, north, rest, fastest, max_speed = sp.symbols("east north rest fastest max_speed", real=True)

_SMALL = sp.Float(
    "1e-8"
)  # below this, the next term of the series is under half a unit in the last place


# sympy brings sinc, which is sin(angle)/angle and 1 at 0. Its sibling:
class decay(sp.Function):  # noqa: N801 (sympy names its functions in lower case)
    """(1 - exp(-k_rho rho))/rho, which is k_rho at rho = 0; ``rewrite(sympy.exp)`` gives the textbook's form back."""

    nargs = 2

    @classmethod
    def eval(cls, rho, k_rho):
        return k_rho if rho.is_zero else None

    def fdiff(self, argindex=1):
        rho, k_rho = self.args
        if argindex == 2:
            return sp.exp(-k_rho * rho)
        return sp.Piecewise(
            ((k_rho * sp.exp(-k_rho * rho) - self) / rho, sp.Ne(rho, 0)), (-(k_rho**2) / 2, True)
        )

    def _eval_rewrite_as_exp(self, rho, k_rho, **_):
        return (1 - sp.exp(-k_rho * rho)) / rho

    def _eval_evalf(self, prec):
        if all(argument.is_number for argument in self.args):
            with mpmath.workprec(prec):
                rho, k_rho = (argument._to_mpmath(prec) for argument in self.args)
                return sp.Expr._from_mpmath(-mpmath.expm1(-k_rho * rho) / rho, prec)

    @staticmethod
    def _imp_(rho, k_rho):  # what sympy.lambdify calls
        with np.errstate(
            divide="ignore", invalid="ignore"
        ):  # numpy evaluates both branches of a Piecewise
            return _guarded_decay(rho, k_rho)[()]


_GUARDED_SINC = sp.Piecewise((sine / angle, sp.Abs(angle) > _SMALL), (1, True))
_GUARDED_DECAY = sp.Piecewise(
    (-expm1(-k_rho * rho) / rho, sp.Abs(k_rho * rho) > _SMALL),
    (k_rho * (1 - k_rho * rho / 2), True),
)
_guarded_decay = sp.lambdify((rho, k_rho), _GUARDED_DECAY, "numpy")

# What wmrlib computes, each formula once -------------------------------------------------------------------------------

_SINE, _COSINE, _SINC = sp.sin(alpha), sp.cos(alpha), sp.sinc(alpha)
_STEER = k_alpha * alpha + pull * _SINC * (alpha + h * theta)
_SPEEDING = v_max * decay(rho, k_rho) * _COSINE
_PULL = {"corrected": _SPEEDING, "printed": _SPEEDING, "aicardi": k_rho * _COSINE}
_OMEGA = {
    "corrected": _STEER,
    "printed": k_alpha * alpha + pull * _SINE * _COSINE * _SINC * (alpha + h * theta),
    "aicardi": _STEER,
}
_KANAYAMA = (
    v_ref * sp.cos(turn) + k_x * ahead,
    omega_ref + v_ref * (k_y * left + k_heading * sp.sin(turn)),
)
_BODY_ERROR = {ahead: rho * _COSINE, left: rho * _SINE, turn: alpha - theta}
_POLAR_RATES = (-pull * rho * _COSINE, pull * _SINE - omega, pull * _SINE)  # (7)-(9)
_LYAPUNOV = rho**2 / (2 * L) + (alpha**2 + h * theta**2) / 2  # (18)
_LYAPUNOV_KANAYAMA = (ahead**2 + left**2) / 2 + (1 - sp.cos(turn)) / k_y
_DISCRIMINANT = (k_alpha / 2) ** 2 - h * rate**2
_SETTLING = sp.Piecewise(
    (k_alpha / 2, _DISCRIMINANT <= 0), (h * rate**2 / (k_alpha / 2 + sp.sqrt(_DISCRIMINANT)), True)
)
_CIRCLE_PERIOD, _CIRCLE_RADIUS = 40, 4
_CIRCLE_TURN = 2 * sp.pi / _CIRCLE_PERIOD

LAWS = ("corrected", "printed", "aicardi", "kanayama")


def law(name: str = "corrected") -> tuple[sp.Expr, sp.Expr]:
    """The twist (v, omega) in m/s and rad/s as expressions in rho, alpha, theta and the gains; finite at rho = 0 and alpha = 0.

    "corrected": (22), and the omega that makes the proof work; "printed": (22) and (24); "aicardi": the linear law; "kanayama": also in
    v_ref and omega_ref. ``sympy.lambdify`` of them equals `wmrlib.control_law` and `wmrlib.tracking_law`.
    Raises ValueError for another name. Sources: see `wmrlib.control`.
    """
    if choice("name", name, LAWS) == "kanayama":
        return tuple(part.subs(_BODY_ERROR) for part in _KANAYAMA)
    return _PULL[name] * rho, _OMEGA[name].subs(pull, _PULL[name])


def closed_loop(name: str = "corrected") -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """(rho', alpha', theta') in m/s and rad/s: equations (7)-(9) under one of the pose laws, smooth through the goal.

    Raises ValueError for another name; "kanayama" is not among them, since its goal moves.
    """
    _, steering = law(choice("name", name, _PULL))
    return tuple(part.subs(omega, steering).subs(pull, _PULL[name]) for part in _POLAR_RATES)


def lyapunov(name: str = "corrected") -> sp.Expr:
    """V, equation (18), or for "kanayama" rho^2/2 + (1 - cos(alpha - theta))/k_y. Raises ValueError for another name."""
    return (
        _LYAPUNOV_KANAYAMA.subs(_BODY_ERROR)
        if choice("name", name, LAWS) == "kanayama"
        else _LYAPUNOV
    )


def lyapunov_rate(name: str = "corrected") -> sp.Expr:
    """V' along the closed loop, equation (19): the gradient of V times the rates.

    For "corrected" it is -(rho/L) v_max (1 - exp(-k_rho rho)) cos^2(alpha) - k_alpha alpha^2, which
    `sympy.expand` finds after `textbook`. For
    "kanayama" the rates are those of the error in the robot's frame. Raises ValueError for another name.
    """
    if choice("name", name, LAWS) == "kanayama":
        speed, turning = _KANAYAMA
        rates = (
            turning * left - speed + v_ref * sp.cos(turn),
            v_ref * sp.sin(turn) - turning * ahead,
            omega_ref - turning,
        )
        state, energy = (ahead, left, turn), _LYAPUNOV_KANAYAMA
        return sum(
            energy.diff(each) * slope for each, slope in zip(state, rates, strict=True)
        ).subs(_BODY_ERROR)
    return sum(
        _LYAPUNOV.diff(each) * slope
        for each, slope in zip((rho, alpha, theta), closed_loop(name), strict=True)
    )


def textbook(expression: sp.Expr) -> sp.Expr:
    """The expression with sinc and decay written out as the paper does, and so undefined at the goal."""
    return expression.replace(decay, lambda *each: decay(*each).rewrite(sp.exp)).replace(
        sp.sinc, lambda each: sp.sin(each) / each
    )
