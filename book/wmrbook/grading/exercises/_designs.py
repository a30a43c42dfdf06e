"""Exercises on the law: what makes V fall, and how hard, how closely and how late a robot acts."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import sympy as sp

from wmrbook.grading._asking import ask_numbers, number, numbers
from wmrbook.grading._expressions import equal_at, expression, points
from wmrbook.grading._hints import Hint, close, expect, explain, rule_out, shown
from wmrbook.grading.exercises._form import about, exercise, expect_below, near
from wmrlib import paper
from wmrlib.control import control_law
from wmrlib.symbolic import L, alpha, h, k_alpha, k_rho, lyapunov_rate, omega_ref, rho, theta, v_ref

_POSITIVE = "gains are positive: a negative one drives the robot away from its goal."
_SQUARED = "look at v_max: by how much is the braking larger at twice the speed?"


@exercise
def brake(limits: Any) -> str:
    """4.5: the largest k_rho with the exponential and with tanh."""
    grid = [x / 1000 for x in range(5000)]
    exponential = max(math.exp(-x) * -math.expm1(-x) for x in grid)
    steepest = exponential, max(math.tanh(x) / math.cosh(x) ** 2 for x in grid)
    value, right = numbers("`limits`", limits, 2), [1.0 / (16.0 * slope) for slope in steepest]
    mistakes = {
        "they are the other way round.": right[::-1],
        _SQUARED: [4.0 * gain for gain in right],
    }
    expect(min(value) > 0.0, _POSITIVE)
    if not near(value, right):
        hint = "differentiate v along the way, dv/dt = dv/drho (-v): where is that steepest?"
        explain(value, mistakes, hint, near)
    for name, gain, most in zip(("the exponential", "tanh"), value, right, strict=True):
        hint = f"with {name} and k_rho = {gain:g} 1/m it brakes harder than 1 m/s^2"
        expect_below(gain, most, hint)
    return "Right: tanh brakes harder, and asks for the smaller gain."


@exercise
def aicardi(V_rate: Any) -> str:
    """4.3: V' of (19) with Aicardi's law."""
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
    value, equal = expression("V_rate", V_rate, symbols), partial(equal_at, points(symbols))
    if not equal(value, right):
        explain(value, mistakes, otherwise, equal)


@exercise
def pendulum(swing: Callable, share: Any = None) -> str:
    """4.4: swing(q, p, seconds) returns (q, p) then; the share of 400 that end at q = 0."""
    for q, p, seconds in ((0.5, -1.0, 2.0), (-4.0, 2.5, 3.0), (6.0, 2.0, 20.0)):
        value = ask_numbers(swing, 2, q, p, seconds)
        swung = partial(_swung, q, p, seconds)
        if not _beside(value, right := swung()):
            mistakes = {
                "gravity has the other sign: this pendulum falls upwards.": swung(gravity=-1.0),
                "friction has the other sign: this pendulum is driven.": swung(friction=-0.3),
                "where is the friction?": swung(friction=0.0),
                "these are Euler's steps; Runge's and Kutta's ask for the rates again "
                "half way.": swung(euler=True),
                "it goes on for one step too many: count the steps, for sums of 0.01 are "
                "rounded.": swung(more=1),
                "it stops one step too soon: round the number of steps.": swung(more=-1),
            }
            rule_out(value, mistakes, _beside)
            turns = round((value[0] - right[0]) / (2.0 * math.pi))
            unwrapped = value[0] - 2.0 * math.pi * turns, value[1]
            expect(not _beside(unwrapped, right), "full turns of q count: do not wrap it.")
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


@exercise
def braking(answer: Any) -> str:
    """5.2: the hardest braking, k_rho for 0.5 m/s^2, and where 5 % of the speed is gone."""
    hardest, gentle, far = numbers("`answer`", answer, 3)
    gains = paper.OUTDOOR_GAINS
    right = gains.v_max**2 * gains.k_rho / 4
    expect(hardest > 0.0, "how hard it brakes is asked, and that is a number above 0.")
    expect(gentle > 0.0, _POSITIVE)
    _expect_unit(hardest, right, "m/s^2")
    if not about(hardest, right):
        explain(hardest, {_SQUARED: right / gains.v_max}, "what is x (1 - x) at most?", about)
    _expect_unit(gentle, gains.k_rho * 0.5 / right, "1/m")
    if not about(gentle, gains.k_rho * 0.5 / right):
        raise Hint("the hardest braking goes as k_rho: what makes it 0.5 m/s^2?")
    expect(far > 0.0, "a distance to the goal is wanted, and that is positive.")
    left = control_law(far, 0.0, 0.0, gains._replace(k_rho=gentle))[0] / gains.v_max
    hint = f"at {far:.3g} m {100 * (1 - left):.1f} % of the speed is gone"
    paced = control_law(far, 0.0, 0.0, gains)[0] / gains.v_max
    expect(not close(paced, 0.95, 1e-2), f"{hint}: with which k_rho?")
    expect(close(left, 0.95, 1e-3), f"{hint}, and 5 % are wanted.")
    return "Right: braking begins early enough for a robot with a load."


@exercise
def one_centimetre(answer: Any) -> str:
    """7.5: k_rho that leaves 1 cm, and the step below which a robot exactly behind settles."""
    gain, step = numbers("`answer`", answer, 2)
    expect(gain > 0.0, _POSITIVE)
    right = -math.log(1.0 - paper.CIRCLE_SPEED / 4.0) / 0.01
    _expect_unit(gain, right, "1/m")
    v = control_law(0.01, 0.0, 0.0, paper.CIRCLE_GAINS._replace(k_rho=gain, v_max=4.0))[0]
    hint = f"1 cm from the goal the law commands {v:.3f} m/s; the goal does "
    expect(close(v, paper.CIRCLE_SPEED, 0.01), f"{hint}{paper.CIRCLE_SPEED:.3f} m/s.")
    slope = gain * (4.0 - paper.CIRCLE_SPEED)  # of v over the distance, where the robot stays
    _expect_unit(step, 2.0 / slope, "s")
    if not about(step, 2.0 / slope):
        there = "v_max k_rho is the slope of v at the goal itself: how steep is it 1 cm away?"
        once = "with this step the error is gone at once; a longer one still lets it shrink."
        mistakes = {once: 1.0 / slope, there: 0.5 / gain}
        hint = "a step multiplies the error by 1 - s dt: what is the slope s of v 1 cm away?"
        explain(step, mistakes, hint, about)
    # The gain is rounded too.
    expect_below(step, 2.002 / slope, f"at {step:g} s the error does not shrink")
    return "Right for a robot exactly behind its goal; with angles the steering fails earlier."


@exercise
def kanayama(V_rate: Any) -> str:
    """7.3: V' along (7.3) under (7.4), of the errors, v_ref and the gains."""
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
        "one error is still missing: what does (7.4) do about e_h?": along,
    }
    symbols = (e_x, e_y, e_h, v_ref, omega_ref, k_x, k_y, k_h)  # e_y and omega_ref go out
    hint = "differentiate V, put (7.3) in for the rates, and (7.4) for v and omega."
    _expect_rate(V_rate, along + across, symbols, mistakes, hint)
    return "Right: it is never positive, whatever the goal's turn, as long as it drives forwards."


