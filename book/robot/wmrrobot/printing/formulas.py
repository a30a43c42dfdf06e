"""The filter's model and its derivatives, to be printed into C and Python."""

from __future__ import annotations

from functools import cache

import sympy as sp

from wmrlib.symbolic import Formula, formula_of, read, shared
from wmrlib.symbolic import symbols as s
from wmrrobot import sensing

gyro_bias, wheel_scale, gyro, share, speed = sp.symbols(
    "gyro_bias wheel_scale gyro share speed", real=True
)
track_width, noise = sp.symbols("track_width noise", positive=True)

_STATE = s.x, s.y, s.heading, gyro_bias, wheel_scale
_INPUTS = s.v, s.omega, gyro, share, s.dt
_ARM = s.ahead, s.left
_TRUE = sensing.speed_and_turn(*_STATE[3:], *_INPUTS[:4])
_HERE = read(sensing.moved, s.x, s.y, s.heading, speed, s.turn, s.dt)


def _moved_rows() -> Formula:
    """Each of x, y, heading by the state, then by speed and turning rate."""
    truth = {speed: _TRUE[0], s.turn: _TRUE[1]}
    by_state = sp.Matrix(_HERE).subs(truth).jacobian(_STATE)
    by_twist = sp.Matrix(_HERE).jacobian([speed, s.turn]).subs(truth)
    says = "d(x, y, heading) by the state's five entries, the speed and the turning rate"
    return shared((*_STATE[2:], *_INPUTS), tuple(by_state.row_join(by_twist)), says)


def _antenna_rows() -> Formula:
    place = sp.Matrix(read(sensing.antenna, s.x, s.y, s.heading, *_ARM))
    says = "d(east, north) of the antenna by the state's five entries"
    return shared((s.heading, *_ARM), tuple(place.jacobian(_STATE)), says)


@cache
def jacobians() -> dict[str, Formula]:
    """The filter's derivatives, row by row."""
    return {"moved_rows": _moved_rows(), "antenna_rows": _antenna_rows()}


@cache
def filter_formulas() -> dict[str, Formula]:
    """What the C filter is made of."""
    step = s.x, s.y, s.heading, speed, s.turn, s.dt
    place, move = (s.x, s.y, s.heading, *_ARM), (s.heading, s.v, s.omega, *_ARM)
    wheels = s.v, s.omega, track_width, noise
    twist = *_STATE[3:], *_INPUTS[:4]
    reading = *_STATE[3:], s.omega
    return {
        "moved": formula_of(sensing.moved, step, "x, y, heading after a step"),
        "true_twist": formula_of(sensing.speed_and_turn, twist, "true speed and turning rate"),
        "gyro_reading": formula_of(sensing.gyro_reading, reading, "the gyro without slip"),
        "wheel_noise": formula_of(
            sensing.wheel_noise, wheels, "variance rates of speed and turning rate"
        ),
        "antenna": formula_of(sensing.antenna, place, "the antenna's east and north"),
        "course": formula_of(sensing.course, move, "where the antenna moves"),
        **jacobians(),
    }
