"""Checks of following a moving goal: what is left behind, feed-forward, and the twist of a path."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from wmrbook.grading._hints import Passed, ask_number, ask_numbers, close, expect, own_work, refuses
from wmrlib import paper
from wmrlib.kinematics import Pose, Reference, advance, polar_error, wrap_angle
from wmrlib.metrics import residual
from wmrlib.simulation import track

Law = Callable[[float, float, float, float, float], tuple[float, float]]
STEP, DURATION, LEFT = 0.1, 40.0, 1e-3  # s, s, m: how a law is tried, and what it may leave


def residual_known(left_behind: Callable) -> Passed:
    """left_behind(speed, share, k_rho, v_max): the distance, m, at which the law with a share of feed-forward keeps up."""
    own_work(left_behind)
    for speed, share, k_rho, v_max in _goals(20):
        value = ask_number(left_behind, speed, share, k_rho, v_max)
        commanded = (
            share * speed - v_max * math.expm1(-k_rho * value)
            if k_rho * value > -50.0
            else -math.inf
        )
        if close(commanded, speed, 1e-6):
            continue
        rest = (1.0 - share) * speed / v_max
        right = -math.log1p(-rest) / k_rho
        expect(
            not close(value, -right),
            "the distance comes out negative: the logarithm of a number below 1 is.",
        )
        expect(
            not close(value, right / math.log(10.0)),
            "`log10` undoes 10^x; (22) has an exponential.",
        )
        expect(
            not close(value, -math.log1p(-speed / v_max) / k_rho),
            "this is (6.2), for a law that knows nothing of the goal's speed.",
        )
        mistaken = -math.log1p(-share * speed / v_max) / k_rho
        expect(
            not close(value, mistaken),
            "which part of the speed must the error bring about: the part that is told, or the other one?",
        )
        expect(
            not close(value, rest / k_rho),
            "this holds for a slow goal only: (22) is not proportional to rho.",
        )
        expect(not close(value, right * k_rho), "k_rho is missing: the result has no metres.")
        hint = f"at your distance, {value:.4g} m, the law commands {commanded:.4g} m/s, but the goal drives {speed:.4g} m/s."
        expect(False, hint)
    gains = paper.CIRCLE_GAINS
    told = ask_number(left_behind, paper.CIRCLE_SPEED, 0.0, gains.k_rho, gains.v_max)
    simulated = residual(track(paper.circle, paper.CIRCLE_START, gains, duration=DURATION))
    expect(
        abs(told - simulated) < 2e-4,
        f"on the paper's circle the simulation leaves {simulated:.4f} m, your formula {told:.4f} m.",
    )
    half = ask_number(left_behind, paper.CIRCLE_SPEED, 0.5, gains.k_rho, gains.v_max)
    return Passed(
        f"On the paper's circle {told:.4f} m ({simulated:.4f} m simulated); with half of the speed told, {half:.4f} m."
    )


def residual_limits(left_behind: Callable) -> Passed:
    """Nothing is left if the whole speed is told; k_rho divides; a goal that is too fast is refused."""
    own_work(left_behind)
    for speed, share, k_rho, v_max in _goals(10):
        expect(
            abs(ask_number(left_behind, speed, 1.0, k_rho, v_max)) < 1e-12,
            "if the whole speed is told (share 1), nothing must be left.",
        )
        value = ask_number(left_behind, speed, share, k_rho, v_max)
        expect(
            close(value, 2.0 * ask_number(left_behind, speed, share, 2.0 * k_rho, v_max)),
            "twice k_rho must leave half the distance.",
        )
        faster = ask_number(left_behind, 1.1 * speed, share, k_rho, v_max)
        expect(faster > value, "a faster goal must be further ahead.")
        too_fast = "the share of the speed that is not told is more than the feedback can ever command, so the goal runs away."
        refuses(left_behind, too_fast, v_max / (1.0 - share) * 1.01, share, k_rho, v_max)
        quick = ask_number(left_behind, 1.5 * v_max, 0.9, k_rho, v_max)
        expect(
            quick > 0.0, "a goal faster than v_max can be followed if enough of its speed is told."
        )
    return Passed(
        "Nothing left with the whole speed told, half as much with twice k_rho, and a goal that runs away is refused."
    )


def law_follows(steer: Law) -> Passed:
    """steer(rho, alpha, theta, v_ref, omega_ref) -> (v, omega) leaves nothing behind, on circles and straight lines."""
    own_work(steer)
    _at_reference(steer)
    worst = 0.0
    for goal, start in _chases():
        pose = start
        for n in range(int(DURATION / STEP)):
            seen, now = polar_error(pose, Pose(*goal(n * STEP)[:3])), goal(n * STEP)
            twist = ask_numbers(steer, 2, *map(float, seen), now.v, now.omega)
            _expect_near(steer, seen.rho < 100.0, seen.rho, n * STEP)
            pose = advance(pose, *twist, STEP)
        end = goal(n * STEP + STEP)
        left = polar_error(pose, Pose(*end[:3])).rho
        _expect_near(steer, left < LEFT, left, DURATION)
        worst = max(worst, left)
    return Passed(
        f"Six chases of 40 s, on circles and straight lines: at most {1000.0 * worst:.2g} mm are left."
    )


def law_mirrors(steer: Law) -> Passed:
    """On the reference the law commands its twist, a mirrored error gives the mirrored twist, and who is behind catches up."""
    own_work(steer)
    _at_reference(steer)
    random = np.random.default_rng(61)
    for rho, alpha, theta, v_ref, omega_ref in random.uniform(
        (0.1, -3.0, -3.0, 0.2, -1.0), (3.0, 3.0, 3.0, 2.0, 1.0), (20, 5)
    ).tolist():
        v, omega = ask_numbers(steer, 2, rho, alpha, theta, v_ref, omega_ref)
        v_there, omega_there = ask_numbers(steer, 2, rho, -alpha, -theta, v_ref, -omega_ref)
        expect(close(v, v_there), "mirror the scene, left for right: the speed must stay the same.")
        expect(
            close(omega, -omega_there),
            "mirror the scene, left for right: the turning must be as strong, the other way.",
        )
    v, _ = ask_numbers(steer, 2, 0.1, 0.0, 0.0, 1.0, 0.0)
    expect(
        v > 1.0,
        "with the reference 10 cm straight ahead the robot is no faster than the reference: it never comes closer.",
    )
    return Passed(
        "On the reference it does what the reference does, left and right are treated alike, and from behind it catches up."
    )


def twist_known(reference_twist: Callable) -> Passed:
    """reference_twist(x_dot, y_dot, x_ddot, y_ddot) -> (v, omega), against differences of speed and heading."""
    own_work(reference_twist)
    for x_dot, y_dot, x_ddot, y_ddot in _motions(20):
        v, omega = ask_numbers(reference_twist, 2, x_dot, y_dot, x_ddot, y_ddot)
        speed, step = math.hypot(x_dot, y_dot), 1e-6
        after, before = (
            math.atan2(y_dot + sign * step * y_ddot, x_dot + sign * step * x_ddot)
            for sign in (1.0, -1.0)
        )
        turning = wrap_angle(after - before) / (2.0 * step)
        expect(not close(v, speed**2), "v is the square of the speed.")
        expect(close(v, speed), "v is not the length of the velocity (x', y').")
        if not close(omega, turning, 1e-5, 1e-6):
            hint = (
                "omega has the wrong sign: which way does a circle driven counter-clockwise turn?"
            )
            expect(
                not close(omega, -turning, 1e-5),
                hint if turning > 0.0 else "a path may turn to the right, too: omega has a sign.",
            )
            expect(
                not close(omega, turning / speed, 1e-5),
                "this is the path's curvature in 1/m; omega is a rate in rad/s.",
            )
            expect(
                not close(omega, turning * speed, 1e-5),
                "omega is in rad/s, and this is the acceleration to the side, in m/s^2.",
            )
            expect(
                not close(omega, turning * speed**2, 1e-5),
                "what does the derivative of atan2(y', x') divide by?",
            )
            expect(
                False,
                "omega is not the rate of the heading atan2(y', x'): differentiate it by the chain rule.",
            )
    return Passed(
        "Twenty motions: v is the speed, and omega the rate at which its direction turns."
    )


def twist_properties(reference_twist: Callable) -> Passed:
    """The same in a turned frame, faster when driven faster, mirrored in a mirror; and right on the paper's circle."""
    own_work(reference_twist)
    for x_dot, y_dot, x_ddot, y_ddot in _motions(10):
        v, omega = ask_numbers(reference_twist, 2, x_dot, y_dot, x_ddot, y_ddot)
        c, s = math.cos(2.0), math.sin(2.0)
        turned = (
            c * x_dot - s * y_dot,
            s * x_dot + c * y_dot,
            c * x_ddot - s * y_ddot,
            s * x_ddot + c * y_ddot,
        )
        hint = "turn the axes: speed and turning rate must not change."
        expect(
            np.allclose(
                ask_numbers(reference_twist, 2, *turned), (v, omega), rtol=1e-9, atol=1e-12
            ),
            hint,
        )
        quick = ask_numbers(
            reference_twist, 2, 2.0 * x_dot, 2.0 * y_dot, 4.0 * x_ddot, 4.0 * y_ddot
        )
        hint = "the same path in half the time: twice the speeds, four times the accelerations, and v and omega both double."
        expect(np.allclose(quick, (2.0 * v, 2.0 * omega), rtol=1e-9), hint)
        mirrored = ask_numbers(reference_twist, 2, x_dot, -y_dot, x_ddot, -y_ddot)
        expect(
            np.allclose(mirrored, (v, -omega), rtol=1e-9, atol=1e-12),
            "the mirrored path turns as fast the other way.",
        )
        straight = ask_numbers(reference_twist, 2, x_dot, y_dot, 3.0 * x_dot, 3.0 * y_dot)[1]
        expect(
            abs(straight) < 1e-9,
            "braking or speeding up along a straight line turns nothing: omega must be 0.",
        )
    turn = 2.0 * math.pi / paper.CIRCLE_PERIOD
    v, omega = ask_numbers(
        reference_twist, 2, 0.0, paper.CIRCLE_SPEED, -paper.CIRCLE_SPEED * turn, 0.0
    )
    expect(
        close(v, paper.CIRCLE_SPEED) and close(omega, turn),
        "at t = 0 of (6.1) the twist is not the paper's circle's.",
    )
    return Passed(
        f"Frames, speeds and mirrors agree; the paper's circle has {v:.3f} m/s and {omega:.3f} rad/s."
    )


