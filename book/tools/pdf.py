"""Print the built pages by Chromium: the single page into the book's PDF, or any page alone.

What paper looks like stands in _static/print.css, which a reader's own printing follows too; pdf.js
answers the predictions and unfolds the short listings before.
"""

from __future__ import annotations

import json
import re
import shutil
import sys
from importlib.util import find_spec
from pathlib import Path

# The first is the same without windows, and takes three quarters of the time.
BROWSERS = (
    "chromium-headless-shell",
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
    "chrome",
)
SCRIPT = Path(__file__).with_suffix(".js").read_text(encoding="utf-8")
STATE = "application/vnd.jupyter.widget-state+json"
DATE = re.compile(rb"/(?:Creation|Mod)Date \(D:[^)]*\)")
PATIENCE = 900_000  # ms: a whole book takes a minute where nothing else runs
SHEET = {"width": 627, "height": 900}  # px: the text on a page of A4, see print.css
SHARP = 2.5  # dots a pixel, of the panels' pictures
NEVER_ASK = "localStorage.setItem('wmr-never-ask', '1')"  # see memory.js


def find_browser() -> str:
    """Return the path of Chromium or Chrome, or say that the PDF needs one."""
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser is None or not all(map(find_spec, ("playwright", "pypdfium2"))):
        sys.exit(
            "The PDF needs the Python packages playwright and pypdfium2, and Chromium or Chrome: "
            "install them, or build without --pdf."
        )
    return browser


def print_book(page: Path, notebooks: list[Path], pdf: Path) -> None:
    """Print the single page that Sphinx made of all documents, with the notebooks' panels."""
    from playwright.sync_api import sync_playwright

    give_states(page, notebooks)
    with sync_playwright() as playwright:
        # The files are our own; without a sandbox because a container often runs as root.
        chromium = playwright.chromium.launch(
            executable_path=find_browser(), args=["--no-sandbox", "--disable-gpu"]
        )
        print_page(chromium, page, pdf)
        chromium.close()


def give_states(page: Path, notebooks: list[Path]) -> None:
    """Write into the single page what its panels store; Sphinx does it for one document alone."""
    states = {}
    for notebook in notebooks:
        widgets = json.loads(notebook.read_text(encoding="utf-8"))["metadata"].get("widgets", {})
        states |= widgets.get(STATE, {}).get("state", {})
    for it in states.values():
        it["state"].pop("still", None)  # the panels themselves are printed
    stored = json.dumps({"state": states}).replace("</", "<\\/")
    text = page.read_text(encoding="utf-8")
    script = f'<script type="{STATE}">{stored}</script></body>'
    page.write_text(text.replace("</body>", script), encoding="utf-8")


def print_page(chromium, page: Path, pdf: Path) -> None:
    """Print one page; if chapters follow one another on it, with a list of them."""
    paper = chromium.new_page(
        viewport=SHEET,
        device_scale_factor=SHARP,
        color_scheme="light",
        reduced_motion="reduce",
    )
    paper.set_default_timeout(PATIENCE)
    paper.add_init_script(NEVER_ASK)
    paper.emulate_media(media="print")
    paper.goto(page.as_uri(), wait_until="load")
    paper.add_script_tag(content=SCRIPT)
    paper.wait_for_function("paper.drawn()")
    chapters = paper.evaluate("paper.prepare()")
    if chapters:  # Chromium knows on which pages they begin when it has printed once
        write(paper, pdf)
        paper.evaluate("pages => paper.number(pages)", begins(pdf, chapters))
    write(paper, pdf)
    paper.close()


def write(paper, pdf: Path) -> None:
    """Write what the page shows into the file, without a date."""
    paper.pdf(path=pdf, prefer_css_page_size=True, print_background=True, tagged=True, outline=True)
    pdf.write_bytes(DATE.sub(lambda date: b" " * len(date[0]), pdf.read_bytes()))


def begins(pdf: Path, anchors: list[str]) -> list[int]:
    """Return the numbers of the pages where links to these anchors lead."""
    import pypdfium2
    from pypdfium2.raw import FPDF_GetNamedDestByName, FPDFDest_GetDestPageIndex

    with pypdfium2.PdfDocument(pdf) as printed:
        places = [FPDF_GetNamedDestByName(printed, name.encode()) for name in anchors]
        return [FPDFDest_GetDestPageIndex(printed, place) + 1 for place in places]
