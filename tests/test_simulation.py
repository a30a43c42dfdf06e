"""Runs against the continuous oracle, by property, from all sides, and at the edges."""

import copy
import math
import pickle
from decimal import Decimal
from fractions import Fraction
from itertools import product

import mpmath
import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import wmrlib as wmr
from wmrbook.chapters import routes
from wmrlib.laws import LAWS, POSE_LAWS

ORIGIN = wmr.Pose(0.0, 0.0, 0.0)
PAPER = wmr.paper.outdoor()
FAR = wmr.Pose(1e3, 0.0, 0.0)
# Near the goal: distance rate 0.8/s, heading 1/s, damping 1.6; and 0.4/s, 1/s, 1.02.
CALM = wmr.Gains(k_rho=0.4, k_alpha=2.0, h=0.6, v_max=2.0)
SETTLING = wmr.Gains(k_rho=0.1, k_alpha=2.0, h=6.0, v_max=4.0)
METHODS = ("euler", "arc", "continuous")
metres = st.floats(-20.0, 20.0)
headings = st.floats(-math.pi, math.pi)
poses = st.builds(wmr.Pose, metres, metres, headings)
gains_drawn = st.builds(
    wmr.Gains, st.floats(0.05, 1.0), st.floats(0.5, 3.0), st.floats(0.05, 2.0), st.floats(0.5, 4.0)
)


def clear_of_pi(run):
    """At pi itself left and right are one."""
    return math.pi - max(np.abs(run.alpha).max(), np.abs(run.theta).max()) > 1e-6


def circle(law="corrected", gains=wmr.paper.CIRCLE_GAINS, **options):
    options = {"law": law, "duration": 40.0} | options
    return wmr.track(wmr.paper.circle, wmr.paper.CIRCLE_START, gains, **options)


# The final heading, which peers forget to test ---------------------------------------------------


def test_final_pose_over_a_grid_of_starts_and_goals():
    """768 runs: 8 directions to the goal, 8 headings at the start, 6 at the goal, 2 distances."""
    eighths = np.arange(8) * math.pi / 4
    ends = np.arange(6) * math.pi / 3
    bearing, start, end, distance = np.meshgrid(eighths, eighths, ends, [2.0, 30.0])
    goals = wmr.Pose(distance * np.cos(bearing), distance * np.sin(bearing), end)
    starts = wmr.Pose(0.0, 0.0, start)
    behind = np.isclose(np.abs(wmr.polar_error(starts, goals).alpha), math.pi)
    assert behind.sum() >= 90
    options = {"dt": 0.05, "duration": 120.0, "arrival_radius": 0.01}
    runs = wmr.sweep(starts, goals, SETTLING, **options)
    assert runs.arrived.all()
    assert np.abs(runs.heading_error).max() < math.radians(1.0)
    for method, heading in product(METHODS, (0.0, 2.0, math.pi)):
        goal = wmr.Pose(-5.0 * math.cos(heading), -5.0 * math.sin(heading), heading)
        start = wmr.Pose(0, 0, heading)
        run = wmr.simulate(start, goal, SETTLING, method=method, **options | {"dt": 0.02})
        assert run.outcome is wmr.Outcome.ARRIVED
        assert abs(run.heading_error[-1]) < math.radians(1.0)
        assert run.v[0] < 0.0  # it backs up while it turns round


# The oracle --------------------------------------------------------------------------------------


