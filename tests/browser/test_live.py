"""Live figures, each in a page of its own: all that moves matters, and everybody can use it."""

from __future__ import annotations

import itertools
import math
import re

import pytest

pytest.importorskip("anywidget", reason="what moves needs anywidget")
from faults import crowded, violations
from host import mounted
from live import as_shown

from wmrbook import live

NAMES = sorted(set(live.__all__) - live.PARTS)
PICTURE = "() => [...document.querySelectorAll('canvas')].map(it => it.toDataURL()).join()"
UNSOUND = re.compile(r"NaN|undefined|Infinity|\[object")
# What is read, and spoken, at each of these states: [text, [names of pictures]].
SAID_AT = """async states => {
    const said = [];
    for (const state of states) {
        panel.set('state', { ...panel.get('state'), ...state });
        await new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)));
        said.push([document.querySelector('.live').innerText,
            [...document.querySelectorAll('.live canvas')].map(it => it.ariaLabel)]);
    }
    return said;
}"""
# A clock that goes at a hundredth of its pace: what plays is met on its way.
SLOWLY = """() => {
    const next = window.requestAnimationFrame.bind(window), begin = performance.now();
    window.requestAnimationFrame = callback => next(now => callback(begin + (now - begin) / 100));
}"""


def opened(page, name: str):
    """Show a figure and answer what it asks, if it asks."""
    thing = getattr(live, name)()
    panel = mounted(page, thing, width=900)
    if ask := thing.setup["ask"]:
        answer(panel, ask)
    return panel


def answer(panel, ask, option: int | None = None) -> None:
    """By keyboard: the right option, or another one, or an arrow or a sketch of one's own."""
    page = panel.page
    if ask["kind"] == "choose":
        option = ask["key"] if option is None else option
        page.locator(".live-answers .live-chip").nth(option).press("Enter")
        panel.settled()
        return
    if ask["kind"] == "turn":
        page.get_by_role("slider", name="the angle of the arrow").press("ArrowRight")
    else:
        for key in ("ArrowRight", "ArrowUp", "ArrowUp", "Backspace", "ArrowLeft"):
            page.locator("canvas").first.press(key)
    panel.press("That's it")


def ends(knob: dict) -> list:
    return [knob["low"], knob["high"]] if "low" in knob else [value for value, _ in knob["choices"]]


@pytest.mark.needs("npm")
@pytest.mark.parametrize("name", NAMES)
def test_on_a_phone_every_knob_changes_the_picture_once_a_prediction_is_made(emptied_page, name):
    page, thing = emptied_page, getattr(live, name)()
    panel, knobs = mounted(page, thing, width=390, height=844), thing.setup["knobs"]
    if ask := thing.setup["ask"]:
        given = page.evaluate(PICTURE)
        for knob in knobs:
            panel.set(**{knob["name"]: ends(knob)[0]})
        assert page.evaluate(PICTURE) == given  # nothing is shown before
        panel.set(**thing.state)
        answers = page.locator(".live-sentence, .live-rows, .wmr-handle, .live-verdict")
        assert answers.locator("visible=true").count() == 0
        if ask["kind"] != "choose":
            assert page.get_by_role("button", name="That's it").is_disabled()
        answer(panel, ask)
        verdict = page.locator(".live-verdict:visible").inner_text()
        assert as_shown(ask["why"]) in verdict
        assert page.evaluate(PICTURE) != given
    home = panel.state()
    for knob in knobs:
        panel.set(**home)
        before = page.evaluate(PICTURE)
        if "choices" in knob:
            box, others = page.get_by_label(knob["says"], exact=True), set(ends(knob))
            for value in others - {home[knob["name"]]}:
                box.select_option(value)
                panel.settled()
        else:
            slider = panel.slider(knob["name"])
            assert slider.get_attribute("aria-label") == knob["says"]
            slider.press("ArrowLeft" if home[knob["name"]] >= knob["high"] else "ArrowRight")
            panel.settled()
        assert page.evaluate(PICTURE) != before, f"{knob['name']} changes nothing"
    names = [knob["name"] for knob in knobs]
    corners = itertools.islice(itertools.product(*map(ends, knobs)), 16)
    states = [dict(zip(names, corner, strict=True)) for corner in corners]
    for state, (text, labels) in zip(states, page.evaluate(SAID_AT, states), strict=True):
        assert not UNSOUND.search(" ".join((text, *labels))), state
        assert all(len(label.split()) > 3 for label in labels)
    panel.set(**home)
    assert not crowded(page, ".live", 20)
    assert not violations(page, ".live")
    page.emulate_media(color_scheme="dark")
    panel.settled()
    assert not violations(page, ".live", runOnly=["color-contrast"])


def test_a_wrong_answer_is_told_what_is_wrong_and_the_knobs_go_where_it_asks():
    things = [getattr(live, name)() for name in NAMES]
    asking = [thing for thing in things if (thing.setup["ask"] or {}).get("wrong")]
    assert len(asking) > 5
    for thing in asking:
        ask = thing.setup["ask"]
        wrong = [k for k, reason in enumerate(ask["wrong"]) if reason]
        assert wrong == [k for k in range(len(ask["options"])) if k != ask["key"]]
        for knob, value in (pair for place in ask["asked"] for pair in place.items()):
            thing[knob] = value  # or it is refused


