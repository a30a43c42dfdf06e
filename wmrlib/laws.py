"""Every law, once: a formula, a row in `LAWS`, a number, a line in `pose_law`; (18), (22), (24).

All else follows from these: what `control` computes, the compiled loops, the sympy expressions, the
panel's JavaScript and menu, and the C header.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numba

from wmrlib.checks import choice, instance, refusal
from wmrlib.compilation import chosen_by_type, compiled_by_its_user, formula
from wmrlib.elementary import decay, direction, share_of, sinc, sincos, wrap
from wmrlib.gains import (
    Gains,
    GainsFields,
    KanayamaFields,
    KanayamaGains,
    LinearFields,
    LinearGains,
)

# The formulas. A pose law takes the polar error (m, rad, rad) and returns v/rho [1/s] and omega
# [rad/s]: the polar model divides v by rho, and v/rho is finite at the goal. A law for a moving
# goal takes the error in the robot's frame (m, m, rad) and the reference's twist, and returns a
# twist.


@formula
def corrected_law(rho, alpha, theta, gains):
    """(22), with the omega for which the paper's proof holds."""
    cos_alpha = sincos(alpha)[1]
    v_over_rho = gains.v_max * decay(rho, gains.k_rho) * cos_alpha
    return v_over_rho, gains.k_alpha * alpha + v_over_rho * sinc(alpha) * (alpha + gains.h * theta)


@formula
def printed_law(rho, alpha, theta, gains):
    """(22) and (24) as the paper prints them."""
    sin_alpha, cos_alpha = sincos(alpha)
    v_over_rho = gains.v_max * decay(rho, gains.k_rho) * cos_alpha
    steering = sin_alpha * cos_alpha * sinc(alpha) * (alpha + gains.h * theta)
    return v_over_rho, gains.k_alpha * alpha + v_over_rho * steering


@formula
def aicardi_law(rho, alpha, theta, gains):
    """The law of Aicardi et al. (1995), whose speed grows with rho without a limit."""
    v_over_rho = gains.k_rho * sincos(alpha)[1]
    return v_over_rho, gains.k_alpha * alpha + v_over_rho * sinc(alpha) * (alpha + gains.h * theta)


@formula
def barrier_law(rho, alpha, theta, gains):
    """A law after Todorovski et al. (2025), which keeps alpha and theta within half a turn."""
    sin_alpha, cos_alpha = sincos(alpha)
    sin_half, cos_half = sincos(0.5 * theta)
    facing = 0.25 * (1.0 + cos_alpha) * (1.0 + cos_alpha)  # cos(alpha/2)^4
    v_over_rho = gains.v_max * decay(rho, gains.k_rho) * cos_alpha
    heading = 2.0 * gains.h * sin_half / (cos_half * cos_half * cos_half)
    return v_over_rho, gains.k_alpha * sin_alpha + v_over_rho * (sin_alpha + facing * heading)


@formula
def graceful_law(rho, alpha, theta, gains):
    """The law of Park and Kuipers (2011), as in Nav2."""
    sin_alpha = sincos(alpha)[0]
    v_over_rho = gains.v_max * decay(rho, gains.k_rho)
    tangent = gains.h * theta
    follow = gains.k_alpha * (alpha + direction(tangent, 1.0))
    approach = (1.0 + gains.h / (1.0 + tangent * tangent)) * sin_alpha
    return v_over_rho, v_over_rho * (follow + approach)


@formula
def kanayama_law(ahead, left, turn, v_ref, omega_ref, gains):
    """The law of Kanayama et al. (1990): feed-forward and nonlinear feedback."""
    sin_turn, cos_turn = sincos(turn)
    v = v_ref * cos_turn + gains.k_x * ahead
    return v, omega_ref + v_ref * (gains.k_y * left + gains.k_heading * sin_turn)


@formula
def linear_law(ahead, left, turn, v_ref, omega_ref, gains):
    """Feed-forward and feedback by a constant 2 x 3 matrix."""
    v = v_ref * sincos(turn)[1] + gains.v_x * ahead + gains.v_y * left + gains.v_heading * turn
    return v, omega_ref + gains.omega_x * ahead + gains.omega_y * left + gains.omega_heading * turn


@formula
def body_error(rho, alpha, theta):
    """The goal in the robot's frame: metres ahead, metres to the left, and its heading."""
    sin_alpha, cos_alpha = sincos(alpha)
    return rho * cos_alpha, rho * sin_alpha, wrap(alpha - theta)


