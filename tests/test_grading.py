"""The checks of the assignments: who is right passes, who is wrong reads a hint that says why.

The mistakes that a check compares with stand there alone, and known.py makes them. Other answers
stand in tests/data/course, a file a chapter:
- `mistake`: two of a task at least, for exactly the graded cells that each loses:
  {part of the hint: it};
- `right`: right answers, `wrong`: wrong ones, {part of the hint: answer or answers},
  each for a task or for one graded cell.
An answer is one or several edits of the model, `old => new || old => new`, or what the task's name
gets; in the last two it may be a whole cell, or stand at the {} of a `frame`;
- `setup`: what these two may use.
"""

import inspect
import math
import re
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from graded import (
    ASSIGNMENTS,
    answers,
    cells,
    given,
    lost,
    released,
    target,
    task_of,
    tasks,
    whole,
    wrong_answers,
)
from known import untold

import wmrlib as wmr
from wmrbook import grading
from wmrbook.grading import Hint, variants

STUDENTS = "Ada", "Emmy", "Grace"
VARIED = [chapter for chapter in ASSIGNMENTS if "mine" in cells(chapter)]
for_students = pytest.mark.parametrize(
    ("chapter", "student"),
    [(each, name) for each in ASSIGNMENTS for name in (STUDENTS if each in VARIED else ("",))],
)
MODULES = [n for n in dir(grading) if n.islower() and n[0] != "_" and n != "variants"]
MINE = {"trips": "home", "design": "tuned", "sampling": "slow", "lyapunov": "right"}


def asked(chapter: str) -> list[tuple[str, str, list[str]]]:
    """The chapter's tasks: a cell with an answer, the model's, and the cells that grade it."""
    graded = [(task, checks) for task, checks in tasks(chapter).items() if checks]
    return [(task, cells(chapter)[task][0], checks) for task, checks in graded]


@for_students
def test_who_is_right_passes_in_whatever_form_and_the_release_does_not(chapter, student):
    assert 2 <= len(asked(chapter)) <= 4
    others = {task: 0 for task, _, _ in asked(chapter)}
    for task, model, checks in asked(chapter):
        assert lost(chapter, task, model, student) == {}
        empty = lost(chapter, task, released(model), student)
        assert list(empty) == checks
        assert all(re.search("not written yet|no value yet", each) for each in empty.values())
    for key, right in answers(chapter)["right"].items():
        others[task_of(chapter, key)] += len(right)
        for answer in right:
            assert lost(chapter, key, whole(chapter, key, answer), student) == {}, answer
    assert min(others.values()) >= 2, others


@for_students
def test_who_is_wrong_reads_why_and_loses_exactly_what_is_wrong(chapter, student):
    rows = [(it["cell"], it["hint"], it["source"], it["loses"]) for it in wrong_answers(chapter)]
    for key, table in answers(chapter)["wrong"].items():
        for hint, wrong in table.items():
            several = [wrong] if isinstance(wrong, str) else wrong
            rows += [(key, hint, whole(chapter, key, answer), None) for answer in several]
    found, counts = {}, Counter()
    for key, hint, source, loses in rows:
        counts[task_of(chapter, key), loses is None] += 1
        hints = lost(chapter, key, source, student)
        named = any(hint in each for each in hints.values())
        if not (named and all(each.startswith("Hint: ") for each in hints.values())):
            found[key, source] = hints
        elif loses not in (None, [*hints]):
            found[key, source] = [*hints]
    assert found == {}
    enough = [counts[task, False] > 1 and counts[task, True] for task, _, _ in asked(chapter)]
    assert all(enough), counts


@pytest.mark.parametrize("chapter", ASSIGNMENTS)
def test_who_makes_a_mistake_that_a_check_looks_for_reads_its_hint(chapter, monkeypatch):
    counts = []
    for _, model, names in asked(chapter):
        checks = [
            lambda answer, name=name: lost(chapter, name, answer).get(name, "") for name in names
        ]
        count, hints = untold(monkeypatch, checks, given(chapter)[target(model)])
        counts.append(count)
        assert hints == set()
    assert sum(counts) > 1 or chapter in ("ch00", "ch10")  # whose mistakes are no other numbers


# What a slip makes of the numbers that a model returns, and what the student reads at once.
SLIPS = {
    "but rounded": "np.round(it, 3)",
    "such as pi|`math.pi`|is needed|beside the place|plain mean": "np.multiply(it, 1 + 1e-4)",
    "swapped|changed places": "it[::-1] if np.ndim(it) == 1 else it",
}
RETURNS = """
import numpy as np, wmrlib
_model = {0}
def {0}(*given):
    it = _model(*given)
    return {1}
"""


