"""Every law, once: a formula and one row in `LAWS`; equations (18), (22) and (24) of the paper.

All else follows from these two: what `control` computes, the compiled loops, the sympy expressions,
the panel's JavaScript and menu, and the C header.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from wmrlib._checks import choice, instance, refusal
from wmrlib._compile import compiled, formula
from wmrlib._vecmath import decay, sinc, sincos
from wmrlib.gains import FIELDS, Gains, KanayamaGains, LinearGains
from wmrlib.kinematics import wrap

# The formulas, one number at a time. A pose law gives v/rho, which is finite at the goal, where the
# polar model divides v by rho; a law for a moving goal gives v.


@formula
def corrected_law(rho, alpha, theta, gains):
    cos_alpha = sincos(alpha)[1]
    v_over_rho = gains.v_max * decay(rho, gains.k_rho) * cos_alpha
    return v_over_rho, gains.k_alpha * alpha + v_over_rho * sinc(alpha) * (alpha + gains.h * theta)


@formula
def printed_law(rho, alpha, theta, gains):
    sin_alpha, cos_alpha = sincos(alpha)
    v_over_rho = gains.v_max * decay(rho, gains.k_rho) * cos_alpha
    steering = sin_alpha * cos_alpha * sinc(alpha) * (alpha + gains.h * theta)
    return v_over_rho, gains.k_alpha * alpha + v_over_rho * steering


@formula
def aicardi_law(rho, alpha, theta, gains):
    v_over_rho = gains.k_rho * sincos(alpha)[1]
    return v_over_rho, gains.k_alpha * alpha + v_over_rho * sinc(alpha) * (alpha + gains.h * theta)


@formula
def kanayama_law(ahead, left, turn, v_ref, omega_ref, gains):
    sin_turn, cos_turn = sincos(turn)
    v = v_ref * cos_turn + gains.k_x * ahead
    return v, omega_ref + v_ref * (gains.k_y * left + gains.k_heading * sin_turn)


@formula
def linear_law(ahead, left, turn, v_ref, omega_ref, gains):
    v = v_ref * sincos(turn)[1] + gains.v_x * ahead + gains.v_y * left + gains.v_heading * turn
    return v, omega_ref + gains.omega_x * ahead + gains.omega_y * left + gains.omega_heading * turn


@formula
def body_error(rho, alpha, theta):
    """The goal in the robot's frame: metres ahead, metres to the left, and its heading."""
    sin_alpha, cos_alpha = sincos(alpha)
    return rho * cos_alpha, rho * sin_alpha, wrap(alpha - theta)


@formula
def lyapunov_value(rho, alpha, theta, h, L):
    return rho * rho / (2.0 * L) + 0.5 * (alpha * alpha + h * theta * theta)


@formula
def pose_value(rho, alpha, theta, gains):
    return lyapunov_value(rho, alpha, theta, gains.h, 1.0)


@formula
def kanayama_value(rho, alpha, theta, gains):
    return 0.5 * rho * rho + (1.0 - sincos(alpha - theta)[1]) / gains.k_y


@formula
def linear_value(rho, alpha, theta, gains):
    """Half the squared error: the law brings no Lyapunov function of its own."""
    turn = wrap(alpha - theta)
    return 0.5 * (rho * rho + turn * turn)


@formula
def fastest_wheel(v, omega, track_width):
    return abs(v) + 0.5 * abs(omega) * track_width


@formula
def saturation_scale(v, omega, wheels):
    """The factor on the twist that brings the faster wheel down to its limit."""
    fastest = fastest_wheel(v, omega, wheels.track_width)
    return wheels.max_speed / fastest if fastest > wheels.max_speed else 1.0


class Law(NamedTuple):
    """A row of `LAWS`.

    `formula` takes (rho, alpha, theta, gains) and returns (v/rho, omega). If the law needs a
    reference it takes (ahead, left, turn, v_ref, omega_ref, gains) and returns (v, omega).
    `value` is its Lyapunov function of (rho, alpha, theta, gains). `title` is for menus. `ignores`
    names the gains that the formula has no use for.
    """

    formula: Callable
    gains: Any  # the type of its gains; Gains if the goal stands still
    title: str
    says: str
    value: Callable = pose_value
    needs_reference: bool = False
    ignores: tuple[str, ...] = ()


