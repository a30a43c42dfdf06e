"""The formulas that are printed into other languages, by name."""

from __future__ import annotations

from types import MappingProxyType
from typing import NamedTuple

import sympy as sp

from wmrlib.symbolic._model import (
    _BODY_ERROR,
    _CIRCLE_RADIUS,
    _CIRCLE_TURN,
    _COSINE,
    _GUARDED_DECAY,
    _GUARDED_SINC,
    _KANAYAMA,
    _LYAPUNOV,
    _LYAPUNOV_KANAYAMA,
    _OMEGA,
    _POLAR_RATES,
    _PULL,
    _SETTLING,
    _SINC,
    _SINE,
    L,
    R,
    ahead,
    alpha,
    angle,
    b,
    cos_alpha,
    dlat,
    dlong,
    east,
    epsilon,
    fastest,
    h,
    k_alpha,
    k_heading,
    k_rho,
    k_x,
    k_y,
    lat1,
    lat2,
    left,
    max_speed,
    north,
    omega,
    omega_ref,
    pull,
    rate,
    rest,
    rho,
    sin_alpha,
    sinc_alpha,
    sine,
    square,
    t,
    theta,
    turn,
    v,
    v_max,
    v_ref,
    zeta_x,
    zeta_y,
)


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
    return sp.horner(
        sp.series(function(angle), angle, 0, 10).removeO().subs(angle, sp.sqrt(square))
    )


FORMULAS = MappingProxyType(
    {
        "sinc": Formula((angle, sine), _GUARDED_SINC, "sin(angle)/angle, which is 1 at 0"),
        "decay": Formula(
            (rho, k_rho), _GUARDED_DECAY, "(1 - exp(-k_rho rho))/rho, which is k_rho at rho = 0"
        ),
        "small_sinc": Formula(
            (square,), _series(sp.sinc), "sin(angle)/angle of an angle up to 0.1, from its square"
        ),
        "small_cos": Formula(
            (square,), _series(sp.cos), "cos(angle) of an angle up to 0.1, from its square"
        ),
        "corrected_pull": _law_formula(
            _PULL["corrected"], (rho, cos_alpha, k_rho, v_max), "v/rho by (22)"
        ),
        "corrected_omega": _law_formula(
            _OMEGA["corrected"], _STATE, "the omega that makes the proof work"
        ),
        "printed_omega": _law_formula(_OMEGA["printed"], _STATE, "(24) as the paper prints it"),
        "aicardi_pull": _law_formula(
            _PULL["aicardi"],
            (cos_alpha, k_rho),
            "v/rho of the linear law; its omega is the corrected one",
        ),
        "body_ahead": _law_formula(
            _BODY_ERROR[ahead], (rho, cos_alpha), "how far the goal lies ahead"
        ),
        "body_left": _law_formula(
            _BODY_ERROR[left], (rho, sin_alpha), "how far the goal lies to the left"
        ),
        "kanayama_v": Formula(
            (ahead, turn, v_ref, k_x), _KANAYAMA[0], "v of the law with feed-forward"
        ),
        "kanayama_omega": Formula(
            (left, turn, v_ref, omega_ref, k_y, k_heading), _KANAYAMA[1], "its omega"
        ),
        "lyapunov_value": Formula((rho, alpha, theta, h, L), _LYAPUNOV, "V, (18)"),
        "kanayama_value": Formula((ahead, left, turn, k_y), _LYAPUNOV_KANAYAMA, "its V"),
        "rho_rate": _law_formula(_POLAR_RATES[0], (rho, cos_alpha, pull), "(7)"),
        "theta_rate": _law_formula(_POLAR_RATES[2], (sin_alpha, pull), "(8)"),
        "alpha_rate": _law_formula(_POLAR_RATES[1], (sin_alpha, pull, omega), "(9)"),
        "mode_frequency": Formula(
            (rate, h), rate * sp.sqrt(h), "natural frequency near the goal, with rate = v_max k_rho"
        ),
        "mode_damping": Formula(
            (rate, k_alpha, h), k_alpha / (2 * rate * sp.sqrt(h)), "damping near the goal"
        ),
        "mode_settling": Formula(
            (rate, k_alpha, h), _SETTLING, "the rate at which the heading settles near the goal"
        ),
        "circle_angle": Formula((t,), _CIRCLE_TURN * t, "where the paper's circle is at time t"),
        "circle_x": Formula((angle,), _CIRCLE_RADIUS * sp.cos(angle) - _CIRCLE_RADIUS, "x_r"),
        "circle_y": Formula((angle,), _CIRCLE_RADIUS * sp.sin(angle), "y_r"),
        "circle_heading": Formula((angle,), angle + sp.pi / 2, "theta_r"),
        "circle_speed": Formula((), _CIRCLE_TURN * _CIRCLE_RADIUS, "speed of the reference"),
        "circle_turn": Formula((), _CIRCLE_TURN, "turning rate of the reference"),
    }
)
"""What is printed, by name. A printer for another language goes through the same table."""


