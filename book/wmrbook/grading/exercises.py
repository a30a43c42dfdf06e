"""Checks of the exercises at the chapters' ends, of those that a few numbers or lines answer.

They print what the checks of the course raise: a sentence if an answer is right, else a hint. So a
chapter runs while they wait for an answer. What an answer prints comes before, shortened.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from contextlib import redirect_stdout
from functools import partial, wraps
from io import StringIO
from itertools import islice, permutations
from typing import Any

import sympy as sp

from wmrbook.grading import _earth, earth
from wmrbook.grading._asking import ask, ask_numbers, number, numbers
from wmrbook.grading._expressions import equal_at, expression, points
from wmrbook.grading._hints import (
    Hint,
    close,
    drawn,
    expect,
    explain,
    named,
    own_work,
    rule_out,
    same_pose,
    shown,
)
from wmrlib import paper
from wmrlib.control import control_law
from wmrlib.geodesy import EARTH_RADIUS_M, GeoPoint, point_at
from wmrlib.kinematics import PolarError, Pose, advance, pose_from_polar, wheels_to_twist
from wmrlib.symbolic import L, alpha, h, k_alpha, k_rho, lyapunov_rate, omega_ref, rho, theta, v_ref

_PRINTED = 2000  # characters; more would push the hint out of sight
_ROUNDED = 1.00003  # of what was computed with steps of one's own
_POSITIVE = "gains are positive: a negative one drives the robot away from its goal."
_SQUARED = "look at v_max: by how much is the braking larger at twice the speed?"


def _exercise(check: Callable[..., str]) -> Callable[..., str]:
    """Return the check that returns its hints, whatever an answer does."""

    @wraps(check)
    def told(*answers: Any) -> str:
        try:
            with redirect_stdout(StringIO()) as printed:
                said = check(*answers)
        except Hint as hint:
            said = f"Hint: {hint}"
        except BaseException as error:  # of a value of a student's own class
            said = f"Hint: the check stops with {named(error)}."
        if text := printed.getvalue().rstrip():
            print(text if len(text) <= _PRINTED else f"{text[:_PRINTED]}...")
        return said

    return told


@_exercise
def third_formula(distance: Callable) -> str:
    """1.2: distance(lat_1, lon_1, lat_2, lon_2), degrees in, metres out."""
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
    alike, first = all(close(each, scales[0]) for each in scales), scales[0]
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


@_exercise
def campus(answer: Any) -> str:
    """1.3: the decimals, and how far the flat map may reach at the paper's latitude and at 60."""
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


@_exercise
def odometry(path: Callable, ends: Any = None) -> str:
    """2.2: path(log, width, dt), a log of (left, right) in m/s, returns (x, y, heading).

    `ends` is where the log of the exercise ends, and where Euler's step says it does: x, y, x, y.
    """
    own_work(path)
    for seed in range(6):
        log = [*drawn(seed, 12, *[(-1.0, 1.0)] * 2), (0.4, 0.4), (0.3, -0.3), (0.0, 0.0)]
        width, dt = 0.3 + 0.1 * seed, 0.7 - 0.1 * seed
        value = ask_numbers(path, 3, [tuple(each) for each in log], width, dt)
        mistakes = {
            "these are Euler's straight steps: on an arc the robot turns on its way.": (1, 0.0),
            "the direction is right, and the step too long: the chord is shorter than its arc.": (
                1,
                0.5,
            ),
            "this robot turns first and then drives: on an arc it does both at once.": (1, 1.0),
            "this robot turns right where it should turn left.": (-1,),
        }
        found = {hint: _driven(log, width, dt, *how) for hint, how in mistakes.items()}
        right, near = _driven(log, width, dt), partial(same_pose, tolerance=1e-6)
        if not near(value, right):
            _expect_radians(value, right)
            wrong = "the path ends elsewhere: "
            wrong += "try one step straight on, one on the spot, one on an arc."
            explain(value, found, wrong, near)
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


