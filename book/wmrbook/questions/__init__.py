"""Twenty-six concept questions on chapters 0 to 12, 14 and 15, to ask a class.

`book/tools/slides.py --questions` makes a deck of them. Every key is computed by wmrlib when a
question is made, and so is every number among the wrong options, from the mistake behind it. A
question whose texts explain another answer than the computed one is refused. To add one, write a
function under `@question` in its chapters' module, and name a sign behind it in tests/flipped.py.
"""

from __future__ import annotations

from wmrbook.questions import field, ground, laws, practice
from wmrbook.questions._asking import LETTERS, MAKERS, Option, Question, Refusal

__all__ = ["LETTERS", "MAKERS", "Option", "Question", "Refusal", "made"]
_CHAPTERS = ground, laws, practice, field  # which fill MAKERS


def made() -> tuple[Question, ...]:
    """Return all questions, made now; raises Refusal for one that can't be asked."""
    return tuple(sorted((make() for make in MAKERS.values()), key=lambda it: it.chapter))
