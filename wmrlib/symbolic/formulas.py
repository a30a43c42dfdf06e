"""The functions that are printed into other languages, by name.

Each table is made on its first use, so that importing the expressions stays quick.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cache
from types import SimpleNamespace
from typing import NamedTuple

import sympy as sp

from wmrlib import body, geodesy, laws, motion, paper
from wmrlib.gains import Gains
from wmrlib.symbolic import symbols as s
from wmrlib.symbolic.model import closed_loop_rates, exact, gains_of, read, steering


class Formula(NamedTuple):
    """One function to print.

    It takes `arguments` and, in one structure, `gains`; it computes `locals_` in order and returns
    `values`, one or several. `says` is the comment above it.
    """

    arguments: tuple[sp.Symbol, ...]
    values: tuple[sp.Expr, ...]
    says: str
    gains: tuple[sp.Symbol, ...] = ()
    locals_: tuple[tuple[sp.Symbol, sp.Expr], ...] = ()

    def expanded(self) -> tuple[sp.Expr, ...]:
        """The values in the arguments and gains alone."""
        values = sp.Tuple(*self.values)
        for name, value in reversed(self.locals_):
            values = values.subs(name, value)
        return tuple(values)


def shared(arguments: tuple, values: tuple, says: str, gains: Iterable = ()) -> Formula:
    """The function of these values, which computes their common subexpressions once."""
    used = tuple(gain for gain in gains if any(value.has(gain) for value in values))
    locals_, values = sp.cse(values, symbols=sp.numbered_symbols("part"))
    return Formula(arguments, tuple(values), says, used, tuple(locals_))


def formula_of(function: Callable, arguments: tuple, says: str) -> Formula:
    """A formula of wmrlib, or one of your own, as a function to print.

    Parameters
    ----------
    function : a formula of numbers that is made of the functions of `wmrlib.elementary`
    arguments : tuple of symbols, with which it is called
    says : str, the comment above the printed function

    Returns
    -------
    Formula
    """
    return shared(arguments, read(function, *arguments), says)


def _law(name: str) -> Formula:
    """(v, omega) of a pose law, with v/rho as a local, which is finite at the goal."""
    row, (speed, turning) = laws.LAWS[name], steering(name)
    used = tuple(
        gain for gain in vars(gains_of(name)).values() if speed.has(gain) or turning.has(gain)
    )
    values = s.rho * s.v_over_rho, turning.subs(speed, s.v_over_rho)
    return Formula(s.STATE, values, row.says, used, ((s.v_over_rho, speed),))


def _formula(name: str) -> Formula:
    """The formula of a law, with the arguments that it has in `LAWS`."""
    row, gains = laws.LAWS[name], gains_of(name)
    if not row.needs_reference:
        law = _law(name)
        return law._replace(values=(s.v_over_rho, law.values[1]))
    state = s.ahead, s.left, s.turn, s.v_ref, s.omega_ref
    return shared(state, read(row.formula, *state, gains), row.says, vars(gains).values())


def _value(name: str) -> Formula:
    value = read(laws.LAWS[name].value, *s.STATE, gains_of(name))
    return shared(s.STATE, value, "its Lyapunov function", vars(gains_of(name)).values())


def _modes(name: str) -> Formula:
    """The coefficients of a pose law's modes near the goal, from its linearised closed loop."""
    goal = dict.fromkeys(s.STATE, 0)
    rates = sp.Matrix(closed_loop_rates(name)[1:])
    rates = rates.replace(sp.sinc, lambda _: sp.Integer(1))  # near 0
    angles = rates.jacobian([s.alpha, s.theta]).subs(goal)
    values = steering(name)[0].subs(goal), -angles.trace(), angles.det()
    says = "p, a, b near the goal: rho' = -p rho, and s^2 + a s + b of the angles"
    return shared((), tuple(map(sp.expand, values)), says, vars(gains_of(name)).values())


_POSE, _GOAL = (s.x, s.y, s.heading), (s.goal_x, s.goal_y, s.goal_heading)
_TWIST = s.v, s.omega, s.dt
_TWIST_AND_WIDTH = s.v, s.omega, s.b
_BODY = s.speed_left, s.speed_right, s.rest_left, s.rest_right


def _roll() -> Formula:
    """The body's wheels as numbers one by one; the new body follows the twist."""
    fields = {name: vars(s).get(name) for name in body.Wheels._fields}
    wheels = SimpleNamespace(**fields | {"track_width": s.b})
    v, omega, after = body.roll(s.v, s.omega, _BODY, wheels, s.dt)
    says = "the mean twist in a period, and the left and right speeds and rests after it"
    used = s.b, s.acceleration, s.lag, s.dead_band, s.encoder_step
    arguments = (s.v, s.omega, *_BODY, *used, s.dt)
    return shared(arguments, tuple(map(exact, (v, omega, *after))), says)