@formula
def lyapunov_value(rho, alpha, theta, h, L):
    """V of (18), no unit."""
    return rho * rho / (2.0 * L) + 0.5 * (alpha * alpha + h * theta * theta)


@formula
def pose_value(rho, alpha, theta, gains):
    """V of (18) with L = 1 m^2."""
    return lyapunov_value(rho, alpha, theta, gains.h, 1.0)


@formula
def barrier_value(rho, alpha, theta, gains):
    """V of (18) with 2 tan(x/2) in place of each angle x, infinite at half a turn."""
    sin_alpha, cos_alpha = sincos(0.5 * alpha)
    sin_theta, cos_theta = sincos(0.5 * theta)
    tan_alpha, tan_theta = sin_alpha / cos_alpha, sin_theta / cos_theta
    return lyapunov_value(rho, 2.0 * tan_alpha, 2.0 * tan_theta, gains.h, 1.0)


@formula
def graceful_value(rho, alpha, theta, gains):
    """Half the square of alpha + atan(k_phi theta), rad^2, whatever rho is."""
    away = alpha + direction(gains.h * theta, 1.0)
    return 0.5 * away * away


@formula
def kanayama_value(rho, alpha, theta, gains):
    """The Lyapunov function of Kanayama et al., m^2."""
    return 0.5 * rho * rho + (1.0 - sincos(alpha - theta)[1]) / gains.k_y


@formula
def linear_value(rho, alpha, theta, gains):
    """Half the squared error, m^2 plus rad^2: the law has no Lyapunov function of its own."""
    turn = wrap(alpha - theta)
    return 0.5 * (rho * rho + turn * turn)


@formula
def fastest_wheel(v, omega, track_width):
    """The speed of the faster wheel, m/s."""
    return abs(v) + 0.5 * abs(omega) * track_width


@formula
def saturation_scale(v, omega, wheels):
    """The factor on the twist that brings the faster wheel down to its limit."""
    return share_of(fastest_wheel(v, omega, wheels.track_width), wheels.max_speed)


class Law(NamedTuple):
    """A control law with its gains and its Lyapunov function: a row of `LAWS`.

    `formula` takes (rho, alpha, theta, gains) and returns (v/rho, omega). If the law needs a
    reference it takes (ahead, left, turn, v_ref, omega_ref, gains) and returns (v, omega).
    `gains` is the type of its gains. `value` is its Lyapunov function of (rho, alpha, theta,
    gains). `title` and `says` are its name and its source, for menus and printed code. `ignores`
    names the gains that the formula does not use.
    """

    formula: Callable
    gains: Any
    title: str
    says: str
    value: Callable = pose_value
    needs_reference: bool = False
    ignores: tuple[str, ...] = ()


_AICARDI = "Aicardi et al. (1995), without a speed limit"
_BARRIER = "after Todorovski et al. (2025): never crosses half a turn of alpha or theta"
_GRACEFUL = "Park and Kuipers (2011), as in Nav2: k_alpha is their k_delta, h their k_phi"
_KANAYAMA = "Kanayama et al. (1990), feed-forward and feedback"
_LINEAR = "feed-forward and a constant matrix, such as `control.lqr` computes"
LAWS = {
    "corrected": Law(corrected_law, Gains, "corrected", "(22), and the omega that the proof needs"),
    "printed": Law(printed_law, Gains, "printed", "(22) and (24) as the paper prints them"),
    "aicardi": Law(aicardi_law, Gains, "Aicardi", _AICARDI, ignores=("v_max",)),
    "barrier": Law(barrier_law, Gains, "barrier", _BARRIER, barrier_value),
    "graceful": Law(graceful_law, Gains, "Graceful (Nav2)", _GRACEFUL, graceful_value),
    "kanayama": Law(
        kanayama_law, KanayamaGains, "feed-forward (Kanayama)", _KANAYAMA, kanayama_value, True
    ),
    "linear": Law(linear_law, LinearGains, "feed-forward (matrix)", _LINEAR, linear_value, True),
}
"""Every law, by name."""
MOST_GAINS = max(len(row.gains._fields) for row in LAWS.values())
TRACKING_LAWS = {name: code for code, name in enumerate(LAWS)}
POSE_LAWS = {name: code for name, code in TRACKING_LAWS.items() if not LAWS[name].needs_reference}


# Loops know a law by its place in `LAWS`, and its gains as numbers, in the order of their type's
# fields, with zeros behind them.
CORRECTED, PRINTED, AICARDI, BARRIER, GRACEFUL, KANAYAMA, LINEAR = range(len(LAWS))


