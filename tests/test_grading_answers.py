"""The assignments: the model answers pass every graded cell, the empty release none, each usual mistake loses its own, with its hint."""

import pytest
from graded import ASSIGNMENTS, BEGIN, assert_loses, assert_model_and_release, cells, wrong_answers

MISTAKES = [
    pytest.param(chapter, each, id=f"{chapter}: {each['name']}")
    for chapter in ASSIGNMENTS
    for each in wrong_answers(chapter)
]


@pytest.mark.parametrize("chapter", ASSIGNMENTS)
def test_the_model_passes_and_the_empty_release_does_not(chapter):
    assert_model_and_release(chapter)


@pytest.mark.parametrize("chapter", ASSIGNMENTS)
def test_every_answer_has_usual_mistakes(chapter):
    answers = [name for name, source, _ in cells(chapter) if BEGIN in source]
    made = [each["cell"] for each in wrong_answers(chapter)]
    assert 2 <= len(answers) <= 4
    assert set(made) == set(answers)
    assert all(made.count(name) >= 2 for name in answers), {
        name: made.count(name) for name in answers
    }


@pytest.mark.parametrize(("chapter", "wrong"), MISTAKES)
def test_a_usual_mistake_loses_its_points_with_its_hint(chapter, wrong):
    assert_loses(chapter, wrong)
