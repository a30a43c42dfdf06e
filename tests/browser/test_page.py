"""The built book, opened from the disk: every page complete, quiet and alive."""

from __future__ import annotations

import functools
import itertools
import os
import re
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import numpy as np
import pypdfium2
import pytest
from faults import SIZES, misplaced, of_page
from lecturers import leaks
from live import (
    PATIENCE,
    ROOT,
    as_shown,
    assert_slider_matters,
    chapters,
    letters,
    pages,
    settled_picture,
    sliders,
)
from pdf import print_page
from pypdfium2.raw import FPDF_PAGEOBJ_IMAGE
from sphinx.util.inventory import InventoryFile

import wmrlib as wmr
import wmrrobot as wr
from wmrbook import face, live

# Formulas that would have to be scrolled.
WIDE = """() => [...document.querySelectorAll('mjx-container[display]')]
    .filter(it => it.scrollWidth > it.clientWidth + 1).map(it => it.innerText)"""
ALL_THERE = """theme => [...document.querySelectorAll(`img.only-${theme}`)]
    .every((it, _, all) => all.length > 3 && it.complete && it.naturalWidth)"""
TEXTS = {path.stem for path in (ROOT / "book").glob("*.md")} - {"design", "lecturers"}
NAMES = [
    *(f"{name}.html" for name in sorted(TEXTS | {"genindex", "search"})),
    *(f"notebooks/{path.stem}.html" for path in chapters()),
]
SOME = "index", "my_robot", "notebooks/04", "notebooks/05"  # all others are slow


def test_these_are_all_pages(site):
    assert {path.relative_to(site).as_posix() for path in pages(site)} == set(NAMES)


def test_every_page_names_its_icon(site):
    """Else a browser asks its server for /favicon.ico: an error in the console of full Chromium."""
    sources = [*(ROOT / "book").glob("deck/*.*"), *(ROOT / "book").glob("tools/*.html")]
    pages = [*site.rglob("*.html"), *sources]
    texts = {path: path.read_text(encoding="utf-8") for path in pages}
    whole = {path: text for path, text in texts.items() if "<head>" in text}
    assert len(whole) > len(NAMES)
    assert not [path for path, text in whole.items() if '<link rel="icon"' not in text]


@pytest.mark.parametrize(
    ("name", "scheme"),
    [
        pytest.param(name, scheme, marks=[pytest.mark.slow] * (not name.startswith(SOME)))
        for name, scheme in zip(NAMES, itertools.cycle(["light", "dark"]), strict=False)
    ],
)
def test_a_page_opens_without_trouble_and_without_faults(name, scheme, opened, browser_page):
    loaded = set()
    browser_page.on("request", lambda request: loaded.add(unquote(urlsplit(request.url).path)))
    browser_page.emulate_media(color_scheme=scheme)
    browser_page.set_viewport_size({"width": 1366, "height": 768})
    page = opened(name)
    assert sum(path.stat().st_size for path in map(Path, loaded) if path.is_file()) < 4.0e6
    assert page.locator("html").get_attribute("data-theme") == scheme
    assert page.locator("h1:visible").count() == 1
    assert page.locator("mjx-merror, .widget-error").count() == 0
    page.assert_quiet()
    assert page.evaluate(WIDE) == []
    assert misplaced(page) == []
    every = "EVERY_SIZE" in os.environ  # and both themes
    assert not (of_page(page) if every else of_page(page, SIZES[:1], (scheme,)))


def test_the_panel_lives_and_follows_the_colour_menu(opened):
    page = opened("explorer.html")
    values = sliders(page)
    assert len(values) >= 3  # k_rho, k_alpha and h
    assert_slider_matters(page, values[0])
    before = settled_picture(page)
    page.locator(".theme-switch-button:visible").click(timeout=PATIENCE)
    page.locator('.theme-change-button[data-mode="dark"]:visible').click(timeout=PATIENCE)
    assert page.locator("html").get_attribute("data-theme") == "dark"
    assert settled_picture(page) != before
    for event, theme in (("beforeprint", "light"), ("afterprint", "dark")):  # paper is white
        page.evaluate("name => dispatchEvent(new Event(name))", event)
        assert page.locator("html").get_attribute("data-theme") == theme


