"""The panel in a real browser: every control matters and extremes are answered."""

from __future__ import annotations

import csv
import itertools
import json
import math
from types import SimpleNamespace
from urllib.parse import urlencode

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

pytest.importorskip("anywidget", reason="the panel needs anywidget and ipywidgets")
from faults import crowded
from host import TRAITS, URL, mounted

import wmrlib as wmr
from wmrbook.panel import Explorer
from wmrbook.panel.controls import MENUS, METHODS, SLIDERS, laws_for
from wmrbook.panel.kit import sources
from wmrlib.laws import LAWS

POSE_SLIDERS = ("k_rho", "k_alpha", "h", "v_max", "dt", "arrival_radius")
CIRCLE_SLIDERS = ("k_x", "k_y", "k_heading")
WHEELS = ("track_width", "acceleration", "lag", "dead_band")
LAZY = wmr.Wheels(0.4, acceleration=1.0, lag=0.2, dead_band=0.06)
HANDLES = [(pose, part) for pose in ("start", "goal") for part in ("move", "turn")]
SIZES = [(320, 700), (390, 844), (936, 672), (1890, 1040)]


BOXES = """() => {
    const parts = '.wmr-bar, .wmr-status, .wmr-figures > div, .wmr-control, .wmr-stage canvas';
    return [...document.querySelectorAll(parts)].filter((each) => each.checkVisibility()
        && !each.matches('.wmr-zoom')).map((each) => {
        const box = each.getBoundingClientRect();
        return [box.left, box.top, box.right, box.bottom];
    });
}"""
CLIPPED = """() => [...document.querySelectorAll('.wmr-value, .wmr-control span, .wmr-bar button')]
    .filter((it) => it.scrollWidth > it.clientWidth && it.checkVisibility()
        && getComputedStyle(it).display !== 'inline').length"""
COPIED = "() => addEventListener('copy', () => { copied = document.activeElement.value; })"
MAP = "() => document.querySelector('.wmr-map').toDataURL()"


def assert_sound(panel):
    """Every picture shows something, every figure says something, and no text says NaN."""
    assert min(panel.colours()) > 10
    text = panel.page.locator(".wmr").inner_text()
    assert "NaN" not in text
    assert "undefined" not in text
    assert panel.status()
    assert all(panel.figures().values())


def ends(name):
    return SLIDERS[name][2:4]


def test_every_slider_changes_the_picture_and_the_figures_and_both_ends_are_sound(emptied_page):
    for explorer, names in (
        (Explorer(), POSE_SLIDERS),
        (Explorer.circle(law="kanayama"), CIRCLE_SLIDERS),
        (Explorer(wheels=LAZY, gains=wmr.GENTLE_GAINS), WHEELS),
    ):
        panel = mounted(emptied_page, explorer)
        if names == WHEELS:
            assert not panel.slider("lag").is_visible()
            emptied_page.get_by_text("Wheels", exact=True).click()
        for name in names:
            picture, figures = panel.picture(), panel.figures()
            for end, key in zip(ends(name), ("Home", "End"), strict=True):
                panel.slider(name).press(key)
                panel.settled()
                assert panel.get(name) == end
                assert panel.picture() != picture, name
                assert panel.figures() != figures, name
                assert not panel.troubled()
                assert_sound(panel)
                picture, figures = panel.picture(), panel.figures()
            panel.set(**{name: explorer.state[name]})


def test_every_choice_of_every_menu_changes_the_picture_and_the_figures(emptied_page):
    still, circle = Explorer(gains=wmr.Gains(1.0, 3.0, 1.0)), Explorer.circle()
    menus = ("law", still, laws_for(False)), ("law", circle, laws_for(True))
    menus += ("method", still, METHODS), ("preset", still, MENUS["preset"][2])
    for name, explorer, choices in menus:
        panel = mounted(emptied_page, explorer)
        select = panel.control(name).locator("select")
        offered = select.locator("option").evaluate_all("them => them.map(it => it.value)")
        assert offered == [*map(str, choices)]
        first, seen = select.input_value(), {panel.picture(): str(panel.figures())}
        for choice in set(offered) - {first}:
            panel.put(name, choice)
            assert_sound(panel)
            seen[panel.picture()] = str(panel.figures())
        assert len(seen) == len(set(seen.values())) == len(offered), name


