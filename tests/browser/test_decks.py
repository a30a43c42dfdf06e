"""A chapter's deck, opened from the disk: each slide within its window, the panels alive."""

from __future__ import annotations

import itertools
import os
from pathlib import Path

import pypdfium2
import pytest
import slides
from faults import violations
from live import (
    PATIENCE,
    assert_slider_matters,
    chapters,
    confine,
    open_deck,
)

READY = os.environ.get("SLIDES")
pytestmark = [] if READY else pytest.mark.needs("npm")
NAMES = [f"{path.stem}.slides.html" for path in chapters()]
SOME = "00", "04", "14"  # looked at whenever the tests run; the others are slow
DECK, CHAPTER = NAMES[0], "00"  # with a panel
SIZES = [(1280, 720)] + [(1920, 1080), (1366, 768), (1024, 768)] * bool(READY)
TROUBLES = (Path(__file__).parent / "slides.js").read_text(encoding="utf-8")
# Notes on each canvas how high the letters are that it shows, in pixels of the page.
LETTERS = """for (const name of ['fillText', 'strokeText', 'fillRect']) {
    const draw = CanvasRenderingContext2D.prototype[name];
    CanvasRenderingContext2D.prototype[name] = function (what, ...rest) {
        const { canvas, font } = this, matrix = this.getTransform();
        if (name === 'fillRect') { // over all of it: what it showed is gone
            if (rest[1] * matrix.a > canvas.width - 2) canvas.letters = new Map();
        } else if (what.trim()) {
            const high = Number(/([\\d.]+)px/.exec(font)[1]) * Math.hypot(matrix.c, matrix.d);
            (canvas.letters ??= new Map()).set(what, high * canvas.clientHeight / canvas.height);
        }
        return draw.call(this, what, ...rest);
    };
}"""
ALL_OPEN = """() => ![...document.querySelectorAll('.live')].some(
    it => it.dataset.open !== 'true' || it.dataset.moving)"""
STAGE = '[data-program="stages/first_drive"]'
SHOW = """what => {
    const at = deck.getIndices(document.querySelector(what).closest('section'));
    deck.slide(at.h, at.v);
}"""


@pytest.fixture(scope="session")
def decks(made_once) -> Path:
    """The folder that the environment variable SLIDES names, or one with all decks, made now."""
    if READY:
        return Path(READY).resolve()
    return made_once("decks", lambda folder: slides.main(folder, []))


@pytest.fixture
def opened(decks, browser_page):
    """Opens a deck and waits until it is drawn; a request that leaves its folder is a trouble."""
    confine(browser_page, decks)
    browser_page.add_init_script(LETTERS)

    def open_of_size(name: str, size=SIZES[0]):
        browser_page.set_viewport_size({"width": size[0], "height": size[1]})
        open_deck(browser_page, f"{decks.as_uri()}/{name}")
        return browser_page

    return open_of_size


def go_to_panel(page):
    """Opens the first slide with a stage and returns its first slider."""
    page.evaluate(SHOW, STAGE)
    stage = page.locator("section.present .stage[data-done=true]")
    stage.wait_for(timeout=PATIENCE)
    return stage.locator(".wmr-slider:visible").first


ANSWER = """() => {
    for (const chips of document.querySelectorAll('.live[data-open="false"] .live-answers')) {
        const options = [...chips.querySelectorAll('.live-chip:not(:disabled)')];
        (options.at(-1) || chips.querySelector('.live-skip')).click();
    }
}"""


@pytest.mark.parametrize(
    "name",
    [pytest.param(it, marks=[pytest.mark.slow] * (it[:2] not in SOME)) for it in NAMES],
)
def test_each_slide_can_be_read_and_its_picture_is_large_before_and_after_an_answer(name, opened):
    faults = []
    for width, height in SIZES:  # a resize would fit what is answered only
        page = opened(name, (width, height))
        page.evaluate("deck.showAll()")
        for answered in (False, True):
            if answered:
                page.evaluate(ANSWER)
                page.wait_for_function(ALL_OPEN, timeout=PATIENCE)
            for _ in range(10):  # a panel that is drawn late is fitted late
                page.wait_for_timeout(300)
                if not (troubles := page.evaluate(TROUBLES)):
                    break
            faults += [(height, answered, *it) for it in troubles]
        if height == SIZES[0][1]:
            assert page.locator("mjx-merror, [data-mjx-error], .widget-error").count() == 0
            assert "$" not in page.locator(".slides").inner_text()
            texts = page.eval_on_selector_all(".slides img", "them => them.map(it => it.alt)")
            assert all(len(text.split()) > 3 for text in texts)
    assert not faults, "\n".join(map(str, faults))


