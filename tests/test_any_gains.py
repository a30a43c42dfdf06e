"""What the book promises for all gains: how soon the heading settles, and where a sign slips."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

import wmrlib as wmr
from wmrlib import paper

gain, small = st.floats(0.05, 20.0), st.floats(0.05, 5.0)


@given(st.floats(-3.0, 3.0))
def test_no_k_rho_at_all_lets_the_papers_heading_settle_first(power):
    assert wmr.modes(paper.OUTDOOR_GAINS._replace(k_rho=10.0**power)).slower > 1.0


@given(k_rho=small, k_alpha=gain, h=gain, v_max=st.floats(0.2, 8.0))
def test_no_h_settles_the_heading_faster_than_half_of_k_alpha(k_rho, k_alpha, h, v_max):
    gains = wmr.Gains(k_rho, k_alpha, h, v_max)
    assert wmr.modes(gains).heading_rate <= k_alpha / 2.0 * (1.0 + 1e-9)
    at_best = wmr.modes(gains._replace(h=(k_alpha / (k_rho * v_max)) ** 2))
    assert at_best.heading_rate == pytest.approx(k_alpha / 2.0)  # and a large one gets there


@given(st.floats(0.05, 20.0))
def test_critical_damping_enters_the_window_at_a_kappa_of_two_only(kappa):
    modes = wmr.modes(wmr.Gains(1.0, kappa, kappa**2 / 4.0, 1.0))
    assert modes.damping == pytest.approx(1.0)
    assert (modes.slower < 1.0) == (kappa > 2.0)


@given(
    k_rho=small,
    k_alpha=small,
    h=st.floats(0.01, 10.0),
    v_max=st.floats(0.1, 10.0),
    power=st.floats(-2.0, 2.0),
    theta=st.floats(0.05, 3.0),
)
def test_under_the_printed_law_v_rises_near_the_goal_for_all_gains_and_every_weight(
    k_rho, k_alpha, h, v_max, power, theta
):
    rate = v_max * k_rho
    alpha = min(0.1, 0.1 * rate * h * theta / (k_alpha + rate * (1.0 + h * theta)))
    state, gains = (1e-9, alpha, theta), wmr.Gains(k_rho, k_alpha, h, v_max)
    assert wmr.lyapunov_rate(*state, gains, law="printed", L=10.0**power) > 0.0
    assert wmr.lyapunov_rate(*state, gains, law="corrected", L=10.0**power) < 0.0


@given(st.floats(0.0, 1.0), st.lists(st.sampled_from([-1.0, 1.0]), min_size=3, max_size=3))
def test_three_rounds_of_small_moves_lead_at_most_three_quarters_of_a_metre_aside(size, signs):
    ahead, turn, pose = 0.5 * size, math.radians(30.0) * size, wmr.Pose(0.0, 0.0, 0.0)
    for sign in signs:
        for v, omega in [(ahead, 0.0), (0.0, turn), (-ahead, 0.0), (0.0, -turn)]:
            pose = wmr.advance(pose, sign * v, sign * omega, 1.0)
    assert abs(pose.y) <= 0.75 + 1e-9


@given(st.floats(6_356_752.0, 6_378_137.0), st.booleans())
def test_no_consistent_reading_of_the_papers_points_gives_eight_metres(radius, swapped):
    points = [(point.lat, point.lon) for point in (paper.GPS_POINT_1, paper.GPS_POINT_2)]
    a, b = (wmr.GeoPoint(lat=p[swapped], lon=p[not swapped]) for p in points)
    east, north = wmr.local_position(a, b, radius=radius)
    for metres in (wmr.haversine_distance(a, b, radius=radius), abs(east), abs(north)):
        assert abs(metres - 8.0) > 0.5
