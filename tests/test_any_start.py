"""What the book promises from every start: draws of starts and gains, in continuous time."""

import math

import numpy as np
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

import wmrlib as wmr
from wmrlib import paper

GOAL = wmr.Pose(0.0, 0.0, 0.0)
DESIGNED = wmr.gains_for(0.8, heading_rate=1.6, damping=1.0)
few, several = settings(max_examples=6), settings(max_examples=15)

direction = st.floats(-math.pi, math.pi)
below_pi = st.floats(-3.0, 3.0)  # the barrier's gain is infinite at pi, and takes endless steps
gains_drawn = st.builds(
    wmr.Gains,
    k_rho=st.floats(0.3, 3.0),
    k_alpha=st.floats(0.5, 4.0),
    h=st.floats(0.3, 5.0),
    v_max=st.floats(1.0, 5.0),
)


def driven(error, gains, law="corrected", **options):
    """A run in continuous time from (rho, alpha, theta)."""
    start = wmr.pose_from_polar(wmr.PolarError(*error), GOAL)
    options = {"method": "continuous", "arrival_radius": 0.0} | options
    return wmr.simulate(start, GOAL, gains, law=law, **options)


def errors(nearest, farthest):
    theta = st.floats(0.01, math.pi) | st.floats(-math.pi, -0.01)  # not on the line of approach
    return st.tuples(st.floats(nearest, farthest), direction, theta)


# Chapters 4 and 15: the theorem and its bounds ---------------------------------------------------


@several
@given(errors(1e-6, 60.0), gains_drawn)
def test_the_robot_parks_from_every_start_away_from_its_goal(error, gains):
    duration = 2.0 * error[0] / gains.v_max + 15.0 / min(wmr.modes(gains)[:2])
    run = driven(error, gains, duration=duration, dt=duration / 100)
    assert abs(run.heading_error[-1]) + run.rho[-1] < 0.01


@several
@given(errors(0.05, 60.0), gains_drawn, st.floats(-4.0, 4.0))
def test_v_falls_with_any_weight_of_the_distance(error, gains, power):
    run = driven(error, gains, arrival_radius=0.01, dt=0.05)
    V = wmr.lyapunov(run.rho, run.alpha, run.theta, gains.h, 10.0**power)
    assert np.diff(V).max() <= 1e-9 * V[0]


@several
@given(errors(0.01, 60.0), gains_drawn)
def test_alpha_stays_within_half_a_turn_whatever_the_distance_and_theta(error, gains):
    assert np.abs(driven(error, gains, dt=0.05).alpha).max() <= math.pi


@several
@given(errors(0.05, 20.0), gains_drawn)
def test_a_drive_has_at_most_one_cusp_with_any_gains(error, gains):
    duration = 2.0 * error[0] / gains.v_max + 10.0 / gains.k_alpha
    run = driven(error, gains, duration=duration, dt=duration / 2000)
    assert np.sum(np.diff(np.cos(run.alpha) > 0.0)) <= 1


@several
@given(st.floats(-6.0, 0.0), st.sampled_from([-1.0, 1.0]), gains_drawn)
def test_however_near_beside_the_goal_the_heading_swings_by_more_than_a_quarter_turn(
    power, side, gains
):
    options = {"method": "continuous", "arrival_radius": 0.0, "dt": 0.005, "duration": 10.0}
    run = wmr.simulate(wmr.Pose(0.0, side * 10.0**power, 0.0), GOAL, gains, **options)
    assert np.abs(run.heading_error).max() > math.pi / 2


@several
@given(errors(0.05, 20.0), gains_drawn)
def test_the_distance_shrinks_to_a_hundredth_within_the_time_that_is_promised(error, gains):
    rho, alpha, theta = error
    straight = math.log(math.expm1(gains.k_rho * rho) / math.expm1(gains.k_rho * rho / 100))
    straight /= gains.v_max * gains.k_rho
    turning = (alpha**2 + gains.h * theta**2) / (2.0 * gains.k_alpha)
    run = driven(error, gains, duration=straight + turning, dt=(straight + turning) / 50)
    assert run.rho[-1] <= rho / 100


