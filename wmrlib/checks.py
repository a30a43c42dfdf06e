"""Checks of arguments: each error names the argument, its value and what is allowed."""

from __future__ import annotations

import math
import numbers
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import contextmanager
from decimal import Decimal
from functools import wraps
from typing import Any, TypeVar

import numpy as np

Real = float | np.ndarray
Kind = TypeVar("Kind", bound=type)

_NAMES = {
    "m": "x y rho distance radius track_width arrival_radius pass_radius east north sigma bias jump"
    " encoder_step",
    "m/s": "v v_max left right max_speed min_speed dead_band",
    "m/s^2": "acceleration",
    "rad": "heading alpha theta angle bearing hysteresis sight compass tolerance",
    "rad/s": "omega min_rate max_rate natural_frequency",
    "s": "t dt duration last memory period delay heading_delay dropout outage jump_every lag"
    " settle",
    "degrees": "lat lon",
    "1/s": "distance_rate heading_rate gain k_x",
    '1/s ("graceful": without a unit)': "k_alpha",
    '1/m ("aicardi": in 1/s)': "k_rho",
    "1/m": "k_heading",
    "1/m^2": "k_y",
    "m^2": "L",
}
UNITS = {name: unit for unit, names in _NAMES.items() for name in names.split()}
"""The unit of an argument or a field, by its name."""


def refusal(name: str, value: Any, needed: str, remark: str = "") -> ValueError:
    """The error that every check raises."""
    try:
        text = repr(value)
    except Exception:  # an int of 5,000 digits, say
        text = object.__repr__(value)
    if "\n" in text:  # a table, for example
        text = " ".join(text.split())
    excerpt = text if len(text) <= 80 else text[:77] + "..."
    return ValueError(f"{name} = {excerpt} is not allowed: {needed} is needed{remark}")


@contextmanager
def book_extra(part: str) -> Iterator[None]:
    """Name the packages to install if an import in this block fails."""
    try:
        yield
    except ModuleNotFoundError as error:
        raise ImportError(
            f'{part} needs {error.name}: pip install ".[book]" in the repository', name=error.name
        ) from error


# Real numbers of Python and numpy, among which numpy counts timedelta64.
_PLAIN = {float, int, *(np.dtype(c).type for c in np.typecodes["AllInteger"] + "efdg")}


class _NotNumbersError(Exception):
    """Says what a value is, or holds, instead of numbers."""


# The last two are of 10**400 and of a list that holds itself.
_UNREADABLE = (_NotNumbersError, ValueError, OverflowError, RecursionError)


def real(name, value, *, low=-math.inf, high=math.inf, above=-math.inf, nan=False) -> Real:
    """Return `value` as a float or, if it has dimensions, as a float array.

    A number of another kind that has one exact value (Decimal, Fraction, sympy's pi) becomes its
    float. Raises ValueError unless every entry is a finite real number with low <= value <= high
    and value > above, or NaN if `nan`. Where numpy would drop a part of the value (a unit, a mask,
    the difference between True and 1), the error names the type and the unit that is needed.
    """
    one = type(value) is float or type(value) is np.float64
    if one and math.isfinite(value) and low <= value <= high and value > above:
        return float(value)  # the common case, kept quick: a simulation checks a dozen numbers
    named = (("above", above), ("at least", low), ("at most", high))
    bounds = [(words, bound) for words, bound in named if math.isfinite(bound)]
    try:
        array = _floats(value)
        fits = np.isfinite(array)
        if bounds:
            fits &= (array >= low) & (array <= high) & (array > above)
        if (fits | np.isnan(array) if nan else fits).all():
            return array if array.ndim else float(array)
        remark = ""
    except _UNREADABLE as error:
        remark = _remark(name, error)
    allowed = " and ".join(f"{words} {bound:g}" for words, bound in bounds)
    raise refusal(name, value, f"a finite number {allowed}".strip() + " or NaN" * nan, remark)


