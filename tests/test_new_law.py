"""A law added to a copy by the steps of CONTRIBUTING.md is everywhere, and the same."""

import json
import shutil
import sys
import textwrap

import numpy as np
import pytest
from recipes import blocks, check, copied, put, run

pytestmark = pytest.mark.slow

CC = shutil.which("cc") or shutil.which("gcc")
NODE = shutil.which("node")
PYTHON = """
import json, sys
import numpy as np, sympy as sp, wmrlib as wmr
from wmrlib import symbolic
from wmrbook.panel import Explorer
from wmrlib.symbolic import alpha, h, k_alpha, k_rho, rho, theta, v_max
states = np.array(json.load(sys.stdin))
gains, how = wmr.Gains(*states[3:]), {"law": "rational", "arrival_radius": 0.05}
symbols = rho, alpha, theta, k_rho, k_alpha, h, v_max
start, goal = wmr.Pose(0.0, 0.0, 1.0), wmr.Pose(2.0, 3.0, -0.5)
run = wmr.arrival(wmr.simulate(start, goal, wmr.Gains(0.5, 2.0, 1.0, 2.0), **how))
swept = wmr.sweep(start, goal, wmr.Gains(0.5, 2.0, [1.0, 1.0], 2.0), method="arc", **how)
smooth = wmr.sweep(start, goal, wmr.Gains(0.5, 2.0, [1.0, 1.0], 2.0), **how)
explorer = Explorer(start, goal, wmr.Gains(0.5, 2.0, 1.0, 2.0), law="rational")
json.dump({
    "control": np.transpose(wmr.control_law(*states[:3], gains, law="rational")).tolist(),
    "rate": wmr.lyapunov_rate(*states[:3], gains, law="rational").tolist(),
    "sympy": np.transpose(sp.lambdify(symbols, symbolic.law("rational"))(*states)).tolist(),
    "run": [run.time, run.heading_error], "smooth": smooth.time.tolist(),
    "swept": [swept.time[1], swept.heading_error[1]],
    "panel": ["rational" in [law["name"] for law in explorer.setup["laws"]],
              float(explorer.trajectory().t[-1])],
}, sys.stdout)
"""
JAVASCRIPT = """
import { readFileSync } from 'node:fs';
import { controlLaw } from './book/wmrbook/panel/kit/law.js';
import { LAWS } from './book/wmrbook/panel/kit/model.js';
const states = JSON.parse(readFileSync(0)), names = LAWS.rational.gains;
const call = (s) => controlLaw(...s.slice(0, 3),
  Object.fromEntries(names.map((name, i) => [name, s[3 + i]])), 'rational');
console.log(JSON.stringify(states[0].map((_, i) => call(states.map((row) => row[i])))));
"""
C = r"""
#include <stdio.h>
#include "wmr_law.h"
int main(void) {
  wmr_polar e; wmr_gains g;
  while (scanf("%lf%lf%lf%lf%lf%lf%lf", &e.rho, &e.alpha, &e.theta, &g.k_rho, &g.k_alpha, &g.h,
               &g.v_max) == 7) {
    const wmr_twist t = wmr_law_rational(e, g);
    printf("%.17g %.17g\n", t.v, t.omega);
  }
  return 0;
}
"""


@pytest.fixture(scope="module")
def states():
    """rho, alpha, theta and four gains, as rows; the goal itself and alpha = 0 among them."""
    random = np.random.default_rng(11)
    low, high = (0, -3, -3, 0.1, 0.1, 0.1, 0.5), (30, 3, 3, 3, 5, 3, 5)
    drawn = random.uniform(low, high, (200, 7)).T
    drawn[0, :3], drawn[1, 2:5] = 0.0, 0.0
    return drawn


@pytest.fixture(scope="module")
def package(tmp_path_factory):
    """A copy of wmrlib with the law: its formula, its row, printed again."""
    copy = copied(tmp_path_factory.mktemp("copy"))
    formula, row, codes, line = blocks("To add a law")
    laws = copy / "wmrlib" / "laws.py"
    put(laws, f"{formula}\n\n", "class Law(NamedTuple):")
    put(laws, f"    {row}", '    "kanayama": Law(')
    put(laws, f"{codes}#", "CORRECTED, PRINTED")
    put(laws, f"{textwrap.indent(line, '    ')}", "    return aicardi_law(rho")
    run(copy, sys.executable, "-m", "wmrlib.symbolic")
    run(copy, sys.executable, "book/tools/kit.py")
    return copy / "wmrlib"


@pytest.fixture(scope="module")
def ours(package, states):
    """What Python makes of it."""
    return json.loads(
        run(package.parent, sys.executable, "-c", PYTHON, given=json.dumps(states.tolist()))
    )


def test_python_sympy_and_the_loops_agree(ours, states):
    rho, alpha, _, k_rho, k_alpha, _, v_max = states
    v = v_max * k_rho * rho / (1 + k_rho * rho) * np.cos(alpha)
    np.testing.assert_allclose(np.transpose(ours["control"])[0], v, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(ours["sympy"], ours["control"], rtol=1e-12, atol=1e-12)
    slope = -rho * v * np.cos(alpha) - k_alpha * alpha**2  # as with the corrected law
    np.testing.assert_allclose(ours["rate"], slope, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(ours["swept"], ours["run"], rtol=1e-9)
    np.testing.assert_allclose(ours["smooth"], ours["run"][0], rtol=0.05)
    assert ours["panel"] == [True, ours["run"][0]]


@pytest.mark.skipif(not NODE, reason="this test needs Node.js (Debian: apt install nodejs)")
def test_javascript_agrees(package, ours, states):
    (package.parent / "law.mjs").write_text(JAVASCRIPT, encoding="utf-8")
    printed = run(package.parent, NODE, "law.mjs", given=json.dumps(states.tolist()))
    np.testing.assert_allclose(json.loads(printed), ours["control"], rtol=1e-12, atol=1e-12)


@pytest.mark.needs("compiler")
def test_c_agrees(package, ours, states):
    (package.parent / "law.c").write_text(C, encoding="utf-8")
    include = f"-I{package / 'symbolic' / 'c'}"
    run(package.parent, CC, "-std=c99", "-Wall", "-Werror", include, "law.c", "-o", "law", "-lm")
    rows = "\n".join(" ".join(map(repr, row)) for row in states.T.tolist())
    printed = run(package.parent, package.parent / "law", given=rows)
    numbers = [list(map(float, line.split())) for line in printed.splitlines()]
    np.testing.assert_allclose(numbers, ours["control"], rtol=1e-12, atol=1e-12)


def test_no_other_test_turns_red(package):
    """Those that go through the laws, name them, or compare what is printed."""
    names = "control", "simulation", "sweeping", "explorer", "symbolic"
    words = "law or named or refused or committed or printed"
    files = (f"tests/test_{name}.py" for name in names)
    check(package.parent, sys.executable, *files, "-k", words)


@pytest.mark.needs("browser")
def test_the_panel_has_it_too(package):
    browser = ("tests/browser/test_panel_core.py", "tests/browser/test_parity.py")
    check(package.parent, sys.executable, *browser)
