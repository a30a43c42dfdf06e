"""Checks of arguments: each error names the argument, its value and what is allowed."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from functools import wraps
from typing import Any, TypeVar

import numpy as np

Real = float | np.ndarray
Kind = TypeVar("Kind", bound=type)


def refusal(name: str, value: Any, needed: str, remark: str = "") -> ValueError:
    """The error that every check raises."""
    try:
        text = repr(value)
    except Exception:  # an int of 5,000 digits, say
        text = object.__repr__(value)
    shown = text if len(text) <= 80 else text[:77] + "..."
    return ValueError(f"{name} = {shown} is not allowed: {needed} is needed{remark}")


@contextmanager
def book_extra(part: str) -> Iterator[None]:
    """Say what to install where an import in this block lacks its package."""
    try:
        yield
    except ModuleNotFoundError as error:
        raise ImportError(
            f'{part} needs {error.name}: pip install ".[book]" in the repository', name=error.name
        ) from error


def real(name, value, *, low=-math.inf, high=math.inf, above=-math.inf, nan=False) -> Real:
    """Return `value` as a float or, if it has dimensions, as a float array.

    Raises ValueError unless every entry is a finite real number with low <= value <= high and
    value > above, or NaN if `nan`; text, booleans, ragged rows and masked arrays are refused.
    """
    if type(value) is float and math.isfinite(value) and low <= value <= high and value > above:
        return value  # the common case, kept quick: a simulation checks a dozen numbers
    array = as_array(value)
    if array.dtype.kind in "iuf":
        array = array.astype(np.float64)
        fits = np.isfinite(array) & (array >= low) & (array <= high) & (array > above)
        if (fits | np.isnan(array) if nan else fits).all():
            return array if array.ndim else float(array)
    bounds = (("above", above), ("at least", low), ("at most", high))
    allowed = " and ".join(f"{words} {bound:g}" for words, bound in bounds if math.isfinite(bound))
    raise refusal(name, value, f"a finite number {allowed}".strip() + " or NaN" * nan)


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


def _masked(value: Any) -> bool:
    """Whether numpy would put a number where a mask says that there is none."""
    listed = isinstance(value, list | tuple) and any(map(_masked, value))
    return listed or isinstance(value, np.ma.MaskedArray)


def as_array(value: Any) -> np.ndarray:
    """The value as an array; as one of no number if it is ragged, masked or no array at all."""
    try:
        return np.array(...) if _masked(value) else np.asarray(value)
    except (ValueError, TypeError, OverflowError, RecursionError):
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
    wanted, given = (f"a{'n' * (word[0] in 'AEIOUaeio')} {word}" for word in names)
    raise refusal(name, value, wanted, f", not {given}")


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
    numbers = [real(name, value, **bounds.get(name, {})) for name, value in values.items()]
    if any(type(number) is not float for number in numbers):
        same_shape(**values)
    return numbers


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
