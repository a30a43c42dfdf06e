"""Tasks that ask for an explanation: students never get what an assistant marks them by."""

import re
from itertools import pairwise

import nbformat
import pytest
from damage import empty_course, hand_in
from gradebook import Course
from graded import ASSIGNMENTS, BEGIN, END, nbgrader, notebook
from nbgrader.api import Gradebook

SCHEME = re.compile(r"=== BEGIN MARK SCHEME ===\n(.*)\n=== END MARK SCHEME ===", re.DOTALL)


def explained(chapter):
    """The cells of a chapter that are marked by hand, each after the cell with its question."""
    cells = nbformat.read(notebook(chapter), as_version=4).cells
    pairs = pairwise(cells)
    return [(q, a) for q, a in pairs if a.cell_type == "markdown" and a.metadata.nbgrader.grade]


EXPLAINED = [chapter for chapter in ASSIGNMENTS if explained(chapter)]


@pytest.mark.parametrize("chapter", EXPLAINED)
def test_a_question_says_what_earns_its_points(chapter):
    for question, answer in explained(chapter):
        most, settings = answer.metadata.nbgrader.points, answer.metadata.nbgrader
        scheme = SCHEME.search(question.source)[1]
        levels = [float(each) for each in re.findall(r"^\| ([\d.]+) \|", scheme, re.MULTILINE)]
        assert 3 <= len(levels) <= 5
        assert levels == sorted(levels, reverse=True)
        assert (levels[0], levels[-1]) == (most, 0)
        assert f"up to {most} points" in question.source
        assert "misunderstandings" in scheme
        assert settings.solution
        assert question.metadata.nbgrader.locked > settings.locked
        limit = int(re.search(r"at most (\d+) words", question.source)[1])
        words = re.sub(r"\$[^$]*\$|#.*", "", answer.source).split()
        assert len(words) <= 1.1 * limit


@pytest.mark.slow
def test_an_explanation_is_marked_by_hand_by_a_scheme_that_no_student_gets(tmp_path):
    folder, name = empty_course(tmp_path, chapter := EXPLAINED[0]), notebook(EXPLAINED[0]).name
    ((question, answer),) = explained(chapter)
    scheme, settings = SCHEME.search(question.source)[1], answer.metadata.nbgrader
    nbgrader(folder, "generate_assignment", chapter)
    given = nbformat.read(folder / "release" / chapter / name, as_version=4)
    model = nbformat.read(notebook(chapter), as_version=4)
    assert not any(line in nbformat.writes(given) for line in (*scheme.split("\n\n"), "SCHEME"))
    for student in "silent", "explains":
        for cell, solved in zip(given.cells, model.cells, strict=True):
            written = student == "explains" or cell.cell_type == "code"
            if solved.metadata.nbgrader.solution and written:
                source = solved.source.replace('"model"', f'"{student}"')
                cell.source = source.replace(BEGIN, "").replace(END, "")
        hand_in(folder, student, chapter, given)
    nbgrader(folder, "autograde", chapter, "--create")
    nbgrader(folder, "generate_feedback", chapter)
    pages = {}
    for stage, end in ("autograded", ".ipynb"), ("feedback", ".html"):
        path = (folder / stage / "explains" / chapter / name).with_suffix(end)
        pages[stage] = path.read_text(encoding="utf-8")
    assert "misunderstandings" in pages["autograded"]  # which the formgrader shows
    assert "misunderstandings" not in pages["feedback"]
    with Gradebook(f"sqlite:///{folder / 'gradebook.db'}") as book:
        for student, waits in ("explains", True), ("silent", False):
            found = book.find_submission(chapter, student)
            most = found.max_score - settings.points
            assert (found.score, found.needs_manual_grade) == (most, waits)
            (by_hand,) = (g for g in found.notebooks[0].grades if g.name == settings.grade_id)
            assert (by_hand.score, by_hand.needs_manual_grade) == (0, waits)


def test_grading_shows_an_assistant_the_scheme_and_keeps_it_from_the_page(tmp_path):
    chapter = EXPLAINED[0]
    folder = empty_course(tmp_path, chapter)
    with Course(folder) as course:
        ran = course.release(chapter)
        assert "misunderstandings" not in nbformat.writes(ran)
        course.score(chapter, "ada", ran, "", dict.fromkeys(("answers", "key", "said"), ""))
        course.give_back(chapter, "ada")
    (stored,) = folder.glob(f"autograded/ada/{chapter}/*.ipynb")
    (page,) = folder.glob(f"feedback/ada/{chapter}/*.html")
    assert "misunderstandings" in stored.read_text(encoding="utf-8")
    assert "misunderstandings" not in page.read_text(encoding="utf-8")
    assert "MARK SCHEME" not in page.read_text(encoding="utf-8")
