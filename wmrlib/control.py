"""The laws that drive the robot to its goal, and the function that proves they do; equations (18) to (26) of the paper.

Five laws, each written once:

- "corrected": (22) for v, and for omega the law that makes the paper's own proof work;
- "printed": (22) and (24) as the paper prints them, with cos(alpha) sin(alpha) twice in (24);
- "aicardi": the linear law of Aicardi et al. (1995), doi:10.1109/100.388294, without a speed limit;
- "kanayama": Kanayama et al. (1990), doi:10.1109/ROBOT.1990.126006, for a moving reference whose speed it knows;
- "linear": feed-forward and a constant matrix, such as `control.lqr` computes, on the error in the robot's own frame.
"""

from __future__ import annotations

import math

from wmrlib._checks import Real, choice, instance, real, same_shape
from wmrlib._compile import compiled, elementwise, formula
from wmrlib._vecmath import decay, sinc, sincos
from wmrlib.gains import (
    NO_TUNING,
    Gains,
    GainsFields,
    KanayamaGains,
    LinearGains,
    Tuning,
    WheelLimits,
    checked_wheels,
)
from wmrlib.kinematics import polar_closing_rate, wrap

CORRECTED, PRINTED, AICARDI, KANAYAMA, LINEAR = range(5)  # how the compiled loops name the laws
POSE_LAWS = {"corrected": CORRECTED, "printed": PRINTED, "aicardi": AICARDI}
TRACKING_LAWS = POSE_LAWS | {"kanayama": KANAYAMA, "linear": LINEAR}


# The formulas, once each, one number at a time ------------------------------------------------------------------------
# Each law gives pull = v/rho rather than v: it is finite at the goal, where the polar model divides v by rho.


@formula
def corrected_law(rho, alpha, theta, gains):
    cos_alpha = sincos(alpha)[1]
    pull = gains.v_max * decay(rho, gains.k_rho) * cos_alpha
    return pull, gains.k_alpha * alpha + pull * sinc(alpha) * (alpha + gains.h * theta)


@formula
def printed_law(rho, alpha, theta, gains):
    sin_alpha, cos_alpha = sincos(alpha)
    pull = gains.v_max * decay(rho, gains.k_rho) * cos_alpha
    return pull, gains.k_alpha * alpha + pull * sin_alpha * cos_alpha * sinc(alpha) * (
        alpha + gains.h * theta
    )


@formula
def aicardi_law(rho, alpha, theta, gains):
    cos_alpha = sincos(alpha)[1]
    pull = gains.k_rho * cos_alpha
    return pull, gains.k_alpha * alpha + pull * sinc(alpha) * (alpha + gains.h * theta)


@formula
def pose_law(rho, alpha, theta, gains, law):
    if law == CORRECTED:
        return corrected_law(rho, alpha, theta, gains)
    if law == PRINTED:
        return printed_law(rho, alpha, theta, gains)
    return aicardi_law(rho, alpha, theta, gains)


@compiled
def body_error(rho, alpha, theta):
    """The goal in the robot's frame: metres ahead, metres to the left, and how far its heading is turned."""
    sin_alpha, cos_alpha = sincos(alpha)
    return rho * cos_alpha, rho * sin_alpha, wrap(alpha - theta)


@compiled
def kanayama_law(ahead, left, turn, v_ref, omega_ref, gains):
    sin_turn, cos_turn = sincos(turn)
    v = v_ref * cos_turn + gains.k_x * ahead
    return v, omega_ref + v_ref * (gains.k_y * left + gains.k_heading * sin_turn)


@compiled
def linear_law(ahead, left, turn, v_ref, omega_ref, gains):
    v = v_ref * sincos(turn)[1] + gains.v_x * ahead + gains.v_y * left + gains.v_heading * turn
    return v, omega_ref + gains.omega_x * ahead + gains.omega_y * left + gains.omega_heading * turn


@compiled
def command(rho, alpha, theta, v_ref, omega_ref, tuning, law):
    """(v, omega) of any of the laws."""
    if law in (KANAYAMA, LINEAR):
        ahead, left, turn = body_error(rho, alpha, theta)
        if law == KANAYAMA:
            return kanayama_law(ahead, left, turn, v_ref, omega_ref, tuning.kanayama)
        return linear_law(ahead, left, turn, v_ref, omega_ref, tuning.linear)
    pull, omega = pose_law(rho, alpha, theta, tuning.pose, law)
    return pull * rho, omega


