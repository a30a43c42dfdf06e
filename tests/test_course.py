"""The course as a lecturer runs it: what students get, what they score, and what they read.

Every assignment is released and graded with the model's answers. One of them is also handed in with
damage that must run to show, with usual mistakes, and with graded cells that a student has changed;
what the mistakes of the others cost is checked in test_grading.py, without nbgrader.
"""

import multiprocessing
import os
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import cage
import damage
import handins
import nbformat
import psutil
import pytest
import sandbox
from cells import grade_id
from graded import ASSIGNMENTS, BEGIN, END, ROOT, cells, marks, most, tasks, wrong_answers
from kernel import Limits
from nbgrader.api import Gradebook

pytestmark = pytest.mark.slow

NOBODY = "Zoe\u0308"
CHAPTER = "ch12"  # with every kind of student; its cells run fast
SPY = """import math, os
import numpy as np
from wmrbook import grading
print([*map(os.path.exists, {})])
for place in grading.__file__, "{}", "mine":
    try:
        open(place, "a").close()
        print("written")
    except OSError:
        print("refused")"""


def mistakes() -> dict[str, list[dict]]:
    """Two students: one makes the first mistake of each task, the other the second."""
    by_task = [[w for w in wrong_answers(CHAPTER) if w["cell"] == each] for each in tasks(CHAPTER)]
    return {f"mistaken-{k + 1}": [made[k] for made in by_task] for k in (0, 1)}


def notebook(course, stage: str, chapter: str = CHAPTER):
    (path,) = (course / stage / chapter).glob("*.ipynb")
    return nbformat.read(path, as_version=4)


def answered(course, chapter: str, answers: dict[str, str]):
    """The release with these answers in its cells."""
    handed_in = notebook(course, "release", chapter)
    for cell in handed_in.cells:
        cell.source = answers.get(cell.metadata.nbgrader.grade_id, cell.source)
    return handed_in


def model(chapter: str) -> dict[str, str]:
    """The model's answers."""
    return {name: source for name, (source, _) in cells(chapter).items() if BEGIN in source}


@pytest.fixture(scope="module")
def course(tmp_path_factory):
    """The folder of a course with what students get; of each assignment something comes in."""
    course = damage.empty_course(tmp_path_factory.mktemp("c"))
    damage.command("package.py", course)
    for chapter in ASSIGNMENTS:
        damage.hand_in(course, "late", chapter, "")  # refused, after the model's answers have run
    damage.hand_in(course, NOBODY, CHAPTER, notebook(course, "release"))
    (course / "submitted" / NOBODY / CHAPTER / "timestamp.txt").write_bytes(b"\xff")
    return course


@pytest.fixture(scope="module")
def graded(course):
    """The table of grade.py, and what it should say of the hand-ins that are damaged."""
    solved = answered(course, CHAPTER, model(CHAPTER))
    other = answered(course, "ch11", model("ch11"))
    expected, files = {}, {"renamed": "my answers (1).ipynb", "no file": "answers.py"}
    for student, content, *wanted in damage.damaged(solved, other):
        damage.hand_in(course, student, CHAPTER, content, files.get(student, ""))
        expected[CHAPTER, student] = wanted
    for student, wrongs in mistakes().items():
        answers = model(CHAPTER) | {wrong["cell"]: wrong["source"] for wrong in wrongs}
        damage.hand_in(course, student, CHAPTER, answered(course, CHAPTER, answers))
    checks = {name: "'all is well'" for name, (_, points) in cells(CHAPTER).items() if points}
    damage.hand_in(course, "cheat", CHAPTER, answered(course, CHAPTER, checks))
    secrets = course, damage.COURSE, ROOT / "tests", Path.home() / ".bashrc"
    spy = {"given-01": SPY.format([*map(str, secrets)], ROOT / "README.md")}
    damage.hand_in(course, "spy", CHAPTER, answered(course, CHAPTER, spy))
    (course / "submitted" / "a[b]").mkdir()
    (course / "submitted" / "bob" / "chapter 1").mkdir(parents=True)
    broken = course / "source" / "broken"
    shutil.copytree(course / "source" / CHAPTER, broken)
    for path in broken.iterdir():
        path.write_text(path.read_text("utf-8").replace("float(", "str("), "utf-8")
        damage.hand_in(course, "ada", "broken", path.read_bytes())
    return damage.rows(damage.command("grade.py", course, "--seconds", "20")), expected


def scores(course, student: str, chapter: str) -> dict[str, tuple[float, float]]:
    """{graded cell: (points, most points)}, out of nbgrader's gradebook."""
    with Gradebook(f"sqlite:///{course / 'gradebook.db'}") as book:
        (graded,) = book.find_submission(chapter, student).notebooks
        return {grade.name: (grade.score, grade.max_score) for grade in graded.grades}


@pytest.mark.parametrize("chapter", ASSIGNMENTS)
def test_the_release_has_no_answer_and_the_model_has_all_points(course, graded, chapter):
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
    assert 8 <= most(chapter) <= 12
    assert graded[0][chapter, "late"].endswith("is empty")  # and not: the model fails


