"""A check says the same of an answer that stands in another process as of one beside it."""

import base64
import contextlib
import json
import pickle
import threading
from collections import deque
from multiprocessing import Pipe

import graded
import judge
import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

import wmrlib as wmr
from wmrbook.grading import _wire
from wmrlib import symbolic as s

KINDS = "tuple list Fraction Decimal complex named array sympy unordered foreign function called"
KINDS = [*KINDS.split(), "pickled"]


class Called:
    """A listener whom somebody has called."""

    def __init__(self, link) -> None:
        self.link = link

    def accept(self):
        return self.link


def over_a_line(names: dict, asks) -> object:
    """What `asks(link)` returns, with an answer's names at the other end of the link."""
    ours, theirs = Pipe()
    with theirs, ours:
        line = _wire.Line(theirs, names, trusts=True)
        thread = threading.Thread(target=line.serve)
        thread.start()
        try:
            return asks(ours)
        finally:
            ours.close()
            thread.join()


def judged(chapter: str, name: str, names: dict) -> str:
    """How a check fails of whose answers the process that judges hears; nothing if it passes."""
    cells = graded.cells(chapter)
    ours = [source for source, points in cells.values() if not points]
    ours = [it for it in ours if graded.BEGIN not in it and not it.startswith("name =")]
    source, _ = cells[name]
    (shown,) = over_a_line(names, lambda link: judge._verdict(source, ours, Called(link)))
    return f"{shown.ename}: {shown.evalue}" if shown.output_type == "error" else ""


@pytest.mark.slow
@pytest.mark.parametrize("chapter", graded.ASSIGNMENTS)
def test_what_a_check_says_does_not_depend_on_where_the_answer_is(chapter):
    cells, tried = graded.cells(chapter), []
    tried += [(wrong["cell"], wrong["source"]) for wrong in graded.wrong_answers(chapter)]
    tried += [(task, cells[task][0]) for task, checks in graded.tasks(chapter).items() if checks]
    for key, right in graded.answers(chapter)["right"].items():
        task = graded.task_of(chapter, key)
        tried += [(task, graded.whole(chapter, key, answer)) for answer in right]
    for task, source in tried:
        names = dict(graded.given(chapter)) | {"name": "Ada"}
        with contextlib.suppress(Exception):  # then the checks fail
            graded.run_cell(source, f"<{chapter} answer>", names)
        beside = graded.lost(chapter, task, source)
        for name in graded.graded(chapter, task):
            assert judged(chapter, name, names) == beside.get(name, ""), (name, source)


NUMBERS = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(allow_nan=False),
    st.complex_numbers(allow_nan=False),
    st.text(),
    st.fractions(),
    st.decimals(allow_nan=False),
    st.builds(wmr.Pose, *[st.floats(-99, 99)] * 3),
    st.builds(lambda lat: wmr.GeoPoint(lat=lat, lon=1.0), st.floats(-90, 90)),
)
VALUES = st.recursive(
    NUMBERS, lambda inner: st.lists(inner, max_size=3).map(tuple) | st.lists(inner)
)


@given(VALUES)
def test_data_arrives_as_it_is(value):
    got = over_a_line({"it": value}, lambda link: _wire.Line(link, {}).value("it"))
    assert got == value
    assert type(got) is type(value)


def test_arrays_expressions_and_functions_arrive_as_what_they_are():
    flat = np.arange(6.0).reshape(2, 3)
    rate = sp.Piecewise(
        (sp.sin(s.alpha) / s.rho + s.decay(s.rho, s.k_rho), s.rho > 0), (sp.pi, True)
    )
    names = {"flat": flat, "rate": rate, "twice": lambda ask, x: 2 * ask(x), "huge": 10**400}
    names |= {"named": lambda ask: ask(x=7), "matrix": np.array([[1.0, 2.0]]).view(np.matrix)}
    names |= {"deque": deque([1, 2]), "values": {"a": 1, "b": 2}.values(), "range": range(1, 3)}
    names |= {"long": np.array([1, 2], np.longdouble), "point": sp.Point(1, 2)}
    names |= {"column": sp.Matrix([1, 2]), "words": {1, 2}, "own": object()}

    def asks(link):
        line = _wire.Line(link, {})
        assert (line.value("flat") == flat).all()
        assert str(line.value("rate")) == str(rate)
        assert line.value("twice")(lambda x: x + 1, 20) == 42  # there and back again
        assert line.value("huge").__float__() == float("inf")
        assert [*line.value("column")] == [1, 2]
        assert isinstance(line.value("words"), dict)
        assert type(line.value("own")).__name__ == "object"
        assert line.value("named")(lambda x: x + 1) == 8
        assert line.value("matrix").tolist() == [[1.0, 2.0]]
        rows = (line.value(key) for key in ("deque", "values", "range", "long", "point"))
        assert [[float(each) for each in row] for row in rows] == [[1.0, 2.0]] * 5
        with pytest.raises(NameError, match="nothing"):
            line.value("nothing")

    over_a_line(names, asks)


@given(
    st.recursive(
        NUMBERS.filter(lambda it: isinstance(it, (type(None), bool, int, float, str))),
        lambda inner: (
            st.lists(inner, max_size=4) | st.dictionaries(st.sampled_from(KINDS), inner, max_size=2)
        ),
        max_leaves=12,
    )
)
def test_whatever_a_hand_in_sends_is_data_or_refused(reply):
    ours, theirs = Pipe()
    with ours, theirs:
        theirs.send_bytes(json.dumps({"value": reply}).encode())
        line = _wire.Line(ours, {})
        with contextlib.suppress(_wire.Hint):
            line.value("it")


def test_a_judge_runs_nothing_that_is_sent(tmp_path):
    class Bomb:
        def __reduce__(self):
            return open, (str(tmp_path / "reached"), "w")

    ours, theirs = Pipe()
    with ours, theirs:
        packed = base64.b64encode(pickle.dumps(Bomb())).decode()
        theirs.send_bytes(json.dumps({"value": {"pickled": packed}}).encode())
        with pytest.raises(_wire.Hint, match="`it` can't be judged"):
            _wire.Line(ours, {}).value("it")
    assert not any(tmp_path.iterdir())
