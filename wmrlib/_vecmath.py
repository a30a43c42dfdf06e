"""The elementary functions that the laws are made of, finite where the textbook form divides by 0.

Some come twice. For one number the C library is fastest. But numba has no vector library, so a loop
that calls the C library computes one number at a time; the forms named `vector_` consist of sums,
products, roots and selections only, which LLVM computes for four or eight runs at once. Formulas
are written once, without; `vectorised` returns the same formula with the vector forms inside.

Sources: Sun's fdlibm (k_sin.c, k_cos.c, s_atan.c) for the polynomials of sine, cosine and arc
tangent; Cody and Waite, Software Manual for the Elementary Functions (1980), for subtracting a
multiple of a number in parts whose products are exact.
"""

from __future__ import annotations

import math
from collections.abc import Hashable
from contextlib import suppress
from functools import partial
from types import CellType, FunctionType

import numba
import numpy as np
from numba.core import types
from numba.extending import intrinsic

from wmrlib._compile import compiled, formula

LARGEST_ANGLE = 1e6  # rad; up to here a multiple of the first part of pi/2 is exact
_ALIGNING = 1.5 * 2.0**52  # added to a number, it leaves it rounded in the last bits
_SMALL = 1e-8  # below this, the next term of the series is under half a unit in the last place
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
_TURN = 2.0 * math.pi
_TURN_1 = 4.0 * _QUARTER_1
_TURN_2 = _TURN - _TURN_1
_LEAST = 5e-324
_HARDLY_HALF = 0.5 + 1e-9
_HALF_OF_EIGHTH = math.sqrt(2.0) - 1.0  # the tangent of pi/8
NEAREST = 1e-140  # the square of a shorter distance may be lost
_F = tuple(1.0 / math.factorial(n) for n in range(14))
_LOWEST = -40.0  # exp of less is lost beside 1
_HIGHEST = 709.0  # exp of more overflows


@formula
def sincos(angle):
    """The sine and the cosine of `angle` [rad]."""
    return math.sin(angle), math.cos(angle)


@formula
def expm1(x):
    """exp(x) - 1, accurate near 0 too."""
    return math.expm1(x)


@formula
def distance(x, y):
    return math.hypot(x, y)


@formula
def direction(y, x):
    return math.atan2(y, x)


@compiled
def wrap(angle):
    """The same direction in (-pi, pi]."""
    if -math.pi < angle <= math.pi:
        return angle
    angle = np.fmod(angle, _TURN)  # exact, and so is what follows
    if angle > math.pi:
        return angle - _TURN
    return angle + _TURN if angle <= -math.pi else angle


@formula
def turned(number, quadrant):
    """The number, with the other sign in the quadrants 2 and 3."""
    return np.int64(np.float64(number).view(np.int64) ^ ((quadrant & 2) << 62)).view(np.float64)


@formula
def vector_sincos(angle):
    """The same; NaN beyond a million radians, where a double hardly knows its direction."""
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
def sinc(angle):
    """sin(angle)/angle, which is 1 at 0 (numpy's sinc has a pi inside)."""
    tiny = abs(angle) <= _SMALL
    divisor = 1.0 if tiny else angle
    return 1.0 if tiny else sincos(angle)[0] / divisor


@formula
def power_of_two(n):
    """2^n for a whole number -1022 <= n <= 1023 kept in a float."""
    aligned = np.float64(n + (_ALIGNING + 1023.0))  # its last bits are the exponent of 2^n
    return np.int64(aligned.view(np.int64) << 52).view(np.float64)  # where a double keeps it


@formula
def vector_expm1(x):
    """exp(x) - 1, accurate near 0 too; above 709 it stays at its value there."""
    x = _LOWEST if x < _LOWEST else x
    x = _HIGHEST if x > _HIGHEST else x
    doublings = np.rint(x * _DOUBLINGS_PER_UNIT)
    coarse = x - doublings * _LN2_1
    r = coarse - doublings * _LN2_2
    rest = (coarse - r) - doublings * _LN2_2  # what rounding took from the line above
    high = _F[8] + r * (_F[9] + r * (_F[10] + r * (_F[11] + r * (_F[12] + r * _F[13]))))
    low = _F[3] + r * (_F[4] + r * (_F[5] + r * (_F[6] + r * (_F[7] + r * high))))
    series = r + (rest + r * r * (_F[2] + r * low))
    scale = power_of_two(doublings)
    return scale * series + (scale - 1.0)


