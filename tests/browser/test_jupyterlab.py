"""The first chapter in JupyterLab: opened, run, and its sliders moved."""

from __future__ import annotations

import json
import shutil
import sys

import pytest
from live import PATIENCE, ROOT, assert_slider_matters, chapters, free_port, serve, sliders

TOKEN = "only-for-this-test"
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
    for name, value in SETTINGS.items():
        path = home / "settings" / "@jupyterlab" / f"{name}.jupyterlab-settings"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(value))
    port = free_port()
    command = [
        *(sys.executable, "-m", "jupyterlab", "--no-browser", "--allow-root", "--ip=127.0.0.1", f"--port={port}"),
        *("--ServerApp.port_retries=0", f"--IdentityProvider.token={TOKEN}", f"--notebook-dir={home / 'notebooks'}"),
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


def test_the_first_chapter_runs_and_its_sliders_move_the_picture(lab, browser_page):
    page = browser_page
    page.goto(f"{lab}lab/tree/{chapters()[0].name}?token={TOKEN}", timeout=PATIENCE)
    kernel = "window.jupyterapp?.shell.currentWidget?.sessionContext?.session?.kernel"
    page.wait_for_function(f"() => {kernel}?.status === 'idle'", timeout=PATIENCE)
    assert page.evaluate("() => window.jupyterapp.commands.execute('notebook:run-all-cells').then(() => true)")
    page.wait_for_function(f"() => {kernel}.status === 'idle'", timeout=PATIENCE)
    assert page.locator('[data-mime-type="application/vnd.jupyter.stderr"], [data-mime-type="application/vnd.jupyter.error"]').count() == 0
    for slider in sliders(page)[:3]:
        assert_slider_matters(page, slider)
    page.assert_quiet()
