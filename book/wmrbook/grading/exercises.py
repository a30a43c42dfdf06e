"""Checks of the exercises at the chapters' ends, of those that a few numbers or lines answer.

They print what the checks of the course raise: a sentence if an answer is right, else a hint. So a
chapter runs while they wait for an answer.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import wraps
from typing import Any

import sympy as sp

from wmrbook.grading import earth
from wmrbook.grading._asking import ask, ask_numbers, number, numbers
from wmrbook.grading._expressions import equal_at, expression, points
from wmrbook.grading._hints import Hint, close, drawn, expect, explain, own_work, same_pose
from wmrlib import paper
from wmrlib.control import control_law
from wmrlib.geodesy import EARTH_RADIUS_M
from wmrlib.kinematics import PolarError, Pose, advance, pose_from_polar, wheels_to_twist
from wmrlib.symbolic import L, alpha, k_alpha, k_rho, lyapunov_rate, rho

_SQUARED = "look at v_max: by how much is the braking larger at twice the speed?"


def _exercise(check: Callable[[Any], str]) -> Callable[[Any], str]:
    """Return the check that returns its hints."""

    @wraps(check)
    def told(answer: Any) -> str:
        try:
            return check(answer)
        except Hint as hint:
            return f"Hint: {hint}"

    return told


@_exercise
def third_formula(distance: Callable) -> str:
    """1.2: distance(lat_1, lon_1, lat_2, lon_2), degrees in, metres out."""
    for a, b in earth._places(20):
        value, right = earth._between(distance, a, b), earth.haversine_distance(a, b)
        across = EARTH_RADIUS_M * math.sin(right / EARTH_RADIUS_M)
        mistakes = {
            "degrees go into a sine: `math.radians` first.": earth.haversine_distance(
                *earth._in_degrees(a, b)
            ),
            "an angle is wanted, and this is its sine: where is the dot product?": across,
            "this is the angle: times the Earth's radius it is the distance.": right
            / EARTH_RADIUS_M,
            "metres are wanted, and these are kilometres.": right / 1000.0,
        }
        hint = "the distance of two known places is wrong: is each vector of length 1?"
        if not close(value, right, 1e-6, 1e-6):
            explain(value, mistakes, hint)
    earth.distance_close(distance)
    return "Right all over the Earth, and for a centimetre."


@_exercise
def odometry(path: Callable) -> str:
    """2.2: path(log, width, dt), a log of (left, right) in m/s, returns (x, y, heading)."""
    own_work(path)
    for seed in range(6):
        log, width, dt = (
            drawn(seed, 12, (-1.0, 1.0), (-1.0, 1.0)),
            0.3 + 0.1 * seed,
            0.7 - 0.1 * seed,
        )
        log = [*log, (0.4, 0.4), (0.3, -0.3), (0.0, 0.0)]  # straight on, on the spot, at rest
        value = ask_numbers(path, 3, [tuple(each) for each in log], width, dt)
        mistakes = {
            "these are Euler's straight steps; on an arc the chord is shorter.": (1, "euler"),
            "this robot turns right where it should turn left.": (-1, "arc"),
            "": (1, "arc"),
        }
        for hint, (side, method) in mistakes.items():
            at = Pose(0.0, 0.0, 0.0)
            for left, right in log:
                v, omega = wheels_to_twist(left, right, width)
                at = advance(at, v, side * omega, dt, method=method)
            if hint:
                expect(not same_pose(value, at, 1e-6), hint)
        wrong = "the path ends elsewhere: try one step straight on, then one on the spot."
        expect(same_pose(value, at, 1e-6), wrong)
    return "Right for six logs, turning both ways and not at all. Euler ends elsewhere."


@_exercise
def back_to_the_pose(pose: Callable) -> str:
    """3.2: pose(rho, alpha, theta, goal) returns (x, y, heading)."""
    own_work(pose)
    bounds = (0.1, 9.0), (-3.0, 3.0), (-3.0, 3.0), (-5.0, 5.0), (-5.0, 5.0), (-3.0, 3.0)
    for far, ahead, beside, *at in drawn(3, 20, *bounds):
        goal = Pose(*at)
        value = ask_numbers(pose, 3, far, ahead, beside, goal)
        mistakes = {
            "the robot is on the other side of the goal: rho leads back.": (-far, ahead, beside),
            "theta has the other sign here; is it Corke's beta?": (far, ahead, -beside),
            "alpha is the line of sight less the heading, not the other way.": (
                far,
                -ahead,
                beside,
            ),
            "the line of sight is theta from the goal's heading, not from x.": (
                far,
                ahead,
                beside - goal.heading,
            ),
        }
        found = {hint: _inverse(goal, *each) for hint, each in mistakes.items()}
        right = pose_from_polar(PolarError(far, ahead, beside), goal)
        if not same_pose(value, right):
            explain(value, found, "the way back misses: draw the line of sight first.", same_pose)
    return "Right: twenty poses come back."


def _inverse(goal: Pose, far: float, ahead: float, beside: float) -> tuple[float, float, float]:
    sight = beside + goal.heading
    return goal.x - far * math.cos(sight), goal.y - far * math.sin(sight), sight - ahead


@_exercise
def brake(limits: Any) -> str:
    """4.1: the largest k_rho with the exponential and with tanh."""
    grid = [x / 1000 for x in range(5000)]
    steepest = (
        max(math.exp(-x) * -math.expm1(-x) for x in grid),
        max(math.tanh(x) / math.cosh(x) ** 2 for x in grid),
    )
    value, right = numbers("`limits`", limits, 2), [1.0 / (16.0 * each) for each in steepest]
    mistakes = {
        "they are the other way round.": right[::-1],
        _SQUARED: [4.0 * each for each in right],
    }
    if not _near(value, right):
        hint = "differentiate v along the way, dv/dt = dv/drho (-v): where is that steepest?"
        explain(value, mistakes, hint, _near)
    return "Right: tanh brakes harder, and asks for the smaller gain."


@_exercise
def aicardi(V_rate: Any) -> str:
    """4.2: V' of (19) with Aicardi's law."""
    symbols = (rho, alpha, L, k_rho, k_alpha)
    if isinstance(V_rate, sp.Expr):  # by the chain rule it holds h theta, which goes out
        V_rate = sp.expand(V_rate.replace(sp.sinc, lambda each: sp.sin(each) / each))
    value, right = expression("V_rate", V_rate, symbols), lyapunov_rate("aicardi")
    where = points(sorted(right.free_symbols | set(symbols), key=str))

    def equal(one: Any, other: Any) -> bool:
        return equal_at(where, one, other)

    if not equal(value, right):
        slower = right + (1 - 1 / (k_rho * rho)) * k_rho / L * (rho * sp.cos(alpha)) ** 2
        mistakes = {
            "the signs are turned round: this V would rise.": -right,
            "the speed brings a factor k_rho rho.": slower,
        }
        explain(value, mistakes, "follow (4.7), with k_rho rho in the brackets' place.", equal)
    return "Right: each term shows that it is never positive."


@_exercise
def braking(answer: Any) -> str:
    """5.2: the hardest braking, k_rho for 0.5 m/s^2, and where 5 % of the speed is gone."""
    hardest, gentle, far = numbers("`answer`", answer, 3)
    gains = paper.OUTDOOR_GAINS
    right = gains.v_max**2 * gains.k_rho / 4
    if not _about(hardest, right):
        explain(hardest, {_SQUARED: right / gains.v_max}, "what is x (1 - x) at most?", _about)
    if not _about(gentle, gains.k_rho * 0.5 / right):
        raise Hint("the hardest braking goes as k_rho: what makes it 0.5 m/s^2?")
    expect(far > 0.0, "a distance to the goal is wanted, and that is positive.")
    left = control_law(far, 0.0, 0.0, gains._replace(k_rho=gentle))[0] / gains.v_max
    hint = f"at {far:.3g} m {100 * (1 - left):.1f} % of the speed is gone: with which k_rho?"
    expect(close(left, 0.95, 1e-3), hint)
    return "Right: braking begins early enough for a robot with a load."


@_exercise
def one_centimetre(answer: Any) -> str:
    """6.1: k_rho that leaves 1 cm, and the step that a sampled robot must stay below."""
    gain, step = numbers("`answer`", answer, 2)
    expect(gain > 0.0, "a negative gain drives away from the goal.")
    v = control_law(0.01, 0.0, 0.0, paper.CIRCLE_GAINS._replace(k_rho=gain, v_max=4.0))[0]
    hint = f"1 cm from the goal the law commands {v:.2f} m/s; the goal does "
    expect(_about(v, paper.CIRCLE_SPEED), f"{hint}{paper.CIRCLE_SPEED:.2f} m/s.")
    constant = 1.0 / (4.0 * gain)
    if not _about(step, 2.0 * constant):
        once = "with this step the distance is gone at once; a longer one still lets it shrink."
        explain(
            step, {once: constant}, "a step multiplies the distance by 1 - v_max k_rho dt.", _about
        )
    return "Right: below this step the distance settles, and 1 cm is left."


@_exercise
def longest_step(seconds: Any) -> str:
    """8.2: the longest polar Euler step with which the circle's gains still settle."""
    value, gains = number("`seconds`", seconds), paper.CIRCLE_GAINS
    pace = gains.k_rho * gains.v_max
    angles, distance = gains.k_alpha / (gains.h * pace**2), 2.0 / pace
    if not _about(value, min(angles, distance)):
        mistakes = {
            "this is how long the angles allow, (8.2): and the distance?": angles,
            "rho changes its sign beyond this step, and still settles: go on.": 1.0 / pace,
        }
        explain(
            value, mistakes, "begin near the goal, and ask whether rho and alpha shrink.", _about
        )
    return "Right: the distance sets this limit, not the angles."


