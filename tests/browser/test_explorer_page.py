"""The panel in a real browser: every control matters and extremes are answered."""

from __future__ import annotations

import math

import pytest

pytest.importorskip("anywidget", reason="the panel needs anywidget and ipywidgets")
from host import mounted

import wmrlib as wmr
from wmrlib.explorer import Explorer
from wmrlib.explorer.controls import laws_for

POSE_SLIDERS = ("k_rho", "k_alpha", "h", "v_max", "dt")
CIRCLE_SLIDERS = ("k_x", "k_y", "k_heading")
HANDLES = [(pose, part) for pose in ("start", "goal") for part in ("move", "turn")]


BOXES = """() => {
    const parts = '.wmr-bar, .wmr-status, .wmr-figures > div, .wmr-stage > div';
    return [...document.querySelectorAll(parts)].map((each) => {
        const box = each.getBoundingClientRect();
        return [box.left, box.top, box.right, box.bottom];
    });
}"""
CLIPPED = """() => [...document.querySelectorAll('.wmr-figures .wmr-value')]
    .filter((it) => it.scrollWidth > it.clientWidth).length"""


def assert_sound(panel):
    """Every picture shows something, every figure says something, and no text says NaN."""
    assert min(panel.colours()) > 10
    text = panel.page.locator(".wmr").inner_text()
    assert "NaN" not in text
    assert "undefined" not in text
    assert panel.status()
    assert all(panel.figures().values())


def test_every_slider_changes_the_picture_and_the_figures_and_both_ends_are_sound(browser_page):
    for explorer, names in (
        (Explorer(), POSE_SLIDERS),
        (Explorer.circle(law="kanayama"), CIRCLE_SLIDERS),
    ):
        panel = mounted(browser_page, explorer)
        home = explorer.panel.home
        for name in names:
            picture, figures = panel.picture(), panel.figures()
            for end in panel.ends(name):
                panel.put(name, end)
                assert panel.picture() != picture, name
                assert panel.figures() != figures, name
                assert not panel.troubled()
                assert_sound(panel)
                picture, figures = panel.picture(), panel.figures()
            panel.set(**{name: home[name]})


def test_every_slider_at_both_ends_on_the_circle_is_sound(browser_page):
    for law in laws_for(moving=True):
        panel = mounted(browser_page, Explorer.circle(law=law["name"]))
        for name in (*law["gains"], "dt"):
            for end in panel.ends(name):
                assert_sound(panel.put(name, end))


def test_every_choice_of_every_menu_changes_the_picture_and_the_figures(browser_page):
    still, circle = Explorer(gains=wmr.Gains(1.0, 3.0, 1.0)), Explorer.circle()
    menus = ("pose_law", still), ("circle_law", circle), ("method", still), ("preset", still)
    for name, explorer in menus:
        panel = mounted(browser_page, explorer)
        choices = browser_page.locator(f"[data-control={name}] option").count()
        assert choices == len(explorer.menus[name].options)
        first, seen = panel.get(name), {panel.picture(): str(panel.figures())}
        for choice in set(range(choices)) - {first}:
            panel.put(name, choice)
            assert_sound(panel)
            seen[panel.picture()] = str(panel.figures())
        assert len(seen) == len(set(seen.values())) == choices, name


def test_every_map_is_another_picture(browser_page):
    panel = mounted(browser_page, Explorer())
    seen = {panel.picture()}
    panel.put("view", 1)
    for axes in (0, 1):
        for metric in (0, 1, 2):
            panel.put("axes", axes).put("metric", metric)
            assert_sound(panel)
            seen.add(panel.picture())
    assert len(seen) == 7


def test_a_slider_that_the_map_does_not_span_changes_the_map(browser_page):
    panel = mounted(browser_page, Explorer(view="gains"))
    before = panel.picture()
    assert panel.put("k_rho", 0.5).picture() != before


def test_the_map_of_the_circle_and_of_the_law_with_feed_forward(browser_page):
    panel = mounted(browser_page, Explorer.circle(view="gains", dt=0.5))
    assert_sound(panel)
    panel.put("circle_law", 3)
    assert_sound(panel)


def test_every_handle_can_be_dragged_and_obeys_the_keyboard(browser_page):
    panel = mounted(browser_page, Explorer())
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


def test_a_dragged_handle_stays_under_the_pointer(browser_page):
    panel = mounted(browser_page, Explorer())
    handle = panel.handle("goal", "move")
    box = handle.bounding_box()
    x, y = box["x"] + 15, box["y"] + 15
    browser_page.mouse.move(x, y)
    browser_page.mouse.down()
    browser_page.mouse.move(x + 60, y + 30, steps=10)
    panel.settled()
    now = handle.bounding_box()
    assert (now["x"] + 15, now["y"] + 15) == pytest.approx((x + 60, y + 30), abs=1.5)
    browser_page.mouse.up()


