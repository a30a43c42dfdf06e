"""The checks of chapter 6's exercises: right answers in other words pass, mistakes get the hint that explains them."""

import pytest
from graded import lost

CHAPTER = "ch06"
RESIDUAL = """
import numpy as np
def left_behind(speed, share, k_rho, v_max):
    if (1 - share) * speed >= v_max:
        raise ValueError("too fast")
    return {}
"""
LAW = """
import numpy as np
def steer(rho, alpha, theta, v_ref, omega_ref):
    e_x, e_y, e_h = rho * np.cos(alpha), rho * np.sin(alpha), alpha - theta
    return {}
"""
TWIST = """
import numpy as np
def reference_twist(x_dot, y_dot, x_ddot, y_ddot):
    v, cross = np.hypot(x_dot, y_dot), x_dot * y_ddot - y_dot * x_ddot
    return {}
"""
RIGHT = {
    "the logarithm the other way up": (
        "residual",
        RESIDUAL.format("np.log(v_max / (v_max - (1 - share) * speed)) / k_rho"),
    ),
    "a linear law": (
        "law",
        LAW.format("v_ref * np.cos(e_h) + 0.8 * e_x, omega_ref + 1.5 * e_y + 1.8 * np.sin(e_h)"),
    ),
    "complex numbers": (
        "twist",
        "def reference_twist(a, b, c, d):\n    z, w = complex(a, b), complex(c, d)\n    return abs(z), (w / z).imag",
    ),
}
MISTAKES = [
    ("residual", RESIDUAL.format("(1 - share) * speed / v_max / k_rho"), "for a slow goal only"),
    ("residual", RESIDUAL.format("-np.log(1 - (1 - share) * speed / v_max)"), "k_rho is missing"),
    ("residual", RESIDUAL.format("0.09"), "the law commands"),
    ("residual", RESIDUAL.format("-1e6"), "the law commands -inf"),
    (
        "residual",
        RESIDUAL.format("-np.log(1 - (1 - share) * speed / v_max) / k_rho").replace(
            "(1 - share) * speed >=", "speed >="
        ),
        "stops",
    ),
    (
        "residual",
        "def left_behind(speed, share, k_rho, v_max):\n    return -math.log(abs(1 - (1 - share) * speed / v_max)) / k_rho",
        "must raise",
    ),
    (
        "law",
        LAW.format("v_ref * np.cos(e_h) - e_x, omega_ref + 2 * e_y + 2 * np.sin(e_h)"),
        "0.1 m straight ahead",
    ),
    (
        "law",
        LAW.format("v_ref * np.cos(e_h) + e_x, omega_ref - 2 * e_y + 2 * np.sin(e_h)"),
        "0.1 m to the left",
    ),
    (
        "law",
        LAW.format("v_ref * np.cos(e_h) + 1e-3 * e_x, omega_ref + 1e-3 * e_y + 1e-3 * np.sin(e_h)"),
        "stronger or weaker",
    ),
    (
        "law",
        LAW.format("v_ref * np.cos(e_h) + e_x, 2 * e_y + 2 * np.sin(e_h)"),
        "on the reference itself",
    ),
    (
        "law",
        LAW.format("v_ref * np.cos(e_h) + e_x, omega_ref + 2 * alpha"),
        "a micrometre to the left",
    ),
    ("law", LAW.format("v_ref, omega_ref"), "it never comes closer"),
    ("law", LAW.format("{v_ref, omega_ref}"), "2 numbers"),
    (
        "law",
        LAW.format(
            "v_ref * np.cos(e_h) + e_x + abs(e_y) + e_y, omega_ref + 2 * e_y + 2 * np.sin(e_h)"
        ),
        "the speed must stay the same",
    ),
    (
        "law",
        LAW.format("v_ref * np.cos(e_h) + e_x, omega_ref + 2 * e_y + 2 * np.sin(e_h) + 2 * e_y**2"),
        "the other way",
    ),
    ("law", LAW.format("v_ref"), "2 numbers"),
    (
        "law",
        "import wmrlib\n"
        + LAW.format("wmrlib.tracking_law(rho, alpha, theta, v_ref, omega_ref, None)"),
        "asks for your own formula",
    ),
    ("twist", TWIST.format("v**2, cross / v**2"), "square of the speed"),
    ("twist", TWIST.format("x_dot + y_dot, cross / v**2"), "the length of the velocity"),
    ("twist", TWIST.format("v, abs(cross) / v**2"), "omega has a sign"),
    ("twist", TWIST.format("v, cross / v"), "acceleration to the side"),
    ("twist", TWIST.format("v, cross"), "divide by"),
    ("twist", TWIST.format("v, np.hypot(x_ddot, y_ddot) / v"), "chain rule"),
    ("twist", TWIST.format("v, 1.0"), "chain rule"),
]


@pytest.mark.parametrize("name", RIGHT)
def test_other_right_answers(name):
    assert lost(CHAPTER, *RIGHT[name]) == {}


@pytest.mark.parametrize(("cell", "source", "hint"), MISTAKES)
def test_mistakes(cell, source, hint):
    hints = lost(CHAPTER, cell, source)
    assert any(hint in each for each in hints.values()), hints
