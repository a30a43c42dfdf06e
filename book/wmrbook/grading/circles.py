"""Checks of following a moving goal: what is left behind, feed-forward, and a path's twist."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from wmrbook.grading._asking import ask_number, ask_numbers, refuses
from wmrbook.grading._hints import close, drawn, expect, explain, own_work, slip, spread
from wmrlib import paper
from wmrlib.kinematics import Pose, Reference, advance, polar_error, wrap_angle
from wmrlib.metrics import residual
from wmrlib.simulation import track

Law = Callable[[float, float, float, float, float], tuple[float, float]]
_GOAL = (0.2, 1.2), (0.1, 0.8), (0.3, 4.0), (1.5, 5.0)  # speed, share, k_rho, v_max
STEP, DURATION, LEFT = 0.1, 40.0, 1e-3  # s, s, m: how a law is tried, and what it may leave


def residual_known(left_behind: Callable) -> str:
    """left_behind(speed, share, k_rho, v_max): the distance, m, at which the law keeps up."""
    own_work(left_behind)
    for speed, share, k_rho, v_max in drawn(62, 20, *_GOAL):
        value = ask_number(left_behind, speed, share, k_rho, v_max)
        far = -v_max * math.expm1(-k_rho * value) if k_rho * value > -50.0 else -math.inf
        commanded = share * speed + far
        if close(commanded, speed, 1e-6):
            continue

        def distance(untold: float, v_max: float = v_max, k_rho: float = k_rho) -> float:
            return -math.log1p(-untold / v_max) / k_rho

        rest = (1.0 - share) * speed
        right, slow = distance(rest), rest / v_max / k_rho
        mistakes = {
            "the distance comes out negative: the logarithm of a number below 1 is.": -right,
            "`log10` undoes 10^x; (22) has an exponential.": right / math.log(10.0),
            "this is (7.2), for a law that knows nothing of the goal's speed.": distance(speed),
            "which part of the speed must the error bring about: "
            "the part that is told, or the other one?": distance(share * speed),
            "this holds for a slow goal only: (22) is not proportional to rho.": slow,
            "k_rho is missing: the result has no metres.": right * k_rho,
        }
        hint = f"at your distance, {value:.4g} m, the law commands {commanded:.4g} m/s, "
        hint += f"but the goal drives {speed:.4g} m/s."
        explain(value, mistakes, hint, right=right)
    gains = paper.CIRCLE_GAINS
    predicted, half = (
        ask_number(left_behind, paper.CIRCLE_SPEED, share, gains.k_rho, gains.v_max)
        for share in (0.0, 0.5)
    )
    simulated = residual(track(paper.circle, paper.CIRCLE_START, gains, duration=DURATION))
    hint = f"on the paper's circle the simulation leaves {simulated:.4f} m, "
    expect(abs(predicted - simulated) < 2e-4, f"{hint}your formula {predicted:.4f} m.")
    circle = f"On the paper's circle {predicted:.4f} m ({simulated:.4f} m simulated)"
    return f"{circle}; with half of the speed told, {half:.4f} m."


def residual_limits(left_behind: Callable) -> str:
    """Nothing is left if the whole speed is told; k_rho divides; too fast a goal is refused."""
    own_work(left_behind)
    goals = drawn(62, 10, *_GOAL)
    for (speed, share, k_rho, v_max), near in zip(goals, spread(1e-3, 1.0, 10), strict=True):
        predicted = abs(ask_number(left_behind, speed, 1.0, k_rho, v_max))
        expect(predicted < 1e-12, "if the whole speed is told (share 1), nothing must be left.")
        value = ask_number(left_behind, speed, share, k_rho, v_max)
        halved = ask_number(left_behind, speed, share, 2.0 * k_rho, v_max)
        expect(close(value, 2.0 * halved), "twice k_rho must leave half the distance.")
        faster = ask_number(left_behind, 1.1 * speed, share, k_rho, v_max)
        expect(faster > value, "a faster goal must be further ahead.")
        hint = "the share of the speed that is not told is more than the feedback can ever "
        hint += "command, so the goal runs away."
        fastest = v_max / (1.0 - share)
        refuses(left_behind, hint, fastest * (1.0 + near), share, k_rho, v_max)
        ask_number(left_behind, fastest / (1.0 + near), share, k_rho, v_max)
        quick = ask_number(left_behind, 1.5 * v_max, 0.9, k_rho, v_max)
        hint = "a goal faster than v_max can be followed if enough of its speed is told."
        expect(quick > 0.0, hint)
    nothing = "Nothing left with the whole speed told, half as much with twice k_rho,"
    return f"{nothing} and a goal that runs away is refused."


def law_follows(steer: Law) -> str:
    """steer(rho, alpha, theta, v_ref, omega_ref) -> (v, omega) leaves nothing behind."""
    own_work(steer)
    _at_reference(steer)
    worst = 0.0
    for goal, start in _chases():
        pose, steps = start, int(DURATION / STEP)
        for n in range(steps):
            now = goal(n * STEP)
            error = polar_error(pose, Pose(*now[:3]))
            twist = ask_numbers(steer, 2, *map(float, error), now.v, now.omega)
            _expect_near(steer, error.rho < 100.0, error.rho, n * STEP)
            pose = advance(pose, *twist, STEP)
        left = polar_error(pose, Pose(*goal(steps * STEP)[:3])).rho
        _expect_near(steer, left < LEFT, left, DURATION)
        worst = max(worst, left)
    chases = "Six chases of 40 s, on circles and straight lines"
    return f"{chases}: at most {1000.0 * worst:.2g} mm are left."


def law_mirrors(steer: Law) -> str:
    """It drives the reference's twist on it, mirrors a mirrored error, and catches up."""
    own_work(steer)
    _at_reference(steer)
    errors = (0.1, 3.0), (-3.0, 3.0), (-3.0, 3.0)
    for rho, alpha, theta, v_ref, omega_ref in drawn(61, 20, *errors, (0.2, 2.0), (-1.0, 1.0)):
        v, omega = ask_numbers(steer, 2, rho, alpha, theta, v_ref, omega_ref)
        v_there, omega_there = ask_numbers(steer, 2, rho, -alpha, -theta, v_ref, -omega_ref)
        mirror = "mirror the scene, left for right: "
        expect(close(v, v_there), f"{mirror}the speed must stay the same.")
        turning = f"{mirror}the turning must be as strong, the other way."
        expect(close(omega, -omega_there), turning)
    v, _ = ask_numbers(steer, 2, 0.1, 0.0, 0.0, 1.0, 0.0)
    hint = "with the reference 10 cm straight ahead the robot is no faster than the reference: "
    expect(v > 1.0, f"{hint}it never comes closer.")
    there = "On the reference it does what the reference does, left and right are treated alike,"
    return f"{there} and from behind it catches up."


