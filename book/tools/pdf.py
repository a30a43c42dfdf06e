"""Print the book into a PDF file: panels pictured, solutions unfolded, pages referred to."""

from __future__ import annotations

import base64
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
FOOTER = (
    '<p style="width: 100%; text-align: center; font-size: 9px">'
    '<span class="pageNumber"></span></p>'
)
MARGIN = {"top": "18mm", "bottom": "18mm", "left": "16mm", "right": "16mm"}
DATE = re.compile(rb"/(?:Creation|Mod)Date \(D:[^)]*\)")
PATIENCE = 300_000  # ms: a whole book
PAPER = Path(__file__).with_suffix(".js").read_text(encoding="utf-8")
STILL = {"width": 1000, "height": 1400}  # a window for panels, in pixels
SHARP = 2  # dots a pixel
# Without what is empty, and with low pictures: letters are the larger for it on paper.
LOW = """.live-gate .wmr-bar, .live-verdict { display: none }
    .live-pane canvas { height: 280px !important }
    .live-tall canvas { height: 320px !important }"""
# Show the panels of another page of the site in this one: for each a page of its own takes seconds.
SHOW = """(html) => {
    const there = new DOMParser().parseFromString(html, 'text/html');
    const place = document.createElement('div');
    place.append(...there.querySelectorAll('script[type^="application/vnd.jupyter.widget"]'));
    document.querySelector('article').replaceChildren(place);
    return widgets.showAll(place);
}"""
DRAWN = """async () => {
    const panels = [...document.querySelectorAll('script[type$="widget-view+json"]')];
    const canvases = [...document.querySelectorAll('article canvas')];
    return canvases.length && canvases.every(it => it.width) && panels.every(
        it => it.parentElement.querySelector('.jupyter-widgets'));
}"""
# A sentence soon takes the room that it may need, and its panel grows: not while it is pictured.
GROWN = "() => [...document.querySelectorAll('.live-sentence')].every(it => it.style.minHeight)"
# Pictures stand for the panels, so none may live: before the page looks for their states.
DEAD = """addEventListener('DOMContentLoaded', () => document
    .querySelectorAll('script[type$="widget-state+json"]').forEach(it => it.remove()))"""
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
        blank = open_book(chromium, page)
        places = blank.evaluate("paper.places()")
        stills = picture_panels(chromium, site, list(dict.fromkeys(places)))
        blank.evaluate("stills => paper.prepare(stills)", stills)
        # Once for the places of the pages, with nothing to be seen; then whole, in a page of its
        # own: what has been printed once may break its pages otherwise the next time.
        blank.add_style_tag(content="* { visibility: hidden !important }")
        pages = find_pages(print_page(blank, pdf), blank.evaluate("paper.anchors()"))
        blank.close()
        for _ in range(5):  # a number of fewer digits may move what follows
            before = pages
            book = open_book(chromium, page)
            book.evaluate("stills => paper.prepare(stills)", stills)
            book.evaluate("pages => paper.number_pages(pages)", pages)
            pages = find_pages(print_page(book, pdf, outline=True, tagged=True), list(pages))
            book.close()
            if pages == before:
                break
        else:
            sys.exit("The PDF's pages moved when their numbers were filled in.")
        chromium.close()
    undated = DATE.sub(lambda date: b" " * len(date[0]), pdf.read_bytes())
    pdf.write_bytes(undated)  # the same file from the same sources


def open_book(chromium, page: Path):
    book = chromium.new_page(color_scheme="light")
    book.set_default_timeout(PATIENCE)
    book.add_init_script(DEAD)
    book.goto(page.as_uri(), wait_until="load")
    book.add_script_tag(content=PAPER)
    return book


def print_page(page, pdf: Path, **more: bool) -> Path:
    page.pdf(
        path=pdf,
        format="A4",
        margin=MARGIN,
        scale=0.84,
        display_header_footer=True,
        header_template="<span></span>",
        footer_template=FOOTER,
        **more,
    )
    return pdf


def picture_panels(chromium, site: Path, places: list[str]) -> list[str]:
    """Return pictures of the panels in these documents of the site, as addresses of images."""
    page = chromium.new_page(color_scheme="light", viewport=STILL, device_scale_factor=SHARP)
    page.set_default_timeout(PATIENCE)
    page.goto((site / "explorer.html").as_uri(), wait_until="load")
    page.wait_for_function(DRAWN)
    page.evaluate("document.documentElement.dataset.still = ''")  # what asks first is open
    page.add_style_tag(content=LOW)
    shots = []
    for place in places:
        page.evaluate(SHOW, (site / f"{place}.html").read_text(encoding="utf-8"))
        page.wait_for_function(DRAWN)
        page.wait_for_function(GROWN)
        page.evaluate(FRAMES)
        shots += [it.screenshot() for it in page.locator(".jupyter-widgets").all()]
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
