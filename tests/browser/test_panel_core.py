"""The panel's formulas, maps, modes and messages in the browser, against wmrlib."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
import sympy as sp

import wmrlib as wmr
from wmrlib import laws, paper, symbolic

OUTDOOR = {
    "start": [0.0, 0.0, paper.START_HEADING],
    "goal": list(paper.outdoor().goal),
    "reference": None,
    "law": "corrected",
    "method": "arc",
    "gains": {"k_rho": 0.2, "k_alpha": 2.0, "h": 2.0, "v_max": 4.0},
    "feedback": {"k_x": 1.0, "k_y": 1.0, "k_heading": 1.0},
    "dt": 0.1,
    "duration": 60.0,
    "arrivalRadius": 0.05,
}


CALL = """([name, rows, count, gains]) => rows.map((row) => {
  const given = row.slice(0, count);
  const tuned = Object.fromEntries(gains.map((gain, i) => [gain, row[count + i]]));
  if (gains.length) given.push(tuned);
  return [window[name](...given)].flat();
})"""


def test_each_printed_formula_equals_its_expression(panel_core):
    for name, formula in symbolic.panel_formulas().items():
        random = np.random.default_rng(7)
        symbols = (*formula.arguments, *formula.gains)
        rows = random.uniform(-3.0, 3.0, (200, len(symbols)))
        for column, symbol in enumerate(symbols):
            if symbol.is_positive:
                rows[:, column] = 10.0 ** random.uniform(-2.0, 1.0, 200)
            elif symbol.name in ("rho", "alpha", "angle", "theta"):
                rows[:20, column] = np.repeat([0.0, 1e-12, 9e-9, 1.1e-8], 5)
        gains = [gain.name for gain in formula.gains]
        request = [symbolic.javascript_name(name), rows.tolist(), len(formula.arguments), gains]
        printed = panel_core.evaluate(CALL, request)
        function = sp.lambdify(symbols, formula.expanded(), "math")
        expected = [function(*row) for row in rows]
        close = 1e-9 if name == "roll" else 1e-12  # it divides by a short period
        np.testing.assert_allclose(printed, expected, rtol=close, atol=close, err_msg=name)


def test_maps_equal_a_sweep(panel_core):
    low_high = {"k_rho": (0.005, 0.5), "k_alpha": (0.3, 4.0), "h": (0.1, 3.0), "v_max": (0.5, 4.0)}
    gains = OUTDOOR["gains"] | {"k_rho": 0.1, "k_alpha": 3.0}
    start, goal = wmr.Pose(*OUTDOOR["start"]), wmr.Pose(*OUTDOOR["goal"])
    axes = itertools.cycle((("k_alpha", "h"), ("k_rho", "h"), ("v_max", "k_rho"), ("h", "k_rho")))
    names = {
        "headingError": "heading_error",
        "time": "time",
        "peakOmega": "peak_omega",
        "pathLength": "path_length",
        "distance": "distance",
    }
    call = """([options, metrics]) =>
        metrics.map((metric) => Array.from(landscape({...options, metric})))"""
    for law, method in ("corrected", "arc"), ("corrected", "continuous"), ("aicardi", "euler"):
        metrics = [*names] if law == "corrected" else ["headingError"]
        kx, ky = next(axes)
        xs, ys = np.linspace(*low_high[kx], 12), np.linspace(*low_high[ky], 10)
        grid = dict(zip((kx, ky), np.meshgrid(xs, ys), strict=True))
        motion = {"law": law, "method": method, "duration": 80.0}
        swept = wmr.sweep(start, goal, wmr.Gains(**(gains | grid)), **motion)
        assert swept.arrived.any()
        options = OUTDOOR | motion | {"gains": gains, "kx": kx, "ky": ky}
        options |= {"xs": xs.tolist(), "ys": ys.tolist()}
        maps = panel_core.evaluate(call, [options, metrics])
        for metric, shown in zip(metrics, maps, strict=True):
            expected = np.abs(getattr(swept, names[metric]))
            expected[~swept.arrived] = np.nan
            ours, where = np.reshape(shown, (10, 12)), f"{law}, {method}, {kx}, {ky}, {metric}"
            np.testing.assert_allclose(ours, expected, rtol=1e-8, atol=1e-8, err_msg=where)


def test_a_map_without_hope_is_empty_and_start_on_goal_is_there_at_once(panel_core):
    axes = {"kx": "k_alpha", "xs": [1.0, 2.0], "ky": "h", "ys": [1.0], "metric": "time"}

    def evaluate(options):
        return panel_core.evaluate("(options) => Array.from(landscape(options))", options | axes)

    assert np.isnan(evaluate(OUTDOOR | {"gains": OUTDOOR["gains"] | {"v_max": 0.5}})).all()
    assert evaluate(OUTDOOR | {"goal": OUTDOOR["start"]}) == [0.0, 0.0]


def test_modes_equal_wmrlib(panel_core):
    others = wmr.Gains(0.2, 2.0, 2.0), wmr.Gains(0.2, 4.0, 0.1, 2.0)
    names = "rate", "naturalFrequency", "damping", "slower", "kappa"
    call = "(options) => modes(...options)"
    for gains in (paper.OUTDOOR_GAINS, paper.CIRCLE_GAINS, *others):
        for law in ("corrected", "aicardi"):
            ours, shown = wmr.modes(gains, law), panel_core.evaluate(call, [gains._asdict(), law])
            expected = ours.distance_rate, ours.natural_frequency, *ours[3:4], *ours[5:]
            assert [shown[name] for name in names] == pytest.approx(expected, rel=1e-12)
    printed = panel_core.evaluate(call, [paper.OUTDOOR_GAINS._asdict(), "printed"])
    assert printed["slower"] == math.inf


def test_a_run_that_leaves_the_range_of_numbers_says_so(panel_core):
    motion = {"law": "aicardi", "method": "euler", "dt": 5.0, "duration": 20_000.0}
    options = OUTDOOR | motion | {"gains": OUTDOOR["gains"] | {"k_rho": 90.0}}
    poses = (wmr.Pose(*options[end]) for end in ("start", "goal"))
    ours = wmr.simulate(*poses, wmr.Gains(**options["gains"]), **motion)
    outcome = panel_core.evaluate("(options) => simulate(options).outcome", options)
    assert outcome == ours.outcome.name == "DIVERGED"


WEIGHTLESS, STILL = (OUTDOOR["gains"] | {name: size} for name, size in (("h", -1), ("v_max", 0)))
NO_K_Y = {"k_x": 1.0, "k_y": 0.0, "k_heading": 1.0}
BAD_INPUT = [
    ({"dt": 0.0}, "dt = 0 is not allowed: a finite number above 0"),
    ({"dt": math.nan}, "dt = NaN is not allowed"),
    ({"dt": 61.0}, "dt = 61 is not allowed: at most the duration"),
    ({"duration": 1e9}, "duration = 1000000000 is not allowed: at most 1000000 steps"),
    ({"start": [0.0, math.nan, 0.0]}, "start = 0,NaN,0 is not allowed"),
    ({"goal": [0.0, math.inf, 0.0]}, "goal = 0,Infinity,0 is not allowed"),
    ({"gains": WEIGHTLESS}, "h = -1 is not allowed: a finite number at least 0"),
    ({"gains": STILL}, "v_max = 0 is not allowed: a finite number above 0"),
    ({"law": "kanayama"}, f"law = kanayama is not allowed: one of {', '.join(laws.POSE_LAWS)}"),
    ({"law": "toString"}, "law = toString is not allowed"),
    ({"method": "rk4"}, "method = rk4 is not allowed: one of euler, arc, continuous"),
    ({"reference": "square"}, "reference = square is not allowed: null or 'circle'"),
    ({"arrivalRadius": -0.1}, "arrivalRadius = -0.1 is not allowed"),
    ({"reference": "circle", "law": "kanayama", "feedback": NO_K_Y}, "k_y = 0 is not allowed"),
]


def test_bad_input_is_named(panel_core):
    text = """(options) => {
        try { return simulate(options).n; } catch (error) { return String(error); }
    }"""
    for change, message in BAD_INPUT:
        answer = panel_core.evaluate(text, OUTDOOR | change)
        assert str(answer).startswith(f"RangeError: {message}"), answer
