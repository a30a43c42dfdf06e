"""Exercises on places, ways and logs: where a point lies, a robot is, or has driven."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from itertools import islice, permutations
from typing import Any

from wmrbook.grading import _earth, earth
from wmrbook.grading._asking import ask, ask_numbers, numbers
from wmrbook.grading._hints import Hint, close, drawn, expect, own_work, rule_out, same_pose
from wmrbook.grading.exercises._form import exercise, near
from wmrlib import paper
from wmrlib.geodesy import EARTH_RADIUS_M, GeoPoint, point_at
from wmrlib.kinematics import PolarError, Pose, advance, pose_from_polar, wheels_to_twist


@exercise
def third_formula(distance: Callable) -> str:
    """1.4: distance(lat_1, lon_1, lat_2, lon_2), degrees in, metres out."""
    scales = []
    for a, b in _earth.places(20):
        value, right = _earth.between(distance, a, b), earth.haversine_distance(a, b)
        scales.append(value / right)
        degrees = earth.haversine_distance(*_earth.in_degrees(a, b))
        across = EARTH_RADIUS_M * math.sin(right / EARTH_RADIUS_M)
        mistakes = {
            "degrees go into a sine: `math.radians` first.": degrees,
            "an angle is wanted, and this is its sine: where is the dot product?": across,
        }
        rule_out(value, mistakes)
    alike, first = all(close(scale, scales[0]) for scale in scales), scales[0]
    angle = "this is the angle: times the Earth's radius it is the distance."
    expect(not (alike and close(first, 1.0 / EARTH_RADIUS_M)), angle)
    hint = f"each distance is {first:.7g} times the right one: metres, on a sphere with "
    expect(not alike or close(first, 1.0), f"{hint}a radius of {EARTH_RADIUS_M:.0f} m, are wanted.")
    hint = "the distance of two known places is wrong: is each vector of length 1, and the angle "
    expect(alike, f"{hint}an atan2 of cross and dot product?")
    earth.distance_close(distance)
    bounds = (-60.0, 60.0), (-170.0, 170.0), (-0.7, 0.7), (-0.7, 0.7)
    for lat, lon, *offset in drawn(6, 20, *bounds):  # to less than a metre from the far side
        a, near = GeoPoint(lat=lat, lon=lon), point_at(GeoPoint(lat=lat, lon=lon), *offset)
        far = GeoPoint(lat=-near.lat, lon=near.lon - math.copysign(180.0, near.lon))
        half, value = math.pi * EARTH_RADIUS_M, _earth.between(distance, a, far)
        hint = f"half way round the Earth less {math.hypot(*offset):.4f} m comes out as less "
        hint += f"{half - value:.4f} m: there (12) loses its digits, and is not asked for."
        expect(close(half - value, math.hypot(*offset), 0.0, 1e-6), hint)
    return "Right all over the Earth: for a centimetre, and half way round."


@exercise
def campus(answer: Any) -> str:
    """1.5: the decimals, and how far the flat map may reach at the paper's latitude and at 60."""
    decimals, *radii = numbers("`answer`", answer, 3)
    hint = "decimals are counted: a whole number, from 0 to 15, is wanted."
    expect(decimals in range(16), hint)
    half = math.radians(0.5 * 10.0**-decimals) * EARTH_RADIUS_M
    for lat, far in zip((paper.GPS_POINT_1.lat, 60.0), radii, strict=True):
        rounding = math.hypot(half, half * math.cos(math.radians(lat)))
        hint = f"{decimals:.0f} decimals move a point by up to {100.0 * rounding:.2f} cm, "
        expect(rounding < 0.01, f"{hint}more than the map may be off in all.")
        expect(far > 0.0, "how far the map may reach is a distance, and that is positive.")
        per_square = _flat_error(lat, 100.0) / 100.0**2
        hint += f"and {far:.4g} m away at {lat:.0f} deg the flat map does by "
        hint += f"{100.0 * per_square * far * far:.2f} cm: "
        limit = math.sqrt((0.01 - rounding) / per_square)
        expect(far <= limit + 0.5, f"{hint}in all more than 1 cm.")  # metres may be rounded
        expect(far > 0.95 * limit, f"{hint}it may reach further.")
    return "Right: the points' rounding and the flat map share the centimetre."


