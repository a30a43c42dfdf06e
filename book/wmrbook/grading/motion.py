"""Checks of the robot's motion: wheels and twist, the exact step, and the limit of the wheels."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np

from wmrbook.grading._asking import ask_numbers
from wmrbook.grading._hints import (
    Hint,
    angle_equal,
    drawn,
    expect,
    explain,
    own_work,
    rule_out,
    same_pose,
    slip,
    spread,
)
from wmrlib.kinematics import Pose, advance, twist_to_wheels, wheels_to_twist, wrap_angle

Pair = tuple[float, float]
Arc = Callable[..., tuple[float, float, float]]
# Two speeds, the track width in m and the wheels' radius in m.
_ROBOT = (-2.0, 2.0), (-2.0, 2.0), (0.2, 0.9), (0.03, 0.3)
_equal = partial(np.allclose, rtol=1e-9, atol=1e-9)


def wheels_known(wheels: Callable[[float, float, float, float], Pair]) -> str:
    """wheels(v, omega, track_width, wheel_radius): the angular speeds (left, right) in rad/s."""
    own_work(wheels)
    for v, omega, width, radius in _robots():
        value = ask_numbers(wheels, 2, v, omega, width, radius)
        ground = np.array(twist_to_wheels(v, omega, width))
        right, doubled = ground / radius, np.array(twist_to_wheels(v, 2.0 * omega, width)) / radius
        if _equal(value, right):
            continue
        mistakes = {
            "left and right have changed places: "
            "in a left turn, which wheel has the longer way?": right[::-1],
            "these are the speeds over the ground, in m/s; "
            "how fast does a wheel of this radius turn?": ground,
            "a small wheel must turn faster than a large one: "
            "the radius does the opposite here.": ground * radius,
            "the robot would turn twice as fast: "
            "how far is a wheel from the middle of the axle?": doubled,
        }
        rule_out(value, mistakes, _equal)
        slip(value, right)
        hint = "the robot would not drive at v: "
        hint += "the mean of the wheels' speeds over the ground must be v, (1)."
        expect(_equal(sum(value), sum(right)), hint)
        expect(False, "the robot would drive at v, but not turn at omega: look at (2).")
    return "Twenty robots drive and turn as they were told."


def twist_known(twist: Callable[[float, float, float, float], Pair]) -> str:
    """twist(left, right, track_width, wheel_radius): (v, omega) from the wheels, (1) and (2)."""
    own_work(twist)
    for left, right, width, radius in _robots():
        v, omega = value = ask_numbers(twist, 2, left, right, width, radius)
        v_right, omega_right = wheels_to_twist(left * radius, right * radius, width)
        slow = wheels_to_twist(left, right, width)
        half = slow[0], omega_right
        mistakes = {
            "(1) has speeds over the ground and (2) angular ones: v needs the radius too.": half,
            "the wheels' speeds are in rad/s: over the ground they are radius times that.": slow,
        }
        rule_out(value, mistakes, _equal)
        mistakes = {
            "it turns the wrong way: "
            "with the right wheel faster the robot turns left, omega > 0.": -omega_right,
            "it turns twice as fast as it should: "
            "by what is the difference of the wheels' speeds divided?": 2.0 * omega_right,
        }
        rule_out(omega, mistakes, _equal)
        slip(value, (v_right, omega_right), "(v, omega)")
        expect(_equal(v, v_right), "v is not the mean of the two speeds over the ground.")
        expect(_equal(omega, omega_right), "omega is not what (2) says.")
    return "Wheels to twist is right; the robot can count its own turns."


def arc_known(arc: Arc) -> str:
    """arc(x, y, heading, v, omega, dt): the pose after a constant twist, up to full turns."""
    own_work(arc)
    for pose, v, omega, dt in _steps(30):
        value, right = ask_numbers(arc, 3, *pose, v, omega, dt), advance(pose, v, omega, dt)
        if same_pose(value, right):
            continue
        if not angle_equal(value[2], right.heading):
            slip(value, right, "(x, y, heading)")
            raise Hint("the heading is wrong: by how much does it turn in the time dt?")
        old, middle, new = (
            (*advance(pose._replace(heading=pose.heading + turn), v, 0.0, dt)[:2], right.heading)
            for turn in (0.0, omega * dt / 2.0, omega * dt)
        )
        mirrored = (*advance(pose, v, -omega, dt)[:2], right.heading)
        mistakes = {
            "this is Euler's step, along the old heading; the robot turns on its way.": old,
            "this is a straight step along the *new* heading; the robot turns on its way.": new,
            "the direction is right, but this is as long as the arc: "
            "the chord of an arc is shorter.": middle,
            "this arc bends to the other side: look at the signs in (2.9).": mirrored,
        }
        otherwise = "the place is not on the arc: "
        otherwise += "integrate cos and sin of the heading over the time, (2.9)."
        explain(value, mistakes, otherwise, same_pose, right)
    origin = Pose(0.0, 0.0, 0.0)
    ends = [advance(origin, 4.0, 1.0, 0.5, method=method)[:2] for method in ("arc", "euler")]
    far = f"{100.0 * math.dist(*ends):.0f} cm beside it after half a second."
    return f"On the arc. At 4 m/s and 1 rad/s Euler's step would end {far}"


def arc_straight(arc: Arc) -> str:
    """It is finite for omega = 0 and keeps its digits when omega is tiny."""
    own_work(arc)
    sizes = spread(1e-15, 1.0, 100)
    for omega in (0.0, -0.0, *sizes, *(-size for size in sizes)):
        value = ask_numbers(arc, 3, 1.0, 2.0, 0.5, 2.0, omega, 1.5)
        right, euler = (
            advance(Pose(1.0, 2.0, 0.5), 2.0, omega, 1.5, method=step) for step in ("arc", "euler")
        )
        away = math.dist(value[:2], right[:2])
        hint = f"with omega = 0 the place is {away:.2g} m off: "
        hint += "how far does a robot get straight on in the time dt, and which way?"
        expect(omega != 0.0 or away < 1e-5, hint)
        where = f"with omega = {omega:.2g} rad/s"
        hint = f"{where} the heading becomes {value[2]:.4g} rad, and {right.heading:.4g} is right: "
        hint += "it was 0.5 rad, and turns by omega times dt."
        expect(abs(wrap_angle(value[2] - right.heading)) < 1e-5, hint)
        if away >= 1e-5:
            hint = f"{where} it drives straight on, which is {1000.0 * away:.2g} mm beside the arc."
            expect(math.dist(value[:2], euler[:2]) > 1e-6, hint)
            hint = f"{where}, a nearly straight line, the place is {1000.0 * away:.2g} mm off: a "
            hint += "difference of two nearly equal numbers, divided by a tiny one, loses its "
            raise Hint(hint + "digits.")
    straight = "Straight ahead and nearly straight ahead:"
    return f"{straight} no division by zero, and no lost digits."


def arc_properties(arc: Arc) -> str:
    """Two halves are a whole, the way back leads back, a mirrored step mirrors."""
    own_work(arc)
    for pose, v, omega, dt in _steps(15):
        whole = ask_numbers(arc, 3, *pose, v, omega, dt)
        half = ask_numbers(arc, 3, *pose, v, omega, dt / 2.0)
        halves = ask_numbers(arc, 3, *half, v, omega, dt / 2.0)
        hint = f"two half steps end {100.0 * math.dist(halves[:2], whole[:2]):.2g} cm "
        hint += f"from one of {dt:.2f} s: an exact step does not care."
        expect(same_pose(halves, whole), hint)
        home = ask_numbers(arc, 3, *whole, -v, -omega, dt)
        hint = "with v and omega reversed it must come back to its start."
        expect(same_pose(home, pose), hint)
        x, y, heading = ask_numbers(arc, 3, pose.x, -pose.y, -pose.heading, v, -omega, dt)
        hint = "seen in a mirror along the x axis, a left turn must be a right turn."
        expect(same_pose((x, -y, -heading), whole), hint)
        expect(math.dist(whole[:2], pose[:2]) > 0.0, "the robot does not move.")
    return "Two half steps are one whole step, and the way back leads back."


def limited_speed(limited: Callable[[float, float, float], Pair]) -> str:
    """limited(left, right, max_speed): the faster wheel at its limit, slow wheels left alone."""
    own_work(limited)
    for (left, right), near in zip(_wheel_pairs(40), spread(1e-3, 10.0, 40), strict=True):
        fastest = max(abs(left), abs(right))
        speeds = ask_numbers(limited, 2, left, right, fastest * (1.0 + near))
        hint = "slow wheels are sped up to the limit; they must be left alone."
        expect(not _equal(speeds, np.multiply(1.0 + near, (left, right))), hint)
        both = "; wheels may turn backwards, too" if min(left, right) < 0.0 else ""
        hint = f"wheels that are below the limit must be left alone{both}."
        slip(speeds, (left, right), "(left, right)")
        expect(_equal(speeds, (left, right)), hint)
        most = fastest / (1.0 + near)
        share = max(map(abs, ask_numbers(limited, 2, left, right, most))) / most
        expect(share <= 1.0 + 1e-9, f"a wheel turns at {share:.2f} times its limit{both}.")
        hint = "the faster wheel stays below the limit; the robot could go faster."
        expect(share >= 1.0 - 1e-9, hint)
    speeds = ask_numbers(limited, 2, 0.0, 0.0, 1.0)
    expect(_equal(speeds, (0.0, 0.0)), "wheels that stand still must go on standing still.")
    return "No wheel is too fast, and none is slower than it must be."


def limited_curvature(limited: Callable[[float, float, float], Pair]) -> str:
    """The robot keeps its path: the turning centre of the limited wheels is where it was."""
    own_work(limited)
    bend = []
    for (left, right), share in zip(_wheel_pairs(40), spread(0.005, 0.95, 40), strict=True):
        most = share * max(abs(left), abs(right))
        slower = ask_numbers(limited, 2, left, right, most)
        v, omega = wheels_to_twist(left, right, 0.5)
        v_slower, omega_slower = wheels_to_twist(*slower, 0.5)
        radius = v / omega if omega else math.inf
        bend.append(abs(v / omega) if omega else 0.0)
        forwards = v * v_slower + omega * omega_slower > 0.0
        if abs(v * omega_slower - omega * v_slower) < 1e-9 and forwards:
            continue
        becomes = abs(v_slower / omega_slower) if omega_slower else math.inf
        hint = f"each wheel is clipped on its own: a curve of radius {abs(radius):.2f} m "
        hint += f"becomes one of {becomes:.2f} m. What must stay the same?"
        expect(not _equal(slower, np.clip((left, right), -most, most)), hint)
        expect(forwards, "the robot stops, or drives the other way.")
        hint = f"the turning centre moves from {radius:.2f} m to the left of the robot; "
        expect(False, hint + "the path must stay, only slower.")
    curves = f"curves of up to {max(bend):.0f} m of radius, keep their centre."
    return f"Turns nearly on the spot, and {curves}"


def _robots() -> list[list[float]]:
    """Rows of _ROBOT, from slow ones to such as no motor drives."""
    sizes = spread(0.1, 50.0, 20)
    rows = zip(sizes, drawn(2, 20, *_ROBOT), strict=True)
    return [[size * one, size * other, *robot] for size, (one, other, *robot) in rows]


def _steps(count: int) -> list[tuple[Pose, float, float, float]]:
    twist = (-3.0, 3.0), (-2.0, 2.0), (0.3, 1.5)
    rows = drawn(8, count, (-5.0, 5.0), (-5.0, 5.0), (-3.0, 3.0), *twist)
    return [(Pose(*row[:3]), *row[3:]) for row in rows]


def _wheel_pairs(count: int) -> list[list[float]]:
    """Straight on, on the spot and about one wheel, then anyhow."""
    named = [[1.2, -1.2], [0.0, 1.0], [-1.0, 0.0], [-1.5, -1.5], [0.7, 0.7]]
    return drawn(9, count - len(named), (-2.0, 2.0), (-2.0, 2.0)) + named
