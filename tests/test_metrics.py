"""What a run amounts to, against hand calculation and a finer run."""

import math

import numpy as np
import pytest

import wmrlib as wmr

PAPER = wmr.paper.outdoor()


def test_arrival_of_a_straight_run():
    """Straight ahead along x with the final heading already right: it can only roll."""
    run = wmr.simulate(wmr.Pose(0, 0, 0), wmr.Pose(10, 0, 0), wmr.Gains(1.0, 1.0, 1.0, 2.0))
    result = wmr.arrival(run)
    assert (result.arrived, result.heading_error, result.peak_omega) == (True, 0.0, 0.0)
    assert result.time == run.t[-1]
    assert result.path_length == pytest.approx(10.0 - result.distance)
    assert 0.0 < result.distance <= 0.05


def test_a_run_that_does_not_arrive_takes_forever():
    result = wmr.arrival(
        wmr.simulate(wmr.Pose(0, 0, 0), wmr.Pose(1e3, 0, 0), PAPER.gains, duration=1.0)
    )
    assert (result.arrived, result.time) == (False, math.inf)
    assert result.distance == pytest.approx(996.0, abs=0.1)


def test_path_length_counts_backing_up():
    run = wmr.simulate(
        wmr.Pose(0, 0, 0), wmr.Pose(-2, 0, 0), wmr.Gains(1.0, 1.0, 1.0, 1.0), dt=0.01
    )
    assert run.v.min() < 0 < run.v.max()
    assert wmr.path_length(run) > np.abs(np.sum(run.v[:-1] * np.diff(run.t))) + 0.1


def test_path_length_of_all_methods_is_that_of_the_polyline():
    for method in ("euler", "arc", "continuous"):
        run = wmr.simulate(
            PAPER.start, PAPER.goal, wmr.Gains(0.2, 2.0, 2.0), method=method, dt=0.005
        )
        assert wmr.path_length(run) == pytest.approx(
            np.hypot(np.diff(run.x), np.diff(run.y)).sum(), rel=1e-4
        )


def test_peak_omega_and_heading_error():
    run = wmr.simulate(PAPER.start, PAPER.goal, PAPER.gains, method="continuous")
    result = wmr.arrival(run)
    assert result.peak_omega == np.abs(run.omega).max()
    assert result.heading_error == pytest.approx(
        wmr.wrap_angle(run.heading[-1] - PAPER.goal.heading)
    )


def test_residual_is_the_mean_of_the_end():
    run = wmr.track(wmr.paper.circle, wmr.paper.CIRCLE_START, wmr.paper.CIRCLE_GAINS, duration=40.0)
    assert wmr.residual(run, last=2.0) == pytest.approx(run.rho[380:].mean())
    assert wmr.residual(run, last=1e9) == pytest.approx(run.rho.mean())


def test_bad_input():
    empty = wmr.simulate(
        wmr.Pose(0, 0, 0), wmr.Pose(5, 1, 0), wmr.Gains(1e308, 1e308, 1e308, 1e308)
    )
    with pytest.raises(ValueError, match="trajectory has no sample"):
        wmr.arrival(empty)
    with pytest.raises(ValueError, match=r"a Trajectory is needed, not a list"):
        wmr.arrival([1, 2])
    with pytest.raises(ValueError, match=r"last = 0\.0 is not allowed"):
        wmr.residual(wmr.simulate(PAPER.start, PAPER.goal, PAPER.gains), last=0.0)
