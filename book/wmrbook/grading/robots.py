"""Checks of what a real robot adds: the compass, the wheels' counters, a step that fails safe."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from functools import partial

import numpy as np

from wmrbook.grading._asking import ask, ask_number, ask_numbers, floats
from wmrbook.grading._hints import (
    angle_equal,
    close,
    drawn,
    expect,
    explain,
    own_work,
    shown,
    slip,
    spread,
)
from wmrlib.body import Wheels
from wmrlib.control import control_law, limit_wheels
from wmrlib.gains import GENTLE_GAINS, Gains
from wmrlib.kinematics import Pose, polar_error, twist_to_wheels, wrap_angle

COUNTS = 65536  # of a counter of 16 bits
STOP = (0.0, 0.0)
_COMPASS = (0.0, 360.0), (-15.0, 15.0)  # what it shows, and the declination, deg
_BY_HAND = "check north, east, south and west by hand."
_same_way = partial(close, relative=1e-9, absolute=1e-12)


def compass_known(heading_of: Callable) -> str:
    """heading_of(compass_deg, declination_deg): radians, counter-clockwise from east."""
    own_work(heading_of)
    for compass, declination in drawn(110, 20, *_COMPASS):
        value, turn = ask_number(heading_of, compass, declination), math.radians(declination)
        right = math.pi / 2.0 - math.radians(compass) - turn
        if angle_equal(value, right):
            continue
        degrees = math.degrees(right), (math.degrees(right) + 180.0) % 360.0 - 180.0
        in_degrees = any(close(value, angle) for angle in degrees)
        expect(not in_degrees, "this is the heading in degrees; radians are asked for.")
        east = declination > 0.0
        needle = f"a needle that points {'east' if east else 'west'} of north"
        mistakes = {
            f"{needle} shows too {'little' if east else 'much'}: "
            "which sign has the declination?": right + 2.0 * turn,
            "the declination does not count in your heading.": right + turn,
            "a compass counts clockwise, a heading counter-clockwise.": math.pi - right,
            "a compass counts from north, a heading from east.": right - math.pi / 2.0,
            "this is the compass's bearing in radians: "
            "it still counts clockwise and from north.": math.pi / 2.0 - right,
            f"your robot looks the other way round: {_BY_HAND}": right + math.pi,
        }
        case = f"{compass:.0f} deg with a declination of {declination:.1f} deg"
        right += math.tau * round((value - right) / math.tau)
        hint = f"{case} come out as {value:.4g} rad: {_BY_HAND}"
        explain(value, mistakes, hint, angle_equal, right)
    return "Twenty compasses, each read as the heading that the law wants."


def compass_range(heading_of: Callable) -> str:
    """The heading is in (-pi, pi], whatever the compass shows; a turn more changes nothing."""
    own_work(heading_of)
    edges = [(270.0, 0.0), (0.0, 0.0), (359.9, 4.0), (720.0, -3.0), (-350.0, 3.0)]
    for compass, declination in [*drawn(110, 20, *_COMPASS), *edges]:
        value = ask_number(heading_of, compass, declination)
        hint = f"{compass:g} deg come out as {value:.7g} rad, which is not in (-pi, pi]."
        expect(abs(value) <= math.pi + 1e-12, hint)
        more = ask_number(heading_of, compass + 360.0, declination)
        expect(angle_equal(value, more), "a whole turn more must be the same heading.")
    turned = wrap_angle(ask_number(heading_of, 50.0, 2.0) - ask_number(heading_of, 40.0, 2.0))
    hint = "when the robot turns to the right, "
    expect(turned < 0.0, f"{hint}the compass counts up and the heading must count down.")
    return "Always in (-pi, pi]; to the right, the compass counts up and the heading down."


def ticks_known(rolled: Callable) -> str:
    """rolled(before, after, ticks_per_turn, wheel_radius): metres, of a counter of 16 bits."""
    own_work(rolled)
    for before, ticks, per_turn, radius in _counters(30):
        after, metre = (before + ticks) % COUNTS, 2.0 * math.pi * radius / per_turn
        value = ask_number(rolled, before, after, per_turn, radius)
        right, counted = ticks * metre, after - before
        if _same_way(value, right):
            continue
        leap, short = counted * metre, (counted + COUNTS // 2) % (COUNTS - 1) - COUNTS // 2
        mistakes = {
            "where the counter passes its end, the robot leaps: 65535 is followed by 0.": leap,
            "right for a robot that drives forwards; "
            "a wheel that rolls back a little seems to race ahead.": counted % COUNTS * metre,
            "how many different numbers can the counter show?": short * metre,
            "forwards and backwards are swapped: "
            "the counter counts up when the wheel rolls forwards.": -right,
            "half as far as it rolled: radius or diameter?": 0.5 * right,
            "twice as far as it rolled: radius or diameter?": 2.0 * right,
            "how long is the way round the wheel, of the radius r?": right / (2.0 * math.pi),
            "this is the angle; how far does the wheel roll?": right / radius,
        }
        case = f"from {before} to {after}, with {per_turn} ticks a turn "
        case += f"and a wheel of {radius:.3f} m, yours says {value:+.4g} m: count by hand."
        explain(value, mistakes, case, _same_way, right)
    return "Thirty pairs of readings, forwards, backwards and across the counter's end."


def ticks_properties(rolled: Callable) -> str:
    """The way there and back is nothing, and two parts of a way add up to the whole."""
    own_work(rolled)
    for before, ticks, per_turn, radius in _counters(10):
        part, after = (before + ticks // 3) % COUNTS, (before + ticks) % COUNTS
        whole, back, first, second = (
            ask_number(rolled, *ends, per_turn, radius)
            for ends in ((before, after), (after, before), (before, part), (part, after))
        )
        expect(close(whole, -back), "there and back must add up to nothing.")
        hint = "two parts of a way must add up to the whole way, "
        expect(close(whole, first + second), f"{hint}wherever the counter passes its end.")
        large = ask_number(rolled, before, after, per_turn, 2.0 * radius)
        expect(close(2.0 * whole, large), "a wheel twice as large rolls twice as far.")
    turn = ask_number(rolled, 65000, 264, 800, 0.1)
    hint = "from 65000 to 264 are 800 ticks: one turn of a wheel with 800 ticks; "
    expect(close(turn, 0.2 * math.pi), f"{hint}yours rolls {turn:.4g} m.")
    turn = f"{turn:.3f} m with a wheel of 0.1 m."
    return f"From 65000 to 264 is one turn of 800 ticks: {turn}"


def step_stops(wheel_speeds: Callable) -> str:
    """wheel_speeds(x, y, heading, age, goal, gains, limits): (0, 0) if in doubt or arrived."""
    given = Pose(0.0, 0.0, 0.0), GENTLE_GAINS, Wheels(0.5, 2.0)
    fine = {"x": -5.0, "y": 1.0, "heading": 0.3, "age": 0.1}
    for name, value in itertools.product(fine, (math.nan, math.inf, -math.inf)):
        why = f"without its {name} a fix can't be trusted."
        _expect_stop(wheel_speeds, fine | {name: value}, given, f"{name} = {value}", why)
    for seconds in spread(1e-3, 3600.0, 20):
        what, why = (
            f"a fix {0.5 + seconds:.4g} s old",
            "silence for more than 0.5 s stops the robot.",
        )
        _expect_stop(wheel_speeds, fine | {"age": 0.5 + seconds}, given, what, why)
    for seconds in spread(1e-9, 10.0, 10):
        what, why = (
            f"a fix {seconds:.2g} s from now",
            "a clock that runs backwards can't be trusted.",
        )
        _expect_stop(wheel_speeds, fine | {"age": -seconds}, given, what, why)
    angles = drawn(111, 20, *[(-3.0, 3.0)] * 3)
    for near, (sight, heading, look) in zip(spread(1e-3, 0.2, 20), angles, strict=True):
        far = 0.2 - near
        place = {"x": 7.0 - far * math.cos(sight), "y": -3.0 - far * math.sin(sight)}
        at, there = place | {"heading": look, "age": 0.0}, Pose(7.0, -3.0, heading)
        what, why = f"{far:.3f} m from the goal", "within 0.2 m it has arrived."
        _expect_stop(wheel_speeds, at, (there, *given[1:]), what, why)
    nonsense = "12 kinds of nonsense, old news, a clock that runs backwards, 20 arrivals"
    return f"{nonsense}: the wheels get (0, 0)."


def step_drives(wheel_speeds: Callable) -> str:
    """Otherwise the wheels get the corrected law, scaled to their limits."""
    for pose, age, goal, gains, limits in _situations(60):
        left, right = speeds = ask_numbers(wheel_speeds, 2, *pose, age, goal, gains, limits)
        twist = control_law(*polar_error(pose, goal), gains)
        limited = limit_wheels(*twist, limits)
        correct = twist_to_wheels(*limited, limits.track_width)
        uncorrected = control_law(*polar_error(pose, goal), gains, "printed")
        printed = twist_to_wheels(*limit_wheels(*uncorrected, limits), limits.track_width)
        if np.allclose(speeds, correct, rtol=1e-6, atol=1e-9):
            continue
        place = f"at ({pose.x:.1f}, {pose.y:.1f}) with heading {pose.heading:.2f}, {age:.2f} s old,"
        expect(speeds != STOP, f"{place} the robot stops; it has no reason to.")
        free = twist_to_wheels(*twist, limits.track_width)
        asked, most = f"a wheel is asked for {max(map(abs, speeds)):.3g} m/s", limits.max_speed
        slip(speeds, correct)
        mistakes = {
            "left and right are swapped.": correct[::-1],
            "this is the law as the paper prints it, (24); the corrected one is (4.6).": printed,
            f"{asked} and has {most:.2f} m/s.": free,
            "both wheels are clipped one by one, which bends the path: "
            "chapter 8 has a better rule.": np.clip(free, -most, most),
            "this is a twist (v, omega); the wheels' speeds are asked for.": twist,
            "this is a twist (v, omega), limited; the wheels' speeds are asked for.": limited,
        }
        hint = f"{place} the wheels get ({left:.3g}, {right:.3g}) m/s, "
        explain(speeds, mistakes, f"{hint}which is not the law within their limits.", np.allclose)
    return "Sixty poses: the law's wheels, never beyond their limits."


def _counters(count: int) -> list[tuple[int, int, int, float]]:
    """(before, ticks, ticks_per_turn, wheel_radius): first short of the end, then across it."""
    random = np.random.default_rng(112)
    counters = [(1000, 500, 800, 0.1), (65000, 2000, 800, 0.1), (40000, -700, 800, 0.1)]
    while len(counters) < count:
        row = random.integers((0, -32000, 100), (COUNTS, 32000, 4000)).tolist()
        counters.append((*row, float(random.uniform(0.03, 0.4))))
    return counters


def _expect_stop(wheel_speeds: Callable, at: dict, given: tuple, what: str, why: str) -> None:
    answer = ask(wheel_speeds, *at.values(), *given)
    speeds = floats(answer)
    hint = f"with {what} the robot gets {shown(answer)}; two speeds are needed, whatever happens."
    expect(speeds is not None and speeds.shape == (2,), hint)
    left, right = speeds.tolist()
    hint = f"with {what} the wheels get ({left:.3g}, {right:.3g}) m/s, not (0, 0): {why}"
    expect((left, right) == STOP, hint)


def _situations(count: int) -> list[tuple[Pose, float, Pose, Gains, Wheels]]:
    """Fixes at most 0.5 s old, from a millimetre more than 0.2 m away to 20 m."""
    random, situations = np.random.default_rng(113), []
    for k, near in enumerate(spread(1e-3, 20.0, count)):
        goal = Pose(*random.uniform(-3.0, 3.0, 3).tolist())
        far, (sight, look) = 0.2 + near, random.uniform(-3.0, 3.0, 2).tolist()
        pose = Pose(goal.x - far * math.cos(sight), goal.y - far * math.sin(sight), look)
        gains = Gains(*random.uniform((0.1, 0.5, 0.2, 1.0), (1.0, 3.0, 3.0, 4.0)).tolist())
        age = 0.5 if k == 0 else random.uniform(0.0, 0.5)
        limits = Wheels(*random.uniform((0.3, 0.8), (1.0, 3.0)).tolist())
        situations.append((pose, age, goal, gains, limits))
    return situations
