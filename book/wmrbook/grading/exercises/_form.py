"""What the checks of exercises share: they say their hints, and take what was rounded by hand."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import redirect_stdout
from functools import wraps
from io import StringIO
from typing import Any

from wmrbook.grading._hints import Hint, close, expect, named

_PRINTED = 2000  # characters; more would push the hint out of sight


def exercise(check: Callable[..., str]) -> Callable[..., str]:
    """Return the check that returns its hints, whatever an answer does."""

    @wraps(check)
    def told(*answers: Any) -> str:
        try:
            with redirect_stdout(StringIO()) as printed:
                said = check(*answers)
        except Hint as hint:
            said = f"Hint: {hint}"
        except BaseException as error:  # of a value of a student's own class
            said = f"Hint: the check stops with {named(error)}."
        if text := printed.getvalue().rstrip():
            print(text if len(text) <= _PRINTED else f"{text[:_PRINTED]}...")
        return said

    return told


def expect_below(value: float, limit: float, hint: str) -> None:
    """Raise Hint unless it is at most the limit, up to the fifth digit: steps may be one's own."""
    expect(value <= 1.00003 * limit, f"{hint}: a limit is rounded down.")


def about(value: float, right: float) -> bool:
    return close(value, right, 0.02)


def near(value: Sequence[float], right: Sequence[float]) -> bool:
    return all(map(about, value, right))
