"""What the checks stand on: calls of the libraries are found; other sources agree with them."""

import decimal
import functools
import math
import re

import numba
import numpy as np
import pytest
import sympy as sp
from assignments import run_cell
from logs import STANDING

import wmrbook.audit
import wmrlib as wmr
from wmrbook.audit.published import Published
from wmrbook.grading import Hint, _asking, _hints, lyapunov, routes, verdicts
from wmrlib import control_law

ALLOWED = ("Pose", "polar_error")
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
    run_cell(CELL.format(given, body), f"<{body}>", names)
    return names["it"]


SEES = [
    "return wmrlib.kinematics.polar_error(START, GOAL)",
    "return seen_from(START, GOAL)",
    "return helper()",
]
LAWS = [
    "return polar_error_of_mine(*polar, GAINS)",
    "import wmrlib.control as c; return c.control_law(*polar, GAINS)",
    "from wmrlib.control import control_law as mine; return (lambda: mine(*polar, GAINS))()",
]


def test_a_call_of_the_libraries_is_found_in_any_way():
    own = "this task asks for your own formula, with `math` or `numpy`"
    allowed, laws = [of("*_", part) for part in SEES], [of("*polar", part) for part in LAWS]
    for function in allowed:
        assert function() == (1.0, 0.0, 0.0)
        _hints.own_work(function, *ALLOWED)
    for function in laws:
        hint = "uses `control_law` of wmrlib; of it only `Pose`, `polar_error` may be used here"
        with pytest.raises(Hint, match=hint):
            _hints.own_work(function, *ALLOWED)
    law, ways = laws[0], (functools.cache, functools.partial, np.vectorize, numba.njit)
    hidden = [lambda *part: law(*part), *(way(law) for way in ways), control_law]
    for function in [*allowed, *laws, *hidden]:
        with pytest.raises(Hint, match=f"of wmrlib; {own}"):
            _hints.own_work(function)


def test_data_and_names_of_ones_own_are_no_call():
    containers = "return wmr.Gains(x, 1, 1)[:3] + wmr.Pose(x, *wmr.GeoPoint(lat=1, lon=2))"
    free = [of("x", "return GAINS.k_rho * x + START.x"), of("x", containers)]
    free += [of("polar_error", "return polar_error(1.0)"), lambda x: x + 1.0]
    for allowed in ((), ALLOWED):
        for function in free:
            _hints.own_work(function, *allowed)
    mixed = of("x", "return wmr.polar_error(START, START).rho + control(x)")
    _hints.own_work(mixed, *ALLOWED)  # wmrlib has a module called control, too


def test_a_function_that_stops_is_told_with_its_error():
    with pytest.raises(Hint, match=r"`<lambda>\(0.5\)` stops with ZeroDivisionError: "):
        _asking.ask(lambda x: x / 0, 0.5)
    with pytest.raises(Hint, match=r"`<lambda>\(-1\)` must raise ValueError: no root"):
        _asking.refuses(lambda x: x, "no root", -1)
    _asking.refuses(math.sqrt, "no root", -1)


def test_jupyter_shows_the_hint_without_the_check():
    assert Hint("a sign")._render_traceback_() == ["Hint: a sign"]


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
    text = STANDING.read_text(encoding="utf-8", errors="replace")
    assert all(f"${body}*" in text for body in routes.BODIES)


def rule_of_the_book(computed, printed):
    return wmrbook.audit.fits(computed, Published(float(printed), "", ""))


def test_the_rule_is_the_audit_s():
    """But for printed zeros, which the audit's float does not know."""
    for computed, printed in verdicts._printed(300):
        if not printed.endswith("0"):
            rounds, cuts, near = verdicts._verdict(decimal.Decimal(repr(computed)), printed)
            assert (rounds or (cuts and near)) == rule_of_the_book(computed, printed)


def test_counterexamples_are_those_of_the_paper_s_equations():
    """Written out by hand: the check takes a state if and only if it refutes the claim."""
    random, counterexamples = np.random.default_rng(1), []
    for rho, alpha, theta, omega in random.uniform((0.01, -1, -3, -2), (1, 1.5, 3, 4), (60, 4)):
        v = 4 * (1 - np.exp(-2 * rho)) * np.cos(alpha)
        part = -alpha * omega + v * np.sin(alpha) / rho * (0.3 * theta + alpha)
        obeyed = omega > (alpha + 0.3 * theta) * np.cos(alpha) * np.sin(alpha)
        refutes = obeyed and part > 1e-3
        try:
            verdicts.counterexample_23((rho, alpha, theta, omega))
            counterexamples.append("accepted")
            assert refutes
            assert alpha > 0
        except Hint as hint:
            side = bool(re.search("chapter 10's side", str(hint)))
            counterexamples.append("side" if side else "claim holds")
            assert side == bool(refutes)
            assert not (refutes and alpha > 0)
    assert min(map(counterexamples.count, ("accepted", "side", "claim holds"))) > 5
