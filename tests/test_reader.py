"""What a reader does with the core chapters: types their cells, and changes a number in one."""

from __future__ import annotations

import ast
import warnings
from itertools import cycle
from pathlib import Path

import matplotlib.pyplot as plt
import nbformat
import pytest

NOTEBOOKS = Path(__file__).parent.parent / "notebooks"
CHAPTERS = sorted(NOTEBOOKS.glob("0[0-5]_*.ipynb"))
FACTORS = (1.25, 0.8, 2.0)
CHANGED = 3  # cells of a chapter
SLOW = {"01", "02"}  # tried with the slow tests
ADVICE = ("not allowed", "needed", "must", "at least", "at most")  # a message that says why


def cells_of(path):
    """Return the cells that a reader runs: their text, and whether the book shows it."""
    cells = nbformat.read(path, as_version=4).cells
    code = [cell for cell in cells if cell.cell_type == "code"]
    runs = [it for it in code if "skip-execution" not in it.metadata.get("tags", ())]
    folded = {"hide-cell", "hide-input", "remove-cell", "remove-input"}
    return [(it.source, not folded & {*it.metadata.get("tags", ())}) for it in runs]


def numbers(source):
    """Return the numbers with a point that stand in a cell, without powers, checks and texts."""
    skipped = (ast.Assert, ast.JoinedStr)
    waiting, places = [ast.parse(source)], []
    while waiting:
        node = waiting.pop(0)
        if isinstance(node, ast.Constant) and type(node.value) is float and node.value:
            places.append(node)
        below = [it for it in ast.iter_child_nodes(node) if not isinstance(it, skipped)]
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow):
            below = [node.left]
        waiting += below
    return places


def with_another(source, number, factor):
    """Return a cell in which one number is larger or smaller."""
    lines = source.splitlines(keepends=True)
    line = lines[number.lineno - 1].encode()
    new = repr(round(factor * number.value, 6)).encode()
    lines[number.lineno - 1] = (
        line[: number.col_offset] + new + line[number.end_col_offset :]
    ).decode()
    return "".join(lines)


def run(source, names):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        exec(compile(source, "<cell>", "exec"), names)
    plt.close("all")


def reason(source, below, names):
    """Run a changed cell and what stands below it, as far as the next folded check.

    Returns what it says against the number, or nothing where all of it runs.
    """
    try:
        run(source, names)
        for text, shown in below:
            run(text, names)
            if not shown:
                break
    except (AssertionError, ValueError) as error:
        return error
    return None


def explains(error):
    """Return whether an error is a sentence that helps a reader."""
    if error is None:
        return True
    if isinstance(error, ValueError):
        return any(word in str(error) for word in ADVICE)
    return len(str(error).split()) >= 4


@pytest.fixture
def at_home(monkeypatch):
    monkeypatch.chdir(NOTEBOOKS)
    monkeypatch.setattr("builtins.display", lambda *shown, **options: None, raising=False)


@pytest.mark.parametrize(
    "path",
    [pytest.param(it, marks=[pytest.mark.slow] * (it.stem[:2] in SLOW)) for it in CHAPTERS],
    ids=lambda path: path.stem,
)
def test_a_changed_number_runs_or_is_told_why_not(path, at_home):
    cells, names = cells_of(path), {"__name__": "__main__"}
    some = [k for k, (source, shown) in enumerate(cells) if shown and numbers(source)]
    some = dict(zip(some[:: max(1, len(some) // CHANGED)], cycle(FACTORS), strict=False))
    for k, (source, _) in enumerate(cells):
        if factor := some.get(k):
            text = with_another(source, numbers(source)[0], factor)
            error = reason(text, cells[k + 1 :], dict(names))
            assert explains(error), f"{text}\n{error!r}"
        run(source, names)