def test_every_map_is_another_picture_and_shows_what_it_does_not_span(emptied_page):
    panel = mounted(emptied_page, Explorer())
    seen = {panel.picture()}
    panel.put("view", "gains")
    for axes in MENUS["axes"][2]:
        for metric in MENUS["metric"][2]:
            panel.put("axes", axes).put("metric", metric)
            assert_sound(panel)
            seen.add(panel.picture())
    assert len(seen) == 7
    maps = [emptied_page.evaluate(MAP)]
    for name, value in (("v_max", 1.0), ("v_max", 4.0), ("law", "printed")):
        panel.put(name, value)
        maps.append(emptied_page.evaluate(MAP))
    assert maps[0] == maps[2]
    assert len(set(maps)) == 3
    panel = mounted(emptied_page, Explorer.circle(view="gains", dt=0.5))
    assert_sound(panel)
    assert_sound(panel.put("law", "kanayama"))


def test_a_map_is_computed_beside_the_page_and_in_it_only_where_that_is_forbidden(browser_page):
    browser_page.add_init_script("Worker.prototype.postMessage = () => { window.asked = true; };")
    panel = mounted(browser_page, Explorer())
    panel.control("view").locator("select").select_option("gains")
    browser_page.wait_for_function("window.asked")
    shown = "() => [...document.querySelectorAll('[data-figure]')].map(it => it.innerText).join()"
    figures = browser_page.evaluate(shown)
    panel.control("k_rho").locator(".wmr-slider").press("ArrowLeft")
    browser_page.wait_for_function(f"figures => ({shown})() !== figures", arg=figures)
    assert browser_page.locator(".wmr-map").get_attribute("data-finished") == "false"
    texts = sources("explorer")
    texts["gain_map.js"] = texts["gain_map.js"].replace("new Blob([text]", "new Blob(['throw 1']")
    assert_sound(mounted(browser_page, Explorer(view="gains"), texts=texts))


def test_every_handle_can_be_dragged_and_obeys_the_keyboard(emptied_page):
    panel = mounted(emptied_page, Explorer())
    for pose, part in HANDLES:
        handle = panel.handle(pose, part)
        for move in ("drag", "ArrowLeft", "Shift+ArrowUp"):
            picture, figures, before = panel.picture(), panel.figures(), panel.get(pose)
            if move == "drag":
                panel.drag(handle, -40, 25)
            else:
                handle.press(move)
                panel.settled()
            assert panel.picture() != picture, (pose, part, move)
            assert panel.figures() != figures, (pose, part, move)
            after = panel.get(pose)
            if move == "drag":
                moved, turned = before[:2] != after[:2], before[2] != after[2]
                assert (moved, turned) == ((True, False) if part == "move" else (False, True))
            elif part == "turn" or "Shift" in move:
                assert after == pytest.approx([*before[:2], before[2] + math.radians(5)], abs=1e-4)
            else:
                assert after[0] < before[0]
                assert after[1:] == pytest.approx(before[1:], abs=1e-4)


def test_an_absurd_value_is_answered_in_the_panel(emptied_page):
    panel = mounted(emptied_page, Explorer())
    good = panel.picture()
    for name in (*POSE_SLIDERS, "start", "goal", "duration"):
        before = panel.get(name)
        for value in (float("nan"), None, -1e300, "text"):
            panel.set(**{name: [0, value, 0] if name in ("start", "goal") else value})
            assert panel.troubled(), (name, value)
            assert min(panel.colours()) > 10
            panel.set(**{name: before})
            assert not panel.troubled()
        assert panel.picture() == good
    typed, before = emptied_page.get_by_label("k_alpha [1/s], typed"), panel.get("k_alpha")
    assert panel.type(typed, "1,000").troubled()  # could be either
    assert panel.get("k_alpha") == before
    assert panel.type(typed, "1,5").get("k_alpha") == 1.5
    stored = Explorer().get_state(TRAITS)
    stored["state"] = stored["state"] | {"k_rho": -1.0}  # and one that it begins with
    begun = SimpleNamespace(program="explorer", get_state=lambda _: stored)
    panel = mounted(emptied_page, begun)
    assert panel.troubled()
    assert min(panel.colours()) > 10
    assert not panel.set(k_rho=1.0).troubled()