@_exercise
def back_to_the_pose(pose: Callable, there: Any = None) -> str:
    """3.2: pose(rho, alpha, theta, goal) returns (x, y, heading); `there`: m, m, deg of the log."""
    own_work(pose)
    bounds = (0.1, 9.0), (-3.0, 3.0), (-3.0, 3.0), (-5.0, 5.0), (-5.0, 5.0), (-3.0, 3.0)
    for far, ahead, beside, *at in drawn(3, 20, *bounds):
        goal = Pose(*at)
        value = ask_numbers(pose, 3, far, ahead, beside, goal)
        other, from_x = (far, -ahead, beside), (far, ahead, beside - goal.heading)
        mistakes = {
            "the robot is on the other side of the goal: rho leads back.": (-far, ahead, beside),
            "theta has the other sign here; is it Corke's beta?": (far, ahead, -beside),
            "alpha is the line of sight less the heading, not the other way.": other,
            "the line of sight is theta from the goal's heading, not from x.": from_x,
        }
        found = {hint: _inverse(goal, *each) for hint, each in mistakes.items()}
        right = pose_from_polar(PolarError(far, ahead, beside), goal)
        if not same_pose(value, right):
            rule_out(value, found, same_pose)
            _expect_radians(value, right)
            placed = math.dist(value[:2], right[:2]) < 1e-7
            hint = "the place is right, the heading is not: the line of sight's less alpha."
            expect(not placed, hint)
            raise Hint("the way back misses: draw the line of sight first.")
    *place, degrees = numbers("The function is right. `there`", there, 3)
    north, log = Pose(0.0, 0.0, math.pi / 2), (5.0, math.radians(-20.0))
    turned = math.radians(degrees)
    mistakes = {
        "degrees are wanted for the heading.": (math.radians(-35.0), degrees),
        "beta went in for theta, and they have opposite signs.": (math.radians(35.0), turned),
    }
    right = _inverse(north, *log, math.radians(-35.0))
    if not _seen_there((*place, turned), right):
        for hint, (beside, heading) in mistakes.items():
            found = _inverse(north, *log, beside)
            expect(not _seen_there((*place, heading), found), f"the function is right; {hint}")
        hint = "the colleague's robot is elsewhere, or a digit is missing."
        raise Hint(f"the function is right; {hint}")
    return "Right: twenty poses come back, and the colleague's robot is found."


def _expect_radians(value: Sequence[float], right: Pose) -> None:
    """Raise Hint if all that is wrong with a pose is that its heading is in degrees."""
    in_degrees = same_pose((*value[:2], math.radians(value[2])), right, 1e-6)
    expect(not in_degrees, "the heading is wanted in radians.")


def _seen_there(one: Sequence[float], other: Sequence[float]) -> bool:
    """To a centimetre and a degree."""
    turned = math.remainder(one[2] - other[2], 2.0 * math.pi)
    return math.dist(one[:2], other[:2]) < 0.011 and abs(turned) < math.radians(1.0)


def _inverse(goal: Pose, far: float, ahead: float, beside: float) -> tuple[float, float, float]:
    sight = beside + goal.heading
    return goal.x - far * math.cos(sight), goal.y - far * math.sin(sight), sight - ahead


@_exercise
def brake(limits: Any) -> str:
    """4.1: the largest k_rho with the exponential and with tanh."""
    grid = [x / 1000 for x in range(5000)]
    exponential = max(math.exp(-x) * -math.expm1(-x) for x in grid)
    steepest = exponential, max(math.tanh(x) / math.cosh(x) ** 2 for x in grid)
    value, right = numbers("`limits`", limits, 2), [1.0 / (16.0 * each) for each in steepest]
    mistakes = {
        "they are the other way round.": right[::-1],
        _SQUARED: [4.0 * each for each in right],
    }
    expect(min(value) > 0.0, _POSITIVE)
    if not _near(value, right):
        hint = "differentiate v along the way, dv/dt = dv/drho (-v): where is that steepest?"
        explain(value, mistakes, hint, _near)
    for name, each, most in zip(("the exponential", "tanh"), value, right, strict=True):
        hint = f"with {name} and k_rho = {each:g} 1/m it brakes harder than 1 m/s^2"
        _expect_below(each, most, hint)
    return "Right: tanh brakes harder, and asks for the smaller gain."


