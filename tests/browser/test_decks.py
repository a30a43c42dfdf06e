"""A chapter's slides, opened from the disk: each within its window, the panel alive."""

from __future__ import annotations

import itertools
import os
import subprocess
import sys
from pathlib import Path

import pypdfium2
import pytest
from faults import ASK, axe
from live import PATIENCE, ROOT, assert_slider_matters, confine, settled_picture, thumb

READY = os.environ.get("SLIDES")
pytestmark = [] if READY else pytest.mark.needs("npm")
CHAPTER = "00"  # with a panel
SIZES = [(1366, 768), (1024, 768), (1280, 720), (1920, 1080)] if READY else [(1366, 768)]
TROUBLES = (Path(__file__).parent / "slides.js").read_text(encoding="utf-8")
DRAWN = """() => {
    const type = 'application/vnd.jupyter.widget-view+json';
    const panels = [...document.querySelectorAll(`script[type="${type}"]`)];
    return panels.every(it => it.parentElement.querySelector('canvas'));
}"""
SHOW = """what => {
    const at = deck.getIndices(document.querySelector(what).closest('section'));
    deck.slide(at.h, at.v);
}"""


@pytest.fixture(scope="module")
def decks(tmp_path_factory) -> Path:
    """The folder that the environment variable SLIDES names, or one with all decks, made now."""
    if READY:
        return Path(READY).resolve()
    return make(tmp_path_factory.mktemp("decks"))


def make(output: Path, *options: str) -> Path:
    """Make decks in a folder."""
    command = [sys.executable, ROOT / "book" / "tools" / "slides.py", output, *options]
    made = subprocess.run(command, capture_output=True, text=True)
    assert made.returncode == 0, made.stdout + made.stderr
    return output


@pytest.fixture
def opened(decks, browser_page):
    """Opens a deck and waits until it is drawn; a request that leaves its folder is a trouble."""
    confine(browser_page, decks)

    def open_deck(name: str, size=SIZES[0]):
        browser_page.set_viewport_size({"width": size[0], "height": size[1]})
        browser_page.goto(f"{decks.as_uri()}/{name}", wait_until="load", timeout=PATIENCE)
        browser_page.wait_for_function(
            "document.documentElement.dataset.deck === 'ready'", timeout=PATIENCE
        )
        browser_page.wait_for_function(DRAWN, timeout=PATIENCE)
        return browser_page

    return open_deck


def made(decks: Path) -> list[Path]:
    return sorted(decks.glob("*.slides.html"))


def with_panel(decks: Path) -> str:
    return next(path.name for path in made(decks) if path.name.startswith(CHAPTER))


def go_to_panel(page):
    """Opens the slide with the Explorer, by its address."""
    page.evaluate(SHOW, ".panel .wmr-stage")
    page.locator(".wmr-stage canvas:visible").first.wait_for(timeout=PATIENCE)


def first_slider(page):
    return page.locator(".wmr-stage .wmr-slider:visible").first


def test_each_slide_has_a_title_and_a_sentence_that_can_be_read_and_all_of_it_fits(decks, opened):
    found = []
    for path in made(decks):
        page = opened(path.name)
        assert page.evaluate("deck.getTotalSlides()") >= 15
        for width, height in SIZES:
            page.set_viewport_size({"width": width, "height": height})
            page.wait_for_function("size => deck.fitted === size", arg=f"{width} {height}")
            for _ in range(10):  # a panel that is drawn late is fitted late
                if not (troubles := page.evaluate(TROUBLES)):
                    break
                page.wait_for_timeout(300)
            found += [(path.name[:2], height, *it) for it in troubles]
        assert page.locator("section mjx-container svg").count() > 10
        assert page.locator("mjx-merror, [data-mjx-error], .widget-error").count() == 0
        assert "$" not in page.locator(".slides").inner_text()
        texts = page.eval_on_selector_all(".slides img", "them => them.map(it => it.alt)")
        assert all(len(text.split()) > 3 for text in texts)
        assert page.locator("figure .caption").count() == len(texts) > 0
    assert not found, "\n".join(map(str, found))


