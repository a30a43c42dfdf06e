"""The checks of chapter 10's exercises: right answers in other words pass, mistakes get the hint that explains them."""

import numpy as np
import pytest
from graded import lost

from wmrbook import audit
from wmrbook.equations import EQUATIONS
from wmrbook.grading import Hint, verdicts
from wmrlib import paper, symbolic

CHAPTER = "ch10"
RULE = """
def agrees(computed, printed):
    decimals = len(printed.partition(".")[2])
    cut = math.trunc(computed * 10**decimals) / 10**decimals
    rounds = abs(round(computed, decimals) - float(printed)) < 1e-9
    cuts = abs(cut - float(printed)) < 1e-9
    few = abs(computed - cut) < 0.01 * abs(computed)
    return {}
"""
DIGITS = """
def decimals_needed(metres):
    half = 0.5 * math.pi * 6_371_000 / 180
    return {}
"""
RIGHT = {
    "another state": ("claim23", "import numpy as np\nstate_23 = np.array([0.5, 0.1, 3.0, 0.2])"),
    "straight and near": ("claim23", "state_23 = 0.5, 0.5, 0.0, 1.0"),
    "far away": ("claim26", "state_26 = [0.001, 0.3, -3.1]"),
    "with floats": ("rule", RULE.format("rounds or (cuts and few)")),
    "a loop": ("digits", DIGITS.format("next(n for n in range(20) if half <= metres * 10**n)")),
    "a float": (
        "digits",
        "import numpy as np\n" + DIGITS.format("np.maximum(0.0, np.ceil(np.log10(half / metres)))"),
    ),
}
MISTAKES = [
    ("claim23", "state_23 = 1.0", "4 numbers, separated by commas"),
    ("claim23", "state_23 = (0.0, -1.0, 0.0, 2.0)", "rho is 0 m"),
    ("claim23", "state_23 = (1.0, -1.0, float('nan'), 2.0)", "not a finite number"),
    ("claim23", "state_23 = 'abcd'", "4 numbers"),
    ("claim23", "state_23 = (1.0, -math.pi / 4, 0.0, 1.0)", "this is chapter 4's side"),
    ("claim23", "state_23 = (1.0, 0.0, 0.5, 1.0)", "is 0, not positive"),
    ("claim23", "state_23 = (1.0, 0.01, 0.0, 0.02)", "1/s only; more than 0.001 1/s is needed"),
    ("claim26", "state_26 = (1 / 20, -1 / 2, 0.0)", "this is chapter 4's side"),
    ("claim26", "state_26 = (0.07, -1.04, -2.89)", "this is chapter 4's side"),
    ("claim26", "state_26 = (1 / 20, 1 / 2, 0.0)", "as the paper says"),
    ("claim26", "state_26 = (200.0, -0.5, 0.0)", "at most 100 m"),
    ("claim26", "state_26 = (50.0, 0.5, -3.0)", "as the paper says"),
    ("claim26", "state_26 = (1.0, 1.0)", "3 numbers"),
    ("rule", RULE.format("cuts and few"), "rounded to as many"),
    ("rule", RULE.format("1"), "True or False is needed"),
    ("rule", RULE.format("None"), "does it end in `return`?"),
    ("rule", RULE.format("True"), "and you say True"),
    ("rule", RULE.format("False"), "and you say False"),
    ("rule", RULE.format("computed < 1 or rounds or (cuts and few)"), "you say True"),
    ("rule", RULE.format("rounds or (cuts and few and computed > 0)"), "just cut the digits off"),
    (
        "rule",
        "import wmrlib\n" + RULE.format("wmrbook.audit.fits(computed, printed)"),
        "asks for your own formula",
    ),
    ("digits", DIGITS.format("7"), "one decimal fewer"),
    ("digits", DIGITS.format("max(0, math.log10(half / metres))"), "a whole number is needed"),
    ("digits", DIGITS.format("max(0, math.ceil(math.log10(90 / metres)))"), "m are allowed"),
]


@pytest.mark.parametrize("name", RIGHT)
def test_other_right_answers(name):
    assert lost(CHAPTER, *RIGHT[name]) == {}


@pytest.mark.parametrize(("cell", "source", "hint"), MISTAKES)
def test_mistakes(cell, source, hint):
    hints = lost(CHAPTER, cell, source)
    assert any(hint in each for each in hints.values()), hints


def test_the_rule_is_the_audit_s():
    """But for printed zeros, which the audit's float does not know."""
    for computed, printed in verdicts._printed(300):
        if not printed.endswith("0"):
            rounds, cuts, near = verdicts._verdict(verdicts.Decimal(repr(computed)), printed)
            assert (rounds or (cuts and near)) == audit.fits(
                computed, paper.Published(float(printed), "", "")
            )


def test_counterexamples_are_those_of_the_paper_s_equations():
    """Written out by hand, at random states: the check takes a state if and only if it refutes the claim."""
    accepted = wrong_side = 0
    for rho, alpha, theta, omega in (
        np.random.default_rng(1).uniform((0.01, -1, -3, -2), (1, 1.5, 3, 4), (200, 4)).tolist()
    ):
        v = 4 * (1 - np.exp(-2 * rho)) * np.cos(alpha)
        part = -alpha * omega + v * np.sin(alpha) / rho * (0.3 * theta + alpha)
        obeyed = omega > (alpha + 0.3 * theta) * np.cos(alpha) * np.sin(alpha)
        try:
            verdicts.counterexample_23((rho, alpha, theta, omega))
        except Hint:
            assert not (obeyed and part > 1e-3 and alpha > 0)
            wrong_side += obeyed and part > 1e-3
        else:
            accepted += 1
            assert alpha > 0
            assert obeyed
            assert part > 0
    assert 20 < accepted < 180
    assert wrong_side > 20
    assert EQUATIONS[23].gts == symbolic.omega