@_exercise
def aicardi(V_rate: Any) -> str:
    """4.2: V' of (19) with Aicardi's law."""
    right, steering = lyapunov_rate("aicardi"), -k_alpha * alpha**2
    slower = right + (1 - 1 / (k_rho * rho)) * k_rho / L * (rho * sp.cos(alpha)) ** 2
    mistakes = {
        "the signs are turned round: this V would rise.": -right,
        "a sign is turned round: look at the steering's term.": right - 2 * steering,
        "a sign is turned round: look at the speed's term.": 2 * steering - right,
        "the speed brings a factor k_rho rho.": slower,
    }
    symbols = (rho, alpha, L, k_rho, k_alpha, h, theta)  # the last two go out
    hint = "follow (4.7), with k_rho rho in the brackets' place."
    _expect_rate(V_rate, right, symbols, mistakes, hint)
    return "Right: each term shows that it is never positive."


def _expect_rate(
    V_rate: Any, right: sp.Expr, symbols: Sequence, mistakes: dict, otherwise: str
) -> None:
    """Raise Hint unless it is this V', whether simplified or not."""
    value, where = expression("V_rate", V_rate, symbols), points(symbols)
    if not equal_at(where, value, right):
        explain(value, mistakes, otherwise, partial(equal_at, where))


@_exercise
def pendulum(swing: Callable, share: Any = None) -> str:
    """4.3: swing(q, p, seconds) returns (q, p) then; the share of 400 that end at q = 0."""
    for q, p, seconds in ((0.5, -1.0, 2.0), (-4.0, 2.5, 3.0), (6.0, 2.0, 20.0)):
        value = ask_numbers(swing, 2, q, p, seconds)
        if not _beside(value, _swung(q, p, seconds)):
            mistakes = {
                "gravity has the other sign: this pendulum falls upwards.": {"gravity": -1.0},
                "friction has the other sign: this pendulum is driven.": {"friction": -0.3},
                "where is the friction?": {"friction": 0.0},
                "these are Euler's steps; Runge's and Kutta's ask for the rates again half way.": {
                    "euler": True
                },
                "it goes on for one step too many: count the steps, for sums of 0.01 are "
                "rounded.": {"more": 1},
                "it stops one step too soon: round the number of steps.": {"more": -1},
            }
            found = {hint: _swung(q, p, seconds, **how) for hint, how in mistakes.items()}
            rule_out(value, found, _beside)
            turns = round((value[0] - _swung(q, p, seconds)[0]) / (2.0 * math.pi))
            unwrapped = value[0] - 2.0 * math.pi * turns, value[1]
            hint = "full turns of q count: do not wrap it."
            expect(not _beside(unwrapped, _swung(q, p, seconds)), hint)
            hint = f"from q = {q:g}, p = {p:g} it is elsewhere after {seconds:g} s: is q' p, and "
            hint += "p' -sin(q) - c p, and are the steps Runge's and Kutta's, of 0.01 s?"
            raise Hint(hint)
    part = number("The function is right. `share`", share)
    hint = "the function is right; a share is between 0 and 1: those at q = 0 over all 400."
    expect(0.0 <= part <= 1.0, hint)
    hint = "the function is right; of the 400, how many have turned round by no full turn?"
    expect(abs(part - 0.5) < 0.1, hint)  # 0.499 of very many, plus or minus four sigma
    return "Right. The energy never rises, which an assert can show, and none ends upright."


