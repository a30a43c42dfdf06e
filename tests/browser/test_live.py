"""The small things to move, each in a page of its own: all that moves matters, and all is sound."""

from __future__ import annotations

import itertools
import math
import random
import re
from pathlib import Path

import pytest

pytest.importorskip("anywidget", reason="what moves needs anywidget")
from faults import crowded, violations
from host import mounted
from live import as_shown

from wmrbook import live

NAMES = sorted(set(live.__all__) - live.PARTS)
ASKS = {name: getattr(live, name)().setup["ask"] for name in NAMES}
GATES = {ask["kind"]: name for name, ask in ASKS.items() if ask}  # one of each kind
PICTURE = "() => [...document.querySelectorAll('canvas')].map(it => it.toDataURL()).join()"
TEXT = "() => document.querySelector('.live').innerText"
UNSOUND = re.compile(r"NaN|undefined|Infinity|\[object")
TOUCH = """() => [...new Set([...document.querySelectorAll('.live canvas')]
    .map(it => getComputedStyle(it).touchAction))]"""
# A mouse passes over each picture from its left to its right, and holds nothing.
PASS = """() => document.querySelectorAll('.live canvas').forEach(canvas => {
    const box = canvas.getBoundingClientRect();
    for (let share = 0.05; share < 1; share += 0.1) {
        canvas.dispatchEvent(new PointerEvent('pointermove', {
            clientX: box.left + share * box.width, clientY: box.top + share * box.height }));
    }
})"""
WORDS = (Path(__file__).parent / "words.js").read_text(encoding="utf-8")
KEYS = """keys => keys.forEach(key => document.activeElement.dispatchEvent(
    new KeyboardEvent('keydown', { key, bubbles: true })))"""
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
# Where the pictures are, below the top, with each knob at each of its ends.
PLACES = """async knobs => {
    const home = panel.get('state'), places = new Set();
    for (const [name, ends] of knobs) for (const value of ends) {
        panel.set('state', { ...home, [name]: value });
        await new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)));
        const [above, below] = ['.live', '.live-panes'].map(it => document.querySelector(it));
        places.add(below.getBoundingClientRect().top - above.getBoundingClientRect().top);
    }
    panel.set('state', home);
    return [...places];
}"""
# Frames that began a minute before: as the first after a button is pressed, if by less.
EARLIER = """() => {
    const next = window.requestAnimationFrame.bind(window);
    window.requestAnimationFrame = callback => next(now => callback(now - 60e3));
}"""
# A clock that goes at a hundredth of its pace until `hurry` is set: what plays is met on its way.
SLOWLY = """() => {
    const next = window.requestAnimationFrame.bind(window), begin = performance.now();
    window.requestAnimationFrame = callback => next(
        now => callback(window.hurry ? now : begin + (now - begin) / 100));
}"""


def opened(page, name: str):
    """Show one and commit to a prediction, if it asks for one; return it and its panel."""
    thing = getattr(live, name)()
    panel = mounted(page, thing, width=900)
    if ask := thing.setup["ask"]:
        assert not crowded(page, ".live", 20)
        commit(panel, ask)
    return thing, panel


def commit(panel, ask) -> None:
    page = panel.page
    if ask["kind"] == "choose":
        page.get_by_role("radio").nth(ask["key"]).check()
    elif ask["kind"] == "turn":
        page.get_by_role("slider").first.press("ArrowRight")
    else:
        for key in ("ArrowRight", "ArrowUp", "ArrowUp", "Backspace", "ArrowLeft"):
            page.locator("canvas").first.press(key)
    panel.press("Commit")


@pytest.fixture(scope="module", params=NAMES)
def in_the_dark(module_page, request):
    """One of them in a dark page, for all tests that put it back where it was."""
    module_page.emulate_media(color_scheme="dark")
    thing, panel = opened(module_page, request.param)
    return thing, panel, panel.state()


@pytest.fixture
def moved(in_the_dark):
    """It, its panel, and the state where it is at home."""
    _, panel, home = in_the_dark
    panel.page.troubles.clear()
    panel.page.mouse.move(0, 0)
    panel.set(**home)
    yield in_the_dark
    panel.page.assert_quiet()


def ends(knob: dict) -> list:
    return [knob["low"], knob["high"]] if "low" in knob else [value for value, _ in knob["choices"]]


