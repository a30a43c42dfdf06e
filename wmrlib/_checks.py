"""Checks of what a caller passes in: each error names the argument, its value and what is allowed."""

from __future__ import annotations

import math
from collections.abc import Collection
from typing import Any

import numpy as np

Real = float | np.ndarray


def real(
    name: str,
    value: Any,
    *,
    low: float = -math.inf,
    high: float = math.inf,
    above: float = -math.inf,
    nan: bool = False,
) -> Real:
    """Return `value` as a float, or as a float array if it has dimensions; every entry finite and within the bounds, or NaN if `nan`.

    Raises ValueError for text, booleans, complex numbers, rows of different lengths, NaN unless `nan` is True, infinities, and numbers
    outside low <= value <= high, value > above.
    """
    if type(value) is float and math.isfinite(value) and low <= value <= high and value > above:
        return value  # the common case, kept quick: a simulation checks a dozen numbers
    try:
        array = np.asarray(value)
    except ValueError:  # rows of different lengths
        array = np.array(None)
    if array.dtype.kind in "iuf":
        array = array.astype(np.float64)
        fits = np.isfinite(array) & (array >= low) & (array <= high) & (array > above)
        if (fits | np.isnan(array) if nan else fits).all():
            return array if array.ndim else float(array)
    raise ValueError(
        f"{name} = {_shown(value)} is not allowed: {_allowed(low, high, above)}{' or NaN' if nan else ''} is needed"
    )


def scalar(name: str, value: Any, **bounds: float) -> float:
    """As `real`, for arguments that can't be arrays."""
    checked = real(name, value, **bounds)
    if isinstance(checked, float):
        return checked
    raise ValueError(
        f"{name} = {_shown(value)} is not allowed: one number is needed, not an array of shape {checked.shape}"
    )


def choice(name: str, value: Any, allowed: Collection[str]) -> str:
    """Return `value` if it is one of the names in `allowed`; raises ValueError, which lists them, if it is not."""
    if isinstance(value, str) and value in allowed:
        return value
    names = ", ".join(repr(each) for each in allowed)
    raise ValueError(f"{name} = {_shown(value)} is not allowed: one of {names} is needed")


def instance(name: str, value: Any, kind: type) -> Any:
    """Return `value` if it is a `kind`; raises ValueError if it is not."""
    if isinstance(value, kind):
        return value
    raise ValueError(
        f"{name} = {_shown(value)} is not allowed: a {kind.__name__} is needed, not a {type(value).__name__}"
    )


def same_shape(**arguments: Any) -> tuple[int, ...]:
    """Return the common shape of the arguments after broadcasting; raises ValueError, which names each one's shape."""
    shapes = {name: _shape(name, value) for name, value in arguments.items()}
    try:
        return np.broadcast_shapes(*shapes.values())
    except ValueError:
        listed = ", ".join(f"{name} has shape {shape}" for name, shape in shapes.items() if shape)
        raise ValueError(
            f"mismatched lengths: {listed}; shapes that broadcast together are needed"
        ) from None


def _shape(name: str, value: Any) -> tuple[int, ...]:
    try:
        return np.shape(value)
    except ValueError:
        raise ValueError(
            f"{name} = {_shown(value)} is not allowed: a number, or an array with rows of one length, is needed"
        ) from None


def _allowed(low: float, high: float, above: float) -> str:
    bounds = []
    if above > -math.inf:
        bounds.append(f"above {above:g}")
    if low > -math.inf:
        bounds.append(f"at least {low:g}")
    if high < math.inf:
        bounds.append(f"at most {high:g}")
    return "a finite number " + " and ".join(bounds) if bounds else "a finite number"


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 80 else text[:77] + "..."