def _guards() -> dict[str, Formula]:
    """The functions that are finite where the textbook has 0/0, or keep an angle within a turn."""
    wrap = "the same direction in (-pi, pi]; in float it loses 2e-7 rad with each whole turn"
    decay = "(1 - exp(-k_rho rho))/rho, which is k_rho at rho = 0"
    return {
        "sinc": Formula((s.angle,), (s.GUARDED_SINC,), "sin(angle)/angle, which is 1 at 0"),
        "decay": Formula((s.rho, s.k_rho), (s.GUARDED_DECAY,), decay),
        "turned_back": Formula((s.angle,), (s.TURNED_BACK,), "an angle within a turn of 0"),
        "wrap": Formula((s.angle,), (s.GUARDED_WRAP,), wrap),
    }


def _keep_branch() -> Formula:
    says = "theta to be used, up to pi + hysteresis; before: the last result, NaN if there is none"
    return formula_of(motion.keep_branch, (s.theta, s.before, s.hysteresis), says)


def _limits() -> dict[str, Formula]:
    """The limits of the wheels on a twist."""
    hurry, fastest = "the factor on it for a min_speed", "speed of the faster wheel"
    scale = "the factor on the twist for a max_speed"
    return {
        "hurry": formula_of(body.hurry, (s.v, s.alpha, s.min_speed), hurry),
        "fastest_wheel": formula_of(laws.fastest_wheel, _TWIST_AND_WIDTH, fastest),
        "saturation_scale": Formula((s.max_speed, s.fastest), (s.SATURATED,), scale),
    }


def _turn_rate() -> Formula:
    arguments = s.error, s.gain, s.min_rate, s.max_rate
    says = "omega of a turn on the spot by an error that is left"
    return formula_of(body.turn_rate, arguments, says)


@cache
def panel_formulas() -> dict[str, Formula]:
    """The functions that are printed for the book's panels, by name."""
    steps = motion.STEPS.items()
    closing = s.rho, s.alpha, s.v_over_rho, s.omega
    error = formula_of(laws.body_error, s.STATE, "the goal ahead, to the left, and turned")
    circle = formula_of(paper.circle_at, (s.t,), "x, y, heading, v, omega of the goal")
    return {
        **_guards(),
        **{f"{name}_law": _formula(name) for name in laws.LAWS},
        "body_error": error,
        **{row.value.__name__: _value(name) for name, row in laws.LAWS.items()},
        **{f"{name}_modes": _modes(name) for name in laws.POSE_LAWS},
        **{f.__name__: formula_of(f, _POSE + _TWIST, f"method {name}") for name, f in steps},
        "polar_from_pose": formula_of(motion.polar_from_pose, _POSE + _GOAL, "rho, alpha, theta"),
        "keep_branch": _keep_branch(),
        **_limits(),
        "turn_rate": _turn_rate(),
        "roll": _roll(),
        "pose_of_error": formula_of(motion.pose_of_error, s.STATE + _GOAL, "x, y, heading"),
        "polar_closing_rate": formula_of(motion.polar_closing_rate, closing, "(7) to (9)"),
        "circle": circle,
    }


@cache
def c_laws() -> dict[str, Formula]:
    """The laws that the C header has, by their names there."""
    return {
        "law" if name == "corrected" else f"law_{name}": _law(name)
        for name in laws.POSE_LAWS
        if laws.LAWS[name].gains is Gains
    }


@cache
def c_formulas() -> dict[str, Formula]:
    """The functions of numbers that a robot needs beside the law, by name."""
    distance, sight, _ = read(motion.polar_from_pose, 0, 0, 0, s.east, s.north, 0)
    left, right = read(motion.wheel_speeds, s.v, s.omega, s.b)
    ends = s.lat1, s.lat2, s.dlat, s.dlong
    length = s.R * read(geodesy.great_circle_angle, *ends)[0]
    bearing = read(geodesy.bearing_angle, *ends)
    return {
        **_guards(),
        "lyapunov_value": formula_of(laws.lyapunov_value, (*s.STATE, s.h, s.L), "V, (18)"),
        "keep_branch": _keep_branch(),
        "turn_rate": _turn_rate(),
        "distance": Formula((s.east, s.north), (distance,), "rho"),
        "sight": Formula((s.east, s.north), sight.args, "the line of sight, from east"),
        "left_wheel": Formula(_TWIST_AND_WIDTH, (left,), "ground speed, from (1) and (2)"),
        "right_wheel": Formula(_TWIST_AND_WIDTH, (right,), "ground speed, from (1) and (2)"),
        **_limits(),
        "sphere_distance": shared((*ends, s.R), (length,), "(11) to (13)"),
        "bearing": shared(ends, bearing, "(15) to (17)"),
    }
