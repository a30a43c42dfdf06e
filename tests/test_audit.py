"""The audit: every row is there, and its verdict changes when what it is about changes."""

import json
import math
import re
from types import MappingProxyType

import numpy as np
import pytest
import sympy as sp

import wmrlib as wmr
from wmrbook import audit
from wmrbook import figures as pictures
from wmrbook.audit import Place, Verdict, figures, numbers, statements
from wmrbook.audit.proof import rising
from wmrlib import paper, symbolic

ROWS = {row.item: row for row in audit.rows()}
WRONG = {"eq-23", "eq-26", "fig-12", "bearing", "y_error_at_start", "time_step", "inner_loop"}
WRONG |= {"claim-stable", "claim-omega", "claim-smooth", "claim-pose"}
TYPOS = {"eq-10", "eq-24", "eq-25", "fig-4", "fig-5", "claim-limit"}
OPEN = {"fig-6", "fig-7", "lqr_x_advantage", "lqr_y_advantage", "claim-cornejo"}


def test_everything_has_a_row():
    equations, figures = [f"eq-{n}" for n in range(1, 27)], [f"fig-{n}" for n in range(1, 13)]
    assert list(ROWS)[:-6] == [*equations, *figures, *paper.PUBLISHED]
    assert all(item.startswith("claim-") for item in list(ROWS)[-6:])
    assert sum(len(audit.rows(group)) for group in audit.GROUPS[1:]) + 26 == len(ROWS)
    with pytest.raises(ValueError, match=r"group = 'tables' is not allowed"):
        audit.rows("tables")


@pytest.mark.parametrize(
    ("verdict", "items"), [(Verdict.WRONG, WRONG), (Verdict.TYPO, TYPOS), (Verdict.OPEN, OPEN)]
)
def test_the_verdicts_are_those_found_by_hand(verdict, items):
    assert {item for item, row in ROWS.items() if row.verdict is verdict} == items


def test_every_row_says_what_it_found_and_why():
    for row in ROWS.values():
        assert row.says
        assert row.why
        assert row.holds.endswith(".")


# Equations ------------------------------------------------------------------------------------------------------------


def with_equation(monkeypatch, number, right):
    """The rows of the equations when one of them is printed with another right side."""
    equation = symbolic.EQUATIONS[number]
    changed = symbolic.omega > right if number == 23 else sp.Eq(equation.lhs, right, evaluate=False)
    monkeypatch.setattr(
        symbolic, "EQUATIONS", MappingProxyType(symbolic.EQUATIONS | {number: changed})
    )
    return {row.item: row for row in audit.rows("equations")}


@pytest.mark.parametrize("number", range(1, 27))
def test_a_flipped_sign_is_noticed(monkeypatch, number):
    right = symbolic.EQUATIONS[number].gts if number == 23 else symbolic.EQUATIONS[number].rhs
    right = symbolic.EQUATIONS[23].lts if number == 23 else right
    verdict = with_equation(monkeypatch, number, -right)[f"eq-{number}"].verdict
    assert verdict in (Verdict.TYPO, Verdict.WRONG)


@pytest.mark.parametrize(
    ("number", "old", "new", "verdict"),
    [
        (8, symbolic.v, -symbolic.v, Verdict.TYPO),  # (10) and (20) ... need the right one
        (1, symbolic.V_l, -symbolic.V_l, Verdict.WRONG),
        (13, symbolic.lat1, 2 * symbolic.lat1, Verdict.TYPO),
        (17, symbolic.lat1, -symbolic.lat1, Verdict.TYPO),
        (18, symbolic.h, -symbolic.h, Verdict.WRONG),
        (22, symbolic.k_rho, -symbolic.k_rho, Verdict.WRONG),
    ],
)
def test_a_sign_within_an_equation_is_noticed(monkeypatch, number, old, new, verdict):
    row = with_equation(monkeypatch, number, symbolic.EQUATIONS[number].rhs.subs(old, new))[
        f"eq-{number}"
    ]
    assert row.verdict is verdict


