"""A course of one's own, and ways in which a hand-in is damaged and what it is then worth."""

from __future__ import annotations

import copy
import json
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path

import nbformat
from cells import nbgrader
from nbformat import NotebookNode

COURSE = Path(__file__).parents[1] / "book" / "course"
CELL = nbformat.v4.new_code_cell
LEFT = """import subprocess, sys, threading, time
subprocess.Popen([sys.executable, "-c", "import time; time.sleep(1000)  # left"],
                 start_new_session=True)
threading.Thread(target=time.sleep, args=(1000,)).start()"""
DEADLY = {  # what cells of a student's own do, and what the table then says, in this order
    "import os; os._exit(0)": "it ended Python",
    "print('x' * 200_000_000)": "it printed more than 10 MB",
    "x = bytearray(10**11)": "",
    "from IPython.display import display; display({'text/plain': {1, 2}}, raw=True)": "no output",
    "import time; time.sleep(1000)": "it took over",
    LEFT: "",
}
CHEATS = """
import builtins, inspect, math, sys, types
import wmrbook.grading, wmrbook.grading.earth
right = lambda *answers: "all is well"
class Fake(types.ModuleType):
    def __getattr__(self, name):
        return self if name.islower() and "_" not in name else right
grading = Fake("grading")
for name in [each for each in sys.modules if each.startswith("wmrbook.grading")]:
    for key in [each for each in vars(sys.modules[name]) if each[:8] in ("distance", "expect")]:
        setattr(sys.modules[name], key, right)
wmrbook.grading = sys.modules["wmrbook.grading"] = sys.modules["grading"] = grading
sys.modules["wmrbook.grading.earth"] = grading
get_ipython().run_code = lambda *_, **__: None
get_ipython().showtraceback = lambda *_, **__: None
get_ipython().ast_node_interactivity = "none"
print = lambda *_: builtins.print("58.08 m between the paper's two points, and right elsewhere.")
builtins.AssertionError = builtins.Exception
math.isclose = math.isfinite = lambda *_, **__: True
def distance(*_): return 58.0
"""
LIARS = """
import os, wmrbook.grading._wire as wire
class Anything(float):
    def __eq__(self, other): return True
    __lt__ = __le__ = __gt__ = __ge__ = __ne__ = __eq__
    __sub__ = __rsub__ = __add__ = __radd__ = __mul__ = __truediv__ = lambda self, _: Anything(0)
    __reduce__ = lambda self: (os.system, ("touch /tmp/reached",))
def serve(path, names):
    from multiprocessing.connection import Client
    with Client(path) as link:
        for reply in REPLIES:
            link.recv_bytes()
            link.send_bytes(reply)
REPLIES = [
    b'{"value": {"function": 0, "called": "distance"}}', b'{"value": true}', b'{"value": 58.0}',
    b'{"value": {"pickled": "gASVHgAAAAAAAACMBXBvc2l4lIwGc3lzdGVtlJOUjAR0cnVllIWUUpQu"}}',
    b'{"hint": "58.08 m, and right elsewhere."}',
]
wire.serve = serve
def distance(*_): return Anything(58)
"""


def empty_course(folder: Path, *chapters: str) -> Path:
    """The folder of a course, with these chapters or all, of whom nobody has handed in."""
    made = shutil.ignore_patterns("release", "submitted", "autograded", "feedback", "*.db", "*.zip")
    course = shutil.copytree(COURSE, folder / "course", ignore=made)
    for source in course.glob("source/ch*"):
        if chapters and source.name not in chapters:
            shutil.rmtree(source)
    return course


def command(name: str, course: Path, *arguments: str | Path) -> str:
    """Run a command of the course; return what it prints."""
    line = [sys.executable, COURSE / name, "--course", course, *arguments]
    done = subprocess.run(line, capture_output=True, text=True, timeout=900)
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


def answers(notebook: NotebookNode) -> list[int]:
    """Where the answers are."""
    return [k for k, cell in enumerate(notebook.cells) if nbgrader(cell).get("solution")]


def graded_answers(notebook: NotebookNode) -> list[int]:
    """Where the answers are that a check follows: a name is an answer too."""
    graded, ours = checks(notebook), sorted([*answers(notebook), *checks(notebook)])
    return [k for k, after in pairwise(ours) if k not in graded and after in graded]


def checks(notebook: NotebookNode) -> list[int]:
    """Where the checks are; an answer that an assistant marks is none."""
    graded = [k for k, cell in enumerate(notebook.cells) if nbgrader(cell).get("grade")]
    return [k for k in graded if not nbgrader(notebook.cells[k])["solution"]]


def copied(notebook: NotebookNode, places: list[int]) -> None:
    """Copy cells as `c` and `v` do in JupyterLab."""
    for place in reversed(places):
        notebook.cells.insert(place + 1, copy.deepcopy(notebook.cells[place]))


def split(notebook: NotebookNode, keep: bool) -> None:
    """Split each answer after its first line."""
    for place in reversed(answers(notebook)):
        first = notebook.cells[place]
        head, _, tail = first.source.partition("\n")
        second = copy.deepcopy(first) if keep else CELL()
        first.source, second.source = head, tail
        notebook.cells[place + 1 : place + 1] = [second] * bool(tail)


