"""The audit: every row is there, and its verdict changes when what it is about changes."""

import math
from functools import cache
from pathlib import Path

import nbformat
import numpy as np
import pytest
import sympy as sp
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

import wmrlib as wmr
from wmrbook import audit
from wmrbook import equations as paper_symbols
from wmrbook.audit import Place, Verdict, claims, equations, proof, row
from wmrbook.audit.published import PUBLISHED, Published
from wmrlib import paper, symbolic

FOUND = {
    Verdict.WRONG: {*("eq-23", "eq-26", "bearing", "y_error_at_start", "claim-tracking")},
    Verdict.TYPO: {
        *("eq-10", "eq-18", "eq-24", "eq-25", "first-part", "second-part", "rho-i", "k-A"),
        *("claim-captions", "claim-reference", "claim-stable", "claim-limit"),
    },
    Verdict.OPEN: {
        *("sphere_error", "circle_residual", "time_step", "inner_loop"),
        *("claim-cornejo", "claim-omega", "claim-pose"),
    },
}
PARTS = {  # who makes the rows of which equations
    range(1, 7): equations.robot_rows,
    range(7, 11): equations.polar_rows,
    range(11, 18): equations.earth_rows,
    range(18, 24): proof.energy_rows,
    range(24, 27): proof.law_rows,
}
CASE = paper.outdoor("east")
INPUTS = {  # of the paper's runs, and numbers of another work
    *(f"{kind}_{name}" for kind in ("circle", "outdoor") for name in ("k_rho", "k_alpha", "h")),
    *(f"{end}_{name}" for end in ("start", "goal") for name in ("latitude", "longitude")),
    *(f"circle_{name}" for name in ("period", "radius", "x_error", "y_error", "start_heading")),
    *("start_heading", "goal_heading", "speed_limit", "lqr_x_advantage", "lqr_y_advantage"),
}


STATEMENTS = (
    *("captions", "reference", "stable", "tracking", "cornejo", "omega", "pose", "limit"),
)
PLACES = {"first-part": 21, "second-part": 22, "rho-i": 23, "k-A": 25}  # after which equation
ITEMS = [f"eq-{n}" for n in range(1, 27)]
for _item, _before in reversed(PLACES.items()):
    ITEMS.insert(_before, _item)
ITEMS += [*(key for key in PUBLISHED if key not in INPUTS), *(f"claim-{k}" for k in STATEMENTS)]


@cache
def all_rows():
    return {row.item: row for row in audit.rows()}


def test_everything_has_a_row_and_the_verdict_found_by_hand():
    assert list(all_rows()) == ITEMS
    assert PUBLISHED.keys() > INPUTS
    for verdict, items in FOUND.items():
        assert {item for item, row in all_rows().items() if row.verdict is verdict} == items
    counts = {Verdict.HOLDS: 24, Verdict.TYPO: 12, Verdict.WRONG: 5, Verdict.OPEN: 7}
    assert audit.tally(list(all_rows().values())) == counts
    with pytest.raises(ValueError, match=r"group = 'tables' is not allowed"):
        audit.rows("tables")


# Each row can come out otherwise ----------------------------------------------------------------


def equation(number, right):
    """Print an equation with another right side, or (23) with another relation."""
    if number != 23:
        right = sp.Eq(row.EQUATIONS[number].lhs, right, evaluate=False)
    return lambda patched: patched.setattr(row, "EQUATIONS", {**row.EQUATIONS, number: right})


def number(key, value):
    """Print another number."""
    changed = PUBLISHED[key]._replace(value=value)
    return lambda patched: patched.setitem(PUBLISHED, key, changed)


def robot(gains):
    """Drive outdoors with other gains."""

    def patch(patched):
        patched.setattr(paper, "outdoor", lambda x_axis: CASE._replace(gains=gains))
        patched.setattr(claims, "outdoor_run", claims.outdoor_run.__wrapped__)

    return patch


def rival(k_rho):
    """Compare with one stand-in only."""
    run = claims.circle_run

    def only(law="corrected", *wheels, **gains):
        return run(law, *wheels, **(gains | {"k_rho": k_rho} if law == "aicardi" else gains))

    return lambda patched: patched.setattr(claims, "circle_run", only)