@_exercise
def three_readings(centre: Callable) -> str:
    """11.2: centre(a, b, c), readings (x, y) on a circle, returns its centre."""
    for *middle, radius, turn in drawn(5, 20, (-40, 40), (-40, 40), (20, 50), (-3, 3)):
        on = [_on_circle(middle, radius, turn + each) for each in (0.0, 0.7, 2.0)]
        value, mean = ask_numbers(centre, 2, *on), [sum(each) / 3 for each in zip(*on, strict=True)]
        if math.dist(value, middle) > 1e-6:
            hint = "this is the mean of the readings, which lie on one side of the circle."
            other = "the centre is not as far from each of the readings: test it with a circle."
            explain(value, {hint: mean}, other, _near)
    return "Right for twenty compasses."


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
    expect(far <= 1.001, f"it stops {far:.2f} m after its last fix.")
    expect(far >= 0.95, f"it stops after {far:.2f} m already: it may be faster.")
    return f"Right: it stops {far:.2f} m after its last fix, and bears one that is lost."


@_exercise
def walk(keep: Callable) -> str:
    """12.2: keep(fixes), of (seconds, east, north), those that can be walked to."""
    for seed in range(4):
        steps = enumerate(drawn(seed, 60, (-1.0, 1.0), (0.0, 1.0)))
        fixes = [(float(t), 1.2 * t + a, 50.0 if t and b > 0.8 else a) for t, (a, b) in steps]
        answer = ask(keep, list(fixes))
        try:
            kept = [tuple(map(float, each)) for each in answer]
        except (TypeError, ValueError):
            raise Hint("a list of fixes is wanted, (seconds, east, north) each.") from None
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


def _about(value: float, right: float) -> bool:
    return close(value, right, 0.02)


def _near(value: Sequence[float], right: Sequence[float]) -> bool:
    return all(map(_about, value, right))
