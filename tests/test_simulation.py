"""Runs against the continuous oracle, by property, over a grid of starts and goals, and at the edges."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import wmrlib as wmr
from wmrlib.runs import MOST_SAMPLES

ORIGIN = wmr.Pose(0.0, 0.0, 0.0)
PAPER = wmr.paper.outdoor()
CALM = wmr.Gains(
    k_rho=0.4, k_alpha=2.0, h=0.6, v_max=2.0
)  # near the goal: distance rate 0.8/s, heading 1/s, damping 1.6
SETTLING = wmr.Gains(
    k_rho=0.1, k_alpha=2.0, h=6.0, v_max=4.0
)  # near the goal: distance rate 0.4/s, heading 1/s, damping 1.02
METHODS = ("euler", "arc", "continuous")
LAWS = ("corrected", "printed", "aicardi")
metres = st.floats(-20.0, 20.0)
headings = st.floats(-math.pi, math.pi)
poses = st.builds(wmr.Pose, metres, metres, headings)
gains_drawn = st.builds(
    wmr.Gains, st.floats(0.05, 1.0), st.floats(0.5, 3.0), st.floats(0.05, 2.0), st.floats(0.5, 4.0)
)


# The final heading, which peers forget to test -----------------------------------------------------------------------


def test_final_pose_over_a_grid_of_starts_and_goals():
    """768 runs: 8 directions to the goal (straight behind included), 8 start headings, 6 goal headings, 2 distances."""
    bearing, start, end, distance = np.meshgrid(
        np.arange(8) * math.pi / 4,
        np.arange(8) * math.pi / 4,
        np.arange(6) * math.pi / 3,
        [2.0, 30.0],
        indexing="ij",
    )
    goals = wmr.Pose(distance * np.cos(bearing), distance * np.sin(bearing), end)
    alpha = wmr.polar_error(wmr.Pose(0.0, 0.0, start), goals).alpha
    assert np.isclose(np.abs(alpha), math.pi).sum() >= 90  # goals straight behind
    runs = wmr.sweep(
        wmr.Pose(0.0, 0.0, start), goals, SETTLING, dt=0.05, duration=120.0, arrival_radius=0.01
    )
    assert runs.arrived.all()
    assert np.abs(runs.heading_error).max() < math.radians(1.0)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("heading", [0.0, 2.0, math.pi])
def test_goal_straight_behind(method, heading):
    goal = wmr.Pose(-5.0 * math.cos(heading), -5.0 * math.sin(heading), heading)
    run = wmr.simulate(
        wmr.Pose(0, 0, heading),
        goal,
        SETTLING,
        method=method,
        dt=0.02,
        duration=60.0,
        arrival_radius=0.01,
    )
    assert run.outcome is wmr.Outcome.ARRIVED
    assert abs(run.heading_error[-1]) < math.radians(1.0)
    assert run.v[0] < 0.0  # it backs up while it turns round


# The oracle ----------------------------------------------------------------------------------------------------------


@settings(max_examples=60)
@given(poses, poses, gains_drawn)
def test_v_never_rises_in_continuous(start, goal, gains):
    run = wmr.simulate(start, goal, gains, method="continuous", duration=30.0)
    assert np.diff(run.V).max(initial=0.0) <= 1e-9 * run.V[0]


@settings(max_examples=30)
@given(poses, poses, gains_drawn)
def test_continuous_is_the_motion_of_the_pose(start, goal, gains):
    """Its (rho, alpha, theta) give poses whose own polar error is the same, and which roll along their heading at v."""
    run = wmr.simulate(
        start, goal, gains, method="continuous", dt=0.01, duration=5.0, arrival_radius=0.2
    )
    assume(len(run) > 10)
    seen = wmr.polar_error(wmr.Pose(run.x, run.y, run.heading), goal)
    assert seen.rho == pytest.approx(run.rho, abs=1e-9)
    assert np.abs(wmr.wrap_angle(seen.alpha - run.alpha)).max() < 1e-8
    dx, dy, dt = np.diff(run.x)[:-1], np.diff(run.y)[:-1], run.t[1]
    along = 0.5 * (run.v[1:-1] + run.v[:-2])
    middle = run.heading[:-2] + 0.5 * wmr.wrap_angle(run.heading[1:-1] - run.heading[:-2])
    limit = 0.2 * dt * (1 + gains.v_max) * (1 + np.abs(run.omega).max()) ** 2 * dt
    assert (
        np.hypot(dx - along * np.cos(middle) * dt, dy - along * np.sin(middle) * dt).max() < limit
    )


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("method", ["euler", "arc"])
@settings(max_examples=15)
@given(start=poses, heading=headings)
def test_sampled_methods_converge_to_continuous(method, law, start, heading):
    """Halving dt twice divides the largest deviation by about four, on the way to 0.5 m from the goal."""
    goal = wmr.Pose(0.0, 0.0, heading)
    oracle = wmr.simulate(
        start, goal, CALM, law=law, method="continuous", dt=0.08, duration=8.0, arrival_radius=0.5
    )
    assume(
        len(oracle) > 10 and np.abs(oracle.theta).max() < 3.0 and np.abs(oracle.alpha).max() < 3.0
    )  # no wrap on the way

    def deviation(dt):
        every = round(0.08 / dt)
        run = wmr.simulate(
            start, goal, CALM, law=law, method=method, dt=dt, duration=8.0, arrival_radius=0.3
        )
        last = min((len(run) - 1) // every, len(oracle) - 2)
        return np.hypot(
            run.x[: last * every + 1 : every] - oracle.x[: last + 1],
            run.y[: last * every + 1 : every] - oracle.y[: last + 1],
        ).max()

    coarse, fine = deviation(0.02), deviation(0.005)
    assert fine < 0.05
    assert fine < 0.35 * coarse + 1e-9


@settings(max_examples=40)
@given(
    poses,
    poses,
    gains_drawn,
    st.sampled_from(["corrected", "aicardi"]),
    st.sampled_from(["euler", "arc"]),
)
def test_mirrored_starts_give_mirrored_paths(start, goal, gains, law, method):
    assume(abs(start.y - goal.y) > 1e-3 or abs(start.x - goal.x) > 1e-3)
    mirrored = [wmr.Pose(pose.x, -pose.y, -pose.heading) for pose in (start, goal)]
    run, image = (
        wmr.simulate(*ends, gains, law=law, method=method, duration=5.0, arrival_radius=0.3)
        for ends in ((start, goal), mirrored)
    )
    assume(
        math.pi - np.abs(run.alpha).max() > 1e-6 and math.pi - np.abs(run.theta).max() > 1e-6
    )  # at pi itself left and right are one
    assert len(run) == len(image)
    assert image.x == pytest.approx(run.x, abs=1e-6)
    assert image.y == pytest.approx(-run.y, abs=1e-6)
    assert image.omega == pytest.approx(-run.omega, abs=1e-6)


@settings(max_examples=30)
@given(poses, poses, st.floats(-math.pi, math.pi), metres, metres)
def test_the_frame_does_not_matter(start, goal, turn, east, north):
    """Turning and shifting the map turns and shifts the path."""

    def moved(pose):
        x, y = (
            pose.x * math.cos(turn) - pose.y * math.sin(turn) + east,
            pose.x * math.sin(turn) + pose.y * math.cos(turn) + north,
        )
        return wmr.Pose(x, y, pose.heading + turn)

    run = wmr.simulate(start, goal, CALM, duration=5.0, arrival_radius=0.3)
    assume(
        len(run) > 1
        and math.pi - np.abs(run.alpha).max() > 1e-6
        and math.pi - np.abs(run.theta).max() > 1e-6
    )
    again = wmr.simulate(moved(start), moved(goal), CALM, duration=5.0, arrival_radius=0.3)
    assert again.rho == pytest.approx(run.rho, abs=1e-6)


# What a Trajectory holds ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("law", LAWS)
def test_columns_agree_with_the_public_functions(law, method):
    run = wmr.simulate(PAPER.start, PAPER.goal, CALM, law=law, method=method, duration=3.0)
    assert len(run) == 31
    assert run.t == pytest.approx(np.arange(31) * 0.1, abs=1e-12)
    polar = wmr.polar_error(wmr.Pose(run.x, run.y, run.heading), PAPER.goal)
    for name in ("rho", "alpha", "theta"):
        assert getattr(polar, name) == pytest.approx(getattr(run, name), abs=1e-9)
    v, omega = wmr.control_law(run.rho, run.alpha, run.theta, CALM, law)
    assert (run.v, run.omega) == (pytest.approx(v), pytest.approx(omega))
    assert pytest.approx(wmr.lyapunov(run.rho, run.alpha, run.theta, CALM.h)) == run.V
    assert (run.x_error[0], run.y_error[0]) == (
        pytest.approx(PAPER.goal.x),
        pytest.approx(PAPER.goal.y),
    )
    assert run.heading_error == pytest.approx(
        wmr.wrap_angle(run.heading - PAPER.goal.heading), abs=1e-9
    )


@pytest.mark.parametrize("method", ["euler", "arc"])
def test_samples_follow_from_each_other(method):
    """The loop of the kernel, written once more with the public functions."""
    run, pose = wmr.simulate(PAPER.start, PAPER.goal, PAPER.gains, method=method), PAPER.start
    for k in range(len(run)):
        assert (run.x[k], run.y[k]) == (
            pytest.approx(pose.x, abs=1e-8),
            pytest.approx(pose.y, abs=1e-8),
        )
        v, omega = wmr.control_law(*wmr.polar_error(pose, PAPER.goal), PAPER.gains)
        pose = wmr.advance(pose, v, omega, 0.1, method)


def test_arrays_cannot_be_written_to():
    run = wmr.simulate(PAPER.start, PAPER.goal, PAPER.gains)
    for name in ("t", "x", "V"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(run, name)[0] = 1.0


def test_repr_says_how_it_ended():
    run = wmr.simulate(PAPER.start, PAPER.goal, PAPER.gains, method="continuous")
    assert repr(run).startswith(
        "<Trajectory: corrected law, continuous, 157 samples, 0.05 m from the goal after 15.52 s: arrived"
    )


# Outcomes and edges --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("method", METHODS)
def test_start_on_the_goal(method):
    run = wmr.simulate(ORIGIN, ORIGIN, CALM, method=method)
    assert (len(run), run.outcome, run.t[0], run.rho[0]) == (1, wmr.Outcome.ARRIVED, 0.0, 0.0)
    assert np.isfinite([run.v[0], run.omega[0], run.V[0]]).all()


@pytest.mark.parametrize("method", METHODS)
def test_time_runs_out(method):
    run = wmr.simulate(ORIGIN, wmr.Pose(1e3, 0, 0), CALM, method=method, duration=2.0)
    assert (run.outcome, run.outcome.message) == (
        wmr.Outcome.TIMED_OUT,
        "did not arrive within the duration",
    )
    assert run.t[-1] == pytest.approx(2.0)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("law", LAWS)
def test_radius_zero_drives_on_and_stays_finite(method, law):
    run = wmr.simulate(
        wmr.Pose(-3, 1, 0.5),
        ORIGIN,
        CALM,
        law=law,
        method=method,
        arrival_radius=0.0,
        duration=60.0,
    )
    assert run.outcome is wmr.Outcome.TIMED_OUT
    assert np.isfinite(
        [run.x, run.y, run.heading, run.rho, run.alpha, run.theta, run.v, run.omega, run.V]
    ).all()


def test_absurd_gains_end_before_a_nan():
    run = wmr.simulate(ORIGIN, wmr.Pose(5.0, 1.0, 0.0), wmr.Gains(1e308, 1e308, 1e308, 1e308))
    assert run.outcome is wmr.Outcome.DIVERGED
    assert np.isfinite(run.rho).all()
    assert repr(run)


def test_duration_is_reached_although_tenths_are_not_exact():
    assert len(wmr.simulate(ORIGIN, wmr.Pose(1e3, 0, 0), CALM, dt=0.1, duration=0.3)) == 4
    assert len(wmr.simulate(ORIGIN, wmr.Pose(1e3, 0, 0), CALM, dt=0.3, duration=1.0)) == 4


def test_wheel_limits_bind_and_keep_the_curvature():
    limits = wmr.WheelLimits(track_width=0.5, max_speed=1.0)
    run = wmr.simulate(PAPER.start, PAPER.goal, PAPER.gains, wheels=limits, duration=120.0)
    wheels = np.abs(wmr.twist_to_wheels(run.v, run.omega, 0.5))
    assert wheels.max() == pytest.approx(1.0)
    v, omega = wmr.control_law(run.rho, run.alpha, run.theta, PAPER.gains)
    assert run.v * omega == pytest.approx(run.omega * v, abs=1e-9)
    slow = wmr.simulate(
        PAPER.start, PAPER.goal, PAPER.gains, wheels=limits, method="continuous", duration=120.0
    )
    assert slow.outcome is wmr.Outcome.ARRIVED
    assert np.abs(wmr.twist_to_wheels(slow.v, slow.omega, 0.5)).max() <= 1.0 + 1e-12


def test_continuous_turns_no_faster_than_its_wheels():
    """Small steps, each limited by itself, as the second method; the limits bind all the way through the turn."""
    ends, limits = (
        (wmr.Pose(0.0, 0.0, 2.5), wmr.Pose(5.0, 1.0, 0.0)),
        wmr.WheelLimits(track_width=0.8, max_speed=0.6),
    )
    oracle = wmr.simulate(*ends, CALM, wheels=limits, method="continuous", dt=0.1, duration=6.0)
    small = wmr.simulate(*ends, CALM, wheels=limits, dt=0.001, duration=6.0)
    assert np.hypot(small.x[::100] - oracle.x, small.y[::100] - oracle.y).max() < 0.01
    assert np.abs(wmr.wrap_angle(small.heading[::100] - oracle.heading)).max() < 0.01


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"dt": 0.0}, r"dt = 0\.0 is not allowed: a finite number above 0 is needed"),
        ({"dt": math.nan}, r"dt = nan"),
        ({"duration": -1.0}, r"duration = -1\.0"),
        (
            {"dt": 2.0, "duration": 1.0},
            r"dt = 2 is not allowed: at most the duration, 1, is needed",
        ),
        (
            {"dt": 1e-9},
            rf"duration = 60 is not allowed: at most {MOST_SAMPLES:,} steps of dt = 1e-09",
        ),
        ({"arrival_radius": -0.1}, r"arrival_radius = -0\.1"),
        (
            {"arrival_radius": [0.1, 0.2]},
            r"arrival_radius = \[0\.1, 0\.2\] .* one number is needed, not an array of shape \(2,\)",
        ),
        (
            {"law": "kanayama"},
            r"law = 'kanayama' is not allowed: one of 'corrected', 'printed', 'aicardi'",
        ),
        ({"method": "rk4"}, r"method = 'rk4' is not allowed: one of 'euler', 'arc', 'continuous'"),
        ({"start": (0, 0, 0)}, r"start = \(0, 0, 0\) .* a Pose is needed"),
        (
            {"goal": wmr.Pose([1.0, 2.0], 0, 0)},
            r"goal\.x = array.* one number is needed; sweep takes arrays",
        ),
        (
            {"gains": wmr.Gains([1.0, 2.0], 1, 1)},
            r"one number a gain is needed; sweep takes arrays of gains",
        ),
        ({"wheels": 1.0}, r"wheels = 1\.0 .* a WheelLimits is needed, not a float"),
        (
            {"wheels": wmr.WheelLimits(np.array([0.5, 0.6]), 2.0)},
            r"wheels\.track_width = .* one number is needed, not an array",
        ),
    ],
)
def test_bad_input_names_argument_value_and_range(options, message):
    arguments = {"start": ORIGIN, "goal": wmr.Pose(1, 1, 0), "gains": CALM} | options
    with pytest.raises(ValueError, match=message):
        wmr.simulate(
            arguments.pop("start"), arguments.pop("goal"), arguments.pop("gains"), **arguments
        )


@pytest.mark.parametrize("method", METHODS)
def test_whole_numbers_give_the_same_samples_in_the_same_type(method):
    whole, exact = (
        wmr.simulate(ORIGIN, wmr.Pose(5, 1, 0), CALM, method=method, dt=dt, duration=5 * dt)
        for dt in (1, 1.0)
    )
    assert whole.t.dtype == exact.t.dtype == np.float64
    np.testing.assert_array_equal(whole.t, exact.t)
    np.testing.assert_array_equal(whole.x, exact.x)
    assert circle(method=method, dt=1).t.dtype == np.float64


# Moving references ---------------------------------------------------------------------------------------------------


def circle(law="corrected", gains=wmr.paper.CIRCLE_GAINS, **options):
    return wmr.track(
        wmr.paper.circle, wmr.paper.CIRCLE_START, gains, law=law, **{"duration": 40.0} | options
    )


@pytest.mark.parametrize("method", METHODS)
def test_following_the_circle_to_the_end(method):
    run = circle(method=method)
    assert (run.outcome, len(run)) == (wmr.Outcome.COMPLETED, 401)
    assert (run.x_error[0], run.y_error[0]) == (-1.0, -2.0)
    assert run.goal.x[-1] == pytest.approx(0.0, abs=1e-12)
    assert np.hypot(run.x_error, run.y_error) == pytest.approx(run.rho, abs=1e-9)


@pytest.mark.parametrize("law", LAWS)
def test_sampled_tracking_converges_to_continuous(law):
    oracle = circle(law, method="continuous", duration=10.0)
    coarse, fine = (
        np.hypot(run.x[:: round(0.1 / dt)] - oracle.x, run.y[:: round(0.1 / dt)] - oracle.y).max()
        for dt, run in ((dt, circle(law, dt=dt, duration=10.0)) for dt in (0.01, 0.0025))
    )
    assert fine < 0.35 * coarse < 0.05


@pytest.mark.parametrize("method", METHODS)
def test_feed_forward_leaves_no_residual(method):
    run = circle(
        "kanayama", wmr.KanayamaGains(k_x=1.0, k_y=2.0, k_heading=2.0), method=method, duration=80.0
    )
    assert wmr.residual(run) < (
        0.02 if method == "euler" else 0.01
    )  # what is left is the step: the reference turns while v is held
    smaller = circle("kanayama", wmr.KanayamaGains(1.0, 2.0, 2.0), dt=0.01, duration=80.0)
    assert wmr.residual(smaller) < 1e-3


def test_lqr_on_the_error_in_the_robots_frame_leaves_no_residual():
    import control

    v, omega = wmr.paper.CIRCLE_SPEED, 2 * math.pi / wmr.paper.CIRCLE_PERIOD
    matrix, _, _ = control.lqr(
        [[0, omega, 0], [-omega, 0, v], [0, 0, 0]], [[-1, 0], [0, 0], [0, -1]], np.eye(3), np.eye(2)
    )
    run = circle("linear", wmr.LinearGains(-matrix), dt=0.01, duration=80.0)
    assert wmr.residual(run) < 1e-3
    assert run.V[-1] < 1e-5 * run.V[0]


def test_a_goal_that_stands_still_is_a_reference_too():
    def still(t):
        return wmr.Reference(PAPER.goal.x + 0 * t, PAPER.goal.y, PAPER.goal.heading, 0.0, 0.0)

    tracked = wmr.track(still, PAPER.start, PAPER.gains, duration=10.0)
    driven = wmr.simulate(PAPER.start, PAPER.goal, PAPER.gains, duration=10.0)
    assert np.array_equal(tracked.x, driven.x)
    assert np.array_equal(tracked.V, driven.V)


@pytest.mark.parametrize(
    ("reference", "options", "message"),
    [
        (lambda t: (t, t), {}, r"a Reference is needed, not a tuple"),
        (lambda t: wmr.Reference(t, t, t, math.nan * t, t), {}, r"reference\(t\)\.v = "),
        (wmr.paper.circle, {"law": "kanayama"}, r"a KanayamaGains is needed, not a Gains"),
        (
            wmr.paper.circle,
            {"law": "lqr"},
            r"law = 'lqr' .* 'aicardi', 'kanayama', 'linear' is needed",
        ),
    ],
)
def test_bad_reference(reference, options, message):
    with pytest.raises(ValueError, match=message):
        wmr.track(reference, ORIGIN, CALM, **options)


# Wheels that lag -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("gains", [PAPER.gains, CALM])
def test_lagging_wheels_are_the_motion_of_the_pose_and_of_each_wheel(gains):
    """Against the two wheels' speeds and the pose itself, integrated by another method."""
    lag, width = 0.1, 0.5
    run = wmr.simulate(
        PAPER.start,
        PAPER.goal,
        gains,
        method="continuous",
        wheel_lag=lag,
        duration=10.0,
        wheels=wmr.WheelLimits(width, 3.0),
    )

    def rate(_, state):
        x, y, heading, left, right = state
        wanted = wmr.control_law(*wmr.polar_error(wmr.Pose(x, y, heading), PAPER.goal), gains)
        wanted = wmr.twist_to_wheels(*wmr.limit_wheels(*wanted, wmr.WheelLimits(width, 3.0)), width)
        motion = wmr.pose_rate(heading, *wmr.wheels_to_twist(left, right, width))
        return *motion, (wanted[0] - left) / lag, (wanted[1] - right) / lag

    other = solve_ivp(
        rate, (0.0, 10.0), (*PAPER.start, 0.0, 0.0), t_eval=run.t, rtol=1e-7, atol=1e-9
    ).y
    v, omega = wmr.wheels_to_twist(other[3], other[4], width)
    np.testing.assert_allclose(run.x, other[0], atol=1e-4)
    np.testing.assert_allclose(run.y, other[1], atol=1e-4)
    np.testing.assert_allclose(run.v, v, atol=1e-4)
    np.testing.assert_allclose(run.omega, omega, atol=1e-4)
    assert (run.v[0], run.omega[0]) == (0.0, 0.0)


