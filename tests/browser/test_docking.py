"""A chapter opens with its stage, which stays beside the text where the window is wide enough."""

from __future__ import annotations

import json

import nbformat
import pytest

pytest.importorskip("sphinx", reason="a page is made by Sphinx")
from live import chapters

DESK, TELEPHONE = {"width": 1366, "height": 768}, {"width": 390, "height": 844}
CHAPTERS = {path.stem: nbformat.read(path, as_version=4) for path in chapters()}
BOX = "it => { const { left, top, right, bottom } = it.getBoundingClientRect();" + (
    " return { left, top, right, bottom }; }"
)
SLIDERS = """() => [...document.querySelectorAll('.wmr.stage')].filter(it => it.offsetWidth)
    .map(it => [...it.querySelectorAll('input[type=range]')].map(it => it.offsetWidth))"""
# Scrolls to each section, and returns which scenes the stage then shows.
READ = """async () => {
    const shown = [], frame = () => new Promise(done => requestAnimationFrame(done));
    for (const section of document.querySelectorAll('section[class*="stage-"]')) {
        section.scrollIntoView({ behavior: 'instant' });
        for (let k = 0; k < 6; k += 1) await frame();
        shown.push(document.querySelector('.docked-stage .wmr.stage').dataset.scene);
    }
    return shown;
}"""


# Where the section that the address names is, and what the stage shows there.
ARRIVED = """() => [
    document.querySelector(decodeURIComponent(location.hash)).getBoundingClientRect().top,
    document.querySelector('.docked-stage .wmr.stage').dataset.scene,
]"""
# What stands at the window's head, and how far above or below it.
HEAD = """() => {
    const parts = [...document.querySelectorAll('.bd-article section > :not(section)')],
        boxes = parts.map(it => it.getBoundingClientRect()),
        part = boxes.findIndex(({ bottom, height }) => height && bottom > 0);
    return [part, Math.round(boxes[part].top)];
}"""
IDS = """() => [...document.querySelectorAll('section[class*="stage-"]')].map(it => it.id)"""


def settle(page) -> None:
    """Wait until nothing on the page changes its height any more."""
    page.wait_for_function(
        """async () => {
            const high = () => document.documentElement.scrollHeight, before = high();
            await new Promise(done => setTimeout(done, 300));
            return high() === before;
        }"""
    )


def scenes(notebook) -> list[str]:
    """The scenes that the sections of a chapter name, in order."""
    return [cell.metadata["stage"] for cell in notebook.cells if "stage" in cell.metadata]


@pytest.mark.parametrize("name", CHAPTERS)
def test_a_section_names_a_scene_that_its_chapters_stage_has(name):
    (stored,) = CHAPTERS[name].metadata["widgets"].values()
    setups = [it["state"].get("setup", {}) for it in stored["state"].values()]
    known = [{scene["name"] for scene in it["scenes"]} for it in setups if "scenes" in it]
    assert known, "no stage"
    assert set(scenes(CHAPTERS[name])) <= known[0]


@pytest.mark.slow
def test_every_chapter_opens_with_its_stage_on_the_first_screen(opened, browser_page):
    browser_page.set_viewport_size(DESK)
    for name in CHAPTERS:
        page = opened(f"notebooks/{name}.html")
        stage = page.locator(".wmr.stage").first
        box = stage.locator("canvas").evaluate(BOX)
        assert 0 < box["top"] < 300, name
        assert box["bottom"] - box["top"] >= 300, name
        assert stage.evaluate(BOX)["bottom"] <= DESK["height"], f"{name}: a handle is cut off"
        assert stage.locator(".stage-words[data-on=true]").inner_text().strip(), name
        assert all(width >= 240 for row in page.evaluate(SLIDERS) for width in row), name


def test_beside_the_text_the_stage_follows_the_reader(opened, browser_page):
    browser_page.set_viewport_size(DESK)
    (name, notebook), *_ = CHAPTERS.items()
    page = opened(f"notebooks/{name}.html")
    page.wait_for_selector("html.docked")
    stage = page.locator(".docked-stage .wmr.stage")
    text = page.locator(".bd-article section > p").first
    box = stage.evaluate(BOX)
    assert box["bottom"] <= DESK["height"], "the stage is higher than the window"
    assert box["right"] <= DESK["width"], "the stage is wider than the window"
    assert text.evaluate(BOX)["right"] <= box["left"], "the stage lies on the text"
    named = scenes(notebook)
    assert page.evaluate(READ) == named, json.dumps(named)
    assert stage.evaluate(BOX) == box, "it stays where it was"
    shown = [it for it in page.locator(".wmr.stage").all() if it.is_visible()]
    assert len(shown) == 1, "where it is docked it does not return"

    page.set_viewport_size(TELEPHONE)
    page.wait_for_selector("html:not(.docked)")
    shown = [it for it in page.locator(".wmr.stage").all() if it.is_visible()]
    assert len(shown) > 1, "where it is not docked it returns"
    widths = page.evaluate(SLIDERS)
    assert all(width >= 200 for row in widths for width in row), widths
    page.evaluate("scrollTo({ top: 0, behavior: 'instant' })")
    box = page.locator(".wmr.stage").first.evaluate(BOX)
    assert box["bottom"] - box["top"] <= TELEPHONE["height"] - 56, "picture and sliders on a screen"


