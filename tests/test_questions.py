"""The concept questions: computed keys, the lines that come back, histograms and the gain."""

import json
import os
import re
import subprocess
import sys
from io import BytesIO
from pathlib import Path
from zipfile import ZipFile

import numpy as np
import package
import pytest
import python_pack
from hypothesis import given
from hypothesis import strategies as st

from wmrbook import questions
from wmrbook.figures import scenes
from wmrbook.lines import Line, read, read_all, written
from wmrbook.questions import Option, Refusal
from wmrbook.questions.__main__ import main
from wmrbook.questions._asking import cases, numbers
from wmrbook.questions._formulas import as_html
from wmrbook.questions.classes import read_class
from wmrbook.questions.form import form
from wmrbook.questions.gain import gain, normalised
from wmrbook.questions.picture import bars

TESTS = Path(__file__).parent
CHAPTERS = sorted((TESTS.parent / "notebooks").glob("[0-9][0-9]_*.ipynb"))
QUESTIONS = questions.made()
TESTED = tuple(question for question in QUESTIONS if not question.untested)
MARK = questions.fingerprint(TESTED)
KEYS = "".join(question.key for question in TESTED)
COUNT = len(KEYS)
# What a student has before the course: the form's words say what the symbols mean.
NOT_YET = r"[Pp]aper|gentle|[Aa]udit|\(\d+\)|\bpoles?\b|damping ratio|Siegwart|Lyapunov"


def test_there_are_26_over_all_chapters_and_no_letter_of_the_test_is_favoured():
    assert (len(QUESTIONS), COUNT) == (26, 21)
    assert {question.chapter for question in QUESTIONS} == {*range(13), 14}
    assert {letter: KEYS.count(letter) >= 3 for letter in "ABCDE"} == dict.fromkeys("ABCDE", True)


def test_the_test_has_no_words_that_the_course_brings():
    asked = {it.id: f"{it.ask} {[option.text for option in it.options]}" for it in QUESTIONS}
    spoken = {name for name, text in asked.items() if re.search(NOT_YET, text)}
    assert spoken <= {it.id for it in QUESTIONS if it.untested}
    assert len(spoken) > 2


@pytest.mark.parametrize("question", QUESTIONS, ids=lambda it: it.id)
def test_a_question_is_short_has_one_right_option_and_a_section_that_answers_it(question):
    chapter = CHAPTERS[question.chapter].read_text(encoding="utf-8")
    section = re.escape(json.dumps(question.section, ensure_ascii=False)[1:-1])
    assert re.search(rf'"#+ {section}(\\n)?"', chapter), question.section
    assert len(question.ask.split()) <= 40
    assert len({as_html(option.text) for option in question.options}) == 5
    assert max(len(option.text.split()) for option in question.options) <= 12
    right = [option for option in question.options if not option.mistake]
    assert right == [question.options["ABCDE".index(question.key)]]


def test_a_flipped_sign_in_the_formula_behind_it_changes_a_key_or_stops_the_question():
    plain = os.environ | {"NUMBA_DISABLE_JIT": "1"}
    command = [sys.executable, "-W", "ignore", TESTS / "flipped.py"]
    told = json.loads(subprocess.run(command, env=plain, capture_output=True, check=True).stdout)
    right = {it.id: it.options["ABCDE".index(it.key)].text for it in QUESTIONS}
    assert told.keys() == right.keys()
    assert [name for name in right if told[name] == right[name]] == []


def test_options_that_agree_and_texts_that_explain_another_answer_are_refused():
    wrong = {"one": 2.0, "two": 3.0, "three": -1.0, "four": 0.0}
    found = numbers(1.0, wrong, "{:.0f} m")
    assert [it.text for it in found] == [f"{k} m" for k in range(-1, 4)]
    for right in (2.03, 0.0, float("nan")):
        with pytest.raises(Refusal, match="nearly equal"):
            numbers(right, wrong, "{:.0f} m")
    texts = {1: ("left", ""), -1: ("right", "a sign"), 0: ("ahead", "a sine")}
    assert {it for it in cases(1, texts) if not it.mistake} == {Option("left", "")}
    for found in (-1, 7, None):
        with pytest.raises(Refusal, match=f"explain 1, and {found} was computed"):
            cases(found, texts)


names = st.text(st.characters(categories=["L", "N", "P", "Zs"]), min_size=1, max_size=60)


@given(
    st.from_regex("[a-z]{1,20}", fullmatch=True),
    st.from_regex("[a-z0-9][a-z0-9-]{0,59}", fullmatch=True),
    names,
    names,
    st.data(),
)
def test_a_line_comes_back_as_it_was_and_one_with_a_changed_character_does_not(
    kind, which, name, value, data
):
    try:
        text = written(Line(kind, which, name, value))
    except ValueError:
        assert not any(map(str.isalnum, name)) or not value.strip()
        return
    assert text.isascii()
    back = read(f"12.3., 10:11 - Ada: {text} thanks")
    assert (back.kind, back.id) == (kind, which)
    assert written(back) == text
    at = data.draw(st.integers(5, len(text) - 1))
    for other in ("", "x" if text[at] != "x" else "y"):
        with pytest.raises(ValueError, match=r"checksum|there is no line"):
            read(text[:at] + other + text[at + 1 :])


