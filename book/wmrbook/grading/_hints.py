"""What a check says, and how it asks for an answer: whatever comes, a student reads a hint."""

from __future__ import annotations

import ast
import inspect
import math
import textwrap
import types
from collections.abc import Callable, Iterator, Mapping, Set
from contextlib import suppress
from typing import Any, NoReturn

import numpy as np

from wmrlib.gains import Gains

_LIBRARIES = ("wmrlib", "wmrbook")
_MOST = 1000.0  # of a gain: what is far beyond any use would take minutes to simulate


class Hint(AssertionError):  # noqa: N818  (its name is what a student reads)
    """Why an answer does not pass.

    Jupyter shows the sentence alone: a traceback would show the check, and with it the answer.
    """

    def _render_traceback_(self) -> list[str]:
        return [f"Hint: {self}"]


def expect(holds: bool, hint: str) -> None:
    """Raise Hint with this sentence unless the condition holds."""
    if not holds:
        raise Hint(hint)


def spread(low: float, high: float, count: int, seed: int = 0) -> list[float]:
    """Numbers drawn log-uniformly, the largest first: a threshold of one's own meets some of them.

    The first is large, so that a plain mistake shows before lost digits do.
    """
    bounds = np.log([low, high])
    return sorted(np.exp(np.random.default_rng(seed).uniform(*bounds, count)).tolist())[::-1]


def angle_equal(one: float, other: float) -> bool:
    """Up to full turns."""
    return abs(math.remainder(one - other, 2.0 * math.pi)) < 1e-9


def close(value: float, right: float, relative: float = 1e-6, absolute: float = 1e-9) -> bool:
    """Whether two numbers are equal up to rounding."""
    return math.isclose(value, right, rel_tol=relative, abs_tol=absolute)


def rule_out(value: Any, mistakes: dict[str, Any], equal: Callable[..., bool] = close) -> None:
    """Raise the Hint of the first usual mistake, {hint: its result}, that gives the value."""
    for hint, mistaken in mistakes.items():
        expect(not equal(value, mistaken), hint)


def explain(
    value: Any, mistakes: dict[str, Any], otherwise: str, equal: Callable[..., bool] = close
) -> NoReturn:
    """As `rule_out`, for a wrong value: if no usual mistake gives it, the hint is `otherwise`."""
    rule_out(value, mistakes, equal)
    raise Hint(otherwise)


def ask(function: Callable, *arguments: Any) -> Any:
    """Return what the student's function returns; if it fails, raise a Hint that says how."""
    if not callable(function):
        raise Hint(f"a function is needed here, not {shown(function)}.")
    try:
        return function(*arguments)
    except Exception as error:
        if type(error) is NotImplementedError:  # as handed out; `input()` raises a child of it
            raise Hint(f"`{_name(function)}` is not written yet.") from None
        call = f"`{_name(function)}({', '.join(map(shown, arguments))})`"
        what = f"{type(error).__name__}: {error}"
        raise Hint(f"{call} stops{_line(error)} with {what}.") from None


def ask_number(function: Callable, *arguments: Any) -> float:
    """As `ask`, for a function that is to return one finite number."""
    return number(f"`{_name(function)}`", ask(function, *arguments), returned=True)


def ask_numbers(function: Callable, count: int, *arguments: Any) -> tuple[float, ...]:
    """As `ask`, for a function that is to return `count` finite numbers."""
    answer, name = ask(function, *arguments), f"`{_name(function)}`"
    needed = f"{count} numbers, separated by commas, are needed."
    expect(ordered(answer, count), f"{name} returns {shown(answer)}; {needed}")
    return tuple(number(name, each, returned=True) for each in answer)


def ask_truth(function: Callable, *arguments: Any) -> bool:
    """As `ask`, for a function that is to return True or False."""
    answer, name = ask(function, *arguments), _name(function)
    expect(answer is not None, f"`{name}` returns nothing: does it end in `return`?")
    truth = isinstance(answer, (bool, np.bool_))
    expect(truth, f"`{name}` returns {shown(answer)}; True or False is needed.")
    return bool(answer)


