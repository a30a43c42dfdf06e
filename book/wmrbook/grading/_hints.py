"""What a check says: why an answer does not pass, and whether it is the student's own."""

from __future__ import annotations

import inspect
import math
import sys
import types
from collections.abc import Callable, Sequence
from typing import Any, NoReturn

import numpy as np

_LIBRARIES = ("wmrlib", "wmrbook")


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


def drawn(seed: int, count: int, *bounds: tuple[float, float]) -> list[list[float]]:
    """Rows of numbers drawn evenly, each column between its two bounds."""
    low, high = zip(*bounds, strict=True)
    return np.random.default_rng(seed).uniform(low, high, (count, len(bounds))).tolist()


def angle_equal(one: float, other: float) -> bool:
    """Up to full turns."""
    return abs(math.remainder(one - other, 2.0 * math.pi)) < 1e-9


def same_pose(value: Sequence[float], right: Sequence[float], tolerance: float = 1e-9) -> bool:
    """Whether two poses are the same up to full turns; the place to 1e-7 m at least."""
    near = math.dist(value[:2], right[:2]) < max(tolerance, 1e-7)
    return near and abs(math.remainder(value[2] - right[2], 2.0 * math.pi)) < tolerance


def close(value: float, right: float, relative: float = 1e-6, absolute: float = 1e-9) -> bool:
    """Whether two numbers are equal up to rounding."""
    return math.isclose(value, right, rel_tol=relative, abs_tol=absolute)


def rule_out(value: Any, mistakes: dict[str, Any], equal: Callable[..., bool] = close) -> None:
    """Raise the Hint of the first usual mistake, {hint: its result}, that gives the value."""
    for hint, mistaken in mistakes.items():
        expect(not equal(value, mistaken), hint)


def explain(
    value: Any,
    mistakes: dict[str, Any],
    otherwise: str,
    equal: Callable[..., bool] = close,
    right: Any = None,
) -> NoReturn:
    """As `rule_out`, for a wrong value: if no usual mistake gives it, the hint is `otherwise`.

    With the `right` value, a mere `slip` is told before that.
    """
    rule_out(value, mistakes, equal)
    if right is not None:
        slip(value, right)
    raise Hint(otherwise)


def slip(value: Any, right: Any, order: str = "", within: float = 1e-3) -> None:
    """Raise Hint if only the last digits or the order of numbers is wrong: no formula is to blame.

    `order` names the numbers as they are asked for; of digits, a share `within` may be wrong.
    """
    given, expected = _flat(value), _flat(right)
    pairs = [*zip(given, expected, strict=True)]
    if all(close(*pair, 1e-9) for pair in pairs):
        return
    first = 2 - math.ceil(math.log10(max(map(abs, expected)) or 1.0))  # two digits at the least
    rounded = any(
        all(close(one, round(other, n), 1e-12, 0.0) for one, other in pairs)
        for n in range(first, 12)
    )
    expect(not rounded, "right, but rounded: return all digits, and round only what you print.")
    worst = max(abs(a - b) / (abs(b) or 1.0) for a, b in pairs)
    hint = f"right but for {100.0 * worst:.1g} %: is a number rounded on the way, such as pi?"
    expect(worst > within, hint)
    alike = not all(map(close, given, expected)) and all(
        map(close, sorted(given), sorted(expected))
    )
    changed = order and alike
    expect(not changed, f"the numbers have changed places: {order} is asked for.")


def _flat(values: Any) -> list[float]:
    """The numbers of a nest of them as Python's floats, which overflow without a warning."""
    if hasattr(values, "__iter__"):
        return [number for entry in values for number in _flat(entry)]
    return [float(values)]


def own_work(function: Callable, *allowed: str) -> None:
    """Raise Hint if the student's function uses a function of the libraries not in `allowed`.

    It reads the names in the function's code, and in that of the notebook's functions that are
    named there. Containers such as Pose and Gains are free. It says what is asked for; it does not
    withstand someone who hides a name.
    """
    asked = "this task asks for your own formula, with `math` or `numpy`."
    if allowed:
        asked = f"of it only {', '.join(f'`{name}`' for name in allowed)} may be used here."
    waiting, checked = [function], []
    while waiting:
        called = inspect.unwrap(waiting.pop(0))
        called = getattr(called, "pyfunc", getattr(called, "func", called))  # vectorize, partial
        library, name = _library(called), name_of(called)
        if library in _LIBRARIES:
            free = isinstance(called, type) or name in allowed
            expect(free, f"`{name_of(function)}` uses `{name}` of {library}; {asked}")
        elif isinstance(called, types.FunctionType) and called not in checked:
            checked.append(called)
            if called is checked[0] or called.__module__ == checked[0].__module__:
                waiting += _named(called)


def _named(function: types.FunctionType) -> list[Callable]:
    """Return the functions that the names in the function's code stand for."""
    codes = [function.__code__]
    for code in codes:  # and the functions and comprehensions inside it
        codes += [constant for constant in code.co_consts if isinstance(constant, types.CodeType)]
    names = [name for code in codes for name in code.co_names + code.co_freevars]
    known = function.__globals__ | inspect.getclosurevars(function).nonlocals
    values = [known.get(name, sys.modules.get(name)) for name in names]
    for value in values:  # of the libraries' modules, the attributes that are named
        if isinstance(value, types.ModuleType) and value.__name__.partition(".")[0] in _LIBRARIES:
            candidates = [getattr(value, name, None) for name in names]
            values += [it for it in candidates if not any(it is other for other in values)]
    return [value for value in values if callable(value)]


def _library(value: Any) -> str:
    return str(getattr(value, "__module__", "")).partition(".")[0]


def name_of(function: Callable) -> str:
    return getattr(function, "__name__", type(function).__name__)


def shown(value: Any) -> str:
    """Return the value as text of at most 60 characters."""
    text = f"{value:.6g}" if isinstance(value, float) else repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
