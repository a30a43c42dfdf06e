"""The panel's JavaScript against wmrlib: every step, whole trajectories, and their summaries."""

from __future__ import annotations

import base64
import math
from typing import Any, NamedTuple

import numpy as np
import pytest
from oracle import commanded

import wmrlib as wmr
from wmrlib import paper

COLUMNS = ("t", "x", "y", "heading", "rho", "alpha", "theta", "v", "omega", "V")
ANGLES = ("heading", "alpha", "theta")
POSE_RUNS, CIRCLE_RUNS, SEED = 700, 100, 20_240_601
CONTINUOUS, CLOSE = 40, 1e-7  # runs; m and rad
PEAKS = 4000
AGREES = 1e-9  # m and rad
BELOW = 1e-11  # AGREES is demanded where the rounding that a run carries is predicted below this
ROUNDING_M, ROUNDING_RAD = 1e-14, 1e-15  # of one step of a run of some 50 m

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
    gains: Any

    @property
    def goal(self) -> tuple[wmr.Pose, Any, Any]:
        """The goal's pose and twist at each of the browser's samples."""
        if self.options["reference"] is None:
            return wmr.Pose(*self.options["goal"]), 0.0, 0.0
        reference = paper.circle(self.theirs["t"])
        return wmr.Pose(*reference[:3]), reference.v, reference.omega


