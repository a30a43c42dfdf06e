"""Checks of the robot's motion: wheels and twist, the exact step, and wheels that are kept below their limit."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from wmrbook.grading._hints import Passed, ask_numbers, expect, own_work
from wmrlib.kinematics import Pose, advance, twist_to_wheels, wheels_to_twist, wrap_angle

Pair = tuple[float, float]


def wheels_known(wheels: Callable[[float, float, float, float], Pair]) -> Passed:
    """wheels(v, omega, track_width, wheel_radius): the angular speeds (left, right) in rad/s."""
    own_work(wheels)
    for v, omega, width, radius in _robots(20):
        value = ask_numbers(wheels, 2, v, omega, width, radius)
        ground = twist_to_wheels(v, omega, width)
        right = (ground[0] / radius, ground[1] / radius)
        if not _equal(value, right):
            doubled = twist_to_wheels(v, 2.0 * omega, width)
            expect(
                not _equal(value, right[::-1]),
                "left and right have changed places: in a left turn, which wheel has the longer way?",
            )
            expect(
                not _equal(value, ground),
                "these are the speeds over the ground, in m/s; how fast does a wheel of this radius turn?",
            )
            expect(
                not _equal(value, (ground[0] * radius, ground[1] * radius)),
                "a small wheel must turn faster than a large one: the radius does the opposite here.",
            )
            expect(
                not _equal(value, (doubled[0] / radius, doubled[1] / radius)),
                "the robot would turn twice as fast: how far is a wheel from the middle of the axle?",
            )
            expect(
                _equal(sum(value) / 2.0, sum(right) / 2.0),
                "the robot would not drive at v: the mean of the wheels' speeds over the ground must be v, (1).",
            )
            expect(False, "the robot would drive at v, but not turn at omega: look at (2).")
    return Passed("Twenty robots drive and turn as they were told.")


def twist_known(twist: Callable[[float, float, float, float], Pair]) -> Passed:
    """twist(left, right, track_width, wheel_radius): (v, omega) from the wheels' angular speeds, (1) and (2)."""
    own_work(twist)
    for left, right, width, radius in _robots(20):
        v, omega = ask_numbers(twist, 2, left, right, width, radius)
        v_right, omega_right = wheels_to_twist(left * radius, right * radius, width)
        slow, slow_turn = wheels_to_twist(left, right, width)
        expect(
            not _equal((v, omega), (slow, omega_right)),
            "(1) has speeds over the ground and (2) angular ones: v needs the radius too.",
        )
        expect(
            not _equal((v, omega), (slow, slow_turn)),
            "the wheels' speeds are in rad/s: over the ground they are radius times that.",
        )
        expect(
            not _equal(omega, -omega_right),
            "it turns the wrong way: with the right wheel faster the robot turns left, omega > 0.",
        )
        expect(
            not _equal(omega, 2.0 * omega_right),
            "it turns twice as fast as it should: by what is the difference of the wheels' speeds divided?",
        )
        expect(_equal(v, v_right), "v is not the mean of the two speeds over the ground.")
        expect(_equal(omega, omega_right), "omega is not what (2) says.")
    return Passed("Wheels to twist is right; the robot can count its own turns.")


