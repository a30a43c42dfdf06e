"""Ways in which a hand-in is damaged, and what it is then worth."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable, Container
from itertools import pairwise
from pathlib import Path

import nbformat
from nbformat import NotebookNode

CELL = nbformat.v4.new_code_cell
DEADLY = {  # what an answer's cell does before anything else, and what the table then says of it
    "exit": ("import os; os._exit(0)", "it ended Python"),
    "quits": ("exit()", "it ended Python"),
    "segfault": ("import ctypes; ctypes.string_at(0)", "it ended Python"),
    "killed": ("import os, signal; os.kill(os.getpid(), signal.SIGTERM)", "it ended Python"),
    "flood": ("print('x' * 200_000_000)", "it printed more than 10 MB"),
    "memory": ("x = bytearray(10**11)", ""),
    "shared memory": (
        "import os, time\nfor _ in range(5):\n    if not os.fork():\n"
        "        x = b'x' * 10**9\n        time.sleep(1000)\ntime.sleep(1000)",
        "it took more than 4 GB",
    ),
    "odd output": (
        "from IPython.display import display; display({'text/plain': {1, 2}}, raw=True)",
        "it shows is no output",
    ),
    "endless": ("import time; time.sleep(1000)", "it took over"),
}
LEFT = """import subprocess, sys, threading, time
subprocess.Popen([sys.executable, "-c", "import time; time.sleep(1000)  # left"],
                 start_new_session=True)
threading.Thread(target=time.sleep, args=(1000,)).start()"""


def answers(notebook: NotebookNode) -> list[int]:
    """Where the answers are."""
    return [k for k, cell in enumerate(notebook.cells) if _nbgrader(cell).get("solution")]


def graded_answers(notebook: NotebookNode) -> list[int]:
    """Where the answers are that a check follows: a name is an answer too."""
    graded, ours = checks(notebook), sorted([*answers(notebook), *checks(notebook)])
    return [k for k, after in pairwise(ours) if k not in graded and after in graded]


def checks(notebook: NotebookNode) -> list[int]:
    """Where the checks are; an answer that an assistant marks is none."""
    graded = [k for k, cell in enumerate(notebook.cells) if _nbgrader(cell).get("grade")]
    return [k for k in graded if not _nbgrader(notebook.cells[k])["solution"]]


def _nbgrader(cell: NotebookNode) -> dict:
    return cell.metadata.get("nbgrader", {})


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


def first_answer(notebook: NotebookNode, change: Callable[[str], str]) -> None:
    """Change the text of the first answer."""
    cell = notebook.cells[graded_answers(notebook)[0]]
    cell.source = change(cell.source)


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


def gathered(notebook: NotebookNode, keep: int) -> None:
    """Move the answers into the first of them, but as many as are kept, and delete their cells."""
    first, *others = graded_answers(notebook)
    moved = others[: len(others) - keep]
    texts = [notebook.cells[place].source for place in (first, *moved)]
    notebook.cells[first].source = "\n\n\n".join(texts)
    without(notebook, moved)


def imports_moved(notebook: NotebookNode) -> None:
    """Write an import that the first answer needs into the given cell above it."""
    given = next(cell for cell in notebook.cells if cell.cell_type == "code")
    given.source += "\nimport base64 as of_mine"
    first_answer(notebook, lambda answer: f"of_mine.b64encode\n{answer}")


EDITS: dict[str, tuple[Callable[[NotebookNode], object], str]] = {  # graded in full
    "sound": (lambda n: None, ""),
    "check copied": (lambda n: copied(n, checks(n)), "copies dropped"),
    "answer copied": (lambda n: copied(n, answers(n)), "copies dropped"),
    "all copied": (lambda n: copied(n, [*range(len(n.cells))]), "copies dropped"),
    "split": (lambda n: split(n, True), "parts joined"),
    "split and stripped": (lambda n: split(n, False), ""),
    "checks deleted": (lambda n: without(n, checks(n)), "put back"),
    "stripped": (stripped, "found without"),
    "not code": (other_kind, "was not a code cell"),
    "merged": (merged, "found without"),
    "all in one": (lambda n: gathered(n, 0), "is in another cell"),
    "one moved": (lambda n: gathered(n, 1), "is in another cell"),
    "given cell changed": (imports_moved, ""),
    "left running": (lambda n: first_answer(n, lambda a: f"{LEFT}\n{a}"), ""),
}


def hand_in(folder: Path, student: str, assignment: str, name: str, text: str | bytes) -> None:
    """Write a file into the folder submitted/ of a course."""
    path = folder / "submitted" / student / assignment / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(text if isinstance(text, bytes) else text.encode())


def hand_in_all(
    folder: Path, assignment: str, solved: NotebookNode, other: NotebookNode, but: Container = ()
) -> dict:
    """Hand in each damage `but` some; return {student: what the table must say}, (points, text).

    points: "all", "less" by the first task's, or "" for what is refused.
    """
    (name,) = (path.name for path in (folder / "source" / assignment).glob("*.ipynb"))
    expected = {}

    def put(student: str, notebook: NotebookNode | str | bytes, points: str, said: str, name=name):
        if student in but:
            return
        text = json.dumps(notebook) if isinstance(notebook, NotebookNode) else notebook
        hand_in(folder, student, assignment, name, text)
        expected[student] = points, said

    def by(student: str) -> NotebookNode:
        notebook = copy.deepcopy(solved)
        for cell in notebook.cells:  # some tasks have numbers of the student's own
            if cell.source.startswith('name = "'):
                cell.source = f'name = "{student}"'
        return notebook

    for student, (edit, said) in EDITS.items():
        damaged = by(student)
        edit(damaged)
        put(student, damaged, "all", said)
    for student, (line, said) in DEADLY.items():
        damaged = by(student)
        first_answer(damaged, lambda answer, line=line: f"{line}\n{answer}")
        put(student, damaged, "less", said)
    damaged = by("answer deleted")
    without(damaged, graded_answers(damaged)[:1])
    put("answer deleted", damaged, "less", "is missing")
    whole = nbformat.writes(solved)
    put("renamed", by("renamed"), "all", "was named", name.replace(".", " (1)."))
    marked = b"\xef\xbb\xbf" + json.dumps(by("with a mark")).encode()
    put("with a mark", marked, "all", "")
    put("empty", "", "", "is empty")
    put("cut", whole[: len(whole) // 2], "", "is no notebook")
    put("no json", "<!DOCTYPE html>", "", "is no notebook")
    put("no cells", json.dumps({"nbformat": 4, "nbformat_minor": 5, "metadata": {}}), "", "is no")
    put("of another", other, "", "not of this assignment")
    put("no file", "print()", "", "no notebook in its folder", "answers.py")
    return expected


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
    less = {a: rows[a, s][:6].strip() for a, s in expected if s == "answer deleted"}
    most = {a: "/".join(2 * [points.partition("/")[2]]) for a, points in less.items()}
    wrong = []
    for (assignment, who), (worth, said) in expected.items():
        row = rows.get((assignment, who), "no row")
        wanted = {"all": most, "less": less, "": {}}[worth].get(assignment, "")
        if row[:6].strip() != wanted or said not in row or less[assignment] == most[assignment]:
            wrong.append(f"{assignment}, {who}: {row!r} where {wanted!r} and {said!r} are wanted")
    return wrong
