"""What a reader of the built book can't see or use, on a page and in the PDF.

Code lines, formulas, tables and figures that are cut, figures with small letters, what axe-core
finds in the light and in the dark, and of the PDF lost panels and pages that look torn.
"""

from __future__ import annotations

import re
import zlib
from pathlib import Path
from urllib.parse import urlsplit
from urllib.request import url2pathname

import numpy as np
import pypdfium2
from build import MODULES, install_javascript
from pypdfium2.raw import FS_MATRIX, FPDFText_GetFontSize, FPDFText_GetMatrix

ROOT = Path(__file__).resolve().parents[2]
SIZES = ((390, 844), (1366, 768), (1920, 1080))
MEASURE = Path(__file__).with_suffix(".js").read_text(encoding="utf-8")
# Nothing may be seen halfway, such as a colour on its way from light to dark.
UNFOLD = """() => {
    document.querySelectorAll('article details').forEach(it => { it.open = true; });
    document.head.append(Object.assign(document.createElement('style'),
        {textContent: '* { transition: none !important; animation: none !important; }'}));
}"""
FOOT = 51  # points from the edge; below stands a page's number
PANEL = '<script type="application/vnd.jupyter.widget-view+json">'
IMAGE = re.compile(  # in a PDF by Chromium
    rb"/Subtype /Image\s+/Width (\d+)\s+/Height (\d+)\s+/ColorSpace \[/ICCBased[^>]*?"
    rb"/Filter /FlateDecode\s+/Length (\d+)>> stream\r?\n"
)
WIDER = """() => [...document.querySelectorAll('.figure-box')]
    .filter(it => it.scrollWidth > it.clientWidth + 1)
    .map(it => it.querySelector('img').alt.slice(0, 60))"""
LARGER = (
    "() => document.querySelectorAll('.figure-size').forEach(it => it.offsetParent && it.click())"
)
FIGURES = """() => [...document.querySelectorAll('article img[src$=".svg"]')]
    .filter(it => it.checkVisibility() && it.clientWidth)
    .map(it => [it.src, it.clientWidth / it.naturalWidth, it.alt.slice(0, 60)])"""
LETTERS = re.compile(r"scale\(([\d.]+) -")  # of a text in an SVG by matplotlib: hundreds of points
FRAME = "() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"
# Else axe-core takes minutes: of the code tokens of a kind it sees the first, and no formulas,
# which have been looked at.
THIN = """() => {
    const seen = new Set();
    for (const token of document.querySelectorAll('pre span[class]:not(.line, a span)')) {
        if (seen.has(token.className)) token.replaceWith(...token.childNodes);
        seen.add(token.className);
    }
    document.querySelectorAll('pre').forEach(it => it.normalize());
    document.querySelectorAll('mjx-container').forEach(it => it.remove());
}"""
ASK = """only => axe.run(document,
    {resultTypes: ['violations'], preload: false, ...only}).then(
    it => it.violations.flatMap(rule => rule.nodes.map(
        node => [rule.id, node.target.join(' ')])))"""


def axe() -> Path:
    """The script of axe-core, which npm fetches in a fresh clone."""
    install_javascript()
    return MODULES / "axe-core" / "axe.min.js"


def of_page(page, sizes=SIZES, themes=("light", "dark")) -> list[tuple[str, str]]:
    """The faults of a page that is drawn, as pairs of kind and place; it is spoiled then."""
    faults = []
    page.evaluate(UNFOLD)
    for width, height in sizes:
        page.set_viewport_size({"width": width, "height": height})
        page.evaluate(FRAME)
        for kind, places in page.evaluate(MEASURE).items():
            faults += [(f"{kind}, {width}x{height}", place) for place in places]
        cut = f"figures that are not seen whole, {width}x{height}"
        faults += [(cut, place) for place in page.evaluate(WIDER)]
        page.wait_for_timeout(300)  # so late, beside other work, a small figure gets its button
        page.evaluate(LARGER)
        for source, scale, said in page.evaluate(FIGURES):
            svg = Path(url2pathname(urlsplit(source).path)).read_text(encoding="utf-8")
            if min(map(float, LETTERS.findall(svg)), default=1) * scale * 400 / 3 < 9:
                faults.append((f"figures with letters under 9 pixels, {width}x{height}", said))
    page.wait_for_timeout(400)  # so late the theme gives a key to what scrolls in the new size
    page.evaluate(THIN)
    page.add_script_tag(path=axe())
    for theme in themes:
        only = {} if theme == themes[0] else {"runOnly": ["color-contrast"]}
        page.emulate_media(color_scheme=theme)
        page.evaluate(FRAME)
        faults += [(f"axe, {theme}: {rule}", place) for rule, place in page.evaluate(ASK, only)]
    return faults


def stills(pdf: Path) -> int:
    """Count the panels' pictures in the PDF, if all of them show more than a ground."""
    file = pdf.read_bytes()
    for image in IMAGE.finditer(file):  # those that are equal are stored once
        width, height, length = map(int, image.groups())
        if width > 1400 and height > 400:  # no figure has as many pixels
            text = zlib.decompress(file[image.end() : image.end() + length])
            pixels = np.frombuffer(text, np.uint8).reshape(height, width, 3)[height // 2 :: 4]
            codes = pixels @ np.array([65536, 256, 1])
            if min(len(np.unique(half)) for half in np.array_split(codes, 2, axis=1)) < 50:
                return 0
    return file.count(b"/Alt (The live panel,")


def of_paper(pdf: Path) -> list[tuple[str, str]]:
    """The faults of the printed book, as pairs of kind and place."""
    book, faults, matrix = pypdfium2.PdfDocument(pdf), [], FS_MATRIX()
    begins = {it.get_dest().get_index() for it in book.get_toc() if it.level <= 2} | {len(book)}
    # The order of the text is that of painting, not of reading: places tell what is on top.
    for index, page in enumerate(book):
        inside = page.get_textpage()
        text, letters = inside.get_text_range(), []  # these as height of the line, size, letter
        for place, letter in enumerate(text):
            if not letter.isspace() and FPDFText_GetMatrix(inside, place, matrix):
                size = FPDFText_GetFontSize(inside, place) * matrix.d
                letters += [(round(matrix.f), size, letter)] if matrix.f > FOOT else []
        highest = max(letters, default=(0,))[0]
        top = "".join(letter for height, _, letter in letters if height == highest)
        rows = (page.render(scale=0.3, grayscale=True).to_numpy() < 200).any(axis=1)
        ink = np.flatnonzero(rows[: -int(FOOT * 0.3)]) / len(rows)
        found = {
            "blank pages": not len(ink),
            "pages more than half empty in a chapter": (
                len(ink) and ink[-1] < 0.45 and index + 1 not in begins
            ),
            "headings at the foot of a page": letters and min(letters)[1] > 11,  # points
            "figures parted from their code": re.match(r"Figure\d+\.\d+\.", top),
            "text under 8 points": any(size < 8 for _, size, _ in letters),
            "gaps after the number of a page": re.search(r"\[p\.\s\d+\]\s+[.,;:)]", text),
        }
        faults += [(kind, f"page {index + 1}") for kind, is_so in found.items() if is_so]
    return faults
