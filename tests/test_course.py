"""The course through nbgrader: what students get, what they score, and what they read.

Every assignment is released, and graded as it was handed out and with the model's answers. One of
them is also handed in with usual mistakes and with graded cells that a student has changed; what
the mistakes of the others cost is checked in test_grading.py, without nbgrader.
"""

import os
import re
import shutil

import nbformat
import pytest
from graded import ASSIGNMENTS, BEGIN, END, ROOT, cells, nbgrader, tasks, wrong_answers
from nbgrader.api import Gradebook

CHAPTER = "ch12"  # with every kind of student; its cells run fast


def mistakes() -> dict[str, list[dict]]:
    """Two students: one makes the first mistake of each task, the other the second."""
    by_task = [[w for w in wrong_answers(CHAPTER) if w["cell"] == each] for each in tasks(CHAPTER)]
    return {f"mistaken-{k + 1}": [made[k] for made in by_task] for k in (0, 1)}


def notebook(course, stage: str, chapter: str = CHAPTER):
    (path,) = (course / stage / chapter).glob("*.ipynb")
    return nbformat.read(path, as_version=4)


def hand_in(course, student: str, chapter: str, answers: dict[str, str]) -> None:
    """The release with `answers` in its cells; "cheat" overwrites those that grade."""
    handed_in = notebook(course, "release", chapter)
    for cell in handed_in.cells:
        settings = cell.metadata.get("nbgrader", {})
        cell.source = answers.get(settings.get("grade_id"), cell.source)
        if student == "cheat" and settings.get("grade"):
            cell.source = "'all is well'"
    folder = course / "submitted" / student / chapter
    folder.mkdir(parents=True)
    (name,) = (path.name for path in (course / "release" / chapter).glob("*.ipynb"))
    nbformat.write(handed_in, folder / name)


@pytest.fixture(scope="module")
def course(tmp_path_factory):
    """The folder of the course, with everything handed in, graded and given back."""
    course = tmp_path_factory.mktemp("c") / "course"
    shutil.copytree(
        ROOT / "book" / "course",
        course,
        ignore=shutil.ignore_patterns("release", "submitted", "autograded", "feedback", "*.db"),
    )
    if os.name != "nt":  # other kernels that start now can't take its ports
        with (course / "nbgrader_config.py").open("a", encoding="utf-8") as config:
            config.write(
                f"\nc.KernelManager.transport = 'ipc'\nc.KernelManager.ip = '{course}/k'\n"
            )
    nbgrader(course, "generate_assignment", "*")
    for chapter in ASSIGNMENTS:
        model = {name: source for name, (source, _) in cells(chapter).items() if BEGIN in source}
        hand_in(course, "model", chapter, model)
        hand_in(course, "empty", chapter, {})
        if chapter == CHAPTER:
            hand_in(course, "cheat", chapter, {})
            for student, wrongs in mistakes().items():
                changed = {wrong["cell"]: wrong["source"] for wrong in wrongs}
                hand_in(course, student, chapter, model | changed)
    nbgrader(course, "autograde", "*")
    nbgrader(course, "generate_feedback", CHAPTER, "--student=mistaken-1")
    return course


def scores(course, student: str, chapter: str) -> dict[str, tuple[float, float]]:
    """{graded cell: (points, most points)}, out of nbgrader's gradebook."""
    with Gradebook(f"sqlite:///{course / 'gradebook.db'}") as book:
        (graded,) = book.find_submission(chapter, student).notebooks
        return {grade.name: (grade.score, grade.max_score) for grade in graded.grades}


@pytest.mark.parametrize("chapter", ASSIGNMENTS)
def test_the_release_has_no_answer_and_scores_nothing_and_the_model_all(course, chapter):
    release = notebook(course, "release", chapter)
    given = {line.strip() for cell in release.cells for line in cell.source.splitlines()}
    for source, _ in cells(chapter).values():
        if BEGIN in source:
            lines = source.partition(BEGIN)[2].partition(END)[0].splitlines()
            answer = {line.strip() for line in lines} - {""}
            assert len(answer & given) < len(answer) / 2  # an import may be given too
    assert "SOLUTION" not in nbformat.writes(release)
    assert not any(cell.get("outputs") for cell in release.cells)
    stubs = sum("raise NotImplementedError" in cell.source for cell in release.cells)
    assert stubs == len(tasks(chapter))
    wanted = {name: points for name, (_, points) in cells(chapter).items() if points}
    assert 8 <= sum(wanted.values()) <= 12
    for student, share in (("model", 1), ("empty", 0)):
        points = {name: (share * most, most) for name, most in wanted.items()}
        assert scores(course, student, chapter) == points


def test_what_a_student_writes_into_a_graded_cell_does_not_count(course):
    assert {points for points, _ in scores(course, "cheat", CHAPTER).values()} == {0}


def test_mistakes_lose_their_points_with_their_hints(course):
    for student, wrongs in mistakes().items():
        points = scores(course, student, CHAPTER)
        lost = {name for name, (reached, most) in points.items() if reached < most}
        assert lost == {name for wrong in wrongs for name in wrong["loses"]}, (student, lost)
        graded = notebook(course, f"autograded/{student}").cells
        said = {
            cell.metadata.nbgrader.grade_id: "\n".join(map(str, cell.outputs))
            for cell in graded
            if cell.metadata.get("nbgrader", {}).get("grade")
        }
        for wrong in wrongs:
            hints = " ".join(said[name] for name in wrong["loses"])
            assert "Hint: " in hints
            assert wrong["hint"] in hints, (wrong["name"], hints)
            assert "wmrbook/grading" not in hints  # no traceback, which would show the check


def test_feedback_has_hints_and_points_and_asks_no_network(course):
    (path,) = (course / "feedback" / "mistaken-1" / CHAPTER).glob("*.html")
    page = path.read_text(encoding="utf-8")
    assert "Hint: " in page
    assert re.search(r"Score: [\d.]+ / [\d.]+", page)
    assert not re.search(r"""(src|srcset|action)\s*=\s*["']?(https?:)?//|<link[^>]*//""", page)
    assert not re.search(r"""@import|url\(["']?(https?:)?//""", page)
