"""The panel's JavaScript against wmrlib: whole trajectories, and their summaries."""

from __future__ import annotations

import base64
import math
from typing import Any, NamedTuple

import numpy as np
import pytest

import wmrlib as wmr
from wmrlib import paper
from wmrlib.laws import POSE_LAWS

COLUMNS = ("t", "x", "y", "heading", "rho", "alpha", "theta", "v", "omega", "V")
ANGLES = ("heading", "alpha", "theta")
POSE_RUNS, CIRCLE_RUNS, SEED = 300, 60, 20_240_601
CONTINUOUS, PEAKS = 40, 1000

# Arrays of doubles as base64: JSON would be four times as long, and would lose NaN.
SIMULATE_ALL = """([runs, columns]) => {
  const parts = [], ends = [];
  for (const options of runs) {
    const run = simulate(options);
    ends.push([run.n, run.outcome, summarise(run)]);
    for (const column of columns) parts.push(run[column]);
  }
  const all = new Float64Array(parts.reduce((size, part) => size + part.length, 0));
  let at = 0;
  for (const part of parts) { all.set(part, at); at += part.length; }
  const bytes = new Uint8Array(all.buffer), texts = [];
  for (let i = 0; i < bytes.length; i += 32768) {
    texts.push(String.fromCharCode.apply(null, bytes.subarray(i, i + 32768)));
  }
  return { ends, data: btoa(texts.join('')) };
}"""


class Run(NamedTuple):
    """One run in both: `ours` is wmrlib's trajectory, `theirs` the browser's columns."""

    options: dict[str, Any]
    ours: wmr.Trajectory
    theirs: dict[str, np.ndarray]
    outcome: str
    summary: dict[str, Any]


def _draw(random: np.random.Generator, circle: bool, methods=("arc", "euler")) -> dict[str, Any]:
    def between(low, high):
        return float(random.uniform(low, high))

    def scaled(low, high):
        return math.exp(between(math.log(low), math.log(high)))

    laws = [*POSE_LAWS, *(["kanayama"] if circle else [])]
    reach = 6.0 if circle else 40.0
    method = str(random.choice(methods))
    kept = between(0.0, 2.0) if random.random() < 0.5 else 0.0
    return {
        "start": [between(-reach, reach), between(-reach, reach), between(-math.pi, math.pi)],
        "goal": [between(-reach, reach), between(-reach, reach), between(-math.pi, math.pi)],
        "reference": "circle" if circle else None,
        "law": str(random.choice(laws)),
        "method": method,
        "hysteresis": 0.0 if circle or method == "continuous" else kept,
        "wheels": None if circle or method == "continuous" else _wheels(random),
        "lastTurn": None if circle or method == "continuous" else _last_turn(random),
        "gains": {
            "k_rho": scaled(0.05, 3.0),
            "k_alpha": between(0.1, 5.0),
            "h": scaled(0.02, 4.0),
            "v_max": between(0.5, 6.0),
        },
        "feedback": {
            "k_x": between(0.1, 3.0),
            "k_y": between(0.1, 5.0),
            "k_heading": between(0.1, 5.0),
        },
        "dt": scaled(0.04, 0.2),
        "duration": between(10.0, 40.0),
        "arrivalRadius": between(0.02, 0.2),
    }


def _wheels(random: np.random.Generator) -> dict[str, float] | None:
    """Wheels with some of what wheels can have; each now and then."""
    if random.random() < 0.4:
        return None
    most = {
        "acceleration": 3.0,
        "lag": 0.3,
        "dead_band": 0.1,
        "min_speed": 0.2,
        "encoder_step": 0.01,
    }
    kept = [name for name in most if random.random() < 0.4]
    some = {name: float(random.uniform(0.2, 1.0)) * most[name] for name in kept}
    return {"track_width": 0.5, "max_speed": float(random.uniform(0.4, 4.0))} | some


def _last_turn(random: np.random.Generator) -> dict[str, float] | None:
    return None if random.random() < 0.5 else {"tolerance": 0.05, "leave": 1.5}


def _ours(options: dict[str, Any]) -> wmr.Trajectory:
    start, law = wmr.Pose(*options["start"]), options["law"]
    kind, of = (wmr.KanayamaGains, "feedback") if law == "kanayama" else (wmr.Gains, "gains")
    gains = kind(**options[of])
    shared = {key: options[key] for key in ("law", "method", "dt", "duration")}
    if options["reference"]:
        return wmr.track(paper.circle, start, gains, **shared)
    shared |= {"arrival_radius": options["arrivalRadius"], "hysteresis": options["hysteresis"]}
    shared |= {"wheels": options["wheels"] and wmr.Wheels(**options["wheels"])}
    shared |= {"last_turn": options["lastTurn"] and wmr.LastTurn(**options["lastTurn"])}
    return wmr.simulate(start, wmr.Pose(*options["goal"]), gains, **shared)


