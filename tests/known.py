"""The mistakes that a check looks for, read as it looks, and answers that make one of them each.

A check compares a wrong answer with a table, {hint: result of a mistake}, where the mistake stands
alone. An answer that is wrong in another way shows the table; one that is right but for a result
of it, in one case, has to get the hint.
"""

import re
from collections.abc import Callable, Iterator
from itertools import product
from typing import Any

import numpy as np
import sympy as sp

from wmrbook import grading
from wmrbook.grading import _earth, _hints
from wmrbook.grading._hints import rule_out

PARTS = slice(None), 0, 1, 2  # of an answer: all of its numbers, or one
CASES = range(6)
_VARIES = r"'[^']*'|[-+.0-9]+"  # in a hint, from case to case


class Changed:
    """An answer like the model's, with its numbers changed in one of the cases it is asked for."""

    def __init__(self, model: Any, case: int, part: Any, to: Any = None) -> None:
        self.part, self.to, self.numbers = part, to, np.array([])
        asked = list[str]()

        def answer(*given: Any) -> Any:
            if repr(given) not in asked:
                asked.append(repr(given))
            result = model(*given)
            return self.changed(result) if asked.index(repr(given)) == case else result

        self.answer = answer if callable(model) else self.changed(model)

    def changed(self, result: Any) -> Any:
        array = np.array(result, None if isinstance(result, sp.Expr) else float)
        self.numbers = array.reshape(-1)
        self.numbers[self.part] = 1.37 * self.numbers[self.part] + 1 if self.to is None else self.to
        return array if array.ndim else array.item()

    def place(self, value: Any) -> slice | None:
        """Where in the answer this value stands."""
        wanted, size = np.ravel(value), np.size(value)
        starts = range(self.numbers.size - size + 1)
        alike = (i for i in starts if np.array_equal(self.numbers[i : i + size], wanted))
        return next((slice(i, i + size) for i in alike), None)


def untold(monkeypatch, checks: list[Callable[[Any], str]], model: Any) -> tuple[int, set[str]]:
    """How many mistakes these checks look for, and the hints that who makes one never reads."""
    told = dict[str, bool]()
    for check in checks:
        for hint, wrong in _mistaken(monkeypatch, check, model):
            said, wanted = (re.sub(_VARIES, "0", text) for text in (check(wrong), f"Hint: {hint}"))
            told[wanted] = told.get(wanted, False) or said == wanted
    return len(told), {hint for hint, is_told in told.items() if not is_told}


def _mistaken(monkeypatch, check: Callable, model: Any) -> Iterator[tuple[str, Any]]:
    """The hint of each mistake that the check looks for, and an answer that makes it."""
    tables = list[tuple[Any, dict]]()

    def noted(value: Any, mistakes: dict, *equal: Callable) -> None:
        tables.append((value, mistakes))
        rule_out(value, mistakes, *equal)

    for module in (_hints, _earth, *(getattr(grading, name) for name in dir(grading))):
        if hasattr(module, "rule_out"):
            monkeypatch.setattr(module, "rule_out", noted)
    for case, part in product(CASES, PARTS):
        tables.clear()
        try:
            wrong = Changed(model, case, part)
            check(wrong.answer)
        except (IndexError, TypeError, ValueError):  # fewer numbers, or none
            continue
        for value, mistakes in tables[:]:
            place = wrong.place(value)
            for hint, result in mistakes.items():
                if place and np.size(result) == np.size(value):
                    yield hint, Changed(model, case, place, np.ravel(result)).answer