def test_a_drag_of_sixty_events_leaves_no_backlog(browser_page):
    panel = mounted(browser_page, Explorer())
    drawings = browser_page.evaluate(
        """async () => {
            const input = document.querySelector('[data-control=k_alpha]');
            drawings = 0;
            for (let i = 1; i <= 60; i += 1) {
                input.value = i / 10;
                input.dispatchEvent(new Event('input'));
            }
            await new Promise(done => setTimeout(done, 300));
            return drawings;
        }"""
    )
    assert drawings == 1
    dragged, figures = panel.picture(), panel.figures()
    panel.put("k_alpha", 1.0)
    assert panel.put("k_alpha", 6.0).picture() == dragged
    assert panel.figures() == figures


def test_an_absurd_value_is_answered_in_the_panel(browser_page):
    panel = mounted(browser_page, Explorer())
    good = panel.picture()
    for trait in (*POSE_SLIDERS, "start", "goal", "duration", "arrival_radius"):
        before = panel.get(trait)
        for value in ("NaN", "null", "Infinity", "-1e300", "'text'", "undefined"):
            absurd = f"[0, {value}, 0]" if trait in ("start", "goal") else value
            browser_page.evaluate(f"trait => panel.set(trait, {absurd})", trait)
            panel.settled()
            assert panel.troubled(), (trait, value)
            assert min(panel.colours()) > 10
            panel.set(**{trait: before})
            assert not panel.troubled()
        assert panel.picture() == good


def test_a_panel_that_begins_with_an_absurd_value_is_not_blank(browser_page):
    explorer = Explorer()
    explorer.panel.k_rho = -1.0
    panel = mounted(browser_page, explorer)
    assert panel.troubled()
    assert min(panel.colours()) > 10
    assert not panel.set(k_rho=1.0).troubled()


def test_a_start_on_the_goal_and_one_far_from_it(browser_page):
    for goal in ((0.0, 0.0, 0.0), (0.0, 0.0, 2.0), (1e-9, 0.0, 0.0), (1e5, -1e5, 1.0)):
        panel = mounted(browser_page, Explorer(wmr.Pose(0.0, 0.0, 0.0), wmr.Pose(*goal)))
        assert not panel.troubled()
        assert_sound(panel)
        assert_sound(panel.put("view", 1))
        assert panel.drag(panel.handle("start", "turn"), 10, 30).get("start")[2] != 0.0


def test_play_moves_the_cursor_to_the_end_and_pause_stops_it(browser_page):
    panel = mounted(browser_page, Explorer())
    cursor = browser_page.locator(".wmr-time")
    before = panel.picture()
    browser_page.locator("[data-do=play]").click()
    browser_page.wait_for_timeout(250)
    browser_page.locator("[data-do=play]").click()
    panel.settled()
    stopped = float(cursor.input_value())
    assert stopped > 0
    assert panel.picture() != before
    browser_page.wait_for_timeout(150)
    assert float(cursor.input_value()) == stopped
    browser_page.evaluate(
        """() => {
            const it = document.querySelector('.wmr-time');
            it.value = 0.95 * it.max;
            it.dispatchEvent(new Event('input'));
        }"""
    )
    browser_page.locator("[data-do=play]").click()
    # "Play" alone would not do: that is what the button says until the first frame is drawn
    browser_page.wait_for_function(
        """() => {
            const { value, max } = document.querySelector('.wmr-time');
            const said = document.querySelector('[data-do=play]').textContent;
            return Math.abs(value - max) < 1e-6 && said === 'Play';
        }"""
    )


def test_the_cursor_follows_the_pointer_on_the_charts_and_the_keyboard(browser_page):
    panel = mounted(browser_page, Explorer())
    before, polar = panel.picture(), browser_page.locator(".wmr-polar").inner_text()
    panel.drag(browser_page.locator(".wmr-charts"), 60, 0)
    assert panel.picture() != before
    assert browser_page.locator(".wmr-polar").inner_text() != polar
    polar = browser_page.locator(".wmr-polar").inner_text()
    browser_page.locator(".wmr-time").press("Home")
    panel.settled()
    assert float(browser_page.locator(".wmr-time").input_value()) == 0.0
    assert browser_page.locator(".wmr-polar").inner_text() != polar


def test_a_pinned_run_stays_as_a_ghost_until_it_is_unpinned_and_reset_returns_home(browser_page):
    panel = mounted(browser_page, Explorer())
    home, figures = panel.picture(), panel.figures()
    panel.click("pin").put("k_alpha", 4.0)
    assert (
        figures["arrival"] in browser_page.locator("[data-figure=arrival] .wmr-pinned").inner_text()
    )
    with_ghost = panel.picture()
    assert panel.click("unpin").picture() != with_ghost
    panel.drag(panel.handle("start", "move"), 30, 0)
    panel.put("preset", 2)
    panel.click("reset")
    assert panel.picture() == home
    assert panel.figures() == figures
    assert panel.get("preset") == 1


