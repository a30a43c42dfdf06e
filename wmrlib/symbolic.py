"""The model as sympy expressions, numbered as in the paper, and the same formulas printed as JavaScript for the panel.

`EQUATIONS` holds what the paper prints, mistakes included. `law`, `closed_loop`, `lyapunov` and `lyapunov_rate` give what wmrlib
computes, finite at the goal. ``python -m wmrlib.symbolic`` prints `FORMULAS` into the panel's ``model.js``.
"""

from __future__ import annotations

import re
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

import mpmath
import numpy as np
import sympy as sp
from sympy.codegen.cfunctions import expm1
from sympy.printing.jscode import JavascriptCodePrinter
from sympy.printing.precedence import PRECEDENCE

from wmrlib._checks import choice

# The state, the twist and the gains, named as everywhere in wmrlib; alpha is the paper's A.
rho, alpha, theta, v, omega, v_ref, omega_ref = sp.symbols("rho alpha theta v omega v_ref omega_ref", real=True)
k_rho, k_alpha, h, v_max, L, k_x, k_y, k_heading = sp.symbols("k_rho k_alpha h v_max L k_x k_y k_heading", positive=True)
pull = sp.Symbol("pull", real=True)  # v/rho, which is finite at the goal
ahead, left, turn, t, rate, angle, square = sp.symbols("ahead left turn t rate angle square", real=True)
sine, sin_alpha, cos_alpha, sinc_alpha = sp.symbols("sine sin_alpha cos_alpha sinc_alpha", real=True)  # computed once, used often

# Rates, whose names sympy typesets with a dot, and what only the paper's first equations need.
rho_rate, alpha_rate, theta_rate, V_rate, x_rate, y_rate = sp.symbols("rhodot alphadot thetadot Vdot xdot ydot", real=True)
V, V_r, V_l, right_wheel, left_wheel, r, b, R, c, epsilon, br = sp.symbols("V V_r V_l w_R w_L r b R c epsilon br", real=True)
lat1, lat2, dlat, dlong, zeta_x, zeta_y = sp.symbols("lat1 lat2 Delta_lat Delta_long zeta_x zeta_y", real=True)

_SMALL = sp.Float("1e-8")  # below this, the next term of the series is under half a unit in the last place


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
        return sp.Piecewise(((k_rho * sp.exp(-k_rho * rho) - self) / rho, sp.Ne(rho, 0)), (-(k_rho**2) / 2, True))

    def _eval_rewrite_as_exp(self, rho, k_rho, **_):
        return (1 - sp.exp(-k_rho * rho)) / rho

    def _eval_evalf(self, prec):
        if all(argument.is_number for argument in self.args):
            with mpmath.workprec(prec):
                rho, k_rho = (argument._to_mpmath(prec) for argument in self.args)
                return sp.Expr._from_mpmath(-mpmath.expm1(-k_rho * rho) / rho, prec)

    @staticmethod
    def _imp_(rho, k_rho):  # what sympy.lambdify calls
        with np.errstate(divide="ignore", invalid="ignore"):  # numpy evaluates both branches of a Piecewise
            return _guarded_decay(rho, k_rho)[()]


_GUARDED_SINC = sp.Piecewise((sine / angle, sp.Abs(angle) > _SMALL), (1, True))
_GUARDED_DECAY = sp.Piecewise((-expm1(-k_rho * rho) / rho, sp.Abs(k_rho * rho) > _SMALL), (k_rho * (1 - k_rho * rho / 2), True))
_guarded_decay = sp.lambdify((rho, k_rho), _GUARDED_DECAY, "numpy")

# What wmrlib computes, each formula once -------------------------------------------------------------------------------

