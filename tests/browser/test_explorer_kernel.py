"""The panel in JupyterLab, with a kernel: Python sees what a hand does, and the reverse."""

from __future__ import annotations

import json
import sys

import nbformat
import pytest
from live import PATIENCE, free_port, serve

TOKEN = "only-for-this-test"
CELLS = [
    "from wmrlib.explorer import Explorer\nimport wmrlib as wmr\n"
    "explorer = Explorer(view='gains')\nexplorer",
    "print('seen', explorer.gains, len(explorer.trajectory()), explorer.law, explorer.moving)",
    "explorer.gains, explorer.law = wmr.Gains(1.5, 4.0, 2.5), 'aicardi'",
]
KERNEL = "window.jupyterapp?.shell.currentWidget?.sessionContext?.session?.kernel"


@pytest.fixture(scope="module")
def lab(tmp_path_factory):
    home = tmp_path_factory.mktemp("lab")
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in CELLS])
    notebook.metadata["kernelspec"] = {"name": "python3", "display_name": "Python 3"}
    nbformat.write(notebook, home / "panel.ipynb")
    settings = {
        "notebook-extension/tracker": {"windowingMode": "none"},
        "apputils-extension/notification": {"fetchNews": "false", "checkForUpdates": False},
    }
    for name, value in settings.items():
        path = home / "settings" / "@jupyterlab" / f"{name}.jupyterlab-settings"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(value))
    port = free_port()
    command = [
        sys.executable,
        "-m",
        "jupyterlab",
        "--no-browser",
        "--allow-root",
        "--ip=127.0.0.1",
        f"--port={port}",
    ]
    command += [
        f"--IdentityProvider.token={TOKEN}",
        f"--notebook-dir={home}",
        "--LabApp.expose_app_in_browser=True",
    ]
    places = {
        "JUPYTERLAB_SETTINGS_DIR": str(home / "settings"),
        "JUPYTERLAB_WORKSPACES_DIR": str(home / "workspaces"),
        "JUPYTER_CONFIG_DIR": str(home / "config"),
    }
    url = f"http://127.0.0.1:{port}/"
    with serve(command, f"{url}api", home / "log.txt", **places):
        yield url


def run(page, cell: int) -> None:
    page.evaluate(
        """cell => {
            window.jupyterapp.shell.currentWidget.content.activeCellIndex = cell;
            return window.jupyterapp.commands.execute('notebook:run-cell').then(() => true);
        }""",
        cell,
    )


def assert_python_sees(page, *words: str) -> None:
    """Python says so at once or soon: a busy kernel hears of the end of a drag when it can."""
    for _ in range(20):
        run(page, 1)
        said = page.locator(".jp-OutputArea-output:has-text('seen ')").inner_text(timeout=PATIENCE)
        if all(word in said for word in words):
            return
        page.wait_for_timeout(250)
    raise AssertionError(f"{words} were not seen, but {said}")


def assert_all_in_view(page) -> None:
    """In a window of 1440 by 900 the panel needs no scrolling, once its cell is at the top."""
    page.set_viewport_size({"width": 1440, "height": 900})
    root = page.locator(".wmr")
    root.scroll_into_view_if_needed()
    page.wait_for_timeout(300)
    box = root.bounding_box()
    room = page.locator(".jp-WindowedPanel-outer, .jp-Notebook").first.bounding_box()
    assert box["height"] <= room["height"]
    assert box["width"] <= room["width"]
    scrolls = "it => it.scrollHeight > it.clientHeight + 1 || it.scrollWidth > it.clientWidth + 1"
    assert not page.locator(".jp-OutputArea-output:has(.wmr)").evaluate(scrolls)


def test_python_follows_the_panel_and_the_panel_follows_python(lab, browser_page):
    page = browser_page
    page.goto(f"{lab}lab/tree/panel.ipynb?token={TOKEN}", timeout=PATIENCE)
    page.wait_for_function(f"() => {KERNEL}?.status === 'idle'", timeout=PATIENCE)
    run(page, 0)
    status = page.locator(".wmr-status:not(:empty)")
    status.wait_for(timeout=PATIENCE)
    assert_python_sees(page, "k_rho=2.0, k_alpha=1.0, h=0.3")

    assert page.locator(".wmr-slider:not([aria-label]), .wmr select:not([aria-label])").count() == 0
    assert_all_in_view(page)

    def assert_said_anew(act) -> None:
        before = status.inner_text()
        act()
        said = "before => document.querySelector('.wmr-status').textContent !== before"
        page.wait_for_function(said, arg=before, timeout=PATIENCE)

    page.locator("[data-control=k_alpha] .wmr-slider").focus()
    assert_said_anew(lambda: [page.keyboard.press("ArrowRight") for _ in range(3)])
    assert_python_sees(page, "k_rho=2.0, k_alpha=1.15, h=0.3")

    chart = page.locator(".wmr-map[data-finished=true]")
    assert_said_anew(lambda: chart.click(position={"x": 250, "y": 100}, timeout=PATIENCE))
    clicked = float(page.locator("[data-control=k_alpha] .wmr-typed").input_value())
    assert clicked != 1.15
    assert_python_sees(page, f"k_alpha={clicked},")

    typed = page.locator("[data-control=h] .wmr-typed")
    run(page, 2)
    page.wait_for_function(
        "() => document.querySelector('[data-control=h] .wmr-typed').value === '2.5'",
        timeout=PATIENCE,
    )
    assert_python_sees(page, "k_rho=1.5, k_alpha=4.0, h=2.5", "aicardi")

    typed.click()
    page.keyboard.press("ControlOrMeta+a")
    page.keyboard.type("3.21")
    page.keyboard.press("Enter")
    assert_python_sees(page, "h=3.21")

    page.locator("[data-do=reset]").click()
    assert_python_sees(page, "k_rho=2.0, k_alpha=1.0, h=0.3")
    page.assert_quiet()