@pytest.mark.parametrize(
    ("asked", "chapter"),
    [
        ("LaSalle", "04_lyapunov"),
        ("Lyapunov function", "04_lyapunov"),
        ("poles", "06_gains_by_design"),
    ],
)
def test_search_puts_the_page_that_explains_a_term_first(opened, asked, chapter):
    page = opened("index.html")
    page.get_by_role("button", name="Search").click()
    page.keyboard.type(asked)
    page.keyboard.press("Enter")
    page.wait_for_url("**/search.html?q=*", timeout=PATIENCE)
    hits = page.locator("#search-results li > a")
    hits.nth(1).wait_for()
    assert hits.first.get_attribute("href") == f"notebooks/{chapter}.html"


def test_search_shows_formulas_as_letters(opened):
    page = opened("search.html?q=LaSalle")
    words = page.evaluate("PAGES['notebooks/04_lyapunov']")
    assert all(term in words for term in ("k_\u03c1", "V\u0307", "\u2202E/\u2202"))
    assert not re.search(r"\\|frac\d", words)


@pytest.mark.parametrize(
    ("asked", "page"), [("arrival radius", 9), ("dead band", 8), ("haversine formula", 1)]
)
def test_a_search_shows_the_sentence_with_all_words_and_no_code(opened, asked, page):
    shown = opened(f"search.html?q={asked.replace(' ', '+')}")
    link = shown.locator(f'a[href^="notebooks/{page:02}_"]')
    hit = shown.locator("#search-results li").filter(has=link).first
    words = hit.locator(".context").inner_text(timeout=PATIENCE)
    assert asked in words.lower(), words
    code = shown.evaluate("Object.values(PAGES).filter(it => it.includes('np.array('))")
    assert not code, code[0][:200]


class Parts(HTMLParser):
    """What a page names: its anchors, where it points, and what its images say.

    Those of the panels, for a browser without JavaScript, are apart: they have no caption.
    """

    def __init__(self, path: Path):
        super().__init__()
        self.anchors, self.targets, self.texts = set(), set(), []
        self.stills, self.apart = [], False
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        named = {name: value for name, value in attrs if value}
        self.anchors |= {named[name] for name in ("id", "name") if name in named}
        self.targets |= {named[name] for name in ("href", "src") if name in named}
        if tag == "img" and "only-dark" not in named.get("class", ""):  # else it is shown twice
            (self.stills if self.apart else self.texts).append(named.get("alt", ""))
        self.apart |= tag == "noscript"

    def handle_endtag(self, tag):
        self.apart &= tag != "noscript"


parts_of = functools.cache(Parts)


def test_no_link_of_the_site_is_broken(site):
    parts = {path: parts_of(path) for path in pages(site)}
    for path, page in parts.items():
        for target in page.targets:
            url = urlsplit(target)
            if url.scheme or url.netloc:
                continue
            there = (path.parent / unquote(url.path)).resolve() if url.path else path
            assert there.is_file(), f"{path.name}: {target}"
            if url.fragment and there in parts:
                assert unquote(url.fragment) in parts[there].anchors, f"{path.name}: {target}"


def test_the_reference_has_an_entry_for_each_public_name(site):
    inventory = InventoryFile.loads((site / "objects.inv").read_bytes(), uri="")
    entries = {name for names in inventory.data.values() for name in names}
    results = "runs.Arrival", "runs.Trajectories", "tracks.Track", "tuning.Modes"
    assert {f"wmrlib.{name}" for name in (*wmr.__all__, *results)} <= entries
    assert {f"wmrrobot.{name}" for name in wr.__all__} <= entries
    text = "".join(path.read_text(encoding="utf-8") for path in site.glob("api*.html"))
    assert text.count("Raises<span") > 20
    assert ":raises" not in text  # a section that was not understood