@formula
def decay(rho, k_rho):
    """(1 - exp(-k_rho rho))/rho, which is k_rho at rho = 0."""
    x = k_rho * rho
    tiny = abs(x) <= _SMALL
    divisor = 1.0 if tiny else rho
    return k_rho * (1.0 - 0.5 * x) if tiny else -expm1(-x) / divisor


@formula
def vector_hypot(x, y):
    """The same; NaN if it is over 1e150, or under 1e-140 and not 0."""
    return np.sqrt(x * x + y * y)


@formula
def vector_atan2(y, x):
    """The same; NaN if both are infinite."""
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
    angle = _TURN / 8.0 + angle if turned else angle
    angle = _TURN / 4.0 - angle if steep else angle
    angle = _TURN / 2.0 - angle if np.signbit(x) else angle
    return np.copysign(angle, y)


@formula
def vector_wrap(angle):
    """The same, as exact; NaN beyond a million radians."""
    angle = angle if abs(angle) <= LARGEST_ANGLE else math.nan
    turns = np.ceil(angle * (1.0 / _TURN) - _HARDLY_HALF)
    angle = (angle - turns * _TURN_1) - turns * _TURN_2  # no product here is rounded
    return angle - _TURN if angle > math.pi else angle


@formula
def vector_wrap_once(angle):
    """The same for what is between two directions in (-pi, pi]: the multiple is -1, 0 or 1."""
    angle = angle - _TURN if angle > math.pi else angle
    return angle + _TURN if angle <= -math.pi else angle


def _ask_for_512_bits(function) -> None:
    with suppress(AttributeError, TypeError):  # without it, loops are vectorised less widely
        # llvmlite's own `add` refuses an attribute with a value.
        set.add(function.attributes, '"prefer-vector-width"="512"')


@intrinsic
def _prefer_512_bits(typing_context):
    def generate(context, builder, signature, arguments):
        _ask_for_512_bits(builder.function)
        return context.get_dummy_value()

    return types.none(), generate


# To be called in a loop that should use the widest vectors there are: by default LLVM halves those
# of AVX-512, for the sake of programs that use them only now and then.
widest_vectors = (lambda: None) if numba.config.DISABLE_JIT else _prefer_512_bits


_VECTORISED = {
    sincos: vector_sincos,
    expm1: vector_expm1,
    distance: vector_hypot,
    direction: vector_atan2,
    wrap: vector_wrap,
}
BETWEEN_DIRECTIONS = _VECTORISED | {wrap: vector_wrap_once}


def vectorised(function, forms=_VECTORISED):
    """The same formula with `vector_sincos` for `sincos`, and so on, by the table `forms`."""
    return rebuilt(function, forms, partial(formula, cache=False))


def rebuilt(function, others, finish=lambda made: made):
    """The same formula, whatever it calls included, that calls others[f] in the place of each f.

    `others` keeps what is made; `finish` makes it out of a plain function.
    """
    if function not in others:
        plain = getattr(function, "py_func", function)

        def other(value):
            known = isinstance(value, Hashable) and value in others
            return rebuilt(value, others, finish) if known or _is_formula(value) else value

        names = {name: other(plain.__globals__.get(name)) for name in plain.__code__.co_names}
        used = {name: value for name, value in names.items() if name in plain.__globals__}
        cells = tuple(CellType(other(cell.cell_contents)) for cell in plain.__closure__ or ())
        made = FunctionType(
            plain.__code__, plain.__globals__ | used, plain.__name__, plain.__defaults__, cells
        )
        made.__qualname__ = f"{plain.__qualname__}_rebuilt"  # see `compiled`
        others[function] = finish(made)
    return others[function]


def _is_formula(value) -> bool:
    if numba.config.DISABLE_JIT:
        return isinstance(value, FunctionType) and value.__module__.startswith(__package__)
    return hasattr(value, "py_func")