def twist_known(reference_twist: Callable) -> str:
    """reference_twist(x_dot, y_dot, x_ddot, y_ddot) -> (v, omega), against differences."""
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
        slip((v, omega), (speed, turning), "(v, omega)", 1e-3 * (not close(v, speed)))
        expect(close(v, speed), "v is not the length of the velocity (x', y').")
        if close(omega, turning, 1e-5, 1e-6):
            continue
        aside, hint = turning * speed, "a path may turn to the right, too: omega has a sign."
        if turning > 0.0:
            hint = "omega has the wrong sign: "
            hint += "which way does a circle driven counter-clockwise turn?"
        mistakes = {
            hint: -turning,
            "this is the path's curvature in 1/m; omega is a rate in rad/s.": turning / speed,
            "omega is in rad/s, and this is the acceleration to the side, in m/s^2.": aside,
            "what does the derivative of atan2(y', x') divide by?": turning * speed**2,
        }
        otherwise = "omega is not the rate of the heading atan2(y', x'): "
        otherwise += "differentiate it by the chain rule."
        explain(omega, mistakes, otherwise, lambda one, other: close(one, other, 1e-5))
    twenty = "Twenty motions: v is the speed,"
    return f"{twenty} and omega the rate at which its direction turns."


def twist_properties(reference_twist: Callable) -> str:
    """Right in a turned frame, driven faster, in a mirror, and on the paper's circle."""
    own_work(reference_twist)
    cos, sin = math.cos(2.0), math.sin(2.0)
    for motion in _motions(10):
        x_dot, y_dot, x_ddot, y_ddot = motion
        v, omega = ask_numbers(reference_twist, 2, *motion)
        turned = [
            (cos * x - sin * y, sin * x + cos * y) for x, y in ((x_dot, y_dot), (x_ddot, y_ddot))
        ]
        axes = "turn the axes: speed and turning rate must not change."
        clock = "the same path in half the time: twice the speeds, four times the accelerations, "
        clock += "and v and omega both double."
        left = "the mirrored path turns as fast the other way."
        for changed, right, hint in (
            ((*turned[0], *turned[1]), (v, omega), axes),
            (np.multiply(motion, (2.0, 2.0, 4.0, 4.0)), (2.0 * v, 2.0 * omega), clock),
            (np.multiply(motion, (1.0, -1.0, 1.0, -1.0)), (v, -omega), left),
        ):
            value = ask_numbers(reference_twist, 2, *changed)
            expect(np.allclose(value, right, rtol=1e-9, atol=1e-12), hint)
        straight = ask_numbers(reference_twist, 2, x_dot, y_dot, 3.0 * x_dot, 3.0 * y_dot)[1]
        hint = "braking or speeding up along a straight line turns nothing: omega must be 0."
        expect(abs(straight) < 1e-9, hint)
    turn, speed = 2.0 * math.pi / paper.CIRCLE_PERIOD, paper.CIRCLE_SPEED
    v, omega = ask_numbers(reference_twist, 2, 0.0, speed, -speed * turn, 0.0)
    hint = "at t = 0 of (7.1) the twist is not the paper's circle's."
    expect(close(v, speed) and close(omega, turn), hint)
    circle = f"the paper's circle has {v:.3f} m/s and {omega:.3f} rad/s."
    return f"Frames, speeds and mirrors agree; {circle}"