def test_each_wish_links_to_the_entries_of_the_functions_that_serve_it(site):
    text = (site / "api.html").read_text(encoding="utf-8")
    rows = re.findall(r"<tr.*?</tr>", text[text.index("<table") : text.index("</table>")], re.S)
    assert len(rows) == 8
    for row in rows[1:]:
        targets = re.findall(r'href="(api_\w+\.html)#([\w.]+)"', row)
        assert targets, row
        for page, name in targets:
            assert f'id="{name}"' in (site / page).read_text(encoding="utf-8")


TO_ENTRY = re.compile(
    r'<a [^>]*href="\.\./(api\w*)\.html#(wmrlib|wmrrobot)\.([\w.]+)"[^>]*>(.*?)</a>', re.DOTALL
)
MEMBER = re.compile(r'<span class="n">(wmr|wr)</span><span class="o">.</span><span class="n">(\w+)')
TO_MODULE = '<a href="../{}.html"><span class="nn">{}<'


def test_names_in_sentences_and_code_link_to_their_entries_and_no_others(site):
    linked, cells = set(), set()
    for path in sorted((site / "notebooks").glob("*.html")):
        text = path.read_text(encoding="utf-8")
        for page, package, name, shown in TO_ENTRY.findall(text):
            plain = re.sub(r"<[^>]+>", "", shown)
            assert re.fullmatch(rf"(\w+\.)?{name}(\.\w+|\(.*\))?", plain, re.DOTALL), (path, plain)
            assert (page == "api_robot") == (package == "wmrrobot")
            linked.add((package, name, "sentence" if "<code" in shown else "code"))
        outside = TO_ENTRY.sub("", text)
        cells |= {(short, name) for short, name in MEMBER.findall(outside)}
        for module, page in (("wmrlib", "api"), ("wmrrobot", "api_robot")):
            imports = text.count(f'<span class="nn">{module}<')
            assert text.count(TO_MODULE.format(page, module)) == imports, path
    for entry in (
        *(("wmrlib", "simulate", "code"), ("wmrlib", "simulate", "sentence")),
        *(("wmrlib", "paper.outdoor", "code"), ("wmrrobot", "sheet", "code")),
    ):
        assert entry in linked
    assert cells <= {("wmr", "paper"), ("wr", "paper")}, cells  # whose numbers have no entry


def test_one_switch_unfolds_the_code_of_every_chapter(opened):
    folded = """() => [...document.querySelectorAll('details.above-input')].map(it => it.open)"""
    page = opened("notebooks/02_the_robot.html")
    assert page.evaluate(folded).count(True) == 0
    assert len(page.evaluate(folded)) > 5
    page.get_by_role("button", name="Show all code").click()
    assert all(page.evaluate(folded))
    assert all(opened("notebooks/07_the_circle.html").evaluate(folded))


def test_a_copy_button_says_what_it_copies(opened):
    page = opened("use.html")
    page.wait_for_function("() => document.querySelector('.copybtn')?.ariaLabel")
    names = page.evaluate("[...document.querySelectorAll('.copybtn')].map(it => it.ariaLabel)")
    assert all(re.match(r"Copy the (code|output): \S", name) for name in names)
    assert len(set(names)) > 3


@pytest.mark.parametrize("name", ["notebooks/03_polar_coordinates.html", "index.html"])
def test_the_first_control_of_a_panel_is_at_most_five_keys_away(name, opened):
    page = opened(name)
    there = "document.activeElement.matches('.wmr *')"
    page.keyboard.press("Tab")
    page.keyboard.press("Tab")
    link = page.evaluate("document.activeElement.textContent")
    assert link == "Skip to the first moving picture"
    page.keyboard.press("Enter")
    page.keyboard.press("Tab")
    if not page.evaluate(there):  # a picture that scrolls
        page.keyboard.press("Tab")
    assert page.evaluate(there)
    box = page.evaluate("document.activeElement.getBoundingClientRect().toJSON()")
    assert 0 <= box["top"] < 900  # and in sight


