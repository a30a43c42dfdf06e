"""What a check says, and how it asks a student's function: nothing that it returns or raises gets past without a clear sentence."""

from __future__ import annotations

import math
import sys
import types
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np


class Hint(AssertionError):  # noqa: N818  (its name is what a student reads)
    """Why an answer does not pass. Jupyter shows the sentence alone: a traceback would show the check, and with it the answer."""

    def _render_traceback_(self) -> list[str]:
        return [f"Hint: {self}"]


class Passed(str):
    """What a check returns: a sentence that Jupyter shows without quotation marks."""

    __slots__ = ()

    def __repr__(self) -> str:
        return str(self)


def expect(holds: bool, hint: str) -> None:
    """Raises Hint with this sentence unless the condition holds."""
    if not holds:
        raise Hint(hint)


def ask(function: Callable, *arguments: Any, **keywords: Any) -> Any:
    """What the student's function returns; that it is not written yet, or stops with an error, becomes a Hint."""
    if not callable(function):
        raise Hint(f"a function is needed here, not {_shown(function)}.")
    try:
        return function(*arguments, **keywords)
    except NotImplementedError:
        raise Hint(f"`{_name(function)}` is not written yet.") from None
    except Exception as error:
        given = ", ".join([*map(_shown, arguments), *(f"{key}={_shown(value)}" for key, value in keywords.items())])
        raise Hint(f"`{_name(function)}({given})` stops{_line(error)} with {type(error).__name__}: {error}.") from None


def ask_number(function: Callable, *arguments: Any, **keywords: Any) -> float:
    """As `ask`, for a function that is to return one finite number."""
    return number(f"`{_name(function)}`", ask(function, *arguments, **keywords), returned=True)


def ask_numbers(function: Callable, count: int, *arguments: Any, **keywords: Any) -> tuple[float, ...]:
    """As `ask`, for a function that is to return `count` finite numbers."""
    answer = ask(function, *arguments, **keywords)
    try:
        found = 0 if isinstance(answer, (str, bytes)) else len(answer)
    except TypeError:  # one number, an array without dimensions, a class
        found = 0
    if found != count:
        raise Hint(f"`{_name(function)}` returns {_shown(answer)}; {count} numbers, separated by commas, are needed.")
    return tuple(number(f"`{_name(function)}`", each, returned=True) for each in answer)


def number(name: str, value: Any, *, returned: bool = False) -> float:
    """The value as a float, if it is one finite real number; a Hint if not."""
    if value is None or value is ...:
        raise Hint(f"{name} returns nothing: does it end in `return`?" if returned else f"{name} has no value yet.")
    if not isinstance(value, (bool, np.bool_, str, bytes)):  # a number of sympy's, numpy's or Python's
        try:
            converted = float(value)
        except (TypeError, ValueError):
            pass
        else:
            expect(math.isfinite(converted), f"{name} {'returns' if returned else 'is'} {converted}, which is not a finite number.")
            return converted
    raise Hint(f"{name} {'returns' if returned else 'is'} {_shown(value)}; one number is needed.")


def own_work(function: Callable, *allowed: str) -> None:
    """Raises Hint if the student's function, or one of the notebook's that it calls, uses wmrlib, but for the names `allowed`.

    It reads the names in the compiled code. It is there to say what is asked for, not to withstand someone who hides it.
    """
    for name, value in _names(function, set()):
        home = value.__name__ if isinstance(value, types.ModuleType) else getattr(value, "__module__", None)
        if isinstance(home, str) and home.split(".")[0] == "wmrlib" and name not in allowed:
            raise Hint(f"`{_name(function)}` uses `{name}` of wmrlib; this task asks for your own formula, with `math` or `numpy`.")


def close(value: float, right: float, relative: float = 1e-6, absolute: float = 1e-9) -> bool:
    """Whether two numbers are equal up to rounding."""
    return math.isclose(value, right, rel_tol=relative, abs_tol=absolute)


def _names(function: Callable, seen: set) -> Iterator[tuple[str, Any]]:
    if not isinstance(function, types.FunctionType) or function in seen:
        return
    seen.add(function)
    codes = [function.__code__]
    while codes:
        code = codes.pop()
        codes += [each for each in code.co_consts if isinstance(each, types.CodeType)]
        for name in code.co_names:
            value = function.__globals__.get(name, sys.modules.get(name) if name == "wmrlib" else None)
            yield name, value
            if not str(getattr(value, "__module__", "")).startswith("wmrlib"):  # what wmrlib's own functions call is no matter
                yield from _names(value, seen)


def _line(error: BaseException) -> str:
    """Where in the student's code it happened: the last line of a cell that the error passed."""
    place, trace = "", error.__traceback__
    while trace:
        if "ipykernel" in trace.tb_frame.f_code.co_filename or "<ipython" in trace.tb_frame.f_code.co_filename:
            place = f" in line {trace.tb_lineno} of its cell"
        trace = trace.tb_next
    return place


def _name(function: Callable) -> str:
    return getattr(function, "__name__", type(function).__name__)


def _shown(value: Any) -> str:
    text = f"{value:.6g}" if isinstance(value, float) else repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
