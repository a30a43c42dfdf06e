"""Python in the pages, from the disk: cells give what the notebooks store, tasks their hints."""

import io
import json
import os
import re
import subprocess
import sys
import zipfile
from pathlib import Path

import build
import graded
import nbformat
import pytest
from faults import SIZES, of_page
from live import PATIENCE, ROOT, chapters
from page_tasks import TASKS
from python_cells import runnable
from python_pack import Z3, packages

CELL = re.compile(r'<script type="application/json" class="python-cell">(.*?)</script>', re.DOTALL)
DRAWN_TEXTS = """() => [...document.querySelectorAll('.python-output')].map(all =>
    [...all.children].map(it => it.querySelector('pre')?.textContent
        ?? MathJax.startup.document.getMathItemsWithin(it)[0].math))"""
LYAPUNOV = "notebooks/04_lyapunov.html"


def given(page: Path) -> list[dict]:
    """What a page says of its cells."""
    return [json.loads(each) for each in CELL.findall(page.read_text(encoding="utf-8"))]


def told(page, number: int) -> str:
    """What the status of a cell says once it has run."""
    page.wait_for_function(
        """number => /^(?!Loading|Running)./.test(
            document.querySelectorAll('.python-status')[number].textContent)""",
        arg=number,
        timeout=PATIENCE,
    )
    return page.locator(".python-status").nth(number).text_content()


def press(page, number: int, name: str) -> None:
    page.evaluate("document.querySelectorAll('details').forEach(it => { it.open = true; })")
    tools = page.locator(".python-tools").nth(number)
    tools.get_by_role("button", name=name).click(timeout=PATIENCE)


def write(page, number: int, code: str) -> None:
    """Put the code into the editor of a cell."""
    cell = page.locator(".cell:has(script.python-cell)").nth(number)
    if not cell.locator(".python-editor").count():
        press(page, number, "Edit")
    fill(cell, code)


def fill(cell, code: str) -> None:
    """Put the code into a cell's editor, which is there once the cell is near."""
    cell.scroll_into_view_if_needed(timeout=PATIENCE)
    cell.locator(".cm-content").fill(code, timeout=PATIENCE)


def shown(page, number: int) -> str:
    return page.locator(".python-output").nth(number).text_content()


@pytest.mark.slow
def test_a_proof_is_run_broken_stopped_and_mended_in_the_page(site, opened):
    """Chapter 4: nothing is loaded before it is asked for, and a cell brings those above it."""
    page = opened(LYAPUNOV)
    asked = []
    page.on("request", lambda request: asked.append(request.url))
    cells = given(site / LYAPUNOV)
    last = next(i for i, cell in enumerate(cells) if "grading" in cell["source"]) - 1
    model = next(i for i, cell in enumerate(cells) if "rates =" in cell["source"])
    assert not page.evaluate("Object.keys(window.PYTHON_PARTS ?? {}).length")
    press(page, last, "Run")
    assert re.fullmatch(r"Done in [\d.]+ s\.", told(page, last))
    assert page.locator(".python-output mjx-container").count() >= last

    # A sign turned round: the check in the cell fails, and says where; without it a rest remains.
    wrong = cells[model]["source"].replace("rho: -v *", "rho: v *")
    write(page, model, wrong)
    press(page, last, "Run")
    assert told(page, last) == f"An error, in cell {model + 1} above."
    assert re.match(r"Line \d+: AssertionError: assert", shown(page, model))
    rest = re.sub(r"(?m)^ *assert.*$|^for number.*$", "", wrong)
    rest = rest.rstrip().rpartition("\n")[0] + "\nprint(sp.expand(slope - EQUATIONS[20].rhs))"
    write(page, model, rest)
    page.keyboard.press("Control+Enter")
    assert told(page, model).startswith("Done")
    assert shown(page, model).strip() == "2*rho*v*cos(alpha)/L"
    press(page, last, "Run")  # what was right above is computed again, from the wrong sign
    proof = next(i for i, cell in enumerate(cells) if "exact_rate =" in cell["source"])
    assert told(page, last) == f"An error, in cell {proof + 1} above."

    # An endless loop: the page stays alive, and what was computed is computed again.
    write(page, model, "while True:\n    pass")
    page.keyboard.press("Control+Enter")
    page.wait_for_timeout(300)
    press(page, model, "Stop")
    assert told(page, model) == "Stopped. All variables are gone."
    press(page, model, "Reset")
    press(page, last, "Run")
    assert told(page, last).startswith("Done")

    # Below a megabyte that is printed stands what the check says.
    asks = next(i for i, cell in enumerate(cells) if "exercises.aicardi(" in cell["source"])
    write(page, asks, f"print('Right\\n' * 200_000)\n{cells[asks]['source']}")
    press(page, asks, "Run")
    assert told(page, asks) == "Not yet."
    assert len(shown(page, asks)) < 30_000

    # By keyboard: Tab indents, and leaves after Esc.
    write(page, model, "")
    page.keyboard.press("Tab")
    editor = page.locator(".cell:has(script.python-cell)").nth(model).locator(".python-editor")
    assert editor.input_value() == "    "
    page.keyboard.press("Control+z")
    assert editor.input_value() == ""
    page.keyboard.type("if x:\nprint('y')")  # the second line is indented by itself
    assert editor.input_value() == "if x:\n    print('y')"
    page.keyboard.press("Escape")
    page.keyboard.press("Tab")
    assert page.locator(":focus").text_content() == "Run"
    assert sum("vendor/python" in url for url in asked) == 5
    page.evaluate("scrollTo(0, 0)")  # the theme's way back to the top is too pale
    page.locator("#pst-back-to-top").wait_for(state="hidden", timeout=PATIENCE)
    assert not of_page(page, SIZES[:1])
    sizes = [each.stat().st_size for each in (site / "_static/vendor/python").iterdir()]
    assert sum(sizes) < 25e6