@several
@given(errors(0.05, 20.0), gains_drawn, st.floats(1.01, 4.0))
def test_the_angles_fall_at_the_exponential_rate_that_is_promised(error, gains, margin):
    run = driven(error, gains, duration=30.0, dt=0.02)
    rate, half = gains.v_max * gains.k_rho, 0.5 / math.sqrt(gains.h)
    slowest = -gains.v_max * math.expm1(-gains.k_rho * error[0]) / error[0]
    a = rate / (2 * gains.k_alpha) + gains.k_alpha / (8 * slowest * gains.h)
    a = margin * max(a, half)
    W, b = run.alpha**2 + gains.h * run.theta**2, rate / (3 * gains.k_alpha)
    form = [[2 * a * gains.k_alpha - rate, gains.k_alpha * half], [gains.k_alpha * half, slowest]]
    c = np.linalg.eigvalsh(form)[0] / (a + half + b * W[0] / 2)
    U = a * W + b * W**2 / 2 + run.alpha * run.theta
    late = (run.t > 0.0) & (1e-12 * U[0] < U)
    assert (U / (U[0] * np.exp(-c * run.t)))[late].max() <= 1.0


@settings(max_examples=3)
@given(
    distance=st.floats(0.5, 20.0),
    alpha=st.floats(-3.1, 3.1),
    theta=st.floats(2.5, 3.1),
    h=st.floats(0.005, 1.0),
    k_alpha=st.floats(0.1, 4.0),
)
def test_two_jumps_of_a_wrapped_theta_are_far_apart(distance, alpha, theta, h, k_alpha):
    """At least 4 pi / lambda, unless alpha passes 90 degrees between them."""
    gains = paper.OUTDOOR_GAINS._replace(h=h, k_alpha=k_alpha)
    least, last, dt = 4.0 * math.pi / (gains.v_max * gains.k_rho), -math.inf, 0.002
    for k in range(4000):
        v, omega = wmr.control_law(distance, alpha, theta, gains)
        rates = wmr.polar_rate(distance, alpha, v, omega)
        ahead = math.cos(alpha) > 0.0
        distance, alpha, theta = (
            value + dt * rate for value, rate in zip((distance, alpha, theta), rates, strict=True)
        )
        last = last if ahead == (math.cos(alpha) > 0.0) else -math.inf
        if abs(theta) > math.pi:
            theta -= math.copysign(2.0 * math.pi, theta)
            assert dt * (k + 1) - last >= least
            last = dt * k


# Chapters 0, 5 and 6: what is left at the goal ---------------------------------------------------


@several
@given(errors(6.0, 60.0))
def test_the_designed_gains_park_within_five_degrees_from_six_metres_on(error):
    run = driven(error, DESIGNED, arrival_radius=0.05, duration=120.0)
    assert abs(math.degrees(run.heading_error[-1])) <= 5.0


@several
@given(errors(2.0, 500.0))
def test_the_gentle_gains_let_the_heading_pass_zero_by_less_than_a_degree(error):
    run = driven(error, wmr.GENTLE_GAINS, arrival_radius=0.01, duration=500.0, dt=0.02)
    near = np.unwrap(run.heading_error[run.rho <= 0.3])
    near -= 2.0 * math.pi * round(near[-1] / (2.0 * math.pi))
    assert math.degrees((-np.sign(near[0]) * near).max()) < 1.0


@several
@given(st.sampled_from(["east", "north"]), st.floats(0.01, 0.05), st.floats(0.5, 2.5))
def test_gains_with_a_margin_of_two_settle_before_five_centimetres(x_axis, radius, heading):
    start, goal, *_ = paper.outdoor(x_axis)
    options = {"method": "continuous", "dt": 0.01, "arrival_radius": 1e-3, "duration": 120.0}
    run = wmr.simulate(start._replace(heading=heading), goal, DESIGNED, **options)
    assert np.degrees(np.abs(run.heading_error[run.rho <= radius])).max() < 1.0


# Chapter 7: the circle ---------------------------------------------------------------------------


def beside_the_circle(far, aim, turned):
    return wmr.Pose(far * math.cos(aim), far * math.sin(aim), math.pi / 2 + turned)


@several
@given(
    start=st.builds(beside_the_circle, st.floats(0.1, 5.0), direction, direction),
    h=st.floats(0.005, 0.5),
    k_alpha=st.floats(1.0, 5.0),
    v_max=st.floats(1.5, 8.0),
)
def test_the_residual_does_not_depend_on_start_h_or_k_alpha(start, h, k_alpha, v_max):
    gains = paper.CIRCLE_GAINS._replace(h=h, k_alpha=k_alpha, v_max=v_max)
    run = wmr.track(paper.circle, start, gains, dt=0.02, duration=40.0)
    assume(abs(run.alpha[-1]) < 0.1)  # some end up driving backwards, at an angle
    residual = -math.log(1.0 - paper.CIRCLE_SPEED / v_max) / gains.k_rho
    assert abs(run.rho[-1] - residual) < 0.004


