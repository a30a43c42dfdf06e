"""The assignments' cells and the usual wrong answers to them, and what a student would see; without Jupyter, so that it is quick."""

import re
import tomllib
from functools import cache
from pathlib import Path

import nbformat

ROOT = Path(__file__).parent.parent
CHAPTERS = sorted(path.name for path in (ROOT / "book" / "course" / "source").iterdir())
STUB = 'raise NotImplementedError("write your answer here")'


@cache
def cells(chapter: str) -> tuple[tuple[str, str, bool], ...]:
    """(name, source, graded) of each code cell of the chapter's assignment, with the model answers."""
    (path,) = (ROOT / "book" / "course" / "source" / chapter).glob("*.ipynb")
    code = [cell for cell in nbformat.read(path, 4).cells if cell.cell_type == "code"]
    return tuple((cell.metadata.nbgrader.grade_id, cell.source, cell.metadata.nbgrader.grade) for cell in code)


def released(source: str) -> str:
    """A cell as students get it."""
    return re.sub(r"(?ms)^( *)### BEGIN SOLUTION.*?### END SOLUTION", rf"\1{STUB}", source)


def wrong_answers(chapter: str) -> list[dict]:
    return tomllib.loads((ROOT / "tests" / "data" / "course" / f"{chapter}.toml").read_text())["answer"]


def marked(chapter: str, change=lambda name, source: source) -> tuple[dict[str, str], dict[str, str]]:
    """What the graded cells say after `change` of each cell's source: the sentences of those that pass, and of those that do not."""
    passed, failed, names = {}, {}, {}
    for name, source, graded in cells(chapter):
        try:
            if graded:
                passed[name] = repr(eval(source, names))
            else:
                exec(compile(change(name, source), name, "exec"), names)
        except (AssertionError, NotImplementedError, NameError) as error:
            if graded:
                failed[name] = str(error)
    return passed, failed