def _swung(q, p, seconds, gravity=1.0, friction=0.3, euler=False, more=0) -> tuple[float, float]:
    """Runge's and Kutta's steps, of q + i p."""

    def rates(at: complex) -> complex:
        return complex(at.imag, -gravity * math.sin(at.real) - friction * at.imag)

    at, dt = complex(q, p), 0.01
    for _ in range(round(seconds / dt) + more):
        first = rates(at)
        half = rates(at + dt / 2 * first)
        then = rates(at + dt / 2 * half)
        mean = (first + 2 * half + 2 * then + rates(at + dt * then)) / 6
        at += dt * (first if euler else mean)
    return at.real, at.imag


def _beside(one: Sequence[float], other: Sequence[float]) -> bool:
    return math.dist(one, other) < 1e-5


@_exercise
def braking(answer: Any) -> str:
    """5.2: the hardest braking, k_rho for 0.5 m/s^2, and where 5 % of the speed is gone."""
    hardest, gentle, far = numbers("`answer`", answer, 3)
    gains = paper.OUTDOOR_GAINS
    right = gains.v_max**2 * gains.k_rho / 4
    expect(hardest > 0.0, "how hard it brakes is asked, and that is a number above 0.")
    expect(gentle > 0.0, _POSITIVE)
    _expect_unit(hardest, right, "m/s^2")
    if not _about(hardest, right):
        explain(hardest, {_SQUARED: right / gains.v_max}, "what is x (1 - x) at most?", _about)
    _expect_unit(gentle, gains.k_rho * 0.5 / right, "1/m")
    if not _about(gentle, gains.k_rho * 0.5 / right):
        raise Hint("the hardest braking goes as k_rho: what makes it 0.5 m/s^2?")
    expect(far > 0.0, "a distance to the goal is wanted, and that is positive.")
    left = control_law(far, 0.0, 0.0, gains._replace(k_rho=gentle))[0] / gains.v_max
    hint = f"at {far:.3g} m {100 * (1 - left):.1f} % of the speed is gone"
    paced = control_law(far, 0.0, 0.0, gains)[0] / gains.v_max
    expect(not close(paced, 0.95, 1e-2), f"{hint}: with which k_rho?")
    expect(close(left, 0.95, 1e-3), f"{hint}, and 5 % are wanted.")
    return "Right: braking begins early enough for a robot with a load."


@_exercise
def one_centimetre(answer: Any) -> str:
    """6.1: k_rho that leaves 1 cm, and the step below which a robot exactly behind settles."""
    gain, step = numbers("`answer`", answer, 2)
    expect(gain > 0.0, _POSITIVE)
    wanted = -math.log(1.0 - paper.CIRCLE_SPEED / 4.0) / 0.01
    _expect_unit(gain, wanted, "1/m")
    v = control_law(0.01, 0.0, 0.0, paper.CIRCLE_GAINS._replace(k_rho=gain, v_max=4.0))[0]
    hint = f"1 cm from the goal the law commands {v:.3f} m/s; the goal does "
    expect(close(v, paper.CIRCLE_SPEED, 0.01), f"{hint}{paper.CIRCLE_SPEED:.3f} m/s.")
    slope = gain * (4.0 - paper.CIRCLE_SPEED)  # of v over the distance, where the robot stays
    _expect_unit(step, 2.0 / slope, "s")
    if not _about(step, 2.0 / slope):
        there = "v_max k_rho is the slope of v at the goal itself: how steep is it 1 cm away?"
        once = "with this step the error is gone at once; a longer one still lets it shrink."
        mistakes = {once: 1.0 / slope, there: 0.5 / gain}
        hint = "a step multiplies the error by 1 - s dt: what is the slope s of v 1 cm away?"
        explain(step, mistakes, hint, _about)
    # The gain is rounded too.
    _expect_below(step, 2.002 / slope, f"at {step:g} s the error does not shrink")
    return "Right for a robot exactly behind its goal; with angles the steering fails earlier."


