"""The book as it is handed out: printed, in one file, and with the lecturer's own pages."""

from __future__ import annotations

import os
import re
from collections import Counter
from pathlib import Path
from urllib.parse import urlsplit
from zipfile import ZipFile

import build
import conf
import nbformat
import pytest
from faults import PANEL, SIZES, of_page
from lecturers import closed, leaks
from live import (
    PATIENCE,
    ROOT,
    as_shown,
    assert_slider_matters,
    chapters,
    pages,
    run,
    sliders,
)
from paper import Printed, letters
from pdf import terms
from test_live import NAMES

from wmrbook import live

pytestmark = [pytest.mark.slow, pytest.mark.needs("browser")]
FONT = re.compile(r"(SourceSerif4|SourceSans3|JetBrainsMono|STIXTwoText)\w*(-\w+)?")  # shipped
CONTROLS = "Play|Commit|Just show me|Try again|Show the code|Hide the code"


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


@pytest.fixture(scope="module")
def printed(book) -> Printed:
    assert book.is_file(), "build the book with --pdf"
    return Printed(book)


def test_the_printed_book_is_a_book(site, printed):
    title, back, contents = *printed.pages[:2], letters(printed.text("Contents"))
    assert conf.project in title
    assert conf.edition in title
    assert all(words in back for words in ("CC BY 4.0", "BSD", "Yousif", conf.edition))
    for chapter in chapters():
        number = int(chapter.name[:2])
        heading = nbformat.read(chapter, 4).cells[0].source.splitlines()[0].removeprefix("# ")
        its_pages = printed.of(f"{number}. {heading}")
        assert letters(f"{number} {heading} {its_pages[0]}") in contents
        for page in its_pages:
            head = f"{number} {heading}" if page % 2 else conf.project
            assert head in printed.pages[page - 1]
            assert str(page) in printed.pages[page - 1]
        assert f"Exercise {number}.1" in printed.text(f"{number}. {heading}")
    assert "Bibliography" in printed.begins
    text = " ".join(printed.pages)
    assert not [it for it in closed() if it in text]
    assert re.search(r"\(24\) \[p\. \d+\]", text)  # a reader on paper turns pages
    assert not [name for name in printed.fonts() if not FONT.fullmatch(name)]
    panels = [path.read_text(encoding="utf-8").count(PANEL) for path in pages(site)]
    pictures = printed.pictures()
    assert len(pictures) > sum(panels) > 5
    assert min(pictures) > 3
    assert not Counter(kind for kind, _ in printed.faults())


def test_what_the_printed_book_lists_stands_where_it_says(printed):
    figures = " ".join(printed.lines(printed.of("Figures")))
    listed = re.findall(r"\b(\d+\.\d+) \D.*?(\d+)(?= \d+\.\d+ \D)", figures)
    line = re.compile(r"(?:\d+ ?(?=\D))?(.+?) ?(\d+)")
    entries = [line.fullmatch(it) for it in printed.lines(printed.of("Contents"))]
    entries = [it for it in entries if it]
    assert len(entries) > 5 * len(chapters())
    for entry, page in (it.groups() for it in entries):
        heading = re.sub(r"^.*\d{3} ", "", entry)  # of two that came as one line
        assert letters(heading) in letters(printed.pages[int(page) - 1]), heading
    assert len(listed) > 30
    for number, page in listed:
        assert f"Figure {number}." in printed.pages[int(page) - 1], f"figure {number}"
    index = "".join("".join(printed.lines(printed.of("Index"))).split())
    terms_pages = {
        term: re.search(rf"(?<=[\dxt]){re.escape(term.replace(' ', ''))}((?:,\d+)+)", index)
        for term, _ in terms()
    }
    assert len(terms_pages) >= 80
    for term, pattern in terms():
        for page in re.findall(r"\d+", terms_pages[term][1]):
            said = printed.pages[int(page) - 1]
            assert re.search(pattern, said, re.IGNORECASE), f"{term}: page {page}"


def test_paper_has_states_and_no_controls_and_answers_at_the_back(printed):
    at_the_back = printed.of("Answers to the predictions")
    back, before = (
        " ".join(printed.lines(it)) for it in (at_the_back, range(1, at_the_back.start))
    )
    asks = [ask for name in NAMES if (ask := getattr(live, name)().setup["ask"])]
    for ask in asks:
        why, question = (letters(as_shown(ask[part])) for part in ("why", "question"))
        assert why in letters(back), ask["name"]
        assert why not in letters(before), ask["name"]
        assert question.removesuffix("Turnthearrow")[-30:] in letters(before), ask["name"]
    assert len(re.findall(r"Prediction \d+\.\d+\.", before)) == len(asks)
    assert not re.findall(rf"(?<![\w*])(?:{CONTROLS})(?!\w)", before + back)


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