_SINE, _COSINE, _SINC = sp.sin(alpha), sp.cos(alpha), sp.sinc(alpha)
_STEER = k_alpha * alpha + pull * _SINC * (alpha + h * theta)
_SPEEDING = v_max * decay(rho, k_rho) * _COSINE
_PULL = {"corrected": _SPEEDING, "printed": _SPEEDING, "aicardi": k_rho * _COSINE}
_OMEGA = {"corrected": _STEER, "printed": k_alpha * alpha + pull * _SINE * _COSINE * _SINC * (alpha + h * theta), "aicardi": _STEER}
_KANAYAMA = (v_ref * sp.cos(turn) + k_x * ahead, omega_ref + v_ref * (k_y * left + k_heading * sp.sin(turn)))
_BODY_ERROR = {ahead: rho * _COSINE, left: rho * _SINE, turn: alpha - theta}
_POLAR_RATES = (-pull * rho * _COSINE, pull * _SINE - omega, pull * _SINE)  # (7)-(9)
_LYAPUNOV = rho**2 / (2 * L) + (alpha**2 + h * theta**2) / 2  # (18)
_LYAPUNOV_KANAYAMA = (ahead**2 + left**2) / 2 + (1 - sp.cos(turn)) / k_y
_DISCRIMINANT = (k_alpha / 2) ** 2 - h * rate**2
_SETTLING = sp.Piecewise((k_alpha / 2, _DISCRIMINANT <= 0), (h * rate**2 / (k_alpha / 2 + sp.sqrt(_DISCRIMINANT)), True))
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
    return _LYAPUNOV_KANAYAMA.subs(_BODY_ERROR) if choice("name", name, LAWS) == "kanayama" else _LYAPUNOV


def lyapunov_rate(name: str = "corrected") -> sp.Expr:
    """V' along the closed loop, equation (19): the gradient of V times the rates.

    For "corrected" it is -(rho/L) v_max (1 - exp(-k_rho rho)) cos^2(alpha) - k_alpha alpha^2, which
    `sympy.expand` finds after `textbook`. For
    "kanayama" the rates are those of the error in the robot's frame. Raises ValueError for another name.
    """
    if choice("name", name, LAWS) == "kanayama":
        speed, turning = _KANAYAMA
        rates = turning * left - speed + v_ref * sp.cos(turn), v_ref * sp.sin(turn) - turning * ahead, omega_ref - turning
        state, energy = (ahead, left, turn), _LYAPUNOV_KANAYAMA
        return sum(energy.diff(each) * slope for each, slope in zip(state, rates, strict=True)).subs(_BODY_ERROR)
    return sum(_LYAPUNOV.diff(each) * slope for each, slope in zip((rho, alpha, theta), closed_loop(name), strict=True))


def textbook(expression: sp.Expr) -> sp.Expr:
    """The expression with sinc and decay written out as the paper does, and so undefined at the goal."""
    return expression.replace(decay, lambda *each: decay(*each).rewrite(sp.exp)).replace(sp.sinc, lambda each: sp.sin(each) / each)


# What the paper prints -------------------------------------------------------------------------------------------------


