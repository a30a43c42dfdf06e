"""The graded tasks of book/course that a page checks, and the notebook that hands them in.

A task is its text, the cell to fill in, and the checks with their hints. The notebook that a page
makes is what students are given, with the answers of the page in its cells.
"""

from __future__ import annotations

import re
from pathlib import Path

import nbformat
from nbgrader.preprocessors import ClearHiddenTests, ClearMarkScheme, ClearSolutions
from traitlets.config.loader import PyFileConfigLoader

SOURCE = Path(__file__).resolve().parents[1] / "course" / "source"
CHAPTER = re.compile(r"notebooks/(\d\d)_")
# The graded tasks that are right in the page too, by the id of the cell to fill in.
TASKS = {
    "01": ("distance", "bearing", "local"),
    "02": ("wheels", "twist", "arc", "limited"),
    "03": ("polar", "tail-model", "our-gains"),
    "04": ("V-rate", "turning", "V-rate-closed", "rising"),
    "05": ("law", "axes"),
    "07": ("law", "twist"),
    "09": ("radius", "averaging"),
    "10": ("claim23", "claim26", "rule", "digits"),
    "11": ("compass", "ticks", "safe"),
    "12": ("checksum", "degrees", "headings"),
    "14": ("distance", "joined"),
}
SOLUTION = re.compile(r"( *)### BEGIN SOLUTION\n.*?### END SOLUTION\n?", re.DOTALL)
STUB = 'raise NotImplementedError("write your answer here")\n'
ABOUT = (
    "Graded tasks of the course, with its hints. "
    "This page has `math`, `sympy` and a part of `numpy`, which says what it lacks."
)
LATER = "*The check of this one is too much for a page: it runs when you hand in.*"


def add_tasks(app, docname, source):
    """Put a chapter's tasks below its exercises."""
    chapter = CHAPTER.match(docname)
    if chapter and (added := tasks(chapter[1])):
        notebook = nbformat.reads(source[0], as_version=4)
        headings = [i for i, cell in enumerate(notebook.cells) if cell.source.startswith("## ")]
        exercises = next(i for i in headings if notebook.cells[i].source.startswith("## Exercises"))
        end = next((i for i in headings if i > exercises), len(notebook.cells))
        notebook.cells[end:end] = added
        source[0] = nbformat.writes(notebook)


def tasks(chapter: str) -> list:
    """Return the chapter's tasks as cells of a notebook, without their solutions."""
    if not (path := _path(chapter)):
        return []
    text, mine, setup, cells = "", "", [], {}
    for cell in nbformat.read(path, 4).cells:
        settings = cell.metadata["nbgrader"]
        if cell.cell_type == "markdown":
            text = cell.source.replace("## Task", "### Task")
        elif "### Task" not in text and not cells:
            setup.append(SOLUTION.sub("", cell.source))  # the imports, and the student's name
        elif settings["grade_id"] == "mine":
            mine = setup[1] + cell.source
        elif SOLUTION.search(cell.source):
            code = mine, SOLUTION.sub(_stub, cell.source)
            cells[settings["grade_id"]], mine = (text, code, checks := []), ""
        elif settings["grade"]:
            checks.append(cell.source)
    made, shown = [], ""
    for name, (text, (mine, answer), checks) in cells.items():
        later = name not in TASKS.get(chapter, ())
        about = [text] * (text != shown) + [ABOUT] * (not made) + [LATER] * later
        made.append(nbformat.v4.new_markdown_cell("\n\n".join(about)))
        shown = text
        parts = (
            ("mine", mine, "from wmrbook import grading", [], False),
            (name, answer, setup[0], checks * (not later), later),
        )
        for key, source, before, graded, unchecked in parts:
            if source:
                code = nbformat.v4.new_code_cell(source.strip("\n"))
                told = {"before": before, "checks": graded, "name": key, "later": unchecked}
                code.metadata["task"] = told
                made.append(code)
    return [cell for cell in made if cell.source]


def _stub(solution: re.Match) -> str:
    return solution[1] and solution[1] + STUB  # in a function something must stand


def handed_in(chapter: str) -> dict | None:
    """Return the notebook in which a page hands its answers in, as students are given it.

    With the name of its file, and the titles of the tasks that the page has not. None where the
    course has no assignment.
    """
    if not (path := _path(chapter)):
        return None
    here = {cell.metadata["task"]["name"] for cell in tasks(chapter) if "task" in cell.metadata}
    notebook, title, elsewhere = nbformat.read(path, 4), "", []
    for cell in notebook.cells:
        name = cell.metadata["nbgrader"]["grade_id"]
        title = (re.findall(r"^## (Task .*)", cell.source) or [title])[0]
        if cell.metadata["nbgrader"]["solution"] and name not in here | {"name"}:
            elsewhere.append(title)
    settings = PyFileConfigLoader("nbgrader_config.py", str(SOURCE.parent)).load_config()
    for step in ClearSolutions, ClearMarkScheme, ClearHiddenTests:
        notebook, _ = step(config=settings).preprocess(notebook, {})
    elsewhere = list(dict.fromkeys(elsewhere))
    return {"file": path.name, "notebook": notebook, "elsewhere": elsewhere}


def _path(chapter: str) -> Path | None:
    folder = SOURCE / f"ch{chapter}"
    if not folder.is_dir():
        return None
    (path,) = folder.glob("*.ipynb")
    return path
