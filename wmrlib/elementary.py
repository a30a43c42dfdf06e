"""The elementary functions that formulas are made of, finite where the textbook divides by 0.

Each function is written for one number, as compiled loops call it. From Python it can also be
called with arrays, for which a second version is registered beside it, and with sympy symbols, for
which `symbolic` registers a third. So a formula made of these functions takes numbers, arrays and
symbols alike. Where Python raises an error for one number and compiled code answers with infinity
or NaN, Python's version answers so too.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import singledispatch
from typing import Any

import numpy as np

from wmrlib.compilation import chosen_by_type

TURN = 2.0 * math.pi
SMALL = 1e-8  # below this, the next term of the series is under half a unit in the last place


def _kinds(of_arrays: Callable | None = None, beyond: Any = None) -> Callable[[Callable], Any]:
    """The function, and another for arrays; more can be added by the type of the first argument.

    Called from Python with a number out of its range, the function returns `beyond`, if given.
    """

    def decorate(function: Callable) -> Any:
        kinds = singledispatch(function)
        chosen_by_type(kinds)(lambda *_: function)
        if of_arrays:
            kinds.register(np.ndarray, of_arrays)

        def of_float(number):
            try:
                return function(number)
            except (ValueError, OverflowError):
                return beyond

        if beyond is not None:
            kinds.register(float, of_float)
        return kinds

    return decorate


@_kinds(lambda angle: (np.sin(angle), np.cos(angle)), beyond=(math.nan, math.nan))
def sincos(angle):
    """The sine and the cosine of `angle` [rad]."""
    return math.sin(angle), math.cos(angle)


@_kinds(np.expm1, beyond=math.inf)
def expm1(x):
    """exp(x) - 1, accurate near 0 too."""
    return math.expm1(x)


@_kinds(np.sqrt, beyond=math.nan)
def root(x):
    """The square root of x."""
    return math.sqrt(x)


@_kinds(np.hypot)
def distance(x, y):
    """The length of the vector (x, y)."""
    return math.hypot(x, y)


@_kinds(np.arctan2)
def direction(y, x):
    """The direction of the vector (x, y), rad in [-pi, pi], counted from the x axis."""
    return math.atan2(y, x)


@_kinds()
def wrap(angle):
    """The same direction in (-pi, pi]."""
    if -math.pi < angle <= math.pi:
        return angle
    angle = float(np.fmod(angle, TURN))  # exact, as are the differences below
    if angle > math.pi:
        return angle - TURN
    return angle + TURN if angle <= -math.pi else angle


@_kinds()
def sinc(angle):
    """sin(angle)/angle, which is 1 at 0 (numpy's sinc has a pi inside)."""
    tiny = abs(angle) <= SMALL
    divisor = 1.0 if tiny else angle
    return 1.0 if tiny else sincos(angle)[0] / divisor


@_kinds()
def decay(rho, k_rho):
    """(1 - exp(-k_rho rho))/rho, which is k_rho at rho = 0."""
    x = k_rho * rho
    tiny = abs(x) <= SMALL
    divisor = 1.0 if tiny else rho
    return k_rho * (1.0 - 0.5 * x) if tiny else -expm1(-x) / divisor


@_kinds(lambda value, limit: np.fmin(limit / value, 1.0))
def share_of(value, limit):
    """The factor that brings a value down to its limit."""
    return limit / value if value > limit else 1.0


@_kinds(np.clip)
def between(value, low, high):
    """The value, or the limit that it is beyond."""
    value = high if value > high else value
    return low if value < low else value


@_kinds(np.copysign)
def signed(size, like):
    """A size with the sign of another number."""
    return math.copysign(size, like)


@_kinds()
def stepped(x, step):
    """The nearest whole number of steps, or x itself if a step is 0."""
    return step * np.floor(x / step + 0.5) if step > 0.0 else x


@_kinds()
def whole(x):
    """The nearest whole number."""
    return np.floor(x + 0.5)


@_kinds(lambda value, limit, other: np.where(np.abs(value) < limit, value, other))
def within(value, limit, other):
    """`value` if it is smaller than `limit`, with either sign; otherwise, or if NaN, `other`."""
    return value if abs(value) < limit else other


@wrap.register(np.ndarray)
def _(angle):
    turned = np.fmod(angle, TURN)
    turned = np.where(turned > math.pi, turned - TURN, turned)
    return np.where(turned <= -math.pi, turned + TURN, turned)


@sinc.register(np.ndarray)
def _(angle):
    tiny = np.abs(angle) <= SMALL
    return np.where(tiny, 1.0, np.sin(angle) / np.where(tiny, 1.0, angle))


@decay.register(np.ndarray)
def _(rho, k_rho):
    x = k_rho * rho
    tiny = np.abs(x) <= SMALL
    return np.where(tiny, k_rho * (1.0 - 0.5 * x), -np.expm1(-x) / np.where(tiny, 1.0, rho))


def elementwise(formula: Callable, *arguments: Any) -> Any:
    """The results of a formula for numbers, or for each entry of arrays that broadcast."""
    if all(isinstance(value, float | int) for value in arguments):
        return formula(*arguments)
    arrays = np.broadcast_arrays(*arguments)
    with np.errstate(all="ignore"):  # infinities and NaN are answers, as in a compiled loop
        results = formula(*arrays)
    if isinstance(results, tuple):
        return tuple(np.array(np.broadcast_to(result, arrays[0].shape)) for result in results)
    return np.array(np.broadcast_to(results, arrays[0].shape))