def _equations() -> dict[int, sp.Basic]:
    speed = v_max * (1 - sp.exp(-k_rho * rho))
    twice = speed * _COSINE * _SINE / rho * _COSINE * _SINE / alpha * (alpha + h * theta)
    grows, falls = v * _SINE / rho * (h * theta + alpha), rho / L * (-speed * _COSINE**2)
    left_over = speed / rho * _COSINE * _SINE / alpha * h * theta
    half_dlat, half_dlong = sp.sin(dlat / 2), sp.sin(dlong / 2)
    return {
        1: sp.Eq(v, (V_r + V_l) / 2),
        2: sp.Eq(omega, (right_wheel - left_wheel) * r / b),
        3: sp.Eq(x_rate, v * sp.cos(theta)),
        4: sp.Eq(y_rate, v * sp.sin(theta)),
        5: sp.Eq(theta_rate, omega),
        6: sp.Eq(sp.Matrix([x_rate, y_rate, theta_rate]), sp.Matrix([v * sp.cos(theta), v * sp.sin(theta), omega])),
        7: sp.Eq(rho_rate, -v * _COSINE),
        8: sp.Eq(theta_rate, v * _SINE / rho),
        9: sp.Eq(alpha_rate, -omega + v * _SINE / rho),
        10: sp.Eq(sp.Matrix([rho_rate, alpha_rate, theta_rate]), sp.Matrix([-v * _COSINE, v * _SINE / rho - omega, -v * _SINE / rho])),
        11: sp.Eq(rho, R * c),
        12: sp.Eq(c, 2 * sp.atan2(sp.sqrt(epsilon), sp.sqrt(1 - epsilon))),
        13: sp.Eq(epsilon, half_dlat**2 + sp.cos(lat1) * sp.cos(lat2) * half_dlong**2),
        14: sp.Eq(theta, sp.pi / 2 - br),
        15: sp.Eq(br, sp.atan2(zeta_x, zeta_y)),
        16: sp.Eq(zeta_x, sp.cos(lat2) * sp.sin(dlong)),
        17: sp.Eq(zeta_y, sp.cos(lat1) * sp.sin(lat2) - sp.sin(lat1) * sp.cos(lat2) * sp.cos(dlong)),
        18: sp.Eq(V, rho**2 / (2 * L) + (alpha**2 + h * theta**2) / 2),
        19: sp.Eq(V_rate, rho * rho_rate / L + alpha * alpha_rate + h * theta * theta_rate),
        20: sp.Eq(V_rate, rho / L * (-v * _COSINE) + alpha * (-omega + v * _SINE / rho) + theta * h * (v * _SINE / rho)),
        21: sp.Eq(V_rate, rho / L * (-v * _COSINE) + (alpha * (-omega) + grows)),
        22: sp.Eq(v, speed * _COSINE),
        23: omega > (alpha + h * theta) * k_alpha * _COSINE * _SINE,
        24: sp.Eq(omega, k_alpha * alpha + twice),
        25: sp.Eq(V_rate, falls + (alpha * (-k_alpha * alpha - twice) + speed * _COSINE * _SINE / rho * (h * theta + alpha))),
        26: sp.Eq(V_rate, sp.Abs(rho) / L * (-speed * _COSINE**2) - k_alpha * alpha**2 - k_alpha * alpha - left_over),
    }


EQUATIONS = MappingProxyType(_equations())
"""From the paper's number to the equation as the paper prints it (sympy relations; A is alpha, 90 degrees are pi/2, and (6) and (10) are
multiplied out). (10) contradicts (8), (23) does not follow from (21), (24) has cos A sin A twice, (26) does not follow from (25)."""


# Printing --------------------------------------------------------------------------------------------------------------


class Formula(NamedTuple):
    """One function to print: its arguments in order, what it returns, and a line that says what that is."""

    arguments: tuple[sp.Symbol, ...]
    value: sp.Expr
    says: str


_SHARED = {_SINE: sin_alpha, _COSINE: cos_alpha, _SINC: sinc_alpha}
_STATE = (alpha, theta, sin_alpha, cos_alpha, sinc_alpha, pull, k_alpha, h)


def _law_formula(value: sp.Expr, arguments: tuple[sp.Symbol, ...], says: str) -> Formula:
    """The law with sin(alpha), cos(alpha) and sinc(alpha) as arguments, which a loop computes once for all formulas."""
    value = value.subs(_SHARED)
    return Formula(tuple(each for each in arguments if value.has(each)), value, says)


def _series(function: sp.Function) -> sp.Expr:
    """The function of an angle up to 0.1 in size, as a polynomial in the angle's square; the next term is lost in rounding."""
    return sp.horner(sp.series(function(angle), angle, 0, 10).removeO().subs(angle, sp.sqrt(square)))


