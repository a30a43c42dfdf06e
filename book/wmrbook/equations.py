"""What the paper prints, mistakes included."""

from __future__ import annotations

from types import MappingProxyType

import sympy as sp

from wmrlib.symbolic import (
    L,
    R,
    alpha,
    b,
    dlat,
    dlong,
    h,
    k_alpha,
    k_rho,
    lat1,
    lat2,
    omega,
    rho,
    theta,
    v,
    v_max,
)

# Rates, whose names sympy typesets with a dot, and what only these equations need.
rho_rate, alpha_rate, theta_rate, V_rate, x_rate, y_rate = sp.symbols(
    "rhodot alphadot thetadot Vdot xdot ydot", real=True
)
V, V_r, V_l, right_wheel, left_wheel, r, c, epsilon, br, zeta_x, zeta_y = sp.symbols(
    "V V_r V_l w_R w_L r c epsilon br zeta_x zeta_y", real=True
)
rho_i, k_A = sp.symbols("rho_i k_A", positive=True)  # noqa: N816
blank = sp.Symbol(r"\square", real=True)  # (18) begins with its "="
UNDEFINED = MappingProxyType({rho_i: rho, k_A: k_alpha, blank: V})
"""From a symbol that the paper never defines, or a blank, to the one that we read in its place."""
_SINE, _COSINE = sp.sin(alpha), sp.cos(alpha)


def _equations() -> dict[int, sp.Basic]:
    speed = v_max * (1 - sp.exp(-k_rho * rho))
    twice = speed * _COSINE * _SINE / rho_i * _COSINE * _SINE / alpha * (alpha + h * theta)
    grows, falls = v * _SINE / rho * (h * theta + alpha), rho / L * (-speed * _COSINE**2)
    left_over = speed / rho * _COSINE * _SINE / alpha * h * theta
    half_dlat, half_dlong = sp.sin(dlat / 2), sp.sin(dlong / 2)
    return {
        1: sp.Eq(v, (V_r + V_l) / 2),
        2: sp.Eq(omega, (right_wheel - left_wheel) * r / b),
        3: sp.Eq(x_rate, v * sp.cos(theta)),
        4: sp.Eq(y_rate, v * sp.sin(theta)),
        5: sp.Eq(theta_rate, omega),
        6: sp.Eq(
            sp.Matrix([x_rate, y_rate, theta_rate]),
            sp.Matrix([v * sp.cos(theta), v * sp.sin(theta), theta_rate]),
        ),
        7: sp.Eq(rho_rate, -v * _COSINE),
        8: sp.Eq(theta_rate, v * _SINE / rho),
        9: sp.Eq(alpha_rate, -omega + v * _SINE / rho),
        10: sp.Eq(
            sp.Matrix([rho_rate, alpha_rate, theta_rate]),
            sp.Matrix([-v * _COSINE, v * _SINE / rho - omega, -v * _SINE / rho]),
        ),
        11: sp.Eq(rho, R * c),
        12: sp.Eq(c, 2 * sp.atan2(sp.sqrt(epsilon), sp.sqrt(1 - epsilon))),
        13: sp.Eq(epsilon, half_dlat**2 + sp.cos(lat1) * sp.cos(lat2) * half_dlong**2),
        14: sp.Eq(theta, sp.pi / 2 - br),
        15: sp.Eq(br, sp.atan2(zeta_x, zeta_y)),
        16: sp.Eq(zeta_x, sp.cos(lat2) * sp.sin(dlong)),
        17: sp.Eq(
            zeta_y, sp.cos(lat1) * sp.sin(lat2) - sp.sin(lat1) * sp.cos(lat2) * sp.cos(dlong)
        ),
        18: sp.Eq(blank, rho**2 / (2 * L) + (alpha**2 + h * theta**2) / 2),
        19: sp.Eq(V_rate, rho * rho_rate / L + alpha * alpha_rate + h * theta * theta_rate),
        20: sp.Eq(
            V_rate,
            rho / L * (-v * _COSINE)
            + alpha * (-omega + v * _SINE / rho)
            + theta * h * (v * _SINE / rho),
        ),
        21: sp.Eq(V_rate, rho / L * (-v * _COSINE) + (alpha * (-omega) + grows)),
        22: sp.Eq(v, speed * _COSINE),
        23: omega > (alpha + h * theta) * k_alpha * _COSINE * _SINE,
        24: sp.Eq(omega, k_alpha * alpha + twice),
        25: sp.Eq(
            V_rate,
            falls
            + (
                alpha * (-k_alpha * alpha - twice)
                + speed * _COSINE * _SINE / rho * (h * theta + alpha)
            ),
        ),
        26: sp.Eq(
            V_rate,
            sp.Abs(rho) / L * (-speed * _COSINE**2) - k_A * alpha**2 - k_A * alpha - left_over,
        ),
    }


PRINTED = MappingProxyType(_equations())
"""From the paper's number to the equation with the symbols that the paper prints, in our notation.

They are sympy relations; A is alpha, w is omega, 90 degrees are pi/2, theta_a is theta, log and
long are longitudes, and (6) and (10) are multiplied out. The input of (6) is v and the rate of
theta, and (18) has no left side.
"""

EQUATIONS = MappingProxyType(
    {number: equation.subs(UNDEFINED, simultaneous=True) for number, equation in PRINTED.items()}
)
"""The same with defined symbols: rho_i in (24) and (25) is read as rho, k_A in (26) as k_alpha, and
the left side that (18) lacks as V.

(10) contradicts (8), (23) does not follow from (21), (24) has cos A sin A twice, and (26) does not
follow from (25).
"""

FIRST_PART = rho * (-v * _COSINE)
"""The bracket that the paper prints without a number above (22), to be negative.

The first part of (21) is divided by L.
"""

SECOND_PART = alpha / L * (-omega) + v * _SINE / (rho * L) * (h * theta + alpha)
"""The bracket that the paper prints without a number between (22) and (23), to be negative.

The second part of (21) has no L.
"""
