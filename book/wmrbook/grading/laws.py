"""Checks of the control law: its values, its limits at the goal, and what the proof asks of it."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from wmrbook.grading._hints import Passed, ask_numbers, close, expect, own_work
from wmrlib.control import control_law, lyapunov_rate
from wmrlib.gains import Gains
from wmrlib.kinematics import polar_rate

State = tuple[float, float, float]


def law_known(law: Callable[..., tuple[float, float]]) -> Passed:
    """law(rho, alpha, theta, k_rho, k_alpha, h, v_max): (v, omega), (22) and (4.6), away from the goal."""
    own_work(law)
    for state, gains in _states(40):
        value, right = ask_numbers(law, 2, *state, *gains), control_law(*state, gains)
        if not close(value[0], right[0]):
            expect(
                not close(value[0] * math.cos(state[1]), right[0]),
                "v lacks its cosine: with the goal behind, the robot would drive away from it.",
            )
            expect(
                not close(value[0], control_law(*state, gains, "aicardi")[0]),
                "v grows with the distance without a limit: (22) has an exponential.",
            )
            expect(
                not close(value[0], gains.v_max * math.cos(state[1])),
                "v does not fall near the goal: (22) has an exponential.",
            )
            degrees = control_law(state[0], math.radians(state[1]), state[2], gains)[0]
            expect(
                not close(value[0], degrees),
                "this cosine takes radians for degrees: alpha comes in radians.",
            )
            expect(False, "v is not that of (22).")
        if not close(value[1], right[1]):
            _explain_omega(value[1], state, gains)
    return Passed("The law commands what it should, ahead and back, left and right.")


def law_goal(law: Callable[..., tuple[float, float]]) -> Passed:
    """It is finite and right with the goal straight ahead (alpha = 0), on the goal (rho = 0), and a hair's breadth beside both."""
    own_work(law)
    gains = Gains(k_rho=2.0, k_alpha=1.0, h=0.3, v_max=4.0)
    for small in (0.0, 1e-3, 1e-6, 1e-9, 1e-12, 1e-15, 1e-30):
        for state in (
            (2.0, small, 0.7),
            (2.0, -small, 0.7),
            (small, 0.5, 0.7),
            (small, small, 0.7),
        ):
            value, right = ask_numbers(law, 2, *state, *gains), control_law(*state, gains)
            where = f"rho = {state[0]:g}, alpha = {state[1]:g}"
            expect(
                close(value[0], right[0], 3e-3, 1e-5),
                f"v is {value[0]:.4g} at {where}: put that distance and that angle into (22).",
            )
            expect(
                close(value[1], right[1], 3e-3, 1e-9),
                f"omega jumps to {value[1]:.4g} at {where}: what do sin(alpha)/alpha and (1 - exp(-k_rho rho))/rho tend to? "
                "And 1 - exp(-x) loses its digits for a small x; `math.expm1` does not.",
            )
    turning = control_law(0.0, 0.0, 0.7, gains)[1]
    return Passed(
        f"Finite everywhere: on the goal, 40 deg off, it still turns at {turning:.2f} rad/s."
    )


def law_properties(law: Callable[..., tuple[float, float]]) -> Passed:
    """V never rises, a mirrored start turns the other way, and no speed is above v_max."""
    own_work(law)
    slopes = []
    for state, gains in _states(200):
        v, omega = ask_numbers(law, 2, *state, *gains)
        mirrored = ask_numbers(law, 2, state[0], -state[1], -state[2], *gains)
        expect(
            close(mirrored[0], v) and close(mirrored[1], -omega),
            "in the mirror (alpha and theta negative) v must stay and omega be the opposite.",
        )
        expect(abs(v) <= gains.v_max, f"v is {v:.3g} m/s, and v_max is {gains.v_max:.3g} m/s.")
        rates = polar_rate(state[0], state[1], v, omega)
        slope = state[0] * rates[0] + state[1] * rates[1] + gains.h * state[2] * rates[2]
        expect(
            slope <= 1e-9,
            f"V rises, by {slope:.2g} a second, in a random state: the proof of chapter 4 does not hold for this law.",
        )
        slopes.append(slope)
    right = [lyapunov_rate(*state, gains) for state, gains in _states(200)]
    expect(all(map(close, slopes, right)), "V falls, but not by what (4.7) says.")
    return Passed(f"V falls in all of {len(slopes)} states, by up to {-min(slopes):.0f} a second.")


def _explain_omega(value: float, state: State, gains: Gains) -> None:
    rho, alpha, theta = state
    expect(
        not close(value, control_law(*state, gains, "printed")[1]),
        "omega is that of (24) as printed, with cos(alpha) sin(alpha) twice: V would rise in places.",
    )
    expect(
        not close(value, control_law(rho, alpha, -theta, gains)[1]),
        "the term with h has the wrong sign: this robot turns away from the approach.",
    )
    right = control_law(*state, gains._replace(k_alpha=0.0))[1]
    expect(not close(value, right), "the term k_alpha alpha is missing.")
    expect(
        not close(value, control_law(*state, gains._replace(h=0.0))[1]),
        "theta plays no role in omega: it would park with any heading.",
    )
    cancelling = value - gains.k_alpha * alpha
    expect(
        not close(cancelling, right * rho),
        "the second term is not divided by rho: compare its unit with that of k_alpha alpha.",
    )
    expect(
        not close(cancelling, right * alpha),
        "the second term is not divided by alpha: sin(alpha)/alpha, not sin(alpha).",
    )
    expect(
        not close(cancelling, right * math.cos(alpha)),
        "the second term has a cosine too many: v has one already.",
    )
    expect(
        not close(cancelling * math.cos(alpha), right),
        "the second term lacks a cosine: it is v/rho with the v of (22).",
    )
    expect(False, "v is right and omega is not: compare it with (4.6), factor by factor.")


def _states(count: int) -> list[tuple[State, Gains]]:
    """States away from the goal, each with gains of its own."""
    low, high = [0.1, -3.0, -3.0, 0.2, 0.5, 0.2, 0.5], [20.0, 3.0, 3.0, 2.0, 3.0, 3.0, 5.0]
    rows = np.random.default_rng(12).uniform(low, high, (count, 7)).tolist()
    return [(tuple(row[:3]), Gains(*row[3:])) for row in rows if abs(row[1]) > 0.05]
