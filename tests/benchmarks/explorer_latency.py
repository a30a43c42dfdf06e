"""From a slider's event to the finished picture: python tests/benchmarks/explorer_latency.py

The static page is of the book's kind: the panel alone, opened from the disk. In JupyterLab the same
panel stands above `ipywidgets.interactive` with a matplotlib figure of the same run. Each is
dragged by its slider's handle. The clock starts when the page hears of the pointer's step, and
stops when the canvas is drawn or the new image is loaded. Machines differ and are noisy: quote
medians, and the ratios rather than the milliseconds.
"""

from __future__ import annotations

import json
import shutil
import statistics
import sys
import tempfile
from pathlib import Path

import nbformat
from ipywidgets.embed import dependency_state, embed_data
from playwright.sync_api import sync_playwright
from timing import ROOT, Row, show

from wmrbook.panel import Explorer

sys.path[:0] = [str(ROOT / place) for place in ("tests/browser", "tests", "book/tools")]
from conftest import FLAGS  # noqa: E402
from kit import bundle  # noqa: E402
from live import PATIENCE, jupyterlab  # noqa: E402
from pdf import BROWSERS  # noqa: E402

STEPS = 40
PANEL_CELL = "from wmrbook.panel import Explorer\nexplorer = Explorer()\nexplorer"
INTERACTIVE_CELL = """
%matplotlib inline
import ipywidgets, matplotlib.pyplot as plt, wmrlib as wmr
case = wmr.paper.outdoor()
def show(k_rho=2.0, k_alpha=1.0, h=0.3):
    run = wmr.simulate(case.start, case.goal, wmr.Gains(k_rho, k_alpha, h))
    figure, (path, speed) = plt.subplots(1, 2, figsize=(9, 4))
    path.plot(run.x, run.y)
    path.set_aspect("equal")
    speed.plot(run.t, run.v, run.t, run.omega)
    plt.show()
ipywidgets.interactive(show, k_rho=(0.05, 5.0), k_alpha=(0.0, 10.0), h=(0.0, 5.0))
"""
# `heard` is when the page hears of a step, `took` what each step took. A drawing counts for the
# step before it.
STOPWATCH = """() => {
    Object.assign(window, { heard: null, took: [] });
    addEventListener('pointermove', event => {
        if (event.buttons && heard === null) heard = performance.now();
    }, true);
    const stop = () => {
        if (heard !== null) took.push(performance.now() - heard);
        heard = null;
    };
    addEventListener('drawn', () => {
        if (!document.querySelector('.wmr-map').checkVisibility()) stop();
    });
    document.addEventListener('load', event => {
        if (event.target.tagName === 'IMG') stop();
    }, true);
}"""
MAP_STOPWATCH = """() => {
    took = [];
    heard = null;
    addEventListener('keydown', () => { heard = performance.now(); }, true);
    addEventListener('drawn', event => {
        const map = event.target.querySelector('.wmr-map');
        if (heard === null || map.dataset.finished !== 'true') return;
        took.push(performance.now() - heard);
        heard = null;
    });
}"""


def thumb(slider) -> tuple[float, float]:
    """Where the handle of a slider is, which is 24 px wide."""
    share, box = slider.evaluate("it => it.value / it.max"), slider.bounding_box()
    return box["x"] + 12 + share * (box["width"] - 24), box["y"] + box["height"] / 2