def test_quick_wheels_are_wheels_without_a_lag():
    at_once = wmr.arrival(wmr.simulate(PAPER.start, PAPER.goal, CALM, method="continuous"))
    late = [
        wmr.arrival(wmr.simulate(PAPER.start, PAPER.goal, CALM, method="continuous", wheel_lag=lag))
        for lag in (0.02, 0.01)
    ]
    off = [abs(each.heading_error - at_once.heading_error) for each in late]
    assert off[0] < math.radians(1.0)
    assert off[0] / off[1] == pytest.approx(2.0, rel=0.15)


@pytest.mark.parametrize("ratio", [10.0, 20.0])
def test_lagging_wheels_settle_or_not_as_their_poles_say(ratio):
    """The paper's gains: with wheels ten times faster than the distance settles, the heading does not settle."""
    k_rho, k_alpha, h, v_max = PAPER.gains
    rate = k_rho * v_max
    bandwidth = ratio * rate
    closing = (
        0.5 * bandwidth * (1.0 - math.sqrt(1.0 - 4.0 / ratio))
    )  # rho'' + bandwidth rho' + bandwidth rate rho = 0
    angles = np.array(
        [
            [closing, 0.0, -1.0],
            [closing, 0.0, 0.0],
            [bandwidth * (k_alpha + rate), bandwidth * rate * h, -bandwidth],
        ]
    )
    growth = np.linalg.eigvals(angles).real.max()
    dt, start = 0.02, wmr.Pose(-1e-3, 0.0, 1e-3)
    run = wmr.simulate(
        start,
        ORIGIN,
        PAPER.gains,
        method="continuous",
        wheel_lag=1.0 / bandwidth,
        dt=dt,
        arrival_radius=1e-8,
    )
    theta = run.theta[
        10:-1
    ]  # when the fast poles have died out, theta[k + 2] = (z1 + z2) theta[k + 1] - z1 z2 theta[k]
    _, minus_product = np.linalg.lstsq(
        np.column_stack([theta[1:-1], theta[:-2]]), theta[2:], rcond=None
    )[0]
    assert 0.5 * math.log(-minus_product) / dt == pytest.approx(growth, abs=0.02)
    assert (growth > 0.0) == (ratio == 10.0)


