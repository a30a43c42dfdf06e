"""A law added to a copy of wmrlib by the steps of CONTRIBUTING.md is everywhere, and the same."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[1]
CC = shutil.which("cc") or shutil.which("gcc")
NODE = shutil.which("node")
FORMULA = """
@formula
def rational_law(rho, alpha, theta, gains):
    v_over_rho = gains.v_max * gains.k_rho / (1.0 + gains.k_rho * rho) * sincos(alpha)[1]
    return v_over_rho, gains.k_alpha * alpha + v_over_rho * sinc(alpha) * (alpha + gains.h * theta)


def scaled(share):
    def scaled_law(rho, alpha, theta, gains):
        v_over_rho, omega = corrected_law(rho, alpha, theta, gains)
        return share * v_over_rho, omega

    return formula(scaled_law)


class Law(NamedTuple):"""
ROW = """LAWS = {
    "rational": Law(rational_law, Gains, "rational", "v that falls as k_rho rho/(1 + k_rho rho)"),
    "half": Law(scaled(0.5), Gains, "half", "half as fast"),
    "twice": Law(scaled(2.0), Gains, "twice", "twice as fast"),
"""
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
    "twins": [wmr.control_law(9.0, 0.5, 0.2, wmr.Gains(0.5, 2.0, 1.0, 2.0), law=each)[0]
              for each in ("half", "twice")],
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
    folder = tmp_path_factory.mktemp("copy")
    left_out = shutil.ignore_patterns(".*", "__pycache__", "_build", "node_modules", "vendor")
    for part in ("wmrlib", "book", "tests"):
        shutil.copytree(ROOT / part, folder / part, ignore=left_out)
    shutil.copy(ROOT / "pyproject.toml", folder)
    copy = folder / "wmrlib"
    text = (copy / "laws.py").read_text(encoding="utf-8")
    for place, new in (("\nclass Law(NamedTuple):", FORMULA), ("LAWS = {\n", ROW)):
        assert text.count(place) == 1
        text = text.replace(place, new)
    (copy / "laws.py").write_text(text, encoding="utf-8")
    run(folder, sys.executable, "-m", "wmrlib.symbolic")
    run(folder, sys.executable, "book/tools/kit.py")
    return copy


@pytest.fixture(scope="module")
def ours(package, states):
    """What Python makes of it."""
    return json.loads(
        run(package.parent, sys.executable, "-c", PYTHON, given=json.dumps(states.tolist()))
    )


def run(folder, *command, given=""):
    places = os.pathsep.join([str(folder), str(folder / "book")])
    environment = os.environ | {"PYTHONPATH": places, "PYTEST_ADDOPTS": ""}
    done = subprocess.run(
        list(map(str, command)),
        cwd=folder,
        env=environment,
        input=given,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr + done.stdout
    return done.stdout


def test_python_sympy_and_the_loops_agree(ours, states):
    rho, alpha, _, k_rho, k_alpha, _, v_max = states
    v = v_max * k_rho * rho / (1 + k_rho * rho) * np.cos(alpha)
    np.testing.assert_allclose(np.transpose(ours["control"])[0], v, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(ours["sympy"], ours["control"], rtol=1e-12, atol=1e-12)
    slope = -rho * v * np.cos(alpha) - k_alpha * alpha**2  # as with the corrected law
    np.testing.assert_allclose(ours["rate"], slope, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(ours["swept"], ours["run"], rtol=1e-9)
    np.testing.assert_allclose(ours["smooth"], ours["run"][0], rtol=0.05)
    assert ours["twins"][1] == pytest.approx(4.0 * ours["twins"][0])  # made by one function
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
    """Those that go through the laws or name them; stored panels are the steps' last point."""
    files = [f"tests/test_{name}.py" for name in ("control", "simulation", "explorer", "symbolic")]
    words = "law or named or refused or committed or printed"
    options = ["-q", "-p", "no:cacheprovider", "-p", "no:nbval", "--override-ini=addopts="]
    run(package.parent, sys.executable, "-m", "pytest", *options, *files, "-k", words)


def test_maps_of_the_panel_equal_a_sweep_by_it(package, find_tool):
    if not find_tool("browser"):
        pytest.skip("this test needs Chromium or Chrome")
    options = ["-q", "-p", "no:cacheprovider", "-p", "no:nbval", "--override-ini=addopts="]
    maps = "tests/browser/test_panel_core.py::test_maps_equal_a_sweep"
    run(package.parent, sys.executable, "-m", "pytest", *options, maps)