def drag(page, handle, wait: float) -> list[float]:
    """Drag a slider's handle to the right step by step; return what each picture took, in ms."""
    page.evaluate(STOPWATCH)
    ours = handle.get_attribute("type") == "range"
    box = handle.bounding_box()
    x, y = thumb(handle) if ours else (box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.mouse.move(x, y)
    page.mouse.down()
    for step in range(1, STEPS + 1):
        page.mouse.move(x + 2 * step, y)
        page.wait_for_timeout(wait)
    page.mouse.up()
    return page.evaluate("() => took")[3:]  # the first ones warm up


def static_page(folder: Path) -> Path:
    """The panel as a page without a kernel, with its JavaScript beside it."""
    explorer, whole = [Explorer()], {"drop_defaults": False}
    data = embed_data(explorer, state=dependency_state(explorer, **whole), **whole)
    parts = data["manager_state"], data["view_specs"]
    state, view = (json.dumps(part).replace("</", "<\\/") for part in parts)
    shutil.copy(ROOT / "book" / "_static" / "widgets.js", folder)
    bundle(folder / "panels.js")
    page = folder / "index.html"
    page.write_text(
        f"""<!doctype html><html><head><meta charset="utf-8">
        <script src="widgets.js" data-start="whole page"></script>
        <script src="panels.js"></script></head><body>
        <script type="application/vnd.jupyter.widget-state+json">{state}</script>
        <script type="application/vnd.jupyter.widget-view+json">{view[1:-1]}</script>
        </body></html>""",
        encoding="utf-8",
    )
    return page


def in_page(browser, folder: Path) -> tuple[list[float], list[float]]:
    page = browser.new_page(viewport={"width": 1280, "height": 800})
    page.goto(static_page(folder).as_uri())
    page.locator(".wmr-status:not(:empty)").wait_for(timeout=PATIENCE)
    dragged = drag(page, page.locator(".wmr-slider").nth(1), wait=40)
    page.locator("[data-control=view] select").select_option("gains")
    handle = page.locator(".wmr-slider").first
    handle.focus()
    page.evaluate(MAP_STOPWATCH)
    for _ in range(20):  # of k_rho, which the map does not span, so that each step is another map
        page.wait_for_timeout(400)
        page.keyboard.press("ArrowLeft")
    page.wait_for_timeout(1000)
    return dragged, page.evaluate("() => took")[3:]


def in_lab(browser, folder: Path) -> tuple[list[float], list[float]]:
    cells = map(nbformat.v4.new_code_cell, (PANEL_CELL, INTERACTIVE_CELL))
    notebook = nbformat.v4.new_notebook(cells=[*cells])
    notebook.metadata["kernelspec"] = {"name": "python3", "display_name": "Python 3"}
    nbformat.write(notebook, folder / "latency.ipynb")
    with jupyterlab(folder, "--IdentityProvider.token=measure") as url:
        page = browser.new_page(viewport={"width": 1280, "height": 1800})
        page.goto(f"{url}lab/tree/latency.ipynb?token=measure", timeout=PATIENCE)
        kernel = "window.jupyterapp?.shell.currentWidget?.sessionContext?.session?.kernel"
        page.wait_for_function(f"() => {kernel}?.status === 'idle'", timeout=PATIENCE)
        run = "window.jupyterapp.commands.execute('notebook:run-all-cells')"
        page.evaluate(f"() => {run}.then(() => true)")
        page.locator(".jp-OutputArea img[src^='data:image/png']").wait_for(timeout=PATIENCE)
        page.locator(".wmr-status:not(:empty)").wait_for(timeout=PATIENCE)
        page.wait_for_timeout(2000)
        panel = drag(page, page.locator(".wmr-slider").nth(1), wait=100)
        interactive = drag(page, page.locator(".widget-interact .noUi-handle").nth(1), wait=900)
        page.close()
    return panel, interactive


def rows() -> list[Row]:
    section = "The explorer, slider event to finished picture, median"
    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as name:
        path = next(filter(None, map(shutil.which, BROWSERS)))
        browser = playwright.chromium.launch(executable_path=path, headless=True, args=FLAGS)
        static, lab = Path(name, "static"), Path(name, "lab")
        static.mkdir()
        lab.mkdir()
        times = {}
        page, maps = "panel, page without a kernel", "its whole gain landscape"
        times[page], times[maps] = in_page(browser, static)
        panel, png = "panel, JupyterLab", "interactive with PNG, JupyterLab"
        times[panel], times[png] = in_lab(browser, lab)
        browser.close()
    return [Row(section, what, statistics.median(taken), "ms") for what, taken in times.items()]


if __name__ == "__main__":
    show(rows())
