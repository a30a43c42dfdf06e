"""Stands in for numpy in the page's Python: the part that graded tasks, and wmrlib, ask of it.

Its functions do what numpy's do, which tests compare. Whatever else numpy has is refused by name.
"""

import bisect
import builtins
import cmath
import contextlib
import math
import operator
from types import SimpleNamespace

from numpy._array import asarray, elementwise, made, missing, ndarray, safe
from numpy._array import broadcast_shapes as broadcast_shapes
from numpy._making import *  # noqa: F403
from numpy._making import append, cumsum, diff, transpose
from numpy._random import Generator

inf, nan, pi, e = math.inf, math.nan, math.pi, math.e
float64, int64 = float, int
# No number in the page is numpy's own.
generic, number, floating, integer, bool_ = (
    type(name, (), {}) for name in ("generic", "number", "floating", "integer", "bool_")
)
ma = SimpleNamespace(MaskedArray=type("MaskedArray", (), {}))


def __getattr__(name):
    raise AttributeError(name) if name.startswith("__") else missing(name)


def matmul(one, other):
    one, other = asarray(one), asarray(other)
    if not 0 < one.ndim < 3 or not 0 < other.ndim < 3 or one.shape[-1] != other.shape[0]:
        raise ValueError(f"shapes {one.shape} and {other.shape} can't be multiplied")
    rows = one if one.ndim == 2 else [one]
    columns = transpose(other) if other.ndim == 2 else [other]
    entries = [builtins.sum((row * column).flat) for row in rows for column in columns]
    return made(entries, one.shape[:-1] + other.shape[1:])


ndarray.__matmul__, dot = matmul, matmul
ndarray.__rmatmul__ = lambda self, other: matmul(other, self)


@elementwise
def where(test, one, other):
    return one if test else other


def unwrap(angles):
    angles = asarray(angles)
    if angles.ndim > 1:
        raise missing("unwrap of more than a row")
    steps = diff(angles)
    turns = where(abs(steps) > pi, (steps + pi) // (2 * pi), 0) * (2 * pi)
    return angles - append(0, cumsum(turns))


@elementwise
def _near(x, y, rtol, atol):
    return x == y or abs(x - y) <= atol + rtol * abs(y) < inf


def isclose(one, other, rtol=1e-5, atol=1e-8):
    return _near(one, other, rtol, atol)


def allclose(one, other, rtol=1e-5, atol=1e-8):
    return all(isclose(one, other, rtol, atol))


def interp(x, xp, fp):
    xp, fp = asarray(xp).flat, asarray(fp).flat

    def between(at):
        at = builtins.min(builtins.max(at, xp[0]), xp[-1])
        k = bisect.bisect_right(xp, at, 1, len(xp) - 1)
        share = (at - xp[k - 1]) / (xp[k] - xp[k - 1])
        return fp[k - 1] + share * (fp[k] - fp[k - 1])

    return elementwise(between)(x)


def _reduced(function):
    def apply(value, axis=None, **more):
        value = asarray(value)
        if axis is None:
            return function(value.flat, **more)
        axis = range(value.ndim)[axis]
        layers = [value[(slice(None),) * axis + (k,)] for k in range(value.shape[axis])]
        rest = value.shape[:axis] + value.shape[axis + 1 :]
        groups = zip(*(asarray(layer).flat for layer in layers), strict=True)
        return made([function(list(group), **more) for group in groups], rest)

    return apply


def _mean(flat):
    return builtins.sum(flat) / len(flat) if len(flat) else nan


def _var(flat, ddof=0):
    middle = _mean(flat)
    squares = builtins.sum(abs(it - middle) ** 2 for it in flat)
    return safe(operator.truediv)(squares, len(flat) - ddof)


def _most(choose):
    """The first entry that is not a number, as in numpy, else what is chosen."""
    return lambda flat: next((it for it in flat if it != it), None) or choose(flat)


def _norm(flat):
    return math.hypot(*map(abs, flat))


sum, max, min, all, any, prod, mean, var, std, argmax, argmin = map(
    _reduced,
    (
        *(sum, _most(max), _most(min), all, any, math.prod, _mean, _var),
        lambda flat, ddof=0: math.sqrt(_var(flat, ddof)),
        lambda flat: flat.index(_most(builtins.max)(flat)),
        lambda flat: flat.index(_most(builtins.min)(flat)),
    ),
)


class _Part(SimpleNamespace):
    """A module of numpy."""

    def __getattr__(self, name):
        raise AttributeError(name) if name.startswith("__") else missing(f"{self.part}.{name}")


def _length(value, ord=None, axis=None):
    if ord not in (None, 2):
        raise missing(f"linalg.norm(ord={ord})")
    return _reduced(_norm)(value, axis)


linalg = _Part(part="linalg", norm=_length)
_METHODS = "sum max min all any prod mean var std argmax argmin cumsum ravel transpose"
for _name in _METHODS.split():
    setattr(ndarray, _name, vars()[_name])
random = _Part(part="random", default_rng=Generator, Generator=Generator)


def errstate(**_):
    return contextlib.nullcontext()


def vectorize(function, **_):
    return elementwise(function)


_SAME = "copysign cos degrees expm1 log10 log1p radians sin tan tanh"
_NAMED = {name: getattr(math, name) for name in _SAME.split()} | {
    **{"abs": abs, "arccos": math.acos, "arcsin": math.asin, "arctan": math.atan},
    **{"deg2rad": math.radians, "rad2deg": math.degrees, "square": lambda x: x * x},
    **{"exp": lambda x: (cmath if isinstance(x, complex) else math).exp(x), "sqrt": math.sqrt},
    **{"log": math.log, "isfinite": cmath.isfinite, "isnan": cmath.isnan},
    **{"sign": lambda x: x and math.copysign(1, x) if x == x else x, "angle": cmath.phase},
    **{"ceil": lambda x: float(math.ceil(x)) if abs(x) < inf else x},
    **{"floor": lambda x: float(math.floor(x)) if abs(x) < inf else x},
    **{"sinc": lambda x: math.sin(pi * x) / (pi * x) if x else 1.0},
    **{"arctan2": math.atan2, "hypot": math.hypot, "fmod": math.fmod, "add": operator.add},
    **{"mod": operator.mod, "remainder": operator.mod, "subtract": operator.sub},
    **{"multiply": operator.mul, "divide": operator.truediv, "power": operator.pow},
    **{"maximum": lambda a, b: a if a >= b or a != a else b},
    **{"minimum": lambda a, b: a if a <= b or a != a else b},
    **{"fmin": lambda a, b: a if a <= b or b != b else b},
    **{"clip": lambda x, low, high: builtins.min(builtins.max(x, low), high)},
    **{"logical_and": lambda a, b: bool(a and b), "logical_or": lambda a, b: bool(a or b)},
    **{"logical_not": operator.not_},
}
vars().update({name: elementwise(safe(function)) for name, function in _NAMED.items()})
absolute = abs


@elementwise
def _round(x, decimals):
    size = 10.0 ** abs(decimals)
    return builtins.round(x * size) / size if decimals > 0 else builtins.round(x / size) * size


def round(value, decimals=0):
    return _round(value, decimals)