@exercise
def announced_too_low(answer: Any) -> str:
    """7.4: how far ahead a goal stays whose speed is announced 10 % too low."""
    value, speed = number("`answer`", answer), paper.CIRCLE_SPEED
    turning = 2.0 * math.pi / paper.CIRCLE_PERIOD
    right = 0.1 * speed / (1.0 + turning**2 / speed)
    if not close(value, right, 0.01):
        there, cm = right * math.hypot(1.0, turning / speed), 100.0 * right
        hint = "the goal is ahead, and so e_x is positive."
        rule_out(value, {hint: -right, "the answer is wanted in metres.": cm}, about)
        mistakes = {
            "how far ahead is asked, e_x; this distance has e_y in it.": there,
            "told the truth, the robot would not lag at all; it is told 10 % less.": 0.0,
            "that is for a straight line. On a circle it turns as well: set the second and third "
            "rate to zero too.": 0.1 * speed,
        }
        near = partial(close, relative=0.006)  # the first and the last are that close
        explain(value, mistakes, "where are all three rates of (7.3) zero?", near)
    return "Right: feed-forward is as good as what it is told."


@exercise
def longest_step(seconds: Any) -> str:
    """8.4: the longest polar Euler step with which the circle's gains still settle."""
    value, gains = number("`seconds`", seconds), paper.CIRCLE_GAINS
    pace = gains.k_rho * gains.v_max
    angles, distance = gains.k_alpha / (gains.h * pace**2), 2.0 / pace
    _expect_unit(value, min(angles, distance), "s")
    expect(value > 0.0, "a time step is positive.")
    if not about(value, min(angles, distance)):
        mistakes = {
            "this is how long the angles allow, (8.2): and the distance?": angles,
            "rho changes its sign beyond this step, and still settles: go on.": 1.0 / pace,
        }
        hint = "begin near the goal, and ask whether rho and alpha shrink."
        explain(value, mistakes, hint, about)
    expect_below(value, distance, f"with {value:g} s the distance grows again")
    return "Right: the distance sets this limit, not the angles."


@exercise
def short_fence(answer: Any) -> str:
    """11.5: the timeout and the top speed."""
    timeout, speed = numbers("`answer`", answer, 2)
    hint = f"after {timeout:g} s the robot brakes: with one fix lost, the next comes after 0.4 s."
    expect(timeout > 0.4, hint)
    hint = f"in {timeout:g} s two fixes may be lost: a shorter timeout lets the robot drive faster."
    expect(timeout <= 0.6, hint)
    far = speed * timeout + speed * speed / 2.0
    expect(speed > 0.0, "the robot should drive.")
    expect_below(far, 1.0, f"it stops {far:.4g} m after its last fix")
    expect(far >= 0.95, f"it stops after {far:.2f} m already: it may be faster.")
    return f"Right: it stops {far:.2f} m after its last fix, and bears one that is lost."


def _expect_unit(value: float, right: float, unit: str) -> None:
    thousands = any(about(value, factor * right) for factor in (1e-3, 1e3))
    expect(not thousands, f"{shown(value)} is a thousand times off: {unit} are wanted.")
