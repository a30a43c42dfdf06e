"""Tasks that ask for an explanation: students never get what an assistant marks them by."""

import re
from itertools import pairwise

import nbformat
import pytest
from damage import empty_course
from gradebook import Course
from graded import ASSIGNMENTS, notebook

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


@pytest.mark.parametrize("chapter", EXPLAINED)
def test_grading_shows_an_assistant_the_scheme_and_keeps_it_from_the_page(chapter, tmp_path):
    scheme = SCHEME.search(explained(chapter)[0][0].source)[1]
    folder = empty_course(tmp_path, chapter)
    with Course(folder) as course:
        ran = course.release(chapter)
        given = nbformat.writes(ran)
        assert not any(line in given for line in (*scheme.split("\n\n"), "SCHEME"))
        course.score(chapter, "ada", ran, "", dict.fromkeys(("answers", "key", "said"), ""))
        course.give_back(chapter, "ada")
    (stored,) = folder.glob(f"autograded/ada/{chapter}/*.ipynb")
    (page,) = folder.glob(f"feedback/ada/{chapter}/*.html")
    assert "misunderstandings" in stored.read_text(encoding="utf-8")
    assert "misunderstandings" not in page.read_text(encoding="utf-8")
    assert "MARK SCHEME" not in page.read_text(encoding="utf-8")