def _flat_error(lat: float, far: float) -> float:
    """How far chapter 1's flat map is from the exact one, in the worst direction."""
    origin, errors = GeoPoint(lat=lat, lon=0.0), []
    for turn in range(72):
        exact = _on_circle((0.0, 0.0), far, turn * math.pi / 36.0)
        point = point_at(origin, *exact)
        wide = math.radians(point.lon) * math.cos(math.radians(lat))
        flat = EARTH_RADIUS_M * wide, EARTH_RADIUS_M * math.radians(point.lat - lat)
        errors.append(math.dist(flat, exact))
    return max(errors)


@exercise
def odometry(path: Callable, ends: Any = None) -> str:
    """2.4: path(log, width, dt), a log of (left, right) in m/s, returns (x, y, heading).

    `ends` is where the log of the exercise ends, and where Euler's step says it does: x, y, x, y.
    """
    own_work(path)
    for seed in range(6):
        log = [*drawn(seed, 12, *[(-1.0, 1.0)] * 2), (0.4, 0.4), (0.3, -0.3), (0.0, 0.0)]
        width, dt = 0.3 + 0.1 * seed, 0.7 - 0.1 * seed
        value = ask_numbers(path, 3, [tuple(entry) for entry in log], width, dt)
        old, mid, new = (_driven(log, width, dt, turned=share) for share in (0.0, 0.5, 1.0))
        mistakes = {
            "these are Euler's straight steps: on an arc the robot turns on its way.": old,
            "the direction is right, and the step too long: "
            "the chord is shorter than its arc.": mid,
            "this robot turns first and then drives: on an arc it does both at once.": new,
            "this robot turns right where it should turn left.": _driven(log, width, dt, side=-1),
        }
        right, near = _driven(log, width, dt), partial(same_pose, tolerance=1e-6)
        if not near(value, right):
            _expect_radians(value, right)
            rule_out(value, mistakes, near)
            wrong = "the path ends elsewhere: "
            raise Hint(f"{wrong}try one step straight on, one on the spot, one on an arc.")
    x, y, *by_euler = numbers("The function is right. `ends`", ends, 4)
    log = [(0.8, 1.2)] * 10 + [(1.2, 0.8)] * 10
    euler = by_euler, 0.0, "Euler's path ends"
    for place, turned, who in (((x, y), None, "the robot ends"), euler):
        right = _driven(log, 0.6, 0.5, turned=turned)[:2]
        hint = f"the function is right, but {who} elsewhere: 10 pairs (0.8, 1.2), then 10 of them "
        expect(math.dist(place, right) < 0.011, f"{hint}turned round, 0.6 m wide, each for 0.5 s.")
    return "Right for six logs, turning both ways and not at all. Euler ends elsewhere."


def _driven(log, width: float, dt: float, side: int = 1, turned: float | None = None) -> Pose:
    """Where a log leads: by arcs, or by straight steps after that share of each turn."""
    at = Pose(0.0, 0.0, 0.0)
    for left, right in log:
        v, omega = wheels_to_twist(left, right, width)
        after = advance(at, v, side * omega, dt)
        if turned is not None:
            begin = at._replace(heading=at.heading + turned * omega * dt)
            after = advance(begin, v, 0.0, dt)._replace(heading=after.heading)
        at = after
    return at


@exercise
def back_to_the_pose(pose: Callable, colleague: Any = None) -> str:
    """3.4: pose(rho, alpha, theta, goal) returns (x, y, heading); `colleague`: m, m, deg."""
    own_work(pose)
    bounds = (0.1, 9.0), (-3.0, 3.0), (-3.0, 3.0), (-5.0, 5.0), (-5.0, 5.0), (-3.0, 3.0)
    for far, ahead, beside, *at in drawn(3, 20, *bounds):
        goal = Pose(*at)
        value = ask_numbers(pose, 3, far, ahead, beside, goal)
        opposite = far, ahead + math.pi, beside + math.pi
        other, from_x = (far, -ahead, beside), (far, ahead, beside - goal.heading)
        mistakes = {
            "the robot is on the other side of the goal: rho leads back.": opposite,
            "theta has the other sign here; is it Corke's beta?": (far, ahead, -beside),
            "alpha is the line of sight less the heading, not the other way.": other,
            "the line of sight is theta from the goal's heading, not from x.": from_x,
        }
        poses = {
            hint: pose_from_polar(PolarError(*error), goal) for hint, error in mistakes.items()
        }
        right = pose_from_polar(PolarError(far, ahead, beside), goal)
        if not same_pose(value, right):
            rule_out(value, poses, same_pose)
            _expect_radians(value, right)
            hint = "the place is right, the heading is not: the line of sight's less alpha."
            expect(math.dist(value[:2], right[:2]) >= 1e-7, hint)
            raise Hint("the way back misses: draw the line of sight first.")
    *place, degrees = numbers("The function is right. `colleague`", colleague, 3)
    north, log = Pose(0.0, 0.0, math.pi / 2), (5.0, math.radians(-20.0))
    turned = math.radians(degrees)
    mistakes = {
        "degrees are wanted for the heading.": (math.radians(-35.0), degrees),
        "beta went in for theta, and they have opposite signs.": (math.radians(35.0), turned),
    }
    right = pose_from_polar(PolarError(*log, math.radians(-35.0)), north)
    if not _same_place((*place, turned), right):
        for hint, (beside, heading) in mistakes.items():
            robot = pose_from_polar(PolarError(*log, beside), north)
            expect(not _same_place((*place, heading), robot), f"the function is right; {hint}")
        hint = "the function is right; the colleague's robot is elsewhere, or a digit is missing."
        raise Hint(hint)
    return "Right: twenty poses come back, and the colleague's robot is found."