@compiled
def pose_tuning(k_rho, k_alpha, h, v_max):
    """A Tuning for one of the pose laws, made inside a compiled loop."""
    return Tuning(GainsFields(k_rho, k_alpha, h, v_max), NO_TUNING.kanayama, NO_TUNING.linear)


@formula
def wheel_share(v, omega, wheels):
    """The share of the twist that the faster wheel, at |v| + |omega| b/2, can follow."""
    fastest = abs(v) + 0.5 * abs(omega) * wheels.track_width
    return wheels.max_speed / fastest if fastest > wheels.max_speed else 1.0


@compiled
def lyapunov_value(rho, alpha, theta, h, L):
    return rho * rho / (2.0 * L) + 0.5 * (alpha * alpha + h * theta * theta)


@compiled
def lyapunov_value_of(rho, alpha, theta, tuning, law):
    """Each law's own Lyapunov function (L = 1); for "linear", which brings none, half the squared error."""
    if law == KANAYAMA:
        return 0.5 * rho * rho + (1.0 - math.cos(alpha - theta)) / tuning.kanayama.k_y
    if law == LINEAR:
        return 0.5 * (rho * rho + wrap(alpha - theta) ** 2)
    return lyapunov_value(rho, alpha, theta, tuning.pose.h, 1.0)


@compiled
def lyapunov_slope(rho, alpha, theta, gains, law, L):
    """(19): the gradient of V times the closed loop's rates."""
    pull, omega = pose_law(rho, alpha, theta, gains, law)
    rho_rate, alpha_rate, theta_rate = polar_closing_rate(rho, alpha, pull, omega)
    return rho * rho_rate / L + alpha * alpha_rate + gains.h * theta * theta_rate


# The same for users: checked, broadcast, described --------------------------------------------------------------------


def control_law(
    rho: Real, alpha: Real, theta: Real, gains: Gains, law: str = "corrected"
) -> tuple[Real, Real]:
    """The twist (v, omega) in m/s and rad/s for the polar error (rho in m, alpha and theta in rad).

    "corrected": v = v_max (1 - exp(-k_rho rho)) cos(alpha), equation (22), and
    omega = k_alpha alpha + v_max (1 - exp(-k_rho rho))/rho cos(alpha) sin(alpha)/alpha (alpha + h theta).
    "printed": omega as in equation (24), with cos(alpha) sin(alpha) once more.
    "aicardi": v = k_rho rho cos(alpha), omega = k_alpha alpha + k_rho cos(alpha) sin(alpha)/alpha (alpha + h theta).

    Finite at rho = 0 and at alpha = 0. All arguments, the gains included, may be arrays that broadcast.
    Raises ValueError for rho < 0, NaN, an unknown law or mismatched lengths.
    """
    state = _checked_state(rho, alpha, theta, gains)
    return elementwise(
        _control_law_all, 2, *state, options=(POSE_LAWS[choice("law", law, POSE_LAWS)],)
    )


def tracking_law(
    rho: Real, alpha: Real, theta: Real, v_ref: Real, omega_ref: Real, gains, law: str = "kanayama"
) -> tuple[Real, Real]:
    """The twist (v, omega) for a goal that itself moves with (v_ref, omega_ref), in m/s and rad/s.

    With the error in the robot's frame, e_x = rho cos(alpha) ahead, e_y = rho sin(alpha) to the left, e_h = wrap(alpha - theta):
    "kanayama": v = v_ref cos(e_h) + k_x e_x, omega = omega_ref + v_ref (k_y e_y + k_heading sin(e_h)), with KanayamaGains;
    "linear": v = v_ref cos(e_h) + K_1 e, omega = omega_ref + K_2 e, with LinearGains.
    Every other law takes Gains and does not look at (v_ref, omega_ref). Shapes broadcast (the gains are single numbers).
    Raises ValueError for rho < 0, NaN, an unknown law, gains of another law or mismatched lengths.
    """
    rho, alpha, theta = real("rho", rho, low=0.0), real("alpha", alpha), real("theta", theta)
    v_ref, omega_ref = real("v_ref", v_ref), real("omega_ref", omega_ref)
    same_shape(rho=rho, alpha=alpha, theta=theta, v_ref=v_ref, omega_ref=omega_ref)
    tuning, code = tuning_of(gains, law, TRACKING_LAWS)
    return elementwise(_command_all, 2, rho, alpha, theta, v_ref, omega_ref, options=(tuning, code))


