"""The arrays of the page's Python: a list of numbers with a shape."""

import math
import operator
from types import SimpleNamespace

import numpy

_KINDS = {bool: "b", int: "i", float: "f", complex: "c"}


class NotInThisPage(AttributeError):  # noqa: N818
    """Names what the page's numpy lacks, and what it has."""


def missing(name):
    ours = {"elementwise", "keys", "made", "missing", "safe"}
    there = sorted(
        it
        for it, value in vars(numpy).items()
        if it[0] != "_" and callable(value) and not isinstance(value, type) and it not in ours
    )
    return NotInThisPage(
        f"numpy.{name} is not in this page, which has a part of numpy only: {', '.join(there)}, "
        "linalg.norm, random.default_rng. The notebook has all of it."
    )


def elementwise(function):
    def apply(*values):
        if not any(isinstance(value, ndarray | list | tuple) for value in values):
            return function(*values)
        arrays = [asarray(value) for value in values]
        shape = broadcast_shapes(*(each.shape for each in arrays))
        return made(map(function, *(spread(each, shape) for each in arrays)), shape)

    return apply


def made(entries, shape):
    flat = list(entries)
    return ndarray(flat, tuple(shape)) if shape != () else flat[0]


def spread(array, shape):
    own = (1,) * (len(shape) - array.ndim) + array.shape
    strides = [0 if size == 1 else step for size, step in zip(own, steps(own), strict=True)]
    flat = array.flat
    return [flat[place] for place in places(map(range, shape), strides)]


def steps(shape):
    return [math.prod(shape[axis + 1 :]) for axis in range(len(shape))]


def places(axes, strides):
    found = [0]
    for axis, step in zip(axes, strides, strict=True):
        chosen = list(axis)
        found = [place + step * at for place in found for at in chosen]
    return found


def keys(key):
    return key if isinstance(key, tuple) else (key,)


_LOGS = {math.log: 0, math.log10: 0, math.log1p: -1}
_DIVISIONS = operator.truediv, operator.floordiv


def safe(function):
    """As numpy does, nan and inf where Python raises an error or leaves the real numbers."""

    def apply(*values):
        try:
            found = function(*values)
        except (ValueError, OverflowError, ZeroDivisionError) as error:
            x, y = values[0], values[-1]
            if function in _DIVISIONS and x and x == x:
                return math.copysign(math.inf, x) * math.copysign(1.0, y)
            if function is operator.pow and not isinstance(x, complex):
                return math.copysign(math.inf, x if y % 2 == 1 else 1.0)
            if isinstance(error, OverflowError):
                return math.inf
            return -math.inf if _LOGS.get(function) == x else math.nan
        left = isinstance(found, complex) and not any(isinstance(it, complex) for it in values)
        return math.nan if left else found

    return apply


_OF_BOOLS = {operator.add: operator.or_, operator.mul: operator.and_}


def _operator(function, swapped=False):
    apply, of_bools = elementwise(safe(function)), elementwise(_OF_BOOLS.get(function))

    def method(self, other):
        bools = function in _OF_BOOLS and {self.dtype.kind, asarray(other).dtype.kind} == {"b"}
        values = (other, self) if swapped else (self, other)
        found = of_bools(*values) if bools else apply(*values)
        return found if isinstance(found, ndarray) else ndarray([found], ())

    return method


def _in_place(function):
    apply = _operator(function)

    def method(self, other):
        found = apply(self, other)
        if found.shape != self.shape:
            raise ValueError(f"an array of shape {self.shape} can't become one of {found.shape}")
        self._write(range(self.size), found.flat)
        return self

    return method


