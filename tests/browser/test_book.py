"""The book as it is handed out: printed, in one file, and with the lecturer's own pages."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path
from urllib.parse import urlsplit
from zipfile import ZipFile

import build
import nbformat
import pypdfium2
import pytest
from faults import PANEL, SIZES, of_page, of_paper, stills
from graded import closed, leaks
from live import PATIENCE, ROOT, assert_slider_matters, chapters, pages, sliders

pytestmark = [pytest.mark.slow]
if not os.environ.get("BOOK_HTML"):
    pytestmark.append(pytest.mark.needs("npm"))


def test_the_lecturers_build_has_the_guide_and_the_solutions(tmp_path, browser_page):
    command = [sys.executable, ROOT / "book" / "tools" / "build.py", tmp_path, "--lecturer"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
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
        tools = ROOT / "book" / "tools"
        done = subprocess.run(
            [sys.executable, "-c", command, site.parent], cwd=tools, capture_output=True, text=True
        )
        assert done.returncode == 0, done.stdout + done.stderr
    return site.parent / "book.pdf"


@pytest.mark.needs("browser")
def test_the_printed_book_holds_every_chapter(site, book):
    assert book.is_file(), "build the book with --pdf"
    printed = pypdfium2.PdfDocument(book)
    text = "\n".join(page.get_textpage().get_text_bounded() for page in printed)
    begins = {it.get_title(): it.get_dest().get_index() + 1 for it in printed.get_toc()}
    contents = " ".join(text.split("Contents", 1)[1].split())
    for chapter in chapters():
        number = int(chapter.name[:2])
        heading = nbformat.read(chapter, 4).cells[0].source.splitlines()[0]
        title = f"{number}. {heading.removeprefix('# ')}"
        assert f"{title} {begins[title]} " in contents
        assert f"Exercise {number}.1" in text
    assert "Bibliography" in text
    assert not [each for each in closed() if each in " ".join(text.split())]
    assert re.search(r"\(24\)\s+\[p\.\s+\d+\]", text)  # a reader on paper turns pages
    assert "000" not in re.findall(r"\[p\. (\d+)\]", text)
    assert len(printed) > 10 * len(chapters())
    assert len(begins) > 5 * len(chapters())
    panels = [path.read_text(encoding="utf-8").count(PANEL) for path in pages(site)]
    assert stills(book) == sum(panels) > 5
    faults = Counter(kind for kind, _ in of_paper(book))
    # What can't be broken may not fit where it stands: one page in fifty.
    assert faults.pop("pages more than half empty in a chapter", 0) <= len(printed) / 50
    assert not faults


@pytest.mark.needs("browser")
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
