"""Print the book into a PDF file: a title, running heads, states of panels, answers, an index.

Chromium wins over LaTeX and paged.js: the pages' own formulas, figures and panels go on paper as
they are, in seconds; its margin boxes write the heads, and a first printing tells the page numbers.
"""

from __future__ import annotations

import base64
import re
import shutil
import sys
from importlib.util import find_spec
from itertools import product
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
HERE = Path(__file__)
# Static fonts: what a PDF has of a variable one are drawings without a name.
FACES = (("Serif", "source-serif-4"), ("Sans", "source-sans-3"), ("Code", "jetbrains-mono"))
FACE = """@font-face {{ font-family: "Paper {name}"; font-weight: {weight}; font-style: {style};
    src: url("{url}"); unicode-range: {range} }}"""
RANGES = {"latin": "U+0-36F, U+1E00-FFFF", "greek": "U+370-3FF"}
DATE = re.compile(rb"/(?:Creation|Mod)Date \(D:[^)]*\)")
PATIENCE = 300_000  # ms: a whole book
STILL = {"width": 1000, "height": 1400}  # a window for panels, in pixels
SHARP = 2.4  # dots a pixel
FOOT = 20.0  # mm, the margin below the text; see pdf.css
EMPTY = 0.37 * 218  # mm at the end of a page, before a picture that did not fit is made lower
LOWEST = 0.5  # of its height
# Show the panels of another page of the site in this one: for each a page of its own takes seconds.
SHOW = """(html) => {
    const there = new DOMParser().parseFromString(html, 'text/html');
    const place = document.createElement('div');
    place.append(...there.querySelectorAll('script[type^="application/vnd.jupyter.widget"]'));
    document.querySelector('article').replaceChildren(place);
    return widgets.showAll(place);
}"""
DRAWN = """() => {
    const panels = [...document.querySelectorAll('script[type$="widget-view+json"]')];
    const canvases = [...document.querySelectorAll('article canvas')];
    const figures = [...document.querySelectorAll('article .live')];
    return canvases.length && canvases.every(it => it.width) && panels.every(
        it => it.parentElement.querySelector('.jupyter-widgets')
    ) && figures.every(it => it.dataset.open);
}"""
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
    """Print the file `page` into `pdf`, with states of the panels in the folder `site`."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        # The files are our own; without a sandbox because a container often runs as root.
        chromium = playwright.chromium.launch(
            executable_path=find_browser(), args=["--no-sandbox", "--disable-gpu"]
        )
        paper = page.with_name("paper.html")
        book = open_page(chromium, page)
        documents = book.evaluate("paper.places()")
        states = picture_panels(chromium, site, list(dict.fromkeys(documents)))
        save_pictures(states, page.parent)
        html = book.evaluate("it => paper.prepare(...it)", [states, front_matter(), terms()])
        book.close()
        paper.write_text(f"<!doctype html>{html}", encoding="utf-8")
        found = settle(chromium, paper, pdf)
        if not print_page(chromium, paper, pdf, *found, seen=True)[0].items() <= found[0].items():
            sys.exit("The PDF's pages moved when they could be seen.")
        chromium.close()
    undated = DATE.sub(lambda date: b" " * len(date[0]), pdf.read_bytes())
    pdf.write_bytes(undated)  # the same file from the same sources


def open_page(chromium, page: Path):
    book = chromium.new_page(color_scheme="light")
    book.set_default_timeout(PATIENCE)
    book.add_init_script(DEAD)
    book.goto(page.as_uri(), wait_until="load")
    book.add_style_tag(content=faces() + HERE.with_suffix(".css").read_text(encoding="utf-8"))
    add_scripts(book)
    return book


def add_scripts(page) -> None:
    for name in ("pdf_parts.js", "pdf.js"):
        page.add_script_tag(path=HERE.with_name(name))


def settle(chromium, paper: Path, pdf: Path) -> tuple[dict[str, int], dict[str, float]]:
    """Find the pages of all anchors, and heights of pictures that leave no page half empty."""
    pages: dict[str, int] = {}
    heights: dict[str, float] = {}
    for _ in range(9):
        before = pages, dict(heights)
        found, pictures = print_page(chromium, paper, pdf, *before)
        pages = pages | found  # the index names a page once, and with it one anchor
        moved = set()  # chapters: what follows in one moves when a picture becomes lower
        for it in pictures:
            lower = it["high"] - (it["needs"] - it["room"]) - 4.0
            lower = min(lower, heights.get(it["id"], it["high"]) - 6.0)
            torn = pages[it["id"]] > pages[it["above"]] and it["room"] > EMPTY
            if torn and it["chapter"] not in moved and lower > LOWEST * it["high"]:
                moved.add(it["chapter"])
                heights[it["id"]] = lower
        if (pages, heights) == before:
            return before
    sys.exit("The PDF's pages moved when their numbers were filled in.")


def print_page(chromium, paper: Path, pdf: Path, pages, heights, seen: bool = False):
    """Print anew: what has been printed once may break its pages otherwise the next time."""
    page = open_page(chromium, paper)
    page.evaluate("given => paper.fill(...given)", [pages, heights])
    if not seen:  # it takes a quarter of the time
        page.add_style_tag(content="* { visibility: hidden !important }")
    page.pdf(path=pdf, prefer_css_page_size=True, print_background=True, outline=seen, tagged=seen)
    places = find_places(pdf, page.evaluate("paper.anchors()"))
    pictures = page.evaluate("paper.pictured()")
    page.close()
    for it in pictures:
        it["room"] = places[it["above"]][1]
    return {name: number for name, (number, _) in places.items()}, pictures


def faces() -> str:
    """Return the rules that bring the fonts of the paper."""
    from build import MODULES  # which imports this module

    rules = []
    for name, package in FACES:
        for weight, style, part in product((400, 600, 700), ("normal", "italic"), RANGES):
            file = f"@fontsource/{package}/files/{package}-{part}-{weight}-{style}.woff2"
            names = {"name": name, "weight": weight, "style": style, "range": RANGES[part]}
            rules.append(FACE.format(url=(MODULES / file).as_uri(), **names))
    return "\n".join(rules)


def front_matter() -> str:
    """Return the title page and its back."""
    import conf

    text = HERE.with_name("front.html").read_text(encoding="utf-8")
    return text.format(title=conf.project, author=conf.author, edition=conf.edition)


def terms() -> list[tuple[str, str]]:
    """Return the terms of the index, each with the pattern by which it is found."""
    rows = HERE.with_name("index.txt").read_text(encoding="utf-8").splitlines()
    pairs = (row.partition(" | ") for row in sorted(rows, key=str.lower))
    return [(term, pattern or re.escape(term)) for term, _, pattern in pairs]


def picture_panels(chromium, site: Path, places: list[str]) -> list[dict]:
    """Return the states of the panels in these documents of the site: see `states` in pdf.js."""
    page = chromium.new_page(
        color_scheme="light", viewport=STILL, device_scale_factor=SHARP, reduced_motion="reduce"
    )
    page.set_default_timeout(PATIENCE)
    page.goto((site / "explorer.html").as_uri(), wait_until="load")
    add_scripts(page)
    page.wait_for_function(DRAWN)
    states = []
    for place in places:
        page.evaluate(SHOW, (site / f"{place}.html").read_text(encoding="utf-8"))
        page.wait_for_function(DRAWN)
        page.evaluate(FRAMES)
        states += page.evaluate("paper.states()")
    page.close()
    return states


def save_pictures(states: list[dict], folder: Path) -> None:
    """Put files in the place of the pictures: whoever opens the page often has less to read."""
    shots = [
        shot for state in states for part in ("given", "asked") for shot in state.get(part, [])
    ]
    for k, shot in enumerate(shots):
        picture = folder / f"still-{k}.png"
        picture.write_bytes(base64.b64decode(shot[0].partition(",")[2]))
        shot[0] = picture.name


def find_places(pdf: Path, anchors: list[str]) -> dict[str, tuple[int, float]]:
    """On which page each anchor was printed, and how many mm of text had room below it."""
    import pypdfium2
    import pypdfium2.raw as pdfium

    printed, places = pypdfium2.PdfDocument(pdf), {}
    for name in anchors:
        place = pdfium.FPDF_GetNamedDestByName(printed, name.encode())
        if not place:
            sys.exit(f"The PDF has no place for the link to {name}.")
        view = (pdfium.FS_FLOAT * 4)()  # the left edge, the upper one, the zoom
        pdfium.FPDFDest_GetView(place, pdfium.c_ulong(), view)
        page = pdfium.FPDFDest_GetDestPageIndex(printed, place) + 1
        places[name] = page, view[1] / 72 * 25.4 - FOOT
    return places
