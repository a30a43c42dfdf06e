"""The polar error in other authors' signs, and their linear law's gains: who writes theta, who writes beta = -theta.

All of them turn with the law omega = k_alpha alpha + (sign) k_beta beta, and mean the same robot; only the third angle's sign, and with it
the sign of its gain, differs. Aicardi's signs, which the paper's (7)-(9) have, are those of the rest of wmrlib.
"""

from __future__ import annotations

from types import MappingProxyType
from typing import NamedTuple

from wmrlib._checks import Real, choice, instance, real, same_shape
from wmrlib.gains import Gains


class Convention(NamedTuple):
    """How an author writes the polar error.

    symbols: of the distance, of the angle from the heading to the line of sight, and of the third angle; third: +1 if that is theta,
    from the goal's heading to the line of sight, -1 if it is beta, from the line of sight to the goal's heading; gain: the sign that the
    author's law has before the third angle's gain; source: where it stands.
    """

    symbols: tuple[str, str, str]
    third: int
    gain: int
    source: str


CONVENTIONS = MappingProxyType(
    {
        "aicardi": Convention(
            ("e", "alpha", "theta"), 1, 1, "Aicardi et al. (1995), doi:10.1109/100.388294"
        ),
        "corke": Convention(
            ("rho", "alpha", "beta"), -1, 1, "Corke (2023), doi:10.1007/978-3-031-06469-2"
        ),
        "siegwart": Convention(
            ("rho", "alpha", "beta"), -1, 1, "Siegwart et al. (2011), section 3.6.2"
        ),
        "pythonrobotics": Convention(
            ("rho", "alpha", "beta"), -1, -1, "PythonRobotics, move_to_pose.py"
        ),
    }
)
"""From the name of a convention to what it is."""


def translate(polar: tuple[Real, Real, Real], source: str, target: str) -> tuple[Real, Real, Real]:
    """The same (distance in m, angle in rad, third angle in rad), written in the convention `target` instead of `source`.

    The third angle changes its sign, beta = -theta, or stays; nothing is wrapped, so that a course over time stays without jumps and the
    way back gives the same numbers. `polar_error` is in "aicardi". Shapes broadcast.
    Raises ValueError for an unknown convention, a negative distance, NaN or mismatched lengths.
    """
    signs = [
        CONVENTIONS[choice(name, value, CONVENTIONS)].third
        for name, value in (("source", source), ("target", target))
    ]
    rho, alpha, third = (
        real("rho", polar[0], low=0.0),
        real("alpha", polar[1]),
        real("third angle", polar[2]),
    )
    same_shape(rho=rho, alpha=alpha, **{"third angle": third})
    return rho, alpha, third if signs[0] == signs[1] else 0.0 - third


def gains_near_goal(gains: Gains, convention: str) -> tuple[Real, Real, Real]:
    """(k_rho, k_alpha, k_beta) in 1/s of the linear law that does near the goal what the corrected law does with `gains`.

    That law is v = k_rho rho, omega = k_alpha alpha + k_beta beta, with the convention's third angle in place of beta and its sign before
    k_beta. With lam = v_max k_rho of `gains`, (22) and the corrected omega become v = lam rho and
    omega = (k_alpha + lam) alpha + lam h theta. So h > 0 is k_beta < 0 for Corke and Siegwart, and their condition k_alpha > k_rho is
    k_alpha > 0 here. Fields may be arrays. Raises ValueError for an unknown convention or what is not Gains.
    """
    how = CONVENTIONS[choice("convention", convention, CONVENTIONS)]
    instance("gains", gains, Gains)
    lam = gains.v_max * gains.k_rho
    return lam, gains.k_alpha + lam, how.third * how.gain * lam * gains.h