def test_a_click_on_the_map_sets_the_gains_and_so_do_its_keys(browser_page):
    panel = mounted(browser_page, Explorer(view="gains"))
    picture, figures = panel.picture(), panel.figures()
    browser_page.locator(".wmr-map").click(position={"x": 300, "y": 120})
    panel.settled()
    assert panel.get("k_alpha") != 1.0
    assert panel.get("h") != 0.3
    assert float(browser_page.locator("[data-control=k_alpha]").input_value()) == pytest.approx(
        panel.get("k_alpha")
    )
    assert panel.picture() != picture
    assert panel.figures() != figures
    h = panel.get("h")
    browser_page.locator(".wmr-map").press("ArrowDown")
    assert panel.settled().get("h") == pytest.approx(h - 0.05)


def test_presets_show_which_one_is_in_force(browser_page):
    panel = mounted(browser_page, Explorer())
    assert panel.get("preset") == 1
    assert panel.put("h", 1.0).get("preset") == 0
    panel.put("preset", 3)
    assert [panel.get(name) for name in ("k_rho", "k_alpha", "h")] == [0.2, 2.0, 2.0]
    assert panel.get("preset") == 3
    panel.put("preset", 2)
    assert panel.get("scenario") == 1
    assert panel.figures()["arrival"] == "0.090 m"  # the paper's "converges to 0.1 m"


def test_light_and_dark_follow_the_page_and_the_system(browser_page):
    panel = mounted(browser_page, Explorer())
    background = "() => getComputedStyle(document.querySelector('.wmr')).backgroundColor"
    light, picture = browser_page.evaluate(background), panel.picture()
    browser_page.evaluate("() => { document.documentElement.dataset.theme = 'dark'; }")
    panel.settled()
    assert browser_page.evaluate(background) != light
    dark = panel.picture()
    assert dark != picture
    browser_page.evaluate("() => { delete document.documentElement.dataset.theme; }")
    assert panel.settled().picture() == picture
    browser_page.emulate_media(color_scheme="dark")
    assert panel.settled().picture() == dark
    browser_page.evaluate("() => { document.body.dataset.jpThemeLight = 'true'; }")
    assert panel.settled().picture() == picture


def test_a_page_that_hides_the_panel_while_it_changes_its_theme_finds_it_whole_again(browser_page):
    panel = mounted(browser_page, Explorer())
    picture = panel.picture()
    browser_page.evaluate(
        """async () => {
            document.body.style.display = 'none';
            document.body.dataset.jpThemeLight = 'true';
            await new Promise(done => setTimeout(done));
            document.body.style.display = '';
        }"""
    )
    assert panel.settled().picture() == picture


def test_nothing_is_cut_off_or_overlaps_at_any_width(browser_page):
    for width in (320, 400, 760, 1280, 1920):
        panel = mounted(browser_page, Explorer(), width=width)
        assert browser_page.evaluate("() => document.documentElement.scrollWidth") <= width
        boxes = browser_page.evaluate(BOXES)
        for i, (left, top, right, bottom) in enumerate(boxes):
            assert left >= 0
            assert right <= width
            for other in boxes[i + 1 :]:
                beside = right <= other[0] + 0.5 or other[2] <= left + 0.5
                assert beside or bottom <= other[1] + 0.5 or other[3] <= top + 0.5, width
        assert browser_page.evaluate(CLIPPED) == 0
        assert_sound(panel)


def test_a_screen_reader_finds_names_and_a_summary(browser_page):
    panel = mounted(browser_page, Explorer())
    assert "Arrives after" in browser_page.locator(".wmr-scene").get_attribute("aria-label")
    assert browser_page.locator(".wmr canvas[role=img][aria-label]").count() == 3
    assert browser_page.locator(".wmr-handle[aria-label*='arrow keys']").count() == 4
    panel.put("k_alpha", 3.0)
    browser_page.wait_for_function("""() => {
        const text = (it) => document.querySelector(it).textContent;
        return text('[aria-live]') === text('.wmr-status');
    }""")


def test_a_view_that_is_closed_answers_no_more(browser_page):
    panel = mounted(browser_page, Explorer())
    panel.page.evaluate(
        """() => {
            unmount();
            drawings = 0;
            panel.set('k_rho', 1);
            document.documentElement.dataset.theme = 'dark';
        }"""
    )
    browser_page.wait_for_timeout(100)
    assert browser_page.evaluate("() => drawings") == 0