def full(*_: object) -> None:
    """What a run is on a full disk."""
    raise OSError(28, "No space left on device")


def test_a_run_that_fails_for_another_reason_is_refused_and_not_worth_nothing(tmp_path):
    runner = sandbox.Sandbox([], Limits())
    runner.processes = multiprocessing.get_context("spawn")
    with pytest.raises(handins.Refused, match=r"try again: OSError: .* No space left"):
        runner._apart(full, 99.0, tmp_path)


@pytest.mark.parametrize("student", [NOBODY, "cheat"])
def test_no_answer_is_worth_nothing_whatever_stands_in_a_graded_cell(course, graded, student):
    """Under a name as macOS writes it, and with a time that nobody can read."""
    wanted = {name: (0, points) for name, (_, points) in cells(CHAPTER).items() if points}
    assert scores(course, student, CHAPTER) == wanted


def test_mistakes_lose_their_points_with_their_hints(course, graded):
    for student, wrongs in mistakes().items():
        points = scores(course, student, CHAPTER)
        lost = {name for name, (reached, most) in points.items() if reached < most}
        assert lost == {name for wrong in wrongs for name in wrong["loses"]}, (student, lost)
        graded = notebook(course, f"autograded/{student}").cells
        said = {grade_id(cell): "\n".join(map(str, cell.get("outputs", ()))) for cell in graded}
        for wrong in wrongs:
            hints = " ".join(said[name] for name in wrong["loses"])
            assert "Hint: " in hints
            assert wrong["hint"] in hints, (wrong["name"], hints)
            assert "wmrbook/grading" not in hints  # no traceback, which would show the check


def test_a_damaged_hand_in_is_graded_or_refused_by_name_and_stops_nobody(graded):
    table, expected = graded
    assert not damage.faults(table, expected)
    assert "the name may have" in table["", "a[b]"]
    assert "no assignment chapter 1" in table["", "bob"]
    commands = [each.info["cmdline"] or [] for each in psutil.process_iter(["cmdline"])]
    assert not any("# left" in line for each in commands for line in each)


@pytest.mark.skipif(not cage.holds(), reason="this system cages no process")
def test_a_hand_in_sees_neither_answers_nor_points_nor_other_hand_ins(course, graded):
    (cell,) = (c for c in notebook(course, "autograded/spy").cells if "exists" in c.source)
    seen, *written = cell.outputs[0].text.splitlines()
    assert seen == "[False, False, False, False]"
    assert written == ["refused", "refused", "written"]  # a file of its own


def test_a_model_that_fails_on_a_machine_costs_nobody_points(graded):
    assert "refused: on this machine the model fails" in graded[0]["broken", "ada"]


def test_feedback_has_hints_and_points_and_is_small(course, graded):
    (path,) = (course / "feedback" / "mistaken-1" / CHAPTER).glob("*.html")
    page = path.read_text("utf-8")
    assert "Hint: " in page
    assert re.search(r"Score: [\d.]+ / [\d.]+", page)
    assert len(page) < 60_000  # of 30 students in 13 assignments: 23 MB


@pytest.mark.parametrize("kind", ["moodle", "canvas"])
def test_marks_have_a_column_an_assignment_and_are_empty_where_nothing_came(course, graded, kind):
    rows = marks(course, kind)
    assert [name for name in next(iter(rows.values())) if name.startswith("ch")] == ASSIGNMENTS
    assert rows["renamed"]["ch00"] == ""
    assert rows[NOBODY][CHAPTER] == "0"
    assert rows["renamed"][CHAPTER] == f"{most(CHAPTER)}"
    if kind == "canvas":
        assert rows[""]["ch00"] == f"{most('ch00')}"


def test_the_package_has_what_a_student_needs_and_no_answers(course, tmp_path):
    with zipfile.ZipFile(course / "students.zip") as package:
        package.extractall(tmp_path)
    texts = [path.read_text("utf-8") for path in tmp_path.rglob("*.ipynb")]
    assert len(texts) == len(ASSIGNMENTS) + len([*(ROOT / "notebooks").glob("*.ipynb")])
    assert not any("SOLUTION" in text or "<summary>Solution" in text for text in texts)
    assert not [*tmp_path.rglob("source"), *tmp_path.rglob("tests"), *tmp_path.rglob("*.toml.*")]
    robot = tmp_path / "robot"
    readme = (robot / "README.md").read_text("utf-8")
    assert readme.count("-r environment.txt -e .") == 2
    code = "import wmrbook.figures, wmrbook.grading.earth, wmrlib; print(wmrlib.__file__)"
    path = {"PYTHONPATH": f"{robot}{os.pathsep}{robot / 'book'}"}
    line = [sys.executable, "-c", code]
    done = subprocess.run(line, cwd=robot, env=os.environ | path, capture_output=True, text=True)
    assert done.stdout.startswith(str(robot)), done.stderr
