"""A law added to a copy by the steps of CONTRIBUTING.md is everywhere, and the same."""

import textwrap

import pytest
from recipes import blocks, check, copied, put, run

pytestmark = pytest.mark.slow

PYTHON = """
import numpy as np, wmrlib as wmr
from wmrbook.panel import Explorer

low, high = (0, -3, -3, 0.1, 0.1, 0.1, 0.5), (30, 3, 3, 3, 5, 3, 5)
states = np.random.default_rng(11).uniform(low, high, (200, 7)).T
states[0, :3], states[1, 2:5] = 0.0, 0.0  # the goal itself and alpha = 0 among them
rho, alpha, theta, k_rho, k_alpha, h, v_max = states
gains = wmr.Gains(k_rho, k_alpha, h, v_max)
found, _ = wmr.control_law(rho, alpha, theta, gains, law="rational")
v = v_max * k_rho * rho / (1 + k_rho * rho) * np.cos(alpha)
np.testing.assert_allclose(found, v, rtol=1e-12, atol=1e-12)
slope = -rho * v * np.cos(alpha) - k_alpha * alpha**2  # as with the corrected law
rate = wmr.lyapunov_rate(rho, alpha, theta, gains, law="rational")
np.testing.assert_allclose(rate, slope, rtol=1e-9, atol=1e-9)

start, goal, how = wmr.Pose(0, 0, 1), wmr.Pose(2, 3, -0.5), {"law": "rational"}
gains, two = wmr.Gains(0.5, 2.0, 1.0, 2.0), wmr.Gains(0.5, 2.0, [1.0, 1.0], 2.0)
run = wmr.arrival(wmr.simulate(start, goal, gains, arrival_radius=0.05, **how))
swept = wmr.sweep(start, goal, two, method="arc", arrival_radius=0.05, **how)
np.testing.assert_allclose(swept.time, run.time, rtol=1e-9)
np.testing.assert_allclose(swept.heading_error, run.heading_error, rtol=1e-9)
smooth = wmr.sweep(start, goal, two, arrival_radius=0.05, **how)
np.testing.assert_allclose(smooth.time, run.time, rtol=0.05)
explorer = Explorer(start, goal, gains, **how)
assert "rational" in [law["name"] for law in explorer.setup["laws"]]
assert explorer.trajectory().t[-1] == run.time
"""


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """A copy with the law: its formula, its row, printed again."""
    copy = copied(tmp_path_factory.mktemp("copy"))
    formula, row, codes, line = blocks("To add a law")
    laws = copy / "wmrlib" / "laws.py"
    put(laws, f"{formula}\n\n", "class Law(NamedTuple):")
    put(laws, f"    {row}", '    "kanayama": Law(')
    put(laws, f"{codes}#", "CORRECTED, PRINTED")
    put(laws, f"{textwrap.indent(line, '    ')}", "    return aicardi_law(rho")
    run(copy, "-m", "wmrlib.symbolic")
    run(copy, "book/tools/kit.py")
    return copy


def test_python_has_it_and_its_loops_agree(copy):
    run(copy, "-c", PYTHON)


def test_sympy_and_c_have_it_and_no_other_test_turns_red(copy):
    """Those that go through the laws, name them, or compare what is printed."""
    names = "control", "simulation", "sweeping", "explorer", "symbolic", "c_header"
    words = "law or named or refused or committed or printed"
    files = (f"tests/test_{name}.py" for name in names)
    printed = copy / "wmrlib" / "symbolic" / "c" / "wmr_law.h"
    assert "wmr_law_rational(" in printed.read_text(encoding="utf-8")
    check(copy, *files, "-k", words)


@pytest.mark.needs("browser")
def test_javascript_and_the_panel_have_it_too(copy):
    browser = ("tests/browser/test_panel_core.py", "tests/browser/test_parity.py")
    check(copy, *browser)