def _goals(count: int) -> list[list[float]]:
    return (
        np.random.default_rng(62)
        .uniform((0.2, 0.1, 0.3, 1.5), (1.2, 0.8, 4.0, 5.0), (count, 4))
        .tolist()
    )


def _motions(count: int) -> list[list[float]]:
    """Velocities and accelerations; the first turns to the left."""
    return [
        [1.0, 0.3, -0.2, 0.9],
        *np.random.default_rng(63).uniform(-2.0, 2.0, (count - 1, 4)).tolist(),
    ]


def _chases() -> list[tuple[Callable[[float], Reference], Pose]]:
    """Moving goals, and where the robot starts: the paper's circle, circles to the left and right, straight lines."""
    found = [(paper.circle, paper.CIRCLE_START)]
    for v, omega, start in [
        (0.8, 0.2, Pose(0.0, -1.0, 0.5)),
        (0.8, -0.2, Pose(0.0, 1.0, -0.5)),
        (1.0, 0.0, Pose(-1.0, 1.0, 0.0)),
        (1.0, 0.0, Pose(0.5, -0.5, 0.4)),
        (0.6, 0.4, Pose(0.3, 0.3, -0.6)),
    ]:
        origin = Pose(0.0, 0.0, 0.0)
        found.append(
            (
                lambda t, v=v, omega=omega, origin=origin: Reference(
                    *advance(origin, v, omega, t), v, omega
                ),
                start,
            )
        )
    return found


