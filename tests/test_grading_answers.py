"""The assignments: the model answers pass every graded cell, the empty release none, each usual mistake loses its own, with its hint."""

import pytest
from coursework import CHAPTERS, cells, marked, released, wrong_answers

MISTAKES = [pytest.param(chapter, each, id=f"{chapter}: {each['name']}") for chapter in CHAPTERS for each in wrong_answers(chapter)]


@pytest.mark.parametrize("chapter", CHAPTERS)
def test_model_answers_pass(chapter):
    passed, failed = marked(chapter)
    assert failed == {}
    assert all(sentence.endswith(".") and sentence[0] != "'" for sentence in passed.values())


@pytest.mark.parametrize("chapter", CHAPTERS)
def test_empty_release_fails(chapter):
    passed, failed = marked(chapter, lambda _, source: released(source))
    assert passed == {}
    assert all("not written yet" in hint or "no value yet" in hint for hint in failed.values()), failed


@pytest.mark.parametrize("chapter", CHAPTERS)
def test_every_answer_has_mistakes(chapter):
    answers = [name for name, source, _ in cells(chapter) if "### BEGIN SOLUTION" in source]
    made = [each["cell"] for each in wrong_answers(chapter)]
    assert all(made.count(name) >= 2 for name in answers), {name: made.count(name) for name in answers}


@pytest.mark.parametrize(("chapter", "wrong"), MISTAKES)
def test_wrong_answer_loses_its_points(chapter, wrong):
    _, failed = marked(chapter, lambda name, source: wrong["source"] if name == wrong["cell"] else source)
    assert list(failed) == wrong["loses"]
    assert any(wrong["hint"] in hint for hint in failed.values()), failed
