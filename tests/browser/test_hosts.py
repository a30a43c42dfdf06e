"""Pages in which a panel can't run: without a kernel, and without JavaScript."""

from __future__ import annotations

import re

from host import HOST, TRAITS, served
from live import chapters

from wmrbook import stages
from wmrbook.panel import stills

# A page that nbconvert wrote has html-manager, whose models no kernel answers.
SHOW = """traits => void widgets.show(
    document.body.appendChild(document.createElement('div')), widgets.modelOf(traits))"""
WIDTHS = "() => [...document.querySelectorAll('.wmr-still img')].map(it => it.naturalWidth)"


def test_in_a_page_without_a_kernel_stand_its_picture_and_where_it_moves(emptied_page):
    page, panel = emptied_page, stages.first_drive()
    panel._repr_mimebundle_()
    served(page)
    page.add_script_tag(content=HOST)
    page.evaluate(SHOW, panel.get_state([*TRAITS, "still"]))
    page.locator(".wmr-still img").wait_for()
    assert page.evaluate(WIDTHS) == [700]
    text = " ".join(page.locator(".wmr-still").inner_text().split())
    assert re.search(rf"It stops after \d.* {stills.RUN_IT}$", text)


def test_a_panel_that_has_no_picture_says_there_what_to_do(emptied_page):
    served(emptied_page)
    emptied_page.add_script_tag(content=HOST)
    emptied_page.evaluate(SHOW, stages.first_drive().get_state(TRAITS))
    emptied_page.get_by_text("Run this notebook to move what is here.").wait_for()


def test_without_javascript_a_chapter_has_the_pictures_of_its_panels(site, browser):
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto((site / "notebooks" / f"{chapters()[4].stem}.html").as_uri())
    images = page.locator('img[src*="still-"]')  # else run book/tools/stills.py
    assert images.count() >= 2
    for image in images.all():
        assert image.bounding_box()["width"] > 300
        assert len(image.get_attribute("alt").split()) > 3
    context.close()
