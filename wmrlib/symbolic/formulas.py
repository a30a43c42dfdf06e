"""The functions that are printed into other languages, by name."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from types import SimpleNamespace
from typing import NamedTuple

import sympy as sp

from wmrlib import body, geodesy, laws, motion, paper
from wmrlib.gains import Gains
from wmrlib.symbolic import symbols as s
from wmrlib.symbolic.model import closed_loop, exact, gains_of, read, steering


class Formula(NamedTuple):
    """One function to print.

    It takes `arguments` and, in one structure, `gains`; it computes `locals_` in order and returns
    `values`, one or several.
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
    """The function that computes what its values have in common once."""
    used = tuple(each for each in gains if any(value.has(each) for value in values))
    locals_, values = sp.cse(values, symbols=sp.numbered_symbols("part"))
    return Formula(arguments, tuple(values), says, used, tuple(locals_))


def formula_of(function: Callable, arguments: tuple, says: str) -> Formula:
    """What a function of wmrlib's kind returns for symbols, as one to print."""
    return shared(arguments, read(function, *arguments), says)


def _law(name: str) -> Formula:
    """(v, omega) of a pose law, with v/rho as a local, which is finite at the goal."""
    row, (speed, turning) = laws.LAWS[name], steering(name)
    used = tuple(it for it in vars(gains_of(name)).values() if speed.has(it) or turning.has(it))
    values = s.rho * s.v_over_rho, turning.subs(speed, s.v_over_rho)
    return Formula(s.STATE, values, row.says, used, ((s.v_over_rho, speed),))


def _formula(name: str) -> Formula:
    """What a row of `LAWS` has as its formula, and takes what that takes."""
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
    """How a pose law settles near the goal, out of its linearised closed loop."""
    goal = dict.fromkeys(s.STATE, 0)
    rates = sp.Matrix(closed_loop(name)[1:]).replace(sp.sinc, lambda _: sp.Integer(1))  # near 0
    angles = rates.jacobian([s.alpha, s.theta]).subs(goal)
    values = steering(name)[0].subs(goal), -angles.trace(), angles.det()
    says = "p, a, b near the goal: rho' = -p rho, and s^2 + a s + b of the angles"
    return shared((), tuple(map(sp.expand, values)), says, vars(gains_of(name)).values())


_POSE, _GOAL = (s.x, s.y, s.heading), (s.goal_x, s.goal_y, s.goal_heading)
_TWIST = s.v, s.omega, s.dt
_CLOSING = s.rho, s.alpha, s.v_over_rho, s.omega
_WRAP = "the same direction in (-pi, pi]; in float it loses 2e-7 rad with each whole turn"
_DECAY = "(1 - exp(-k_rho rho))/rho, which is k_rho at rho = 0"
_KEEPS = "theta to be used, up to pi + hysteresis; before: the last result, NaN if there is none"
_BRANCH = formula_of(motion.keep_branch, (s.theta, s.before, s.hysteresis), _KEEPS)
_GUARDS = {
    "sinc": Formula((s.angle,), (s.GUARDED_SINC,), "sin(angle)/angle, which is 1 at 0"),
    "decay": Formula((s.rho, s.k_rho), (s.GUARDED_DECAY,), _DECAY),
    "turned_back": Formula((s.angle,), (s.TURNED_BACK,), "an angle within a turn of 0"),
    "wrap": Formula((s.angle,), (s.GUARDED_WRAP,), _WRAP),
}
_TWIST_AND_WIDTH = s.v, s.omega, s.b
_SCALE = "the factor on the twist for a max_speed"
_LIMITS = {
    "hurry": formula_of(
        body.hurry, (s.v, s.alpha, s.min_speed), "the factor on it for a min_speed"
    ),
    "fastest_wheel": formula_of(laws.fastest_wheel, _TWIST_AND_WIDTH, "speed of the faster wheel"),
    "saturation_scale": Formula((s.max_speed, s.fastest), (s.SATURATED,), _SCALE),
}
_TURNING = s.error, s.gain, s.min_rate, s.max_rate
_TURN_RATE = formula_of(
    body.turn_rate, _TURNING, "omega of a turn on the spot by an error that is left"
)
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


FORMULAS = {
    **_GUARDS,
    **{f"{name}_law": _formula(name) for name in laws.LAWS},
    "body_error": formula_of(laws.body_error, s.STATE, "the goal ahead, to the left, and turned"),
    **{row.value.__name__: _value(name) for name, row in laws.LAWS.items()},
    **{f"{name}_modes": _modes(name) for name in laws.POSE_LAWS},
    **{
        f.__name__: formula_of(f, _POSE + _TWIST, f"method {name}")
        for name, f in motion.STEPS.items()
    },
    "polar_from_pose": formula_of(motion.polar_from_pose, _POSE + _GOAL, "rho, alpha, theta"),
    "keep_branch": _BRANCH,
    **_LIMITS,
    "turn_rate": _TURN_RATE,
    "roll": _roll(),
    "pose_of_error": formula_of(motion.pose_of_error, s.STATE + _GOAL, "x, y, heading"),
    "polar_closing_rate": formula_of(motion.polar_closing_rate, _CLOSING, "(7) to (9)"),
    "circle": formula_of(paper.circle_at, (s.t,), "x, y, heading, v, omega of the goal"),
}
"""What is printed for the panel, by name."""

C_LAWS = {
    "law" if name == "corrected" else f"law_{name}": _law(name)
    for name in laws.POSE_LAWS
    if laws.LAWS[name].gains is Gains
}
"""The laws that the C header has, by their names there."""

_DISTANCE, _SIGHT, _ = read(motion.polar_from_pose, 0, 0, 0, s.east, s.north, 0)
_LEFT, _RIGHT = read(motion.wheel_speeds, s.v, s.omega, s.b)
_ENDS = s.lat1, s.lat2, s.dlat, s.dlong
_LENGTH = s.R * read(geodesy.great_circle_angle, *_ENDS)[0]
_BEARING = read(geodesy.bearing_angle, *_ENDS)
C_FORMULAS = {
    **_GUARDS,
    "lyapunov_value": formula_of(laws.lyapunov_value, (*s.STATE, s.h, s.L), "V, (18)"),
    "keep_branch": _BRANCH,
    "turn_rate": _TURN_RATE,
    "distance": Formula((s.east, s.north), (_DISTANCE,), "rho"),
    "sight": Formula((s.east, s.north), _SIGHT.args, "the line of sight, from east"),
    "left_wheel": Formula(_TWIST_AND_WIDTH, (_LEFT,), "ground speed, from (1) and (2)"),
    "right_wheel": Formula(_TWIST_AND_WIDTH, (_RIGHT,), "ground speed, from (1) and (2)"),
    **_LIMITS,
    "sphere_distance": shared((*_ENDS, s.R), (_LENGTH,), "(11) to (13)"),
    "bearing": shared(_ENDS, _BEARING, "(15) to (17)"),
}
"""What a robot needs around the law, each a function of numbers."""
