"""The elementary functions again, as sums, products, roots and selections only.

numba has no vector library, so a loop that calls the C library computes one number at a time; these
forms LLVM computes for four or eight runs at once (2.7 ns a step of a sweep, and 74 without).
Formulas are written once, with the functions of `elementary`; `vectorised` returns the same
formula with these inside.

Sources: Sun's fdlibm (k_sin.c, k_cos.c, s_atan.c) for the polynomials of sine, cosine and arc
tangent; Cody and Waite, Software Manual for the Elementary Functions (1980), for subtracting a
multiple of a number in parts whose products are exact.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from types import FunctionType

import numpy as np

from wmrlib.compilation import formula
from wmrlib.elementary import TURN, direction, distance, expm1, sincos, wrap

LARGEST_ANGLE = 1e6  # rad; up to here a multiple of the first part of pi/2 is exact
_ALIGNING = 1.5 * 2.0**52  # added to a number, it leaves it rounded in the last bits
_QUARTERS_PER_RADIAN = 2.0 / math.pi
_QUARTER_1 = 1.57079632673412561417  # the three parts of pi/2
_QUARTER_2 = 6.07710050630396597660e-11
_QUARTER_3 = 2.02226624879595063154e-21
_DOUBLINGS_PER_UNIT = 1.0 / math.log(2.0)
_LN2_1, _LN2_2 = 6.93147180369123816490e-1, 1.90821492927058770002e-10  # the two parts of ln 2
_S1, _S2, _S3 = -1.66666666666666324348e-1, 8.33333333332248946124e-3, -1.98412698298579493134e-4
_S4, _S5, _S6 = 2.75573137070700676789e-6, -2.50507602534068634195e-8, 1.58969099521155010221e-10
_C1, _C2, _C3 = 4.16666666666666019037e-2, -1.38888888888741095749e-3, 2.48015872894767294178e-5
_C4, _C5, _C6 = -2.75573143513906633035e-7, 2.08757232129817482790e-9, -1.13596475577881948265e-11
_T1, _T2, _T3 = 3.33333333333329318027e-1, -1.99999999998764832476e-1, 1.42857142725034663711e-1
_T4, _T5, _T6 = -1.11111104054623557880e-1, 9.09088713343650656196e-2, -7.69187620504482999495e-2
_T7, _T8, _T9 = 6.66107313738753120669e-2, -5.83357013379057348645e-2, 4.97687799461593236017e-2
_T10, _T11 = -3.65315727442169155270e-2, 1.62858201153657823623e-2
_TURN_1 = 4.0 * _QUARTER_1
_TURN_2 = TURN - _TURN_1
_LEAST = 5e-324
_HARDLY_HALF = 0.5 + 1e-9
_HALF_OF_EIGHTH = math.sqrt(2.0) - 1.0  # the tangent of pi/8
NEAREST = 1e-140  # the square of a shorter distance may be lost
_F = tuple(1.0 / math.factorial(n) for n in range(14))
_LOWEST = -40.0  # exp of less is lost beside 1
_HIGHEST = 709.0  # exp of more overflows


@formula
def turned(number, quadrant):
    """The number, with the other sign in the quadrants 2 and 3."""
    return np.int64(np.float64(number).view(np.int64) ^ ((quadrant & 2) << 62)).view(np.float64)


@formula
def vector_sincos(angle):
    """`sincos`; NaN beyond a million radians, where a double hardly knows its direction."""
    angle = angle if abs(angle) <= LARGEST_ANGLE else math.nan
    aligned = np.float64(angle * _QUARTERS_PER_RADIAN + _ALIGNING)
    quarters, quadrant = aligned - _ALIGNING, aligned.view(np.int64)
    r = ((angle - quarters * _QUARTER_1) - quarters * _QUARTER_2) - quarters * _QUARTER_3
    z = r * r
    odd = z * (_S1 + z * (_S2 + z * (_S3 + z * (_S4 + z * (_S5 + z * _S6)))))
    even = z * z * (_C1 + z * (_C2 + z * (_C3 + z * (_C4 + z * (_C5 + z * _C6)))))
    s, c = r + r * odd, 1.0 - (0.5 * z - even)
    swapped = (quadrant & 1) != 0
    sine, cosine = (c if swapped else s), (s if swapped else c)
    return turned(sine, quadrant), turned(cosine, quadrant + 1)


@formula
def power_of_two(n):
    """2^n for a whole number -1022 <= n <= 1023 kept in a float."""
    aligned = np.float64(n + (_ALIGNING + 1023.0))  # its last bits are the exponent of 2^n
    return np.int64(aligned.view(np.int64) << 52).view(np.float64)  # where a double keeps it


@formula
def vector_expm1(x):
    """`expm1`; above 709 it stays at its value there."""
    x = _LOWEST if x < _LOWEST else x
    x = _HIGHEST if x > _HIGHEST else x
    doublings = np.rint(x * _DOUBLINGS_PER_UNIT)
    coarse = x - doublings * _LN2_1
    r = coarse - doublings * _LN2_2
    rest = (coarse - r) - doublings * _LN2_2  # the rounding error of the line above
    high = _F[8] + r * (_F[9] + r * (_F[10] + r * (_F[11] + r * (_F[12] + r * _F[13]))))
    low = _F[3] + r * (_F[4] + r * (_F[5] + r * (_F[6] + r * (_F[7] + r * high))))
    series = r + (rest + r * r * (_F[2] + r * low))
    scale = power_of_two(doublings)
    return scale * series + (scale - 1.0)


@formula
def vector_hypot(x, y):
    """`distance`; NaN if it is over 1e150, or under 1e-140 and not 0."""
    return np.sqrt(x * x + y * y)


@formula
def vector_atan2(y, x):
    """`direction`; NaN if both are infinite."""
    high, wide = abs(y), abs(x)
    steep = high > wide
    short, long = (wide if steep else high), (high if steep else wide)
    long = _LEAST if long < _LEAST else long
    turned = short > _HALF_OF_EIGHTH * long  # back by pi/4, where the series is long
    r = (short - long if turned else short) / (long + short if turned else long)
    z = r * r
    w = z * z  # the even and the odd powers are summed at the same time
    odd = z * (_T1 + w * (_T3 + w * (_T5 + w * (_T7 + w * (_T9 + w * _T11)))))
    even = w * (_T2 + w * (_T4 + w * (_T6 + w * (_T8 + w * _T10))))
    angle = r - r * (odd + even)
    angle = TURN / 8.0 + angle if turned else angle
    angle = TURN / 4.0 - angle if steep else angle
    angle = TURN / 2.0 - angle if np.signbit(x) else angle
    return np.copysign(angle, y)


@formula
def vector_wrap(angle):
    """`wrap`, as exact; NaN beyond a million radians."""
    angle = angle if abs(angle) <= LARGEST_ANGLE else math.nan
    turns = np.ceil(angle * (1.0 / TURN) - _HARDLY_HALF)
    angle = (angle - turns * _TURN_1) - turns * _TURN_2  # no product here is rounded
    return angle - TURN if angle > math.pi else angle


@formula
def vector_wrap_once(angle):
    """`wrap` of the difference of two directions in (-pi, pi]: it takes at most one turn."""
    angle = angle - TURN if angle > math.pi else angle
    return angle + TURN if angle <= -math.pi else angle


_FORMS = {
    sincos: vector_sincos,
    expm1: vector_expm1,
    distance: vector_hypot,
    direction: vector_atan2,
    wrap: vector_wrap,
}
BETWEEN_DIRECTIONS = _FORMS | {wrap: vector_wrap_once}


def vectorised(function: Callable, forms: dict = _FORMS) -> Callable:
    """The same formula, and all that it calls, with the vector forms of the table `forms`.

    Its globals are replaced, so that a formula is written once: written again with vector forms,
    laws and motion would be 60 lines more, and a law would be added in two places.
    """
    if function not in forms:
        plain = getattr(function, "__wrapped__", function)  # of several kinds of numbers
        used = {
            name: vectorised(value, forms) if _is_formula(value) else value
            for name, value in plain.__globals__.items()
            if name in plain.__code__.co_names
        }
        used["__name__"] = plain.__module__  # numba imports this module for its compiled code
        made = FunctionType(plain.__code__, used, plain.__name__, plain.__defaults__)
        made.__qualname__ = f"{plain.__qualname__}_vectorised"
        forms[function] = formula(made)
    return forms[function]


def _is_formula(value: object) -> bool:
    return isinstance(value, FunctionType) and value.__module__.startswith("wmrlib")