_AICARDI = "Aicardi et al. (1995), without a speed limit"
_KANAYAMA = "Kanayama et al. (1990), feed-forward and feedback"
_LINEAR = "feed-forward and a constant matrix, such as `control.lqr` computes"
LAWS = {
    "corrected": Law(corrected_law, Gains, "corrected", "(22), and the omega that the proof needs"),
    "printed": Law(printed_law, Gains, "printed", "(22) and (24) as the paper prints them"),
    "aicardi": Law(aicardi_law, Gains, "Aicardi", _AICARDI, ignores=("v_max",)),
    "kanayama": Law(
        kanayama_law, KanayamaGains, "feed-forward (Kanayama)", _KANAYAMA, kanayama_value, True
    ),
    "linear": Law(linear_law, LinearGains, "feed-forward (matrix)", _LINEAR, linear_value, True),
}
"""Every law, by name. The compiled loops know a law by its place in this table."""
TRACKING_LAWS = {name: code for code, name in enumerate(LAWS)}
POSE_LAWS = {name: code for name, code in TRACKING_LAWS.items() if not LAWS[name].needs_reference}
# Loops take a "tuning": gains of each kind side by side, all 0 but those of the law, and in plain
# tuples, which numba unpacks sooner than named ones.
_KINDS = [*FIELDS]
_UNUSED = tuple((0.0,) * len(fields._fields) for fields in FIELDS.values())
OTHERS = _UNUSED[1:]  # the gains that a pose law has no use for


@formula
def _scaled(rho, v_over_rho, omega):
    return v_over_rho * rho, omega


def _command_of(row: Law) -> str:
    if row.needs_reference:
        return "{formula}(*body_error(rho, alpha, theta), v_ref, omega_ref, {gains})"
    return "_scaled(rho, *{formula}(rho, alpha, theta, {gains}))"


def _by_law(name: str, arguments: str, laws: dict[str, int], call_of) -> Callable:
    """The function of (rho, alpha, theta, `arguments`, law) that makes the call of that law.

    In one expression, because numba takes a tenth of a second for each function, however short.
    """
    cases, known = [], globals() | {fields.__name__: fields for fields in FIELDS.values()}
    for row, code in ((LAWS[each], code) for each, code in laws.items()):
        used = {"formula": f"formula_{code}", "value": f"value_{code}"}
        known |= {used["formula"]: row.formula, used["value"]: row.value}
        gains = f"{FIELDS[row.gains].__name__}(*tuning[{_KINDS.index(row.gains)}])"
        call = call_of(row).format(**used, gains=gains)
        cases.append(f"{call} if law == {code}")
    text = " else ".join(cases).rpartition(" if ")[0]  # the last law needs no condition
    function = eval(f"lambda rho, alpha, theta, {arguments}, law: {text}", known)
    function.__name__ = function.__qualname__ = name
    return function


_rule = _by_law("pose_law", "gains", POSE_LAWS, lambda _: "{formula}(rho, alpha, theta, gains)")
pose_law = formula(_rule)
"""(v/rho, omega) of a pose law: a function of (rho, alpha, theta, gains, law)."""
command = compiled(_by_law("command", "v_ref, omega_ref, tuning", TRACKING_LAWS, _command_of))
"""(v, omega) of any of the laws: of (rho, alpha, theta, v_ref, omega_ref, tuning, law)."""
_rule = _by_law("value", "tuning", TRACKING_LAWS, lambda _: "{value}(rho, alpha, theta, {gains})")
lyapunov_value_of = formula(_rule)
"""Each law's own Lyapunov function with L = 1, of (rho, alpha, theta, tuning, law)."""


def tuning_of(gains, law: str, laws: dict[str, int]) -> tuple[tuple, int]:
    """The gains and the law as the compiled loops take them; ValueError if they don't match."""
    code = laws[choice("law", law, laws)]
    instance("gains", gains, LAWS[law].gains)
    if {*map(type, gains)} != {float}:
        raise refusal("gains", gains, "one number a gain", "; sweep takes arrays of gains")
    place = _KINDS.index(LAWS[law].gains)
    return (*_UNUSED[:place], tuple(gains), *_UNUSED[place + 1 :]), code
