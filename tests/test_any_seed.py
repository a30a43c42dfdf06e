"""What the book promises through noise: whatever the seed, the memory and the receiver's rate."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

import wmrlib as wmr
from wmrlib import paper

GENTLE = wmr.GENTLE_GAINS
MATCHED = wmr.gains_for(0.2, natural_frequency=0.6, damping=0.5 / 0.6, v_max=4.0)
GOAL = wmr.Pose(0.0, 0.0, 0.0)
few = settings(max_examples=4)

seeds, axes = st.integers(0, 10**6), st.sampled_from(["east", "north"])
memories, periods = st.sampled_from([0.1, 3.0, 100.0, 1e4]), st.sampled_from([0.1, 1.0])


def parked(gains, x_axis, receiver, seed, **options):
    """Where 200 robots end up that steer the paper's drive by such receivers."""
    case = paper.outdoor(x_axis)
    receiver = receiver._replace(sigma=np.full(200, receiver.sigma))
    options = {"method": "arc", "dt": 0.1, "duration": 120.0, "progress": False} | options
    return wmr.sweep(case.start, case.goal, gains, receiver=receiver, seed=seed, **options)


def rms(values):
    return math.sqrt(np.mean(np.square(values)))


@few
@given(seeds, axes, memories, periods)
def test_the_matched_gains_leave_less_heading_error_and_more_distance(seed, axis, memory, period):
    receiver = wmr.Receiver(0.5, memory, period)
    gentle = parked(GENTLE, axis, receiver, seed, arrival_radius=0.2)
    matched = parked(MATCHED, axis, receiver, seed, arrival_radius=1.0)
    assert rms(matched.heading_error) < rms(gentle.heading_error)
    assert rms(matched.distance) > rms(gentle.distance)


@few
@given(seeds, axes, memories, periods, st.floats(0.3, 1.0), st.sampled_from([0.0, 2.0]))
def test_a_last_turn_beats_every_design_without_one(seed, axis, memory, period, sigma, h):
    receiver, end = wmr.Receiver(sigma, memory, period), wmr.LastTurn(leave=math.inf)
    options = {"last_turn": end, "duration": 900.0, "arrival_radius": 0.2}
    turned = parked(GENTLE._replace(h=h), axis, receiver, seed, **options)
    matched = parked(MATCHED, axis, receiver, seed, arrival_radius=2.0 * sigma)
    assert turned.arrived.all()
    assert np.abs(turned.heading_error).max() < 0.02
    assert rms(turned.distance) < rms(matched.distance)


@few
@given(seeds, axes, st.sampled_from([300.0, 3e3, 1e4]), st.floats(0.5, 1.0))
def test_a_slow_error_parks_the_robot_by_its_own_size(seed, axis, memory, sigma):
    receiver = wmr.Receiver(sigma, memory, 0.1)
    ends = parked(GENTLE, axis, receiver, seed, arrival_radius=0.2)
    assert 1.2 < rms(ends.distance) / sigma < 1.65  # about sqrt(2)


@few
@given(seeds, axes, st.sampled_from([0.0, 10.0, 300.0]))
def test_more_than_half_who_believe_to_be_within_five_centimetres_are_not(seed, axis, memory):
    receiver, options = wmr.Receiver(0.5, memory), {"dt": 0.05, "duration": 100.0}
    ends = parked(GENTLE, axis, receiver, seed, arrival_radius=0.05, **options)
    assert np.median(ends.distance) > 0.05


@few
@given(seeds, st.floats(0.0, 0.5))
def test_from_twenty_centimetres_a_drive_ends_too_soon_for_any_hysteresis(seed, hysteresis):
    start = wmr.pose_from_polar(wmr.PolarError(0.2, 0.0, math.pi), GOAL)
    receiver = wmr.Receiver(sight=np.full(300, math.radians(2.0)))
    options = {"method": "arc", "dt": 0.01, "receiver": receiver, "seed": seed, "progress": False}
    ends = wmr.sweep(start, GOAL, paper.OUTDOOR_GAINS, hysteresis=hysteresis, **options)
    assert np.mean(np.abs(ends.heading_error) > math.pi / 2) >= 0.99


@few
@given(seeds)
def test_at_most_one_in_a_hundred_of_the_designed_runs_is_off(seed):
    designed = wmr.gains_for(0.8, heading_rate=1.6, damping=1.0)
    lattice = np.outer(np.arange(1000), (0.8191725, 0.6710436, 0.5497005))  # spread evenly
    far, aim, heading = ((lattice + np.random.default_rng(seed).random(3)) % 1.0).T
    far, aim, heading = 5.0 + 55.0 * far, 2.0 * math.pi * aim, 2.0 * math.pi * heading
    starts = wmr.Pose(far * np.cos(aim), far * np.sin(aim), heading)
    ends = wmr.sweep(starts, GOAL, designed, progress=False)
    assert np.mean(np.abs(ends.heading_error) > math.radians(5.0)) <= 0.01


@few
@given(seeds, st.floats(5.0, 50.0))
def test_with_the_right_sign_of_beta_none_is_far_off_at_a_millimetre(seed, distance):
    """And with the wrong sign, more than eight in ten are."""
    for sign, least, most in ((-1.0, 0.0, 0.0), (1.0, 0.8, 1.0)):
        alpha, theta = np.random.default_rng(seed).uniform(
            [[-1.5], [-3.1]], [[1.5], [3.1]], (2, 50)
        )
        x, y, heading = wmr.pose_from_polar(wmr.PolarError(distance, alpha, theta), GOAL)
        dt = 0.01
        while (rho := np.hypot(x, y)).max() > 0.001:
            sight, going = np.arctan2(-y, -x), rho > 0.001
            turn = dt * going * (8.0 * wmr.wrap_angle(sight - heading) - 1.5 * sign * sight)
            way = 3.0 * dt * going * rho
            x = x + way * np.cos(heading + turn / 2.0)
            y = y + way * np.sin(heading + turn / 2.0)
            heading = heading + turn
        assert least <= np.mean(np.abs(wmr.wrap_angle(heading)) > math.radians(30.0)) <= most