SOLVED = """from wmrbook.chapters.strict import K2, Q, counterexample, slope
found = []
for k2 in ("13/64", "1/2", "2"):
    asked = slope().subs(K2, k2)
    found.append(counterexample(asked, Q > 0))
print(found)"""


@pytest.mark.slow
def test_z3_decides_in_the_page_and_is_loaded_for_a_cell_that_asks_it(site, tmp_path, browser_page):
    texts = "1 + 1", SOLVED, "import z3\nz3.get_version_string()"
    cells = [{"place": i, "source": text, "before": "", "left_out": 0, "checks": [],
              "space": "chapter", "name": ""} for i, text in enumerate(texts)]  # fmt: skip
    path = tmp_path / "z3.html"
    path.write_text(page_of(cells, (site / "_static").as_uri()), encoding="utf-8")
    browser_page.goto(path.as_uri())
    asked = []
    browser_page.on("request", lambda request: asked.append(request.url.rpartition("/")[2]))
    for number, most in enumerate((5, 6, 6)):
        press(browser_page, number, "Run")
        assert told(browser_page, number).startswith("Done")
        assert sum(it.endswith(".js") for it in asked) == most
        assert ("z3.js" in asked) == (number > 0)
    assert shown(browser_page, 1).strip() == "[{p: 0, q: 1/8}, None, None]"
    version = Z3.read_text(encoding="utf-8").split()[0].removeprefix("z3-solver==")
    assert version.startswith(shown(browser_page, 2).strip(" '\n"))

    # Stopped while it thinks, it is asked again.
    endless = "from wmrbook.chapters import strict\n"
    endless += "while True:\n    strict.counterexample(strict.slope())"
    write(browser_page, 1, endless)
    press(browser_page, 1, "Run")
    browser_page.wait_for_timeout(500)
    press(browser_page, 1, "Stop")
    assert told(browser_page, 1) == "Stopped. All variables are gone."
    press(browser_page, 1, "Reset")
    press(browser_page, 2, "Run")
    assert told(browser_page, 2).startswith("Done")
    assert sum(it == "z3.js" for it in asked) == 1