def test_a_name_counts_once_by_its_last_line_and_what_does_not_count_is_listed(tmp_path):
    path = tmp_path / "class.txt"
    first, last = (written(Line("gate", "a", name, value)) for name, value in ("A1", "a2"))
    text = f"\ufeff# class 7\r\n\r\n{first}\r\n{last}\nrubbish"
    path.write_bytes(text.encode() + b"\xff\n")
    lines, refused = read_all(path)
    assert lines == [Line("gate", "a", "a", "2")]
    assert [(it.line, "no line" in it.reason) for it in refused] == [(5, True)]


@pytest.fixture
def sent(tmp_path):
    """A file of a class: three sheets, a choice, two sorts of numbers, and lines that are wrong."""
    right, blank = KEYS, "-" * COUNT
    lines = [
        Line("test", f"pre-{MARK}", "Ada", blank),
        Line("test", f"pre-{MARK}", "Bob", right),
        Line("test", f"post-{MARK}", "ADA", right),
        Line("test", f"pre-{MARK}", "Cy", right[:11] + blank[11:]),
        Line("test", f"post-{MARK}", "cy", right),
        *(Line("gate", "ch04-sign", *each) for each in ("AL", "BR", "CL")),
        *(Line("gate", "ch06-gain", *each) for each in (("A", "10"), ("B", "9.0"), "C9")),
        *(Line("gate", "ch08-step", f"n{k}", f"{k / 8:.3f}") for k in range(17)),
        Line("test", f"mid-{MARK}", "Dee", right),
        Line("test", "pre-0000", "Dee", right),
        Line("test", f"pre-{MARK}", "Dee", right[1:]),
    ]
    path = tmp_path / "class.txt"
    guesses = ["12.3. - Ada: predict turning_centre 2", *["predict turning_centre 0"] * 2]
    told = [*map(written, lines), *guesses, "predict path [[0,1]]"]
    path.write_text("\n".join(told), encoding="utf-8")
    return path


def test_a_class_file_becomes_histograms_of_choices_and_of_numbers(sent):
    found = read_class(sent, TESTED, MARK)
    told = [(it.line, it.reason) for it in found.refused]
    assert [line for line, _ in told] == [29, 30, 31, 35]
    parts = "no test", "another form", f"{COUNT} letters", "no line"
    assert all(part in reason for (_, reason), part in zip(told, parts, strict=True))
    groups = found.histograms(TESTED)
    first = groups["test pre"][0]
    chosen = dict(zip(first.labels, first.counts, strict=True))
    assert chosen == dict.fromkeys("ABCDE", 0) | {KEYS[0]: 2, "-": 1}
    assert groups["test pre"][0].right == KEYS[0]
    assert groups["test pre"][-1].counts[-1] == 2
    assert groups["gate ch04-sign"][0][1:3] == (("L", "R"), (2, 1))
    assert groups["gate ch06-gain"][0][1:3] == (("9", "10"), (2, 1))
    assert groups["predict turning_centre"][0][1:3] == (("0", "2"), (2, 1))
    (steps,) = groups["gate ch08-step"]
    assert (sum(steps.counts), steps.labels[0][:4]) == (17, "0 to")
    for title, histograms in groups.items():
        picture = bars(histograms, title)
        drawn = [[bar.get_height() for bar in axes.patches] for axes in picture.figure.axes]
        assert drawn == [list(each.counts) for each in histograms]
        marked = [[bool(bar.get_hatch()) for bar in axes.patches] for axes in picture.figure.axes]
        assert marked == [[label == it.right for label in it.labels] for it in histograms]
        assert all(each.title in picture.alt for each in histograms)
    assert "A 2 (right)" in bars(groups["test post"], "x").alt


def test_the_commands_write_what_they_say_and_name_what_does_not_count(sent, capsys):
    main(["histogram", str(sent)])
    told = capsys.readouterr().out
    assert f"1. {TESTED[0].id}: 3 answers" in told
    assert "line 30 does not count: it was made with another form (0000" in told
    shown = Path(f"{sent}.html").read_text(encoding="utf-8")
    assert shown.count("<img alt=") == 6
    main(["gain", str(sent)])
    told = capsys.readouterr().out
    assert "2 students sat both tests: 26 % right before, 100 % after." in told
    assert "Normalised gain 1.00" in told
    assert "with the first test only: Bob" in told
    for name in ("none.txt", "."):
        with pytest.raises(SystemExit, match=re.escape(name)):
            main(["gain", name])