def test_a_slide_plays_on_each_visit_and_keys_let_the_deck_go_on_or_turn_dark(
    opened,
):
    page = opened(DECK)
    for _ in range(2):
        page.locator("section.present .stage[data-done=true]").wait_for(timeout=PATIENCE)
        page.keyboard.press("ArrowRight")
        page.keyboard.press("ArrowLeft")
        page.locator("section.present .stage[data-done=false]").wait_for(timeout=PATIENCE)
    page.keyboard.press("a")
    assert page.evaluate("deck.getConfig().autoSlide") > 10_000
    page.keyboard.press("a")
    assert page.evaluate("deck.getConfig().autoSlide") == 0
    page.evaluate(SHOW, "figure > img")
    light = page.locator("section.present img:visible").get_attribute("src")
    page.keyboard.press("d")
    assert page.evaluate("document.documentElement.dataset.theme") == "dark"
    assert page.locator("section.present img:visible").get_attribute("src") != light


def test_the_arrow_the_space_bar_and_a_remote_control_walk_through_a_deck(opened):
    page = opened(DECK)
    page.add_style_tag(content="* { transition: none !important; }")  # no colour halfway
    where, seen = "JSON.stringify(deck.getState())", set()
    for key in itertools.cycle(("ArrowRight", "Space", "PageDown")):
        seen.add(page.evaluate("deck.getIndices().h"))
        if len(seen) % 6 == 1:  # each would take half a minute
            assert not violations(page)
        if page.evaluate("deck.isLastSlide()"):
            break
        before = page.evaluate(where)
        page.keyboard.press(key)
        page.wait_for_function(f"before => {where} !== before", arg=before, timeout=PATIENCE)
    assert len(seen) == page.evaluate("deck.getTotalSlides()")


def test_a_slider_moves_by_keyboard_and_the_slide_stays(opened):
    page = opened(DECK)
    slider = go_to_panel(page)
    for _ in range(30):  # Tab goes round in what can be seen
        page.keyboard.press("Tab")
        assert page.evaluate("""() => !document.activeElement.closest('section')
            || deck.getCurrentSlide().contains(document.activeElement)""")
    where = page.evaluate("deck.getIndices()")
    assert_slider_matters(page, slider)
    assert page.evaluate("deck.getIndices()") == where
    page.keyboard.press("Escape")
    page.keyboard.press("ArrowRight")
    page.wait_for_function("before => deck.getIndices().h !== before.h", arg=where)


def test_after_a_click_in_a_panel_the_arrow_leads_on(opened):
    page = opened(DECK)
    page.evaluate(SHOW, "[data-asks]")
    page.locator("section.present .stage[data-done=true]").wait_for(timeout=PATIENCE)
    page.locator("section.present .stage-chip:visible").first.click()
    where = page.evaluate("deck.getIndices().h")
    page.keyboard.press("ArrowRight")
    page.wait_for_function("h => deck.getIndices().h > h", arg=where, timeout=PATIENCE)


def test_the_speakers_view_shows_the_notes_from_the_disk_and_each_formula_once(decks, opened):
    slides.main(decks / "lecturer", [CHAPTER], lecturer=True)  # its notes have formulas
    page = opened(f"lecturer/{DECK}")
    assert page.locator("aside.notes svg").count()
    assert not page.locator("aside.notes math").count()
    page.evaluate(SHOW, "aside.notes")
    note = page.locator("section.present aside.notes p").first.text_content()
    with page.expect_popup(timeout=PATIENCE) as popup:
        page.keyboard.press("s")
    popup.value.wait_for_function(
        "note => document.querySelector('.speaker-controls-notes')?.textContent.includes(note)",
        arg=note[:30],
        timeout=PATIENCE,
    )


def test_a_deck_prints_a_page_a_slide(opened, tmp_path):
    # Printed, reveal.js counts pages as slides, and wrongly.
    count = opened(DECK).evaluate("deck.getTotalSlides()")
    page = opened(f"{DECK}?print-pdf")
    page.pdf(path=tmp_path / "deck.pdf", prefer_css_page_size=True, print_background=True)
    pages = [
        page.get_textpage().get_text_bounded()
        for page in pypdfium2.PdfDocument(tmp_path / "deck.pdf")
    ]
    assert count <= len(pages) <= count + 1  # Chromium may add an empty one
    assert "while the heading still swings" in pages[count - 1]


def test_the_list_leads_to_each_deck(decks, browser_page):
    browser_page.goto((decks / "index.html").as_uri())
    links = browser_page.eval_on_selector_all(
        "li a", "them => them.map(it => it.getAttribute('href'))"
    )
    assert links == NAMES