def right_side(number):
    return row.EQUATIONS[number].rhs


def verdict_with(monkeypatch, item, change):
    """The verdict on a row after a change of what is printed, or of what drives."""
    with monkeypatch.context() as patched:
        change(patched)
        if item in PUBLISHED:
            rows = claims.numbers()
        elif item.startswith("claim-"):
            rows = claims.statements()
        else:
            place = PLACES[item] + 1 if item in PLACES else int(item.removeprefix("eq-"))
            rows = next(make for part, make in PARTS.items() if place in part)()
        return {row.item: row.verdict for row in rows}[item]


def bracket(name, right):
    """Print another bracket above or below (22)."""
    return lambda patched: patched.setattr(paper_symbols, f"{name}_PART", right)


def symbol(number, right):
    """Print an equation with other symbols."""
    other = {**row.PRINTED, number: sp.Eq(row.PRINTED[number].lhs, right)}
    return lambda patched: patched.setattr(row, "PRINTED", other)


_ALPHA, _TURN = symbolic.alpha, symbolic.k_alpha * symbolic.alpha


@cache
def mended():
    """Print what is right, or drive with what is."""
    rate = audit.slope(audit.steering())
    return {
        "eq-10": equation(10, sp.Matrix([*right_side(10)[:2], -right_side(10)[2]])),
        "eq-18": lambda patched: patched.setattr(
            row,
            "PRINTED",
            {**row.PRINTED, 18: sp.Eq(paper_symbols.V, row.PRINTED[18].rhs)},
        ),
        "eq-23": equation(23, _ALPHA * symbolic.omega > _ALPHA * audit.steering() - _TURN * _ALPHA),
        "first-part": bracket("FIRST", right_side(21) - right_side(21).coeff(symbolic.L, 0)),
        "second-part": bracket("SECOND", right_side(21).coeff(symbolic.L, 0)),
        "rho-i": symbol(24, right_side(24)),
        "k-A": symbol(26, right_side(26)),
        "eq-24": equation(24, audit.steering()),
        "eq-25": equation(25, rate),
        "eq-26": equation(26, rate),
        "bearing": number("bearing", 9.58),
        "y_error_at_start": number("y_error_at_start", 9.67),
        "time_step": number("time_step", 0.01),
        "inner_loop": number("inner_loop", 20.0),
        "claim-captions": lambda p: p.setattr(
            claims, "CAPTIONS", {n: f"{n}." for n in range(1, 13)}
        ),
        "claim-reference": equation(6, sp.Matrix([0, 0, right_side(8)])),
        "claim-stable": equation(24, audit.steering()),
        "claim-cornejo": rival(1.9),
        "claim-omega": robot(wmr.Gains(0.25, 4.0, 16.0, 2.0)),
        "claim-pose": robot(wmr.Gains(0.25, 4.0, 16.0, 2.0)),
        "claim-limit": number("speed_limit", 2.12),
    }


@cache
def damaged():
    """Print what is wrong, where the paper is right."""
    changed = {f"eq-{n}": equation(n, -right_side(n)) for n in range(1, 27) if n != 23}
    changed |= {
        key: number(key, 3.0 * PUBLISHED[key].value)
        for key in ITEMS
        if key in PUBLISHED and key not in ("inner_loop", "time_step")
    }
    return changed | {
        "first-part": bracket("FIRST", -paper_symbols.FIRST_PART),
        "second-part": bracket("SECOND", -paper_symbols.SECOND_PART),
        "rho-i": symbol(24, 7 * row.PRINTED[24].rhs),
        "k-A": symbol(26, 7 * row.PRINTED[26].rhs),
        "inner_loop": number("inner_loop", 1.0),
        "claim-reference": equation(8, right_side(8) + 1),
        "claim-stable": equation(24, sp.Integer(7)),
        "claim-tracking": lambda p: p.setattr(paper, "CIRCLE_SPEED", 0.0),  # a goal at rest
        "claim-cornejo": rival(7.6),
        "claim-pose": robot(CASE.gains._replace(h=0.0)),
        "claim-limit": number("speed_limit", 9.0),
    }


