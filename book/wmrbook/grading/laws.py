"""Checks of the control law: its values, its limits at the goal, and what the proof asks of it."""

from __future__ import annotations

import math
from collections.abc import Callable

from wmrbook.grading._asking import ask_numbers
from wmrbook.grading._hints import close, drawn, expect, explain, own_work, rule_out, slip, spread
from wmrlib.control import control_law, lyapunov_rate
from wmrlib.gains import Gains
from wmrlib.kinematics import polar_rate

State = tuple[float, float, float]


def law_known(law: Callable[..., tuple[float, float]]) -> str:
    """law(rho, alpha, theta, k_rho, k_alpha, h, v_max): (v, omega), (22) and (4.6)."""
    own_work(law)
    for state, gains in _states(40):
        rho, alpha, theta = state
        (v, omega), right = ask_numbers(law, 2, *state, *gains), control_law(*state, gains)
        if not close(v, right[0]):
            aicardi, far = control_law(*state, gains, "aicardi")[0], gains.v_max * math.cos(alpha)
            degrees = control_law(rho, math.radians(alpha), theta, gains)[0]
            away = "with the goal behind, the robot would drive away from it."
            mistakes = {
                f"v lacks its cosine: {away}": right[0] / math.cos(alpha),
                "v grows with the distance without a limit: (22) has an exponential.": aicardi,
                "v does not fall near the goal: (22) has an exponential.": far,
                "this cosine takes radians for degrees: alpha comes in radians.": degrees,
            }
            rule_out(v, mistakes)
            slip((v, omega), right, "(v, omega)")
            expect(False, "v is not that of (22).")
        if not close(omega, right[1]):
            _explain_omega(omega, state, gains)
    return "The law commands what it should, ahead and back, left and right."


def law_goal(law: Callable[..., tuple[float, float]]) -> str:
    """It is finite and right at alpha = 0 and rho = 0, and a hair's breadth beside both."""
    own_work(law)
    gains, theta = Gains(k_rho=2.0, k_alpha=1.0, h=0.3, v_max=4.0), 0.7
    for small in (*spread(1e-16, 0.1, 80), 1e-30, 0.0):
        for rho, alpha in ((2.0, small), (2.0, -small), (small, 0.5), (small, small)):
            near = 3e-3 if rho < 1.0 else 1e-5
            v, omega = ask_numbers(law, 2, rho, alpha, theta, *gains)
            right = control_law(rho, alpha, theta, gains)
            where = f"at rho = {rho:.2g}, alpha = {alpha:.2g}:"
            hint = f"v is {v:.4g} {where} put that distance and that angle into (22)."
            expect(close(v, right[0], near, 1e-5), hint)
            hint = f"omega jumps to {omega:.4g} {where} what do sin(alpha)/alpha and "
            hint += "(1 - exp(-k_rho rho))/rho tend to? And 1 - exp(-x) loses its digits "
            hint += "for a small x; `math.expm1` does not."
            expect(close(omega, right[1], near, 1e-9), hint)
    turning = control_law(0.0, 0.0, theta, gains)[1]
    where = "Finite everywhere: on the goal, 40 deg off,"
    return f"{where} it still turns at {turning:.2f} rad/s."


def law_properties(law: Callable[..., tuple[float, float]]) -> str:
    """V never rises, a mirrored start turns the other way, and no speed is above v_max."""
    own_work(law)
    slopes = []
    for (rho, alpha, theta), gains in _states(200):
        v, omega = ask_numbers(law, 2, rho, alpha, theta, *gains)
        mirrored = ask_numbers(law, 2, rho, -alpha, -theta, *gains)
        hint = "in the mirror (alpha and theta negative) v must stay and omega be the opposite."
        expect(close(mirrored[0], v) and close(mirrored[1], -omega), hint)
        expect(abs(v) <= gains.v_max, f"v is {v:.3g} m/s, and v_max is {gains.v_max:.3g} m/s.")
        weights, rates = (rho, alpha, gains.h * theta), polar_rate(rho, alpha, v, omega)
        slope = sum(weight * rate for weight, rate in zip(weights, rates, strict=True))
        hint = f"V rises, by {slope:.2g} a second, in a random state: "
        expect(slope <= 1e-9, hint + "the proof of chapter 4 does not hold for this law.")
        slopes.append(slope)
    right = [lyapunov_rate(*state, gains) for state, gains in _states(200)]
    expect(all(map(close, slopes, right)), "V falls, but not by what (4.7) says.")
    return f"V falls in all of {len(slopes)} states, by up to {-min(slopes):.0f} a second."


def _explain_omega(omega: float, state: State, gains: Gains) -> None:
    rho, alpha, theta = state
    first, second = gains.k_alpha * alpha, control_law(*state, gains._replace(k_alpha=0.0))[1]
    away = control_law(rho, alpha, -theta, gains)[1]
    blind = control_law(*state, gains._replace(h=0.0))[1]
    mistakes = {
        "omega is that of (24) as printed, with cos(alpha) sin(alpha) twice: "
        "V would rise in places.": control_law(*state, gains, "printed")[1],
        "the term with h has the wrong sign: this robot turns away from the approach.": away,
        "the term k_alpha alpha is missing.": second,
        "theta plays no role in omega: it would park with any heading.": blind,
    }
    rule_out(omega, mistakes)
    slip(omega, control_law(*state, gains)[1])
    mistakes = {
        "the second term is not divided by rho: compare its unit with the first's.": rho,
        "the second term is not divided by alpha: sin(alpha)/alpha, not sin(alpha).": alpha,
        "the second term has a cosine too many: v has one already.": math.cos(alpha),
        "the second term lacks a cosine: it is v/rho with the v of (22).": 1.0 / math.cos(alpha),
    }
    mistakes = {hint: first + second * factor for hint, factor in mistakes.items()}
    explain(
        omega, mistakes, "v is right and omega is not: compare it with (4.6), factor by factor."
    )


def _states(count: int) -> list[tuple[State, Gains]]:
    """States away from the goal, each with gains of its own."""
    gains = (0.2, 2.0), (0.5, 3.0), (0.2, 3.0), (0.5, 5.0)
    rows = drawn(12, count, (0.1, 20.0), (-3.0, 3.0), (-3.0, 3.0), *gains)
    return [(tuple(row[:3]), Gains(*row[3:])) for row in rows if abs(row[1]) > 0.05]