def test_every_page_with_a_panel_has_a_link_to_it(site):
    for path in pages(site):
        text = path.read_text(encoding="utf-8")
        view = text.find("widget-view+json")
        assert (view > 0) == ('href="#first-panel"' in text), path.name
        assert view < 0 or 0 < text.find('id="first-panel"') < view, path.name


def test_a_symbol_that_is_touched_lights_up_and_no_other_and_has_a_halo_in_the_pictures(opened):
    page = opened("notebooks/04_lyapunov.html")
    page.locator("article h1").hover()
    dark = settled_picture(page)
    page.locator(f'#the-paper-s-bowl [data-c="{face.LETTERS["alpha"]}"]').first.hover()
    lit = """role => [...document.querySelectorAll(`[data-c="${role}"]`)]
        .map(it => getComputedStyle(it).filter !== 'none')"""
    for role, code in face.LETTERS.items():
        assert set(page.evaluate(lit, code)) == {role == "alpha"}, role
    assert settled_picture(page) != dark


def test_an_index_h_is_not_in_the_colour_of_the_gain_h(browser_page):
    roles = {
        "h\\theta": ["h"],
        "h_1^2": ["h"],
        "k_h e_{h}^2": ["", ""],
        "\\frac{k_h}{h}": ["", "h"],
    }
    formulas = "".join(f"<p>\\({formula}\\)</p>" for formula in roles)
    browser_page.set_content(f"<style>{face.css()}</style>{formulas}")
    browser_page.add_script_tag(path=ROOT / "book/node_modules/mathjax/es5/tex-svg.js")
    browser_page.evaluate("window.MathJax.startup.promise.then(() => null)")
    seen = """letter => [...document.querySelectorAll('p')].map(
        it => [...it.querySelectorAll(`[data-c="${letter}"]`)].map(
            shape => getComputedStyle(shape).getPropertyValue('--role').trim()))"""
    assert browser_page.evaluate(seen, face.LETTERS["h"]) == list(roles.values())


def test_pages_and_search_have_neither_the_guide_nor_solutions(site):
    assert not (site / "lecturers.html").exists()
    assert not leaks(site)


def test_every_image_says_what_it_shows_and_has_a_caption(site):
    for path in pages(site):
        page = parts_of(path)
        for text in (*page.texts, *page.stills):
            assert len(text.split()) > 3, f"{path.name}: {text!r} is no alternative text"
        captions = [anchor for anchor in page.anchors if anchor.startswith("figure-")]
        assert len(captions) == len(page.texts), path.name


def test_code_is_folded_and_nothing_that_it_shows(site):
    for page in sorted((site / "notebooks").glob("*.html")):
        folds = re.findall(
            r'<details class="[^"]*above-input.*?</details>', page.read_text("utf-8"), re.DOTALL
        )
        assert folds, page
        for fold in folds:
            assert "highlight" in fold, page
            assert not re.search("widget-view|cell_output|figure-box", fold), (page, fold[:300])


def test_each_chapter_can_be_downloaded_as_a_notebook(site):
    for chapter in chapters():
        page = site / "notebooks" / f"{chapter.stem}.html"
        (target,) = [it for it in parts_of(page).targets if it.endswith(f"{chapter.stem}.ipynb")]
        assert (page.parent / target).read_text(encoding="utf-8").startswith("{")


def test_a_papers_equation_that_is_mentioned_leads_to_where_it_is_derived(opened):
    page = opened("notebooks/10_the_audit.html")
    page.get_by_role("link", name="(22)", exact=True).first.click(timeout=PATIENCE)
    page.wait_for_url("**/04_lyapunov.html#paper-22", timeout=PATIENCE)
    page.locator("div.math:has(#paper-22) svg").first.wait_for(timeout=PATIENCE)
    assert "paper 22" in page.locator("div.math:has(#paper-22)").text_content()


