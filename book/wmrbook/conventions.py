"""The polar error in other authors' signs, and the gains of their linear law.

Some write theta, some beta = -theta. All of them turn with omega = k_alpha alpha + (sign) k_beta
beta and mean the same robot; only the third angle's sign differs, and with it that of its gain. The
library has Aicardi's signs, as the paper's (7)-(9).
"""

from __future__ import annotations

from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from wmrlib.checks import Real, choice, instance, reals, refusal
from wmrlib.gains import Gains


class Convention(NamedTuple):
    """How an author writes the polar error.

    symbols: of the distance, of the angle from the heading to the line of sight, and of the third
    angle; third: +1 if that is theta, from the goal's heading to the line of sight, -1 if it is
    beta, the other way; gain: the sign before the third angle's gain; source: where it stands.
    """

    symbols: tuple[str, str, str]
    third: int
    gain: int
    source: str


_BETA = ("rho", "alpha", "beta")
CONVENTIONS = MappingProxyType(
    {
        "aicardi": Convention(
            ("e", "alpha", "theta"), 1, 1, "Aicardi et al. (1995), doi:10.1109/100.388294"
        ),
        "corke": Convention(_BETA, -1, 1, "Corke (2023), doi:10.1007/978-3-031-06469-2"),
        "siegwart": Convention(_BETA, -1, 1, "Siegwart et al. (2011), section 3.6.2"),
        "pythonrobotics": Convention(_BETA, -1, -1, "PythonRobotics since 2021, move_to_pose.py"),
    }
)
"""From the name of a convention to what it is."""


def translate(polar: tuple[Real, Real, Real], source: str, target: str) -> tuple[Real, Real, Real]:
    """The same (distance in m, angle, third angle in rad) in the convention `target`.

    The third angle changes its sign, or stays; nothing is wrapped, so that a course over time stays
    without jumps. `polar_error` is in "aicardi". Shapes broadcast. Raises ValueError for an unknown
    convention, a negative distance, NaN or mismatched lengths.
    """
    sign = CONVENTIONS[choice("source", source, CONVENTIONS)].third
    sign *= CONVENTIONS[choice("target", target, CONVENTIONS)].third
    listed = isinstance(polar, list | tuple | np.ndarray) and np.iterable(polar)
    if not listed or len(polar) != 3:
        raise refusal("polar", polar, "three numbers or three arrays")
    rho, alpha, third = reals(
        at_least_0=("rho",), **dict(zip(("rho", "alpha", "third angle"), polar, strict=True))
    )
    return rho, alpha, third if sign == 1 else 0.0 - third


def gains_near_goal(gains: Gains, convention: str) -> tuple[Real, Real, Real]:
    """(k_rho, k_alpha, k_beta) [1/s] of the linear law that is the corrected one near the goal.

    That law is v = k_rho rho, omega = k_alpha alpha + k_beta beta, with the convention's third
    angle in place of beta and its sign before k_beta. With lam = v_max k_rho of `gains`, (22) and
    the corrected omega become v = lam rho and omega = (k_alpha + lam) alpha + lam h theta. So h > 0
    is k_beta < 0 for Corke and Siegwart, and their condition k_alpha > k_rho is k_alpha > 0 here.
    Fields may be arrays. Raises ValueError for an unknown convention or what is not Gains.
    """
    signs = CONVENTIONS[choice("convention", convention, CONVENTIONS)]
    instance("gains", gains, Gains)
    lam = gains.v_max * gains.k_rho
    return lam, gains.k_alpha + lam, signs.third * signs.gain * lam * gains.h