LISTEN = """() => {
    wmrPanels.explorer.initialize({ model: panel });
    window.heard = [];
    for (const name of ['k_rho', 'k_alpha', 'h', 'v_max']) {
        panel.set(name, panel.get('state')[name]); // as Python does
        panel.on(`change:${name}`, () => heard.push(name));
    }
    panel.on('change:state', () => heard.push('state'));
}"""


def test_a_gain_that_the_page_links_moves_the_panel_and_follows_it_without_a_kernel(emptied_page):
    panel = mounted(emptied_page, Explorer())
    emptied_page.evaluate(LISTEN)
    figures = panel.figures()
    emptied_page.evaluate("() => panel.set('k_alpha', 2.5)")
    assert panel.settled().get("k_alpha") == 2.5
    assert panel.figures() != figures
    assert emptied_page.evaluate("heard.splice(0).sort()") == ["k_alpha", "state"]
    panel.put("h", 1.5)
    assert emptied_page.evaluate("heard.splice(0).sort()") == ["h", "state"]
    assert emptied_page.evaluate("[panel.get('h'), panel.get('k_alpha')]") == [1.5, 2.5]
    panel.put("preset", 3)  # all at once
    gains = emptied_page.evaluate("['k_rho', 'k_alpha', 'h', 'v_max'].map(it => panel.get(it))")
    assert gains == [panel.get(name) for name in wmr.Gains._fields] == [*wmr.GENTLE_GAINS]


def test_play_moves_the_cursor_to_the_end_and_pause_stops_it(emptied_page):
    panel = mounted(emptied_page, Explorer())
    cursor = emptied_page.locator(".wmr-time")
    before = panel.picture()
    emptied_page.locator("[data-do=play]").click()
    emptied_page.wait_for_timeout(250)
    emptied_page.locator("[data-do=play]").click()
    panel.settled()
    stopped = float(cursor.input_value())
    assert stopped > 0
    assert panel.picture() != before
    emptied_page.wait_for_timeout(150)
    assert float(cursor.input_value()) == stopped
    emptied_page.evaluate(
        """() => {
            const it = document.querySelector('.wmr-time');
            it.value = 0.95 * it.max;
            it.dispatchEvent(new Event('input'));
        }"""
    )
    emptied_page.locator("[data-do=play]").click()
    # "Play" alone would not do: that is what the button says until the first frame is drawn
    emptied_page.wait_for_function(
        """() => {
            const { value, max } = document.querySelector('.wmr-time');
            const said = document.querySelector('[data-do=play]').textContent;
            return Math.abs(value - max) < 1e-6 && said === 'Play';
        }"""
    )


def test_the_cursor_follows_the_pointer_on_the_charts_and_the_keyboard(emptied_page):
    panel = mounted(emptied_page, Explorer())
    before, polar = panel.picture(), emptied_page.locator(".wmr-polar").inner_text()
    panel.drag(emptied_page.locator(".wmr-charts"), 60, 0)
    assert panel.picture() != before
    assert emptied_page.locator(".wmr-polar").inner_text() != polar
    polar = emptied_page.locator(".wmr-polar").inner_text()
    emptied_page.locator(".wmr-time").press("Home")
    panel.settled()
    assert float(emptied_page.locator(".wmr-time").input_value()) == 0.0
    assert emptied_page.locator(".wmr-polar").inner_text() != polar


def test_a_pinned_run_stays_as_a_ghost_until_it_is_unpinned(emptied_page):
    panel = mounted(emptied_page, Explorer())
    figures = panel.figures()
    panel.click("pin").put("k_alpha", 4.0)
    old = emptied_page.locator("[data-figure=arrival] .wmr-pinned").inner_text()
    assert figures["arrival"] in old
    with_ghost = panel.picture()
    assert panel.click("unpin").picture() != with_ghost


def test_reset_is_the_loaded_state_whatever_was_done(emptied_page):
    for options in ({"at": 3.0, "zoom": 5.0, "law": "printed", "view": "gains"}, {}):
        panel = mounted(emptied_page, Explorer(**options))
        home, state = panel.picture(), panel.state()
        panel.click("pin").click("in").drag(panel.handle("start", "move"), 30, 0)
        panel.put("view", "gains").put("metric", "time").put("axes", "k_rho").put("view", "time")
        panel.put("method", "euler").put("preset", 2)
        panel.drag(emptied_page.locator(".wmr-charts"), 60, 0)
        panel.drag(emptied_page.locator(".wmr-scene"), 40, 10)
        assert panel.click("reset").picture() == home
        assert panel.state() == state