def test_on_a_telephone_a_section_without_a_stage_of_its_own_can_have_it(opened, browser_page):
    browser_page.set_viewport_size(TELEPHONE)
    page = opened("notebooks/12_your_own_gps.html")
    stage = page.locator(".wmr.stage").first
    stage.locator("canvas").wait_for()
    opening, sections = stage.get_attribute("data-scene"), page.locator("section[class*=stage-]")
    shown, at_home = [], page.locator("h1 ~ .cell .wmr.stage")
    for section in sections.all():
        own, scene = section.locator(":scope > .tag_stage"), section.get_attribute("class")
        if not own.count():
            head = section.locator(":scope > h2")
            head.scroll_into_view_if_needed()
            before = head.evaluate(BOX)["top"]
            section.locator(":scope > .bring-stage").click()
            assert abs(head.evaluate(BOX)["top"] - before) < 2, "the reader has lost the place"
            assert at_home.count() == 0, "the stage is twice on the page"
        own.locator("canvas").wait_for()
        shown.append(own.locator(".wmr.stage").get_attribute("data-scene"))
        assert f"stage-{shown[-1]}" in scene.split(), scene
    assert len({*shown}) > 4, shown
    page.locator(".bring-stage").first.click()
    assert at_home.get_attribute("data-scene") == opening


def test_a_docked_page_keeps_its_buttons_its_links_and_the_readers_place(opened, browser_page):
    browser_page.set_viewport_size(DESK)
    (name, notebook), *_ = CHAPTERS.items()
    page = opened(f"notebooks/{name}.html")
    names = page.evaluate(IDS)
    page.locator(".secondary-toggle:visible").click()
    link = page.locator("dialog[open] a", has_text="How far, and which way?")
    link.wait_for()
    page.keyboard.press("Escape")
    link.wait_for(state="hidden")
    page.locator(".primary-toggle:visible").click()
    drawer = page.locator("#pst-primary-sidebar")
    drawer.wait_for()
    page.keyboard.press("Escape")
    drawer.wait_for(state="hidden")
    page.locator(".theme-switch-button:visible").click()
    menu = page.locator(".dropdown-menu.show")
    menu.wait_for()
    page.keyboard.press("Escape")
    menu.wait_for(state="hidden")

    for wanted, section in list(zip(scenes(notebook), names, strict=True))[1::3]:
        page.goto("about:blank")
        page = opened(f"notebooks/{name}.html#{section}")
        settle(page)
        page.wait_for_function(f"() => ({ARRIVED})()[1] === {json.dumps(wanted)}")
        top, _ = page.evaluate(ARRIVED)
        assert 0 <= top < 0.45 * DESK["height"], section

    page.goto(page.url.partition("#")[0], wait_until="load")
    settle(page)
    page.evaluate("scrollTo({ top: 0.8 * document.body.scrollHeight, behavior: 'instant' })")
    settle(page)
    head = page.evaluate(HEAD)
    page.reload(wait_until="load")
    page.wait_for_function(f"head => `${{({HEAD})()}}` === `${{head}}`", arg=head)
    other = list(CHAPTERS)[6]
    page.goto(page.url.replace(name, other), wait_until="load")
    page.go_back(wait_until="load")
    page.wait_for_function(f"head => `${{({HEAD})()}}` === `${{head}}`", arg=head)
    settle(page)
    assert page.evaluate(HEAD) == head, "Back leads to where one was"
    page.evaluate("id => { location.hash = id; }", names[1])
    page.wait_for_function(f"({ARRIVED})()[0] < 200")
    page.wait_for_timeout(300)  # until the place is kept
    page.go_back()
    page.wait_for_function(f"head => `${{({HEAD})()}}` === `${{head}}`", arg=head)

    page.set_viewport_size({"width": 1200, "height": 768})
    page.wait_for_selector("html:not(.docked)")
    opening = page.locator(".wmr.stage").first.evaluate("it => it.stage.opening")
    page.wait_for_function(
        "wanted => document.querySelector('.wmr.stage').dataset.scene === wanted", arg=opening
    )