def test_mended_equations_hold(monkeypatch):
    printed = symbolic.EQUATIONS[10].rhs
    assert (
        with_equation(monkeypatch, 10, sp.Matrix([printed[0], printed[1], -printed[2]]))[
            "eq-10"
        ].verdict
        is Verdict.HOLDS
    )
    assert with_equation(monkeypatch, 24, audit.steering())["eq-24"].verdict is Verdict.HOLDS
    assert (
        with_equation(monkeypatch, 25, audit.slope(audit.steering()))["eq-25"].verdict
        is Verdict.HOLDS
    )
    assert (
        with_equation(monkeypatch, 26, audit.slope(audit.steering()))["eq-26"].verdict
        is Verdict.HOLDS
    )


def test_the_derived_law_is_the_librarys():
    assert audit.same(audit.steering(), symbolic.textbook(symbolic.law("corrected")[1]))
    assert audit.same(
        audit.slope(audit.steering()), symbolic.textbook(symbolic.lyapunov_rate("corrected"))
    )
    for law, turning in (("corrected", audit.steering()), ("printed", symbolic.EQUATIONS[24].rhs)):
        run = wmr.track(
            paper.circle,
            paper.CIRCLE_START,
            paper.CIRCLE_GAINS,
            law=law,
            method="euler",
            duration=40.0,
        )
        assert audit.circle_residual(turning) == pytest.approx(run.rho[-100:].mean(), rel=1e-6)
    assert rising(audit.slope(audit.steering())) is None
    rho, alpha, theta, slope = rising(audit.slope(symbolic.EQUATIONS[24].rhs))
    assert slope == pytest.approx(
        wmr.lyapunov_rate(rho, alpha, theta, paper.OUTDOOR_GAINS, law="printed")
    )


def test_same_proves_or_refuses():
    x = symbolic.alpha
    assert audit.same(sp.sin(2 * x), 2 * sp.sin(x) * sp.cos(x))
    assert not audit.same(sp.sin(x), x)
    with pytest.raises(ArithmeticError, match="can't prove"):
        audit.same(x + sp.Float("1e-13") * sp.exp(x), x)


# Numbers and statements -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("value", "printed", "agrees"),
    [
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
    ],
)
def test_a_number_fits_by_rounding_or_by_a_small_cut(value, printed, agrees):
    assert audit.fits(value, paper.Published(printed, "", "here")) is agrees


@pytest.mark.parametrize(
    "key", [key for key in paper.PUBLISHED if key not in OPEN and key not in WRONG]
)
def test_another_number_is_noticed(monkeypatch, key):
    printed = paper.PUBLISHED[key]
    monkeypatch.setitem(
        paper.PUBLISHED, key, printed._replace(value=3.0 * printed.value + (printed.value == 0.0))
    )
    if key.endswith(("_latitude", "_longitude")):
        monkeypatch.setitem(paper.PUBLISHED, key, printed._replace(value=printed.value + 0.01))
    assert {row.item: row.verdict for row in audit.rows("numbers")}[key] is Verdict.WRONG


@pytest.mark.parametrize(
    ("key", "value"),
    [("bearing", 9.58), ("y_error_at_start", 9.67), ("time_step", 0.05), ("inner_loop", 20.0)],
)
def test_the_right_number_holds(monkeypatch, key, value):
    monkeypatch.setitem(paper.PUBLISHED, key, paper.PUBLISHED[key]._replace(value=value))
    assert {row.item: row.verdict for row in audit.rows("numbers")}[key] is Verdict.HOLDS


def test_the_bounds_of_the_sphere_are_those_of_short_geodesics():
    geodesic = pytest.importorskip("geographiclib.geodesic").Geodesic.WGS84
    errors = []
    for lat in (0.0, 89.9):
        for azimuth in (0.0, 90.0):
            end = geodesic.Direct(lat, 10.0, azimuth, 100.0)
            points = wmr.GeoPoint(lat=lat, lon=10.0), wmr.GeoPoint(lat=end["lat2"], lon=end["lon2"])
            errors.append(wmr.haversine_distance(*points) - 100.0)
    assert (min(errors), max(errors)) == pytest.approx(numbers.sphere_bounds(), abs=2e-3)


def test_the_slowest_pole_goes_to_that_without_a_lag():
    assert numbers.slowest_pole(1e6) == pytest.approx(
        -wmr.modes(paper.OUTDOOR_GAINS).heading_rate, abs=1e-3
    )
    assert numbers.slowest_pole(10.0) > 0 > numbers.slowest_pole(20.0)