class ndarray:  # noqa: N801
    __array_priority__ = 1000  # sympy's numbers leave the formula to the array
    kind = None  # of its numbers, once it is written to

    def __init__(self, flat, shape, base=None, seats=()):
        self.base, self._seats = base, seats  # a part of another array has its numbers there
        if base is None and {type(entry) for entry in flat} == {int, float}:
            flat = [float(entry) for entry in flat]
        self._own, self.shape = flat, shape

    ndim = property(lambda self: len(self.shape))
    size = property(lambda self: math.prod(self.shape))

    @property
    def flat(self):
        if self.base is None:
            return self._own
        return tuple(self.base._own[seat] for seat in self._seats)  # which can't be written to

    def _part(self, chosen, shape):
        if self.base is None:
            return ndarray(None, shape, self, chosen)
        return ndarray(None, shape, self.base, [self._seats[place] for place in chosen])

    @property
    def dtype(self):
        kinds = {_KINDS.get(type(entry), "O") for entry in self.flat} or {"f"}
        mixed = [kind for kind in "Ocfib" if kind in kinds]
        return SimpleNamespace(kind=mixed[0] if kinds <= {*"cfi"} or len(kinds) == 1 else "O")

    T = property(
        lambda self: self._part(
            places(map(range, self.shape[::-1]), steps(self.shape)[::-1]), self.shape[::-1]
        )
    )
    real = property(lambda self: made([entry.real for entry in self.flat], self.shape))
    imag = property(lambda self: made([entry.imag for entry in self.flat], self.shape))

    def astype(self, kind):
        return ndarray([kind(entry) for entry in self.flat], self.shape)

    def copy(self):
        return ndarray(list(self.flat), self.shape)

    def reshape(self, *shape):
        shape = shape[0] if isinstance(shape[0], tuple) else shape
        rest = self.size // abs(math.prod(shape)) if -1 in shape else 0
        shape = tuple(rest if size == -1 else size for size in shape)
        if math.prod(shape) != self.size:
            raise ValueError(f"cannot reshape array of size {self.size} into shape {shape}")
        if self.ndim == 1 or self.in_one_piece():
            return self._part(range(self.size), shape)
        return ndarray(list(self.flat), shape)  # as numpy, which copies what it must

    def in_one_piece(self):
        seats = [*self._seats]
        return self.base is None or not seats or seats == [*range(seats[0], seats[0] + self.size)]

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
        return (self[k] for k in range(len(self)))

    def __getitem__(self, key):
        chosen, shape = self._chosen(key)
        if shape and not any(isinstance(it, ndarray | list) for it in keys(key)):
            return self._part(chosen, shape)
        flat = self.flat
        return made([flat[place] for place in chosen], shape)

    def __setitem__(self, key, value):
        (chosen, shape), value = self._chosen(key), asarray(value)
        if broadcast_shapes(value.shape, shape) != shape:
            raise ValueError(f"numbers of shape {value.shape} don't fit into {shape}")
        self._write(chosen, spread(value, shape))

    def _write(self, chosen, entries):
        """Store entries; refuse what numpy would cut off."""
        if self.base is not None:
            return self.base._write([self._seats[place] for place in chosen], entries)
        self.kind = self.kind or self.dtype.kind
        for place, entry in zip(chosen, entries, strict=True):
            if self.kind == "b":
                self._own[place] = bool(entry)
                continue
            if self.kind == "i" and isinstance(entry, float):
                text = f"an array of whole numbers can't keep {entry:g}: numpy cuts it off. "
                raise TypeError(text + "Begin with floats, as in np.array([0.0, 0.0])")
            self._own[place] = float(entry) if self.kind == "f" and type(entry) is int else entry

    def _chosen(self, key):
        """The places in `flat` of what an index names, and the shape of it."""
        mask = asarray(key) if isinstance(key, ndarray | list) else None
        if mask is not None and mask.dtype.kind == "b" and mask.shape == self.shape:
            chosen = [place for place, true in enumerate(mask.flat) if true]
            return chosen, (len(chosen),)
        axes, shape, sizes = [], [], iter(self.shape)
        left = self.ndim - len([it for it in keys(key) if it is not None])
        if left < 0 or sum(isinstance(it, ndarray | list) for it in keys(key)) > 1:
            raise IndexError(f"this index is too much, in a page, for {self.ndim} dimensions")
        for at in (*keys(key), *[slice(None)] * left):
            if at is None:
                shape.append(1)
                continue
            chosen = range(next(sizes))
            if isinstance(at, ndarray | list):
                at = asarray(at)
                if at.ndim != 1:
                    raise missing(f"ndarray[an array of {at.ndim} dimensions]")
                if at.dtype.kind == "b":
                    chosen = [k for k, true in zip(chosen, at.flat, strict=True) if true]
                else:
                    chosen = [chosen[k] for k in at.flat]
            elif isinstance(at, slice):
                chosen = chosen[at]
            elif hasattr(at, "__index__"):
                axes.append([chosen[at]])
                continue
            else:
                raise missing(f"ndarray[{at!r}]")
            axes.append(chosen)
            shape.append(len(chosen))
        return places(axes, steps(self.shape)), tuple(shape)

    def __float__(self):
        return float(self.item())

    def __complex__(self):
        return complex(self.item())

    def __format__(self, spec):
        return format(self.item(), spec) if spec else str(self)

    def __bool__(self):
        return bool(self.item())

    def __repr__(self):
        return f"array({self.tolist()})"

    __hash__ = None

    def __getattr__(self, name):
        raise AttributeError(name) if name.startswith("_") else missing(f"ndarray.{name}")


def asarray(value, dtype=None):
    """Return an array of numbers, of rows, or of rows of rows."""
    if dtype is not None:
        found = asarray(value)
        return found if found.dtype.kind == _KINDS.get(dtype) else found.astype(dtype)
    if isinstance(value, ndarray):
        return value
    if not isinstance(value, list | tuple | range):
        return ndarray([value], ())
    rows = [asarray(row) for row in value]
    if len({row.shape for row in rows}) > 1:
        raise ValueError("the rows have different lengths: an array needs rows of one length")
    flat = [entry for row in rows for entry in row.flat]
    return ndarray(flat, (len(rows), *(rows[0].shape if rows else ())))


def broadcast_shapes(*shapes):
    found = ()
    for shape in shapes:
        more = max(len(found), len(shape))
        padded = ((1,) * (more - len(each)) + each for each in (found, shape))
        pairs = list(zip(*padded, strict=True))
        if any(a != b and 1 not in (a, b) for a, b in pairs):
            raise ValueError(f"operands could not be broadcast together with shapes {shapes}")
        found = tuple(b if a == 1 else a for a, b in pairs)
    return found


for _name in ("add", "sub", "mul", "truediv", "floordiv", "mod", "pow", "and", "or"):
    _function = getattr(operator, _name + "_" * (_name in ("and", "or")))
    setattr(ndarray, f"__{_name}__", _operator(_function))
    setattr(ndarray, f"__r{_name}__", _operator(_function, swapped=True))
for _name in ("add", "sub", "mul", "truediv", "floordiv", "mod", "pow"):
    setattr(ndarray, f"__i{_name}__", _in_place(getattr(operator, _name)))
for _name in ("lt", "le", "gt", "ge", "eq", "ne"):
    setattr(ndarray, f"__{_name}__", _operator(getattr(operator, _name)))
for _name, _function in {
    "neg": operator.neg,
    "abs": abs,
    "invert": lambda it: not it if isinstance(it, bool) else ~it,
}.items():
    setattr(ndarray, f"__{_name}__", elementwise(_function))