def test_a_click_on_the_map_sets_the_gains_and_so_do_its_keys(emptied_page):
    panel = mounted(emptied_page, Explorer(view="gains"))
    picture, figures = panel.picture(), panel.figures()
    emptied_page.locator(".wmr-map").click(position={"x": 300, "y": 120})
    panel.settled()
    assert panel.get("k_alpha") != 1.0
    assert panel.get("h") != 0.3
    typed = panel.control("k_alpha").locator(".wmr-typed").input_value()
    assert float(typed) == pytest.approx(panel.get("k_alpha"))
    assert panel.picture() != picture
    assert panel.figures() != figures
    h = panel.get("h")
    emptied_page.locator(".wmr-map").press("ArrowDown")
    assert panel.settled().get("h") == pytest.approx(h - 0.05)


def test_presets_show_which_one_is_in_force_and_bring_their_scene(emptied_page):
    panel = mounted(emptied_page, Explorer())
    chosen = panel.control("preset").locator("select")
    assert chosen.input_value() == "1"
    panel.put("h", 1.0)
    assert chosen.input_value() == "0"
    start = panel.put("preset", 3).get("start")
    assert [panel.get(name) for name in ("k_rho", "k_alpha", "h")] == [0.2, 2.0, 2.0]
    assert chosen.input_value() == "3"
    panel.put("dt", 0.01).put("preset", 1).put("dt", 0.01).put("preset", 3)
    assert (panel.get("dt"), chosen.input_value()) == (0.01, "3")  # gains, whatever the step
    panel.put("preset", 2)
    assert panel.get("moving")
    assert panel.figures()["arrival"] == "0.090 m"  # the paper's "converges to 0.1 m"
    panel.put("law", "kanayama").put("preset", 3)
    assert (panel.get("start"), panel.get("law")) == (start, "corrected")


def test_light_and_dark_follow_the_page_and_the_system(emptied_page):
    panel = mounted(emptied_page, Explorer())
    background = "() => getComputedStyle(document.querySelector('.wmr')).backgroundColor"
    light, picture = emptied_page.evaluate(background), panel.picture()
    emptied_page.evaluate("() => { document.documentElement.dataset.theme = 'dark'; }")
    panel.settled()
    assert emptied_page.evaluate(background) != light
    dark = panel.picture()
    assert dark != picture
    emptied_page.evaluate("() => { delete document.documentElement.dataset.theme; }")
    assert panel.settled().picture() == picture
    emptied_page.emulate_media(color_scheme="dark")
    assert panel.settled().picture() == dark
    emptied_page.evaluate("() => { document.body.dataset.jpThemeLight = 'true'; }")
    assert panel.settled().picture() == picture


@pytest.mark.parametrize("view", ["time", "gains"])
def test_all_is_in_view_and_nothing_is_cut_off_overlaps_or_is_small(emptied_page, view):
    for width, height in SIZES:
        panel = mounted(emptied_page, Explorer(view=view), width, height)
        assert emptied_page.evaluate("() => document.documentElement.scrollWidth") <= width
        if width >= 600:
            assert emptied_page.evaluate("() => document.body.scrollHeight") <= height
        boxes = emptied_page.evaluate(BOXES)
        for (left, top, right, bottom), other in itertools.combinations(boxes, 2):
            beside = right <= other[0] + 0.5 or other[2] <= left + 0.5
            assert beside or bottom <= other[1] + 0.5 or other[3] <= top + 0.5, width
        assert emptied_page.evaluate(CLIPPED) == 0
        assert crowded(emptied_page, ".wmr") == []
        assert_sound(panel)


def test_on_a_phone_the_picture_stays_in_view_while_any_slider_moves(emptied_page):
    height = 480
    panel = mounted(emptied_page, Explorer(), 390, height)
    for name in POSE_SLIDERS:
        slider, scene = panel.slider(name), emptied_page.locator(".wmr-scene")
        slider.evaluate("it => it.scrollIntoView({ block: 'end' })")
        box, seen = slider.bounding_box(), scene.bounding_box()
        assert seen["y"] >= 0
        assert seen["y"] + seen["height"] <= box["y"]
        assert box["y"] + box["height"] <= height + 1


