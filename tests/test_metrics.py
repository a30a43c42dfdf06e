"""What a run amounts to, against hand calculation and the polyline."""

import math

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
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


def test_a_run_that_does_not_arrive_takes_forever():
    run = wmr.simulate(ORIGIN, wmr.Pose(1e3, 0, 0), PAPER.gains, duration=1.0)
    result = wmr.arrival(run)
    assert (result.arrived, result.time) == (False, math.inf)
    assert result.distance == pytest.approx(996.0, abs=0.1)


def test_path_length_is_that_of_the_polyline_and_counts_backing_up():
    backwards = wmr.Pose(0.0, 0.0, math.pi - 0.1)
    for method in ("euler", "arc", "continuous"):
        for start, goal in ((PAPER.start, PAPER.goal), (backwards, wmr.Pose(6.0, 1.0, 0.0))):
            run = wmr.simulate(start, goal, wmr.GENTLE_GAINS, method=method, dt=0.005)
            polyline = np.hypot(np.diff(run.x), np.diff(run.y)).sum()
            assert run.path_length == pytest.approx(polyline, rel=1e-4)
        assert run.v.min() < 0.0 < run.v.max()


def test_peak_omega_and_heading_error():
    run = wmr.simulate(PAPER.start, PAPER.goal, PAPER.gains, method="continuous")
    result = wmr.arrival(run)
    assert result.peak_omega > -run.omega.min() > -run.omega[-1] > run.omega.max()
    error = wmr.wrap_angle(run.heading[-1] - PAPER.goal.heading)
    assert result.heading_error == pytest.approx(error)


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


@example(wmr.Pose(-0.75, 1.24, -0.95), (0.667, 1.721, 1.356, 1.823))
@example(wmr.Pose(2.476, 2.708, 1.698), (1.925, -0.251, 1.694, 1.519))
@settings(max_examples=10)
@given(
    st.builds(wmr.Pose, st.floats(-3, 3), st.floats(-3, 3), st.floats(-3, 3)),
    st.tuples(*[st.floats(-1.0, 2.0)] * 4),
)
def test_a_peak_in_the_first_step_of_stiff_gains(start, decades):
    assume(math.hypot(start.x, start.y) > 0.2)
    gains = wmr.Gains(*(10.0**each for each in decades))
    moment = 8.0 / max(gains.k_alpha, gains.v_max, gains.k_rho * gains.v_max)
    options = {"method": "continuous", "duration": moment, "arrival_radius": 0.001}
    run = wmr.simulate(start, ORIGIN, gains, dt=moment / 4000, **options)
    peak = np.abs(run.omega).max()
    assert run.peak_omega > peak - 1e-7 * (1.0 + peak)


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
