"""What an assistant does between two runs of grade.py, and what table and marks then say."""

import contextlib
import os
import shutil
import signal

import damage
import grade
import handins
import nbformat
import pytest
from gradebook import Course
from graded import ROOT, marks
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook, new_output
from sandbox import Limits
from table import Row, table

NAME = "01_a.ipynb"
RIGHT = "def one():\n    return 1"
ESSAY = "Because *so*."


class Sandbox(contextlib.nullcontext):
    """Runs cells in this process, and counts what it has run; each answer that is 2 stops it."""

    runs: list[str] = []  # noqa: RUF012

    def __init__(self, *_):
        super().__init__(self)

    def repaired(self, path, release):
        return handins.repaired(handins.read(path), release)

    def run(self, notebook, student, others, trusted=False):
        self.runs.append(student)
        names: dict = {}
        if "return 2" in notebook.cells[0].source:
            os.kill(os.getpid(), signal.SIGINT)
        for cell in notebook.cells:
            if cell.cell_type == "code":
                try:
                    exec(cell.source, names)
                except Exception as error:
                    why = {"ename": "E", "evalue": str(error), "traceback": ["E"]}
                    cell.outputs = [new_output("error", **why)]
        return notebook


def cell(make, source, name, points=0, **about):
    about = {"schema_version": 3, "grade_id": name, "locked": False, "task": False} | about
    if points:
        about["points"] = points
    return make(source, metadata={"nbgrader": about})


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A course with a task that is checked and one to be marked by hand, and two hand-ins."""
    folder = tmp_path_factory.mktemp("made") / "course"
    (folder / "source" / "ch01").mkdir(parents=True)
    shutil.copy(ROOT / "book/course/nbgrader_config.py", folder)
    solved = RIGHT.replace("return 1", "### BEGIN SOLUTION\n    return 1\n    ### END SOLUTION")
    cells = [
        cell(new_code_cell, solved, "one", grade=False, solution=True),
        cell(new_code_cell, "assert one() == 1", "one-is", 3, grade=True, solution=False),
        cell(new_markdown_cell, "MODEL", "why", 4, grade=True, solution=True),
    ]
    nbformat.write(new_notebook(cells=cells), folder / "source" / "ch01" / NAME)
    with Course(folder) as ours:
        ours.release("ch01")
    for student in "ada", "bob":
        hand_in(folder, student)
    return folder


@pytest.fixture
def course(made, tmp_path, monkeypatch):
    """The same course, anew."""
    monkeypatch.setattr(grade, "Sandbox", Sandbox)
    Sandbox.runs.clear()
    return shutil.copytree(made, tmp_path / "course")


def hand_in(course, student: str, answer: str = RIGHT, essay: str = ESSAY) -> None:
    notebook = nbformat.read(course / "release" / "ch01" / NAME, as_version=4)
    notebook.cells[0].source, notebook.cells[2].source = answer, essay
    damage.hand_in(course, student, "ch01", notebook)


def graded(course, *students, **more) -> dict[str, tuple[str, str]]:
    """{student: (points, what is said)}."""
    rows = grade.grade(course, [], Limits(), 1, students, **more)
    return {row.student: (row.points, row.said) for row in rows}


def marked(course) -> dict[str, str]:
    return {name: row["ch01"] for name, row in marks(course).items()}


def page(course, student: str) -> str:
    return (course / "feedback" / student / "ch01" / "01_a.html").read_text("utf-8")


@contextlib.contextmanager
def grades(course, student: str = "ada"):
    """What an assistant changes in the formgrader."""
    with Course(course) as ours:
        (notebook,) = ours.book.find_submission("ch01", student).notebooks
        yield {each.name: each for each in notebook.grades}
        ours.book.db.commit()


def test_a_text_to_be_marked_by_hand_is_counted_apart_until_it_is_marked(course):
    assert graded(course)["ada"] == ("3/3", "+ 4 to be marked by hand: why")
    assert marked(course)["ada"] == "3"
    with grades(course) as found:
        found["why"].manual_score = 2.5
        found["why"].needs_manual_grade = False
    with Course(course) as ours:
        comment = ours.book.find_comment("why", "01_a", "ch01", "ada")
        comment.manual_comment = "say **more**"
        ours.book.db.commit()
    Sandbox.runs.clear()
    assert graded(course)["ada"] == ("5.5/7", "")
    assert Sandbox.runs == []  # the page and the marks are new, and nothing has run again
    assert "Score: 5.5 / 7" in page(course, "ada")
    assert "say <strong>more</strong>" in page(course, "ada")
    assert marked(course)["ada"] == "5.5"
    assert graded(course, every=True)["ada"] == ("5.5/7", "")
    hand_in(course, "ada", essay="Because of something else.")
    said = "a manual score of an earlier hand-in stands, look at it: why"
    assert graded(course)["ada"] == ("5.5/7", said)
    assert graded(course)["ada"] == ("5.5/7", said)
    with grades(course) as found:
        found["why"].needs_manual_grade = False
    assert graded(course)["ada"] == ("5.5/7", "")


def test_a_manual_score_of_a_check_is_marked_when_another_answer_comes(course):
    hand_in(course, "ada", "one = None")
    assert graded(course)["ada"][0] == "0/3"
    with grades(course) as found:
        found["one-is"].manual_score = 1
    hand_in(course, "ada")
    said = "a manual score of an earlier hand-in stands, look at it: one-is"
    assert graded(course)["ada"] == ("1/3", f"+ 4 to be marked by hand: why; {said}")
    hand_in(course, "ada", essay="YOUR ANSWER HERE")
    assert graded(course)["ada"] == ("1/7", said)


def test_table_page_and_marks_agree_on_lateness_and_follow_the_policy(course):
    (course / "term.toml").write_text("[due]\nch01 = 2026-11-03")
    stamp = course / "submitted" / "ada" / "ch01" / "timestamp.txt"
    stamp.write_text("2026-11-04 10:00:00 UTC")
    assert graded(course)["ada"] == ("3/3", "+ 4 to be marked by hand: why")
    (course / "term.toml").write_text("[due]\nch01 = 2026-11-03\n[late]\nper_day = 1.0")
    points, said = graded(course)["ada"]
    assert (points, "3 points off for lateness" in said) == ("0/3", True)
    assert marked(course) == {"ada": "0", "bob": "3"}
    assert "(Score: 0 / 7)" in page(course, "ada")
    stamp.unlink()
    assert graded(course)["ada"][0] == "3/3"
    assert marked(course)["ada"] == "3"


def test_only_what_has_changed_is_graded_again(course, monkeypatch):
    graded(course)
    assert sorted(Sandbox.runs) == ["ada", "bob", "model"]

    def ran(*students, **more) -> list[str]:
        Sandbox.runs.clear()
        graded(course, *students, **more)
        return sorted(Sandbox.runs)

    assert ran() == []
    hand_in(course, "bob", "one = 3")
    assert ran("ada") == []
    assert ran("bob") == ["bob", "model"]
    assert ran("ada", every=True) == ["ada", "model"]
    (course / "submitted/ada/ch01/timestamp.txt").write_text("2026-11-04 10:00:00 UTC")
    assert ran() == ["ada", "model"]
    monkeypatch.setattr(grade, "sources", lambda: "another wmrlib")
    assert ran() == ["ada", "bob", "model"]
    shutil.rmtree(course / "autograded" / "ada")
    assert ran() == ["ada", "model"]
    (course / "gradebook.db").unlink()
    assert ran() == ["ada", "bob", "model"]
    with pytest.raises(SystemExit, match="no hand-in of eve: there are those of ada, bob"):
        graded(course, "eve")


def test_what_is_refused_later_says_that_earlier_points_stand(course):
    graded(course)
    (course / "submitted/ada/ch01" / NAME).write_text("")
    points, said = graded(course)["ada"]
    assert (points, said.endswith("is empty; the points of an earlier hand-in stand")) == ("", True)
    assert marked(course)["ada"] == "3"
    place = course / "submitted" / "eve" / "ch01"
    place.mkdir(parents=True)
    assert "earlier" not in graded(course)["eve"][1]


def test_ctrl_c_keeps_what_is_graded_and_writes_the_marks(course):
    for student in "carl", "dora", "zed":
        hand_in(course, student, "def one():\n    return 2" if student == "carl" else RIGHT)
    with pytest.raises(KeyboardInterrupt, match=r"Stopped: \d of 5 hand-ins are graded") as stopped:
        graded(course)
    done = int(str(stopped.value).split()[1])
    assert done < 5
    assert len(marked(course)) == done
    hand_in(course, "carl")
    Sandbox.runs.clear()
    assert len(graded(course)) == 5
    assert len(Sandbox.runs) == 5 - done + 1  # and the model


def test_with_a_roster_the_marks_are_those_of_its_students(course):
    lines = "username,name,id", "ada,Ada Lovelace,123", "cy,Cy,"
    (course / "students.csv").write_text("\n".join(lines))
    assert graded(course)["bob"][1].startswith("not in students.csv and not in the marks; ")
    assert marked(course) == {"ada": "3", "cy": ""}
    rows = marks(course, "canvas")
    assert (rows["ada"]["Student"], rows["ada"]["ID"]) == ("Ada Lovelace", "123")
    assert (rows["cy"]["Student"], rows["cy"]["ID"], rows["cy"]["ch01"]) == ("Cy", "", "")
    (course / "students.csv").write_text("name\nada")
    with pytest.raises(ValueError, match="username is needed"):
        graded(course)


def test_the_table_prints_nothing_that_moves_the_cursor_or_turns_letters():
    bad = "\x1b[2J\x1b]0;title\x07\u202e11/11\u2066\r\x9b1A\n\nx\ud800"
    text = table([Row("ch01", bad, "0/3", bad)])
    assert len(text.splitlines()) == 3
    assert not {"\x1b", "\x07", "\u202e", "\u2066", "\r", "\x9b", "\ud800"} & {*text}
    assert "\ufffd11/11" in text