FORMULAS = MappingProxyType(
    {
        "sinc": Formula((angle, sine), _GUARDED_SINC, "sin(angle)/angle, which is 1 at 0"),
        "decay": Formula((rho, k_rho), _GUARDED_DECAY, "(1 - exp(-k_rho rho))/rho, which is k_rho at rho = 0"),
        "small_sinc": Formula((square,), _series(sp.sinc), "sin(angle)/angle of an angle up to 0.1, from its square"),
        "small_cos": Formula((square,), _series(sp.cos), "cos(angle) of an angle up to 0.1, from its square"),
        "corrected_pull": _law_formula(_PULL["corrected"], (rho, cos_alpha, k_rho, v_max), "v/rho by (22)"),
        "corrected_omega": _law_formula(_OMEGA["corrected"], _STATE, "the omega that makes the proof work"),
        "printed_omega": _law_formula(_OMEGA["printed"], _STATE, "(24) as the paper prints it"),
        "aicardi_pull": _law_formula(_PULL["aicardi"], (cos_alpha, k_rho), "v/rho of the linear law; its omega is the corrected one"),
        "body_ahead": _law_formula(_BODY_ERROR[ahead], (rho, cos_alpha), "how far the goal lies ahead"),
        "body_left": _law_formula(_BODY_ERROR[left], (rho, sin_alpha), "how far the goal lies to the left"),
        "kanayama_v": Formula((ahead, turn, v_ref, k_x), _KANAYAMA[0], "v of the law with feed-forward"),
        "kanayama_omega": Formula((left, turn, v_ref, omega_ref, k_y, k_heading), _KANAYAMA[1], "its omega"),
        "lyapunov_value": Formula((rho, alpha, theta, h, L), _LYAPUNOV, "V, (18)"),
        "kanayama_value": Formula((ahead, left, turn, k_y), _LYAPUNOV_KANAYAMA, "its V"),
        "rho_rate": _law_formula(_POLAR_RATES[0], (rho, cos_alpha, pull), "(7)"),
        "theta_rate": _law_formula(_POLAR_RATES[2], (sin_alpha, pull), "(8)"),
        "alpha_rate": _law_formula(_POLAR_RATES[1], (sin_alpha, pull, omega), "(9)"),
        "mode_frequency": Formula((rate, h), rate * sp.sqrt(h), "natural frequency near the goal, with rate = v_max k_rho"),
        "mode_damping": Formula((rate, k_alpha, h), k_alpha / (2 * rate * sp.sqrt(h)), "damping near the goal"),
        "mode_settling": Formula((rate, k_alpha, h), _SETTLING, "the rate at which the heading settles near the goal"),
        "circle_angle": Formula((t,), _CIRCLE_TURN * t, "where the paper's circle is at time t"),
        "circle_x": Formula((angle,), _CIRCLE_RADIUS * sp.cos(angle) - _CIRCLE_RADIUS, "x_r"),
        "circle_y": Formula((angle,), _CIRCLE_RADIUS * sp.sin(angle), "y_r"),
        "circle_heading": Formula((angle,), angle + sp.pi / 2, "theta_r"),
        "circle_speed": Formula((), _CIRCLE_TURN * _CIRCLE_RADIUS, "speed of the reference"),
        "circle_turn": Formula((), _CIRCLE_TURN, "turning rate of the reference"),
    }
)
"""What is printed, by name. A printer for another language goes through the same table."""


class _Printer(JavascriptCodePrinter):
    def _print_Pow(self, expr):  # noqa: N802 (sympy's name)
        if expr.exp != 2:
            return super()._print_Pow(expr)
        base = self.parenthesize(expr.base, PRECEDENCE["Mul"])
        return f"({base}*{base})"  # rounded once, where Math.pow promises nothing


MODEL_JS = Path(__file__).parent / "panel" / "model.js"
_HEADER = "// The model's formulas, printed from sympy: change wmrlib/symbolic.py, then run python -m wmrlib.symbolic.\n"


def javascript_name(name: str) -> str:
    """The name in camelCase, as `javascript` prints it."""
    return re.sub("_(.)", lambda part: part[1].upper(), name)


def javascript() -> str:
    """The text of ``model.js``: every formula of `FORMULAS` as a JavaScript function of numbers, named in camelCase."""
    names = {name: javascript_name(name) for name in FORMULAS}
    printer = _Printer({"user_functions": names | {"expm1": "Math.expm1"}})
    functions = []
    for name, (arguments, value, says) in FORMULAS.items():
        body = re.sub(r"\s+", " ", printer.doprint(value))
        functions.append(f"\n// {says}\nfunction {names[name]}({', '.join(map(str, arguments))}) {{\n  return {body};\n}}\n")
    return _HEADER + "".join(functions)


if __name__ == "__main__":
    MODEL_JS.write_text(javascript(), encoding="utf-8")