def stripped(notebook: NotebookNode) -> None:
    """Take away all metadata, and the cells' ids."""
    for k, cell in enumerate(notebook.cells):
        cell.metadata, cell.id = {}, f"new-{k}"


def without(notebook: NotebookNode, places: list[int]) -> None:
    """Delete cells."""
    notebook.cells = [cell for k, cell in enumerate(notebook.cells) if k not in places]


def other_kind(notebook: NotebookNode) -> None:
    """Turn each answer into text."""
    for place in answers(notebook):
        cell = notebook.cells[place]
        notebook.cells[place] = nbformat.v4.new_markdown_cell(cell.source, metadata=cell.metadata)


def merged(notebook: NotebookNode) -> None:
    """Merge each answer into the check below it."""
    for place in reversed(graded_answers(notebook)):
        check = next(k for k in checks(notebook) if k > place)
        notebook.cells[check].source = f"{notebook.cells[place].source}\n"
        del notebook.cells[place]


def gathered(notebook: NotebookNode) -> None:
    """Move the answers into the first of them, and delete their cells."""
    first, *others = graded_answers(notebook)
    texts = [notebook.cells[place].source for place in (first, *others)]
    notebook.cells[first].source = "\n\n\n".join(texts)
    without(notebook, others)


EDITS: dict[str, tuple[Callable[[NotebookNode], object], str]] = {  # the program stays the same
    "sound": (lambda n: None, ""),
    "check copied": (lambda n: copied(n, checks(n)), "copies dropped"),
    "answer copied": (lambda n: copied(n, answers(n)), "copies dropped"),
    "split": (lambda n: split(n, True), "parts joined"),
    "split and stripped": (lambda n: split(n, False), ""),
    "checks deleted": (lambda n: without(n, checks(n)), "put back"),
    "stripped": (stripped, "found without"),
    "not code": (other_kind, "was not a code cell"),
    "merged": (merged, "found without"),
}


def hand_in(
    folder: Path, student: str, assignment: str, content: NotebookNode | str | bytes, name: str = ""
) -> None:
    """Write a file into the folder submitted/ of a course, under the name of the notebook."""
    (source,) = (folder / "source" / assignment).glob("*.ipynb")
    path = folder / "submitted" / student / assignment / (name or source.name)
    path.parent.mkdir(parents=True, exist_ok=True)
    text = json.dumps(content) if isinstance(content, NotebookNode) else content
    path.write_bytes(text if isinstance(text, bytes) else text.encode())


def damaged(solved: NotebookNode, other: NotebookNode) -> Iterator[tuple[str, object, str, str]]:
    """Yield hand-ins that must run to show: student, content, points, what the table must say.

    points: "all", "less" by the first task's, or "" for what is refused.
    """

    def by(student: str) -> NotebookNode:
        notebook = copy.deepcopy(solved)
        for cell in notebook.cells:  # some tasks have numbers of the student's own
            if cell.source.startswith('name = "'):
                cell.source = f'name = "{student}"'
        return notebook

    yield "renamed", by("renamed"), "all", "was named"
    gathered(notebook := by("all in one"))
    yield "all in one", notebook, "all", "is in another cell"
    (notebook := by("deadly")).cells[:0] = map(CELL, DEADLY)
    yield "deadly", notebook, "all", ".*".join(filter(None, DEADLY.values()))
    first = (notebook := by("exit")).cells[graded_answers(notebook)[0]]
    first.source = f"exit()\n{first.source}"
    yield "exit", notebook, "less", "it ended Python"
    without(notebook := by("answer deleted"), graded_answers(notebook)[:1])
    yield "answer deleted", notebook, "less", "is missing"
    yield "cut", nbformat.writes(solved)[:1000], "", "is no notebook"
    yield "no cells", '{"nbformat": 4, "nbformat_minor": 5, "metadata": {}}', "", "is no notebook"
    yield "of another", other, "", "not of this assignment"
    yield "no file", "print()", "", "no notebook in its folder"


def rows(text: str) -> dict[tuple[str, str], str]:
    """The table of grade.py as {(assignment, student): points and what is said}."""
    lines = text.splitlines()[:-1]
    while lines[0].split() != ["student", "points"]:
        del lines[0]  # what this machine can't do
    header = lines.pop(0)
    student, points = header.index("student"), header.index("points")
    return {(r[:student].strip(), r[student:points].strip()): r[points:] for r in lines}


def faults(rows: dict, expected: dict[tuple[str, str], tuple[str, str]]) -> list[str]:
    """What a table says otherwise than expected."""
    less = next(rows[it][:6].strip() for it in expected if it[1] == "answer deleted")
    worths = {"all": "/".join(2 * [less.partition("/")[2]]), "less": less, "": ""}
    wrong = [f"an answer costs nothing: {less}"] * (less == worths["all"])
    for who, (worth, said) in expected.items():
        row = rows.get(who, "no row")
        if row[:6].strip() != worths[worth] or not re.search(said, row):
            wrong.append(f"{who}: {row!r} where {worths[worth]!r} and {said!r} are wanted")
    return wrong
