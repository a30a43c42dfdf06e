"""What a check says, and how it asks a student's function: nothing that it returns or raises gets past without a clear sentence."""

from __future__ import annotations

import contextlib
import importlib
import math
import types
from collections.abc import Callable, Iterator, Mapping, Set
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
        given = ", ".join(
            [
                *map(_shown, arguments),
                *(f"{key}={_shown(value)}" for key, value in keywords.items()),
            ]
        )
        raise Hint(
            f"`{_name(function)}({given})` stops{_line(error)} with {type(error).__name__}: {error}."
        ) from None


def ask_number(function: Callable, *arguments: Any, **keywords: Any) -> float:
    """As `ask`, for a function that is to return one finite number."""
    return number(f"`{_name(function)}`", ask(function, *arguments, **keywords), returned=True)


def ask_numbers(
    function: Callable, count: int, *arguments: Any, **keywords: Any
) -> tuple[float, ...]:
    """As `ask`, for a function that is to return `count` finite numbers."""
    answer = ask(function, *arguments, **keywords)
    if not ordered(answer, count):
        raise Hint(
            f"`{_name(function)}` returns {_shown(answer)}; {count} numbers, separated by commas, are needed."
        )
    return tuple(number(f"`{_name(function)}`", each, returned=True) for each in answer)


def ordered(answer: Any, count: int) -> bool:
    """Whether it is `count` things one after the other; a set or a dict has them in no order, and a text is one thing."""
    try:
        return not isinstance(answer, (str, bytes, Set, Mapping)) and len(answer) == count
    except TypeError:  # one number, an array without dimensions, a class
        return False


def number(name: str, value: Any, *, returned: bool = False) -> float:
    """The value as a float, if it is one finite real number; a Hint if not."""
    if value is None or value is ...:
        raise Hint(
            f"{name} returns nothing: does it end in `return`?"
            if returned
            else f"{name} has no value yet."
        )
    plain = (
        value.item() if isinstance(value, (np.generic, np.ndarray)) and value.size == 1 else value
    )  # what stands in the array
    if not isinstance(
        plain, (bool, str, bytes, np.ndarray)
    ):  # a number of sympy's, numpy's or Python's
        try:
            converted = float(plain)
        except (TypeError, ValueError):
            pass
        except OverflowError:
            raise Hint(
                f"{name} {'returns' if returned else 'is'} a number that is far too large."
            ) from None
        else:
            expect(
                math.isfinite(converted),
                f"{name} {'returns' if returned else 'is'} {converted}, which is not a finite number.",
            )
            return converted
    raise Hint(f"{name} {'returns' if returned else 'is'} {_shown(value)}; one number is needed.")


def floats(value: Any) -> np.ndarray | None:
    """The numbers of a list, matrix or array; None if it holds anything else: texts, truths, complex numbers, rows of different lengths."""
    try:
        given = np.asarray(value)
        return given.astype(float) if given.dtype.kind in "iufO" else None
    except (TypeError, ValueError, OverflowError):
        return None


def own_work(function: Callable, *allowed: str) -> None:
    """Raises Hint if the student's function, or one of the notebook's that it calls, uses wmrlib, but for the names `allowed`.

    It reads the names in the compiled code. It is there to say what is asked for, not to withstand someone who hides it.
    """
    more = (
        f"of it only {', '.join(f'`{each}`' for each in allowed)} may be used here."
        if allowed
        else ""
    )
    for name in _of_wmrlib(function, bool(allowed), set()):
        asked = more or "this task asks for your own formula, with `math` or `numpy`."
        expect(
            name.split(".")[-1] in allowed, f"`{_name(function)}` uses `{name}` of wmrlib; {asked}"
        )


def close(value: float, right: float, relative: float = 1e-6, absolute: float = 1e-9) -> bool:
    """Whether two numbers are equal up to rounding."""
    return math.isclose(value, right, rel_tol=relative, abs_tol=absolute)


def _of_wmrlib(function: Callable, parts: bool, seen: set) -> Iterator[str]:
    """The names by which it uses wmrlib: functions and classes; with `parts` those that it takes out of a module, else the module."""
    if not isinstance(function, types.FunctionType) or function in seen:
        return
    seen.add(function)
    modules: dict[str, types.ModuleType] = {}
    names = list(dict.fromkeys(_names(function.__code__)))
    for name in names:
        if (
            "." in name or name not in function.__globals__
        ):  # imported in the function, a builtin, or an attribute of something
            if name.split(".")[0] == "wmrlib":
                with contextlib.suppress(
                    ImportError
                ):  # then the function stops, which another hint says
                    modules[name] = importlib.import_module(name)
            continue
        value = function.__globals__[name]
        if isinstance(value, types.ModuleType):
            if _home(value) == "wmrlib":
                modules[name] = value
        elif _home(value) == "wmrlib":  # what wmrlib's own functions call is no matter
            yield getattr(value, "__name__", name)
        else:
            yield from _of_wmrlib(value, parts, seen)
    if not parts:
        yield from modules
        return
    looked_at: set = set()
    while modules:
        called, module = modules.popitem()
        looked_at.add(module)
        for name in names:
            value = None if name in function.__globals__ else getattr(module, name, None)
            if (
                isinstance(value, types.ModuleType)
                and _home(value) == "wmrlib"
                and value not in looked_at
            ):
                modules[f"{called}.{name}"] = value
            elif not isinstance(value, types.ModuleType) and _home(value) == "wmrlib":
                yield f"{called}.{name}"


def _names(code: types.CodeType) -> Iterator[str]:
    """The global names, attributes and imports of a function and of those inside it."""
    yield from code.co_names
    for each in code.co_consts:
        if isinstance(each, types.CodeType):
            yield from _names(each)


def _home(value: Any) -> str:
    """The package that a module, function or class is from; nothing for an object that is only data."""
    if isinstance(value, types.ModuleType):
        return value.__name__.split(".")[0]
    return str(getattr(value, "__module__", "")).split(".")[0] if callable(value) else ""


def _line(error: BaseException) -> str:
    """Where in the student's code it happened: the last line of a cell that the error passed."""
    place, trace = "", error.__traceback__
    while trace:
        if (
            "ipykernel" in trace.tb_frame.f_code.co_filename
            or "<ipython" in trace.tb_frame.f_code.co_filename
        ):
            place = f" in line {trace.tb_lineno} of its cell"
        trace = trace.tb_next
    return place


def _name(function: Callable) -> str:
    return getattr(function, "__name__", type(function).__name__)


def _shown(value: Any) -> str:
    try:
        text = f"{value:.6g}" if isinstance(value, float) else repr(value)
    except (
        Exception
    ):  # of what a student wrote, or of Python with an integer of more than 4300 digits
        text = f"something of the type {type(value).__name__}"
    return text if len(text) <= 60 else f"{text[:57]}..."
