"""The deck of the concept questions in a browser: each slide is read from the last row."""

from __future__ import annotations

import pytest
import slides
from live import open_deck
from test_decks import TROUBLES

from wmrbook import questions
from wmrbook.figures import scenes


@pytest.mark.needs("npm")
def test_each_question_has_a_title_can_be_read_and_fits_and_its_notes_have_formulas(
    tmp_path, browser_page
):
    slides.questions(tmp_path)
    browser_page.set_viewport_size({"width": 1366, "height": 768})
    open_deck(browser_page, (tmp_path / "questions.html").as_uri())
    count = len(questions.made())
    assert browser_page.evaluate("deck.getTotalSlides()") == 3 + count
    pictures = browser_page.locator(".page figure img:first-child")
    assert pictures.count() == 1 + len(scenes.SCENES)
    assert all(picture.get_attribute("alt") for picture in pictures.all())
    assert browser_page.evaluate(TROUBLES) == []
    listed = "it => getComputedStyle(it).listStyleType"
    assert browser_page.locator("ol li").first.evaluate(listed) == "upper-alpha"
    assert browser_page.locator("aside.notes strong").count() == count
    texts = browser_page.locator(".slides, aside.notes").all_text_contents()
    assert not [text for text in texts if "$" in text]
