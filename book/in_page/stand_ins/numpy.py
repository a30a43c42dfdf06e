"""Stands in for numpy in the page's Python: what wmrlib asks of it for single numbers.

An array is a list of numbers with a shape. It can be looked at and compared, nothing more; whatever
else numpy has is refused by name.
"""

import math
import operator
import random as _random
from types import SimpleNamespace

_KINDS = {bool: "b", int: "i", float: "f"}
_NEEDED = "needs numpy, which this page has not: open the notebook for it"
inf, nan, pi = math.inf, math.nan, math.pi
float64, int64 = float, int


class generic:  # noqa: N801
    """No number in the page is numpy's own."""


class number(generic):  # noqa: N801
    pass


class bool_(generic):  # noqa: N801
    pass


def _compared(operation):
    def compare(self, other):
        others = asarray(other)
        right = others.flat if others.shape else others.flat * self.size
        pairs = zip(self.flat, right, strict=True)
        return ndarray([operation(*pair) for pair in pairs], self.shape)

    return compare


def _refuse(*operands):
    raise ModuleNotFoundError(f"To calculate with arrays {_NEEDED}")


class ndarray:  # noqa: N801
    def __init__(self, flat, shape):
        self.flat, self.shape, self.ndim, self.size = flat, shape, len(shape), len(flat)
        kinds = {_KINDS.get(type(entry), "O") for entry in flat}
        kind = "f" if kinds == {"i", "f"} else "O" if len(kinds) > 1 else "".join(kinds)
        self.dtype = SimpleNamespace(kind=kind)

    def astype(self, kind):
        return ndarray([kind(entry) for entry in self.flat], self.shape)

    def all(self):
        return all(self.flat)

    def item(self):
        (only,) = self.flat
        return only

    def tolist(self):
        return [row.tolist() for row in self] if self.ndim > 1 else list(self.flat)

    def __len__(self):
        if not self.ndim:
            raise TypeError("len() of unsized object")
        return self.shape[0]

    def __iter__(self):
        if self.ndim < 2:
            return iter(self.flat)
        width = self.size // self.shape[0]
        starts = range(0, self.size, width)
        return iter([ndarray(self.flat[i : i + width], self.shape[1:]) for i in starts])

    def __float__(self):
        return float(self.item())

    def __bool__(self):
        return bool(self.item())

    def __repr__(self):
        return f"array({self.tolist()})"

    __ge__, __gt__ = _compared(operator.ge), _compared(operator.gt)
    __le__, __lt__ = _compared(operator.le), _compared(operator.lt)
    __and__, __or__ = _compared(operator.and_), _compared(operator.or_)
    __add__ = __radd__ = __sub__ = __rsub__ = __mul__ = __rmul__ = __truediv__ = __rtruediv__ = (
        _refuse
    )
    __pow__ = __matmul__ = __neg__ = __abs__ = __getitem__ = _refuse


def asarray(value):
    if isinstance(value, ndarray):
        return value
    if not isinstance(value, list | tuple):
        return ndarray([value], ())
    rows = [asarray(row) for row in value]
    if len({row.shape for row in rows}) > 1:
        raise ValueError("ragged rows")
    flat = [entry for row in rows for entry in row.flat]
    return ndarray(flat, (len(rows), *(rows[0].shape if rows else ())))


class Generator:
    """Not numpy's random numbers, but the same ones each time."""

    def __init__(self, seed):
        self._random = _random.Random(seed)

    def uniform(self, low, high, size=None):
        if size is None:
            return self._random.uniform(low, high)
        shape = size if isinstance(size, tuple) else (size,)
        width = max(asarray(low).size, asarray(high).size)
        lows, highs = (_repeated(asarray(bound).flat, width) for bound in (low, high))
        draws = (self._random.uniform(lows[i % width], highs[i % width]) for i in _places(shape))
        return ndarray(list(draws), shape)

    def integers(self, low, high):
        return self._random.randrange(low, high)


def _repeated(flat, width):
    return flat * (width // len(flat))


def _places(shape):
    return range(math.prod(shape))


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
    if any(one not in ((), longest) for one in shapes):
        raise ValueError("shapes differ")
    return longest


def vectorize(function, **options):
    return function


def where(test, one, other):
    return one if test else other


def clip(value, low, high):
    return min(max(value, low), high)


def _of_each(function):
    def apply(value):
        if not isinstance(value, list | tuple | ndarray):
            return function(value)
        return ndarray([function(entry) for entry in asarray(value).flat], shape(value))

    return apply


_ONE = (
    "ceil cos cosh degrees exp expm1 floor isfinite isnan log log1p radians sin sinh sqrt tan tanh"
)
_OTHERWISE = {"abs": abs, "arccos": math.acos, "arcsin": math.asin, "arctan": math.atan}
_OTHERWISE |= {"deg2rad": math.radians, "rad2deg": math.degrees, "square": lambda x: x * x}
_NAMED = {name: getattr(math, name) for name in _ONE.split()} | _OTHERWISE
vars().update({name: _of_each(function) for name, function in _NAMED.items()})
arctan2, fmod, hypot = math.atan2, math.fmod, math.hypot
mod = remainder = operator.mod
subtract, e = operator.sub, math.e


def __getattr__(name):
    if name.startswith("__"):
        raise AttributeError(name)
    raise ModuleNotFoundError(f"numpy.{name} {_NEEDED}")