@pytest.mark.needs("npm")
def test_each_end_and_each_choice_changes_the_picture_and_everybody_can_use_it_in_the_dark(moved):
    thing, panel, home = moved
    page, knobs = panel.page, thing.setup["knobs"]
    assert not crowded(page, ".live", 20)
    assert not violations(page, ".live", runOnly=["color-contrast"])  # the rest on a phone
    for knob in knobs:
        panel.set(**home)
        before, pictures = page.evaluate(PICTURE), set()
        if "choices" in knob:
            for value in ends(knob):
                page.get_by_label(knob["says"], exact=True).select_option(value)
                panel.settled()
                assert panel.get(knob["name"]) == value
                pictures.add(page.evaluate(PICTURE))
            assert len(pictures | {before}) > 1, f"{knob['name']} changes nothing"
            continue
        slider = panel.slider(knob["name"])
        said = slider.get_attribute("aria-valuetext")
        slider.press("ArrowLeft" if home[knob["name"]] >= knob["high"] else "ArrowRight")
        panel.settled()
        assert slider.get_attribute("aria-valuetext") != said
        assert page.evaluate(PICTURE) != before, f"{knob['name']} changes nothing"
        assert slider.get_attribute("aria-label") == knob["says"]
    names = [knob["name"] for knob in knobs]
    corners = list(itertools.islice(itertools.product(*map(ends, knobs)), 16))
    states = [dict(zip(names, corner, strict=True)) for corner in corners]
    for corner, (text, labels) in zip(corners, page.evaluate(SAID_AT, states), strict=True):
        for said in (text, *labels):
            assert not UNSOUND.search(said), (corner, said)
        assert all(len(label.split()) > 3 for label in labels)


def test_a_number_in_the_sentence_is_typed_dragged_and_refused_and_a_handle_moves(moved):
    thing, panel, home = moved
    page = panel.page
    for knob in thing.setup["knobs"]:
        number = page.get_by_role("spinbutton", name=knob["says"], exact=True)
        if "choices" in knob or not number.count():  # its slider alone moves it
            continue
        before = panel.get(knob["name"])
        panel.type(number, str(knob["high"] + 1))
        assert panel.get(knob["name"]) == before
        assert "is not allowed" in page.locator(".live-trouble").inner_text()
        middle = (knob["low"] + knob["high"]) / 2
        panel.type(number, f"{middle:.5f}".replace(".", ","))
        assert panel.get(knob["name"]) == pytest.approx(middle)
        assert page.locator(".live-trouble").inner_text() == ""
        now = panel.get(knob["name"])
        number.scroll_into_view_if_needed()
        panel.drag(number, 40, 0)
        assert panel.get(knob["name"]) > now
    panel.set(**home)
    for handle in page.locator(".wmr-handle").all():
        before = panel.state()
        for key in ("ArrowLeft", "ArrowUp"):
            handle.press(key)
        assert panel.settled().state() != before or page.locator(".live-trouble").inner_text()
        panel.drag(handle, 2000, -2000)  # off the picture
        for knob in thing.setup["knobs"]:
            if "low" in knob:
                assert knob["low"] <= panel.get(knob["name"]) <= knob["high"], knob["name"]
    panel.set(**home)
    page.evaluate(PASS)
    held = [name for name in home if name != "time" and panel.get(name) != home[name]]
    assert not held, f"a mouse that passes over a picture moves {held}"


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_words_in_a_picture_are_whole_and_none_lies_on_another(emptied_page, name):
    thing, draw = getattr(live, name)(), random.Random(name)
    for width in (390, 760):
        panel = mounted(emptied_page, thing, width=width, height=844)
        emptied_page.evaluate(WORDS)
        panel.set(guess="skipped")
        states = [{}] + [
            {
                knob["name"]: draw.uniform(*ends(knob))
                if "low" in knob
                else draw.choice(ends(knob))
                for knob in thing.setup["knobs"]
            }
            for _ in range(5)
        ]
        assert emptied_page.evaluate("states => crowdedAt(states)", states) == [], width


