"""How a check asks for an answer: whatever a student's function returns, there is a hint."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Set
from typing import Any

import numpy as np

from wmrbook.grading._hints import Hint, expect, name_of, shown
from wmrlib.gains import Gains

_MOST = 1000.0  # of a gain: what is far beyond any use would take minutes to simulate


def ask(function: Callable, *arguments: Any) -> Any:
    """Return what the student's function returns; if it fails, raise a Hint that says how."""
    expect(callable(function), f"a function is needed here, not {shown(function)}.")
    try:
        answer = function(*arguments)
    except Exception as error:
        raise _failure(function, arguments, error) from None
    expect(answer is not None, f"`{name_of(function)}` returns nothing: does it end in `return`?")
    return answer


def refuses(function: Callable, hint: str, *arguments: Any) -> None:
    """Raise Hint unless the student's function raises ValueError for these arguments."""
    try:
        function(*arguments)
    except ValueError:
        return
    except Exception as error:
        raise _failure(function, arguments, error) from None
    raise Hint(f"{_call(function, arguments)} must raise ValueError: {hint}")


def _failure(function: Callable, arguments: tuple, error: Exception) -> Hint:
    """Return the hint that tells what stopped the student's function, and where."""
    if type(error) is NotImplementedError:  # `input()` raises a subclass where nobody answers
        return Hint(f"`{name_of(function)}` is not written yet.")
    message = f"{type(error).__name__}: {error}".rstrip(": ")
    return Hint(f"{_call(function, arguments)} stops{_line(error)} with {message}.")


def _call(function: Callable, arguments: tuple) -> str:
    return f"`{name_of(function)}({', '.join(map(shown, arguments))})`"


def _line(error: BaseException) -> str:
    """Return where in the student's code it happened: the last line of a cell that it passed."""
    place, trace = "", error.__traceback__
    while trace:
        file = trace.tb_frame.f_code.co_filename
        if "ipykernel_" in file or "<ipython" in file:
            place = f" in line {trace.tb_lineno} of its cell"
        trace = trace.tb_next
    return place


def ask_number(function: Callable, *arguments: Any) -> float:
    """As `ask`, for a function that is to return one finite number."""
    return number(f"`{name_of(function)}`", ask(function, *arguments), returned=True)


def ask_numbers(function: Callable, count: int, *arguments: Any) -> tuple[float, ...]:
    """As `ask`, for a function that is to return `count` finite numbers."""
    return numbers(f"`{name_of(function)}`", ask(function, *arguments), count, returned=True)


def ask_truth(function: Callable, *arguments: Any) -> bool:
    """As `ask`, for a function that is to return True or False."""
    name, answer = name_of(function), ask(function, *arguments)
    truth = isinstance(answer, (bool, np.bool_))
    expect(truth, f"`{name}` returns {shown(answer)}; True or False is needed.")
    return bool(answer)


def ask_array(function: Callable, shape: tuple[int, ...], *arguments: Any) -> np.ndarray:
    """As `ask`, for a function that is to return finite numbers in this shape."""
    name, answer = name_of(function), ask(function, *arguments)
    array = floats(answer)
    needed = " x ".join(map(str, shape)) + (" number is" if shape == (1,) else " numbers are")
    expect(array is not None, f"`{name}` returns {shown(answer)}; {needed} needed.")
    got = " x ".join(map(str, array.shape)) + " numbers" if array.ndim else "one number"
    expect(array.shape == shape, f"`{name}` returns {got}; {needed} needed.")
    finite = bool(np.isfinite(array).all())
    expect(finite, f"`{name}` returns a number that is not finite: {shown(array.tolist())}.")
    return array


def expect_value(name: str, value: Any) -> None:
    """Raise Hint if the value is still None or an ellipsis, as it was handed out."""
    expect(value is not None and value is not ..., f"{name} has no value yet.")


def ordered(answer: Any, count: int) -> bool:
    """Whether it is `count` things in order, which a set or dict has not; a text is one thing."""
    try:
        return not isinstance(answer, (str, bytes, Set, Mapping)) and len(answer) == count
    except TypeError:  # one number, an array without dimensions, a class
        return False


def number(name: str, value: Any, *, returned: bool = False) -> float:
    """Return the value as a float if it is one finite real number, of any type; else raise Hint."""
    verb = "returns" if returned else "is"
    if not returned:
        expect_value(name, value)
    needed = f"{name} {verb} {shown(value)}; one number is needed."
    if isinstance(value, (np.generic, np.ndarray)) and value.size == 1:
        value = value.item()
    expect(not isinstance(value, (bool, str, bytes)), needed)
    try:
        converted = float(value)
    except (TypeError, ValueError, OverflowError):
        raise Hint(needed) from None
    finite = math.isfinite(converted)
    expect(finite, f"{name} {verb} {converted}, which is not a finite number.")
    return converted


def numbers(name: str, value: Any, count: int, *, returned: bool = False) -> tuple[float, ...]:
    """Return the value as `count` finite floats, or raise Hint."""
    if not returned:
        expect_value(name, value)
    given = f"{name} {'returns' if returned else 'is'} {shown(value)}"
    expect(ordered(value, count), f"{given}; {count} numbers, separated by commas, are needed.")
    return tuple(number(name, entry, returned=returned) for entry in value)


def floats(value: Any) -> np.ndarray | None:
    """Return the real numbers of a list, matrix or array; None if anything else is in it."""
    try:
        array = np.asarray(value.tolist() if hasattr(value, "tolist") else value)
        return array.astype(float) if array.dtype.kind in "iufO" else None
    except (TypeError, ValueError, OverflowError):
        return None


def gains_of(name: str, value: Any) -> Gains:
    """Return the value if it is Gains of single numbers, or raise Hint."""
    expect_value(name, value)
    needed = "`wmr.Gains(k_rho=..., k_alpha=..., h=..., v_max=...)` is needed."
    expect(isinstance(value, Gains), f"{name} is {shown(value)}; {needed}")
    try:
        single = all(np.ndim(field) == 0 for field in value)
        expect(single, f"{name} holds arrays; one number a gain is needed.")
        gains = Gains(*map(float, value))  # `_replace` does not check what it is given
    except (TypeError, ValueError, OverflowError) as error:
        raise Hint(f"{name}: {error}.") from None
    for field, gain in zip(Gains._fields, gains, strict=True):
        hint = f"{name}: {field} = {gain:g} is more than {_MOST:g}, which no robot can follow."
        expect(gain <= _MOST, hint)
    return gains