# What only the robot's C needs: its pose in the plane, its wheels and its GPS receiver -------------------------------------

_HALF_LAT, _HALF_LONG = sp.sin(dlat / 2) ** 2, sp.sin(dlong / 2) ** 2
_ACROSS = sp.cos(lat1) * sp.cos(lat2)
_WRAPPED = sp.Piecewise(
    (angle - 2 * sp.pi, angle > sp.pi), (angle + 2 * sp.pi, angle <= -sp.pi), (angle, True)
)
_OF_THE_LAW = (
    "sinc",
    "decay",
    "corrected_pull",
    "corrected_omega",
    "printed_omega",
    "aicardi_pull",
    "lyapunov_value",
)
_OF_THE_ROBOT = {
    "turned_back": Formula((angle,), _WRAPPED, "an angle within a turn of 0, in (-pi, pi]"),
    "distance": Formula((east, north), sp.sqrt(east**2 + north**2), "rho"),
    "sight": Formula((east, north), sp.atan2(north, east), "the line of sight, from east"),
    "left_wheel": Formula((v, omega, b), v - omega * b / 2, "its ground speed, from (1) and (2)"),
    "right_wheel": Formula((v, omega, b), v + omega * b / 2, "its ground speed, from (1) and (2)"),
    "fastest_wheel": Formula(
        (v, omega, b), sp.Abs(v) + sp.Abs(omega) * b / 2, "the ground speed of the faster wheel"
    ),
    "wheel_share": Formula(
        (max_speed, fastest),
        sp.Piecewise((max_speed / fastest, fastest > max_speed), (1, True)),
        "the share of the twist that the faster wheel, at `fastest`, can follow within its max_speed",
    ),
}
GEODESY = MappingProxyType(
    {
        "epsilon": Formula((lat1, lat2, dlat, dlong), _HALF_LAT + _ACROSS * _HALF_LONG, "(13)"),
        "rest": Formula(
            (lat1, lat2, dlong),
            sp.sin((lat1 + lat2) / 2) ** 2 + _ACROSS * sp.cos(dlong / 2) ** 2,
            "1 - epsilon, without the difference",
        ),
        "sphere_distance": Formula(
            (epsilon, rest, R), 2 * R * sp.atan2(sp.sqrt(epsilon), sp.sqrt(rest)), "(11) and (12)"
        ),
        "zeta_x": Formula((lat2, dlong), sp.cos(lat2) * sp.sin(dlong), "(16)"),
        "zeta_y": Formula(
            (lat1, lat2, dlat, dlong),
            sp.sin(dlat) + 2 * sp.sin(lat1) * sp.cos(lat2) * _HALF_LONG,
            "(17), without losing digits nearby",
        ),
        "bearing": Formula((zeta_x, zeta_y), sp.atan2(zeta_x, zeta_y), "(15)"),
    }
)
"""The formulas of two GPS points, which need doubles."""
C_FORMULAS = MappingProxyType({name: FORMULAS[name] for name in _OF_THE_LAW} | _OF_THE_ROBOT)
"""What is printed into the C header: the law's formulas out of `FORMULAS`, and those of the robot around it."""