@pytest.mark.parametrize("chapter", ASSIGNMENTS)
def test_no_formula_is_blamed_for_a_slip(chapter):
    """A last digit, or the order of right numbers: the first hint says so."""
    found = {}
    for task, model, (first, *_) in asked(chapter):
        is_function = model.startswith("def ") and "Pose(" not in model
        for words, slip in SLIPS.items() if is_function else ():
            slip = f"it if isinstance(it, bool) else {slip}"
            hints = lost(chapter, first, model + "\n" + RETURNS.format(target(model), slip))
            if not all(re.search(words, each) for each in hints.values()):
                found[task, slip] = hints
    assert found == {}


NO_ANSWER = {
    "returns nothing: does it end in `return`": "None",
    "needed|has to return": "'A'",
    "asks for your own formula|may be used here": "(wmrlib.haversine_distance, it)[1]",
}


@pytest.mark.parametrize("chapter", ASSIGNMENTS)
def test_nothing_no_number_and_a_call_of_the_library_get_a_hint_each(chapter):
    for task, model, checks in asked(chapter):
        free = task in ("poses", "parked", "safe")  # they may call the library
        for words, it in [*NO_ANSWER.items()][: 3 - free] if model.startswith("def ") else ():
            hints = lost(chapter, task, model + "\n" + RETURNS.format(target(model), it))
            assert list(hints) == checks
            assert all(re.search(words, each) for each in hints.values()), hints


# Ways to write a right answer: every number, whatever holds several, every expression.
NUMBERS = ["Fraction(it)", "Decimal(it)", "np.float64(it)", "mpmath.mpf(it)", "sp.Float(it, 30)"]
NUMBERS += ["int(it) if it == int(it) else it", "np.array(it)", "sp.Rational(it)"]
SEVERAL = ["tuple(it)", "list(it)", "np.array(it)", "sp.Matrix(it)", "mpmath.matrix(it)"]
EXPRESSIONS = [
    *(f"sp.{it}" for it in ["factor", "expand", "together", "trigsimp", "factor_terms", "powsimp"]),
    *(f"sp.{it}" for it in ["nsimplify", "simplify", "signsimp", "UnevaluatedExpr", "cancel"]),
    *("lambda it: sp.collect(it, rho)", "lambda it: it.rewrite(sp.exp)"),
    *("lambda it: sp.Mul(-1, -it, evaluate=False)", "lambda it: sp.Add(it, 0, evaluate=False)"),
    "lambda it: it.xreplace({each: sp.Symbol(each.name) for each in it.free_symbols})",
    "lambda it: (lambda parts, ends: ends[0].subs(parts[::-1]))(*sp.cse(it))",
]
WRITTEN = """
from decimal import Decimal
from fractions import Fraction
import mpmath, numpy as np, sympy as sp
from wmrlib.symbolic import rho
def _several(it, way):
    named = hasattr(it, "_fields") or isinstance(it, tuple) and hasattr(it[0], "_fields")
    return it if named or not isinstance(it, (tuple, list, np.ndarray)) else way(it)
def _each(it, way):
    it = it.tolist() if isinstance(it, np.ndarray) else it
    if isinstance(it, (tuple, list)):
        made = [_each(one, way) for one in it]
        return tuple.__new__(type(it), made) if isinstance(it, tuple) else made
    return way(it) if isinstance(it, (int, float)) and not isinstance(it, bool) else it
def _formula(it, way):
    if isinstance(it, sp.MatrixBase):
        return it.applyfunc(way)
    return way(it) if isinstance(it, sp.Expr) else it
_model = {0}
"""


@pytest.mark.parametrize("chapter", ASSIGNMENTS)
def test_a_right_answer_may_be_written_in_any_way(chapter):
    ways = [f"_each(it, lambda it: {way})" for way in NUMBERS]
    ways += [f"_several(it, lambda it: {way})" for way in SEVERAL]
    formulas = [f"_formula(it, {way})" for way in EXPRESSIONS]
    found = {}
    for task, model, checks in asked(chapter):
        kind, name = re.match(r"(def )?(\w+)", model).groups()
        form = f"def {name}(*given):\n    it = _model(*given)\n    return " if kind else ""
        form = form or f"it = _model\n{name} = "
        for way in ways if kind else ways + formulas:
            answer = model + "\n" + WRITTEN.format(name) + form + way
            for check in checks[:1] if kind else checks:
                hints = lost(chapter, check, answer)
                if hints and "right, but the sign can't be read off" not in hints[check]:
                    found[task, way] = hints
    assert found == {}