@pytest.mark.parametrize("item", ITEMS)
def test_each_row_can_come_out_otherwise(monkeypatch, item):
    before, after = all_rows()[item].verdict, set()
    if item in mended():
        assert verdict_with(monkeypatch, item, mended()[item]) is Verdict.HOLDS
        after.add(Verdict.HOLDS)
    if item in damaged():
        worse = verdict_with(monkeypatch, item, damaged()[item])
        assert worse in (Verdict.TYPO, Verdict.WRONG), item
        after.add(worse)
    assert after - {before}


def test_a_slip_is_a_typo_if_something_printed_needs_the_right_form(monkeypatch):
    for place, old, factor, verdict in (
        (8, symbolic.v, -1, Verdict.TYPO),  # (10) and (20) need the right one
        (1, paper_symbols.V_l, -1, Verdict.WRONG),
        (17, symbolic.lat1, -1, Verdict.TYPO),
        (17, symbolic.lat1, 3 * symbolic.lat2, Verdict.WRONG),  # two slips
    ):
        right = row.EQUATIONS[place].rhs.subs(old, factor * old)
        assert verdict_with(monkeypatch, f"eq-{place}", equation(place, right)) is verdict, place


def test_a_law_that_no_slip_mends_is_wrong_and_stabilises_nothing(monkeypatch):
    for law in (-_TURN, -audit.steering()):
        for item in ("eq-24", "eq-25", "claim-stable"):
            assert verdict_with(monkeypatch, item, equation(24, law)) is Verdict.WRONG, (law, item)
    slipped = audit.steering() - 2 * _TURN  # one sign
    assert verdict_with(monkeypatch, "claim-stable", equation(24, slipped)) is Verdict.TYPO


def test_slips():
    def slip(*pair):
        return audit.one_slip(*(sp.ImmutableMatrix([entry]) for entry in pair))

    a, b, c = sp.symbols("a b c")
    assert slip(a - b, a + b) == "the sign of $- b$"
    assert slip(a * b + a / c, a * b + b / c) == "$a$ for $b$"
    assert slip(a**2 + b, a + b) == "$a$ printed twice"
    assert slip(a + b + c, a + b) == "$c$ too many"
    assert slip(a + b, a + b * c) == "$c$ missing"
    assert slip(a * sp.cos(b), a * sp.sin(b)).endswith("for $\\sin{\\left(b \\right)}$")
    assert slip(-a - b * c, a + b * c) is None
    assert slip(-a + b * a, a + c * b) is None


def test_the_derived_law_is_the_librarys():
    law = audit.steering()
    library = symbolic.law("corrected")[1], symbolic.lyapunov_rate("corrected")
    assert audit.equivalent(law, symbolic.textbook(library[0]))
    assert audit.equivalent(audit.slope(law), symbolic.textbook(library[1]))
    assert proof.rising(audit.slope(law)) is None


def test_equivalence_is_proved_or_refused():
    x = symbolic.alpha
    assert audit.equivalent(sp.sin(2 * x), 2 * sp.sin(x) * sp.cos(x))
    assert not audit.equivalent(sp.sin(x), x)
    with pytest.raises(ArithmeticError, match="can't prove"):
        audit.equivalent(x + sp.Float("1e-13") * sp.exp(x), x)


# Numbers and statements -------------------------------------------------------------------------


def test_a_number_fits_by_rounding_or_by_a_small_cut():
    for value, printed, agrees in (
        (58.0758, 58.07, True),
        (58.0758, 58.08, True),
        (58.0758, 58.06, False),
        (9.5831, 9.4, False),
        (0.0900, 0.1, True),
        (0.193, 0.1, False),
        (57.265, 57.0, True),
        (-57.265, 57.0, False),
        (0.0, 0.0, True),
        (6371.0088, 6371.0, True),
        (math.pi / 2, math.pi / 2, True),
        (1.571, math.pi / 2, False),
    ):
        assert audit.fits(value, Published(printed, "", "here")) is agrees, value
    assert not audit.fits(58.0758, Published(58.07, "", "here"), cut=5e-5)


