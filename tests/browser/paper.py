"""What the printed book shows, page by page, and what a reader would find torn in it."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pypdfium2
from pypdfium2.raw import FPDF_PAGEOBJ_IMAGE, FS_MATRIX, FPDFText_GetFontSize, FPDFText_GetMatrix

MM = 72 / 25.4
HEAD, FOOT = (260 - 22) * MM, 20 * MM  # between them stands the text; see book/tools/pdf.css
FULL = 0.6
FONT = re.compile(rb"/BaseFont /(?:[A-Z]{6}\+)?([\w-]+)")


def plain(text: str) -> str:
    """In one line, without the hyphens at the ends of lines."""
    return " ".join(text.replace("\ufffe", "").split())


def letters(text: str) -> str:
    """Without spaces, which a PDF does not have everywhere, and marks."""
    return re.sub(r"[\W_]+", "", text)


class Printed:
    """A PDF: `pages` has the text of each page, `begins` the first page of each heading."""

    def __init__(self, pdf: Path) -> None:
        self.bytes, self.book = pdf.read_bytes(), pypdfium2.PdfDocument(pdf)
        self.pages = [plain(page.get_textpage().get_text_bounded()) for page in self.book]
        self.outline = [
            (it.level, plain(it.get_title()), it.get_dest().get_index() + 1)
            for it in self.book.get_toc()
        ]
        self.begins = {letters(it): page for level, it, page in self.outline if level == 1}

    def of(self, title: str) -> range:
        """The pages of what begins with this title."""
        first = self.begins[letters(title)]
        later = [page for page in self.begins.values() if page > first]
        return range(first, min(later, default=len(self.pages) + 1))

    def text(self, title: str) -> str:
        return " ".join(self.pages[page - 1] for page in self.of(title))

    def lines(self, numbers: range) -> list[str]:
        """The lines of these pages between their heads and feet: a sentence runs on there."""
        pages = (self.book[number - 1].get_textpage() for number in numbers)
        boxes = (page.get_text_bounded(top=HEAD, bottom=FOOT) for page in pages)
        return [line.strip() for box in boxes for line in box.splitlines()]

    def fonts(self) -> set[str]:
        names = {name.decode() for name in FONT.findall(self.bytes)}
        return names | ({"drawings"} if b"/Subtype /Type3" in self.bytes else set())

    def pictures(self) -> list[int]:
        """Of each picture how many colours it has."""
        images = (it for page in self.book for it in page.get_objects([FPDF_PAGEOBJ_IMAGE]))
        pixels = (it.get_bitmap().to_numpy()[::8, ::2] for it in images)
        return [len(np.unique(it.reshape(-1, it.shape[-1]), axis=0)) for it in pixels]

    def faults(self) -> list[tuple[str, str]]:
        """The faults that one sees, as pairs of kind and place."""
        faults, matrix = [], FS_MATRIX()
        ends = {page - 1 for page in self.begins.values()} | {1, 2, len(self.book)}
        for number, page in enumerate(self.book, start=1):
            # The order of the text is that of painting, not of reading: places tell what is last.
            inside = page.get_textpage()
            text, letters = inside.get_text_range(), []  # height of the line, size, letter
            for place, letter in enumerate(text):
                if not letter.isspace() and FPDFText_GetMatrix(inside, place, matrix):
                    size = FPDFText_GetFontSize(inside, place) * matrix.d
                    letters += [(round(matrix.f), size, letter)] if FOOT < matrix.f < HEAD else []
            rows = (page.render(scale=0.4, grayscale=True).to_numpy() < 210).any(axis=1)
            from_top, to_foot = int(len(rows) * 22 / 260), int(len(rows) * 240 / 260)
            ink = np.flatnonzero(rows[from_top:to_foot]) / (to_foot - from_top)
            found = {
                "blank": not len(ink),
                "less than 60 % full in a chapter": (
                    len(ink) and ink[-1] < FULL and number not in ends
                ),
                "a heading at the foot": letters and min(letters)[1] > 13 and number not in ends,
                "text under 8 points": any(size < 7.9 for _, size, _ in letters),
                "a gap after the number of a page": re.search(r"\[p\.\s\d+\]\s+[.,;:)]", text),
            }
            faults += [(kind, f"page {number}") for kind, is_so in found.items() if is_so]
        return faults