def floats(name: str, value: Any, needed: str) -> np.ndarray:
    """Return `value` as an array of floats; any float will do.

    Otherwise raise ValueError, which says what is `needed`.
    """
    try:
        return _floats(value)
    except _UNREADABLE as error:
        remark = _remark(name, error)
    raise refusal(name, value, needed, remark)


def _remark(name: str, error: Exception) -> str:
    """The end of a refusal: the type of a value that is no number, and the remedy."""
    if isinstance(error, _NotNumbersError):
        unit = UNITS.get(name.rpartition(".")[2])
        advice = f"the number in {unit}" if unit else "a plain number, in the documented unit"
        return f", not {error}: give {advice}"
    return ", not rows of different lengths" if isinstance(error, ValueError) else ""


def _floats(value: Any) -> np.ndarray:
    """The value as a new array of floats.

    Raises `_NotNumbersError` where numpy would drop a part of it, ValueError if its rows are ragged
    and OverflowError for 10**400.
    """
    if type(value) in _PLAIN:
        return np.array(float(value))
    if type(value) is np.ndarray and value.dtype.kind in "iuf":
        return value.astype(np.float64)
    if isinstance(value, list | tuple):
        if {*map(type, value)} <= _PLAIN:  # quick for a million numbers
            return np.array(value, dtype=np.float64)
        return np.array([_floats(entry) for entry in value])
    if isinstance(value, bool | str | bytes | bytearray):  # numpy reads the last as small numbers
        raise _NotNumbersError(kind_of(value))
    if part := _dropped(value):
        raise _NotNumbersError(part)
    try:
        # Decimal, Fraction and mpf are such numbers; sympy's pi and sqrt(2) say so themselves.
        if isinstance(value, numbers.Real | Decimal) or _own(value, "is_number") is True:
            return np.array(float(value))
        array = np.asarray(value)
    except OverflowError:
        raise
    except Exception:  # sympy's I, an interval; a conversion to an array may raise anything
        raise _NotNumbersError(kind_of(value)) from None
    if array.dtype.kind in "iuf":
        return array.astype(np.float64)
    if not array.ndim:
        raise _NotNumbersError(kind_of(value))
    if array.dtype != object:
        raise _NotNumbersError(f"an array of {array.dtype.type.__name__.rstrip('_')}")
    return np.array([_floats(entry) for entry in array.flat]).reshape(array.shape)


def _dropped(value: Any) -> str:
    """The type of a value with a unit, a mask or whatever else numpy would drop, or ""."""
    if type(value) in (np.ndarray, np.memmap):
        return ""
    if any(map(_has_unit, (value, _own(value, "dtype"), _own(value, "data")))):
        return f"{kind_of(value)} with a unit"
    return kind_of(value) if isinstance(value, np.ndarray) else ""


def _has_unit(value: Any) -> bool:
    """Whether a value says that it has a unit, as those of pint, astropy and xarray do."""
    attributes = _own(value, "attrs")
    noted = attributes if isinstance(attributes, Mapping) else {}
    return any(_own(value, name) is not None or name in noted for name in ("unit", "units"))


def _own(value: Any, name: str) -> Any:
    """An attribute that the class or the object itself has, or None.

    In a table of pandas `value.unit` may also be a column, which does not count.
    """
    try:
        has = hasattr(type(value), name) or name in vars(value)
        return getattr(value, name) if has else None
    except Exception:  # no `vars`, or a property that fails
        return None


def kind_of(value: Any) -> str:
    """The type of a value for a sentence, such as "an astropy.Quantity"."""
    if value is None:
        return "None"
    house, name = type(value).__module__.partition(".")[0], type(value).__name__
    name = name if house in ("builtins", "__main__") else f"{house}.{name}"
    return f"a{'n' * (name[0] in 'AEIOUaeiox')} {name}"  # an x is spoken as "ex"


def scalar(name: str, value: Any, *, endless: bool = False, **bounds: float) -> float:
    """As `real`, for arguments that can't be arrays; infinity too, if it may be `endless`."""
    if endless and isinstance(value, float | np.floating) and value == math.inf:
        return math.inf
    checked = real(name, value, **bounds)
    if isinstance(checked, float):
        return checked
    raise refusal(name, value, "one number", f", not an array of shape {checked.shape}")


