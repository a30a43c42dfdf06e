"""Tables of results: everything given is to be read, aligned, and said to a screen reader too."""

import re
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wmrbook.tables import table

DASH = "\N{EN DASH}"
words = st.text("abc <&\"'[]", min_size=1, max_size=9).map(str.strip).filter(bool)
columns = (
    st.integers(1, 5)
    .flatmap(
        lambda rows: st.fixed_dictionaries(
            {"gains": st.lists(words, min_size=rows, max_size=rows)},
            optional={
                "error [m]": st.lists(st.floats(-1e4, 1e4), min_size=rows, max_size=rows),
                "arrived": st.lists(words, min_size=rows, max_size=rows),
            },
        )
    )
    .map(lambda of: {name: of[name] for name in sorted(of, key="gains".__ne__)})
)


@given(columns)
def test_every_value_is_to_be_read_in_its_row_and_column(given_columns):
    shown = table(given_columns, {"error [m]": ".2f"} if "error [m]" in given_columns else {})
    tree = ElementTree.fromstring(shown._repr_html_())
    head = [cell.text for cell in tree.findall("thead/tr/*")]
    assert head == list(given_columns)
    for k, row in enumerate(tree.findall("tbody/tr")):
        assert next(cell.get("scope") for cell in row) == "row"
        for name, cell in zip(head, row, strict=True):
            value = given_columns[name][k]
            if isinstance(value, float):
                assert float(cell.text.replace("\N{MINUS SIGN}", "-")) == pytest.approx(
                    value, abs=0.0051
                )
                assert cell.get("style") == "text-align: right"
            else:
                assert cell.text == value
    lines = repr(shown).splitlines()
    assert len(lines) == 1 + len(given_columns["gains"])


def test_decimals_stand_below_one_another():
    lines = repr(table({"run": ["a", "bb"], "time [s]": [9.25, 110.5]}, ".2f")).splitlines()
    assert [line.rindex(".") for line in lines[1:]] == [10, 10]
    shown = table({"of": ["all"], "n": [12], "left [%]": [np.float64(2.0)], "ok": [True]})
    assert repr(shown).splitlines()[1].split() == ["all", "12", "2", "yes"]


def test_the_largest_number_of_a_column_has_three_digits_and_whole_numbers_no_decimals():
    columns = {
        "k_rho": [0.25, 2.0],
        "t": [15.53, 9.0],
        "x": [0.1264, 0.01],
        "n": [1000, -2.0],
        "d": [0.4, "no"],
    }
    assert repr(table(columns)).splitlines()[1].split()[-1] == "0.4"
    assert repr(table(columns)).splitlines()[2].split() == ["2", "9.0", "0.010", "-2", "no"]


def test_no_number_infinity_and_a_rounded_zero():
    shown = table({"k": list("abcd"), "v": [np.nan, -np.inf, -0.001, None]}, ".2f")
    assert [line.split()[1] for line in repr(shown).splitlines()[1:]] == [DASH, "-∞", "0.00", DASH]


def test_a_formula_is_typeset_and_the_corner_heads_nothing():
    text = table({"": ["$k_\\rho$ & h"], "x < y": [1]}, caption="Of $h$")._repr_html_()
    assert '<span class="math notranslate nohighlight">\\(k_\\rho\\)</span> &amp; h' in text
    assert "<caption>Of <span" in text
    assert "x &lt; y" in text
    symbols = table({"k_rho [1/m]": [1]}, caption="By alpha, 3 deg off")._repr_html_()
    assert "\\(k_{\\rho}\\)</span> [1/m]" in symbols
    assert "By \N{GREEK SMALL LETTER ALPHA}, 3° off" in symbols
    assert "<thead><tr><td></td><th " in text
    assert re.findall('scope="(.*?)"', text) == ["col", "row"]


@pytest.mark.parametrize(
    ("given_columns", "formats", "says"),
    [
        ({}, ".1f", r"columns = \{\} is not allowed: a table has at least one column"),
        ({"a": [1, 2], "b": [1]}, ".1f", r"columns\['b'\] has 1 values: 2 are needed"),
        ({"a": [1]}, {"c": ".1f"}, r"formats\['c'\] is not allowed: columns has a"),
        ({"a": [1.5]}, ".1q", r"formats\['a'\] = '\.1q' is not allowed: a format"),
    ],
)
def test_bad_input_is_named(given_columns, formats, says):
    with pytest.raises(ValueError, match=says):
        table(given_columns, formats)


def test_a_list_is_no_mapping():
    with pytest.raises(ValueError, match="a Mapping is needed"):
        table([1, 2])
