"""The book as it is handed out: printed, in one file, and with the lecturer's own pages."""

from __future__ import annotations

import os
import re
from pathlib import Path
from urllib.parse import urlsplit
from zipfile import ZipFile

import build
import conf
import nbformat
import pypdfium2
import pytest
from faults import SIZES, of_page
from lecturers import closed, leaks
from live import PATIENCE, ROOT, assert_slider_matters, chapters, letters, run, sliders
from pypdfium2.raw import FPDF_PAGEOBJ_IMAGE

pytestmark = [pytest.mark.slow, pytest.mark.needs("browser")]


@pytest.mark.usefixtures("site")  # what both builds need is there then
def test_the_lecturers_build_has_the_guide_and_the_solutions(tmp_path, browser_page):
    run(ROOT, "book/tools/build.py", tmp_path, "--lecturer")
    site = tmp_path / "lecturer" / "html"
    assert leaks(site) == closed()
    for name in "lecturers.html", "notebooks/04_lyapunov.html", "exercises.html":
        browser_page.goto((site / name).as_uri(), timeout=PATIENCE)
        faults = of_page(browser_page, SIZES[:1], ("light",))
        assert not faults, f"{name}: {faults}"


@pytest.fixture(scope="module")
def book(site) -> Path:
    """The PDF, beside the zip, made from the site unless that is one that is built already."""
    if not os.environ.get("BOOK_HTML"):
        command = "import sys, pathlib, build; output = pathlib.Path(sys.argv[1]); "
        command += "build.make_pdf(output); build.make_zip(output)"
        run(ROOT / "book" / "tools", "-c", command, site.parent)
    return site.parent / "book.pdf"


def test_the_printed_book_has_all_chapters_where_its_contents_say(book):
    """What stands on the pages is a test of one chapter's, in test_page.py."""
    assert book.is_file(), "build the book with --pdf"
    with pypdfium2.PdfDocument(book) as printed:
        pages = [page.get_textpage().get_text_bounded() for page in printed]
        images = [it for page in printed for it in page.get_objects([FPDF_PAGEOBJ_IMAGE])]
    assert letters(conf.edition) in letters(pages[0] + pages[1])
    lines = [letters(line) for page in pages[:5] for line in page.splitlines()]
    for chapter in chapters():
        heading = nbformat.read(chapter, 4).cells[0].source.splitlines()[0].removeprefix("# ")
        title = f"{int(chapter.name[:2])}. {heading}"
        listed = next(filter(None, (re.fullmatch(rf"{letters(title)}(\d+)", it) for it in lines)))
        page = letters(pages[int(listed[1]) - 1])
        assert page.startswith(letters(title + listed[1] + title)), title  # its foot, then itself
    text = letters("".join(pages))
    assert not [it for it in closed() if letters(it) in text]
    assert len(images) > 3 * len(chapters())


def test_the_zip_has_all_that_is_handed_out_and_opens_from_the_disk(book, tmp_path, browser_page):
    assert book.with_name(build.ZIP).is_file(), "build the book with --zip"
    with ZipFile(book.with_name(build.ZIP)) as package:
        rows = package.infolist()
        package.extractall(tmp_path)
    assert {row.date_time for row in rows} == {(1980, 1, 1, 0, 0, 0)}  # the same on another day
    names = [row.filename for row in rows]
    assert names == sorted(names)
    assert not [name for name in names if "/." in name]
    home = tmp_path / "robot-book"
    parts = {"LICENSE", "book.pdf", "html", "index.html", "slides"}
    assert {path.name for path in home.iterdir()} == parts
    assert not leaks(home)
    assert (home / "book.pdf").read_bytes() == book.read_bytes()
    assert b"CreationDate" not in book.read_bytes()
    assert len(list(home.glob("slides/*.slides.html"))) == len(chapters())

    asked = []
    browser_page.on("request", lambda request: asked.append(request.url))
    browser_page.goto((home / "index.html").as_uri())
    links = browser_page.locator("a").evaluate_all("them => them.map(it => it.href)")
    assert {urlsplit(link).path.removeprefix(f"{home}/") for link in links} == {
        *("html/index.html", "slides/index.html", "book.pdf", "LICENSE")
    }
    deck = f"{chapters()[0].stem}.slides.html"
    for page in "html/index.html", "slides/index.html", f"slides/{deck}":
        browser_page.goto((home / page).as_uri(), wait_until="load", timeout=PATIENCE)
    browser_page.goto((home / "html" / "explorer.html").as_uri(), timeout=PATIENCE)
    assert_slider_matters(browser_page, sliders(browser_page)[0])
    assert all(url.startswith((home.as_uri(), "data:", "blob:")) for url in asked)
