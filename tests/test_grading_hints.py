"""What every check stands on: how answers are asked for, and whether one calls the libraries."""

import decimal
import functools
import math
import re
import subprocess
import sys
from pathlib import Path

import graded
import nbformat
import numba
import numpy as np
import pytest
import sympy as sp
from known import untold
from nbclient import NotebookClient

import wmrbook.audit
import wmrlib as wmr
from wmrbook.grading import (
    Hint,
    _asking,
    _hints,
    earth,
    exercises,
    lyapunov,
    routes,
    variants,
    verdicts,
)
from wmrbook.published import Published
from wmrlib import control_law

ALLOWED = ("Pose", "polar_error")
CHAPTERS = "".join(it.read_text(encoding="utf-8") for it in graded.ROOT.glob("notebooks/*.ipynb"))


def test_what_calls_input_is_not_said_to_be_unwritten():
    class StdinNotImplementedError(NotImplementedError):  # as a notebook without a user raises
        pass

    def asks():
        raise StdinNotImplementedError("raw_input was called")

    with pytest.raises(Hint, match=r"`asks.*` stops with StdinNotImplementedError: raw_input"):
        _asking.ask(asks)


ENDINGS = {
    "return exit()": "stops in line 2 of its cell with SystemExit.",
    "quit(True)": "stops in line 2 of its cell with SystemExit.",
    "return float(input('x? ')), 0": "line 2 of its cell with EOFError: nobody answers `input()`",
    "raise type('Odd', (Exception,), {'__str__': None})": "stops in line 2 of its cell with Odd.",
    "return type('Odd', (), {'__len__': lambda _: 1 / 0})()": "check stops with ZeroDivisionError",
    "print('x' * 10**6); return a": "xxx...\nHint: the centre is not as far",
}


def test_what_ends_a_notebook_does_not_end_a_check():
    """In a kernel, which `exit()` asks to stop, and which may ask a reader."""
    cell = "def centre(a, b, c):\n    {}\n\n\nprint(exercises.three_readings(centre))"
    sources = ["from wmrbook.grading import exercises", *map(cell.format, ENDINGS)]
    sources.append("assert not get_ipython().exit_now\ninput()")
    book = nbformat.v4.new_notebook(cells=[*map(nbformat.v4.new_code_cell, sources)])
    client = NotebookClient(book, timeout=120, allow_errors=True)
    client.execute()
    *told, after = (cell.outputs for cell in book.cells[1:])
    for wanted, outputs in zip(ENDINGS.values(), told, strict=True):
        text = "".join(each.text for each in outputs)
        assert wanted in text
        assert len(text) < 2500
    assert after[0].ename == "StdinNotImplementedError"  # a reader is asked again


CELL = """
import wmrlib, wmrlib as wmr, wmrlib.kinematics
from wmrlib import control_law as polar_error_of_mine, polar_error, polar_error as seen_from
GAINS = wmr.Gains(1.0, 2.0, 3.0)
START, GOAL = wmr.Pose(0.0, 0.0, 0.0), wmr.Pose(1.0, 0.0, 0.0)
def control(x):
    return x
def helper():
    return wmr.polar_error(wmr.Pose(*START), GOAL)
def it({}): {}
"""


def of(given: str, body: str):
    """A student's function."""
    names = {"__name__": __name__}
    graded.run_cell(CELL.format(given, body), f"<{body}>", names)
    return names["it"]


SEES = [
    *("return polar_error(START, GOAL)", "return wmr.polar_error(wmr.Pose(*START), GOAL)"),
    *("return wmrlib.kinematics.polar_error(START, GOAL)", "return seen_from(START, GOAL)"),
    "import wmrlib.kinematics as k; return (lambda: k.polar_error(wmr.Pose(*START), GOAL))()",
    *("from wmrlib import Pose; return polar_error(Pose(*START), GOAL)", "return helper()"),
]
LAWS = [
    *("return wmr.control_law(*polar, GAINS)", "return polar_error_of_mine(*polar, GAINS)"),
    "import wmrlib.control as c; return c.control_law(*polar, GAINS)",
    "from wmrlib.control import control_law as mine; return (lambda: mine(*polar, GAINS))()",
]


