"""In JupyterLab: the first chapter is run and its sliders moved; a graded exercise as a student gets it shows its hints."""

from __future__ import annotations

import json
import shutil
import sys

import nbformat
import pytest
from graded import nbgrader, wrong_answers
from live import PATIENCE, ROOT, assert_slider_matters, chapters, free_port, serve, sliders

TOKEN = "only-for-this-test"
ASSIGNMENT, MISTAKE = "ch01", "swapped"
CONTEXT = "window.jupyterapp?.shell.currentWidget?.context"
KERNEL = f"{CONTEXT}?.sessionContext?.session?.kernel"
# A cell that is out of sight would not be drawn, and the news would be asked for.
SETTINGS = {
    "notebook-extension/tracker": {"windowingMode": "none"},
    "apputils-extension/notification": {"fetchNews": "false", "checkForUpdates": False},
}


@pytest.fixture(scope="module")
def lab(tmp_path_factory):
    """JupyterLab on a copy of the chapters, with settings of its own: the reader's files and settings stay as they are."""
    home = tmp_path_factory.mktemp("lab")
    shutil.copytree(ROOT / "notebooks", home / "notebooks", ignore=shutil.ignore_patterns(".*"))
    release_with_a_mistake(home / "course", home / "notebooks")
    for name, value in SETTINGS.items():
        path = home / "settings" / "@jupyterlab" / f"{name}.jupyterlab-settings"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(value))
    port = free_port()
    command = [
        *(
            sys.executable,
            "-m",
            "jupyterlab",
            "--no-browser",
            "--allow-root",
            "--ip=127.0.0.1",
            f"--port={port}",
        ),
        *(
            "--ServerApp.port_retries=0",
            f"--IdentityProvider.token={TOKEN}",
            f"--notebook-dir={home / 'notebooks'}",
        ),
        "--LabApp.expose_app_in_browser=True",
    ]
    environment = {
        "JUPYTERLAB_SETTINGS_DIR": str(home / "settings"),
        "JUPYTERLAB_WORKSPACES_DIR": str(home / "workspaces"),
        "JUPYTER_CONFIG_DIR": str(home / "config"),
    }
    url = f"http://127.0.0.1:{port}/"
    with serve(command, f"{url}api", home / "log.txt", **environment):
        yield url


def release_with_a_mistake(course, folder):
    """What students get of an assignment, with one usual mistake written into it, and the name of its notebook."""
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


def open_notebook(page, lab: str, name: str) -> None:
    """Opens one notebook in an empty workspace (JupyterLab would bring back the notebook of the test before) and waits for its kernel."""
    page.goto(f"{lab}lab/tree/{name}?reset&token={TOKEN}", timeout=PATIENCE)
    page.wait_for_function(
        f"name => {KERNEL}?.status === 'idle' && {CONTEXT}.path === name",
        arg=name,
        timeout=PATIENCE,
    )


def test_the_first_chapter_runs_and_its_sliders_move_the_picture(lab, browser_page):
    page = browser_page
    open_notebook(page, lab, chapters()[0].name)
    assert page.evaluate(
        "() => window.jupyterapp.commands.execute('notebook:run-all-cells').then(() => true)"
    )
    page.wait_for_function(f"() => {KERNEL}.status === 'idle'", timeout=PATIENCE)
    assert (
        page.locator(
            '[data-mime-type="application/vnd.jupyter.stderr"], [data-mime-type="application/vnd.jupyter.error"]'
        ).count()
        == 0
    )
    for slider in sliders(page)[:3]:
        assert_slider_matters(page, slider)
    page.assert_quiet()


def test_a_graded_exercise_shows_its_hint_and_nothing_leaves(lab, browser_page):
    page = browser_page
    open_notebook(page, lab, f"{ASSIGNMENT}.ipynb")
    page.evaluate(
        "() => window.jupyterapp.commands.execute('notebook:run-all-cells').then(() => true)"
    )  # up to the cell that fails
    hint = page.locator(".jp-OutputArea-output", has_text="Hint: ").first
    hint.wait_for(timeout=PATIENCE)
    assert MISTAKE in hint.inner_text()
    assert "book/wmrbook/grading" not in hint.inner_text()
    page.assert_quiet()
