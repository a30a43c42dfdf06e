"""The checks of assignments and exercises: a right answer passes, a wrong one gets its hint.

tests/data/course has a file for each assignment, with answers for a task or one of its checks:
- `right`: other right answers than the model's;
- `wrong`: wrong ones, {part of the hint: answer or answers}.
An answer is one or several edits of the model, `old => new || old => new`, or a whole cell, or
what is put at the {} of the task's `frame`, by default "NAME = {}". `setup` is put before it.
tests/data/exercises.toml has the same for the exercises at the chapters' ends.
"""

import inspect
import math
import re
import tomllib
from functools import cache

import numpy as np
import pytest
import sympy as sp
from assignments import ASSIGNMENTS, ROOT, Task, failed, released, run_cell, tasks

from wmrbook import grading
from wmrbook.grading import Hint

for_assignments = pytest.mark.parametrize("chapter", ASSIGNMENTS)
CHAPTERS = "".join(it.read_text(encoding="utf-8") for it in ROOT.glob("notebooks/*.ipynb"))
EXERCISES = tomllib.loads((ROOT / "tests/data/exercises.toml").read_text(encoding="utf-8"))


@cache
def answers(chapter: str) -> dict:
    return tomllib.loads((ROOT / f"tests/data/course/{chapter}.toml").read_text(encoding="utf-8"))


def edited(source: str, edits: str) -> str:
    """The source after one or several edits, `old => new || old => new`."""
    for edit in edits.split(" || "):
        old, new = edit.split(" => ")
        assert old in source, edit
        source = source.replace(old, new)
    return source


def task_of(chapter: str, key: str) -> Task:
    """The task of this name, or the one with these checks alone: `key`, or `key-...`."""
    for task in tasks(chapter):
        checks = {
            it: source for it, source in task.checks.items() if f"{it}-".startswith(f"{key}-")
        }
        if checks or task.name == key:
            return task._replace(checks=checks or task.checks)
    raise LookupError(key)


def errors(chapter: str, key: str, answer: str) -> dict[str, str]:
    """What the checks say of an answer in the file of data, if they fail."""
    task, data = task_of(chapter, key), answers(chapter)
    if " => " in answer:
        answer = edited(task.model, answer)
    elif not re.search(rf"^(def )?{task.target}\b *[(=]", answer, re.MULTILINE):
        frames = data.get("frame", {})
        frame = frames.get(key) or frames.get(task.name) or task.target + " = {}"
        answer = frame.replace("{}", answer)
    return failed(chapter, task, data.get("setup", "") + answer)


@for_assignments
def test_the_model_and_other_right_answers_pass_and_the_release_does_not(chapter):
    for task in tasks(chapter):
        assert failed(chapter, task, task.model) == {}
        empty = failed(chapter, task, released(task.model))
        assert list(empty) == list(task.checks)
        assert all(re.search("not written yet|no value yet", message) for message in empty.values())
    for key, right in answers(chapter)["right"].items():
        for answer in right:
            assert errors(chapter, key, answer) == {}, answer


@for_assignments
def test_a_wrong_answer_gets_its_hint(chapter):
    for key, rows in answers(chapter)["wrong"].items():
        for hint, wrong in rows.items():
            for answer in [wrong] if isinstance(wrong, str) else wrong:
                messages = errors(chapter, key, answer).values()
                assert any(hint in message for message in messages), (key, answer, messages)
                assert all(message.startswith("Hint: ") for message in messages), (
                    key,
                    answer,
                    messages,
                )


RETURNS = """
import numpy as np, sympy as sp, wmrlib
from fractions import Fraction
_model = {0}
def {0}(*given):
    it = _model(*given)
    return {1}
"""
SLIPS = {
    "but rounded": "np.round(it, 3)",
    "such as pi|`math.pi`|is needed|beside the place|plain mean": "np.multiply(it, 1 + 1e-4)",
    "swapped|changed places": "it[::-1] if np.ndim(it) == 1 else it",
}


def returning(task: Task, what: str) -> str:
    """The model, whose result `it` is changed before it is returned."""
    return task.model + "\n" + RETURNS.format(task.target, what)


@for_assignments
def test_a_slip_is_told_as_a_slip(chapter):
    """If only a last digit or the order of right numbers is wrong, no formula is blamed."""
    for task in tasks(chapter):
        is_function = task.model.startswith("def ") and "Pose(" not in task.model
        for words, slip in SLIPS.items() if is_function else ():
            first, *_ = task.checks
            slip = f"it if isinstance(it, bool) else {slip}"
            messages = failed(chapter, task, returning(task, slip))
            assert first not in messages or re.search(words, messages[first]), (
                task.name,
                slip,
                messages,
            )


@for_assignments
def test_an_answer_that_calls_the_library_is_not_ones_own(chapter):
    words = "asks for your own formula|may be used here"
    for task in tasks(chapter):
        if task.model.startswith("def ") and task.name not in ("poses", "parked", "safe"):
            messages = failed(chapter, task, returning(task, "(wmrlib.haversine_distance, it)[1]"))
            assert list(messages) == list(task.checks)
            assert all(re.search(words, message) for message in messages.values()), messages


NONSENSE = [
    *(None, 1.5, math.nan, math.inf, 1e308, 10**400, 1j, "1.5", True, dict),
    *(sp.Symbol("x"), (1.0, 2.0, 3.0, 4.0), [0.0, 0.0, 0.0], np.ones((2, 2))),
]
MODULES = [name for name in dir(grading) if name.islower() and name[0] != "_"]


@pytest.mark.parametrize("module", MODULES)
def test_nonsense_is_answered_by_a_hint(module):
    module = getattr(grading, module)
    checks = [
        inspect.unwrap(check)
        for name, check in inspect.getmembers(module, inspect.isfunction)
        if check.__module__.startswith(module.__name__) and not name.startswith("_")
    ]
    assert len(checks) > 2
    for check in checks:
        for value in NONSENSE:
            for answer in (value, lambda *_, v=value: v, lambda *_, v=value: [v] * 2):
                with pytest.raises(Hint) as error:
                    check(answer)
                assert len(str(error.value)) < 400


@pytest.mark.parametrize("name", EXERCISES)
def test_a_chapters_exercise_takes_its_answer_and_says_what_is_wrong_with_others(name):
    (_, model), *edits = EXERCISES[name].items()
    for words, source in [("Right", model), *((it, edited(model, edit)) for it, edit in edits)]:
        names = {}
        run_cell(source, f"<{name}>", names)
        given = [names[part] for part in ("answer", "more") if part in names]
        outcome = getattr(grading.exercises, name)(*given)
        assert words in outcome
        assert outcome.startswith("Hint: ") == (words != "Right")
    assert f"grading.exercises.{name}(" in CHAPTERS
