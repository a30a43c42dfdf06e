"""The twist that a law commands, its Lyapunov function and the wheels' limits; (18) to (26).

The formulas stand in `wmrlib.laws`. Here they take arrays and say what is wrong with an argument.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from wmrlib.body import Wheels, checked_wheels
from wmrlib.checks import Real, choice, floats, instance, reals, refusal
from wmrlib.elementary import elementwise
from wmrlib.gains import Gains, GainsFields
from wmrlib.laws import LAWS, POSE_LAWS, lyapunov_value, saturation_scale, tuning_of
from wmrlib.motion import polar_closing_rate


def control_law(
    rho: Real, alpha: Real, theta: Real, gains: Gains, law: str = "corrected"
) -> tuple[Real, Real]:
    """The twist that a pose law commands, (22) and (24); finite at rho = 0 and at alpha = 0.

    Parameters
    ----------
    rho, alpha, theta : float or array; m, rad, rad. The polar error.
    gains : Gains, whose fields may be arrays that broadcast with the polar error.
    law : "corrected": v = v_max (1 - exp(-k_rho rho)) cos(alpha) and
        omega = k_alpha alpha + v/rho sin(alpha)/alpha (alpha + h theta); "printed": with
        cos(alpha) sin(alpha) once more in omega; "aicardi": with v = k_rho rho cos(alpha);
        "barrier": as "corrected", with 2 tan(x/2) for either angle x in V; "graceful": Nav2's
        curvature, omega/v = (k_alpha z + (1 + h/(1 + (h theta)^2)) sin(alpha))/rho, where
        z = alpha + atan(h theta), with v = v_max (1 - exp(-k_rho rho)).

    Returns
    -------
    v, omega : float or array; m/s, rad/s

    Raises
    ------
    ValueError : for rho < 0, NaN, an unknown law or mismatched lengths.

    Examples
    --------
    >>> import wmrlib as wmr
    >>> gains = wmr.Gains(k_rho=2.0, k_alpha=1.0, h=0.3, v_max=4.0)
    >>> v, omega = wmr.control_law(rho=2.0, alpha=0.0, theta=0.5, gains=gains)
    >>> print(f"{v:.2f} m/s, {omega:.2f} rad/s")  # straight ahead, it turns for the heading
    3.93 m/s, 0.29 rad/s
    """
    tuned = instance("gains", gains, Gains)._asdict()
    state = _checked(rho=rho, alpha=alpha, theta=theta, **tuned)
    v_over_rho, omega = elementwise(_law(law), *state)
    return v_over_rho * state[0], omega


def closed_loop(
    gains: Gains | Any, law: str | Callable = "corrected"
) -> Callable[[float, np.ndarray], np.ndarray]:
    """The closed loop as a function f(t, state) of a state (rho, alpha, theta), (7) to (9).

    scipy's `solve_ivp` takes it as it is, and python-control in one line:
    `control.nlsys(lambda t, x, u, params: f(t, x), inputs=0, states=3)`.

    Parameters
    ----------
    gains : Gains of numbers; for a law of your own whatever it understands
    law : as for `control_law`, or a function (rho, alpha, theta, gains) -> (v, omega)

    Returns
    -------
    A function of a time [s], on which nothing depends, and a state [m, rad, rad], or one a column.
    It returns the rates [m/s, rad/s, rad/s] in the state's shape. With a law of your own, rho must
    not be 0.

    Raises
    ------
    ValueError : an unknown law, or gains that are not its own

    Examples
    --------
    >>> import numpy as np
    >>> import wmrlib as wmr
    >>> rates = wmr.closed_loop(wmr.GENTLE_GAINS)
    >>> print(rates(0.0, np.array([10.0, 0.0, 1.0])).round(2))  # straight ahead, at 3.46 m/s
    [-3.46 -0.69  0.  ]
    """
    law_in_loop: Any = tuning_of(gains, law, POSE_LAWS)[1]  # it refuses wrong gains

    def rates(t: float, state: np.ndarray) -> np.ndarray:
        error = floats("state", state, "rho, alpha and theta")
        if len(np.atleast_1d(error)) != 3:
            raise refusal("state", state, "rho, alpha and theta")
        rho, alpha, theta = error
        if callable(law):
            twists = [law_in_loop(*column, gains) for column in error.reshape(3, -1).T]
            v, omega = np.reshape(np.transpose(twists), (2, *error.shape[1:]))
            v_over_rho = v / np.where(rho == 0.0, math.nan, rho)
        else:
            v_over_rho, omega = elementwise(_law(law), rho, alpha, theta, *gains)
        return np.array(elementwise(polar_closing_rate, rho, alpha, v_over_rho, omega))

    return rates


def lyapunov(rho: Real, alpha: Real, theta: Real, h: Real, L: Real = 1.0) -> Real:
    """V = rho^2/(2 L) + (alpha^2 + h theta^2)/2, equation (18).

    Parameters
    ----------
    rho, alpha, theta, h, L : float or array; m, rad, rad, no unit, m^2

    Returns
    -------
    V : float or array; no unit

    Raises
    ------
    ValueError : for rho < 0, h < 0, L that is not positive, NaN or mismatched lengths.

    Examples
    --------
    >>> import wmrlib as wmr
    >>> wmr.lyapunov(rho=2.0, alpha=1.0, theta=1.0, h=0.5)
    2.75
    """
    state = _checked(rho=rho, alpha=alpha, theta=theta, h=h, L=L)
    return elementwise(lyapunov_value, *state)


def lyapunov_rate(
    rho: Real, alpha: Real, theta: Real, gains: Gains, law: str = "corrected", L: Real = 1.0
) -> Real:
    """V' = rho rho'/L + alpha alpha' + h theta theta', (19), along a pose law's closed loop.

    For "corrected" it is -(rho/L) v_max (1 - exp(-k_rho rho)) cos^2(alpha) - k_alpha alpha^2, which
    is never positive; for "printed" it is positive in places.

    Parameters
    ----------
    rho, alpha, theta, gains, law, L : as for `control_law` and `lyapunov`.

    Returns
    -------
    V' : float or array; 1/s

    Raises
    ------
    ValueError : as `control_law`, and for L that is not positive.

    Examples
    --------
    >>> import wmrlib as wmr
    >>> for law in "corrected", "printed":
    ...     rate = wmr.lyapunov_rate(0.1, 0.5, 2.0, wmr.paper.OUTDOOR_GAINS, law)
    ...     print(f"{law}: {rate:.2f} 1/s")
    corrected: -0.31 1/s
    printed: 1.64 1/s
    """
    tuned = instance("gains", gains, Gains)._asdict()
    state = _checked(rho=rho, alpha=alpha, theta=theta, **tuned, L=L)
    rho, alpha, theta, *_, h, _, L = state
    v_over_rho, omega = elementwise(_law(law), *state[:-1])
    rates = elementwise(polar_closing_rate, rho, alpha, v_over_rho, omega)
    return rho * rates[0] / L + (alpha * rates[1] + h * theta * rates[2])


def limit_wheels(v: Real, omega: Real, limits: Wheels) -> tuple[Real, Real]:
    """Scale a twist down until no wheel exceeds its speed limit; the curvature omega/v stays.

    Parameters
    ----------
    v, omega, limits : float or array, m/s; float or array, rad/s; Wheels

    Returns
    -------
    v, omega : float or array; m/s, rad/s

    Raises
    ------
    ValueError : for NaN, a width or speed that is not positive, or mismatched lengths.

    Examples
    --------
    >>> import wmrlib as wmr
    >>> limits = wmr.Wheels(track_width=1.0, max_speed=2.0)
    >>> wmr.limit_wheels(v=3.0, omega=2.0, limits=limits)  # the outer wheel would need 4 m/s
    (1.5, 1.0)
    """
    v, omega = reals(v=v, omega=omega)
    limits = checked_wheels(limits, "limits")
    scale = elementwise(lambda *twist: saturation_scale(*twist, limits), v, omega)
    return v * scale, omega * scale


def _checked(**state: Real) -> list[Real]:
    return reals(at_least_0=("rho", "h"), above_0=("L",), **state)


def _law(law: str) -> Callable:
    """The law as a formula of the polar error and four gains."""
    row = LAWS[choice("law", law, POSE_LAWS)]
    return lambda rho, alpha, theta, *gains: row.formula(rho, alpha, theta, GainsFields(*gains))