def test_what_a_threshold_or_a_choice_decides_is_not_decided():
    assert audit.decide(lambda: True) is Verdict.HOLDS
    assert audit.decide(lambda known: known > 5, over=[(1,), (2,)]) is Verdict.WRONG
    assert audit.decide(lambda known: known > 1, over=[(1,), (2,)]) is Verdict.OPEN
    for stop, verdict in ((0.02, Verdict.WRONG), (0.03, Verdict.OPEN), (0.2, Verdict.HOLDS)):
        assert audit.decide(lambda radius, stop=stop: radius < stop, "arrival") is verdict


def test_a_row_quotes_what_the_paper_prints_and_not_what_must_be_meant():
    dot = "\\dot{\\theta}"
    for item, quoted in (("eq-6", f"{dot}\\end"), ("eq-18", "$\\square ="), ("eq-24", "\\rho_{i}")):
        assert quoted in all_rows()[item].says, item
    assert all_rows()["eq-6"].says.count(dot) == 2  # a rate that is itself
    assert "\\square" not in "".join(row.holds + row.why for row in all_rows().values())


def test_a_point_ahead_of_the_axle_swings_sideways():
    d, theta = sp.Symbol("d"), symbolic.theta
    swing = equations.rolling(d) - equations.rolling()
    left = sp.Matrix([-sp.sin(theta), sp.cos(theta), 0])
    assert sp.simplify(swing - d * symbolic.omega * left) == sp.zeros(3, 1)


@pytest.mark.parametrize("names", [(), ("theta",), ("alpha", "theta")])
def test_an_unwrapped_angle_counts_on_and_the_others_do_not(names):
    rho, gains = 2.0, paper.OUTDOOR_GAINS
    turns = {"alpha": np.linspace(1.0, -20.0, 50), "theta": np.linspace(-2.0, 30.0, 50)}
    law = audit.unwrapped("printed", *names)
    for angles in zip(*turns.values(), strict=True):
        seen = [float(wmr.wrap_angle(angle)) for angle in angles]
        kept = [
            angle if name in names else at
            for name, angle, at in zip(turns, angles, seen, strict=True)
        ]
        expected = wmr.control_law(rho, *kept, gains, law="printed")
        assert law(rho, *seen, gains) == pytest.approx(expected, abs=1e-9)
    with pytest.raises(ValueError, match=r"angle = 'rho' is not allowed"):
        audit.unwrapped("printed", "rho")


# The table --------------------------------------------------------------------------------------


def code(*tags):
    return new_code_cell(metadata={"tags": [*tags]})


@pytest.fixture
def folder(tmp_path):
    four, law, six = map(new_markdown_cell, ("# Four", "text\n## The | law\nmore", "# Seven"))
    both, again = code("audit:eq-24", "audit:eq-25"), code("audit:eq-24")
    chapters = {
        "04_lyapunov": [four, code(), law, both, again],
        "07_the_circle": [six, code("audit:eq-24", "hide-cell"), new_markdown_cell("no heading")],
        "notes": [code("audit:eq-1")],
    }
    for name, cells in chapters.items():
        nbformat.write(new_notebook(cells=cells), tmp_path / f"{name}.ipynb")
    return tmp_path


def test_each_row_is_shown_by_a_cell():
    chapters = Path(__file__).parents[1] / "notebooks"
    assert audit.missing([*all_rows().values()], audit.places(chapters)) == []


def test_without_the_chapters_there_are_no_places(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert audit.places() == {}
    rows = [all_rows()["eq-24"]]
    assert "in no chapter of this folder" in audit.Table(rows, audit.places()).markdown()


def test_places_finds_the_tagged_cells_and_the_headings_above(folder):
    where = audit.places(folder)
    four = Place("04_lyapunov.ipynb", 4, "The | law", 2)
    six = Place("07_the_circle.ipynb", 7, "Seven", 1)
    assert where == {"eq-24": [four, four._replace(cell=3), six], "eq-25": [four]}
    three = [all_rows()[item] for item in ("eq-24", "eq-25", "eq-26")]
    assert audit.missing(three, where) == ["eq-26"]
    with pytest.raises(ValueError, match=r"is not allowed: one with notebooks"):
        audit.places(folder / "nowhere")