def _runs(page, drawn: list[dict[str, Any]]) -> list[Run]:
    runs = []
    for first in range(0, len(drawn), 200):
        batch = drawn[first : first + 200]
        answer = page.evaluate(SIMULATE_ALL, [batch, COLUMNS])
        data, at = np.frombuffer(base64.b64decode(answer["data"])), 0
        for options, (n, outcome, summary) in zip(batch, answer["ends"], strict=True):
            columns = data[at : at + n * len(COLUMNS)].reshape(len(COLUMNS), n)
            at += columns.size
            theirs = dict(zip(COLUMNS, columns, strict=True))
            runs.append(Run(options, _ours(options), theirs, outcome, summary))
    return runs


def _difference(column: str, a, b):
    return wmr.wrap_angle(a - b) if column in ANGLES else a - b


def _assert_run(run: Run, size: float, close: float) -> bool:
    """Hold a run against wmrlib's: what `size` at its start becomes is what it may be off by.

    Where a sampled loop is unstable, with the printed law near the goal, and where the goal lies
    straight behind, that grows without bound. Returns whether it does not, so that the end and the
    summary were compared too.
    """
    x, *rest = run.options["start"]
    nudged = _ours(run.options | {"start": [x + size, *rest]})
    ours, count = run.ours, min(len(run.ours), len(nudged), run.theirs["t"].size)
    own = [(column, getattr(ours, column)[:count]) for column in COLUMNS]
    apart = [np.abs(_difference(name, getattr(nudged, name)[:count], it)) for name, it in own]
    carried = np.maximum.accumulate(np.max(apart, axis=0))
    near = carried < 1e-5
    for column, values in own:
        off = np.abs(_difference(column, run.theirs[column][:count], values))
        allowed = close * (1.0 + np.abs(values)) + 10.0 * carried
        if column in ANGLES[1:]:  # a place off by so much, seen from so near
            allowed += close / np.maximum(ours.rho[:count], 1e-300)
        assert (off <= allowed)[near].all(), (column, off.max(), run.options)
    if not near.all():
        return False
    assert (run.theirs["t"].size, run.outcome) == (len(ours), ours.outcome.name), run.options
    _assert_summary(run, 10.0 * close)
    return True


def test_whole_trajectories_equal_those_of_wmrlib(panel_core):
    random = np.random.default_rng(SEED)
    drawn = [_draw(random, circle=k >= POSE_RUNS) for k in range(POSE_RUNS + CIRCLE_RUNS)]
    assert sum(_assert_run(run, 1e-10, 1e-9) for run in _runs(panel_core, drawn)) >= 290


def test_continuous_runs_equal_those_of_wmrlib(panel_core):
    random = np.random.default_rng(SEED)
    drawn = [_draw(random, k % 3 == 0, ["continuous"]) for k in range(CONTINUOUS)]
    drawn[1]["arrivalRadius"], drawn[2]["start"] = 0.0, drawn[2]["goal"]
    runs = _runs(panel_core, drawn)
    assert sum(_assert_run(run, 1e-8, 1e-7) for run in runs) >= CONTINUOUS // 2


def test_the_peak_of_omega_is_that_of_wmrlib_wherever_in_a_step_it_is(panel_core):
    """Of drives that swing: one in a thousand has its peak apart from the largest step's end.

    Not by the printed law: what a run along its unstable rest does is decided by the tolerance.
    """
    random, drawn = np.random.default_rng(SEED), []
    for _ in range(PEAKS):
        drawn.append(_draw(random, False, ["continuous"]))
        gains = ("k_rho", 0.05, 3.0), ("k_alpha", 0.1, 5.0), ("h", 0.1, 30.0), ("v_max", 0.5, 6.0)
        drawn[-1]["gains"] = {
            name: math.exp(random.uniform(math.log(low), math.log(high)))
            for name, low, high in gains
        }
        drawn[-1] |= {"law": "corrected", "dt": 2.0, "duration": 60.0}
    answer = panel_core.evaluate(SIMULATE_ALL, [drawn, []])
    for options, (*_, summary) in zip(drawn, answer["ends"], strict=True):
        peak = _ours(options).peak_omega
        assert summary["peakOmega"] == pytest.approx(peak, rel=1e-6), options


def _assert_summary(run: Run, within: float) -> None:
    arrival, summary = wmr.arrival(run.ours), run.summary
    assert summary["arrived"] == arrival.arrived
    assert summary["time"] == pytest.approx(arrival.time, rel=within)
    assert abs(wmr.wrap_angle(summary["headingError"] - arrival.heading_error)) < within
    for name, value in (
        ("peakOmega", arrival.peak_omega),
        ("pathLength", arrival.path_length),
        ("distance", arrival.distance),
    ):
        assert summary[name] == pytest.approx(value, rel=within, abs=within), name
    assert summary["residual"] == pytest.approx(wmr.residual(run.ours), rel=within, abs=1e-12)