def _expect_radians(value: Sequence[float], right: Pose) -> None:
    """Raise Hint if all that is wrong with a pose is that its heading is in degrees."""
    in_degrees = same_pose((*value[:2], math.radians(value[2])), right, 1e-6)
    expect(not in_degrees, "the heading is wanted in radians.")


def _same_place(one: Sequence[float], other: Sequence[float]) -> bool:
    """To a centimetre and a degree."""
    turned = math.remainder(one[2] - other[2], 2.0 * math.pi)
    return math.dist(one[:2], other[:2]) < 0.011 and abs(turned) < math.radians(1.0)


@exercise
def three_readings(centre: Callable) -> str:
    """11.4: centre(a, b, c), readings (x, y) on a circle, returns its centre."""
    bounds = (-40, 40), (-40, 40), (20, 50), (-3, 3), (0.2, 2.9), (0.2, 2.9)
    circles = [
        (middle, [_on_circle(middle, radius, turn + arc) for arc in (0.0, one, one + two)][::way])
        for way in (1, -1)  # a robot may turn either way
        for *middle, radius, turn, one, two in drawn(5, 10, *bounds)
    ]
    corners = (1.0, 1.0), (3.0, 1.0), (3.0, 5.0)  # lines along the axes have no slope
    circles += [((2.0, 3.0), on) for on in permutations(corners)]
    for middle, on in circles:
        value, mean = ask_numbers(centre, 2, *on), [sum(axis) / 3 for axis in zip(*on, strict=True)]
        if math.dist(value, middle) > 1e-6:
            hint = "this is the mean of the readings, which lie on one side of the circle."
            rule_out(value, {hint: mean}, near)
            raise Hint("the centre is not as far from each of the readings: test it with a circle.")
    return "Right for twenty compasses, and for readings in line with the axes."


def _on_circle(middle: Sequence[float], radius: float, turn: float) -> tuple[float, float]:
    return middle[0] + radius * math.cos(turn), middle[1] + radius * math.sin(turn)


@exercise
def walk(keep: Callable) -> str:
    """12.4: keep(fixes), of (seconds, east, north), those that can be walked to."""
    for seed in range(4):
        t, fixes = 0.0, []
        for a, b, seconds in drawn(seed, 60, (-1.0, 1.0), (0.0, 1.0), (0.4, 2.0)):
            fixes.append((t, 1.2 * t + a, 50.0 if fixes and b > 0.8 else a))
            t += seconds
        answer = ask(keep, list(fixes))
        hint = "a list of fixes is wanted, (seconds, east, north) each."
        try:
            track = [tuple(map(float, fix)) for fix in islice(answer, 99)]  # it may never end
        except (TypeError, ValueError):
            raise Hint(hint) from None
        expect({len(fix) for fix in track} <= {3}, hint)
        expect(track[:1] == fixes[:1], "the first fix is to be kept.")
        hint = "each fix is compared with the one before it: compare with the last one *kept*."
        expect(track != _walked(fixes, of_all=True), hint)
        expect(track == _walked(fixes), "it keeps other fixes: 3 m/s, over the time between them.")
    return "Right for four walks."


def _walked(fixes: list, of_all: bool = False) -> list:
    track = before = fixes[:1]
    for fix in fixes[1:]:
        seconds, *to = fix
        if math.dist(to, before[-1][1:]) <= 3.0 * (seconds - before[-1][0]):
            track = [*track, fix]
        before = [fix] if of_all else track
    return track
