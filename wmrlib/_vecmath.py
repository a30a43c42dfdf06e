"""The elementary functions that the laws are made of, finite where the textbook's form divides by zero."""

from __future__ import annotations

import math

from wmrlib._compile import compiled

_SMALL = 1e-8  # below this, the next term of the series is under half a unit in the last place


@compiled
def sincos(angle):
    """The sine and the cosine of `angle` [rad]."""
    return math.sin(angle), math.cos(angle)


@compiled
def sinc(angle):
    """sin(angle)/angle, which is 1 at 0 (not numpy's sinc, which has a pi inside)."""
    return math.sin(angle) / angle if abs(angle) > _SMALL else 1.0


@compiled
def decay(rho, k_rho):
    """(1 - exp(-k_rho rho))/rho, which is k_rho at rho = 0."""
    x = k_rho * rho
    return -math.expm1(-x) / rho if abs(x) > _SMALL else k_rho * (1.0 - 0.5 * x)