@formula
def pose_law(rho, alpha, theta, gains, law):
    """(v/rho, omega) of a pose law, which is given by its number."""
    if law == CORRECTED:
        return corrected_law(rho, alpha, theta, gains)
    if law == PRINTED:
        return printed_law(rho, alpha, theta, gains)
    if law == BARRIER:
        return barrier_law(rho, alpha, theta, gains)
    if law == GRACEFUL:
        return graceful_law(rho, alpha, theta, gains)
    if law == AICARDI:
        return aicardi_law(rho, alpha, theta, gains)
    return math.nan, math.nan  # a law without a line here ends each run at once


def command(rho, alpha, theta, v_ref, omega_ref, gains, law):
    """(v, omega) of a law: one of `LAWS`, by its number, or a function of one's own."""
    law_of = _own_law if callable(law) else _built_in_law
    return law_of(rho, alpha, theta, v_ref, omega_ref, gains, law)


@formula
def _built_in_law(rho, alpha, theta, v_ref, omega_ref, gains, law):
    if law < KANAYAMA:
        v_over_rho, omega = pose_law(rho, alpha, theta, GainsFields(*gains[:4]), law)
        return v_over_rho * rho, omega
    ahead, left, turn = body_error(rho, alpha, theta)
    if law == KANAYAMA:
        return kanayama_law(ahead, left, turn, v_ref, omega_ref, KanayamaFields(*gains[:3]))
    return linear_law(ahead, left, turn, v_ref, omega_ref, LinearFields(*gains))


@formula
def _own_law(rho, alpha, theta, v_ref, omega_ref, gains, law):
    return law(rho, alpha, theta, gains)


@chosen_by_type(command)
def _(rho, alpha, theta, v_ref, omega_ref, gains, law):
    return _built_in_law if isinstance(law, numba.types.Integer) else _own_law


def tuning_of(gains, law: str | Callable, laws: dict[str, int]) -> tuple[Any, int | Callable]:
    """The gains and the law as the loops take them; ValueError if they don't match.

    A function of one's own takes its gains as they are.
    """
    if callable(law):
        return gains, own_law(law)
    code = laws[choice("law", law, laws, OWN_IS_WELCOME)]
    instance("gains", gains, LAWS[law].gains)
    if {*map(type, gains)} != {float}:
        raise refusal("gains", gains, "one number a gain", "; sweep takes arrays of gains")
    numbers = (*gains, *(0.0,) * (MOST_GAINS - len(gains)))
    command(1.0, 0.5, 0.2, 0.0, 0.0, numbers, code)  # a slip in a formula is Python's own error
    return numbers, code


_OWN = "a function (rho, alpha, theta, gains) -> (v, omega)"
OWN_IS_WELCOME = f", or {_OWN},"


_TEXT = str, bytes, bytearray
_UNORDERED = dict, set, frozenset  # which number would be v?


class OwnLaw(NamedTuple):
    """A law of one's own in plain Python, whose every answer is checked."""

    function: Callable

    def __call__(self, rho: float, alpha: float, theta: float, gains: Any) -> tuple[float, float]:
        twist = self.function(float(rho), float(alpha), float(theta), gains)
        try:
            v, omega = twist
            text = any(isinstance(value, _TEXT) for value in (twist, v, omega))
            refused = text or isinstance(twist, _UNORDERED)
            v, omega = (math.nan, math.nan) if refused else (float(v), float(omega))
        except (TypeError, ValueError):
            v = omega = math.nan
        if math.isnan(v) or math.isnan(omega):
            place = f"rho = {rho:.6g}, alpha = {alpha:.6g}, theta = {theta:.6g}"
            what = f"{law_name(self.function)} at {place}"
            raise refusal(what, twist, "a pair of numbers, v in m/s and omega in rad/s,")
        return v, omega


def own_law(law: Callable) -> Any:
    """A law of one's own as the loops take it: as it is if numba has compiled it.

    ValueError shows the parameters of a function that does not take these four.
    """
    try:
        signature = inspect.signature(getattr(law, "py_func", law))
    except (TypeError, ValueError):  # of a function in C, for example
        signature = None
    try:
        if signature:
            signature.bind("rho", "alpha", "theta", "gains")
    except TypeError:
        given = f"law = {law_name(law)}{signature}"
        raise ValueError(f"{given} is not allowed: {_OWN} is needed") from None
    return law if compiled_by_its_user(law) else OwnLaw(law)


def law_name(law: str | Callable) -> str:
    """The name of a law for the reader, one's own included."""
    law = law.function if isinstance(law, OwnLaw) else law
    return law if isinstance(law, str) else getattr(law, "__name__", type(law).__name__)