@pytest.mark.slow
def test_each_cell_gives_what_is_stored_and_each_task_takes_the_model(site, tmp_path, browser_page):
    """All of the book's cells in one page, so that Python starts once."""
    cells, wanted = [], []
    for chapter in chapters():
        number, notebook = chapter.name[:2], nbformat.read(chapter, as_version=4)
        build.without_solutions(notebook)  # as the pages are built
        stored = notebook.cells
        names = iter(TASKS.get(number, ()))
        for cell in given(site / f"notebooks/{chapter.stem}.html"):
            if cell["later"]:
                continue
            if cell["checks"]:
                cell["source"] = graded.cells(f"ch{number}")[next(names)][0]
                wanted.append(None)
            elif cell["space"] == "tasks":  # a student's own numbers are those of the class
                cell["source"] = cell["source"].replace('name = ""', 'name = " Zoë"')
                exec(f"{cell['before']}\n{cell['source']}", own := {})
                wanted.append([plain(repr(own["mine"]))])
            else:
                if "grading.exercises." in cell["source"]:  # an answer may name what is imported
                    cell["source"] = f"math\n{cell['source']}"
                wanted.append([texts(output) for output in stored[cell["place"]].outputs])
            cells.append(cell | {"space": f"{cell['space']} {number}"})
        assert not next(names, None), chapter
    assert len(cells) > 40
    asked = "".join(cell["source"] for cell in cells)
    assert not [it for it in graded.exercises() if f"grading.exercises.{it}(" not in asked]
    path = tmp_path / "all.html"
    path.write_text(page_of(cells, (site / "_static").as_uri()), encoding="utf-8")
    browser_page.goto(path.as_uri())
    found = {}
    for i, cell in enumerate(cells):
        press(browser_page, i, "Check" if cell["checks"] else "Run")
        said = told(browser_page, i)
        own = cell["name"] and cell["space"].startswith("chapter")  # an answer is still missing
        if not re.match("Right" if cell["checks"] else "Not yet" if own else "Done", said):
            found[i] = said, shown(browser_page, i), cell
    assert not found
    drawn = [[plain(text) for text in each] for each in browser_page.evaluate(DRAWN_TEXTS)]
    pairs = zip(wanted, drawn, strict=True)
    assert not [pair for pair in pairs if pair[0] is not None and pair[0] != pair[1]]


def page_of(cells: list[dict], static: str) -> str:
    """A page that holds these cells and nothing else."""
    names = ("vendor/mathjax/tex-svg.js", "python_cells.js")
    head = f"<script>{(ROOT / 'book' / 'mathjax.js').read_text(encoding='utf-8')}</script>"
    head += "".join(f'<script src="{static}/{name}"></script>' for name in names)
    holder = '<div class="cell"><div class="cell_input"><pre></pre></div>{}</div>'
    script = '<script type="application/json" class="python-cell">{}</script>'
    told = (json.dumps(cell).replace("</", "<\\/") for cell in cells)
    body = "".join(holder.format(script.format(each)) for each in told)
    return f"<!doctype html><meta charset=utf-8><title>Cells</title>{head}{body}"


def texts(output) -> str:
    """What an output says, in a notebook or in a page."""
    data = output.get("data", {})
    return plain(output.get("text") or data.get("text/latex") or data.get("text/plain"))


def plain(text: str) -> str:
    return " ".join(text.strip("$").split())


@pytest.mark.slow
def test_tasks_of_the_page_have_the_hints_of_the_course(tmp_path):
    """With the stand-ins for numpy and numba, mistakes lose what they lose, for the same reason."""
    with zipfile.ZipFile(io.BytesIO(packages())) as archive:
        archive.extractall(tmp_path)
    paths = [str(tmp_path), str(ROOT / "tests")]
    run = subprocess.run(
        [sys.executable, "-c", HINTS, json.dumps(TASKS)],
        capture_output=True,
        text=True,
        cwd=tmp_path,  # else the library itself is found first
        env=os.environ | {"PYTHONPATH": os.pathsep.join(paths)},
    )
    assert run.returncode == 0, run.stderr
    assert json.loads(run.stdout.splitlines()[-1]) == []