def arc_known(arc: Callable[..., tuple[float, float, float]]) -> Passed:
    """arc(x, y, heading, v, omega, dt): the pose after a constant twist, exactly; the heading up to full turns."""
    own_work(arc)
    nearly_straight = [
        (pose, v, math.copysign(1e-3, omega), dt) for pose, v, omega, dt in _steps(4)
    ]
    for pose, v, omega, dt in [*_steps(30), *nearly_straight]:
        value, right = ask_numbers(arc, 3, *pose, v, omega, dt), advance(pose, v, omega, dt)
        expect(
            _same_angle(value[2], right.heading),
            "the heading is wrong: by how much does it turn in the time dt?",
        )
        if not _same_place(value, right):
            expect(
                not _same_place(value, advance(pose, v, omega, dt, method="euler")),
                "this is Euler's step, along the old heading; the robot turns on its way.",
            )
            late = advance(Pose(*pose[:2], pose.heading + omega * dt), v, omega, dt, method="euler")
            expect(
                not _same_place(value, late),
                "this is a straight step along the *new* heading; the robot turns on its way.",
            )
            middle = advance(
                Pose(*pose[:2], pose.heading + omega * dt / 2.0), v, omega, dt, method="euler"
            )
            expect(
                not _same_place(value, middle),
                "the direction is right, but this is as long as the arc: the chord of an arc is shorter.",
            )
            expect(
                not _same_place(value, advance(pose, v, -omega, dt)),
                "this arc bends to the other side: look at the signs in (2.9).",
            )
            expect(
                False,
                "the place is not on the arc: integrate cos and sin of the heading over the time, (2.9).",
            )
    far = math.dist(
        advance(Pose(0.0, 0.0, 0.0), 4.0, 1.0, 0.5)[:2],
        advance(Pose(0.0, 0.0, 0.0), 4.0, 1.0, 0.5, method="euler")[:2],
    )
    return Passed(
        f"On the arc. At 4 m/s and 1 rad/s Euler's step would end {100.0 * far:.0f} cm beside it after half a second."
    )


def arc_straight(arc: Callable[..., tuple[float, float, float]]) -> Passed:
    """It is finite for omega = 0 and keeps its digits when omega is tiny."""
    own_work(arc)
    for omega in (0.0, -0.0, -1e-6, 1e-9, -1e-12, 1e-15):
        value, right = (
            ask_numbers(arc, 3, 1.0, 2.0, 0.5, 2.0, omega, 1.5),
            advance(Pose(1.0, 2.0, 0.5), 2.0, omega, 1.5),
        )
        away = math.dist(value[:2], right[:2])
        expect(
            omega != 0.0 or away < 1e-5,
            f"with omega = 0 the place is {away:.2g} m off: how far does a robot get straight on in the time dt, and which way?",
        )
        expect(
            away < 1e-5,
            f"with omega = {omega:g} rad/s, a nearly straight line, the place is {1000.0 * away:.2g} mm off: "
            "a difference of two nearly equal numbers, divided by a tiny one, loses its digits.",
        )
        turned = abs(wrap_angle(value[2] - right.heading))
        expect(
            turned < 1e-5,
            f"with omega = {omega:g} rad/s the heading becomes {value[2]:.4g} rad; it was 0.5 rad, and hardly changes.",
        )
    return Passed(
        "Straight ahead and nearly straight ahead: no division by zero, and no lost digits."
    )


def arc_properties(arc: Callable[..., tuple[float, float, float]]) -> Passed:
    """Two halves are a whole, the way back leads back, a mirrored step mirrors."""
    own_work(arc)
    for pose, v, omega, dt in _steps(15):
        whole = ask_numbers(arc, 3, *pose, v, omega, dt)
        half = ask_numbers(arc, 3, *pose, v, omega, dt / 2.0)
        halves = ask_numbers(arc, 3, *half, v, omega, dt / 2.0)
        expect(
            _same_place(halves, whole) and _same_angle(halves[2], whole[2]),
            f"two half steps end {100.0 * math.dist(halves[:2], whole[:2]):.2g} cm from one of {dt:.2f} s: an exact step does not care.",
        )
        home = ask_numbers(arc, 3, *whole, -v, -omega, dt)
        expect(
            _same_place(home, pose) and _same_angle(home[2], pose.heading),
            "with v and omega reversed it must come back to its start.",
        )
        mirrored = ask_numbers(arc, 3, pose.x, -pose.y, -pose.heading, v, -omega, dt)
        expect(
            _same_place((mirrored[0], -mirrored[1]), whole) and _same_angle(-mirrored[2], whole[2]),
            "seen in a mirror along the x axis, a left turn must be a right turn.",
        )
        expect(math.dist(whole[:2], pose[:2]) > 0.0, "the robot does not move.")
    return Passed("Two half steps are one whole step, and the way back leads back.")