@_exercise
def kanayama(V_rate: Any) -> str:
    """6.2: V' along (6.3) under (6.4), of the errors, v_ref and the gains."""
    e_x, e_y, e_h = sp.symbols("e_x e_y e_h", real=True)
    k_x, k_y, k_h = sp.symbols("k_x k_y k_h", positive=True)
    along, across = -k_x * e_x**2, -k_h / k_y * v_ref * sp.sin(e_h) ** 2
    mistakes = {
        "the signs are turned round: this V would rise.": -along - across,
        "a sign is turned round: look at the term of e_x.": across - along,
        "a sign is turned round: look at the term of e_h.": along - across,
        "V has 1 - cos(e_h) over k_y.": along + k_y * across,
        "the angle need not be small: where is its sine?": along
        + across * (e_h / sp.sin(e_h)) ** 2,
        "one error is still missing: what does (6.4) do about e_h?": along,
    }
    symbols = (e_x, e_y, e_h, v_ref, omega_ref, k_x, k_y, k_h)  # e_y and omega_ref go out
    hint = "differentiate V, put (6.3) in for the rates, and (6.4) for v and omega."
    _expect_rate(V_rate, along + across, symbols, mistakes, hint)
    return "Right: it is never positive, whatever the goal's turn, as long as it drives forwards."


@_exercise
def told_too_little(answer: Any) -> str:
    """6.3: how far ahead a goal stays whose speed is announced 10 % too low."""
    value, speed = number("`answer`", answer), paper.CIRCLE_SPEED
    turning = 2.0 * math.pi / paper.CIRCLE_PERIOD
    right = 0.1 * speed / (1.0 + turning**2 / speed)
    if not close(value, right, 0.01):
        there, cm = right * math.hypot(1.0, turning / speed), 100.0 * right
        hint = "the goal is ahead, and so e_x is positive."
        rule_out(value, {hint: -right, "the answer is wanted in metres.": cm}, _about)
        mistakes = {
            "how far ahead is asked, e_x; this distance has e_y in it.": there,
            "told the truth, the robot would not lag at all; it is told 10 % less.": 0.0,
            "that is for a straight line. On a circle it turns as well: set the second and third "
            "rate to zero too.": 0.1 * speed,
        }
        near = partial(close, relative=0.006)  # the first and the last are that close
        explain(value, mistakes, "where are all three rates of (6.3) zero?", near)
    return "Right: feed-forward is as good as what it is told."


@_exercise
def longest_step(seconds: Any) -> str:
    """8.2: the longest polar Euler step with which the circle's gains still settle."""
    value, gains = number("`seconds`", seconds), paper.CIRCLE_GAINS
    pace = gains.k_rho * gains.v_max
    angles, distance = gains.k_alpha / (gains.h * pace**2), 2.0 / pace
    _expect_unit(value, min(angles, distance), "s")
    expect(value > 0.0, "a time step is positive.")
    if not _about(value, min(angles, distance)):
        mistakes = {
            "this is how long the angles allow, (8.2): and the distance?": angles,
            "rho changes its sign beyond this step, and still settles: go on.": 1.0 / pace,
        }
        hint = "begin near the goal, and ask whether rho and alpha shrink."
        explain(value, mistakes, hint, _about)
    _expect_below(value, distance, f"with {value:g} s the distance grows again")
    return "Right: the distance sets this limit, not the angles."


