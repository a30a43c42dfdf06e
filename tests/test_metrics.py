"""What a run amounts to, against hand calculation and the polyline."""

import math

import numpy as np
import pytest

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
            assert wmr.path_length(run) == pytest.approx(polyline, rel=1e-4)
        assert run.v.min() < 0.0 < run.v.max()


def test_peak_omega_and_heading_error():
    run = wmr.simulate(PAPER.start, PAPER.goal, PAPER.gains, method="continuous")
    result = wmr.arrival(run)
    assert result.peak_omega == -run.omega.min() > -run.omega[-1] > run.omega.max()
    error = wmr.wrap_angle(run.heading[-1] - PAPER.goal.heading)
    assert result.heading_error == pytest.approx(error)


def test_residual_is_the_mean_of_the_end():
    run = wmr.track(wmr.paper.circle, wmr.paper.CIRCLE_START, wmr.paper.CIRCLE_GAINS, duration=40.0)
    assert wmr.residual(run, last=2.0) == pytest.approx(run.rho[380:].mean())
    assert wmr.residual(run, last=1e9) == pytest.approx(run.rho.mean())


def test_bad_input():
    empty = wmr.simulate(ORIGIN, wmr.Pose(5, 1, 0), wmr.Gains(1e308, 1e308, 1e308, 1e308))
    run = wmr.simulate(PAPER.start, PAPER.goal, PAPER.gains)
    for function in (wmr.arrival, wmr.path_length, wmr.residual):
        with pytest.raises(ValueError, match="trajectory has no sample"):
            function(empty)
        with pytest.raises(ValueError, match="a Trajectory is needed, not a list"):
            function([1, 2])
    with pytest.raises(ValueError, match=r"last = 0\.0 is not allowed"):
        wmr.residual(run, last=0.0)
