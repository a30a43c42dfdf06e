"""The concept questions in a browser: the slides to vote by, and the form on a telephone."""

from __future__ import annotations

import pytest
import slides
from faults import of_page
from live import again, open_deck
from test_decks import TROUBLES

from wmrbook import questions
from wmrbook.figures import scenes
from wmrbook.lines import Line, read, written
from wmrbook.questions.form import form


@pytest.mark.needs("npm")
def test_each_slide_to_vote_by_has_a_title_and_can_be_read_and_all_of_it_fits(
    tmp_path, browser_page
):
    slides.vote(tmp_path)
    browser_page.set_viewport_size({"width": 1366, "height": 768})
    open_deck(browser_page, (tmp_path / "questions.html").as_uri())
    assert browser_page.evaluate("deck.getTotalSlides()") == 3 + 2 * len(questions.made())
    pictures = browser_page.locator(".page figure img:first-child")
    assert pictures.count() == 1 + len(scenes.SCENES)
    assert all(each.get_attribute("alt") for each in pictures.all())
    assert browser_page.evaluate(TROUBLES) == []
    listed = "it => getComputedStyle(it).listStyleType"
    assert browser_page.locator("ol li").first.evaluate(listed) == "upper-alpha"
    assert "$" not in browser_page.locator(".slides").inner_text()


@pytest.mark.needs("npm")
def test_the_form_on_a_telephone_makes_a_line_that_counts(tmp_path, browser_page):
    made = questions.tested()
    path = tmp_path / "questions.html"
    path.write_text(form(made), encoding="utf-8")
    browser_page.set_viewport_size({"width": 390, "height": 844})
    browser_page.goto(path.as_uri())
    line = browser_page.locator("#line")
    assert line.input_value() == ""  # nobody's
    name = "  Zoë O'Neil (4)\u00a0! "
    browser_page.fill("#who", name)
    browser_page.get_by_label("after it").check()
    answers = [*"ABCDE", *["-"] * (len(made) - 6), "E"]
    for at, letter in enumerate(answers, start=1):
        if letter != "-" or at % 2:  # every second open one is not touched at all
            browser_page.locator(f"input[name=q{at}][value='{letter}']").check()
    assert browser_page.locator("#state").text_content().startswith(f"6 of {len(made)} answered")
    told = line.input_value()
    which = f"post-{questions.fingerprint(made)}"
    assert read(told) == Line("test", which, "Zoë O'Neil (4) !", "".join(answers))
    again(browser_page, "wmr-test-", browser_page.reload)
    assert line.input_value() == told
    for size in range(1, 61):  # of every length that a block of the checksum can end in
        one = Line("gate", "ch04-level", "ñ" * size, "left of it")
        assert browser_page.evaluate("it => wmrLine(...it)", list(one)) == written(one)
    faults = of_page(browser_page, sizes=((390, 844),))
    assert faults == []
    for button, left in (("Copy the line", name.strip()), ("Clear all", "")):
        browser_page.get_by_role("button", name=button).click()
        browser_page.wait_for_timeout(1000)  # ms: a clipboard may take its time
        browser_page.reload()
        assert browser_page.locator("#who").input_value().strip() == left
        assert browser_page.locator("#state").text_content().startswith("0 of")


@pytest.mark.parametrize(
    "blocked", ["throw new DOMException('no', 'SecurityError')", "return null"]
)
def test_the_form_works_where_a_browser_keeps_nothing(blocked, tmp_path, browser_page):
    browser_page.add_init_script(
        f"Object.defineProperty(window, 'localStorage', {{ get() {{ {blocked}; }} }})"
    )
    path = tmp_path / "questions.html"
    path.write_text(form(questions.tested()), encoding="utf-8")
    browser_page.goto(path.as_uri())
    browser_page.fill("#who", "Ada")
    browser_page.locator("input[name=q1][value='B']").check()
    assert read(browser_page.locator("#line").input_value()).value[:2] == "B-"
    assert "answer in one go" in browser_page.locator("#kept").text_content()
