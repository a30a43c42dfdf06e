"""Print a page of the book, with its formulas drawn and its solutions unfolded, into a PDF file."""

from __future__ import annotations

import shutil
import sys
from importlib.util import find_spec
from pathlib import Path

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
FOOTER = (
    '<p style="width: 100%; text-align: center; font-size: 9px">'
    '<span class="pageNumber"></span></p>'
)
PATIENCE = 300_000  # ms: a whole book
# Sphinx leaves the state of panels out of a single page, so a sentence stands in for each.
PREPARE = """async () => {
    const panel = 'script[type="application/vnd.jupyter.widget-view+json"]';
    const said = '<p><em>The pages and the notebook have a live panel here.</em></p>';
    document.querySelectorAll(panel).forEach(it => it.insertAdjacentHTML('afterend', said));
    document.querySelectorAll('details').forEach(it => { it.open = true; });
    document.querySelectorAll('img').forEach(it => { it.loading = 'eager'; });
    await MathJax.startup.promise;
    await Promise.all([...document.images].map(it => it.decode()));
}"""


def find_browser() -> str:
    """Return the path of Chromium or Chrome, or say that the PDF needs one."""
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser is None or not find_spec("playwright"):
        sys.exit(
            "The PDF needs the Python package playwright, and Chromium or Chrome: "
            "install them, or build without --pdf."
        )
    return browser


def print_page(page: Path, pdf: Path) -> None:
    """Print the file `page` into `pdf`, A4, with page numbers and an outline of the headings."""
    from playwright.sync_api import sync_playwright

    browser = find_browser()
    with sync_playwright() as playwright:
        # The files are our own; without a sandbox because a container often runs as root.
        chromium = playwright.chromium.launch(
            executable_path=browser, args=["--no-sandbox", "--disable-gpu"]
        )
        opened = chromium.new_page(color_scheme="light")
        opened.goto(page.as_uri(), wait_until="load", timeout=PATIENCE)
        opened.evaluate(PREPARE)
        margin = {"top": "18mm", "bottom": "18mm", "left": "16mm", "right": "16mm"}
        opened.pdf(
            path=pdf,
            format="A4",
            margin=margin,
            scale=0.8,
            display_header_footer=True,
            header_template="<span></span>",
            footer_template=FOOTER,
            outline=True,
            tagged=True,
        )
        chromium.close()
