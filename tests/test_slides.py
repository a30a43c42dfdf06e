"""Each chapter's deck is written as one: claims, pictures, and what to ask a class."""

import json
import math
import re

import pytest
import slides

NUMBERS = sorted(path.stem for path in (slides.BOOK / "deck").glob("[0-9][0-9].md"))
NUMBER = re.compile(r"(?<![\w.])\d[\d,]*(?:\.\d+)?(?:e-?\d+)?")


def source(number):
    return (slides.BOOK / "deck" / f"{number}.md").read_text(encoding="utf-8")


def test_each_chapter_has_a_deck():
    paths = (slides.ROOT / "notebooks").glob("[0-9][0-9]_*.ipynb")
    assert sorted(path.name[:2] for path in paths) == NUMBERS


@pytest.mark.parametrize("number", NUMBERS)
def test_the_numbers_in_a_deck_are_those_of_the_chapters_that_it_shows(number):
    figures = re.findall(r"^figure: (.*)$", source(number), re.MULTILINE)
    shown = {number, *(name[:2] for name in figures if name[2] == "/")}
    known = numbers(" ".join([*map(shown_by, shown), *figures]).replace("=", " "))
    stated = numbers(
        re.sub(r"^figure: .*$|[Cc]hapters? [\d, and]+", "", source(number), flags=re.MULTILINE)
    )
    assert {it for it in stated - known if it >= 10 or it % 1} == set()


def numbers(text):
    return {float(it.replace(",", "")) for it in NUMBER.findall(text)}


def shown_by(number):
    """All that a chapter says in words, prints, and asks."""
    chapter, texts = slides.chapter(number), []
    for cell in chapter.cells:
        texts.append(cell.source)
        for output in cell.get("outputs", ()):
            data = output.get("data", {})
            texts += [output.get("text", ""), data.get("text/plain", "")]
            texts += [data.get("text/markdown", ""), data.get("text/latex", "")]
    widgets = chapter.metadata.get("widgets", {}).get(slides.STATE, {"state": {}})
    for model in widgets["state"].values():
        setup = model["state"].get("setup", {})
        parts = [setup.get(part) for part in ("ask", "knobs", "sentence")]
        texts.append(json.dumps(parts, ensure_ascii=False))
    return " ".join(texts)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (("no-cell",), "0 pictures at cell 'no-cell': 1 is needed"),
        (("live-two-bars", "gain=3"), "no knob 'gain', only law, alpha, theta"),
        (("live-two-bars", "alpha=400"), "alpha=400: not from -180.0 to 180.0"),
    ],
)
def test_a_picture_that_is_not_there_and_a_knob_that_does_not_turn_so_far_are_told(wrong, message):
    with pytest.raises(SystemExit, match=re.escape(message)):
        slides.picture_of("04", *wrong)


def test_a_panel_begins_as_its_slide_says_and_leaves_the_chapters_own_alone():
    panel = slides.picture_of("04", "live-two-bars", "law=printed", "theta=-90", "open")
    state = json.loads(re.findall(r">(\{.*?\})</script>", panel)[1])["state"]["it"]["state"]
    assert state["state"] == {"alpha": 0.0, "guess": None, "law": "printed", "theta": -90.0}
    assert state["setup"]["ask"] is None
    again = slides.picture_of("04", "live-two-bars")
    assert '"law": "corrected"' in again
    assert '"ask": {' in again


@pytest.mark.parametrize("number", NUMBERS)
def test_a_lecturers_notes_have_the_exercises_with_their_solutions(number):
    solved = slides.solved(number)
    assert solved.count("### Exercise") == solved.count("**Solution.**") >= 5
    assert "<details>" not in solved
    assert "**Solution.**" not in source(number)


def test_a_stage_stands_in_its_scene_as_its_slide_says():
    stage = slides.picture_of("04", "opening-scene", "scene=ask", "h=0", "start=1,-3,90", "open")
    state = json.loads(re.findall(r">(\{.*?\})</script>", stage)[1])["state"]["it"]["state"]
    (scene,) = (it for it in state["setup"]["scenes"] if it["name"] == "ask")
    assert (scene["to"], scene["ask"]) == ({"h": 0.0}, None)
    assert state["setup"]["poses"]["start"] == [1.0, -3.0, math.radians(90.0)]


@pytest.mark.parametrize("number", NUMBERS)
def test_no_picture_stands_twice_in_a_deck(number):
    pictures = [slide.picture for slide in slides.deck(number)[1] if slide.picture]
    assert len(pictures) == len({*pictures})


def test_a_vote_shows_the_situation_of_its_question_and_an_unknown_one_is_refused():
    assert "before its moves" in slides.picture_of("02", "question/four-moves")
    with pytest.raises(SystemExit, match="no picture of the question 'three-moves', only two-angl"):
        slides.picture_of("02", "question/three-moves")


def test_items_of_some_lists_appear_one_by_one(tmp_path):
    words = "+ first\n+ second\n\n> 1) third\n\n- at once"
    slides.write(tmp_path / "deck.html", "Title", [slides.Slide("Claim", words)])
    page = (tmp_path / "deck.html").read_text(encoding="utf-8")
    later = re.findall(r'<li class="fragment">\s*(?:<p>)?(\w+)', page)
    assert later == ["first", "second", "third"]