@pytest.mark.parametrize("method", ["euler", "arc"])
@settings(max_examples=40)
@given(law=st.sampled_from(tuple(POSE_LAWS)), start=poses, heading=headings)
def test_sampled_methods_converge_to_continuous(method, law, start, heading):
    """Halving dt twice divides the largest deviation by about four, up to 0.5 m from the goal."""
    goal, options = wmr.Pose(0.0, 0.0, heading), {"law": law, "duration": 8.0}
    more = options | {"method": "continuous", "dt": 0.08, "arrival_radius": 0.5}
    oracle = wmr.simulate(start, goal, CALM, **more)
    angles = np.abs([oracle.alpha, oracle.theta])
    assume(len(oracle) > 10 and angles.max() < 3.0)  # no wrap on the way

    def deviation(dt):
        more = options | {"method": method, "dt": dt, "arrival_radius": 0.3}
        run, every = wmr.simulate(start, goal, CALM, **more), round(0.08 / dt)
        count = 1 + min((len(run) - 1) // every, len(oracle) - 2)
        x, y = run.x[::every][:count], run.y[::every][:count]
        return np.hypot(x - oracle.x[:count], y - oracle.y[:count]).max()

    coarse, fine = deviation(0.02), deviation(0.005)
    assert fine < 0.05
    assert fine < 0.35 * coarse + 1e-9


# What a Trajectory holds -------------------------------------------------------------------------


@pytest.mark.parametrize("method", METHODS)
def test_columns_agree_with_the_public_functions(method):
    goal = PAPER.goal._replace(heading=1.0)
    for law in POSE_LAWS:
        run = wmr.simulate(PAPER.start, goal, CALM, law=law, method=method, duration=3.0)
        assert run.t == pytest.approx(np.arange(31) * 0.1, abs=1e-12)
        polar = wmr.polar_error(wmr.Pose(run.x, run.y, run.heading), goal)
        for name in ("rho", "alpha", "theta"):
            assert getattr(polar, name) == pytest.approx(getattr(run, name), abs=1e-9)
        v, omega = wmr.control_law(run.rho, run.alpha, run.theta, CALM, law)
        assert (run.v, run.omega) == (pytest.approx(v), pytest.approx(omega))
        assert pytest.approx(LAWS[law].value(run.rho, run.alpha, run.theta, CALM)) == run.V
        assert run.x_error == pytest.approx(goal.x - run.x)
        assert run.y_error == pytest.approx(goal.y - run.y)
        error = wmr.wrap_angle(run.heading - goal.heading)
        assert run.heading_error == pytest.approx(error, abs=1e-9)


# Outcomes and edges ------------------------------------------------------------------------------


@pytest.mark.parametrize("method", METHODS)
def test_outcomes(method):
    run = wmr.simulate(ORIGIN, ORIGIN, CALM, method=method)
    assert (len(run), run.outcome, run.t[0], run.rho[0]) == (1, wmr.Outcome.ARRIVED, 0.0, 0.0)
    run = wmr.simulate(ORIGIN, FAR, CALM, method=method, duration=2.0)
    assert run.outcome is wmr.Outcome.TIMED_OUT
    assert run.outcome.value == "did not arrive within the duration"
    assert run.t[-1] == pytest.approx(2.0)
    start = wmr.Pose(-3.0, 0.0, 0.0)  # who is just on the radius has arrived
    free = wmr.simulate(start, ORIGIN, CALM, method=method, arrival_radius=0.0)
    for k in (0,) if method == "continuous" else (0, 1, 20):
        options = {"method": method, "arrival_radius": float(free.rho[k])}
        run = wmr.simulate(start, ORIGIN, CALM, **options)
        assert (len(run), run.outcome) == (k + 1, wmr.Outcome.ARRIVED)
        assert k or wmr.sweep(start, ORIGIN, CALM, **options)[:2] == (True, 0.0)
    for law in POSE_LAWS:  # without a radius it drives on, and stays finite
        options = {"law": law, "method": method, "arrival_radius": 0.0}
        run = wmr.simulate(wmr.Pose(-3, 1, 0.5), ORIGIN, CALM, **options)
        assert run.outcome is wmr.Outcome.TIMED_OUT
        samples = [getattr(run, name) for name in (*wmr.Trajectory.__slots__[:9], "V")]
        assert np.isfinite(samples).all()
    run = circle(method=method)
    assert (run.outcome, len(run)) == (wmr.Outcome.COMPLETED, 401)
    assert (run.x_error[0], run.y_error[0]) == (-1.0, -2.0)
    assert run.goal.x[-1] == pytest.approx(0.0, abs=1e-12)
    assert np.hypot(run.x_error, run.y_error) == pytest.approx(run.rho, abs=1e-9)


def test_absurd_gains_end_before_a_nan():
    absurd = wmr.Gains(1e308, 1e308, 1e308, 1e308)
    run = wmr.simulate(ORIGIN, wmr.Pose(5.0, 1.0, 0.0), absurd)
    assert run.outcome is wmr.Outcome.DIVERGED
    assert repr(run).endswith("0 samples, no sample: left the range of numbers>")
    run = wmr.simulate(PAPER.start, PAPER.goal, PAPER.gains, method="continuous")
    end = "157 samples, 0.05 m from the goal after 15.52 s: arrived within the arrival radius>"
    assert repr(run) == f"<Trajectory: corrected law, continuous, {end}"


@pytest.mark.parametrize("method", METHODS)
def test_places_beyond_the_squares_of_numbers(method):
    """The squares of 1e200 and 1e-200 are infinite and 0; their distances are not."""
    far = wmr.simulate(wmr.Pose(1e200, 1e200, 0.0), ORIGIN, CALM, method=method, duration=1.0)
    assert far.outcome is wmr.Outcome.TIMED_OUT
    assert far.rho == pytest.approx(math.sqrt(2.0) * 1e200)
    near = wmr.simulate(wmr.Pose(3e-200, 4e-200, 0.0), ORIGIN, CALM, method=method)
    assert near.rho == pytest.approx([5e-200], rel=1e-12, abs=0.0)
    ends = wmr.Pose(1e308, 0.0, 0.0), wmr.Pose(-1e308, 0.0, 0.0)
    beyond = wmr.simulate(*ends, CALM, method=method)
    wild = wmr.simulate(ORIGIN, ORIGIN, wmr.Gains(1e300, 1e300, 1e300, 1e300), method=method)
    for lost in (beyond, wild):
        assert (lost.outcome, len(lost)) == (wmr.Outcome.DIVERGED, 0)
        assert (lost.peak_omega, lost.path_length) == (0.0, 0.0)


TURNS = st.integers(-50, 50)


@settings(max_examples=8)
@given(poses, poses, TURNS, TURNS)
def test_a_heading_may_be_written_with_full_turns(start, goal, turns, goal_turns):
    assume(math.hypot(start.y - goal.y, start.x - goal.x) > 0.1)
    again, there = (
        pose._replace(heading=pose.heading + 2.0 * math.pi * count)
        for pose, count in ((start, turns), (goal, goal_turns))
    )
    for method in METHODS:
        options = {"method": method, "duration": 2.0}
        plain = wmr.simulate(start, goal, CALM, **options)
        turned = wmr.simulate(again, there, CALM, **options)
        assume(clear_of_pi(plain))
        assert np.all((-math.pi < turned.heading) & (turned.heading <= math.pi))
        assert np.abs(wmr.wrap_angle(turned.heading - plain.heading)).max() < 1e-9
        if method == "continuous":
            continue
        more = {"method": method, "duration": 2.0, "trajectories": True}
        summary, swept = wmr.sweep(again, there, CALM, **more)
        assert summary == pytest.approx(tuple(wmr.arrival(turned)), rel=1e-12)
        assert swept.heading[: len(turned)] == pytest.approx(turned.heading, rel=0, abs=1e-12)


def test_copies_of_a_run_are_the_run_and_stay_read_only():
    runs = [circle(duration=1.0), wmr.simulate(ORIGIN, FAR, CALM, duration=1.0)]
    route = routes.drive_route(wmr.Pose([0.0, 5.0], [0.0, 0.0], 0.0), CALM)
    for run in (*runs, route):
        copies = copy.copy(run), copy.deepcopy(run), pickle.loads(pickle.dumps(run))
        for again in (run, *copies):
            for name in type(run).__slots__:
                value, other = getattr(run, name), getattr(again, name)
                if isinstance(value, np.ndarray) or name in ("goal", "waypoints"):
                    np.testing.assert_array_equal(value, other)
                elif name != "legs":
                    assert value == other
                for part in other if name in ("goal", "waypoints") else [other]:
                    if isinstance(part, np.ndarray):
                        with pytest.raises(ValueError, match="read-only"):
                            part[0] = 1.0


HARD = [
    (wmr.Pose(-1.0, 0.0, math.pi), PAPER.gains, "corrected"),  # the goal straight behind
    (wmr.Pose(-1e-6, 1e-6, 2.0), PAPER.gains, "corrected"),
    (wmr.Pose(-3e4, 2e4, -1.0), PAPER.gains, "corrected"),
    (wmr.Pose(2.0, 0.0, 0.1), PAPER.gains, "corrected"),  # theta = pi
    (wmr.Pose(-0.1, 0.3, 2.0), wmr.Gains(3.0, 0.5, 4.0, 8.0), "corrected"),
    (wmr.Pose(-2.0, 1.0, 1.0), wmr.Gains(0.5, 40.0, 20.0, 4.0), "corrected"),
    (wmr.Pose(-2.0, 1.0, 1.0), wmr.Gains(0.01, 0.1, 0.0, 0.1), "corrected"),
    (wmr.Pose(-2.0, 1.0, 0.5), PAPER.gains, "printed"),
    (wmr.Pose(-2.0, -1.0, 2.5), wmr.Gains(2.0, 9.0, 5.0, 4.0), "aicardi"),
    (wmr.Pose(-1e-3, 0.0, -3.0), wmr.Gains(6.0, 1.0, 9.0, 4.0), "aicardi"),
]


@pytest.mark.parametrize(("start", "gains", "law"), HARD)
def test_continuous_against_taylor_series_at_thirty_digits(start, gains, law):
    """The law written once more, in mpmath, from the same polar error."""
    k_rho, k_alpha, h, v_max = map(mpmath.mpf, gains)

    def rate(_, state):
        rho, alpha, theta = state
        pull = k_rho if law == "aicardi" else -v_max * mpmath.expm1(-k_rho * rho) / rho
        v = pull * mpmath.cos(alpha)
        turning = v * mpmath.sin(alpha)
        steering = turning * (alpha + h * theta) / alpha
        if law == "printed":
            steering *= mpmath.cos(alpha) * mpmath.sin(alpha)
        return [-v * rho * mpmath.cos(alpha), turning - k_alpha * alpha - steering, turning]

    with mpmath.workdps(30):
        seen = map(mpmath.mpf, wmr.polar_error(start, ORIGIN))
        truth = mpmath.odefun(rate, 0, list(seen), tol=mpmath.mpf("1e-13"))(0.05)
        truth = np.array([float(number) for number in truth])
    options = {"law": law, "dt": 0.05, "duration": 0.05, "arrival_radius": 0.0}
    run = wmr.simulate(start, ORIGIN, gains, method="continuous", **options)
    end = [run.rho[-1], run.alpha[-1], run.theta[-1]]
    assert end == pytest.approx(truth, rel=1e-10, abs=1e-10)
    assert run.rho[-1] == pytest.approx(truth[0], rel=1e-10)


FAST = st.floats(0.0, 6.0).map(lambda power: 10.0**power)


@settings(max_examples=6)
@given(poses, st.builds(wmr.Gains, st.just(0.5), FAST, st.just(0.5), st.just(2.0)))
@example(wmr.Pose(-5.0, -2.0, 0.3), wmr.Gains(1e6, 1e6, 1e6))
def test_continuous_with_stiff_gains(start, gains):
    """Against Radau, which is made for stiff equations."""

    def rate(_, state):
        rho, alpha, theta = max(state[0], 1e-9), *state[1:]
        return wmr.polar_rate(rho, alpha, *wmr.control_law(rho, alpha, theta, gains))

    assume(math.hypot(start.x, start.y) > 0.1)
    options = {"method": "continuous", "dt": 0.25, "duration": 1.0}
    run = wmr.simulate(start, ORIGIN, gains, **options)
    times = {"t_eval": run.t, "rtol": 1e-9, "atol": 1e-12}
    truth = solve_ivp(rate, (0.0, run.t[-1]), wmr.polar_error(start, ORIGIN), "Radau", **times).y
    np.testing.assert_allclose([run.rho, run.alpha, run.theta], truth, atol=1e-7)


def test_stiff_gains_arrive_although_a_trial_step_passes_the_goal():
    ends = wmr.Pose(0.0, 0.0, 0.5), wmr.Pose(5.0, 3.0, 1.0)
    options = {"method": "continuous", "arrival_radius": 1e-3}
    run = wmr.simulate(*ends, wmr.Gains(1e6, 1e6, 1e6), **options)
    assert run.outcome is wmr.Outcome.ARRIVED


def test_a_run_that_takes_too_long_is_refused():
    """It truly turns round and round, 10,000 times a second."""
    restless = wmr.Gains(0.5, 1e3, 1e6, 1e6)
    with pytest.raises(ValueError, match=r"method = .continuous. .* more than 1,000,000 steps"):
        wmr.simulate(wmr.Pose(-5, 0, 1), ORIGIN, restless, method="continuous", arrival_radius=0.0)


def test_the_last_sample_is_at_the_duration_although_tenths_are_not_exact():
    assert len(wmr.simulate(ORIGIN, FAR, CALM, dt=0.1, duration=0.3)) == 4
    assert len(wmr.simulate(ORIGIN, FAR, CALM, dt=0.3, duration=1.0)) == 4
    for method in METHODS:
        options = {"method": method, "duration": 5}
        whole, exact = (wmr.simulate(ORIGIN, FAR, CALM, dt=dt, **options) for dt in (1, 1.0))
        assert whole.t.dtype == exact.t.dtype == circle(method=method, dt=1).t.dtype == np.float64
        np.testing.assert_array_equal([whole.t, whole.x], [exact.t, exact.x])


def test_wheel_limits_bind_and_keep_the_curvature():
    limits = wmr.Wheels(track_width=0.5, max_speed=1.0)
    for method in METHODS:
        options = {"method": method, "wheels": limits, "duration": 120.0}
        run = wmr.simulate(PAPER.start, PAPER.goal, PAPER.gains, **options)
        fastest = np.abs(wmr.twist_to_wheels(run.v, run.omega, 0.5)).max()
        assert fastest == pytest.approx(1.0)
        v, omega = wmr.control_law(run.rho, run.alpha, run.theta, PAPER.gains)
        assert run.v * omega == pytest.approx(run.omega * v, abs=1e-9)
        assert (v * run.v >= 0.0).all()


LAGGING = {"method": "continuous", "wheels": wmr.Wheels(1.0, lag=0.1)}
BAD = [
    ({"dt": 2, "duration": 1}, "dt = 2 is not allowed: at most the duration, 1, is needed"),
    ({"dt": 1e-9}, r"duration = 60\.0 .*: at most 10,000,000 steps of dt = 1e-09 is needed"),
    ({"arrival_radius": [0.1, 0.2]}, r"arrival_radius = \[0\.1, 0\.2\] .* one number is needed"),
    ({"law": "kanayama"}, f"law = 'kanayama' .*: one of {str(tuple(POSE_LAWS))[1:-1]}"),
    ({"method": "rk4"}, "method = 'rk4' .*: one of 'arc', 'euler', 'continuous'"),
    ({"goal": wmr.Pose([1.0], 0, 0)}, r"goal\.x = array.* one number is needed; sweep takes arr"),
    ({"gains": wmr.Gains([1.0], 1, 1)}, "one number a gain is needed; sweep takes arrays of gains"),
    ({"wheels": 1.0}, r"wheels = 1\.0 .* a Wheels is needed, not a float"),
    ({"wheels": wmr.Wheels([0.5], 2.0)}, r"wheels\.track_width = .* one number is needed"),
    (LAGGING | {"arrival_radius": 0.0}, "wheels = Wheels.*: ideal wheels, or a lag and an arrival"),
    ({"wheels": wmr.Wheels(1.0, lag=-0.1)}, r"wheels\.lag = -0\.1 .* at least 0 is needed"),
    (LAGGING | {"wheels": wmr.Wheels(1.0, acceleration=1.0)}, "ideal wheels, or a lag and an arr"),
    (LAGGING | {"wheels": wmr.Wheels(1.0, lag=0.1, dead_band=0.1)}, "neither dead_band nor enc"),
    (
        LAGGING | {"last_turn": wmr.LastTurn()},
        r"last_turn = LastTurn\(.*: None, or method 'arc' or 'euler'",
    ),
    ({"last_turn": wmr.LastTurn(), "arrival_radius": 0.0}, "with an arrival radius, is needed"),
    ({"last_turn": wmr.LastTurn(leave=np.array([2.0]))}, r"last_turn\.leave = .* one number is"),
    ({"last_turn": wmr.LastTurn(leave=0.9)}, r"last_turn\.leave = 0\.9 .* at least 1 is needed"),
    ({"last_turn": wmr.LastTurn(max_rate=0.1)}, r"max_rate = 0\.1 .*: at least min_rate, 0\.2,"),
    ({"last_turn": wmr.LastTurn(min_rate=0.5)}, r"min_rate = 0\.5 .*: at most two tolerances a st"),
    ({"wheels": wmr.Wheels(1.0, 0.5, min_speed=1.0)}, r"wheels\.min_speed = 1\.0 .*: at most max"),
]
BAD_TRACKS = [
    ({"reference": lambda t: (t, t)}, "a Reference is needed, not a tuple"),
    ({"reference": lambda t: wmr.Reference(t, t, t, math.nan * t, t)}, r"reference\(t\)\.v = "),
    ({"law": "kanayama"}, "a KanayamaGains is needed, not a Gains"),
    ({"law": "lqr"}, f"law = 'lqr' .*: one of {str(tuple(LAWS))[1:-1]}, or a function"),
    ({"start": wmr.Pose([1.0], 0, 0)}, r"start\.x = "),
]


def test_bad_input_names_argument_value_and_range():
    valid = {"start": ORIGIN, "goal": wmr.Pose(1, 1, 0), "gains": CALM}
    for options, message in BAD:
        with pytest.raises(ValueError, match=message):
            wmr.simulate(**valid | options)
    valid = {"reference": wmr.paper.circle, "start": ORIGIN, "gains": CALM}
    for options, message in BAD_TRACKS:
        with pytest.raises(ValueError, match=message):
            wmr.track(**valid | options)


# Moving references -------------------------------------------------------------------------------


def test_sampled_tracking_converges_to_continuous():
    for law in POSE_LAWS:
        oracle = circle(law, method="continuous", duration=10.0)
        off = []
        for every in (10, 40):
            run = circle(law, dt=0.1 / every, duration=10.0)
            off.append(np.hypot(run.x[::every] - oracle.x, run.y[::every] - oracle.y).max())
        assert off[1] < 0.35 * off[0] < 0.05


def test_samples_after_a_reference_lie_on_one_run_whatever_dt():
    """The run that scipy finds; and they say what the law sees and commands there."""

    def rate(t, pose):
        goal = wmr.paper.circle(np.array([t]))
        seen = wmr.polar_error(wmr.Pose(*pose), wmr.Pose(*(float(field[0]) for field in goal[:3])))
        return wmr.pose_rate(pose[2], *wmr.control_law(*seen, wmr.paper.CIRCLE_GAINS))

    fine, coarse = (circle(method="continuous", dt=dt) for dt in (0.1, 1.0))
    for name in ("x", "y", "heading", "rho", "alpha", "theta", "v", "omega", "V"):
        every = getattr(fine, name)[::10]
        np.testing.assert_allclose(every, getattr(coarse, name), rtol=1e-8, atol=1e-8)
    options = {"t_eval": fine.t, "rtol": 1e-11, "atol": 1e-12}
    x, y, heading = solve_ivp(rate, (0.0, 40.0), wmr.paper.CIRCLE_START, "DOP853", **options).y
    np.testing.assert_allclose([fine.x, fine.y], [x, y], atol=2e-9)
    assert np.abs(wmr.wrap_angle(fine.heading - heading)).max() < 2e-9
    seen = wmr.polar_error(wmr.Pose(fine.x, fine.y, fine.heading), fine.goal)
    np.testing.assert_allclose([fine.rho, fine.alpha, fine.theta], seen, atol=1e-12)
    commanded = wmr.control_law(*seen, wmr.paper.CIRCLE_GAINS)
    np.testing.assert_allclose([fine.v, fine.omega], commanded, rtol=1e-7, atol=1e-7)


def test_feed_forward_leaves_no_residual():
    gains = wmr.KanayamaGains(k_x=1.0, k_y=2.0, k_heading=2.0)
    # What is left is the step: the reference turns while v is held.
    for options, left in (
        ({"method": "euler"}, 0.02),
        ({"method": "arc"}, 0.01),
        ({"method": "continuous"}, 1e-3),
        ({"dt": 0.01}, 1e-3),
    ):
        run = circle("kanayama", gains, duration=80.0, **options)
        assert wmr.residual(run) < left
        turned = (1.0 - np.cos(run.heading_error)) / gains.k_y
        np.testing.assert_allclose(run.V, 0.5 * run.rho**2 + turned, atol=1e-12)


def test_lqr_on_the_error_in_the_robots_frame_leaves_no_residual():
    import control

    v, omega = wmr.paper.CIRCLE_SPEED, 2 * math.pi / wmr.paper.CIRCLE_PERIOD
    rates, inputs = [[0, omega, 0], [-omega, 0, v], [0, 0, 0]], [[-1, 0], [0, 0], [0, -1]]
    matrix, _, _ = control.lqr(rates, inputs, np.eye(3), np.eye(2))
    run = circle("linear", wmr.LinearGains(-matrix), dt=0.01, duration=80.0)
    assert wmr.residual(run) < 1e-3
    assert run.V[-1] < 1e-5 * run.V[0]
    np.testing.assert_allclose(run.V, 0.5 * (run.rho**2 + run.heading_error**2), atol=1e-12)


@pytest.mark.parametrize("method", METHODS)
def test_a_goal_that_stands_still_is_a_reference_too(method):
    """Backing up after it counts as way."""
    start, goal = wmr.Pose(-5.0, 1.0, 3.0), wmr.Pose(0.5, -0.2, 0.3)

    def still(t):
        return wmr.Reference(goal.x + 0.0 * t, goal.y, goal.heading, 0.0, 0.0)

    options = {"method": method, "duration": 2.0}
    tracked = wmr.track(still, start, CALM, **options)
    driven = wmr.simulate(start, goal, CALM, **options)
    assert tracked.v.min() < 0.0
    assert tracked.path_length == pytest.approx(driven.path_length, abs=1e-7)
    assert tracked.peak_omega == pytest.approx(driven.peak_omega, rel=1e-7)
    for name in ("x", "y", "heading", "rho", "v", "omega", "V"):
        ours, theirs = getattr(tracked, name), getattr(driven, name)
        np.testing.assert_allclose(ours, theirs, rtol=1e-10, atol=1e-10)


# Wheels that lag ---------------------------------------------------------------------------------


def test_lagging_wheels_are_the_motion_of_the_pose_and_of_each_wheel():
    """Against the two wheels' speeds and the pose itself, integrated by another method."""
    lag, limits = 0.1, wmr.Wheels(0.5, 3.0, lag=0.1)
    options = {"wheels": limits, "duration": 10.0}

    def rate(_, state, gains):
        x, y, heading, left, right = state
        wanted = wmr.control_law(*wmr.polar_error(wmr.Pose(x, y, heading), PAPER.goal), gains)
        wanted = wmr.twist_to_wheels(*wmr.limit_wheels(*wanted, limits), limits.track_width)
        twist = wmr.wheels_to_twist(left, right, limits.track_width)
        motion = wmr.pose_rate(heading, *twist)
        return *motion, (wanted[0] - left) / lag, (wanted[1] - right) / lag

    for gains in (PAPER.gains, CALM):
        run = wmr.simulate(PAPER.start, PAPER.goal, gains, method="continuous", **options)
        begin, accuracy = (*PAPER.start, 0.0, 0.0), {"rtol": 1e-7, "atol": 1e-9}
        more = {"args": (gains,), "t_eval": run.t} | accuracy
        x, y, _, *wheels = solve_ivp(rate, (0.0, 10.0), begin, **more).y
        expected = [x, y, *wmr.wheels_to_twist(*wheels, limits.track_width)]
        np.testing.assert_allclose([run.x, run.y, run.v, run.omega], expected, atol=1e-4)
        assert (run.v[0], run.omega[0]) == (0.0, 0.0)
    parked = wmr.simulate(ORIGIN, ORIGIN, CALM, **LAGGING)
    assert (len(parked), parked.v[0], parked.omega[0]) == (1, 0.0, 0.0)


@settings(max_examples=30, deadline=None)
@given(poses, st.floats(0.2, 0.6), st.floats(-6.0, -2.0))
def test_lagging_wheels_that_graze_the_radius_have_arrived(start, lag, exponent):
    """Where a run without a radius comes nearest, by its samples, one a hair wider is met."""
    assume(math.hypot(start.x, start.y) > 1.0)
    gains = wmr.Gains(0.5, 2.0, 2.0, 2.0)
    options = {"method": "continuous", "wheels": wmr.Wheels(0.5, lag=lag)}
    free = wmr.simulate(start, ORIGIN, gains, dt=0.001, arrival_radius=1e-9, **options)
    nearest = 1 + int(np.argmax(np.diff(free.rho) > 0.0))  # the first time that it goes away
    assume(1e-6 < free.rho[nearest] < 0.5 * free.rho[0])
    radius = float(free.rho[nearest]) * (1.0 + 10.0**exponent)
    run = wmr.simulate(start, ORIGIN, gains, arrival_radius=radius, **options)
    assert run.t[-1] <= free.t[nearest] + 1e-9


@given(exponent=st.integers(-12, 0))
@settings(max_examples=13)
def test_continuous_is_as_right_however_small_the_radius(exponent):
    start, gains = wmr.Pose(0.07, 0.33, -2.92), wmr.Gains(0.9, 9.9, 0.37, 0.6)
    options = {"arrival_radius": 0.3 * 10.0**exponent, "duration": 90.0}
    run = wmr.arrival(wmr.simulate(start, ORIGIN, gains, method="continuous", **options))
    many = wmr.sweep(start, ORIGIN, gains, **options)
    assert run.arrived
    assert many.arrived
    assert run.time == pytest.approx(many.time, rel=1e-7)


# Numbers of other kinds ---------------------------------------------------------------------------


def test_whole_runs_take_exact_numbers():
    third, tenth = Fraction(1, 3), Decimal("0.1")
    start, goal = wmr.Pose(0, third, tenth), wmr.Pose(Decimal(3), tenth, 0)
    gains = wmr.Gains(k_rho=tenth, k_alpha=2, h=third * 3, v_max=Fraction(2))
    end = wmr.LastTurn(tolerance=tenth, gain=Fraction(2))
    wheels = wmr.Wheels(Fraction(1, 2), max_speed=tenth * 20)
    exact = {"dt": tenth, "duration": Fraction(20), "arrival_radius": tenth, "hysteresis": third}
    plain = {name: float(value) for name, value in exact.items()}
    run = wmr.simulate(start, goal, gains, **exact, wheels=wheels, last_turn=end)
    same = wmr.simulate(
        start, goal, gains, **plain, wheels=wmr.Wheels(0.5, 2.0), last_turn=wmr.LastTurn(0.1, 2.0)
    )
    np.testing.assert_array_equal(run.x, same.x)


def resting(x):
    """A reference that rests, in numbers of several kinds."""
    return lambda t: wmr.Reference(x, 0, 0.0 * t, np.array([Decimal(0)] * t.size), Fraction(0))


@pytest.mark.parametrize("method", ["arc", "continuous"])
def test_a_reference_may_return_exact_numbers_and_no_mask(method):
    drive = {"duration": Fraction(1, 2), "dt": Decimal("0.1"), "method": method}
    run = wmr.track(resting(Fraction(1, 2)), ORIGIN, CALM, **drive)
    assert {*run.goal.x} == {0.5}
    masked = resting(np.ma.array([0.1]))
    with pytest.raises(
        ValueError, match=r"^reference\(t\)\.x = .* not a numpy.MaskedArray: .* in m$"
    ):
        wmr.track(masked, ORIGIN, CALM, **drive)


def test_a_reference_is_checked_between_the_samples_too():
    def masked_in_a_step(t):
        return resting(np.ma.array(t) if np.ptp(t) < 0.1 else t)(t)

    with pytest.raises(ValueError, match=r"^reference\(t\)\.x = .* not a numpy.MaskedArray"):
        wmr.track(masked_in_a_step, ORIGIN, CALM, method="continuous")
