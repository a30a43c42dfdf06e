"""In JupyterLab, started as README does: the first chapter lives before it is run, and after."""

from __future__ import annotations

import json
import re
import shutil
import sys

import nbformat
import pytest
from graded import nbgrader, wrong_answers
from live import PATIENCE, ROOT, assert_slider_matters, chapters, free_port, serve, sliders

CHAPTER = f"notebooks/{chapters()[0].name}"
ASSIGNMENT, MISTAKE = "ch01", "swapped"
CONTEXT = "window.jupyterapp?.shell.currentWidget?.context"
KERNEL = f"{CONTEXT}?.sessionContext?.session?.kernel"
CELLS = "window.jupyterapp.shell.currentWidget.content.widgets"
RUN_ALL = "() => window.jupyterapp.commands.execute('notebook:run-all-cells').then(() => true)"
SAVE = "() => window.jupyterapp.commands.execute('docmanager:save').then(() => true)"
CHANGED = "() => window.jupyterapp.shell.currentWidget.context.model.dirty"
# A cell that is out of sight would not be drawn.
SETTINGS = "settings/@jupyterlab/notebook-extension/tracker.jupyterlab-settings"


@pytest.fixture(scope="module")
def lab(tmp_path_factory):
    """JupyterLab on a copy of the chapters; the reader's files and settings stay as they are."""
    home = tmp_path_factory.mktemp("lab")
    shutil.copytree(ROOT / "notebooks", home / "notebooks", ignore=shutil.ignore_patterns(".*"))
    release_with_a_mistake(home / "course", home / "notebooks")
    (home / SETTINGS).parent.mkdir(parents=True)
    (home / SETTINGS).write_text(json.dumps({"windowingMode": "none"}))
    port = free_port()
    options = {
        "--config": "book/lab/jupyter_lab_config.py",
        "--ServerApp.root_dir": home,
        "--ServerApp.port": port,
        "--ServerApp.port_retries": 0,
        "--LabApp.expose_app_in_browser": True,
    }
    command = [sys.executable, "-m", "jupyterlab", "--no-browser", "--allow-root"]
    command += [f"{name}={value}" for name, value in options.items()]
    folders = {
        "JUPYTERLAB_SETTINGS_DIR": str(home / "settings"),
        "JUPYTERLAB_WORKSPACES_DIR": str(home / "workspaces"),
        "JUPYTER_CONFIG_DIR": str(home / "config"),
        "JUPYTER_DATA_DIR": str(home / "data"),  # where the trust in a notebook is kept
    }
    with serve(command, f"http://127.0.0.1:{port}/api", home / "log.txt", **folders):
        yield home


def release_with_a_mistake(course, folder):
    """Put what students get of an assignment into the folder, with one usual mistake in it."""
    shutil.copytree(
        ROOT / "book" / "course",
        course,
        ignore=shutil.ignore_patterns("release", "submitted", "autograded", "*.db"),
    )
    nbgrader(course, "generate_assignment", ASSIGNMENT)
    (release,) = (course / "release" / ASSIGNMENT).glob("*.ipynb")
    notebook = nbformat.read(release, as_version=4)
    wrong = next(each for each in wrong_answers(ASSIGNMENT) if MISTAKE in each["hint"])
    for cell in notebook.cells:
        if cell.metadata.nbgrader.get("grade_id") == wrong["cell"]:
            cell.source = wrong["source"]
    nbformat.write(notebook, folder / f"{ASSIGNMENT}.ipynb")


def link(home) -> str:
    """The link that the terminal shows."""
    return re.search(r"http://127\S+", (home / "log.txt").read_text()).group()


def open_notebook(page, url: str, name: str) -> None:
    """Open a notebook in an empty workspace and wait for its kernel."""
    page.goto(url.replace("?", "?reset&"), timeout=PATIENCE)
    idle = f"name => {KERNEL}?.status === 'idle' && {CONTEXT}.path === name"
    page.wait_for_function(idle, arg=name, timeout=PATIENCE)


def solutions_in_sight(page) -> list:
    folded = "it.model.getMetadata('tags')?.includes('hide-cell')"
    return page.evaluate(
        f"() => {CELLS}.filter(it => it.isVisible && {folded}).map(it => it.model.id)"
    )


def test_the_first_chapter_lives_before_it_is_run_and_after_it_is_saved(lab, browser_page):
    page = browser_page
    open_notebook(page, link(lab), CHAPTER)
    assert not page.get_by_text("Formgrader").count()
    found = sliders(page)
    page.wait_for_function(f"() => !({CHANGED})()", timeout=PATIENCE)  # once the last is drawn
    for slider in found[:2]:
        assert_slider_matters(page, slider)
    assert solutions_in_sight(page) == []
    count = page.evaluate(f"() => {CELLS}.length")
    page.locator(".live [type=radio]").first.check()
    page.get_by_role("button", name="Commit").last.click()
    for place in ("[aria-label^=controls] .wmr-slider", ".wmr:not(.live) button"):
        page.locator(place).locator("visible=true").first.press("b")  # in a cell it adds one
    assert page.evaluate(f"() => {CELLS}.length") == count

    assert page.evaluate(RUN_ALL)
    page.wait_for_function(f"() => {KERNEL}.status === 'idle'", timeout=PATIENCE)
    assert page.evaluate(CHANGED)
    trouble = '[data-mime-type$="jupyter.stderr"], [data-mime-type$="jupyter.error"]'
    assert page.locator(trouble).count() == 0
    assert_slider_matters(page, sliders(page)[0])
    assert solutions_in_sight(page) == []

    page.evaluate(SAVE)
    open_notebook(page, link(lab), CHAPTER)
    assert_slider_matters(page, sliders(page)[0])
    assert solutions_in_sight(page) == []
    assert "nbgrader" not in (lab / "log.txt").read_text()
    page.assert_quiet()


def test_a_graded_exercise_shows_its_hint_and_nothing_leaves(lab, browser_page):
    page = browser_page
    name = f"notebooks/{ASSIGNMENT}.ipynb"
    open_notebook(page, link(lab).replace(CHAPTER, name), name)
    page.evaluate(RUN_ALL)  # up to the cell that fails
    hint = page.locator(".jp-OutputArea-output", has_text="Hint: ").first
    hint.wait_for(timeout=PATIENCE)
    assert MISTAKE in hint.inner_text()
    assert "book/wmrbook/grading" not in hint.inner_text()
    page.assert_quiet()
