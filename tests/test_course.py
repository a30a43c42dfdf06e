"""The course through nbgrader itself: what students get, and what the models, untouched releases and usual mistakes score."""

from __future__ import annotations

import re
import shutil
from itertools import zip_longest
from pathlib import Path

import nbformat
import pytest
from graded import ASSIGNMENTS, BEGIN, END, ROOT, cells, nbgrader, wrong_answers

COURSE = ROOT / "book" / "course"


def handed_in(
    release: Path, folder: Path, answers: dict[str, str], graded: str | None = None
) -> None:
    """The release with `answers` in its cells; if `graded` is given, that stands in the cells that grade, which students must not edit."""
    notebook = nbformat.read(release, as_version=4)
    for cell in notebook.cells:
        settings = cell.metadata.get("nbgrader", {})
        if cell.cell_type == "code":
            cell.source = (
                graded
                if graded and settings.get("grade")
                else answers.get(settings.get("grade_id"), cell.source)
            )
    folder.mkdir(parents=True)
    nbformat.write(notebook, folder / release.name)


def mistakes(chapter: str) -> dict[str, list[dict]]:
    """The usual mistakes as students make them: the k-th one has the k-th mistake of each task, if there are so many."""
    by_cell: dict[str, list[dict]] = {}
    for wrong in wrong_answers(chapter):
        by_cell.setdefault(wrong["cell"], []).append(wrong)
    return {
        f"mistaken-{count}": list(filter(None, each))
        for count, each in enumerate(zip_longest(*by_cell.values()), start=1)
    }


@pytest.fixture(scope="module", params=ASSIGNMENTS)
def graded_course(request, tmp_path_factory):
    """(chapter, folder of the course) with everything handed in and graded."""
    chapter, course = request.param, tmp_path_factory.mktemp("course")
    shutil.copy(COURSE / "nbgrader_config.py", course)
    shutil.copytree(COURSE / "templates", course / "templates")
    shutil.copytree(COURSE / "source" / chapter, course / "source" / chapter)
    nbgrader(course, "generate_assignment", chapter)
    (release,) = (course / "release" / chapter).glob("*.ipynb")
    model = {name: source for name, source, _ in cells(chapter) if BEGIN in source}

    def hand_in(student: str, answers: dict[str, str], **graded: str) -> None:
        handed_in(release, course / "submitted" / student / chapter, answers, **graded)

    hand_in("model", model)
    hand_in("empty", {})
    hand_in("cheat", {}, graded="'all is well'")
    for student, wrongs in mistakes(chapter).items():
        hand_in(student, model | {wrong["cell"]: wrong["source"] for wrong in wrongs})
    nbgrader(course, "autograde", chapter)
    return chapter, course


def scores(course: Path, chapter: str, student: str) -> dict[str, tuple[float, float]]:
    """(points, most points) of each graded cell, out of nbgrader's gradebook."""
    from nbgrader.api import Gradebook

    with Gradebook(f"sqlite:///{course / 'gradebook.db'}") as book:
        submission = book.find_submission(chapter, student)
        return {
            grade.name: (grade.score, grade.max_score)
            for notebook in submission.notebooks
            for grade in notebook.grades
        }


def said(course: Path, chapter: str, student: str) -> dict[str, str]:
    """What each graded cell says in the notebook that the student gets back."""
    (path,) = (course / "autograded" / student / chapter).glob("*.ipynb")
    graded = [
        cell
        for cell in nbformat.read(path, as_version=4).cells
        if cell.metadata.get("nbgrader", {}).get("grade")
    ]
    return {cell.metadata.nbgrader.grade_id: "\n".join(map(str, cell.outputs)) for cell in graded}


def test_no_answer_is_in_what_students_get(graded_course):
    chapter, course = graded_course
    (release,) = (course / "release" / chapter).glob("*.ipynb")
    notebook = nbformat.read(release, as_version=4)
    given = {line.strip() for cell in notebook.cells for line in cell.source.splitlines()}
    for _, source, _ in cells(chapter):
        if BEGIN in source:
            answer = {
                line.strip() for line in source.partition(BEGIN)[2].partition(END)[0].splitlines()
            } - {""}
            assert answer
            shared = answer & given
            assert len(shared) < len(answer) / 2, (
                shared
            )  # an import or a closing bracket may be given too
    assert "SOLUTION" not in release.read_text(encoding="utf-8")
    assert not any(cell.get("outputs") for cell in notebook.cells)
    assert sum("raise NotImplementedError" in cell.source for cell in notebook.cells) >= 2


def test_the_model_scores_all_and_the_empty_release_nothing(graded_course):
    chapter, course = graded_course
    wanted = {name: points for name, _, points in cells(chapter) if points}
    assert 8 <= sum(wanted.values()) <= 12
    assert scores(course, chapter, "model") == {
        name: (points, points) for name, points in wanted.items()
    }
    for student in ("empty", "cheat"):  # what a student writes into a graded cell does not count
        assert scores(course, chapter, student) == {
            name: (0, points) for name, points in wanted.items()
        }


def test_usual_mistakes_lose_their_points_with_their_hints(graded_course):
    chapter, course = graded_course
    for student, wrongs in mistakes(chapter).items():
        lost = {
            name
            for name, (points, most) in scores(course, chapter, student).items()
            if points < most
        }
        assert lost == {name for wrong in wrongs for name in wrong["loses"]}, (student, lost)
        texts = said(course, chapter, student)
        for wrong in wrongs:
            hints = " ".join(texts[name] for name in wrong["loses"])
            assert "Hint: " in hints
            assert wrong["hint"] in hints, (wrong["name"], hints)
            assert "book/wmrbook/grading" not in hints  # no traceback, which would show the check


def test_feedback_has_hints_and_points_and_asks_no_network(graded_course):
    chapter, course = graded_course
    nbgrader(course, "generate_feedback", chapter, "--student=mistaken-1")
    (path,) = (course / "feedback" / "mistaken-1" / chapter).glob("*.html")
    page = path.read_text(encoding="utf-8")
    assert "Hint: " in page
    assert re.search(r"Score: [\d.]+ / [\d.]+", page)
    assert not re.search(
        r"""(src|srcset|action)\s*=\s*["']?(https?:)?//|<link[^>]*//|@import|url\(["']?(https?:)?//""",
        page,
    )
