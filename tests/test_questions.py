"""The concept questions: computed keys, the lines that come back, histograms and the gain."""

import math
import re
from pathlib import Path

import numpy as np
import package
import pytest
import slides

import wmrlib as wmr
from wmrbook import lines, questions
from wmrbook.lines import Line
from wmrbook.questions import __main__ as command
from wmrbook.questions import form
from wmrbook.questions._asking import Refusal, cases, numbers
from wmrbook.questions._formulas import as_html
from wmrbook.questions.classes import read_class
from wmrbook.questions.gain import gain, normalised
from wmrbook.questions.picture import bars

CHAPTERS = sorted((Path(__file__).parent.parent / "notebooks").glob("[0-9][0-9]_*.ipynb"))
QUESTIONS = questions.made()
MARK = questions.fingerprint(QUESTIONS)


def minus(*places):
    """A result with the signs of these parts flipped."""

    def flipped(parts):
        new = [-part if at in places else part for at, part in enumerate(parts)]
        return type(parts)(*new) if hasattr(parts, "_fields") else tuple(new)

    return flipped


def of_run(change):
    return lambda run: type(run)(**{**{k: getattr(run, k) for k in run.__slots__}, **change(run)})


# Each question with the function of wmrlib behind it, and what a sign flipped there makes of its
# result.
TURNED = {
    "arrived-parked": ("polar_rate", None),
}


@pytest.mark.parametrize("question", QUESTIONS, ids=lambda it: it.id)
def test_a_question_is_short_has_one_right_option_and_a_section_that_answers_it(question):
    chapter = CHAPTERS[question.chapter].read_text(encoding="utf-8")
    assert re.search(rf'"#+ {re.escape(question.section)}(\\n)?"', chapter), question.section
    assert len(question.ask.split()) <= 40
    assert len({option.text for option in question.options}) == 5
    assert [option.mistake for option in question.options].count("") == 1
    for option in question.options:
        assert len(option.text.split()) <= 12
        as_html(option.text)
    assert question.options["ABCDE".index(question.key)].mistake == ""