def test_start_on_the_goal_with_lagging_wheels():
    run = wmr.simulate(ORIGIN, ORIGIN, CALM, method="continuous", wheel_lag=0.1)
    assert (len(run), run.v[0], run.omega[0]) == (1, 0.0, 0.0)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (
            {"wheel_lag": 0.1},
            r'wheel_lag = 0\.1 is not allowed: 0, or method "continuous" with an arrival radius, is needed',
        ),
        (
            {"wheel_lag": 0.1, "method": "continuous", "arrival_radius": 0.0},
            r"wheel_lag = 0\.1 is not allowed",
        ),
        (
            {"wheel_lag": -0.1, "method": "continuous"},
            r"wheel_lag = -0\.1 is not allowed: a finite number at least 0 is needed",
        ),
    ],
)
def test_bad_lags(options, message):
    with pytest.raises(ValueError, match=message):
        wmr.simulate(PAPER.start, PAPER.goal, PAPER.gains, **options)


# Many runs -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("method", ["euler", "arc"])
def test_every_entry_of_a_sweep_is_the_run_alone(law, method):
    starts = wmr.Pose(np.array([-3.0, 1.0, 0.0])[:, None], 1.0, 0.5)
    gains = wmr.Gains(np.array([0.4, 2.0]), 2.0, 0.6, 2.0)
    runs = wmr.sweep(starts, ORIGIN, gains, law=law, method=method, duration=8.0)
    assert runs.time.shape == (3, 2)
    for i in range(3):
        for j in range(2):
            single = wmr.simulate(
                wmr.Pose(float(starts.x[i, 0]), 1.0, 0.5),
                ORIGIN,
                wmr.Gains([0.4, 2.0][j], 2.0, 0.6, 2.0),
                law=law,
                method=method,
                duration=8.0,
            )
            assert tuple(field[i, j] for field in runs) == pytest.approx(
                tuple(wmr.arrival(single)), rel=1e-12, abs=1e-12
            )


def test_a_sweep_of_one_gives_numbers():
    one = wmr.sweep(PAPER.start, PAPER.goal, PAPER.gains, method="arc")
    assert one == pytest.approx(wmr.arrival(wmr.simulate(PAPER.start, PAPER.goal, PAPER.gains)))
    assert {type(field) for field in one} == {bool, float}


def test_sweep_refuses_shapes_that_do_not_broadcast():
    with pytest.raises(
        ValueError,
        match=r"mismatched lengths: starts\.x has shape \(2,\), gains\.h has shape \(3,\)",
    ):
        wmr.sweep(wmr.Pose([0.0, 1.0], 0, 0), PAPER.goal, wmr.Gains(1.0, 1.0, [1.0, 2.0, 3.0]))
