"""What the checks of exercises share: they say their hints, and take what was rounded by hand."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import wraps
from typing import Any

from wmrbook.grading._hints import Hint, close, expect


def exercise(check: Callable[..., str]) -> Callable[..., str]:
    """Return the check that returns its hints, so that a chapter runs on."""

    @wraps(check)
    def checked(*answers: Any) -> str:
        try:
            return check(*answers)
        except Hint as hint:
            return f"Hint: {hint}"

    return checked


def expect_below(value: float, limit: float, hint: str) -> None:
    """Raise Hint unless it is at most the limit, up to the fifth digit: steps may be one's own."""
    expect(value <= 1.00003 * limit, f"{hint}: a limit is rounded down.")


def about(value: float, right: float) -> bool:
    return close(value, right, 0.02)


def near(value: Sequence[float], right: Sequence[float]) -> bool:
    return all(map(about, value, right))
