"""Code that stands in a text runs; a notebook without answers runs to its end."""

import ast
import json
import re

import nbformat
import pytest
from assignments import ASSIGNMENTS, ROOT, given, notebook, released, tasks

PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "book").glob("*.md"))]
CHAPTERS = sorted((ROOT / "notebooks").glob("*.ipynb"))
TASKS = [notebook(chapter) for chapter in ASSIGNMENTS]
NAMES = """
from scipy.special import exprel
from decimal import Decimal
import numpy as np, sympy as sp
import wmrbook, wmrbook.data, wmrlib, wmrlib as wmr
from wmrbook import stages
from wmrbook.chapters import challenge
from wmrbook.panel import Explorer
starts, goals, gains = wmr.Pose([5.0, 6.0], 1.0, 0.0), wmr.Pose(0.0, 0.0, 0.0), wmr.GENTLE_GAINS
paper = wmr.paper
explorer, x, y, heading, goal = Explorer(), 1.0, 2.0, 0.3, goals
start = wmr.Pose(5.0, 1.0, 0.0)
seed = 2026
"""


def text(path) -> str:
    """What is read, without the cells of a page that is itself run."""
    words = path.read_text(encoding="utf-8")
    if path.suffix == ".ipynb":
        cells = json.loads(words)["cells"]
        words = "\n\n".join("".join(c["source"]) for c in cells if c["cell_type"] == "markdown")
    return re.sub(r"```\{.*?```", "", words, flags=re.DOTALL)


def calls(words: str) -> list[str]:
    """The expressions between backticks that call something, with no part left open as `...`."""
    matches = []
    for code in re.findall(r"`([^`]+)`", re.sub(r"```.*?```", "", words, flags=re.DOTALL)):
        try:
            nodes = list(ast.walk(ast.parse(" ".join(code.split()))))
        except SyntaxError:
            continue
        is_open = any(isinstance(node, ast.Constant) and node.value is ... for node in nodes)
        if any(isinstance(node, ast.Call) for node in nodes) and not is_open:
            matches.append(" ".join(code.split()))
    return matches


@pytest.mark.parametrize("path", [*PAGES, *CHAPTERS, *TASKS], ids=lambda path: path.stem)
def test_code_in_a_text_runs(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    names = {}
    exec(NAMES, names)
    if path in TASKS:
        names |= given(path.parent.name)
    for code in re.findall(r"```python\n(.*?)```", text(path), flags=re.DOTALL) + calls(text(path)):
        exec(code, names)


@pytest.mark.parametrize("chapter", ASSIGNMENTS)
def test_cells_that_fail_without_an_answer_do_not_stop_the_others(chapter):
    """Jupyter goes on after a cell with this tag; nbgrader sees its error all the same."""
    names, failed = {"__name__": "__main__"}, 0
    for cell in nbformat.read(notebook(chapter), as_version=4).cells:
        if cell.cell_type == "code":
            try:
                exec(released(cell.source), names)
            except Exception:
                assert "raises-exception" in cell.metadata.tags
                failed += 1
    assert failed >= sum(len(task.checks) for task in tasks(chapter))
