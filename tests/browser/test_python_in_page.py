"""Python in the pages, from the disk: cells of chapter 4, and chapter 13's proof by z3."""

import json
import re

import pytest
from faults import SIZES, of_page
from live import PATIENCE

FORMULA = "it => MathJax.startup.document.getMathItemsWithin(it)[0].math.trim()"
LYAPUNOV = "notebooks/04_lyapunov.html"


def output_of(page, number: int) -> str:
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
    """Put the code into the editor of a cell, which is there once the cell is near."""
    cell = page.locator(".cell:has(script.python-cell)").nth(number)
    if not cell.locator(".python-editor").count():
        press(page, number, "Edit")
    cell.scroll_into_view_if_needed(timeout=PATIENCE)
    cell.locator(".cm-content").fill(code, timeout=PATIENCE)


def shown(page, number: int) -> str:
    return page.locator(".python-output").nth(number).text_content()


def sources(page) -> list[str]:
    """What stands in the cells that the page runs."""
    return [
        json.loads(it)["source"] for it in page.locator("script.python-cell").all_text_contents()
    ]


def parts_of(page) -> list[str]:
    """The list of what is loaded of Python, which grows."""
    asked = []

    def note(request):
        _, folder, name = request.url.rpartition("vendor/python/")
        if folder:
            asked.append(name)

    page.on("request", note)
    return asked


def test_python_is_loaded_for_the_first_cell_that_is_run(opened):
    page = opened(LYAPUNOV)
    asked = parts_of(page)
    number = next(i for i, it in enumerate(sources(page)) if "energy_dot =" in it)  # a formula
    cell = page.locator(".cell:has(script.python-cell)").nth(number)
    stored = cell.locator(".cell_output:not(.python-output)")
    formula = stored.evaluate(FORMULA)
    assert not page.evaluate("Object.keys(window.PYTHON_PARTS ?? {}).length")
    press(page, number, "Run")
    assert re.fullmatch(r"Done in [\d.]+ s\.", output_of(page, number))
    assert not stored.is_visible()
    assert cell.locator(".python-output").evaluate(FORMULA) == formula
    assert sorted(asked) == ["asm.js", "packages.js", "stdlib.js", "wasm.js", "worker.js"]


@pytest.mark.slow
def test_z3_is_loaded_for_the_cell_that_asks_it_and_proves_the_theorem(opened):
    page = opened("notebooks/13_other_laws.html")
    asked = parts_of(page)
    asks = [i for i, it in enumerate(sources(page)) if "strict.counterexample(" in it]
    press(page, 0, "Run")
    assert output_of(page, 0).startswith("Done")
    for cell, answer in zip(asks, ("None", "p = 0, q = 1/8"), strict=True):
        press(page, cell, "Run")
        assert output_of(page, cell).startswith("Done")
        assert answer in shown(page, cell)
    assert asked.count("z3.js") == 1


@pytest.mark.slow
def test_a_proof_is_run_broken_stopped_and_mended_in_the_page(site, opened):
    """Chapter 4: a cell brings those above it."""
    page = opened(LYAPUNOV)
    cells = sources(page)
    last = len(cells) - 1
    model = next(i for i, source in enumerate(cells) if "energy_dot =" in source)
    chain = next(i for i, source in enumerate(cells) if "V_dot =" in source)
    press(page, last, "Run")
    assert output_of(page, last).startswith("Done")
    assert page.locator(".python-output mjx-container").count() >= last

    # A sign turned round: the cell shows another rate, and an assert says so to those below it.
    wrong = cells[model].replace("- c * p", "+ c * p")
    write(page, model, wrong.rstrip().rpartition("\n")[0] + "\nprint(sp.expand(energy_dot))")
    page.keyboard.press("Control+Enter")
    assert output_of(page, model).startswith("Done")
    assert shown(page, model).strip() == "c*p**2"
    write(page, model, wrong + "\nassert sp.expand(energy_dot) == -c * p**2")
    press(page, last, "Run")
    assert output_of(page, last) == f"An error, in cell {model + 1} above."
    assert re.match(r"Line \d+: AssertionError: assert", shown(page, model))
    press(page, model, "Reset")
    write(page, chain, cells[chain].replace("* rho_dot", "* rho_dots"))
    press(page, last, "Run")
    assert output_of(page, last) == f"An error, in cell {chain + 1} above."
    press(page, chain, "Reset")

    # An endless loop: the page stays alive, and what was computed is computed again.
    write(page, model, "while True:\n    pass")
    page.keyboard.press("Control+Enter")
    press(page, model, "Stop")
    assert output_of(page, model) == "Stopped. All variables are gone."
    press(page, model, "Reset")
    press(page, last, "Run")
    assert output_of(page, last).startswith("Done")

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
    page.evaluate("scrollTo(0, 0)")  # the theme's way back to the top is too pale
    page.locator("#pst-back-to-top").wait_for(state="hidden", timeout=PATIENCE)
    assert not of_page(page, SIZES[:1])
    sizes = [file.stat().st_size for file in (site / "_static/vendor/python").iterdir()]
    assert sum(sizes) < 25e6