def test_the_form_holds_no_key():
    """It is the same page whichever options are right."""

    def other(question):
        wrong = [option._replace(mistake=f"m{at}") for at, option in enumerate(question.options)]
        at = "ABCDE".index(question.key)
        wrong[at - 1] = wrong[at - 1]._replace(mistake="")
        return question._replace(options=tuple(wrong), why="", section="", title="")

    assert form(TESTED) == form(tuple(map(other, TESTED)))
    assert form(TESTED).count("<fieldset>") == COUNT + 1
    changed = TESTED[0]._replace(ask=TESTED[0].ask + " ")
    assert questions.fingerprint((changed, *TESTED[1:])) != MARK
    with pytest.raises(ValueError, match=r"a form can't write \\gamma"):
        as_html(r"$\gamma$")


def test_students_do_not_get_what_computes_the_keys():
    names = {name for name, _ in package._book()}
    names |= set(ZipFile(BytesIO(python_pack.packages())).namelist())  # of the pages
    assert {"book/wmrbook/lines.py", "wmrbook/lines.py"} <= names
    assert not [name for name in names if "wmrbook/questions" in name]


def test_a_picture_has_no_number_that_its_question_has_not():
    asked = {it.id: it.ask for it in QUESTIONS}
    assert asked.keys() >= scenes.SCENES.keys()
    for name in scenes.SCENES:
        told = re.findall(r"\d+(?:\.\d+)?", scenes.scene_of(name).alt)
        assert set(told) <= set(re.findall(r"\d+(?:\.\d+)?", asked[name])), name


def a_class(rng, known, planted, guess=0.2, students=30):
    """Answers before and after of a class that gains exactly what is planted, up to one question.

    Whether a student knows a question follows from ability and difficulty (a logistic curve, both
    normal); of all that is not known, a share is learned, sooner where it lies nearer; what is
    known is answered rightly, everything else with the probability of a guess.
    """
    near = rng.normal(size=(students, 1)) - rng.normal(size=(1, COUNT))
    chance = 1.0 / (1.0 + np.exp(-near - 1.35 * np.log(known / (1 - known))))
    before = rng.random(near.shape) < chance
    open_ = np.flatnonzero(~before)
    odds = 1.0 / (1.0 + np.exp(-near.ravel()[open_]))
    learned = rng.choice(open_, round(planted * open_.size), replace=False, p=odds / odds.sum())
    after = before.copy()
    after.flat[learned] = True
    answers = (knows | (rng.random(near.shape) < guess) for knows in (before, after))
    return *answers, learned.size / open_.size


def how_often(known, planted):
    """How often the gain is within 0.05 of what was planted."""
    rng, near = np.random.default_rng(7), []
    for _ in range(300):
        before, after, gained = a_class(rng, known, planted)
        near.append(abs(normalised(before, after, None) - gained) <= 0.05)
    return np.mean(near)


def test_the_lecturers_guide_says_how_often_a_gain_is_right():
    text = (TESTS.parent / "book" / "lecturers.md").read_text(encoding="utf-8")
    planted = re.findall(r"gain (0\.\d)", re.search(r"\| known before .*", text)[0])
    rows = re.findall(r"^\| (\d+) % \| (\d+) % \| (\d+) % \| (\d+) % \|$", text, re.MULTILINE)
    assert (len(planted), len(rows)) == (3, 3)
    for known, *told in rows:
        found = [how_often(int(known) / 100, float(each)) for each in planted]
        assert found == pytest.approx([int(share) / 100 for share in told], abs=0.05)


def test_a_gain_is_of_those_who_sat_both_tests_and_says_what_is_in_doubt():
    rows = {"ada": [1, 0, 0, 0], "bob": [1, 1, 0, 0], "cy": [0, 0, 0, 0]}
    later = {"dee": [1, 1, 1, 1], "bob": [1, 1, 1, 0], "ada": [1, 1, 0, 1]}
    before, after = ({n: np.array(v, bool) for n, v in it.items()} for it in (rows, later))
    result = gain(before, after)
    assert result[:5] == pytest.approx((0.6, 0.5, 2 / 3, 3 / 8, 6 / 8), abs=1e-9)
    named = result.names, result.only_before, result.only_after
    assert named == (("ada", "bob"), ("cy",), ("dee",))
    np.testing.assert_allclose(result.by_question[:, 2], [np.nan, 1.0, 0.5, 0.5])
    assert "fewer than 12 students" in result.remark
    some = {k: np.arange(20) % 2 == 0 for k in range(15)}  # half of it is forgotten
    other = {k: np.arange(20) % 4 < 2 for k in range(15)}
    assert "50 % of what is wrong after was right before" in gain(some, other, 0.2).remark
    for bad, told in (
        ((before, {"cy": after["ada"]}), "1 students sat both"),
        ((before, {n: it[:3] for n, it in after.items()}), "different lengths"),
        (({"ada": after["dee"], "bob": after["dee"]}, after), "nothing to gain"),
        ((before, after, 1.0), "guess = 1.0 is not allowed"),
    ):
        with pytest.raises(ValueError, match=told):
            gain(*bad)