def test_the_arrow_the_space_bar_and_a_remote_control_walk_through_a_deck(decks, opened):
    page = opened(with_panel(decks))
    page.add_style_tag(content="* { transition: none !important; }")  # no colour halfway
    page.add_script_tag(path=axe())
    where, seen = "JSON.stringify(deck.getState())", set()
    for key in itertools.cycle(("ArrowRight", "Space", "PageDown")):
        seen.add(page.evaluate("JSON.stringify(deck.getIndices().h * 100 + deck.getIndices().v)"))
        if len(seen) % 6 == 1:  # each would take half a minute
            assert not page.evaluate(ASK, {})
        if page.evaluate("deck.isLastSlide() && !deck.availableFragments().next"):
            break
        before = page.evaluate(where)
        page.keyboard.press(key)
        page.wait_for_function(f"before => {where} !== before", arg=before, timeout=PATIENCE)
    assert len(seen) == page.evaluate("deck.getTotalSlides()")
    assert page.locator(".fragment:not(.visible)").count() == 0


def test_a_slider_moves_by_keyboard_and_the_slide_stays(decks, opened):
    page = opened(with_panel(decks))
    go_to_panel(page)
    for _ in range(30):  # Tab goes round in what can be seen
        page.keyboard.press("Tab")
        assert page.evaluate("""() => !document.activeElement.closest('section')
            || deck.getCurrentSlide().contains(document.activeElement)""")
    where = page.evaluate("deck.getIndices()")
    assert_slider_matters(page, first_slider(page))
    assert page.evaluate("deck.getIndices()") == where
    page.keyboard.press("Escape")
    page.keyboard.press("ArrowRight")
    page.wait_for_function(
        "before => JSON.stringify(deck.getIndices()) !== before",
        arg=page.evaluate("it => JSON.stringify(it)", where),
    )


@pytest.mark.parametrize("size", [(1920, 1080), (1024, 768)], ids=str)
def test_a_slider_and_the_goal_follow_the_pointer(decks, opened, size):
    page = opened(with_panel(decks), size)
    go_to_panel(page)
    slider, goal = first_slider(page), page.locator(".wmr-stage .wmr-handle:visible").first

    def drag(x, y, right, up):
        before = settled_picture(page)
        page.mouse.move(x, y)
        page.mouse.down()
        page.mouse.move(x + right, y - up, steps=5)
        page.mouse.up()
        assert settled_picture(page) != before

    x, y = thumb(slider)
    drag(x, y, 25, 0)
    assert thumb(slider)[0] - x == pytest.approx(25, abs=3)  # it stays under the pointer
    box = goal.bounding_box()
    drag(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2, 40, 20)


def test_the_speakers_view_shows_the_notes_from_the_disk_and_each_formula_once(decks, opened):
    ours = make(decks / "lecturer", "--lecturer", "--chapters", CHAPTER)  # its notes have formulas
    page = opened(f"{ours.name}/{with_panel(ours)}")
    assert page.locator("aside.notes svg").count()
    assert not page.locator("aside.notes math").count()
    page.evaluate(SHOW, "aside.notes")
    note = page.locator(
        "section.present section.present aside.notes p, section.present > .page aside.notes p"
    ).first.text_content()
    with page.expect_popup(timeout=PATIENCE) as popup:
        page.keyboard.press("s")
    popup.value.wait_for_function(
        "note => document.querySelector('.speaker-controls-notes')?.textContent.includes(note)",
        arg=note[:30],
        timeout=PATIENCE,
    )


def test_a_key_shows_and_hides_the_code(decks, opened):
    page = opened(with_panel(decks))
    page.evaluate(SHOW, "details.code")
    code = page.locator("section.present details.code pre").first
    assert not code.is_visible()
    page.keyboard.press("c")
    code.wait_for(state="visible", timeout=PATIENCE)
    assert "wmr." in code.inner_text()
    page.keyboard.press("c")
    code.wait_for(state="hidden", timeout=PATIENCE)


def test_a_deck_prints_a_page_a_slide(decks, opened, tmp_path):
    slides = opened(with_panel(decks)).evaluate(
        "deck.getTotalSlides()"
    )  # printed, reveal.js counts pages as slides, and wrongly
    page = opened(f"{with_panel(decks)}?print-pdf")
    page.pdf(path=tmp_path / "deck.pdf", prefer_css_page_size=True, print_background=True)
    pages = [
        page.get_textpage().get_text_bounded()
        for page in pypdfium2.PdfDocument(tmp_path / "deck.pdf")
    ]
    assert slides <= len(pages) <= slides + 1  # Chromium may add an empty one
    assert "Summary" in pages[slides - 1]


def test_the_list_leads_to_each_deck(decks, browser_page):
    browser_page.goto((decks / "index.html").as_uri())
    links = browser_page.eval_on_selector_all(
        "li a", "them => them.map(it => it.getAttribute('href'))"
    )
    assert links == [path.name for path in made(decks)]
