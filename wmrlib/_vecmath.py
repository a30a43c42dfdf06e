"""The elementary functions that the laws are made of, finite where the textbook form divides by 0.

Sine, cosine and expm1 come twice. For one number the C library is fastest. But numba has no vector
library, so a loop that calls the C library computes one number at a time; `vector_sincos` and
`vector_expm1` consist of sums, products and selections only, which LLVM computes for four or eight
runs at once. The laws are written once, with `sincos` and `decay`; `vectorised` returns the same
formula with the vector forms inside.

Sources: Sun's fdlibm (k_sin.c, k_cos.c) for the polynomials of sine and cosine; Cody and Waite,
Software Manual for the Elementary Functions (1980), for subtracting a multiple of pi/2 or ln 2 in
parts whose products are exact.
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

from wmrlib._compile import formula

LARGEST_ANGLE = 1e6  # rad; up to here a multiple of the first part of pi/2 is exact
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
def vector_sincos(angle):
    """The same; NaN beyond a million radians, where a double hardly knows its direction."""
    angle = angle if abs(angle) <= LARGEST_ANGLE else math.nan
    quarters = np.rint(angle * _QUARTERS_PER_RADIAN)
    coarse = angle - quarters * _QUARTER_1
    middle = coarse - quarters * _QUARTER_2
    lost = (coarse - middle) - quarters * _QUARTER_2  # to rounding, in the line above
    fine = quarters * _QUARTER_3 - lost
    r = middle - fine
    rest = (middle - r) - fine  # r + rest is the reduced angle to twice a double's digits
    z = r * r
    odd = r * z * (_S1 + z * (_S2 + z * (_S3 + z * (_S4 + z * (_S5 + z * _S6)))))
    even = z * z * (_C1 + z * (_C2 + z * (_C3 + z * (_C4 + z * (_C5 + z * _C6)))))
    s = r + (odd + rest)
    c = 1.0 - (0.5 * z - (even - r * rest))
    quadrant = quarters - 4.0 * np.floor(0.25 * quarters)
    swapped = (quadrant == 1.0) | (quadrant == 3.0)
    sine, cosine = (c if swapped else s), (s if swapped else c)
    left = (quadrant == 1.0) | (quadrant == 2.0)
    return (-sine if quadrant >= 2.0 else sine), (-cosine if left else cosine)


@formula
def sinc(angle):
    """sin(angle)/angle, which is 1 at 0 (numpy's sinc has a pi inside)."""
    tiny = abs(angle) <= _SMALL
    divisor = 1.0 if tiny else angle
    return 1.0 if tiny else sincos(angle)[0] / divisor


@formula
def power_of_two(n):
    """2^n for a whole number -1022 <= n <= 1023 kept in a float."""
    aligned = np.float64(n + (1.5 * 2.0**52 + 1023.0))  # its last bits are the exponent of 2^n
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


_VECTORISED = {sincos: vector_sincos, expm1: vector_expm1}


def vectorised(function):
    """The same formula with `vector_sincos` for `sincos` and `vector_expm1` for `expm1`."""
    return rebuilt(function, _VECTORISED, partial(formula, cache=False))


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
        others[function] = finish(made)
    return others[function]


def _is_formula(value) -> bool:
    if numba.config.DISABLE_JIT:
        return isinstance(value, FunctionType) and value.__module__.startswith(__package__)
    return hasattr(value, "py_func")