def scalars(above_0: Collection[str] = (), **values: Any) -> list[float]:
    """Each value through `scalar`."""
    bounds: dict[str, Any] = {"above": 0.0}
    return [scalar(k, value, **bounds if k in above_0 else {}) for k, value in values.items()]


def undropped(name: str, value: Any) -> Any:
    """Return a value of any kind; raise ValueError if it has a unit or a mask, in a list too."""
    if part := _dropped(value):
        raise refusal(name, value, "an array without a unit or a mask", f", not {part}")
    for entry in value if isinstance(value, list | tuple) else ():
        undropped(name, entry)
    return value


def as_array(value: Any) -> np.ndarray:
    """The value as an array; as one of no number if it is ragged, masked or no array at all."""
    try:
        return np.array(...) if isinstance(value, np.ma.MaskedArray) else np.asarray(value)
    except Exception:  # its own conversion may raise anything
        return np.array(...)


def plain(value: Any) -> Any:
    """Return a Python number for a number, and an array as it is."""
    return value if np.ndim(value) else np.asarray(value).item()


def choice(name: str, value: Any, allowed: Collection[str], otherwise: str = "") -> str:
    """Return `value` if it is one of `allowed`; otherwise raise ValueError, which lists them."""
    if isinstance(value, str) and value in allowed:
        return value
    listed = ", ".join(repr(option) for option in allowed)
    raise refusal(name, value, f"one of {listed}{otherwise}")


def instance(name: str, value: Any, kind: type) -> Any:
    """Return `value` if it is a `kind`; otherwise raise ValueError."""
    if isinstance(value, kind):
        return value
    names = kind.__name__, type(value).__name__
    needed, given = (f"a{'n' * (word[0] in 'AEIOUaeio')} {word}" for word in names)
    raise refusal(name, value, needed, f", not {given}")


def same_shape(**arguments: Any) -> tuple[int, ...]:
    """Return the arguments' shape after broadcasting; ValueError names each one's own shape."""
    shapes = {}
    for name, value in arguments.items():
        try:
            shapes[name] = np.shape(value)
        except ValueError:
            raise refusal(name, value, "a number, or an array with rows of one length,") from None
    try:
        return np.broadcast_shapes(*shapes.values())
    except ValueError:
        listed = ", ".join(f"{name} has shape {shape}" for name, shape in shapes.items() if shape)
        needed = "shapes that broadcast together are needed"
        raise ValueError(f"mismatched lengths: {listed}; {needed}") from None


def reals(*, at_least_0=(), above_0=(), at_most_1=(), **values: Any) -> list[Real]:
    """Each value through `real`; ValueError too where their shapes don't broadcast together."""
    bounds = {name: {"low": 0.0} for name in at_least_0}
    bounds |= {name: {"above": 0.0} for name in above_0}
    bounds |= {name: {"low": 0.0, "high": 1.0} for name in at_most_1}
    checked = [real(name, value, **bounds.get(name, {})) for name, value in values.items()]
    if any(type(number) is not float for number in checked):
        same_shape(**dict(zip(values, checked, strict=True)))
    return checked


def checked(others: str = "", **bounds: Collection[str]) -> Callable[[Kind], Kind]:
    """Pass the fields of a NamedTuple through `reals` wherever one is made, by `_replace` too.

    `others` is the bound of the fields that have no other, if they have one.
    """

    def decorate(kind: Any) -> Any:
        unchecked = kind.__new__
        if others:
            bounds[others] = {*kind._fields}.difference(*bounds.values())

        @wraps(unchecked)  # numba and the reference read the signature
        def new(cls, *values, **named):
            return unchecked(cls, *reals(**bounds, **unchecked(cls, *values, **named)._asdict()))

        kind.__new__ = new
        kind._make = classmethod(lambda cls, values: cls(*values))  # `_replace` calls it
        return kind

    return decorate
