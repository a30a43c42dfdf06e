"""The concept questions: computed keys, and the slides that ask them."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from wmrbook import questions
from wmrbook.figures import scenes
from wmrbook.questions import deck

TESTS = Path(__file__).parent
CHAPTERS = sorted((TESTS.parent / "notebooks").glob("[0-9][0-9]_*.ipynb"))


@pytest.fixture(scope="module")
def made() -> list:
    return questions.made()


def test_a_question_has_one_right_option_and_a_section_that_answers_it(made):
    for question in made:
        chapter = CHAPTERS[question.chapter].read_text(encoding="utf-8")
        section = re.escape(json.dumps(question.section, ensure_ascii=False)[1:-1])
        assert re.search(rf'"#+ {section}(\\n)?"', chapter), question.section
        assert len({option.text for option in question.options}) == 5
        right = [option for option in question.options if not option.mistake]
        assert right == [question.options["ABCDE".index(question.key)]]


def test_a_flipped_sign_in_the_formula_behind_it_changes_a_key_or_stops_the_question(made):
    plain = os.environ | {"NUMBA_DISABLE_JIT": "1"}
    command = [sys.executable, "-W", "ignore", TESTS / "flipped.py"]
    answers = json.loads(subprocess.run(command, env=plain, capture_output=True, check=True).stdout)
    right = {it.id: it.options["ABCDE".index(it.key)].text for it in made}
    assert answers.keys() == right.keys()
    assert [name for name in right if answers[name] == right[name]] == []


def test_a_slide_asks_and_its_notes_have_the_key_the_reason_and_each_mistake(made):
    asked = list(deck.slides(made))[3:]
    assert len(asked) == len(made)
    for question, (title, words, _, notes) in zip(made, asked, strict=True):
        assert title.endswith(question.title)
        assert [words.count(f"<li>{it.text}</li>") for it in question.options] == [1] * 5
        assert question.why not in words
        right = question.options["ABCDE".index(question.key)]
        assert notes.startswith(f"**{question.key}: {right.text}.** {question.why}")
        mistakes = [
            f"\n- {letter}: {it.mistake}\n"
            for letter, it in zip("ABCDE", question.options, strict=True)
        ]
        assert [it in notes for it in mistakes] == [bool(it.mistake) for it in question.options]


def test_a_picture_has_no_number_that_its_question_has_not(made):
    asked = {it.id: it.ask for it in made}
    assert asked.keys() >= scenes.SCENES.keys()
    for name in scenes.SCENES:
        numbers = re.findall(r"\d+(?:\.\d+)?", scenes.scene_of(name).alt)
        assert set(numbers) <= set(re.findall(r"\d+(?:\.\d+)?", asked[name])), name