NONSENSE = [
    *(None, ..., 1.5, math.nan, math.inf, 1e308, 1e-308, 10**400, 1j, np.complex128(1 + 2j)),
    *("1.5", True, np.array(True), dict, sp.Symbol("x"), {1.0}, {1.0, 2.0}, {1.0: 1.0, 2.0: 2.0}),
    *((1.0, 2.0, 3.0, 4.0), [0.0, 0.0, 0.0], (-1e300, -1e300), (1.0, 1e300), (8, 0.125, -24)),
    *(np.ones((2, 2)), np.array([1.0, 0])),
]


@pytest.mark.parametrize("module", MODULES)
def test_nonsense_is_answered_by_a_hint(module):
    mine = getattr(variants, MINE.get(module, "left"))("Ada")
    module = getattr(grading, module)
    checks = [
        check
        for name, check in inspect.getmembers(module, inspect.isfunction)
        if check.__module__.startswith(module.__name__) and not name.startswith("_")
    ]
    if module is grading.exercises:  # which say their hints instead
        checks = [check.__wrapped__ for check in checks]
    assert len(checks) > 2
    for check in checks:
        assert inspect.getdoc(check)
        assert check.__annotations__["return"] == "str"
        for value in NONSENSE:
            given = (value, lambda *_, v=value: v, lambda v=value: v, lambda *_, v=value: [v] * 2)
            for answer in given:
                with pytest.raises(Hint) as found:
                    check(answer, *[mine] * ("mine" in check.__annotations__))
                assert len(str(found.value)) < 400


def test_every_graded_cell_calls_a_check_of_its_own():
    called = [
        re.fullmatch(r"print\(grading\.(\w+\.\w+)\(\w+(, mine)?\)\)", cells(chapter)[name][0])[1]
        for chapter in ASSIGNMENTS
        for _, _, names in asked(chapter)
        for name in names
    ]
    assert len(called) == len(set(called)) > 70


def handed_in_by(monkeypatch, student: str) -> None:
    monkeypatch.setenv("WMR_STUDENT", student)
    monkeypatch.setenv("WMR_CLASS", ",".join(STUDENTS))


@pytest.mark.parametrize("chapter", VARIED)
def test_a_classmates_answer_is_known(chapter, monkeypatch):
    handed_in_by(monkeypatch, "Ada")
    for task, model, checks in asked(chapter):
        if any("mine" in cells(chapter)[each][0] for each in checks):
            copied = lost(chapter, task, model, "Ada", by="Emmy")
            assert list(copied) == checks
            words = "right with the numbers of emmy, and not"
            assert all(words in each for each in copied.values())


@pytest.mark.parametrize("make", [variants.home, variants.tuned, variants.slow])
def test_everybodys_drive_is_as_hard(make):
    """The same gains, told in each student's units, leave as much, to either side."""
    errors, limits = [], []
    for mine in map(make, "abcdefgh"):
        gains = wmr.Gains(0.3 / mine.metre, 1 / mine.second, 0.8, 4 * mine.metre / mine.second)
        _, end = mine.run(gains)
        errors.append(end.heading_error)
        limits.append(mine.time / mine.second)
    assert np.abs(errors) == pytest.approx(abs(errors[0]), rel=1e-3)
    assert min(errors) < 0 < max(errors)
    assert max(limits) - min(limits) < 0.2  # s, of the paper's drive; each is rounded up


def test_numbers_are_a_names_own(monkeypatch, tmp_path):
    for make in (getattr(variants, each) for each in ("home", "tuned", "slow", "right", "left")):
        assert make("Ada") == make(" ada ")
        shown = {repr(make(f"student {k}")) for k in range(20)}
        assert len(shown) > 15
    (own,) = variants.checked(variants.home, lambda *_: "right")
    handed_in_by(monkeypatch, "ada")
    assert variants.home("") == variants.home("Ada")  # as the grader's folder says
    with pytest.raises(Hint, match="'grace', but 'ada' handed this in"):
        own(None, variants.home("Grace"))
    with pytest.raises(Hint, match="a text is needed"):
        variants.home(1)
    (seen,) = variants.checked(variants.home, lambda _, numbers: numbers)
    lax = replace(variants.home("Ada"), time=1e9)
    assert seen(None, lax) == variants.home("Ada")  # whatever a notebook makes of them
    monkeypatch.undo()
    with pytest.raises(Hint, match="your name is missing"):
        own(None, variants.home(""))
    folder = tmp_path / "autograded" / "Emmy" / "ch00"
    folder.mkdir(parents=True)
    monkeypatch.chdir(folder)
    assert variants.home("") == variants.home("Emmy")
