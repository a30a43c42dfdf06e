"""Checks of what stands around the law on a real robot: the compass, the wheels' counters, and a step that fails safe."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from wmrbook.grading._hints import (
    Passed,
    ask,
    ask_number,
    ask_numbers,
    close,
    expect,
    floats,
    own_work,
    shown,
)
from wmrlib.control import control_law, limit_wheels
from wmrlib.gains import Gains, WheelLimits
from wmrlib.kinematics import Pose, polar_error, twist_to_wheels, wrap_angle

PATIENCE, RADIUS = 0.5, 0.2  # s, m: as the text of the task says
COUNTS = 65536  # of a counter of 16 bits
STOP = (0.0, 0.0)


def compass_known(heading_of: Callable) -> Passed:
    """heading_of(compass_deg, declination_deg): radians, counter-clockwise from east, of a compass that counts clockwise from north."""
    own_work(heading_of)
    for compass, declination in _compasses(20):
        value = ask_number(heading_of, compass, declination)
        right, way = (
            math.pi / 2.0 - math.radians(compass + declination),
            f"{'east' if declination > 0.0 else 'west'} of north",
        )
        if _same_angle(value, right):
            continue
        expect(
            not close(value, math.degrees(right))
            and not close(value, (math.degrees(right) + 180.0) % 360.0 - 180.0),
            _IN_DEGREES,
        )
        for mistaken, hint in [
            (90.0 - compass - declination, "the numbers are degrees where radians are asked for."),
            (
                right + 2.0 * math.radians(declination),
                f"a needle that points {way} shows too {'little' if declination > 0.0 else 'much'}: which sign has the declination?",
            ),
            (right + math.radians(declination), "the declination does not count in your heading."),
            (math.pi - right, "a compass counts clockwise, a heading counter-clockwise."),
            (right - math.pi / 2.0, "a compass counts from north, a heading from east."),
            (
                math.pi / 2.0 - right,
                "this is the compass's bearing in radians: it still counts clockwise and from north.",
            ),
            (
                right + math.pi,
                "your robot looks the other way round: check north, east, south and west by hand.",
            ),
        ]:
            expect(not _same_angle(value, mistaken), hint)
        seen = f"{compass:.0f} deg with a declination of {declination:.1f} deg"
        expect(
            False, f"{seen} come out as {value:.4g} rad: check north, east, south and west by hand."
        )
    return Passed("Twenty compasses, each read as the heading that the law wants.")


def compass_range(heading_of: Callable) -> Passed:
    """The heading is in (-pi, pi], whatever the compass shows; a turn more is the same heading."""
    own_work(heading_of)
    for compass, declination in [
        *_compasses(20),
        (270.0, 0.0),
        (0.0, 0.0),
        (359.9, 4.0),
        (720.0, -3.0),
        (-350.0, 3.0),
    ]:
        value = ask_number(heading_of, compass, declination)
        inside = -math.pi - 1e-12 <= value <= math.pi + 1e-12
        expect(inside, f"{compass:g} deg come out as {value:.4g} rad, which is not in (-pi, pi].")
        expect(
            _same_angle(value, ask_number(heading_of, compass + 360.0, declination)),
            "a whole turn more must be the same heading.",
        )
    turned = wrap_angle(ask_number(heading_of, 50.0, 2.0) - ask_number(heading_of, 40.0, 2.0))
    expect(
        turned < 0.0,
        "when the robot turns to the right, the compass counts up and the heading must count down.",
    )
    return Passed("Always in (-pi, pi]; to the right, the compass counts up and the heading down.")


def ticks_known(rolled: Callable) -> Passed:
    """rolled(before, after, ticks_per_turn, wheel_radius): metres, from two readings of a counter of 16 bits."""
    own_work(rolled)
    for before, ticks, per_turn, radius in _counters(30):
        after = (before + ticks) % COUNTS
        value, metre = (
            ask_number(rolled, before, after, per_turn, radius),
            2.0 * math.pi * radius / per_turn,
        )
        if close(value, ticks * metre, 1e-9, 1e-12):
            continue
        for mistaken, hint in [
            (
                (after - before) * metre,
                "where the counter passes its end, the robot leaps: 65535 is followed by 0.",
            ),
            (
                (after - before) % COUNTS * metre,
                "right for a robot that drives forwards; a wheel that rolls back a little seems to race ahead.",
            ),
            (
                ((after - before + COUNTS // 2) % (COUNTS - 1) - COUNTS // 2) * metre,
                "how many different numbers can the counter show?",
            ),
            (
                -ticks * metre,
                "forwards and backwards are swapped: the counter counts up when the wheel rolls forwards.",
            ),
            (0.5 * ticks * metre, "half as far as it rolled: radius or diameter?"),
            (2.0 * ticks * metre, "twice as far as it rolled: radius or diameter?"),
            (
                ticks * metre / (2.0 * math.pi),
                "how long is the way round the wheel, of the radius r?",
            ),
            (ticks * metre / radius, "this is the angle; how far does the wheel roll?"),
        ]:
            expect(not close(value, mistaken, 1e-9, 1e-12), hint)
        case = (
            f"from {before} to {after}, with {per_turn} ticks a turn and a wheel of {radius:.3f} m"
        )
        expect(False, f"{case}, yours says {value:+.4g} m: count by hand.")
    return Passed("Thirty pairs of readings, forwards, backwards and across the counter's end.")


def ticks_properties(rolled: Callable) -> Passed:
    """The way there and back is nothing, and two parts of a way add up to the whole."""
    own_work(rolled)
    for before, ticks, per_turn, radius in _counters(10):
        part, after = (before + ticks // 3) % COUNTS, (before + ticks) % COUNTS
        whole = ask_number(rolled, before, after, per_turn, radius)
        back = ask_number(rolled, after, before, per_turn, radius)
        expect(close(whole, -back), "there and back must add up to nothing.")
        parts = ask_number(rolled, before, part, per_turn, radius) + ask_number(
            rolled, part, after, per_turn, radius
        )
        expect(
            close(whole, parts),
            "two parts of a way must add up to the whole way, wherever the counter passes its end.",
        )
        expect(
            close(2.0 * whole, ask_number(rolled, before, after, per_turn, 2.0 * radius)),
            "a wheel twice as large rolls twice as far.",
        )
    turn = ask_number(rolled, 65000, 264, 800, 0.1)
    expect(
        close(turn, 0.2 * math.pi),
        f"from 65000 to 264 are 800 ticks: one turn of a wheel with 800 ticks; yours rolls {turn:.4g} m.",
    )
    return Passed(
        f"From 65000 to 264 is one turn of 800 ticks: {turn:.3f} m with a wheel of 0.1 m."
    )


def step_stops(wheel_speeds: Callable) -> Passed:
    """wheel_speeds(x, y, heading, age, goal, gains, limits) -> (left, right): (0, 0) for nonsense, for old news and at the goal."""
    case = Pose(0.0, 0.0, 0.0), Gains(0.2, 2.0, 2.0, 4.0), WheelLimits(0.5, 2.0)
    fine = {"x": -5.0, "y": 1.0, "heading": 0.3, "age": 0.1}
    for name in fine:
        why = (
            "an age that is not finite can't be trusted."
            if name == "age"
            else "a pose that is not finite is no pose."
        )
        for nonsense in (math.nan, math.inf, -math.inf):
            _expect_stop(wheel_speeds, fine | {name: nonsense}, case, f"{name} = {nonsense}", why)
    for age in (0.51, 0.7, 3600.0):
        _expect_stop(
            wheel_speeds,
            fine | {"age": age},
            case,
            f"a fix {age:g} s old",
            "silence for more than 0.5 s stops the robot.",
        )
    _expect_stop(
        wheel_speeds,
        fine | {"age": -0.1},
        case,
        "a fix 0.1 s from now",
        "a clock that runs backwards can't be trusted.",
    )
    random = np.random.default_rng(111)
    for _ in range(20):
        far, sight, heading, look = random.uniform(
            (0.0, -3.0, -3.0, -3.0), (0.19, 3.0, 3.0, 3.0)
        ).tolist()
        at = {
            "x": 7.0 - far * math.cos(sight),
            "y": -3.0 - far * math.sin(sight),
            "heading": look,
            "age": 0.0,
        }
        _expect_stop(
            wheel_speeds,
            at,
            (Pose(7.0, -3.0, heading), *case[1:]),
            f"{far:.2f} m from the goal",
            "within 0.2 m it has arrived.",
        )
    return Passed(
        "12 kinds of nonsense, old news, a clock that runs backwards, 20 arrivals: the wheels get (0, 0)."
    )


def step_drives(wheel_speeds: Callable) -> Passed:
    """Otherwise the wheels get the corrected law, scaled to their limits."""
    for pose, age, goal, gains, limits in _drives(60):
        left, right = ask_numbers(wheel_speeds, 2, *pose, age, goal, gains, limits)
        v, omega = control_law(*polar_error(pose, goal), gains)
        wanted = twist_to_wheels(*limit_wheels(v, omega, limits), limits.track_width)
        if np.allclose((left, right), wanted, rtol=1e-6, atol=1e-9):
            continue
        free = twist_to_wheels(v, omega, limits.track_width)
        clipped = np.clip(free, -limits.max_speed, limits.max_speed)
        place = f"at ({pose.x:.1f}, {pose.y:.1f}) with heading {pose.heading:.2f}, {age:.2f} s old,"
        expect((left, right) != STOP, f"{place} the robot stops; it has no reason to.")
        expect(not np.allclose((right, left), wanted), "left and right are swapped.")
        hint = f"a wheel is asked for {max(abs(left), abs(right)):.3g} m/s and has {limits.max_speed:.2f} m/s."
        expect(not np.allclose((left, right), free), hint)
        expect(
            not np.allclose((left, right), clipped),
            "both wheels are clipped one by one, which bends the path: chapter 8 has a better rule.",
        )
        twists = (v, omega), limit_wheels(v, omega, limits)
        expect(
            not any(np.allclose((left, right), each) for each in twists),
            "this is a twist (v, omega); the wheels' speeds are asked for.",
        )
        expect(
            False,
            f"{place} the wheels get ({left:.3g}, {right:.3g}) m/s, which is not the corrected law within their limits.",
        )
    return Passed("Sixty poses: the law's wheels, never beyond their limits.")


_IN_DEGREES = "this is the heading in degrees; radians are asked for."


def _same_angle(one: float, other: float) -> bool:
    return abs(math.remainder(one - other, 2.0 * math.pi)) < 1e-9


def _compasses(count: int) -> list[list[float]]:
    return np.random.default_rng(110).uniform((0.0, -15.0), (360.0, 15.0), (count, 2)).tolist()


def _counters(count: int) -> list[tuple[int, int, int, float]]:
    """(before, ticks, ticks_per_turn, wheel_radius): first without passing the end, then across it, forwards and backwards."""
    random, found = (
        np.random.default_rng(112),
        [(1000, 500, 800, 0.1), (65000, 2000, 800, 0.1), (40000, -700, 800, 0.1)],
    )
    while len(found) < count:
        row = random.integers(0, COUNTS), random.integers(-32000, 32000), random.integers(100, 4000)
        found.append((*map(int, row), float(random.uniform(0.03, 0.4))))
    return found


def _expect_stop(
    wheel_speeds: Callable, at: dict[str, float], case: tuple, what: str, why: str
) -> None:
    answer = ask(wheel_speeds, at["x"], at["y"], at["heading"], at["age"], *case)
    speeds = floats(answer)
    expect(
        speeds is not None and speeds.shape == (2,),
        f"with {what} the robot gets {shown(answer)}; two speeds are needed, whatever happens.",
    )
    left, right = speeds.tolist()
    expect(
        (left, right) == STOP,
        f"with {what} the wheels get ({left:.3g}, {right:.3g}) m/s, not (0, 0): {why}",
    )


def _drives(count: int) -> list[tuple[Pose, float, Pose, Gains, WheelLimits]]:
    random, found = np.random.default_rng(113), []
    for k in range(count):
        goal, far, sight = (
            Pose(*random.uniform(-3.0, 3.0, 3).tolist()),
            random.uniform(0.25, 20.0),
            random.uniform(-3.0, 3.0),
        )
        pose = Pose(
            goal.x - far * math.cos(sight),
            goal.y - far * math.sin(sight),
            random.uniform(-3.0, 3.0),
        )
        gains = Gains(*random.uniform((0.1, 0.5, 0.2, 1.0), (1.0, 3.0, 3.0, 4.0)).tolist())
        age = 0.5 if k == 0 else random.uniform(0.0, 0.5)
        found.append(
            (
                pose,
                age,
                goal,
                gains,
                WheelLimits(random.uniform(0.3, 1.0), random.uniform(0.8, 3.0)),
            )
        )
    return found
