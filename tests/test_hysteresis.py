"""The half turn's seam: a branch that is kept, against a plain loop, and what noise does there."""

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import wmrlib as wmr
from wmrlib.motion import keep_branch

GOAL, PAPER = wmr.Pose(1.0, -2.0, 0.7), wmr.paper.OUTDOOR_GAINS
TURN = 2.0 * math.pi
wrapped = st.floats(-math.pi, math.pi, exclude_min=True)
sizes = st.sampled_from([0.0, 0.1, 0.5, 4.0]) | st.floats(0.0, 8.0)


@given(wrapped, st.floats(-10.0, 10.0), sizes)
@example(math.pi, -math.pi + 1e-9, 0.0)
@example(math.nextafter(-math.pi, 0.0), math.pi, 0.0)
def test_the_branch_is_kept_up_to_the_hysteresis_and_no_farther(theta, before, hysteresis):
    kept = keep_branch(theta, before, hysteresis)
    turns = (kept - theta) / TURN
    assert turns == pytest.approx(round(turns), abs=1e-12)  # the same direction
    nearest = before + math.remainder(theta - before, TURN)
    bound = math.pi + hysteresis
    if abs(nearest) < bound - 1e-9:
        assert abs(kept - before) <= math.pi + 1e-9
    if abs(nearest) > bound + 1e-9:
        assert kept == theta
    assert abs(kept) < bound or kept == theta
    assert keep_branch(theta, kept, hysteresis) == kept or abs(kept - theta) < 1e-9
    if hysteresis == 0.0:
        assert kept == theta
    assert keep_branch(theta, math.nan, hysteresis) == theta


# A second way: of all branches, by trying -----------------------------------------------------


def driven(start, gains, hysteresis, method="arc", dt=0.1, duration=4.0):
    """The polar errors and twists of a run."""
    pose, before, samples = start, None, []
    for _ in range(round(duration / dt) + 1):
        rho, alpha, theta = wmr.polar_error(pose, GOAL)
        if before is not None:
            near = min((theta + n * TURN for n in range(-3, 4)), key=lambda it: abs(it - before))
            theta = near if abs(near) < math.pi + hysteresis else theta
        before = theta
        v, omega = wmr.control_law(rho, alpha, theta, gains)
        samples.append((rho, alpha, theta, v, omega))
        if rho <= 0.05:
            break
        pose = wmr.advance(pose, v, omega, dt, method)
    return np.array(samples).T


COLUMNS = "rho", "alpha", "theta", "v", "omega"
near_the_seam = st.builds(
    wmr.PolarError, st.floats(0.3, 3.0), st.floats(-2.0, 2.0), st.floats(2.6, 3.7)
).map(lambda polar: wmr.pose_from_polar(polar, GOAL))


@settings(max_examples=40)
@example(wmr.pose_from_polar(wmr.PolarError(0.8, 1.5, 3.0), GOAL), 0.4, "arc")
@given(
    near_the_seam,
    st.sampled_from([0.0, 0.05, 0.2, 0.6, 2.0]),
    st.sampled_from(["arc", "euler"]),
)
def test_a_run_and_a_sweep_keep_it_as_the_plain_loop_does(start, hysteresis, method):
    gains, options = wmr.Gains(0.8, 1.2, 1.5, 1.5), {"method": method}
    expected = driven(start, gains, hysteresis, **options)
    run = wmr.simulate(start, GOAL, gains, hysteresis=hysteresis, duration=4.0, **options)
    mine = np.array([getattr(run, name) for name in COLUMNS])
    np.testing.assert_allclose(mine, expected, rtol=0.0, atol=1e-8)
    energy = wmr.lyapunov(run.rho, run.alpha, run.theta, gains.h)
    np.testing.assert_allclose(run.V, energy, rtol=1e-12)
    starts = start._replace(x=np.full(2, start.x))
    options |= {"hysteresis": hysteresis, "duration": 4.0}
    ends, paths = wmr.sweep(starts, GOAL, gains, trajectories=True, **options)
    np.testing.assert_allclose(wmr.sweep(starts, GOAL, gains, **options), ends, rtol=0, atol=1e-8)
    for name, column in zip(COLUMNS, expected, strict=True):
        samples = getattr(paths, name)[1]
        np.testing.assert_allclose(samples[: column.size], column, rtol=0.0, atol=1e-8)
    summed = np.array(wmr.arrival(run), dtype=float)
    np.testing.assert_allclose([field[1] for field in ends], summed, rtol=0.0, atol=1e-8)
    _, seen = wmr.sweep(starts, GOAL, gains, trajectories=True, receiver=wmr.Receiver(), **options)
    assert all(np.array_equal(*pair, equal_nan=True) for pair in zip(seen, paths, strict=True))


# Noise on the line of sight -----------------------------------------------------------------------


def share_turned_away(noise_deg, hysteresis, seed):
    """The share of 1000 runs that end over 90 deg off, from 0.5 m behind a goal that is faced."""
    start = wmr.pose_from_polar(wmr.PolarError(0.5, 0.0, math.pi), GOAL)
    starts, sight = start._replace(x=np.full(1000, start.x)), math.radians(noise_deg)
    options = {"method": "arc", "dt": 0.01, "hysteresis": hysteresis, "seed": seed}
    ends = wmr.sweep(starts, GOAL, PAPER, receiver=wmr.Receiver(sight=sight), **options)
    assert ends.arrived.all()
    return np.mean(np.abs(ends.heading_error) > math.pi / 2.0)


def test_noise_holds_a_robot_on_the_seam_and_hysteresis_of_five_times_as_much_lets_it_go():
    assert share_turned_away(2.0, 0.0, 1) == pytest.approx(0.59, abs=0.05)
    assert share_turned_away(2.0, 0.1, 1) < 0.01
    assert share_turned_away(2.0, 0.2, 1) == 0.0
    assert share_turned_away(5.0, 0.0, 1) == pytest.approx(0.89, abs=0.04)
    assert share_turned_away(5.0, 0.1, 1) == pytest.approx(0.26, abs=0.05)
    assert share_turned_away(5.0, 0.4, 1) == 0.0


@pytest.mark.parametrize("drive", [wmr.simulate, wmr.sweep])
def test_bad_input_names_argument_value_and_range(drive):
    both = "hysteresis = 0.1 is not allowed: 0, or method 'arc' or 'euler', is needed: with"
    with pytest.raises(ValueError, match=both):
        drive(wmr.Pose(0.0, 0.0, 0.0), GOAL, PAPER, method="continuous", hysteresis=0.1)
    with pytest.raises(ValueError, match=r"hysteresis = \[0.1\] is not allowed: one number is"):
        drive(wmr.Pose(0.0, 0.0, 0.0), GOAL, PAPER, method="arc", hysteresis=[0.1])