def test_growth_at_the_goal():
    gains = paper.OUTDOOR_GAINS
    assert statements.growth("printed") == pytest.approx(
        gains.v_max * gains.k_rho - gains.k_alpha, rel=1e-4
    )
    assert statements.growth("corrected") == pytest.approx(-wmr.modes(gains).heading_rate, rel=1e-4)


def test_a_caption_of_its_own_is_no_typo(monkeypatch):
    for number in (4, 6):
        monkeypatch.setitem(figures.CAPTIONS, number, f"Figure {number}.")
    rows = {row.item: row.verdict for row in audit.rows("figures")}
    assert rows["fig-4"] is Verdict.HOLDS
    assert rows["fig-6"] is Verdict.OPEN


# What was never published ---------------------------------------------------------------------------------------------


def test_what_depends_on_a_choice_cannot_be_reproduced():
    assert audit.depends([True, True]) is Verdict.HOLDS
    assert audit.depends([False, False]) is Verdict.WRONG
    assert audit.depends([True, False]) is audit.depends([False, True, True]) is Verdict.OPEN


def test_the_rival_is_nearer_or_farther_by_the_choice_of_its_gains():
    """The residual of v = k_rho rho cos(alpha) is speed/k_rho where alpha is small; an LQR with feed-forward has none."""
    text, nearer = figures.comparison()
    assert nearer == [True, False, False]
    for k_rho in (paper.CIRCLE_GAINS.k_rho, paper.CIRCLE_GAINS.k_rho * paper.CIRCLE_GAINS.v_max):
        run = wmr.track(
            paper.circle,
            paper.CIRCLE_START,
            paper.CIRCLE_GAINS._replace(k_rho=k_rho),
            law="aicardi",
            duration=40.0,
        )
        assert f"{wmr.residual(run):.3f} m" in text
        assert wmr.residual(run) == pytest.approx(paper.CIRCLE_SPEED / k_rho, rel=0.02)


@pytest.mark.parametrize(
    ("law", "verdict", "caption"),
    [("aicardi", Verdict.HOLDS, Verdict.TYPO), ("linear", Verdict.WRONG, Verdict.WRONG)],
)
def test_a_published_rival_decides(monkeypatch, law, verdict, caption):
    """With one rival only, Aicardi's law with the paper's k_rho or an LQR, figures and comparison come out one way."""
    chase, ours = figures.chase, ("corrected",)
    monkeypatch.setattr(
        figures, "chase", lambda *which: chase(*which) if which in (ours, ()) else chase(law)
    )
    rows = {row.item: row for group in ("figures", "statements") for row in audit.rows(group)}
    assert [rows[item].verdict for item in ("fig-6", "fig-7", "claim-cornejo")] == [
        caption,
        caption,
        verdict,
    ]
    assert "not published" not in rows["claim-cornejo"].why + rows["fig-6"].why


@pytest.mark.parametrize("key", ["lqr_x_advantage", "lqr_y_advantage"])
def test_an_advantage_beyond_every_weight_is_wrong(monkeypatch, key):
    for value, verdict in ((90.0, Verdict.WRONG), (-50.0, Verdict.WRONG), (5.0, Verdict.OPEN)):
        monkeypatch.setitem(paper.PUBLISHED, key, paper.PUBLISHED[key]._replace(value=value))
        assert {row.item: row.verdict for row in audit.rows("numbers")}[key] is verdict


def test_the_advantages_are_those_of_an_lqr_by_python_control():
    control = pytest.importorskip("control")
    turn, speed = paper.CIRCLE_SPEED / paper.CIRCLE_RADIUS, paper.CIRCLE_SPEED
    A, B = [[0, turn, 0], [-turn, 0, speed], [0, 0, 0]], [[-1, 0], [0, 0], [0, -1]]
    polar = wmr.track(
        paper.circle, paper.CIRCLE_START, paper.CIRCLE_GAINS, law="aicardi", duration=40.0
    )
    for weight in (0.1, 1.0, 10.0):
        gains = wmr.LinearGains(-control.lqr(A, B, weight * np.eye(3), np.eye(2))[0])
        run = wmr.track(paper.circle, paper.CIRCLE_START, gains, law="linear", duration=40.0)
        for name in "xy":
            sizes = [
                math.sqrt(np.mean(getattr(each, f"{name}_error") ** 2)) for each in (run, polar)
            ]
            assert (
                f"{100 * (1 - sizes[0] / sizes[1]):.1f} % with q = {weight:g}"
                in ROWS[f"lqr_{name}_advantage"].holds
            )


