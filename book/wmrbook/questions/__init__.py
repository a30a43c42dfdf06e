"""Twenty-six concept questions on chapters 0 to 12 and 14, for votes in class and as a test.

One source makes three things: slides to vote by (`book/tools/slides.py --questions`), a form that
works from the disk on a telephone (`python -m wmrbook.questions form`), and, of the lines that come
back, histograms and the gain from a test before to one after. The test asks those that a student
can think about before the course; the others are for votes. Every key is computed by wmrlib when
a question is made, and so is every number among the wrong options, from the mistake behind it. A
question whose texts explain another answer than the computed one is refused. To add one, write a
function under `@question` in its chapters' module, and name a sign behind it in tests/flipped.py.
"""

from __future__ import annotations

import hashlib

from wmrbook.questions import field, ground, laws, practice
from wmrbook.questions._asking import LETTERS, MAKERS, Option, Question, Refusal

__all__ = [
    "LETTERS",
    "MAKERS",
    "Option",
    "Question",
    "Refusal",
    "fingerprint",
    "made",
    "of_chapter",
    "tested",
]
_CHAPTERS = ground, laws, practice, field  # which fill MAKERS


def made() -> tuple[Question, ...]:
    """Return all questions, made now; raises Refusal for one that can't be asked."""
    return tuple(sorted((make() for make in MAKERS.values()), key=lambda it: it.chapter))


def tested() -> tuple[Question, ...]:
    """Return the questions of the test before and after, made now, in the order of its sheet."""
    return tuple(it for it in made() if not it.untested)


def of_chapter(chapter: int) -> list[str]:
    """Return the number and the title of each slide to vote by that belongs to a chapter."""
    numbered = enumerate(made(), start=1)
    return [f"{number}. {it.title}" for number, it in numbered if it.chapter == chapter]


def fingerprint(questions: tuple[Question, ...]) -> str:
    """Return four digits that change with any text or order, so that a letter keeps its meaning."""
    texts = [(one.ask, *(option.text for option in one.options)) for one in questions]
    return hashlib.sha256(repr(texts).encode()).hexdigest()[:4]