@pytest.mark.needs("npm")
@pytest.mark.parametrize("name", NAMES)
def test_on_a_phone_nothing_is_shown_before_the_prediction_and_everybody_can_use_it(
    emptied_page, name
):
    page, thing = emptied_page, getattr(live, name)()
    panel = mounted(page, thing, width=390, height=844)
    if ask := thing.setup["ask"]:
        given = page.evaluate(PICTURE)
        for knob in thing.setup["knobs"]:
            for value in ends(knob):
                panel.set(**{knob["name"]: value})
                assert page.evaluate(PICTURE) == given, knob["name"]
        panel.set(**thing.state)
        answers = page.locator(".live-sentence, .live-rows, .wmr-handle")
        assert answers.locator("visible=true").count() == 0
        assert re.search(r"\?|Sketch", ask["question"])
        assert as_shown(ask["why"]) not in page.evaluate(TEXT)
        assert not page.locator(".live-key").count()
        assert page.evaluate(TOUCH) == ["pan-y pinch-zoom"]  # a finger scrolls over it
        grips = page.locator(".live-grip:visible")  # but where the arrow or the path begins
        assert grips.count() == (ask["kind"] != "choose")
        assert page.get_by_role("button", name="Commit").is_disabled()
        assert not crowded(page, ".live", 20)
        assert name not in GATES.values() or not violations(page, ".live")
        commit(panel, ask)
        assert as_shown(ask["why"]) in page.evaluate(TEXT)
        assert grips.count() == 0
        assert page.locator(".live-sentence").is_visible()
        assert page.evaluate(PICTURE) != given
        assert page.locator(".live-gate input:enabled").count() == 0
        assert page.evaluate("document.activeElement.matches('.live-verdict')")  # keys go on there
    assert not crowded(page, ".live", 20)
    assert not violations(page, ".live")
    page.wait_for_function("document.querySelector('.live-sentence').style.minHeight")
    knobs = [(knob["name"], ends(knob)) for knob in thing.setup["knobs"]]
    assert len(page.evaluate(PLACES, knobs)) == 1  # a longer sentence moves nothing
    for handle in panel.settled().page.locator(".wmr-handle").all():
        before, after = panel.state(), []
        for key in ("Right", "Up"):
            handle.press(f"Shift+Arrow{key}")
            after.append(panel.state())
        assert after != [before] * 2, handle.get_attribute("data-handle")


@pytest.mark.parametrize("name", ["bench", "lag", "late"])
def test_a_hand_moves_a_drive_along_its_picture_whose_cursor_says_so(name, emptied_page):
    thing = getattr(live, name)()
    panel = mounted(emptied_page, thing)
    held = emptied_page.locator("canvas[style*=crosshair]")
    assert held.count() == 0  # not before it is asked
    commit(panel, thing.setup["ask"])
    time = panel.get("time")
    assert panel.drag(held.first, -9, 5).get("time") != time


def test_python_moves_it_and_refuses_what_is_not_allowed():
    thing = live.turning_centre()
    thing["left"] = 1.25
    assert thing["left"] == thing.state["left"] == 1.25
    for name, value, said in ("left", 9.0, "left"), ("left", math.nan, "left"), ("on", 1.0, "knob"):
        with pytest.raises(ValueError, match=f"{said} = .* is not allowed"):
            thing[name] = value


def test_a_path_is_sketched_by_hand_too(emptied_page):
    panel = mounted(emptied_page, live.half_turn())
    canvas = emptied_page.locator("canvas").first
    panel.drag(canvas, 0.3 * canvas.bounding_box()["width"], 0, steps=3)
    guess = panel.press("Commit").get("guess")
    steps = [after[0] - before[0] for before, after in itertools.pairwise(guess[1:])]
    assert len(steps) == 3
    assert steps == pytest.approx([steps[0]] * 3)


def test_a_hand_stops_what_plays_and_a_second_key_goes_on_from_the_first(emptied_page):
    _, panel = opened(emptied_page, "commutator")
    play = emptied_page.get_by_role("button", name="Play: moves made")
    emptied_page.evaluate(SLOWLY)
    play.click()
    stop = emptied_page.get_by_role("button", name="Stop: moves made")
    stop.wait_for()
    number = emptied_page.get_by_role("spinbutton", name="how far forward and back")
    number.press("ArrowDown")
    play.wait_for()
    rests = panel.settled().get("moves")
    emptied_page.evaluate("window.hurry = true")
    emptied_page.wait_for_timeout(200)
    assert panel.get("moves") == rests < 12
    play.click()
    panel.type(number, "999")
    play.wait_for()
    assert "999 is not allowed" in emptied_page.locator(".live-trouble").inner_text()

    _, panel = opened(emptied_page, "turning_centre")
    emptied_page.locator("[data-handle=left]").focus()
    emptied_page.evaluate(KEYS, ["ArrowLeft", "ArrowLeft"])
    twice = panel.settled().get("left")
    emptied_page.evaluate(KEYS, ["ArrowRight"])
    once = panel.settled().get("left")
    emptied_page.evaluate(KEYS, ["ArrowRight"])
    assert panel.settled().get("left") > once > twice

    _, panel = opened(emptied_page, "commutator")
    emptied_page.evaluate(EARLIER)
    play.click()
    stop.wait_for()
    assert panel.settled().get("moves") >= 0


def test_digits_that_are_selected_are_dragged_all_the_same(emptied_page):
    _, panel = opened(emptied_page, "poles")
    number = emptied_page.get_by_role("spinbutton").first
    number.select_text()
    before = panel.get("k_alpha")
    assert panel.drag(number, 60, 0).get("k_alpha") == pytest.approx(before + 1.2)