# The table ------------------------------------------------------------------------------------------------------------


def notebook(path, *cells):
    path.write_text(json.dumps({"cells": list(cells)}), encoding="utf-8")


def code(*tags):
    return {
        "cell_type": "code",
        "source": "",
        "metadata": {"tags": list(tags)},
        "execution_count": None,
    }


def prose(text):
    return {"cell_type": "markdown", "source": text.splitlines(keepends=True), "metadata": {}}


@pytest.fixture
def folder(tmp_path):
    tagged = code("audit:eq-24", "audit:eq-25")
    notebook(
        tmp_path / "04_lyapunov.ipynb",
        prose("# Four"),
        code(),
        prose("text\n## The | law\nmore"),
        tagged,
        code("audit:eq-24"),
    )
    notebook(
        tmp_path / "06_the_circle.ipynb",
        prose("# Six"),
        code("audit:eq-24", "hide-cell"),
        prose("no heading"),
    )
    notebook(tmp_path / "notes.ipynb", code("audit:eq-1"))
    return tmp_path


def test_places_finds_the_tagged_cells_and_the_headings_above(folder):
    four = Place("04_lyapunov.ipynb", 4, "The | law", 2)
    assert audit.places(folder) == {
        "eq-24": [four, four._replace(cell=3), Place("06_the_circle.ipynb", 6, "Six", 1)],
        "eq-25": [four],
    }
    with pytest.raises(ValueError, match=r"is not allowed: one with notebooks"):
        audit.places(folder / "nowhere")


def test_missing_lists_what_no_cell_shows(folder):
    three = [ROWS[item] for item in ("eq-24", "eq-25", "eq-26")]
    assert audit.missing(three, audit.places(folder)) == ["eq-26"]
    assert audit.missing(three[:2], audit.places(folder)) == []


def test_the_table_is_well_formed_markdown(folder):
    table = audit.table(list(ROWS.values()), audit.places(folder))
    bundle = table._repr_mimebundle_()
    lines = bundle["text/markdown"].splitlines()
    assert len(lines) == len(ROWS) + 2
    for line in lines:
        assert len(re.findall(r"(?<!\\)\|", line)) == 6
        math_parts = line.split("$")
        assert len(math_parts) % 2 == 1
        for formula in math_parts[1::2]:
            assert "|" not in formula
            assert formula.count("{") == formula.count("}")
            assert formula.count(r"\left") == formula.count(r"\right")
            assert formula.count(r"\begin") == formula.count(r"\end")
    assert (
        r"[4, The \| law](04_lyapunov.ipynb), cell 2, 3; [6, Six](06_the_circle.ipynb), cell 1"
        in lines[25]
    )
    assert "no cell" in lines[3]
    assert bundle["text/plain"].splitlines()[9].startswith("(10)  ") is True
    assert "✎ typo" in bundle["text/plain"].splitlines()[9]
    assert audit.tally(list(ROWS.values())) == {
        Verdict.HOLDS: 52,
        Verdict.TYPO: 6,
        Verdict.WRONG: 11,
        Verdict.OPEN: 5,
    }


def test_the_picture_of_the_verdicts():
    picture = pictures.verdicts(
        {"equations": {"holds": 21, "typo": 3}, "figures": {"holds": 7, "typo": 0}}
    )
    assert (
        picture.alt
        == "Bars of how many rows have each verdict. equations: 21 holds, 3 typo; figures: 7 holds."
    )
    axes = picture.figure.axes[0]
    assert [bar.get_width() for bar in axes.patches] == [21, 7, 3, 0]
    assert len({bar.get_hatch() for bar in axes.patches}) == 2
    assert len(picture.png()) > 2000
    assert "[" in axes.get_xlabel()
    with pytest.raises(ValueError, match=r"counts has 0 verdicts"):
        pictures.verdicts({})
