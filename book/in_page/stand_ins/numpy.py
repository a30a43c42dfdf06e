"""Stands in for numpy in the page's Python: what wmrlib asks of it for single numbers.

An array is a list of numbers with a shape. It can be looked at and compared, nothing more; whatever
else numpy has is refused by name.
"""

import math
import operator
import random as _random
from math import fmod, hypot, inf, nan, pi  # noqa: F401
from operator import mod, sub as subtract  # noqa
from types import SimpleNamespace

_KINDS = {bool: "b", int: "i", float: "f"}
float64, int64 = float, int


class generic:  # noqa: N801
    """No number in the page is numpy's own."""


class number(generic):  # noqa: N801
    pass


class bool_(generic):  # noqa: N801
    pass


class Generator:
    """Other numbers than numpy's, and the same ones each time."""

    def __init__(self, seed):
        self._random = _random.Random(seed)

    def uniform(self, low, high, size=None):
        lows, highs = asarray(low), asarray(high)
        if size is None:
            return self._random.uniform(low, high)
        shape = size if isinstance(size, tuple) else (size,)
        count, width = math.prod(shape), max(lows.size, highs.size)
        pairs = list(zip(lows.flat * (width // lows.size), highs.flat * (width // highs.size)))
        return ndarray([self._random.uniform(*pairs[i % width]) for i in range(count)], shape)

    def integers(self, low, high):
        return self._random.randrange(low, high)


class ndarray:  # noqa: N801
    def __init__(self, flat, shape):
        self.flat, self.shape, self.ndim, self.size = flat, shape, len(shape), len(flat)
        kinds = {_KINDS.get(type(each), "O") for each in flat}
        if kinds == {"i", "f"}:
            kinds = {"f"}
        self.dtype = SimpleNamespace(kind=kinds.pop() if len(kinds) == 1 else "O")

    def astype(self, kind):
        return ndarray([kind(each) for each in self.flat], self.shape)

    def all(self):
        return all(self.flat)

    def item(self):
        (only,) = self.flat
        return only

    def tolist(self):
        return [each.tolist() for each in self] if self.ndim > 1 else list(self.flat)

    def __iter__(self):
        if self.ndim < 2:
            return iter(self.flat)
        width = self.size // self.shape[0]
        starts = range(0, self.size, width)
        return iter([ndarray(self.flat[i : i + width], self.shape[1:]) for i in starts])

    def __float__(self):
        return float(self.item())

    def __repr__(self):
        return f"array({self.tolist()})"

    def __array_is_missing(self, *others):
        raise ModuleNotFoundError("to calculate with arrays needs numpy: open the notebook for it")

    __add__ = __radd__ = __sub__ = __rsub__ = __mul__ = __rmul__ = __truediv__ = __array_is_missing
    __rtruediv__ = __pow__ = __matmul__ = __neg__ = __getitem__ = __array_is_missing

    def _with(operation):
        def apply(self, other):
            others = asarray(other).flat
            pairs = zip(self.flat, others * (self.size // len(others)), strict=True)
            return ndarray([operation(*pair) for pair in pairs], self.shape)

        return apply

    __ge__, __gt__, __le__, __lt__ = map(
        _with, (operator.ge, operator.gt, operator.le, operator.lt)
    )
    __and__, __or__ = _with(operator.and_), _with(operator.or_)


def asarray(value):
    if isinstance(value, ndarray):
        return value
    if not isinstance(value, (list, tuple)):
        return ndarray([value], ())
    rows = [asarray(each) for each in value]
    if len({row.shape for row in rows}) > 1:
        raise ValueError("ragged rows")
    flat = [each for row in rows for each in row.flat]
    return ndarray(flat, (len(rows), *(rows[0].shape if rows else ())))


array = asarray
random = SimpleNamespace(default_rng=Generator, Generator=Generator)
ma = SimpleNamespace(MaskedArray=type("MaskedArray", (), {}))


def zeros(shape):
    return ndarray([0.0] * math.prod(shape), shape)


def shape(value):
    return asarray(value).shape


def ndim(value):
    return asarray(value).ndim


def ravel(value):
    return ndarray(asarray(value).flat, (asarray(value).size,))


def broadcast_shapes(*shapes):
    longest = max(shapes, key=len)
    if any(each not in ((), longest) for each in shapes):
        raise ValueError("shapes differ")
    return longest


def vectorize(function, **options):
    return function


def clip(value, low, high):
    return min(max(value, low), high)


def where(test, one, other):
    return one if test else other


def _of_each(function):
    def apply(value):
        if not isinstance(value, (list, tuple, ndarray)):
            return function(value)
        return ndarray([function(each) for each in asarray(value).flat], shape(value))

    return apply


_SAME_NAME = "cos degrees exp floor isfinite isnan log radians sin sqrt tan"
vars().update({name: _of_each(getattr(math, name)) for name in _SAME_NAME.split()})
arctan2 = math.atan2


def __getattr__(name):
    if name.startswith("__"):
        raise AttributeError(name)
    raise ModuleNotFoundError(f"numpy.{name} is not in this page: open the notebook for it")