def test_a_comma_is_a_decimal_one_and_what_could_be_a_thousand_is_refused(emptied_page):
    _, panel = opened(emptied_page, "bearing")
    number = emptied_page.get_by_role("spinbutton").first
    (name,) = [it for it in ("east", "north") if it in number.get_attribute("aria-label")]
    before = panel.get(name)
    emptied_page.set_viewport_size({"width": 500, "height": 720})  # the sentence is laid out anew
    number.fill("7")
    emptied_page.wait_for_timeout(500)
    number.press("Tab")  # and what was being typed is still there
    assert panel.settled().get(name) == 7
    for text, value in (("1,5", 1.5), ("1.5e1", 15), ("\N{MINUS SIGN}2", -2), ("0,125", 0.125)):
        assert panel.type(number, text).get(name) == value
    for text in ("1,000", "0x10", "", "one"):
        assert panel.type(number, text).get(name) == 0.125 != before
        assert "number from" in emptied_page.locator(".live-trouble").inner_text()
    number.select_text()
    emptied_page.keyboard.type(number.input_value())  # nothing has changed since it was shown
    number.press("Tab")
    panel.settled()
    assert emptied_page.locator(".live-trouble").inner_text() == ""
    panel.set(east=0, north=0)  # nothing is said to follow from what is refused
    assert emptied_page.locator(".live-trouble").inner_text()
    assert set(emptied_page.locator(".live-result").all_inner_texts()) == {"\N{EN DASH}"}


CHOICES = [name for name, ask in ASKS.items() if ask and ask["kind"] == "choose"]


@pytest.mark.parametrize("name", CHOICES)
def test_each_wrong_answer_is_told_what_is_wrong_and_the_picture_shows_what_was_asked(
    emptied_page, name
):
    thing = getattr(live, name)()
    ask, page = thing.setup["ask"], emptied_page
    assert len(ask["wrong"]) == len(ask["options"])
    assert [not said for said in ask["wrong"]] == [
        k == ask["key"] for k in range(len(ask["wrong"]))
    ]
    panel = mounted(page, thing, width=900)
    shown = {}
    for knob, value in (pair for place in ask["asked"] for pair in place.items()):
        thing[knob] = shown[knob] = value  # or it is refused
    verdict = page.locator(".live-verdict")
    for k, wrong in enumerate(ask["wrong"]):
        page.get_by_role("radio").nth(k).check()
        panel.press("Commit")
        assert {knob: panel.get(knob) for knob in shown} == shown
        told = "As you said." if k == ask["key"] else f"Not so. {wrong}"
        assert verdict.inner_text() == as_shown(f"{told} {ask['why']}")
        panel.press("Try again")
        assert verdict.inner_text() == ""
        given = {knob["name"]: knob["value"] for knob in thing.setup["knobs"]}
        assert {knob: panel.get(knob) for knob in given} == given
        assert page.locator(".live-sentence").is_hidden()
    panel.press("Just show me")
    assert verdict.inner_text() == as_shown(ask["why"])
    right = page.locator(".live-key").all_inner_texts()
    assert right == [as_shown(ask["options"][ask["key"]])]


WATCHED = """() => { window.seen = []; panel.on('change:state', () =>
    window.seen.push([panel.get('state').stop, performance.now()])); }"""


def test_the_picture_moves_from_what_was_given_to_what_was_asked_unless_a_hand_stops_it(
    emptied_page,
):
    thing = live.stopping()
    panel, page = mounted(emptied_page, thing, width=900), emptied_page
    page.emulate_media(reduced_motion="no-preference")
    page.evaluate(WATCHED)
    commit(panel, thing.setup["ask"])
    passed = [stop for stop, _ in page.evaluate("window.seen")]
    assert passed[0] == 0.05
    assert passed[-1] == 0.01
    assert passed == sorted(passed, reverse=True)
    assert len({*passed}) > 4
    panel.press("Try again")
    page.get_by_role("radio").first.check()
    page.get_by_role("button", name="Commit").click()
    page.wait_for_function("panel.get('state').stop < 0.05")
    panel.slider("stop").press("ArrowRight")
    stopped = panel.settled().get("stop")
    page.wait_for_timeout(1500)
    assert panel.get("stop") == stopped > 0.01


def test_a_sketch_is_judged_by_its_distance_from_the_way(emptied_page):
    panel = mounted(emptied_page, live.wheel_limit(), width=900)
    commit(panel, ASKS["wheel_limit"])
    said = emptied_page.locator(".live-verdict").inner_text()
    far = float(re.search(r"Your path is ([\d.]+) m from the robot's, on average", said)[1])
    run = panel.found()["run"]
    way = list(zip(run["x"], run["y"], strict=True))
    ours = [min(math.dist(point, it) for it in way) for point in panel.get("guess")]
    assert far == pytest.approx(sum(ours) / len(ours), rel=0.05)
