"""How the angles settle near the goal; each formula takes numbers, arrays or sympy symbols.

`rate` is the distance's: v_max k_rho, or k_rho for Aicardi's law. The angles' characteristic
equation is s^2 + k_alpha s + h rate^2 = 0. For symbols, replace this module's `sqrt` and `where`
by sympy's square root and a Piecewise.
"""

from numpy import sqrt, where


def mode_frequency(rate, h):
    """Natural frequency, rad/s."""
    return rate * sqrt(h)


def mode_damping(rate, k_alpha, h):
    """Damping ratio."""
    return k_alpha / (2 * rate * sqrt(h))


def mode_settling(rate, k_alpha, h):
    """Rate at which the slower of the two modes decays, 1/s."""
    half, stiffness = k_alpha / 2, h * rate * rate
    gap = half * half - stiffness
    # The second form of half - sqrt(gap) does not cancel.
    return where(gap > 0, stiffness / (half + sqrt(gap)), half)
