"""A term's dates and rules, names in released copies, and answers that are alike."""

import re
from datetime import UTC, datetime, timedelta

import exchange
import handins
import nbformat
import policy
import pytest
import roster
from alike import alike
from graded import ROOT
from hypothesis import given
from hypothesis import strategies as st
from test_guide import block


@pytest.fixture
def folder(tmp_path):
    """An empty course with the guide's class and dates."""
    (tmp_path / "students.csv").write_text(block("text", "username"), encoding="utf-8")
    (tmp_path / "term.toml").write_text(block("toml", "zone"), encoding="utf-8")
    for each in "ch00", "ch01":
        (tmp_path / "source" / each).mkdir(parents=True)
    return tmp_path


def test_the_guides_class_and_dates_are_read(folder):
    assert [each.group for each in roster.read(folder / "students.csv")] == ["tuesday", "thursday"]
    term = policy.read(folder)
    dates = {
        (each, who): f"{term.due_for(each, who):%d %H:%M %z}"
        for each in ("ch00", "ch01")
        for who in ("alovelace3", "cbabbage", "nobody")
    }
    assert dates == {
        ("ch00", "alovelace3"): "12 23:59 +0200",
        ("ch00", "cbabbage"): "14 23:59 +0200",  # with the group
        ("ch00", "nobody"): "12 23:59 +0200",
        ("ch01", "alovelace3"): "19 18:00 +0200",
        ("ch01", "cbabbage"): "26 23:59 +0100",  # later than the group; no summer time any more
        ("ch01", "nobody"): "19 18:00 +0200",
    }
    assert term.due_for("ch02", "alovelace3") is None


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ("ch01 => ch99", "[due] ch99: there are ch00, ch01"),
        ("= 2026-10-12 => = 12", "ch00 = 12: 2026-10-19 or 2026-10-19T18:00:00 is needed"),
        ("cbabbage => babbage", "[extensions] babbage: there are alovelace3, cbabbage, thursday"),
        ("thursday = 2 => thursday = -2", "thursday = -2: 2026-10-19 or"),
        ("per_day = 0.1 => per_day = true", "[late] per_day = True: a number from 0 on"),
        ("most_days = 7 => most_days = -7", "[late] most_days = -7: a number from 0 on"),
        ("per_day => perday", "[late] perday: there are most_days, per_day"),
        ("[late] => [penalty]", "penalty: there are due, extensions, late, lessons, zone"),
        ("Europe/Berlin => Europe/Bonn", "Europe/Bonn"),
        ('"Europe => Europe', "term.toml: "),
    ],
)
def test_a_mistake_in_the_dates_is_named(folder, change, said):
    old, new = change.split(" => ")
    path = folder / "term.toml"
    path.write_text(path.read_text("utf-8").replace(old, new, 1), encoding="utf-8")
    with pytest.raises(ValueError, match=re.escape(said)) as error:
        policy.read(folder)
    assert str(path) in str(error.value)


@given(st.timedeltas(timedelta(days=-3), timedelta(days=30)), st.floats(0, 12), st.booleans())
def test_days_late_are_those_begun_and_cost_no_more_than_was_reached(late, points, late_rule):
    due = {"ch01": datetime(2026, 10, 19, 16, tzinfo=UTC)}
    term = policy.Term(due, {}, {}, {}, 0.1, 7 if late_rule else 1e9)
    days = term.days_late("ch01", "ada", due["ch01"] + late)
    assert days == next(k for k in range(40) if late <= timedelta(days=k))
    lost = term.penalty(days, points)
    assert lost == pytest.approx(points if late_rule and days > 7 else points * min(days, 10) / 10)
    assert term.days_late("ch01", "ada", None) == 0


ANSWER = """def distance(a, b):
    \"\"\"How far it is.\"\"\"
    east = (b.lon - a.lon) * math.cos(a.lat)
    north = b.lat - a.lat
    return radius * math.hypot(east, north)
"""


@pytest.mark.parametrize(
    ("edits", "shared"),
    [
        ((), None),  # all alike: nothing is rare
        (("east => dx_east", "north => dy_norte"), ["dx_east", "dy_norte"]),
        (("east => dx_east",), None),  # one name may be chance
        (("return => # as the man said\n    return",), ["# as the man said"]),
        (("radius => 6371.137",), ["6371.137"]),
        (("radius => 6371.0088",), None),  # the task names it
    ],
)
def test_what_only_two_have_in_the_same_program_is_told(edits, shared):
    answers = {f"s{k}": ANSWER for k in range(8)}
    for student in "s3", "s4":
        for edit in edits:
            answers[student] = answers[student].replace(*edit.split(" => "))
    own = answers["s4"].replace('    """How far it is."""\n', "")
    answers["s4"] = own.replace("distance", "far")
    answers |= {"deep": "(" * 10**5, "long": "+".join("1" * 9999), "null": "\0", "open": "x = ("}
    known = "The radius is 6371.0088 km. def distance(a, b): east north math"
    found = list(alike(answers, known))
    assert found == ([(["s3", "s4"], shared)] if shared else [])
    few = {each: answers[each] for each in ("s1", "s2", "s3", "s4")}
    other = answers | {"s4": answers["s4"] + "far(1, 2)\n"}
    short = {each: "\n".join(text.splitlines()[-1:]).strip() for each, text in answers.items()}
    assert not [*alike(few, known), *alike(other, known), *alike(short, known)]


def test_a_released_copy_bears_its_students_name_and_another_is_remarked(folder):
    named = 0
    for path in (ROOT / "book" / "course" / "source").glob("*/*.ipynb"):
        released = nbformat.read(path, as_version=4)
        for cell in released.cells:
            cell.source = re.sub("### BEGIN.*?### END SOLUTION", "", cell.source, flags=re.DOTALL)
        own = exchange.named(nbformat.writes(released).encode(), "Zo\u00eb.b-2")
        pairs = zip(nbformat.reads(own.decode(), as_version=4).cells, released.cells, strict=True)
        changed = [each for each, before in pairs if each.source != before.source]
        assert all(cell.source.startswith('name = "Zo\u00eb.b-2"') for cell in changed)
        named += len(changed)
        copy = nbformat.reads(own.decode(), as_version=4)
        assert not handins.misnamed(copy, "Zoe\u0308.b-2")
        for notebook in copy, released:
            assert len(handins.misnamed(notebook, "zoe")) == len(changed) <= 1
    assert named == 5