def test_an_answer_is_judged_and_can_be_tried_again(emptied_page):
    thing, page = live.stopping(), emptied_page
    panel, ask = mounted(page, thing), thing.setup["ask"]
    verdict, right = page.locator(".live-verdict:visible"), ask["options"][ask["key"]]
    for k, wrong in enumerate(ask["wrong"]):
        answer(panel, ask, k)
        assert panel.get("stop") == ask["asked"][-1]["stop"]
        is_right = k == ask["key"]
        judged = f"Yes, {right}. {ask['why']}" if is_right else f"No: {right}. {wrong}"
        assert verdict.inner_text() == as_shown(judged)
        assert page.evaluate("document.activeElement.className") == "live-verdict"
        panel.press("Try again")
        assert panel.get("stop") == live.stopping()["stop"]
        assert page.locator(".live-sentence").is_hidden()
    panel.press("Just show me")
    assert verdict.inner_text() == as_shown(f"{right.capitalize()}. {ask['why']}")


def test_a_remembered_answer_opens_a_figure(browser_page):
    browser_page.add_init_script("globalThis.wmrKit = () => {}")  # as where a page remembers
    ask = live.stopping().setup["ask"]
    asked = ask["asked"][-1]["stop"]
    answer(mounted(browser_page, live.stopping()), ask)
    panel = mounted(browser_page, live.stopping())
    assert panel.get("stop") == asked
    browser_page.get_by_label("more about predictions").click()
    panel.press("Forget all my answers")
    assert panel.get("stop") == mounted(browser_page, live.stopping()).get("stop") != asked


def test_a_sketch_is_drawn_by_hand_and_judged_by_its_distance_from_the_way(emptied_page):
    panel = mounted(emptied_page, live.half_turn(), width=900)
    canvas = emptied_page.locator("canvas").first
    panel.drag(canvas, 0.3 * canvas.bounding_box()["width"], 0, steps=3)
    guess = panel.press("That's it").get("guess")
    assert len(guess) == 5
    verdict = emptied_page.locator(".live-verdict:visible").inner_text()
    far = float(re.search(r"Your path is ([\d.]+) m from the robot's, on average", verdict)[1])
    run = panel.results()["run"]
    way = list(zip(run["x"], run["y"], strict=True))
    ours = [min(math.dist(point, it) for it in way) for point in guess]
    assert far == pytest.approx(sum(ours) / len(ours), rel=0.05)


def test_a_number_in_the_sentence_is_typed_dragged_and_refused(emptied_page):
    panel = opened(emptied_page, "bearing")
    number = emptied_page.get_by_role("spinbutton", name="point 2 to the east", exact=True)
    trouble = emptied_page.locator(".live-trouble")
    for text, value in (("1,5", 1.5), ("1.5e1", 15), ("\N{MINUS SIGN}2", -2), ("0,125", 0.125)):
        assert panel.type(number, text).get("east") == value
    for text in ("1,000", "0x10", "", "61"):  # the first could be either
        assert panel.type(number, text).get("east") == 0.125
        assert trouble.inner_text()
    panel.type(number, "3")
    assert not trouble.inner_text()
    assert panel.drag(number, 40, 0).get("east") > 3
    panel.set(east=0, north=0)  # nothing is said to follow from what is refused
    assert trouble.inner_text()
    assert set(emptied_page.locator(".live-result").all_inner_texts()) == {"\N{EN DASH}"}


@pytest.mark.parametrize(
    ("name", "handle", "key", "knob", "sign"),
    [
        ("two_bars", "state", "ArrowRight", "alpha", 1),
    ],
)
def test_what_can_be_held_moves_the_figure(emptied_page, name, handle, key, knob, sign):
    panel, held = opened(emptied_page, name), emptied_page.locator(f"[data-handle={handle}]")
    for act in (lambda: held.press(key), lambda: panel.drag(held, 15, -30)):
        before, picture = panel.settled().get(knob), panel.picture()
        act()
        moved = panel.settled().get(knob) - before
        assert panel.picture() != picture
        assert moved * sign > 0 or (sign == 0 and moved)
    panel.drag(held, 2000, -2000)  # off the picture
    for it in getattr(live, name)().setup["knobs"]:
        if "low" in it:
            assert it["low"] <= panel.get(it["name"]) <= it["high"]


def test_a_hand_stops_what_plays(emptied_page):
    panel = opened(emptied_page, "half_turn")
    play = emptied_page.get_by_role("button", name="Play: how far on its way")
    emptied_page.evaluate(SLOWLY)
    play.click()
    emptied_page.get_by_role("button", name="Stop: how far on its way").wait_for()
    emptied_page.get_by_role("spinbutton", name="the goal to the right").press("ArrowDown")
    play.wait_for()
    assert panel.settled().get("time") < 1


def test_python_moves_a_figure_and_refuses_what_is_not_allowed():
    thing = live.one_step()
    thing["dt"] = 1.25
    assert thing["dt"] == thing.state["dt"] == 1.25
    for name, value, message in (
        ("dt", 9.0, "dt"),
        ("dt", math.nan, "dt"),
        ("on", 1.0, "knob"),
    ):
        with pytest.raises(ValueError, match=f"{message} = .* is not allowed"):
            thing[name] = value
