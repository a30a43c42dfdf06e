"""How a check asks for an answer: whatever a student's function does, there is a hint."""

from __future__ import annotations

import builtins
import math
import sys
from collections.abc import Callable, Iterator, Mapping, Set
from contextlib import contextmanager, suppress
from typing import Any

import numpy as np

from wmrbook.grading._hints import Hint, expect, name_of, named, shown
from wmrlib.gains import Gains

_MOST = 1000.0  # of a gain: what is far beyond any use would take minutes to simulate


class Failed(Exception):  # noqa: N818  (it is an answer's fault, not the check's)
    """How a student's function stopped: what is told of it; if it refused, or is as handed out."""

    def __init__(self, told: str, refused: bool = False, unwritten: bool = False) -> None:
        self.told, self.refused, self.unwritten = told, refused, unwritten


def called(function: Callable, *arguments: Any) -> Any:
    """Return what the student's function returns; raise Failed if it stops, whatever it does."""
    try:
        with _alone():
            return function(*arguments)
    except Failed:  # in another process, which told it
        raise
    except BaseException as error:  # of `exit()`, and of a reader who stops it, too
        unwritten = type(error) is NotImplementedError  # `input()` raises a child of it
        told = f"{_line(error)} with {named(error)}"
        raise Failed(told, isinstance(error, ValueError), unwritten) from None


def ask(function: Callable, *arguments: Any) -> Any:
    """Return what the student's function returns; if it fails, raise a Hint that says how."""
    if not callable(function):
        raise Hint(f"a function is needed here, not {shown(function)}.")
    try:
        answer = called(function, *arguments)
    except Failed as failed:
        if failed.unwritten:
            raise Hint(f"`{name_of(function)}` is not written yet.") from None
        call = f"`{name_of(function)}({', '.join(map(shown, arguments))})`"
        raise Hint(f"{call} stops{failed.told}.") from None
    expect(answer is not None, f"`{name_of(function)}` returns nothing: does it end in `return`?")
    return answer


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


def refuses(function: Callable, hint: str, *arguments: Any) -> None:
    """Raise Hint unless the student's function raises ValueError for these arguments."""
    try:
        called(function, *arguments)
    except Failed as failed:
        if failed.refused:
            return
        ask(function, *arguments)  # which says what happened
    call = f"`{name_of(function)}({', '.join(map(shown, arguments))})`"
    raise Hint(f"{call} must raise ValueError: {hint}")


@contextmanager
def _alone() -> Iterator[None]:
    """Let an answer end by `exit()`, which in a notebook ends the kernel, and by `input()`."""

    def leave(*_: Any, **__: Any) -> None:
        raise SystemExit

    def refuse(*_: Any, **__: Any) -> None:
        raise EOFError("nobody answers `input()` in a check")

    shell = sys.modules["IPython"].get_ipython() if "IPython" in sys.modules else None
    asks, builtins.input = builtins.input, refuse
    if shell:
        shell.ask_exit = leave
    try:
        yield
    finally:
        builtins.input = asks
        if shell:
            del shell.ask_exit


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
    single = isinstance(value, (np.generic, np.ndarray)) and value.size == 1
    plain = value.item() if single else value
    if not isinstance(plain, (bool, str, bytes, np.ndarray)):
        with suppress(TypeError, ValueError):
            try:
                converted = float(plain)
            except OverflowError:
                raise Hint(f"{name} {verb} a number that is far too large.") from None
            finite = math.isfinite(converted)
            expect(finite, f"{name} {verb} {converted}, which is not a finite number.")
            return converted
    raise Hint(f"{name} {verb} {shown(value)}; one number is needed.")


def numbers(name: str, value: Any, count: int, *, returned: bool = False) -> tuple[float, ...]:
    """Return the value as `count` finite floats, or raise Hint."""
    if not returned:
        expect_value(name, value)
    given = f"{name} {'returns' if returned else 'is'} {shown(value)}"
    expect(ordered(value, count), f"{given}; {count} numbers, separated by commas, are needed.")
    return tuple(number(name, each, returned=returned) for each in value)


def floats(value: Any) -> np.ndarray | None:
    """Return the real numbers of a list, matrix or array; None if anything else is in it."""
    try:
        given = np.asarray(value.tolist() if hasattr(value, "tolist") else value)
        if (
            given.ndim == 2
            and 1 in given.shape
            and not isinstance(value, np.ndarray | list | tuple)
        ):
            given = given.ravel()  # a column of sympy's or mpmath's
        return given.astype(float) if given.dtype.kind in "iufO" else None
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
    for field, each in zip(Gains._fields, gains, strict=True):
        hint = f"{name}: {field} = {each:g} is more than {_MOST:g}, which no robot can follow."
        expect(each <= _MOST, hint)
    return gains


def _line(error: BaseException) -> str:
    """Return where in the student's code it happened: the last line of a cell that it passed."""
    place, trace = "", error.__traceback__
    while trace:
        file = trace.tb_frame.f_code.co_filename
        if "ipykernel_" in file or "<ipython" in file:
            place = f" in line {trace.tb_lineno} of its cell"
        trace = trace.tb_next
    return place