def lyapunov(rho: Real, alpha: Real, theta: Real, h: Real, L: Real = 1.0) -> Real:
    """V = rho^2/(2 L) + (alpha^2 + h theta^2)/2, equation (18); shapes broadcast.

    Raises ValueError for rho < 0, h < 0, L that is not positive, NaN or mismatched lengths.
    """
    rho, alpha, theta = real("rho", rho, low=0.0), real("alpha", alpha), real("theta", theta)
    h, L = real("h", h, low=0.0), real("L", L, above=0.0)
    same_shape(rho=rho, alpha=alpha, theta=theta, h=h, L=L)
    return elementwise(_lyapunov_value_all, 1, rho, alpha, theta, h, L)[0]


def lyapunov_rate(
    rho: Real, alpha: Real, theta: Real, gains: Gains, law: str = "corrected", L: Real = 1.0
) -> Real:
    """V' along the closed loop: rho rho'/L + alpha alpha' + h theta theta', equation (19), for any of the pose laws.

    For "corrected" it equals -(rho/L) v_max (1 - exp(-k_rho rho)) cos^2(alpha) - k_alpha alpha^2, which is never positive; for
    "printed" it is positive in places. Shapes broadcast. Raises ValueError as `control_law`, and for L that is not positive.
    """
    state, L = _checked_state(rho, alpha, theta, gains), real("L", L, above=0.0)
    same_shape(rho=rho, alpha=alpha, theta=theta, L=L)
    return elementwise(
        _lyapunov_slope_all, 1, *state, L, options=(POSE_LAWS[choice("law", law, POSE_LAWS)],)
    )[0]


def limit_wheels(v: Real, omega: Real, limits: WheelLimits) -> tuple[Real, Real]:
    """The twist (v, omega) scaled so that neither wheel is faster than `limits.max_speed`; the curvature omega/v stays.

    Clipping v and omega (or the wheels) one by one would bend the path; scaling both only slows it down. Shapes broadcast.
    Raises ValueError for NaN, a track width or a speed that is not positive, or mismatched lengths.
    """
    v, omega, limits = real("v", v), real("omega", omega), checked_wheels(limits, "limits")
    same_shape(v=v, omega=omega)
    share = elementwise(_wheel_share_all, 1, v, omega, options=(limits,))[0]
    return v * share, omega * share


def tuning_of(gains, law: str, laws: dict[str, int]) -> tuple[Tuning, int]:
    """The gains and the law as the compiled loops take them; raises ValueError if they don't belong together."""
    code = laws[choice("law", law, laws)]
    kind = _GAINS_OF.get(code, Gains)
    instance("gains", gains, kind)
    if not all(type(field) is float for field in gains):
        raise ValueError(
            f"gains = {gains!r} is not allowed: one number a gain is needed; sweep takes arrays of gains"
        )
    if kind is Gains:
        return Tuning(gains, *NO_TUNING[1:]), code
    return NO_TUNING._replace(**{law: gains}), code


_GAINS_OF = {KANAYAMA: KanayamaGains, LINEAR: LinearGains}


def _checked_state(rho, alpha, theta, gains):
    instance("gains", gains, Gains)
    state = real("rho", rho, low=0.0), real("alpha", alpha), real("theta", theta), *gains
    same_shape(rho=rho, alpha=alpha, theta=theta, **gains._asdict())
    return state


@compiled
def _control_law_all(rho, alpha, theta, k_rho, k_alpha, h, v_max, law, v, omega):
    for i in range(rho.size):
        pull, omega[i] = pose_law(
            rho[i], alpha[i], theta[i], GainsFields(k_rho[i], k_alpha[i], h[i], v_max[i]), law
        )
        v[i] = pull * rho[i]


@compiled
def _command_all(rho, alpha, theta, v_ref, omega_ref, tuning, law, v, omega):
    for i in range(rho.size):
        v[i], omega[i] = command(rho[i], alpha[i], theta[i], v_ref[i], omega_ref[i], tuning, law)


@compiled
def _lyapunov_value_all(rho, alpha, theta, h, L, value):
    for i in range(rho.size):
        value[i] = lyapunov_value(rho[i], alpha[i], theta[i], h[i], L[i])


@compiled
def _lyapunov_slope_all(rho, alpha, theta, k_rho, k_alpha, h, v_max, L, law, slope):
    for i in range(rho.size):
        gains = GainsFields(k_rho[i], k_alpha[i], h[i], v_max[i])
        slope[i] = lyapunov_slope(rho[i], alpha[i], theta[i], gains, law, L[i])


@compiled
def _wheel_share_all(v, omega, limits, share):
    for i in range(v.size):
        share[i] = wheel_share(v[i], omega[i], limits)
