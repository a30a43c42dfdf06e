"""Python in the pages: cells run with sympy alone, and give what the notebooks store."""

import json
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest
import sympy as sp
from plain_symbolic import BY_LAW
from python_cells import runnable
from python_pack import IN_PAGE, own_files

from wmrlib import symbolic

ROOT = Path(__file__).resolve().parents[1]
NOTEBOOKS = sorted((ROOT / "notebooks").glob("[0-9][0-9]_*.ipynb"))
# The theorem and the proof by z3; all others, which nbval runs too, are slow.
QUICK = {"04": "exact_rate =", "13": "strict.counterexample("}
# A process with the modules of a folder, as in the page: nothing else of wmrlib and wmrbook.
ALONE = """
import json, sys
sys.modules["numpy"] = sys.modules["numba"] = None  # nobody can import them
sys.path[:0] = sys.argv[1:]
"""
EXPRESSIONS = """
import sympy as sp
from wmrlib import symbolic
found = []
for name, law in json.load(sys.stdin):
    value = getattr(symbolic, name)
    found.append(sp.srepr(value(law) if law else value))
print(json.dumps(found))
"""
CELLS = """
from run_cell import run
print(json.dumps([json.loads(run(*it)) for it in json.load(sys.stdin)]))
"""


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    """Runs code where only what the page has can be imported, and reads the JSON that it prints."""
    folder = tmp_path_factory.mktemp("page")
    for name, content in own_files().items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)

    def answer(code, given):
        command = [sys.executable, "-I", "-c", ALONE + code, folder, IN_PAGE]
        run = subprocess.run(command, input=json.dumps(given), capture_output=True, text=True)
        assert run.returncode == 0, run.stderr
        return json.loads(run.stdout)

    return answer


def test_the_pages_expressions_are_the_librarys(alone):
    symbols = {(name, ""): it for name, it in vars(symbolic).items() if isinstance(it, sp.Symbol)}
    laws = {(it.__name__, law): it(law) for it, laws in BY_LAW.items() for law in laws}
    values = symbols | laws
    assert alone(EXPRESSIONS, list(values)) == [sp.srepr(value) for value in values.values()]


def chapter(path: Path):
    number = path.stem[:2]
    return pytest.param(path, id=number, marks=() if number in QUICK else pytest.mark.slow)


@pytest.mark.parametrize("path", list(map(chapter, NOTEBOOKS)))
def test_what_runs_in_the_page_gives_what_is_stored(alone, path):
    notebook = nbformat.read(path, as_version=4)
    cells = runnable(notebook)
    assert QUICK.get(path.stem[:2], "") in "".join(cell.source for cell in cells)
    asked = [(number, cell.before, cell.source) for number, cell in enumerate(cells, 1)]
    for cell, printed in zip(cells, alone(CELLS, asked), strict=True):
        assert printed["error"] is None, cell
        stored = map(text_of, notebook.cells[cell.place].outputs)
        assert [plain(text) for _, text in printed["shown"]] == [plain(text) for text in stored]


def text_of(output) -> str:
    data = output.get("data", {})
    return output.get("text") or data.get("text/latex") or data.get("text/plain")


def plain(text: str) -> str:
    return " ".join(text.strip("$").split())


def test_what_a_cell_of_the_page_prints_breaks_or_leaves_behind(alone):
    asked = [
        (1, "x = 1", "print(x)\nx + 1"),
        (2, "", "print('y')\n\nassert x == 2"),
        (3, "", "x = (1"),
        (4, "", "print('z' * 1_000_000)\nx"),
    ]
    works, breaks, unfinished, long = alone(CELLS, asked)
    assert works == {"shown": [["text", "1\n"], ["text", "2"]], "error": None}
    assert breaks == {"shown": [["text", "y\n"]], "error": "Line 3: AssertionError: assert x == 2"}
    assert unfinished["error"].startswith("Line 1: SyntaxError")
    assert len(long["shown"][0][1]) < 30_000
    assert long["shown"][1] == ["text", "1"]


NUMPY = "import numpy as np\n"


@pytest.mark.parametrize(
    ("code", "kept"),
    [
        ("import sympy as sp\nsp.Symbol('x')", "import sympy as sp\nsp.Symbol('x')"),
        (NUMPY + "x = 1\nassert np.ones(x)\nx", "x = 1\nx"),
        (NUMPY + "x = np.ones(3)\nx", None),
        (NUMPY + "x = []\nfor y in np.ones(3):\n    x.append(y)\nprint(x)", None),
        (NUMPY + "def f(x):\n    return np.ones(x)\n\n\nf(3)", None),
        ("from wmrlib import symbolic\nsymbolic.c_header()", None),
        (NUMPY + "x = np.ones(3)\nx = 1\nx", "x = 1\nx"),
    ],
)
def test_a_cell_runs_in_the_page_if_all_that_it_shows_can(code, kept):
    shows = nbformat.v4.new_output("execute_result", {"text/plain": "what it shows"})
    cell = nbformat.v4.new_code_cell(code, outputs=[shows])
    chosen = runnable(nbformat.v4.new_notebook(cells=[cell]))
    assert [part.source for part in chosen] == ([] if kept is None else [kept])


def test_what_a_cell_needs_of_cells_that_are_not_run_comes_before_it():
    shows = nbformat.v4.new_output("stream", text="what it shows")
    needed = "import math\nturns = []\nfor i in range(3):\n    turns.append(2 * math.pi * i)"
    sources = f"{NUMPY}n = np.e\n{needed}\nmore = 3", "print(turns)"
    cells = [nbformat.v4.new_code_cell(source, outputs=[shows]) for source in sources]
    (cell,) = runnable(nbformat.v4.new_notebook(cells=cells))
    assert (cell.before, cell.left_out) == (needed, 0)