def test_names_and_values_of_all_controls_are_spoken(emptied_page):
    panel = mounted(emptied_page, Explorer(view="gains"))
    assert "Arrives after" in emptied_page.locator(".wmr-scene").get_attribute("aria-label")
    assert emptied_page.locator(".wmr canvas[role=img][aria-label]").count() == 3
    assert emptied_page.locator(".wmr-handle[aria-label*='arrow keys']").count() == 4
    for name, (text, tip, *_) in {**MENUS, **SLIDERS}.items():
        control = panel.control(name).locator("select, .wmr-slider")
        label = control.get_attribute("aria-label")
        assert text.split(" [")[0] in label
        assert tip in label
    spoken = {"k_alpha": "1 per s", "h": "0.3", "v_max": "4 m/s", "dt": "0.1 s"}
    for name, words in spoken.items():
        assert panel.slider(name).get_attribute("aria-valuetext") == words
    panel.put("k_alpha", 3.0)
    emptied_page.wait_for_function("""() => {
        const text = (it) => document.querySelector(it).textContent;
        return text('[aria-live]') === text('.wmr-status');
    }""")


def test_the_picture_zooms_to_the_goal_and_back(emptied_page):
    panel = mounted(emptied_page, Explorer(method="continuous"))
    whole = panel.picture()
    assert panel.click("near").picture() != whole
    start = panel.handle("start", "move")
    assert start.evaluate("it => it.tabIndex") == -1  # it is out of the picture
    assert panel.click("near").picture() == whole
    assert start.evaluate("it => it.tabIndex") == 0
    zoomed = panel.click("in").picture()
    assert zoomed != whole
    assert panel.drag(emptied_page.locator(".wmr-scene"), 30, 10).picture() != zoomed


RUNS = [
    Explorer(method="continuous", gains=wmr.Gains(0.7, 3.0, 1.5, 2.0), arrival_radius=0.2),
    Explorer(wmr.Pose(1.0, -2.0, 3.0), law="printed", method="euler", duration=7.5),
    Explorer.circle(law="kanayama", dt=0.05),
    Explorer(wheels=LAZY),
]


def test_a_run_can_be_taken_along_as_python_table_and_picture(emptied_page, tmp_path):
    for explorer in RUNS:
        panel = mounted(emptied_page, explorer)
        panel.put("dt", 0.05)
        explorer.dt = 0.05
        emptied_page.evaluate(COPIED)
        panel.click("python")
        text = emptied_page.evaluate("copied")
        space = {}
        exec(text.replace("print(", "("), space)
        ours, theirs = explorer.trajectory(), space["run"]
        assert (theirs.law, theirs.method) == (ours.law, ours.method)
        np.testing.assert_array_equal([theirs.x, theirs.omega], [ours.x, ours.omega])
        with emptied_page.expect_download() as saved:
            panel.reached(emptied_page.locator("[data-do=csv]")).click()
        rows = list(csv.DictReader(saved.value.path().read_text(encoding="utf-8").splitlines()))
        assert len(rows) == len(ours)
        for name in ("t", "x", "y", "rho", "v", "omega", "V"):
            column = [float(row[name]) for row in rows]
            np.testing.assert_allclose(column, getattr(ours, name), rtol=1e-6, atol=1e-6)
    with emptied_page.expect_download() as saved:
        emptied_page.locator("[data-do=png]").click()
    assert saved.value.path().read_bytes().startswith(b"\x89PNG")
    assert saved.value.suggested_filename == "run.png"


