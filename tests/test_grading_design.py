"""The checks of chapter 7's exercises: right answers in other words pass, mistakes get the hint that explains them."""

import pytest
from graded import lost

CHAPTER = "ch07"
RIGHT = {
    "by small differences": (
        "angles",
        """
import numpy as np
def angle_matrix(rho, k_rho, k_alpha, h, v_max):
    g = k_rho * v_max if rho < 1e-7 else v_max * (1 - np.exp(-k_rho * rho)) / rho
    def rates(a, t):
        w = k_alpha * a + g * np.cos(a) * np.sinc(a / np.pi) * (a + h * t)
        turning = g * np.cos(a) * np.sin(a)
        return np.array([turning - w, turning])
    e = 1e-5
    return np.column_stack([(rates(e, 0) - rates(-e, 0)) / (2 * e), (rates(0, e) - rates(0, -e)) / (2 * e)])
""",
    ),
    "by damping and frequency": (
        "placement",
        """
import numpy as np
def gains_from_poles(distance_pole, pole_1, pole_2, v_max):
    one, minus_total, product = np.poly([pole_1, pole_2]).real
    rate = abs(distance_pole)
    frequency = np.sqrt(product)
    damping = minus_total / (2 * frequency)
    return rate / v_max, 2 * damping * frequency, (frequency / rate) ** 2
""",
    ),
    "other gains": ("tuning", "gains = wmr.Gains(0.4, 3.0, 2.0, 4.0)"),
    "numbers of numpy's": (
        "tuning",
        "import numpy as np\ngains = wmr.Gains(0.4, 2.5, 1.5)._replace(k_rho=np.float64(0.4))",
    ),
    "whole numbers": ("tuning", "gains = wmr.Gains(0.4, 2.5, 1.5)._replace(k_alpha=3, h=2)"),
}
MISTAKES = [
    (
        "angles",
        "return [[-k_alpha, -h * pull * rho], [pull * rho, 0.0]]",
        "holds v where (8) has v/rho",
    ),
    ("angles", "return [[-k_alpha, pull], [-h * pull, 0.0]]", "rows and columns are swapped"),
    ("angles", "return [[0.0, pull], [-h * pull, -k_alpha]]", "in this order"),
    ("angles", "return [[-k_alpha - pull, -h * pull], [pull, 0.0]]", "(9) has two terms"),
    (
        "angles",
        "return [[-k_alpha, h * pull], [pull, 0.0]]",
        "with which sign does omega stand in (9)",
    ),
    ("angles", "return [[-k_alpha, -pull], [pull, 0.0]]", "what in omega multiplies theta"),
    ("angles", "return [[-k_alpha, -h * pull], [pull, h]]", "does theta itself stand in (8)"),
    ("angles", "return [[-2 * k_alpha, -h * pull], [pull, 0.0]]", "collect what multiplies alpha"),
    ("angles", "return [[-k_alpha, -h * pull], [2 * pull, 0.0]]", "linearise (8)"),
    ("angles", "return [-k_alpha, pull]", "returns 2 numbers; 2 x 2 numbers are needed"),
    ("angles", "return 'A'", "2 x 2 numbers are needed"),
    ("angles", "pass", "does it end in `return`?"),
    ("angles", "return [[-k_alpha, math.nan], [pull, 0.0]]", "not finite"),
    (
        "angles",
        "return [[-k_alpha, -h * pull], [wmr.Gains(1.0, 1.0, 1.0).k_rho * pull, 0.0]]",
        "asks for your own formula",
    ),
    (
        "placement",
        "return distance_pole / v_max, k_alpha, stiffness / distance_pole**2",
        "k_rho is negative",
    ),
    (
        "placement",
        "return -2 * distance_pole / v_max, k_alpha, stiffness / distance_pole**2",
        "see (7.1)",
    ),
    (
        "placement",
        "return -distance_pole / v_max, k_alpha / 2, stiffness / distance_pole**2",
        "k_alpha is wrong",
    ),
    (
        "placement",
        "return -distance_pole / v_max, k_alpha, stiffness",
        "a part of that is the distance's",
    ),
    (
        "placement",
        "return -distance_pole / v_max, k_alpha, -math.sqrt(stiffness) / distance_pole",
        "the root of what it should be",
    ),
    ("placement", "return -distance_pole / v_max, k_alpha, 3.0", "what has no s"),
    ("placement", "return k_alpha, stiffness", "3 numbers"),
    ("placement", "return 1, 2, 3", "Which can change"),
    ("placement", "return -distance_pole, k_alpha, stiffness / distance_pole**2", "twice v_max"),
    (
        "placement",
        "return -distance_pole / v_max, k_alpha * v_max, stiffness / distance_pole**2",
        "must not depend on v_max",
    ),
    (
        "placement",
        "return -distance_pole / v_max, -2 * complex(pole_1).real, stiffness / distance_pole**2",
        "must not count",
    ),
    ("tuning", "gains = (0.25, 2.0, 2.0, 4.0)", "`wmr.Gains("),
    ("tuning", "gains = wmr.Gains([0.2, 0.3], 2.0, 2.0)", "one number a gain"),
    (
        "tuning",
        "gains = wmr.Gains(0.2, 2.0, 2.0); gains = tuple.__new__(wmr.Gains, (-0.2, *gains[1:]))",
        "k_rho = -0.2 is not allowed",
    ),
    ("tuning", "gains = tuple.__new__(wmr.Gains, (None, 2.0, 2.0, 4.0))", "`gains`: "),
    ("tuning", "gains = wmr.Gains(0.32, 1.37, 0.81)", "it takes 19.4 s"),  # chapter 7 prints these
    ("tuning", "gains = wmr.Gains(0.0, 2.0, 2.0)", "does not arrive"),
    ("tuning", "gains = wmr.Gains(0.2, 2.0, 2.0, 3.0)", "s, where 19 s are allowed"),
    ("tuning", "gains = wmr.Gains(0.01, 0.2, 0.1, 4.0)", "have not arrived"),
]
BEGINNINGS = {
    "angles": "pull = -v_max * math.expm1(-k_rho * rho) / rho if rho > 0 else v_max * k_rho",
    "placement": "k_alpha, stiffness = -(pole_1 + pole_2).real, (pole_1 * pole_2).real",
}
SIGNATURES = {
    "angles": "def angle_matrix(rho, k_rho, k_alpha, h, v_max):",
    "placement": "def gains_from_poles(distance_pole, pole_1, pole_2, v_max):",
}


def test_near_the_goal_a_sign_is_not_taken_for_lost_digits():
    hints = lost(
        CHAPTER, "angles", source_of("angles", "return [[-k_alpha, h * pull], [pull, 0.0]]")
    )
    assert "with which sign does omega stand in (9)" in hints["angles-goal"]


def source_of(cell: str, text: str) -> str:
    return "\n    ".join([SIGNATURES[cell], BEGINNINGS[cell], text]) if cell in SIGNATURES else text


@pytest.mark.parametrize("name", RIGHT)
def test_other_right_answers(name):
    assert lost(CHAPTER, *RIGHT[name]) == {}


@pytest.mark.parametrize(("cell", "text", "hint"), MISTAKES)
def test_mistakes(cell, text, hint):
    hints = lost(CHAPTER, cell, source_of(cell, text))
    assert any(hint in each for each in hints.values()), hints
