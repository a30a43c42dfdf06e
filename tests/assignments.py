"""The assignments of the course, run in this process as a student's notebook runs them."""

import contextlib
import json
import re
from functools import cache
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
ASSIGNMENTS = sorted(path.name for path in (ROOT / "book/course/source").glob("ch*"))
STUB = 'raise NotImplementedError("write your answer here")'
BEGIN, END = "### BEGIN SOLUTION", "### END SOLUTION"


class Task(NamedTuple):
    """A cell with an answer, by its id, and the cells that check it, {id: source}."""

    name: str
    model: str
    checks: dict[str, str]

    @property
    def target(self) -> str:
        """The name that the answer gives a value to."""
        return re.match(r"(?:def )?(\w+)", self.model)[1]


def notebook(chapter: str) -> Path:
    """The lecturer's notebook, with the model answers."""
    (path,) = (ROOT / "book/course/source" / chapter).glob("*.ipynb")
    return path


@cache
def tasks(chapter: str) -> list[Task]:
    """The tasks of an assignment that checks grade."""
    listed: list[Task] = []
    for name, source in _code(chapter).items():
        if BEGIN in source:
            listed.append(Task(name, source, {}))
        elif source.startswith("print(grading."):
            listed[-1].checks[name] = source
    return [task for task in listed if task.checks]


@cache
def given(chapter: str) -> dict:
    """The names that the notebook's other cells make, which no check and no answer is in."""
    names = {"__name__": "__main__"}
    for name, source in _code(chapter).items():
        if BEGIN not in source and not source.startswith("print(grading."):
            run_cell(source, f"<{chapter} {name}>", names)
    return names


def failed(chapter: str, task: Task, answer: str) -> dict[str, str]:
    """What the checks of a task say that fail with this answer, {id: error}."""
    names, errors = dict(given(chapter)), {}
    with contextlib.suppress(Exception):  # an answer that stops fails its checks
        run_cell(answer, f"<{chapter} {task.name}>", names)
    for name, source in task.checks.items():
        try:
            run_cell(source, f"<{chapter} {name}>", names)
        except Exception as error:
            errors[name] = f"{type(error).__name__}: {error}"
    return errors


def released(source: str) -> str:
    """What a student gets in the place of a cell with an answer."""
    before, begin, rest = source.partition(BEGIN)
    return before + STUB + rest.partition(END)[2] if begin else source


def run_cell(source: str, name: str, names: dict) -> None:
    exec(compile(source, name, "exec"), names)


def _code(chapter: str) -> dict[str, str]:
    """The code cells by their ids."""
    cells = json.loads(notebook(chapter).read_text(encoding="utf-8"))["cells"]
    code = [cell for cell in cells if cell["cell_type"] == "code"]
    return {it["metadata"]["nbgrader"]["grade_id"]: "".join(it["source"]) for it in code}