@few
@given(st.floats(0.05, 3.0), direction)
def test_a_speed_announced_a_tenth_too_low_leaves_six_centimetres_from_every_start(far, aim):
    def announced(t):
        reference = paper.circle(t)
        return reference._replace(v=0.9 * reference.v)

    gains, options = wmr.KanayamaGains(1.0, 2.0, 2.0), {"dt": 0.02, "duration": 60.0}
    run = wmr.track(announced, beside_the_circle(far, aim, 0.0), gains, law="kanayama", **options)
    assert 0.0595 < run.rho[-1] * math.cos(run.alpha[-1]) < 0.0610


# Chapter 8: wheels -------------------------------------------------------------------------------


@few
@given(st.floats(3.0, 12.0), direction, st.floats(-3.0, 3.0), st.floats(1.5, 4.0))
def test_scaling_to_the_wheels_keeps_the_path_if_they_accelerate_at_once(far, aim, theta, fastest):
    gains, start = wmr.GENTLE_GAINS, GOAL
    goal = wmr.Pose(far * math.cos(aim), far * math.sin(aim), aim - theta)
    free = wmr.simulate(start, goal, gains, method="continuous", dt=0.005)
    scaled = wmr.simulate(start, goal, gains, dt=0.02, wheels=wmr.Wheels(0.5, fastest))
    path, places = free.x + 1j * free.y, (scaled.x + 1j * scaled.y)[::5]
    assert np.abs(path[:, None] - places).min(axis=0).max() < 0.15
    assert scaled.t[-1] > free.t[-1] - 0.05


# Chapter 13: other laws --------------------------------------------------------------------------


@few
@given(st.floats(0.1, 20.0), below_pi, below_pi, gains_drawn)
def test_under_the_barrier_law_no_angle_crosses_half_a_turn(rho, alpha, theta, gains):
    options = {"dt": 0.05, "duration": 10.0, "wheels": wmr.Wheels(0.4, 1.0)}
    run = driven((rho, alpha, theta), gains, "barrier", **options)
    assert max(np.abs(run.alpha).max(), np.abs(run.theta).max()) <= math.pi


@several
@given(errors(0.5, 3.0), st.floats(1.0, 2.0), st.sampled_from([0.5, 0.7, 1.4, 2.0]))
def test_near_the_goal_only_the_slower_power_of_graceful_remains(error, k_phi, ratio):
    gains, ends = wmr.Gains(2.0, ratio * k_phi, k_phi, 1.0), []
    for radius in (1e-3, 1e-4):
        run = driven(error, gains, "graceful", arrival_radius=radius, duration=600.0)
        ends.append(math.hypot(run.alpha[-1], run.theta[-1]))
    power = math.log10(ends[0] / ends[1])
    assert 0.8 < power / min(k_phi, gains.k_alpha) < 1.2


@given(st.floats(0.2, 5.0), st.floats(0.2, 5.0), st.floats(0.1, 6.0))
def test_parking_at_a_given_speed_lets_the_angles_fall_at_least_by_the_smaller_gain(c_1, c_2, s):
    remaining = np.linalg.norm(expm(np.array([[-c_1, 1.0], [-1.0, -c_2]]) * s), 2)
    assert remaining <= math.exp(-min(c_1, c_2) * s) * (1.0 + 1e-9)


@few
@given(
    law=st.sampled_from(["corrected", "printed", "aicardi", "graceful"]),
    seed=st.integers(0, 10**6),
    width=st.floats(0.2, 0.6),
    fastest=st.floats(0.3, 1.0),
)
def test_a_dock_is_entered_backwards_sooner_from_every_start_past_it(law, seed, width, fastest):
    random = np.random.default_rng(seed)
    x, (y, heading) = random.uniform(1.8, 2.2, 200), random.uniform(-0.4, 0.4, (2, 200))
    tuned = {"aicardi": wmr.Gains(0.8, 3.2, 4.0, 1.0), "graceful": wmr.Gains(1.0, 2.0, 3.0, 1.0)}
    options = {"law": law, "method": "arc", "dt": 0.02, "wheels": wmr.Wheels(width, fastest)}
    forwards, backwards = (
        wmr.sweep(
            wmr.Pose(x, y, heading + turn),
            wmr.Pose(0.0, 0.0, turn),
            tuned.get(law, DESIGNED),
            progress=False,
            **options,
        )
        for turn in (0.0, math.pi)
    )
    assert (backwards.time < forwards.time).all()