# Each line of what it finds: a task, a mistake, what the page says of it.
HINTS = """
import json, re, sys
import graded, numpy
assert "Stands in" in numpy.__doc__
arcs = {"atan2": "arctan2", "asin": "arcsin", "acos": "arccos", "atan": "arctan"}
in_numpy = lambda text: "import numpy as np\\n" + re.sub(
    r"math\\.(?!remainder)(\\w+)", lambda it: "np." + arcs.get(it[1], it[1]), text)
found = []
for chapter, tasks in json.loads(sys.argv[1]).items():
    for task in tasks:
        chapter = chapter if chapter.startswith("ch") else "ch" + chapter
        model, _ = graded.cells(chapter)[task]
        wrong = [each for each in graded.wrong_answers(chapter) if each["cell"] == task]
        wrong.append({"name": "empty", "source": graded.released(model), "hint": "",
                      "loses": graded.tasks(chapter)[task]})
        assert len(wrong) > 2
        # One who writes with numpy, as the assignments allow, loses nothing.
        wrong.append({"name": "numpy", "source": in_numpy(model), "hint": "", "loses": []})
        for each in wrong:
            hints = graded.lost(chapter, task, each["source"])
            named = any(each["hint"] in it for it in hints.values()) or not each["loses"]
            if list(hints) != each["loses"] or not named:
                found.append([chapter, task, each["name"], hints])
found += [(name, graded.mistold(name)) for name in graded.exercises() if graded.mistold(name)]
print()
print(json.dumps(found))
"""


NUMPY = "import numpy as np\n"
F_OF_0 = "def f(np):\n    x = np\n    return x and f(x)\nf(0)"


@pytest.mark.parametrize(
    ("code", "kept"),
    [
        ("import sympy as sp\nsp.Symbol('x')", "import sympy as sp\nsp.Symbol('x')"),
        (NUMPY + "x = 1\nassert np.ones(x)\nx", "x = 1\nx"),
        (NUMPY + "x = np.ones(3)\nx", None),
        (NUMPY + "x = 1\nx += np.ones(3)\nx", None),
        (NUMPY + "x = []\nfor y in np.ones(3):\n    x.append(y)\nprint(x)", None),
        (NUMPY + "assert np.ones(3)\nprint('as it should be')", None),
        (NUMPY + "def f(x):\n    return np.ones(x)\n\n\nf(3)", None),
        (NUMPY + "x = np.ones(3)\n[x for x in range(3)]", "[x for x in range(3)]"),
        (NUMPY + "x = np.ones(3)\nx = 1\nx", "x = 1\nx"),
        (NUMPY + "x = np.ones(3)\nsum([(x := 1) + x])", "sum([(x := 1) + x])"),
        (NUMPY + "x = np.ones(3)\n[x for x in x]", None),
        (NUMPY + "f = np.e\ndef f(np):\n    x = np\n    return x and f(x)\nf(0)", F_OF_0),
        ("def f():\n    import numpy as np\n    return np.e\n\n\nf()", None),
    ],
)
def test_a_cell_runs_in_the_page_if_all_that_it_shows_can(code, kept):
    shows = nbformat.v4.new_output("execute_result", {"text/plain": "what it shows"})
    cell = nbformat.v4.new_code_cell(code, outputs=[shows])
    found = runnable(nbformat.v4.new_notebook(cells=[cell]))
    assert [each.source for each in found] == ([] if kept is None else [kept])


def test_what_a_cell_made_is_gone_before_it_runs_again_and_nobody_is_asked(monkeypatch):
    monkeypatch.syspath_prepend(ROOT / "book" / "in_page")
    from run_cell import run

    def ends(source, number=2, space="tasks"):
        return json.loads(run(space, number, "", source, ["found = answer"]))["error"]

    assert run("tasks", 1, "", "given = 1", [])
    assert ends("answer = given") is None
    assert "answer" in ends("renamed = 2")
    assert ends("answer = given", space="chapter").startswith("Line 1: NameError")
    assert ends("answer = given") is None  # what other cells made stays
    assert "write the value into the code" in ends("answer = input('how far? ')")


def test_what_a_cell_needs_of_cells_that_are_not_run_comes_before_it():
    shows = nbformat.v4.new_output("stream", text="what it shows")
    needed = "import math\nturns = []\nfor i in range(3):\n    turns.append(2 * math.pi * i)"
    sources = f"{NUMPY}n = np.e\n{needed}\nmore = 3", "print(turns)"
    cells = [nbformat.v4.new_code_cell(each, outputs=[shows]) for each in sources]
    (cell,) = runnable(nbformat.v4.new_notebook(cells=cells))
    assert (cell.before, cell.left_out) == (needed, 0)
