"""A short repr for records of arrays, a comparison that returns one bool, and fields by keyword."""

from __future__ import annotations

import re
from functools import wraps
from typing import Any, TypeVar

import numpy as np

Kind = TypeVar("Kind", bound=type)
_SHORT = 72  # characters: a shorter field is shown as Python and numpy show it
_WIDTH = 88  # characters of a line


def record(kind: Kind) -> Kind:
    """Make `repr` and == of a NamedTuple, or of a dataclass with slots, fit for arrays.

    A tuple's own `repr` lists up to a thousand numbers of each array, and its own == raises an
    error where it compares arrays.
    """
    changed: Any = kind
    changed.__repr__ = short_repr
    changed.__eq__ = same
    changed.__ne__ = different
    return kind


def by_keyword(kind: Kind) -> Kind:
    """Let the error say so if the fields of a dataclass are not given by keyword."""
    changed: Any = kind
    init = changed.__init__

    @wraps(init)
    def checked_init(self, *numbers: Any, **fields: Any) -> None:
        if numbers:
            names = list(changed.__dataclass_fields__)
            given = f"{kind.__name__}({', '.join(map(_text, numbers))})"
            needed = f"{kind.__name__}({', '.join(f'{name}=...' for name in names)})"
            raise TypeError(f"{given} is not allowed: {needed}, by keyword, is needed")
        init(self, **fields)

    changed.__init__ = checked_init
    return kind


def short_repr(value: Any) -> str:
    """The record's fields by name; a long array by its shape and its range."""
    names = getattr(value, "_fields", None) or value.__slots__
    head = f"{type(value).__name__}("
    whole = ", ".join(f"{name}={_text(getattr(value, name))}" for name in names)
    if "<" not in whole and len(head + whole) < 3 * _WIDTH:
        return f"{head}{whole})"
    lines = [head]
    for item in re.split(r", (?=\w+=|<)", whole):
        if len(lines[-1]) + len(item) >= _WIDTH and lines[-1].strip() != head:
            lines.append(" " * len(head))
        lines[-1] += f"{item}, "
    return "\n".join(line.rstrip() for line in lines)[:-1] + ")"


def same(one: Any, other: Any) -> bool:
    """Whether all fields are equal, in shape and in every number; NaN equals nothing, as always."""
    if isinstance(one, tuple):
        if not isinstance(other, tuple):
            return NotImplemented
        return len(one) == len(other) and all(map(_equal, one, other))
    if type(one) is not type(other):
        return NotImplemented
    return all(_equal(getattr(one, name), getattr(other, name)) for name in one.__slots__)


def different(one: Any, other: Any) -> bool:
    """The opposite of `same`."""
    equal = one.__eq__(other)
    return equal if equal is NotImplemented else not equal


def _equal(one: Any, other: Any) -> bool:
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return np.array_equal(one, other)
    if isinstance(one, tuple) and isinstance(other, tuple):
        return same(one, other)
    return bool(one == other)


def _text(value: Any) -> str:
    if isinstance(value, np.ndarray) and value.size > _SHORT:  # spare numpy the work
        return _summary(value)
    if type(value) is tuple:
        return f"({', '.join(map(_text, value))})"
    text = " ".join(repr(value).split())
    if len(text) <= _SHORT:
        return text
    return _summary(value) if isinstance(value, np.ndarray) else f"{text[: _SHORT - 3]}..."


def _summary(array: np.ndarray) -> str:
    size = " x ".join(map(str, array.shape))
    if array.dtype == bool:
        return f"<{size} bools, {np.count_nonzero(array)} of them True>"
    part = "real part " if np.iscomplexobj(array) else ""
    numbers = np.real(array)
    finite = numbers[np.isfinite(numbers)]
    words = [f"<{size} numbers"]
    if finite.size:
        low, high = f"{finite.min():.4g}", f"{finite.max():.4g}"
        words.append(f"{part}{low}" if low == high else f"{part}from {low} to {high}")
    for count, name in ((np.isinf(numbers).sum(), "infinite"), (np.isnan(numbers).sum(), "NaN")):
        words += [f"{count} {name}"] * bool(count)
    return ", ".join(words) + ">"
