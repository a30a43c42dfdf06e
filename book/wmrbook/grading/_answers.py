"""Answers that are more than numbers: a matrix that a student's function returns, and gains."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from wmrbook.grading._hints import Hint, _name, _shown, ask, expect, floats, number
from wmrlib.gains import Gains


def ask_array(function: Callable, shape: tuple[int, ...], *arguments: Any) -> np.ndarray:
    """As `ask`, for a function that is to return a list, matrix or array of this shape, all finite."""
    name, answer = _name(function), ask(function, *arguments)
    expect(answer is not None, f"`{name}` returns nothing: does it end in `return`?")
    array = floats(answer)
    wanted = " x ".join(map(str, shape)) + (
        " numbers are" if len(shape) > 1 or shape[0] > 1 else " number is"
    )
    expect(array is not None, f"`{name}` returns {_shown(answer)}; {wanted} needed.")
    got = " x ".join(map(str, array.shape)) + " numbers" if array.ndim else "one number"
    expect(array.shape == shape, f"`{name}` returns {got}; {wanted} needed.")
    expect(
        bool(np.isfinite(array).all()),
        f"`{name}` returns a number that is not finite: {_shown(array.tolist())}.",
    )
    return array


def gains_of(name: str, value: Any) -> Gains:
    """The value, if it is Gains of single numbers; a Hint if not."""
    if value is None or value is ...:
        number(name, value)  # raises the Hint of an answer that has no value
    expect(
        isinstance(value, Gains),
        f"{name} is {_shown(value)}; `wmr.Gains(k_rho=..., k_alpha=..., h=..., v_max=...)` is needed.",
    )
    try:
        expect(
            all(np.ndim(field) == 0 for field in value),
            f"{name} holds arrays; one number a gain is needed.",
        )
        return Gains(
            *map(float, value)
        )  # `_replace` may have left an int, a number of numpy's, or what is no gain at all
    except (TypeError, ValueError, OverflowError) as error:
        raise Hint(f"{name}: {error}.") from None


def refuses(function: Callable, hint: str, *arguments: Any) -> None:
    """Raises Hint unless the student's function raises ValueError for these arguments."""
    try:
        function(*arguments)
    except ValueError:
        return
    except Exception:
        ask(function, *arguments)  # which says what happened
    given = ", ".join(map(_shown, arguments))
    expect(False, f"`{_name(function)}({given})` must raise ValueError: {hint}")


def ask_truth(function: Callable, *arguments: Any) -> bool:
    """As `ask`, for a function that is to return True or False."""
    answer = ask(function, *arguments)
    expect(answer is not None, f"`{_name(function)}` returns nothing: does it end in `return`?")
    expect(
        isinstance(answer, (bool, np.bool_)),
        f"`{_name(function)}` returns {_shown(answer)}; True or False is needed.",
    )
    return bool(answer)


def numbers(name: str, value: Any, count: int) -> tuple[float, ...]:
    """The value as `count` finite floats; a Hint if it is anything else."""
    if value is None or value is ...:
        number(name, value)  # raises the Hint of an answer that has no value
    listed = (
        isinstance(value, (tuple, list, np.ndarray)) and np.ndim(value) == 1 and len(value) == count
    )
    expect(listed, f"{name} is {_shown(value)}; {count} numbers, separated by commas, are needed.")
    return tuple(number(name, each) for each in value)