def rule_of_the_book(computed, printed):
    return wmrbook.audit.fits(computed, Published(float(printed), "", ""))


def test_a_call_of_the_libraries_is_found_in_any_way():
    own = "this task asks for your own formula, with `math` or `numpy`"
    allowed, laws = [of("*_", each) for each in SEES], [of("*polar", each) for each in LAWS]
    for function in allowed:
        assert function() == (1.0, 0.0, 0.0)
        _hints.own_work(function, *ALLOWED)
    for function in laws:
        assert function(1.0, 0.5, 0.2) == control_law(1.0, 0.5, 0.2, wmr.Gains(1.0, 2.0, 3.0))
        hint = "uses `control_law` of wmrlib; of it only `Pose`, `polar_error` may be used here"
        with pytest.raises(Hint, match=hint):
            _hints.own_work(function, *ALLOWED)
    law, ways = laws[0], (functools.cache, functools.partial, np.vectorize, numba.njit)
    hidden = [lambda *each: law(*each), functools.wraps(law)(lambda *each: law(*each))]
    hidden += [*(way(law) for way in ways), functools.cache(control_law), control_law]
    for function in [*allowed, *laws, *hidden]:
        with pytest.raises(Hint, match=f"of wmrlib; {own}"):
            _hints.own_work(function)
    with pytest.raises(Hint, match=f"`fits` of wmrbook; {own}"):
        _hints.own_work(rule_of_the_book)


def test_data_and_names_of_ones_own_are_no_call():
    data = of("x", "return GAINS.k_rho * x + START.x")
    assert data(2.0) == 2.0
    containers = "return wmr.Gains(x, 1, 1)[:3] + wmr.Pose(x, *wmr.GeoPoint(lat=1, lon=2))"
    containers = functools.cache(of("x", containers))
    unknown = of("x", "import wmrlib.nowhere as nowhere; return nowhere.law(x)")
    free = [data, containers, functools.partial(containers), np.vectorize(of("x", "return x"))]
    free += [of("polar_error", "return polar_error(1.0)"), unknown]
    free += [eval("lambda x: wmr.wrap_angle(x)")]  # without a source
    for allowed in ((), ALLOWED):
        for function in free:
            _hints.own_work(function, *allowed)
    mixed = of("x", "return wmr.polar_error(START, START).rho + control(x)")
    _hints.own_work(mixed, *ALLOWED)  # wmrlib has a module of that name too
    _hints.own_work(lambda x: x + 1.0)  # the call around it is not the student's
    with pytest.raises(Hint, match="`wrap_angle` of wmrlib"):
        _hints.own_work(lambda x: wmr.wrap_angle(x))
    with pytest.raises(Hint, match=r"stops.* with ModuleNotFoundError"):
        _asking.ask(unknown, 1.0)


@pytest.mark.parametrize("roundings", range(-2, 3))
def test_an_acos_is_caught_however_its_cosine_was_rounded(roundings):
    """By whatever a processor's dot product is off; above 1.5 m the answer is right to 0.3 %."""

    def distance(*pair):
        lat_a, lon_a, lat_b, lon_b = map(math.radians, pair)
        half = math.sin((lat_b - lat_a) / 2) ** 2
        half += math.cos(lat_a) * math.cos(lat_b) * math.sin((lon_b - lon_a) / 2) ** 2
        exact = 2 * wmr.EARTH_RADIUS_M * math.asin(math.sqrt(half))
        cosine = round((1 - 2 * half) * 2**53 + roundings) / 2**53
        lost = wmr.EARTH_RADIUS_M * math.acos(max(-1.0, min(1.0, cosine)))
        return lost if 1.5 < exact < 100 else exact

    assert "58.08 m" in earth.distance_known(distance)  # this check does not hang on it
    with pytest.raises(Hint, match="which function loses its digits"):
        earth.distance_close(distance)