def test_a_page_has_the_figures_of_its_theme(opened, browser_page):
    browser_page.emulate_media(color_scheme="dark")
    page = opened("notebooks/05_pose_to_pose.html")
    page.wait_for_function(ALL_THERE, arg="dark", timeout=PATIENCE)
    page.locator(".theme-switch-button:visible").click(timeout=PATIENCE)
    page.locator('.theme-change-button[data-mode="light"]:visible').click(timeout=PATIENCE)
    page.wait_for_function(ALL_THERE, arg="light", timeout=PATIENCE)


# Where on its canvas something is drawn: the middle of it, in parts of its size.
PLAYED = """player => {
  const box = [player.previousElementSibling, player.previousElementSibling.previousElementSibling]
      .find(it => it.matches('.figure-box')), canvas = box.querySelector('canvas');
  const { width, height } = canvas, data = canvas.getContext('2d')
      .getImageData(0, 0, width, height).data;
  let sum = 0, x = 0, y = 0;
  for (let k = 0; k < width * height; k += 1) if (data[4 * k + 3] > 200) {
    sum += 1; x += k % width; y += Math.floor(k / width);
  }
  const { seconds, robots } = JSON.parse(box.querySelector('script').text);
  const last = values => values.reduce((sum, it) => sum + it, 0) / 10000;
  return { count: sum, at: [x / sum / width, y / sum / height], seconds,
           end: [last(robots[0].x), last(robots[0].y)] };
}"""


def test_a_drive_plays_over_its_picture_and_waits_where_it_is_paused(opened):
    page = opened(f"notebooks/{chapters()[12].stem}.html")
    player = page.query_selector(".player")
    player.scroll_into_view_if_needed()
    assert player.evaluate(PLAYED)["count"] == 0  # the picture speaks for itself
    slider, button = player.query_selector("input"), player.query_selector("button")
    slider.press("End")
    seen = player.evaluate(PLAYED)
    assert seen["at"] == pytest.approx(seen["end"], abs=0.02)
    assert slider.get_attribute("aria-valuetext") == f"{seen['seconds']:.1f} s"
    slider.press("Home")
    button.click()
    page.wait_for_function("it => it.ariaValueText !== '0.0 s'", arg=slider)
    button.click()
    assert button.inner_text() == "Play"
    assert slider.get_attribute("aria-valuetext") != "0.0 s"


CONTROLS = "Copy|Show all code|Hide the code|Larger|Play|That's it|Just show me|Try again|Run|Code"


def test_a_printed_chapter_has_no_control_no_imports_and_no_prediction_that_waits(
    site, browser, tmp_path
):
    print_page(browser, site / "notebooks" / "03_polar_coordinates.html", tmp_path / "page.pdf")
    with pypdfium2.PdfDocument(tmp_path / "page.pdf") as printed:
        lines = [
            line.strip()
            for page in printed
            for line in page.get_textpage().get_text_bounded().splitlines()
        ]
        images = [it for page in printed for it in page.get_objects([FPDF_PAGEOBJ_IMAGE])]
        colours = [len(np.unique(it.get_bitmap().to_numpy()[::8, ::8])) for it in images]
    assert not [line for line in lines if re.fullmatch(f"(?:{CONTROLS}| )+", line)]
    assert not [line for line in lines if re.match(r"import |from \w+ import", line)]
    text = letters(" ".join(lines))
    source = (ROOT / "notebooks" / "03_polar_coordinates.ipynb").read_text(encoding="utf-8")
    asks = [live_of(name) for name in re.findall(r"live\.(\w+)\(", source)]
    assert asks
    for ask in filter(None, asks):
        assert letters(as_shown(ask["why"])) in text, ask["name"]
    assert len(colours) >= 3
    assert min(colours) > 3  # a picture of each panel


def live_of(name):
    return getattr(live, name)().setup["ask"]