def _at_reference(steer: Law) -> None:
    for v_ref, omega_ref in ((1.0, 0.0), (0.6, 0.3), (0.6, -0.3)):
        v, omega = ask_numbers(steer, 2, 0.0, 0.0, 0.0, v_ref, omega_ref)
        there, here = f"({v_ref:g} m/s, {omega_ref:g} rad/s)", f"({v:.3g} m/s, {omega:.3g} rad/s)"
        hint = f"on the reference itself, which drives {there}, your law commands {here}."
        expect(close(v, v_ref) and close(omega, omega_ref), hint)


def _expect_near(steer: Law, near: bool, rho: float, t: float) -> None:
    """A hint with the first of three simple tests that the law fails, if the run failed."""
    if near:
        return
    shown = f"after {t:.0f} s the reference is {rho:.3g} m away. "
    v, _ = ask_numbers(steer, 2, 0.1, 0.0, 0.0, 1.0, 0.0)
    expect(
        v > 1.0,
        shown
        + "Look at a reference 0.1 m straight ahead, in the same direction: is the robot faster than the reference?",
    )
    _, omega = ask_numbers(steer, 2, 0.1, math.pi / 2.0, math.pi / 2.0, 1.0, 0.0)
    expect(
        omega > 0.0,
        shown
        + "Look at a reference 0.1 m to the left, in the same direction: which way does the robot turn?",
    )
    _, omega = ask_numbers(steer, 2, 0.0, 0.2, 0.0, 1.0, 0.0)
    expect(
        omega > 0.0,
        shown
        + "Look at a reference here that points 0.2 rad further left: which way does the robot turn?",
    )
    _, strong = ask_numbers(steer, 2, 0.1, math.pi / 2.0, math.pi / 2.0, 1.0, 0.0)
    _, faint = ask_numbers(steer, 2, 1e-6, math.pi / 2.0, math.pi / 2.0, 1.0, 0.0)
    hint = "Look at a reference a micrometre to the left: should the robot turn as strongly as for 10 cm?"
    expect(abs(faint) < 0.1 * abs(strong), shown + hint)
    expect(False, shown + "The signs are right: try stronger or weaker feedback.")
