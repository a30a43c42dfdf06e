"""What a concept question is, and how one is made: keys are computed, and bad questions refused."""

from __future__ import annotations

import hashlib
import itertools
from collections.abc import Callable, Hashable
from typing import NamedTuple

LETTERS = "ABCDE"
_APART = 0.04  # of the larger of two numbers: closer ones nobody tells apart


class Option(NamedTuple):
    """An option's text, and the mistake that leads to it; "" for the right one."""

    text: str
    mistake: str


class Question(NamedTuple):
    """A question as it is put to a class.

    id: its name; chapter, section: where the book answers it; title, ask: texts
    with formulas in $; why: the reason for the right option; options: five, in their order.
    """

    id: str
    chapter: int
    section: str
    title: str
    ask: str
    why: str
    options: tuple[Option, ...]

    @property
    def key(self) -> str:
        """The letter of the right option."""
        return next(letter for letter, it in zip(LETTERS, self.options, strict=True) if not it[1])


class Refusal(ValueError):  # noqa: N818  (it is no fault of the program)
    """A question can't be asked: two of its options agree, or its texts explain another answer."""


MAKERS: dict[str, Callable[[], Question]] = {}
"""From a question's id to the function that makes it."""


def question(chapter: int, section: str, title: str) -> Callable:
    """Enter a function that returns (ask, options, why) as the question of its name.

    How the texts are broken into lines does not count.
    """

    def enter(make: Callable[[], tuple[str, list[Option], str]]) -> Callable[[], Question]:
        name = make.__name__.replace("_", "-")

        def made() -> Question:
            ask, options, why = make()
            ask, why = (" ".join(text.split()) for text in (ask, why))
            texts = [option.text for option in options]
            if len(set(texts)) < len(LETTERS):
                raise Refusal(f"{name}: five different options are needed, not {texts}")
            if [option.mistake for option in options].count("") != 1:
                raise Refusal(f"{name}: one option must be right, and no more: {options}")
            return Question(name, chapter, section, title, ask, why, tuple(options))

        MAKERS[name] = made
        return made

    return enter


def numbers(right: float, mistaken: dict[str, float], form: str) -> list[Option]:
    """Options from the right number and from what each mistake gives, in order of size.

    form: of a number as text, such as "{:.1f} m". Raises Refusal if two are nearly equal.
    """
    values = {"": right, **mistaken}
    ordered = sorted(values, key=values.get)
    for low, high in itertools.pairwise(ordered):
        gap = values[high] - values[low]
        if not gap > _APART * max(abs(values[low]), abs(values[high])):
            pair = (
                f"{values[low]:.4g} ({low or 'right'}) and {values[high]:.4g} ({high or 'right'})"
            )
            raise Refusal(f"two options are nearly equal: {pair}")
    return [Option(form.format(values[mistake] + 0.0), mistake) for mistake in ordered]


def cases(computed: Hashable, options: dict[Hashable, tuple[str, str]]) -> list[Option]:
    """Options from texts: what was computed names the right one.

    options: from each outcome to (text, mistake). The one without a mistake is the one that the
    texts explain; if another was computed they are wrong, and the question is refused.
    """
    (explained,) = (outcome for outcome, (_, mistake) in options.items() if not mistake)
    if computed != explained:
        raise Refusal(f"the texts explain {explained!r}, and {computed!r} was computed")
    mixed = sorted(options.values(), key=lambda it: hashlib.sha256(it[0].encode()).digest())
    return [Option(*option) for option in mixed]


def sign(value: float, least: float) -> int:
    """-1, 0 or 1; 0 for a size below `least`."""
    return 0 if abs(value) < least else 1 if value > 0.0 else -1
