"""A hand-in that was rearranged earns what it earned at home."""

import contextlib
import copy
import json

import damage
import graded
import handins
import nbformat
import pytest
from hypothesis import given, note
from hypothesis import strategies as st
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

NAMES = "first", "second", "third", "fourth"
ESSAY = "because it is so"


def released():
    """Two tasks with a check each, one with a check for both, and one to be marked by hand."""
    cells = [("imports", "import math", {})]
    for name in NAMES:
        stub = f'def {name}():\n    raise NotImplementedError("write")'
        cells.append((name, stub, {"solution": True}))
        if name != "second":
            check = f"assert {name}() == {name!r}" + " and second() == 'second'" * (name == "third")
            cells.append((f"{name}-works", check, {"grade": True}))
    made = []
    for key, source, more in cells:
        about = {"grade_id": key, "grade": False, "solution": False} | more
        made.append(new_code_cell(source, metadata={"nbgrader": about}))
    essay = {"grade_id": "essay", "grade": True, "solution": True, "points": 4}
    made.insert(-2, new_markdown_cell("YOUR ANSWER", metadata={"nbgrader": essay}))
    return new_notebook(cells=made)


def points(notebook) -> list[str]:
    """The checks that pass when all cells are run in their order."""
    names, passed = {}, []
    for cell in notebook.cells:
        with contextlib.suppress(Exception):
            if cell.cell_type == "code":
                exec(cell.source, names)
                passed += [cell.source] * cell.source.startswith("assert")
    return passed


def answer(name: str) -> str:
    return f"def {name}():\n    return {name!r}\n"


@given(st.data())
def test_wherever_the_definitions_stand_before_their_checks_all_points_are_kept(data):
    release = released()
    handed_in = copy.deepcopy(release)
    cells = handed_in.cells
    place = {cell.metadata.nbgrader.grade_id: k for k, cell in enumerate(cells)}
    for name in data.draw(st.permutations(NAMES)):
        cells[place[name]].source = ""
    texts = [[] for _ in range(2 * len(cells))]  # in a cell, and in one of their own before it
    for name in NAMES:
        last = place[{"second": "third"}.get(name, name) + "-works"]
        at = data.draw(st.one_of(st.just(2 * place[name] + 1), st.integers(0, 2 * last + 1)))
        texts[at].append(answer(name))
    cells[place["essay"]].source = ESSAY
    bare = data.draw(st.booleans())
    rearranged = []
    for k, cell in enumerate(cells):
        if texts[2 * k]:
            rearranged.append(new_code_cell("\n".join(texts[2 * k])))
        if texts[2 * k + 1] and cell.cell_type == "markdown":
            rearranged.append(new_code_cell("\n".join(texts[2 * k + 1])))
        elif texts[2 * k + 1]:
            cell.source = "\n".join([*texts[2 * k + 1], cell.source])
        if bare:
            cell.metadata, cell.id = {}, f"new-{k}"
        if cell.source or data.draw(st.booleans()):
            rearranged.append(cell)
    handed_in.cells = rearranged
    note("\n--\n".join(cell.source for cell in rearranged))
    assert len(points(release)) == 0
    found, how = handins.repaired(handed_in, release)
    note("\n--\n".join(cell.source for cell in found.cells))
    assert len(points(found)) == 3, how
    assert [cell.source for cell in found.cells if cell.cell_type == "markdown"] == [ESSAY], how


def program(notebook) -> list[str]:
    """The lines of its code."""
    code = [cell.source for cell in notebook.cells if cell.cell_type == "code"]
    return [line for source in code for line in source.splitlines() if line]


def assignment(chapter: str):
    """What students get of an assignment, and the same with the model's answers."""
    solved = nbformat.read(graded.notebook(chapter), as_version=4)
    for k in damage.answers(solved):
        if solved.cells[k].cell_type == "markdown":
            solved.cells[k].source = "YOUR ANSWER"
    release = copy.deepcopy(solved)
    for cell in release.cells:
        cell.source = graded.released(cell.source)
    return release, solved


@pytest.mark.parametrize("chapter", graded.ASSIGNMENTS)
def test_a_damaged_notebook_becomes_the_program_that_it_was(chapter):
    release, solved = assignment(chapter)
    for name, (edit, said) in damage.EDITS.items():
        damaged = copy.deepcopy(solved)
        edit(damaged)
        found, how = handins.repaired(damaged, release)
        assert program(found) == program(solved), name
        assert said in "; ".join(how), name
        checks = [release.cells[k].source for k in damage.checks(release)]
        assert [found.cells[k].source for k in damage.checks(found)] == checks, name


def test_an_answer_below_its_check_comes_too_late(tmp_path):
    release, solved = assignment("ch12")
    tried = copy.deepcopy(release)
    for k in damage.answers(tried):
        tried.cells[k].source = "tried = 1"
    (tmp_path / "it").write_text(json.dumps(tried), encoding="utf-8-sig")  # with a mark
    late = handins.read(tmp_path / "it")
    late.cells += solved.cells
    found, how = handins.repaired(late, release)
    assert program(found) == program(tried)
    assert "copies dropped" in "; ".join(how)


@pytest.mark.parametrize("bad", [["a"], {"a": 1}, 3])
def test_metadata_of_another_kind_is_no_name(bad):
    handed_in = released()
    handed_in.cells[1].metadata.nbgrader.grade_id = bad
    handed_in.cells[1].source = answer("first")
    found, _ = handins.repaired(handed_in, released())
    assert found.cells[1].source == answer("first")


def test_a_text_to_mark_by_hand_is_never_run_together_with_code():
    handed_in = released()
    place = [cell.cell_type for cell in handed_in.cells].index("markdown")
    handed_in.cells[place].source = "one"
    second = nbformat.from_dict(handed_in.cells[place] | {"source": "two"})
    handed_in.cells.insert(place + 1, second)
    found, how = handins.repaired(handed_in, released())
    assert [c.source for c in found.cells if c.cell_type == "markdown"] == ["one\n\ntwo"]
    assert how == ["its parts joined: essay"]
    del handed_in.cells[place : place + 2]
    found, how = handins.repaired(handed_in, released())
    assert [c.source for c in found.cells if c.cell_type == "markdown"] == ["YOUR ANSWER"]
    assert how == ["is missing: essay"]
