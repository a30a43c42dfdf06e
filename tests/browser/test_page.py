"""The built book, opened from the disk: every page complete, quiet and alive; and printed."""

from __future__ import annotations

import itertools
import os
import re
import subprocess
import sys
from collections import Counter
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit
from zipfile import ZipFile

import build
import nbformat
import pypdfium2
import pytest
from faults import PANEL, SIZES, of_page, of_paper, stills
from graded import closed
from live import PATIENCE, ROOT, assert_slider_matters, chapters, settled_picture, sliders

pytestmark = [] if os.environ.get("BOOK_HTML") else pytest.mark.needs("npm")

# Formulas that would have to be scrolled.
WIDE = """() => [...document.querySelectorAll('mjx-container[display]')]
    .filter(it => it.scrollWidth > it.clientWidth + 1).map(it => it.innerText)"""


def pages(site: Path) -> list[Path]:
    """The pages of the site, without the theme's own files."""
    return sorted(path for path in site.rglob("*.html") if "_static" not in path.parts)


def test_every_page_opens_without_trouble_and_without_faults(site, opened, browser_page):
    names = [path.relative_to(site).as_posix() for path in pages(site)]
    assert {"index.html", "explorer.html"} < set(names)
    loaded = set()
    browser_page.on("request", lambda request: loaded.add(unquote(urlsplit(request.url).path)))
    for name, scheme in zip(names, itertools.cycle(["light", "dark"]), strict=False):
        browser_page.emulate_media(color_scheme=scheme)
        browser_page.set_viewport_size({"width": 1366, "height": 768})
        loaded.clear()
        page = opened(name)
        assert sum(path.stat().st_size for path in map(Path, loaded) if path.is_file()) < 4e6, name
        assert page.locator("html").get_attribute("data-theme") == scheme
        assert page.locator("h1:visible").count() == 1, name
        assert page.locator("mjx-merror, .widget-error").count() == 0, name
        page.assert_quiet()
        assert page.evaluate(WIDE) == [], name
        every = "EVERY_SIZE" in os.environ  # and both themes
        faults = of_page(page) if every else of_page(page, SIZES[:1], (scheme,))
        assert not faults, f"{name}: {faults}"


def test_every_slider_moves_by_keyboard_and_changes_the_picture(opened):
    page = opened("explorer.html")
    found = sliders(page)
    assert len(found) >= 4  # k_rho, k_alpha, h and at least one more
    for slider in found:
        assert_slider_matters(page, slider)


def test_the_panel_follows_the_colour_menu(opened):
    page = opened("explorer.html")
    before = settled_picture(page)
    page.locator(".theme-switch-button:visible").click(timeout=PATIENCE)
    page.locator('.theme-change-button[data-mode="dark"]:visible').click(timeout=PATIENCE)
    assert page.locator("html").get_attribute("data-theme") == "dark"
    assert settled_picture(page) != before
    for event, theme in (("beforeprint", "light"), ("afterprint", "dark")):  # paper is white
        page.evaluate("name => dispatchEvent(new Event(name))", event)
        assert page.locator("html").get_attribute("data-theme") == theme


def test_the_search_says_the_chapter_and_what_stands_around_the_words(opened):
    page = opened("search.html?q=residual")
    found = page.locator("#search-results li", has_text="6. The circle").first
    assert "residual" in found.locator("p.context").inner_text(timeout=PATIENCE)


class _Parts(HTMLParser):
    """What a page names: its anchors, where it points, and what its images say."""

    def __init__(self, path: Path):
        super().__init__()
        self.anchors, self.targets, self.texts = set(), set(), []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        named = {name: value for name, value in attrs if value}
        self.anchors |= {named[name] for name in ("id", "name") if name in named}
        self.targets |= {named[name] for name in ("href", "src") if name in named}
        if tag == "img" and "only-dark" not in named.get("class", ""):  # else it is shown twice
            self.texts.append(named.get("alt", ""))


def test_no_link_of_the_site_is_broken(site):
    parts = {path: _Parts(path) for path in pages(site)}
    for path, page in parts.items():
        for target in page.targets:
            url = urlsplit(target)
            if url.scheme or url.netloc:
                continue
            there = (path.parent / unquote(url.path)).resolve() if url.path else path
            assert there.is_file(), f"{path.name}: {target}"
            assert (
                not url.fragment
                or there not in parts
                or unquote(url.fragment) in parts[there].anchors
            ), f"{path.name}: {target}"


def leaks(folder: Path) -> list[str]:
    """What is the lecturer's alone, and stands in a file of the folder."""
    kinds = {".html", ".js", ".ipynb", ".md", ".txt"}
    paths = [it for it in folder.rglob("*") if it.suffix in kinds and "vendor" not in it.parts]
    texts = [" ".join(it.read_text(encoding="utf-8").split()) for it in paths]
    return [each for each in closed() if any(each in text for text in texts)]


def test_pages_and_search_have_neither_the_guide_nor_solutions(site):
    assert not (site / "lecturers.html").exists()
    assert not leaks(site)


def test_every_image_says_what_it_shows_and_has_a_caption(site):
    for path in pages(site):
        page = _Parts(path)
        for text in page.texts:
            assert len(text.split()) > 3, f"{path.name}: {text!r} is no alternative text"
        captions = [anchor for anchor in page.anchors if anchor.startswith("figure-")]
        assert len(captions) == len(page.texts), path.name


def test_each_chapter_can_be_downloaded_as_a_notebook(site):
    for chapter in chapters():
        page = site / "notebooks" / f"{chapter.stem}.html"
        downloads = [
            target for target in _Parts(page).targets if target.endswith(f"{chapter.stem}.ipynb")
        ]
        assert downloads, page.name
        assert (page.parent / downloads[0]).read_text(encoding="utf-8").startswith("{")


def test_a_papers_equation_that_is_mentioned_leads_to_where_it_is_derived(opened):
    page = opened("notebooks/00_from_gps_to_a_parked_robot.html")
    page.get_by_role("link", name="(24)", exact=True).first.click(timeout=PATIENCE)
    page.wait_for_url("**/10_the_audit.html#paper-24", timeout=PATIENCE)
    page.locator("div.math:has(#paper-24) svg").first.wait_for(timeout=PATIENCE)
    assert "paper 24" in page.locator("div.math:has(#paper-24)").text_content()


@pytest.mark.slow
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


@pytest.mark.slow
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


@pytest.mark.slow
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
