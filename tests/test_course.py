"""A class from release to marks, by the commands that the lecturer's guide shows."""

import csv
import os
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import nbformat
import pytest

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[1]
COURSE = ROOT / "book/course"
GUIDE = (ROOT / "book/lecturers.md").read_text(encoding="utf-8")
COMMANDS = re.findall(r"^    (nbgrader .+|python package\.py)$", GUIDE, re.MULTILINE)
NAME = "01_gps_to_metres.ipynb"
HINT = "the result is in kilometres; metres are asked for."
MOST, LOST = 11.0, 4.0  # points of the assignment, and of a wrong distance
MOODLE = {
    "Ada Lovelace_1234_assignsubmission_file_/" + NAME: "right",
    "Jürgen O'Neill_1235_assignsubmission_file_01_gps_to_metres (1).ipynb": "wrong",
    "Eve Adams_1236_assignsubmission_file_" + NAME: "damaged",
}
CANVAS = {
    "lovelaceada_4711_98765_" + NAME: "right",
    "oneilljurgen_LATE_4712_98766_01_gps_to_metres-1.ipynb": "wrong",
    "adamseve_4713_98767_" + NAME: "damaged",
}
STUDENTS = [
    ("Ada Lovelace", "Jürgen O'Neill", "Eve Adams"),
    ("lovelaceada", "oneilljurgen", "adamseve"),
]


def run(command: str, folder: Path) -> subprocess.CompletedProcess:
    """Run a command of the guide in the folder of a course, with this Python's programs first."""
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    options = {"cwd": folder, "env": os.environ | {"PATH": path}}
    return subprocess.run(command.split(), capture_output=True, text=True, **options)


def hand_ins(release: Path) -> dict[str, str]:
    """The released notebook with right answers, with one that is wrong, and cut off."""
    source = nbformat.read(COURSE / "source/ch01" / NAME, as_version=4)
    answers = {cell.metadata.nbgrader.grade_id: cell.source for cell in source.cells}
    notebook = nbformat.read(release, as_version=4)
    for cell in notebook.cells:
        if cell.metadata.nbgrader.solution:
            cell.source = answers[cell.metadata.nbgrader.grade_id]
    right = nbformat.writes(notebook)
    wrong = right.replace("return 6_371_000 * 2", "return 6_371 * 2")
    assert wrong != right
    return {"right": right, "wrong": wrong, "damaged": right[: len(right) // 2]}


@pytest.fixture(scope="module")
def course(tmp_path_factory):
    """A course after all commands of the guide, and what grading said."""
    folder, messages = tmp_path_factory.mktemp("course"), ""
    shutil.copytree(COURSE / "source/ch01", folder / "source/ch01")
    shutil.copy(COURSE / "nbgrader_config.py", folder)
    for command in COMMANDS:
        if "zip_collect" in command:
            download(folder)
        if command == "python package.py":
            command = f"python {COURSE / 'package.py'} --course {folder}"
        done = run(command, folder)
        if "autograde" in command:
            messages = done.stderr
        assert (done.returncode == 0) != ("autograde" in command), done.stderr
    return folder, messages


def download(folder: Path) -> None:
    """Put what Moodle and Canvas give a lecturer where the guide says."""
    archive = folder / "downloaded/ch01/archive"
    archive.mkdir(parents=True)
    contents = hand_ins(folder / "release/ch01" / NAME)
    for name, files in {"moodle": MOODLE, "canvas": CANVAS}.items():
        with zipfile.ZipFile(archive / f"{name}.zip", "w") as package:
            for file, kind in files.items():
                package.writestr(file, contents[kind])


@pytest.mark.parametrize(("right", "wrong", "damaged"), STUDENTS)
def test_a_class_gets_its_marks_and_its_hints(course, right, wrong, damaged):
    folder, messages = course
    with (folder / "grades.csv").open(encoding="utf-8") as file:
        marks = {row["student_id"]: float(row["score"]) for row in csv.DictReader(file)}
    assert (marks[right], marks[wrong], marks[damaged]) == (MOST, MOST - LOST, 0.0)
    assert f"error processing assignment 'ch01' for student '{damaged}'" in messages
    pages = {name: folder / f"feedback/{name}/ch01/01_gps_to_metres.html" for name in marks}
    assert "Hint: " not in pages[right].read_text(encoding="utf-8")
    page = pages[wrong].read_text(encoding="utf-8")
    assert f"Hint: {HINT}" in page
    assert "wmrbook/grading" not in page  # a traceback would show the check, and the answer with it
    assert not pages[damaged].exists()


def test_students_get_no_answers_and_what_the_notebooks_need(course, tmp_path):
    folder, _ = course
    with zipfile.ZipFile(folder / "students.zip") as package:
        package.extractall(tmp_path)
    robot = tmp_path / "robot"
    (assignment,) = robot.glob("assignments/*/*.ipynb")
    assert (assignment.parent.name, assignment.name) == ("ch01", NAME)
    chapters = sorted(robot.glob("notebooks/*.ipynb"))
    assert [path.name for path in chapters] == sorted(
        path.name for path in (ROOT / "notebooks").glob("*.ipynb")
    )
    assert (robot / "notebooks" / "robot_in_one_page.py").exists()
    for path in (assignment, *chapters):
        text = path.read_text(encoding="utf-8")
        assert "SOLUTION" not in text
        assert "<summary>Solution" not in text
    assert not [*robot.rglob("questions")]  # which compute the keys of the concept questions
    assert (robot / "README.md").read_text("utf-8").count("-r environment.txt -e .") == 2
    code = "import wmrbook.figures, wmrbook.grading.earth, wmrlib; print(wmrlib.__file__)"
    path = {"PYTHONPATH": os.pathsep.join(map(str, (robot, robot / "book", robot / "book/robot")))}
    line = [sys.executable, "-c", code]
    done = subprocess.run(line, cwd=robot, env=os.environ | path, capture_output=True, text=True)
    assert done.stdout.startswith(str(robot)), done.stderr


def test_what_an_assistant_marks_by_stays_with_the_lecturer(tmp_path):
    shutil.copytree(COURSE / "source/ch04", tmp_path / "source/ch04")
    shutil.copy(COURSE / "nbgrader_config.py", tmp_path)
    assert "MARK SCHEME" in (tmp_path / "source/ch04/04_lyapunov.ipynb").read_text("utf-8")
    run("nbgrader generate_assignment ch04", tmp_path)
    release = (tmp_path / "release/ch04/04_lyapunov.ipynb").read_text("utf-8")
    assert "MARK SCHEME" not in release
    assert "misunderstandings" not in release