def _motions(count: int) -> list[list[float]]:
    """Velocities and accelerations; the first turns to the left."""
    return [[1.0, 0.3, -0.2, 0.9], *drawn(63, count - 1, *[(-2.0, 2.0)] * 4)]


def _chases() -> list[tuple[Callable[[float], Reference], Pose]]:
    """Moving goals and starts: the paper's circle, circles to both sides, straight lines."""
    chases = [(paper.circle, paper.CIRCLE_START)]
    for v, omega, start in [
        (0.8, 0.2, Pose(0.0, -1.0, 0.5)),
        (0.8, -0.2, Pose(0.0, 1.0, -0.5)),
        (1.0, 0.0, Pose(-1.0, 1.0, 0.0)),
        (1.0, 0.0, Pose(0.5, -0.5, 0.4)),
        (0.6, 0.4, Pose(0.3, 0.3, -0.6)),
    ]:

        def goal(t: float, v: float = v, omega: float = omega) -> Reference:
            return Reference(*advance(Pose(0.0, 0.0, 0.0), v, omega, t), v, omega)

        chases.append((goal, start))
    return chases


def _at_reference(steer: Law) -> None:
    for v_ref, omega_ref in ((1.0, 0.0), (0.6, 0.3), (0.6, -0.3)):
        v, omega = ask_numbers(steer, 2, 0.0, 0.0, 0.0, v_ref, omega_ref)
        there, here = f"({v_ref:g} m/s, {omega_ref:g} rad/s)", f"({v:.3g} m/s, {omega:.3g} rad/s)"
        slip((v, omega), (v_ref, omega_ref), "(v, omega)")
        hint = f"on the reference itself, which drives {there}, your law commands {here}."
        expect(close(v, v_ref) and close(omega, omega_ref), hint)


def _expect_near(steer: Law, near: bool, rho: float, t: float) -> None:
    """If the run failed, raise a Hint with the first simple test that the law fails."""
    if near:
        return
    left, side = (math.pi / 2.0, math.pi / 2.0, 1.0, 0.0), "which way does the robot turn?"
    v, _ = ask_numbers(steer, 2, 0.1, 0.0, 0.0, 1.0, 0.0)
    _, strong = ask_numbers(steer, 2, 0.1, *left)
    _, turned = ask_numbers(steer, 2, 0.0, 0.2, 0.0, 1.0, 0.0)
    _, faint = ask_numbers(steer, 2, 1e-6, *left)
    distance_text = f"after {t:.0f} s the reference is {rho:.3g} m away. "
    look = f"{distance_text}Look at a reference "
    hint = "0.1 m straight ahead, in the same direction: is the robot faster than the reference?"
    expect(v > 1.0, look + hint)
    expect(strong > 0.0, f"{look}0.1 m to the left, in the same direction: {side}")
    expect(turned > 0.0, f"{look}here that points 0.2 rad further left: {side}")
    hint = "a micrometre to the left: should the robot turn as strongly as for 10 cm?"
    expect(abs(faint) < 0.1 * abs(strong), look + hint)
    expect(False, f"{distance_text}The signs are right: try stronger or weaker feedback.")