def test_a_link_brings_back_what_is_shown_and_only_in_its_own_panel(browser_page):
    ours, other = Explorer(), Explorer(method="continuous")
    panel = mounted(browser_page, ours)
    untouched = panel.figures()
    panel.put("k_alpha", 2.5).put("law", "printed").drag(panel.handle("start", "turn"), 9, 9)
    panel.click("near").drag(browser_page.locator(".wmr-charts"), 60, 0)
    picture, figures = panel.picture(), panel.figures()
    link = panel.click("link").page.evaluate("location.href")
    assert link.startswith(f"{URL}#")
    again = mounted(browser_page, ours, url=link)
    assert (again.picture(), again.figures()) == (picture, figures)
    assert again.click("reset").figures() == untouched
    away = mounted(browser_page, other).picture()
    assert mounted(browser_page, other, url=link).picture() == away
    for wrong in ("k_rho=x&law=5&unknown=1", "start=1", "start={}", "goal=%22east%22"):
        bad = mounted(browser_page, ours, url=link.replace("law=%22printed%22", wrong))
        assert bad.troubled()
        assert f"In the link, {wrong.partition('=')[0]} = " in bad.status()
        assert "is not allowed: " in bad.status()
        assert bad.figures() == untouched


NUMBERS = st.floats(-2e6, 2e6) | st.sampled_from([0, -0.0, 1e-300, 1e300, 5])
JUNK = st.recursive(
    NUMBERS | st.booleans() | st.none() | st.text(max_size=5) | st.sampled_from([*METHODS, *LAWS]),
    lambda parts: st.lists(parts, max_size=4) | st.dictionaries(st.text(max_size=8), parts),
    max_leaves=4,
)
FRAGMENTS = st.text() | st.lists(
    st.tuples(
        st.sampled_from([*Explorer().state, "unknown", "toString", "__proto__"]),
        JUNK.map(json.dumps)
        | st.text(max_size=9)
        | st.sampled_from(["1e999", "NaN", "[1,2", "{}"]),
    ),
    min_size=1,
    max_size=3,
).map(urlencode)
SIZES_OF_GAINS = st.integers(1, 40).map(lambda size: size / 10)
POSES = st.tuples(*[st.integers(-300, 300).map(lambda tenth: tenth / 10)] * 3).map(list)
RIGHT = st.fixed_dictionaries(
    {},
    optional={
        **dict.fromkeys(["k_rho", "k_alpha", "h", "v_max", "k_x", "k_y", "lag"], SIZES_OF_GAINS),
        **dict.fromkeys(["start", "goal"], POSES),
        "law": st.sampled_from(laws_for(False)),
        "method": st.sampled_from([*METHODS]),
        "metric": st.sampled_from([*MENUS["metric"][2]]),
        "moving": st.booleans(),
    },
)
OPEN = """fragment => {
    const changed = new Promise((done) => addEventListener('hashchange', done, { once: true }));
    const before = location.href;
    location.hash = fragment;
    return location.href === before ? null : changed.then(() => null);
}"""


@pytest.fixture(scope="module")
def linked(module_page):
    """A panel, what its links begin with, and its state and figures as it is opened."""
    module_page.troubles.clear()
    panel = mounted(module_page, Explorer())
    home = panel.state(), panel.figures()
    yield panel, panel.click("link").page.evaluate("location.hash"), home
    module_page.assert_quiet()


@settings(max_examples=25, deadline=None)
@given(fragment=FRAGMENTS, ours=st.booleans())
def test_any_text_in_the_address_gives_a_panel_that_drives(linked, fragment, ours):
    panel, link, home = linked
    panel.page.evaluate(OPEN, f"{link}&{fragment}" if ours else fragment)
    assert_sound(panel.settled())
    if panel.troubled():
        assert panel.status().startswith("In the link, ")
        assert "is needed. The panel is as it was opened." in panel.status()
        assert (panel.state(), panel.figures()) == home
    assert math.isfinite(float(panel.page.locator(".wmr-time").get_attribute("max")))


@settings(max_examples=10, deadline=None)
@given(values=RIGHT)
def test_a_right_link_brings_back_its_state(linked, values):
    panel, _, home = linked
    panel.click("reset").set(**values)
    shown = panel.state(), panel.figures()
    link = panel.click("link").page.evaluate("location.hash")
    panel.click("reset").page.evaluate(OPEN, "")
    assert (panel.state(), panel.figures()) == home
    panel.page.evaluate(OPEN, link)
    assert not panel.settled().troubled()
    assert (panel.state(), panel.figures()) == shown


def test_what_another_version_has_stored_is_to_be_run_again(emptied_page):
    explorer = Explorer()
    explorer.contract = "another"
    mounted(emptied_page, explorer)
    assert "run its cell again" in emptied_page.locator("body").inner_text()
    assert emptied_page.locator("canvas").count() == 0