def _draw(random: np.random.Generator, circle: bool, methods=("arc", "euler")) -> dict[str, Any]:
    def between(low, high):
        return float(random.uniform(low, high))

    def scaled(low, high):
        return math.exp(between(math.log(low), math.log(high)))

    laws = ["corrected", "printed", "aicardi", *(["kanayama"] if circle else [])]
    reach = 6.0 if circle else 40.0
    return {
        "start": [between(-reach, reach), between(-reach, reach), between(-math.pi, math.pi)],
        "goal": [between(-reach, reach), between(-reach, reach), between(-math.pi, math.pi)],
        "reference": "circle" if circle else None,
        "law": str(random.choice(laws)),
        "method": str(random.choice(methods)),
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


def _ours(options: dict[str, Any]):
    start, law = wmr.Pose(*options["start"]), options["law"]
    kind, of = (wmr.KanayamaGains, "feedback") if law == "kanayama" else (wmr.Gains, "gains")
    gains = kind(**options[of])
    shared = {key: options[key] for key in ("law", "method", "dt", "duration")}
    if options["reference"]:
        return wmr.track(paper.circle, start, gains, **shared), gains
    return wmr.simulate(
        start, wmr.Pose(*options["goal"]), gains, arrival_radius=options["arrivalRadius"], **shared
    ), gains


def _runs(page, drawn: list[dict[str, Any]]) -> list[Run]:
    runs = []
    for first in range(0, len(drawn), 200):
        batch = drawn[first : first + 200]
        answer = page.evaluate(SIMULATE_ALL, [batch, COLUMNS])
        data, at = np.frombuffer(base64.b64decode(answer["data"])), 0
        for options, (n, outcome, summary) in zip(batch, answer["ends"], strict=True):
            columns = data[at : at + n * len(COLUMNS)].reshape(len(COLUMNS), n)
            at += columns.size
            ours, gains = _ours(options)
            theirs = dict(zip(COLUMNS, columns, strict=True))
            runs.append(Run(options, ours, theirs, outcome, summary, gains))
    return runs


def _difference(column: str, a, b):
    return wmr.wrap_angle(a - b) if column in ANGLES else a - b


def _step(run: Run, pose: wmr.Pose, goal: wmr.Pose, v_ref, omega_ref) -> wmr.Pose:
    seen = wmr.polar_error(pose, goal)
    twist = commanded(*seen, v_ref, omega_ref, run.gains, run.options["law"])
    return wmr.advance(pose, *twist, run.options["dt"], run.options["method"])


def _carried_rounding(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """The rounding errors that wmrlib's own run carries, of the pose and of the line of sight.

    Predicted by the linearised step: its Jacobian J along the run takes the errors' covariance P to
    J P J' plus that of one more rounding. The line of sight is off by the position's error over the
    distance.
    """
    ours, size = run.ours, 1e-7
    state = np.array([ours.x, ours.y, ours.heading])
    reference = paper.circle(ours.t) if run.options["reference"] else None
    twist = (reference.v, reference.omega) if reference else (0.0, 0.0)
    jacobian = np.empty((len(ours), 3, 3))
    for axis in range(3):
        nudge = np.zeros((3, 1))
        nudge[axis] = size
        ahead, behind = (
            _step(run, wmr.Pose(*(state + side * nudge)), ours.goal, *twist) for side in (1.0, -1.0)
        )
        for row, name in enumerate(("x", "y", "heading")):
            jacobian[:, row, axis] = _difference(
                name, getattr(ahead, name), getattr(behind, name)
            ) / (2.0 * size)
    fresh = np.diag([ROUNDING_M**2, ROUNDING_M**2, ROUNDING_RAD**2])
    position, heading, covariance = np.full(len(ours), np.inf), np.full(len(ours), np.inf), fresh
    for k, slope in enumerate(jacobian):
        position[k] = math.sqrt(covariance[0, 0] + covariance[1, 1])
        heading[k] = math.sqrt(covariance[2, 2])
        if position[k] + heading[k] > 1.0:  # lost for good
            break
        covariance = slope @ covariance @ slope.T + fresh
    return np.maximum(position, heading), position / np.maximum(ours.rho, 1e-300) + heading


@pytest.fixture
def runs(panel_core):
    random = np.random.default_rng(SEED)
    return _runs(
        panel_core, [_draw(random, circle=k >= POSE_RUNS) for k in range(POSE_RUNS + CIRCLE_RUNS)]
    )


def test_every_step_and_whole_trajectories_equal_those_of_wmrlib(runs):
    """Each step to rounding; whole runs to 1e-9 m and rad, unless rounding errors outgrow that.

    A run can amplify them without bound: where the sampled loop is unstable (dt v_max k_rho above
    2, say), with the printed law near the goal, or with the goal straight behind, where alpha jumps
    from pi to -pi. There two correct programs disagree, so they are compared up to the sample at
    which wmrlib's own rounding error is predicted to pass 1e-11.
    """
    whole, worst, whole_circle = 0, 0.0, 0
    for run in runs:
        _assert_steps(run)
        ours, theirs = run.ours, run.theirs
        compared = len(ours)
        for columns, carried in zip(
            (("t", "x", "y", "heading", "rho"), ("alpha", "theta")),
            _carried_rounding(run),
            strict=True,
        ):
            lost = np.flatnonzero(carried > BELOW)
            until = lost[0] if lost.size else len(ours)
            assert theirs["t"].size >= until, run.options
            for column in columns:
                deviation = np.abs(
                    _difference(column, theirs[column][:until], getattr(ours, column)[:until])
                ).max(initial=0.0)
                assert deviation < AGREES, (column, deviation, run.options)
                worst = max(worst, deviation)
            if not (run.options["law"] == "kanayama" and "alpha" in columns):
                compared = min(compared, until)
        if compared == len(ours):
            assert (theirs["t"].size, run.outcome) == (len(ours), ours.outcome.name), run.options
            whole += not run.options["reference"]
            whole_circle += bool(run.options["reference"])
            _assert_summary(run)
    print(
        f"{whole} of {POSE_RUNS} runs and {whole_circle} of {CIRCLE_RUNS} on the circle compared "
        f"to their end; worst deviation {worst:.1e}"
    )
    assert whole >= 600
    assert whole_circle >= 65


def test_continuous_runs_equal_those_of_wmrlib(panel_core):
    """Both integrate to 1e-10 a step; what a run makes of 1e-8 m at its start is what it may add.

    Behind the goal, on it and where an angle wraps that is much. So are peaks that an angle's jump
    makes: they are compared where the motion is smooth.
    """
    random, size = np.random.default_rng(SEED), 1e-8
    drawn = [_draw(random, k % 3 == 0, ["continuous"]) for k in range(CONTINUOUS)]
    drawn[1]["arrivalRadius"], drawn[2]["start"] = 0.0, drawn[2]["goal"]
    whole = 0
    for run in _runs(panel_core, drawn):
        x, *rest = run.options["start"]
        nudged, _ = _ours(run.options | {"start": [x + size, *rest]})
        ours, count = run.ours, min(len(run.ours), len(nudged))
        assert (run.theirs["t"].size, run.outcome) == (len(ours), ours.outcome.name), run.options
        worst = 0.0
        for column in COLUMNS:
            values = getattr(ours, column)
            off = np.abs(_difference(column, run.theirs[column], values))[:count]
            carried = np.abs(_difference(column, getattr(nudged, column)[:count], values[:count]))
            allowed = CLOSE * (1.0 + np.abs(values[:count]))
            allowed += 10.0 * np.maximum.accumulate(carried)
            if column in ANGLES[1:]:  # a place off by so much, seen from so near
                allowed += CLOSE / np.maximum(ours.rho[:count], 1e-300)
            assert (off <= allowed).all(), (column, off.max(), run.options)
            worst = max(worst, carried.max())
        if worst < 1e-5:
            whole += 1
            _assert_summary(run, 1e-6)
    assert whole >= CONTINUOUS // 2


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
        peak = _ours(options)[0].peak_omega
        assert summary["peakOmega"] == pytest.approx(peak, rel=1e-6), options


def _assert_steps(run: Run) -> None:
    """At the browser's own samples: what it sees, what it commands, V, and where it goes next."""
    theirs, options = run.theirs, run.options
    goal, v_ref, omega_ref = run.goal
    pose = wmr.Pose(*(theirs[c] for c in ("x", "y", "heading")))
    seen = dict(zip(("rho", "alpha", "theta"), wmr.polar_error(pose, goal), strict=True))
    state = [theirs[c] for c in seen]
    twist = commanded(*state, v_ref, omega_ref, run.gains, options["law"])
    expected = seen | dict(zip(("v", "omega"), twist, strict=True))
    rho, alpha, theta = state
    if options["law"] == "kanayama":
        expected["V"] = rho**2 / 2.0 + (1.0 - np.cos(alpha - theta)) / run.gains.k_y
    else:
        expected["V"] = wmr.lyapunov(rho, alpha, theta, run.gains.h)
    for column, values in expected.items():
        error = np.abs(_difference(column, theirs[column], values))
        slack = 1e-12 * (1.0 + np.abs(values))
        if column in ("alpha", "theta") and options["reference"]:
            # the circle's goal is computed anew, to the last bits of some metres
            slack = slack + 1e-14 / np.maximum(rho, 1e-300)
        assert (error <= slack).all(), (column, error.max(), options)
    moved = wmr.advance(pose, theirs["v"], theirs["omega"], options["dt"], options["method"])
    for column in ("x", "y", "heading"):
        error = np.abs(_difference(column, getattr(moved, column)[:-1], theirs[column][1:]))
        assert error.max(initial=0.0) <= 1e-12, (column, error.max(), options)


def _assert_summary(run: Run, within: float = 1e-8) -> None:
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