@_exercise
def three_readings(centre: Callable) -> str:
    """11.2: centre(a, b, c), readings (x, y) on a circle, returns its centre."""
    bounds = (-40, 40), (-40, 40), (20, 50), (-3, 3), (0.2, 2.9), (0.2, 2.9)
    circles = [
        (middle, [_on_circle(middle, radius, turn + each) for each in (0.0, one, one + two)][::way])
        for way in (1, -1)  # a robot may turn either way
        for *middle, radius, turn, one, two in drawn(5, 10, *bounds)
    ]
    corners = (1.0, 1.0), (3.0, 1.0), (3.0, 5.0)  # lines along the axes have no slope
    circles += [((2.0, 3.0), on) for on in permutations(corners)]
    for middle, on in circles:
        value, mean = ask_numbers(centre, 2, *on), [sum(each) / 3 for each in zip(*on, strict=True)]
        if math.dist(value, middle) > 1e-6:
            hint = "this is the mean of the readings, which lie on one side of the circle."
            other = "the centre is not as far from each of the readings: test it with a circle."
            explain(value, {hint: mean}, other, _near)
    return "Right for twenty compasses, and for readings in line with the axes."


def _on_circle(middle: Sequence[float], radius: float, turn: float) -> tuple[float, float]:
    return middle[0] + radius * math.cos(turn), middle[1] + radius * math.sin(turn)


@_exercise
def short_fence(answer: Any) -> str:
    """11.3: the timeout and the top speed."""
    timeout, speed = numbers("`answer`", answer, 2)
    hint = f"after {timeout:g} s the robot brakes: with one fix lost, the next comes after 0.4 s."
    expect(timeout > 0.4, hint)
    hint = f"in {timeout:g} s two fixes may be lost: a shorter timeout lets the robot drive faster."
    expect(timeout <= 0.6, hint)
    far = speed * timeout + speed * speed / 2.0
    expect(speed > 0.0, "the robot should drive.")
    _expect_below(far, 1.0, f"it stops {far:.4g} m after its last fix")
    expect(far >= 0.95, f"it stops after {far:.2f} m already: it may be faster.")
    return f"Right: it stops {far:.2f} m after its last fix, and bears one that is lost."


@_exercise
def walk(keep: Callable) -> str:
    """12.2: keep(fixes), of (seconds, east, north), those that can be walked to."""
    for seed in range(4):
        t, fixes = 0.0, []
        for a, b, seconds in drawn(seed, 60, (-1.0, 1.0), (0.0, 1.0), (0.4, 2.0)):
            fixes.append((t, 1.2 * t + a, 50.0 if fixes and b > 0.8 else a))
            t += seconds
        answer = ask(keep, list(fixes))
        hint = "a list of fixes is wanted, (seconds, east, north) each."
        try:
            kept = [tuple(map(float, each)) for each in islice(answer, 99)]  # it may never end
        except (TypeError, ValueError):
            raise Hint(hint) from None
        expect({len(each) for each in kept} <= {3}, hint)
        expect(kept[:1] == fixes[:1], "the first fix is to be kept.")
        hint = "each fix is compared with the one before it: compare with the last one *kept*."
        expect(kept != _walked(fixes, of_all=True), hint)
        expect(kept == _walked(fixes), "it keeps other fixes: 3 m/s, over the time between them.")
    return "Right for four walks."


def _walked(fixes: list, of_all: bool = False) -> list:
    kept = before = fixes[:1]
    for each in fixes[1:]:
        seconds, *to = each
        if math.dist(to, before[-1][1:]) <= 3.0 * (seconds - before[-1][0]):
            kept = [*kept, each]
        before = [each] if of_all else kept
    return kept


def _expect_below(value: float, limit: float, hint: str) -> None:
    """Raise Hint unless it is at most the limit, up to the fifth digit."""
    expect(value <= _ROUNDED * limit, f"{hint}: a limit is rounded down.")


def _expect_unit(value: float, right: float, unit: str) -> None:
    thousands = any(_about(value, factor * right) for factor in (1e-3, 1e3))
    expect(not thousands, f"{shown(value)} is a thousand times off: {unit} are wanted.")


def _about(value: float, right: float) -> bool:
    return close(value, right, 0.02)


def _near(value: Sequence[float], right: Sequence[float]) -> bool:
    return all(map(_about, value, right))
