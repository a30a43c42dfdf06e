"""The book's headline numbers, and what each is varied over.

A headline is a sentence of the book with a number or a strong word in it: never, at most, every,
first. Its function computes that number anew, and its ranges say what a reader may vary: radius,
distance, direction, seed, L, dt, x_axis, noise. A condition that is not varied stands in the
sentence. `book/tools/vary.py` draws from the ranges and says whether the sentence survives.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np

Range = tuple[float, float] | Sequence  # an interval, or a list of choices
ROUND = (-math.pi, math.pi)  # any direction
SEEDS = range(10**6)


@dataclass(frozen=True)
class Before:
    """A sentence that fell: what it said, and the ranges and limits that it claimed."""

    says: str
    vary: dict[str, Range]
    at_least: float = -math.inf
    at_most: float = math.inf


@dataclass(frozen=True)
class Headline:
    """A sentence, the function behind its number, what is varied and what the sentence allows."""

    where: str  # a chapter's two digits, or a file such as README.md
    says: str  # as it stands there; markup, case of spaces and line breaks aside
    value: Callable[..., float]
    vary: dict[str, Range]
    at_least: float
    at_most: float
    unit: str
    before: Before | None


HEADLINES: list[Headline] = []


def headline(
    where: str,
    says: str,
    *,
    at_least: float | None = None,
    at_most: float | None = None,
    unit: str = "",
    before: Before | None = None,
    **vary: Range,
) -> Callable[[Callable[..., float]], Callable[..., float]]:
    """Enter a function of the varied quantities; without limits it returns whether it holds."""
    if not vary:
        raise ValueError(f"{says!r}: nothing is varied")
    if at_least is None and at_most is None:
        at_least = 1.0
    low = -math.inf if at_least is None else at_least
    high = math.inf if at_most is None else at_most

    def enter(value: Callable[..., float]) -> Callable[..., float]:
        HEADLINES.append(Headline(where, says, value, vary, low, high, unit, before))
        return value

    return enter


def drawn(
    value: Callable[..., float], vary: dict[str, Range], draws: int, seed: int = 0
) -> Iterator[tuple[dict[str, Any], float]]:
    """Yield draws from the ranges, both ends of the intervals first, and the value at each."""
    random = np.random.default_rng(seed)
    for turn in range(draws):
        draw, place = {}, turn
        for name, kind in vary.items():
            if isinstance(kind, tuple):
                draw[name] = _within(kind, turn, random)
            elif len(kind) > 99:
                draw[name] = kind[int(random.integers(len(kind)))]
            else:  # choices are gone through in order, each with each of the others
                place, index = divmod(place, len(kind))
                draw[name] = kind[index]
        yield draw, float(value(**draw))


def _within(interval: tuple[float, float], turn: int, random: np.random.Generator) -> float:
    low, high = interval
    if turn < 2:
        return interval[turn]
    if low > 0 and high / low >= 4:  # as many draws near one end as near the other
        return math.exp(random.uniform(math.log(low), math.log(high)))
    return random.uniform(low, high)


for _chapters in ("body", "field", "ground", "laws", "other_laws", "practice", "sampled"):
    import_module(f"{__name__}.{_chapters}")  # which fills HEADLINES