def ask_array(function: Callable, shape: tuple[int, ...], *arguments: Any) -> np.ndarray:
    """As `ask`, for a function that is to return finite numbers in this shape."""
    name, answer = _name(function), ask(function, *arguments)
    expect(answer is not None, f"`{name}` returns nothing: does it end in `return`?")
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
        function(*arguments)
    except ValueError:
        return
    except Exception:
        ask(function, *arguments)  # which says what happened
    call = f"`{_name(function)}({', '.join(map(shown, arguments))})`"
    raise Hint(f"{call} must raise ValueError: {hint}")


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
    if value is None or value is ...:
        nothing = f"{name} returns nothing: does it end in `return`?"
        raise Hint(nothing if returned else f"{name} has no value yet.")
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


def numbers(name: str, value: Any, count: int) -> tuple[float, ...]:
    """Return the value as `count` finite floats, or raise Hint."""
    expect_value(name, value)
    row = isinstance(value, (tuple, list, np.ndarray)) and np.ndim(value) == 1
    needed = f"{count} numbers, separated by commas, are needed."
    expect(row and len(value) == count, f"{name} is {shown(value)}; {needed}")
    return tuple(number(name, each) for each in value)


def floats(value: Any) -> np.ndarray | None:
    """Return the real numbers of a list, matrix or array; None if anything else is in it."""
    try:
        given = np.asarray(value)
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


def own_work(function: Callable, *allowed: str) -> None:
    """Raise Hint if the student's function names a function of the libraries not in `allowed`.

    It reads the source, and that of the notebook's functions that are named there. Containers
    such as Pose and Gains are free. It says what is asked for; it does not withstand someone who
    hides a name.
    """
    asked = "this task asks for your own formula, with `math` or `numpy`."
    if allowed:
        asked = f"of it only {', '.join(f'`{each}`' for each in allowed)} may be used here."
    waiting, seen, home = [function], [], None
    while waiting:
        called = inspect.unwrap(waiting.pop(0))
        called = getattr(called, "pyfunc", getattr(called, "func", called))  # vectorize, partial
        library, name = str(getattr(called, "__module__", "")).partition(".")[0], _name(called)
        if library in _LIBRARIES:
            free = isinstance(called, type) or name in allowed
            expect(free, f"`{_name(function)}` uses `{name}` of {library}; {asked}")
        elif isinstance(called, types.FunctionType) and called not in seen:
            seen.append(called)
            home = home or called.__module__
            if called.__module__ == home or called is function:
                waiting += [each for each in _named(called) if callable(each)]


def _named(function: types.FunctionType) -> Iterator[Any]:
    """What the names, attributes and imports in the function's source stand for."""
    try:
        tree = ast.parse(textwrap.dedent(inspect.getsource(function)))
    except (OSError, SyntaxError):
        return  # without its source, a function passes
    own = dict.fromkeys(function.__code__.co_varnames)
    names = function.__globals__ | own | inspect.getclosurevars(function).nonlocals

    def value(node: ast.AST) -> Any:
        if isinstance(node, ast.Attribute):
            return getattr(value(node.value), node.attr, None)
        return names.get(node.id) if isinstance(node, ast.Name) else None

    for node in ast.walk(tree):
        if isinstance(node, (ast.Import, ast.ImportFrom)):
            with suppress(ImportError):  # the function stops there, and another hint says so
                exec(compile(ast.Module([node], []), "<import>", "exec"), names)
    for node in ast.walk(tree):
        yield value(node)


def _line(error: BaseException) -> str:
    """Return where in the student's code it happened: the last line of a cell that it passed."""
    place, trace = "", error.__traceback__
    while trace:
        file = trace.tb_frame.f_code.co_filename
        if "ipykernel" in file or "<ipython" in file:
            place = f" in line {trace.tb_lineno} of its cell"
        trace = trace.tb_next
    return place


def _name(function: Callable) -> str:
    return getattr(function, "__name__", type(function).__name__)


def shown(value: Any) -> str:
    """Return the value as text of at most 60 characters."""
    try:
        text = f"{value:.6g}" if isinstance(value, float) else repr(value)
    except Exception:  # of a student's class, or of an integer with more than 4300 digits
        text = f"something of the type {type(value).__name__}"
    return text if len(text) <= 60 else f"{text[:57]}..."
