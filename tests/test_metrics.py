"""What a run amounts to, against hand calculation and the polyline."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import wmrlib as wmr

ORIGIN = wmr.Pose(0.0, 0.0, 0.0)
PAPER = wmr.paper.outdoor()


def test_arrival_of_a_straight_run():
    """Straight ahead along x with the final heading already right: it can only roll."""
    run = wmr.simulate(ORIGIN, wmr.Pose(10, 0, 0), wmr.Gains(1.0, 1.0, 1.0, 2.0))
    result = wmr.arrival(run)
    assert (result.arrived, result.heading_error, result.peak_omega) == (True, 0.0, 0.0)
    assert result.time == run.t[-1]
    assert result.path_length == pytest.approx(10.0 - result.distance)
    assert 0.0 < result.distance <= 0.05


def test_path_length_is_that_of_the_polyline_and_counts_backing_up():
    backwards = wmr.Pose(0.0, 0.0, math.pi - 0.1)
    for method in ("euler", "arc", "continuous"):
        for start, goal in ((PAPER.start, PAPER.goal), (backwards, wmr.Pose(6.0, 1.0, 0.0))):
            run = wmr.simulate(start, goal, wmr.GENTLE_GAINS, method=method, dt=0.005)
            polyline = np.hypot(np.diff(run.x), np.diff(run.y)).sum()
            assert run.path_length == pytest.approx(polyline, rel=1e-4)
        assert run.v.min() < 0.0 < run.v.max()


@settings(max_examples=10)
@given(
    st.builds(wmr.Pose, st.floats(-9, 9), st.floats(-9, 9), st.floats(-3, 3)),
    st.builds(wmr.Gains, *[st.floats(0.2, 3.0)] * 4),
    st.sampled_from([None, wmr.Wheels(0.5, 1.0), wmr.Wheels(0.5, 1.0, lag=0.2)]),
)
def test_peak_and_path_between_the_samples(start, gains, wheels):
    """However far apart the samples are: against a run with hundreds of times as many."""
    assume(math.hypot(start.x, start.y) > 0.2)
    options = {"method": "continuous", "duration": 4.0, "wheels": wheels}
    coarse, fine = (wmr.simulate(start, ORIGIN, gains, dt=dt, **options) for dt in (2.0, 0.005))
    peak, speed = np.abs(fine.omega).max(), np.abs(fine.v)
    assert coarse.peak_omega == pytest.approx(peak, rel=0.02)
    assert coarse.peak_omega > peak - 1e-7 * (1.0 + peak)
    assert coarse.peak_omega == pytest.approx(fine.peak_omega, rel=1e-6, abs=1e-9)
    trapezoids = 0.5 * (speed[1:] + speed[:-1]) @ np.diff(fine.t)
    assert coarse.path_length == pytest.approx(trapezoids, abs=1e-3)
    assert coarse.path_length == pytest.approx(fine.path_length, abs=1e-7)


def test_residual_is_the_mean_of_the_end():
    run = wmr.track(wmr.paper.circle, wmr.paper.CIRCLE_START, wmr.paper.CIRCLE_GAINS, duration=40.0)
    assert wmr.residual(run, last=2.0) == pytest.approx(run.rho[380:].mean())
    assert wmr.residual(run) == pytest.approx(run.rho[350:].mean())
    assert wmr.residual(run, last=1e9) == pytest.approx(run.rho.mean())
    assert wmr.residual(run, last=1e-6) == run.rho[-1]


def test_a_run_without_a_sample_is_refused():
    empty = wmr.simulate(ORIGIN, wmr.Pose(5, 1, 0), wmr.Gains(1e308, 1e308, 1e308, 1e308))
    for function in (wmr.arrival, wmr.residual):
        with pytest.raises(ValueError, match="trajectory has no sample"):
            function(empty)
