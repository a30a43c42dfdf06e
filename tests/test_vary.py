"""The book's headlines survive what was not meant to be fixed; those that fell, fall."""

import inspect
import math
import re

import pytest
import vary

from wmrbook.headlines import HEADLINES, drawn

IDS = [f"{row.where}-{row.value.__name__}" for row in HEADLINES]
FALLEN = [row for row in HEADLINES if row.before]


@pytest.mark.slow
@pytest.mark.parametrize("number", range(len(HEADLINES)), ids=IDS)
def test_a_headline_survives(number):
    row = HEADLINES[number]
    assert vary.spread(number, draws=8, seed=0)[2] == ""
    assert math.isfinite(row.at_least) or math.isfinite(row.at_most)


@pytest.mark.parametrize("row", HEADLINES, ids=IDS)
def test_its_sentence_stands_where_the_row_says(row):
    assert vary.plain(row.says) in vary.text(row.where)
    assert set(inspect.signature(row.value).parameters) >= set(row.vary)
    assert re.search(rf"\d|{vary.STRONG}", row.says), "no number, no strong word"


@pytest.mark.parametrize("row", FALLEN, ids=lambda row: row.value.__name__)
def test_a_sentence_that_fell_falls_and_is_gone(row):
    old = row.before
    assert vary.plain(old.says) not in vary.text(row.where)
    values = (value for _, value in drawn(row.value, old.vary, 60))
    assert any(not old.at_least <= value <= old.at_most for value in values)