def test_the_bowl_falls_along_wmrlib_s_robot():
    """A second method: the robot's own rates, and differences of V."""
    for rho, alpha, theta in np.random.default_rng(7).uniform([0.1, -3, -3], 3, (20, 3)):
        v, h, k_alpha, angles = math.cos(alpha), 2, 1.5, (rho, alpha, theta)
        symbols = (lyapunov.rho, lyapunov.alpha, lyapunov.theta)
        bowl = sp.lambdify(symbols, lyapunov.BOWL.subs({lyapunov.L: 1, lyapunov.h: h}))
        omega = k_alpha * math.sin(alpha) + v / rho * (math.sin(alpha) + h * math.sin(theta))
        step = 1e-6 * np.array(wmr.polar_rate(rho, alpha, v, omega))
        slope = (bowl(*(angles + step)) - bowl(*(angles - step))) / 2e-6
        assert slope == pytest.approx(-rho * v**2 - k_alpha * math.sin(alpha) ** 2, abs=1e-6)


def test_the_sentences_are_those_of_the_log():
    log = Path(__file__).parents[1] / "notebooks/data/ublox5-standing.nmea"
    text = log.read_text(encoding="utf-8", errors="replace")
    assert all(f"${body}*" in text for body in routes.BODIES)


def test_the_rule_is_the_audit_s():
    """But for printed zeros, which the audit's float does not know."""
    for computed, printed in verdicts._printed(300):
        if not printed.endswith("0"):
            rounds, cuts, near = verdicts._verdict(decimal.Decimal(repr(computed)), printed)
            assert (rounds or (cuts and near)) == rule_of_the_book(computed, printed)


def test_counterexamples_are_those_of_the_paper_s_equations():
    """Written out by hand: the check takes a state if and only if it refutes the claim."""
    random, found = np.random.default_rng(1), []
    anywhere = variants.Window("ada", -math.pi, math.pi)
    for rho, alpha, theta, omega in random.uniform((0.01, -1, -3, -2), (1, 1.5, 3, 4), (60, 4)):
        v = 4 * (1 - np.exp(-2 * rho)) * np.cos(alpha)
        part = -alpha * omega + v * np.sin(alpha) / rho * (0.3 * theta + alpha)
        obeyed = omega > (alpha + 0.3 * theta) * np.cos(alpha) * np.sin(alpha)
        refutes = obeyed and part > 1e-3
        try:
            verdicts._refuted_23((rho, alpha, theta, omega), anywhere)
            found.append("accepted")
            assert refutes
            assert alpha > 0
        except Hint as hint:
            side = bool(re.search("chapter 10's side", str(hint)))
            found.append("side" if side else "claim holds")
            assert side == bool(refutes)
            assert not (refutes and alpha > 0)
    assert min(map(found.count, ("accepted", "side", "claim holds"))) > 5


@pytest.mark.parametrize("name", graded.exercises())
def test_a_chapters_exercise_takes_its_answer_and_says_what_is_wrong_with_others(name, monkeypatch):
    assert graded.mistold(name) == []
    right = graded.right(name)
    for k, answer in enumerate(right):
        check = getattr(exercises, name)
        tells = [lambda it, k=k, check=check: check(*right[:k], it, *right[k + 1 :])]
        assert untold(monkeypatch, tells, answer)[1] == set()
    assert f"grading.exercises.{name}(" in CHAPTERS


ENDLESS = """
import sympy as sp
from wmrlib.symbolic import L, alpha, k_alpha, k_rho, rho
from wmrbook.grading import Hint, exercises, lyapunov

shared, long = alpha, alpha
for _ in range(60):
    shared = sp.Add(shared, sp.sin(shared), evaluate=False)
for _ in range(2000):
    long = sp.sin(long, evaluate=False)
found = [
    *(shared, long, (1 + rho) ** 10**9, (rho + alpha + L + k_rho + k_alpha) ** 300, rho**10**8),
    *(sp.Sum(1 / (alpha**2 + rho), (rho, 1, sp.oo)), sp.factorial(rho * 10**9)),
    *(sp.sin(sp.exp(sp.exp(20 * rho))), sp.Integral(sp.exp(sp.sin(rho**rho)), (rho, 0, alpha))),
]
for each in found:
    assert exercises.aicardi(each).startswith("Hint: ")
    for check in (lyapunov.rate, lyapunov.steering, lyapunov.steering_usable, lyapunov.closed):
        try:
            check(each)
        except Hint:
            continue
        raise AssertionError(each)
"""


def test_an_expression_that_sympy_never_finishes_gets_a_hint():
    subprocess.run([sys.executable, "-c", ENDLESS], check=True, timeout=120)