def limited_speed(limited: Callable[[float, float, float], Pair]) -> Passed:
    """limited(left, right, max_speed): no wheel is faster than the limit, one is just as fast, and slow wheels are left alone."""
    own_work(limited)
    for left, right in _wheel_pairs(40):
        fastest = max(abs(left), abs(right))
        kept = ask_numbers(limited, 2, left, right, fastest * 1.25)
        expect(
            not _equal(kept, (1.25 * left, 1.25 * right)),
            "slow wheels are sped up to the limit; they must be left alone.",
        )
        both = "; wheels may turn backwards, too" if min(left, right) < 0.0 else ""
        expect(
            _equal(kept, (left, right)),
            f"wheels that are below the limit must be left alone{both}.",
        )
        slower = ask_numbers(limited, 2, left, right, fastest * 0.5)
        speed = max(map(abs, slower))
        expect(
            speed <= fastest * 0.5 * (1.0 + 1e-9),
            f"a wheel turns at {speed / fastest * 2.0:.2f} times its limit{both}.",
        )
        expect(
            speed >= fastest * 0.5 * (1.0 - 1e-9),
            "the faster wheel stays below the limit; the robot could go faster.",
        )
    kept = ask_numbers(limited, 2, 0.0, 0.0, 1.0)
    expect(_equal(kept, (0.0, 0.0)), "wheels that stand still must go on standing still.")
    return Passed("No wheel is too fast, and none is slower than it must be.")


def limited_curvature(limited: Callable[[float, float, float], Pair]) -> Passed:
    """The robot keeps its path: the turning centre of the limited wheels is where it was."""
    own_work(limited)
    bend = []
    for left, right in _wheel_pairs(40):
        most = 0.6 * max(abs(left), abs(right))
        slower = ask_numbers(limited, 2, left, right, most)
        v, omega = wheels_to_twist(left, right, 0.5)
        v_slower, omega_slower = wheels_to_twist(*slower, 0.5)
        if (
            abs(v * omega_slower - omega * v_slower) > 1e-9
            or v * v_slower + omega * omega_slower <= 0.0
        ):
            clipped = (min(max(left, -most), most), min(max(right, -most), most))
            expect(
                not _equal(slower, clipped),
                f"each wheel is clipped on its own: a curve of radius {abs(v / omega):.2f} m "
                f"becomes one of {abs(v_slower / omega_slower) if omega_slower else math.inf:.2f} m. What must stay the same?",
            )
            expect(
                v * v_slower + omega * omega_slower > 0.0,
                "the robot stops, or drives the other way.",
            )
            expect(
                False,
                f"the turning centre moves from {v / omega:.2f} m to the left of the robot; the path must stay, only slower.",
            )
        bend.append(abs(v / omega))
    return Passed(
        f"Turns nearly on the spot, and curves of up to {max(bend):.0f} m of radius, keep their centre."
    )


def _equal(value, right) -> bool:
    return bool(np.allclose(value, right, rtol=1e-9, atol=1e-9))


def _same_place(value, right) -> bool:
    return math.dist(value[:2], right[:2]) < 1e-7


def _same_angle(value: float, right: float) -> bool:
    return abs(wrap_angle(value - right)) < 1e-9


def _robots(count: int) -> list[list[float]]:
    """Two speeds, a track width in m and a wheel radius in m."""
    return (
        np.random.default_rng(2)
        .uniform([-2.0, -2.0, 0.2, 0.03], [2.0, 2.0, 0.9, 0.3], (count, 4))
        .tolist()
    )


def _steps(count: int) -> list[tuple[Pose, float, float, float]]:
    rows = (
        np.random.default_rng(8)
        .uniform([-5.0, -5.0, -3.0, -3.0, -2.0, 0.3], [5.0, 5.0, 3.0, 3.0, 2.0, 1.5], (count, 6))
        .tolist()
    )
    return [(Pose(*row[:3]), *row[3:]) for row in rows]


def _wheel_pairs(count: int) -> list[list[float]]:
    return np.random.default_rng(9).uniform(-2.0, 2.0, (count, 2)).tolist()
