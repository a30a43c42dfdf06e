"""Print the book into a PDF file: panels pictured, solutions unfolded, pages referred to."""

from __future__ import annotations

import base64
import shutil
import sys
from importlib.util import find_spec
from pathlib import Path

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
FOOTER = (
    '<p style="width: 100%; text-align: center; font-size: 9px">'
    '<span class="pageNumber"></span></p>'
)
MARGIN = {"top": "18mm", "bottom": "18mm", "left": "16mm", "right": "16mm"}
PATIENCE = 300_000  # ms: a whole book
PAPER = Path(__file__).with_suffix(".js").read_text(encoding="utf-8")
STILL = {"width": 1000, "height": 1400}  # a window for panels, in pixels
SHARP = 2  # dots a pixel
# Nothing but its panels has to be drawn of a page that is opened for their pictures.
BARE = """addEventListener('DOMContentLoaded', () => {
    document.querySelectorAll('article :is(.math, pre, img)').forEach(it => it.remove());
})"""
PANEL = 'script[type="application/vnd.jupyter.widget-view+json"]'
ALIVE = f"""async () => {{
    await MathJax.startup.promise;
    const panels = [...document.querySelectorAll('{PANEL}')].map(it => it.parentElement);
    return panels.every(it => it.querySelector('.jupyter-widgets canvas')?.width);
}}"""
FRAMES = "() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"


def find_browser() -> str:
    """Return the path of Chromium or Chrome, or say that the PDF needs one."""
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser is None or not all(map(find_spec, ("playwright", "pypdfium2"))):
        sys.exit(
            "The PDF needs the Python packages playwright and pypdfium2, and Chromium or Chrome: "
            "install them, or build without --pdf."
        )
    return browser


def print_book(site: Path, page: Path, pdf: Path) -> None:
    """Print the file `page` into `pdf`, A4, with pictures of the panels in the folder `site`."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        # The files are our own; without a sandbox because a container often runs as root.
        chromium = playwright.chromium.launch(
            executable_path=find_browser(), args=["--no-sandbox", "--disable-gpu"]
        )
        book = chromium.new_page(color_scheme="light")
        book.set_default_timeout(PATIENCE)
        book.goto(page.as_uri(), wait_until="load")
        book.add_script_tag(content=PAPER)
        places = book.evaluate("paper.places()")
        stills = {place: picture_panels(chromium, site, place) for place in dict.fromkeys(places)}
        book.evaluate("stills => paper.prepare(stills)", sum(stills.values(), []))
        pages: dict[str, int] = {}
        for _ in range(4):  # a number that turns out shorter may move what comes after it
            book.evaluate("pages => paper.number_pages(pages)", pages)
            book.pdf(
                path=pdf,
                format="A4",
                margin=MARGIN,
                scale=0.8,
                display_header_footer=True,
                header_template="<span></span>",
                footer_template=FOOTER,
                outline=True,
                tagged=True,
            )
            before, pages = pages, find_pages(pdf, book.evaluate("paper.anchors()"))
            if pages == before:
                break
        chromium.close()


def picture_panels(chromium, site: Path, place: str) -> list[str]:
    """Open a document of the site and return its panels' pictures as addresses of images."""
    page = chromium.new_page(color_scheme="light", viewport=STILL, device_scale_factor=SHARP)
    page.set_default_timeout(PATIENCE)
    page.add_init_script(BARE)
    page.goto((site / f"{place}.html").as_uri(), wait_until="load")
    page.wait_for_function(ALIVE)
    page.evaluate(FRAMES)
    shots = [it.screenshot() for it in page.locator(".widget-subarea > .jupyter-widgets").all()]
    page.close()
    return [f"data:image/png;base64,{base64.b64encode(shot).decode()}" for shot in shots]


def find_pages(pdf: Path, anchors: list[str]) -> dict[str, int]:
    """On which page each anchor was printed."""
    import pypdfium2
    from pypdfium2.raw import FPDF_GetNamedDestByName, FPDFDest_GetDestPageIndex

    printed = pypdfium2.PdfDocument(pdf)
    places = {it: FPDF_GetNamedDestByName(printed, it.encode()) for it in anchors}
    if lost := [it for it, place in places.items() if not place]:
        sys.exit(f"The PDF has no place for the links to {', '.join(lost)}.")
    return {it: FPDFDest_GetDestPageIndex(printed, place) + 1 for it, place in places.items()}
