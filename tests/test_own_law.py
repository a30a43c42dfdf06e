"""A law of one's own, in plain Python or compiled, and a run of one's own, by its poses."""

import math
from collections import namedtuple

import numba
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import wmrlib as wmr
from wmrlib.laws import POSE_LAWS

START, GOAL, GAINS, _ = wmr.paper.outdoor()
Slope = namedtuple("Slope", "slope")


def straight(rho, alpha, theta, gains):
    """A law that needs no more than it is given."""
    return gains.slope * rho * math.cos(alpha), 2.0 * alpha


def as_function(name):
    return lambda rho, alpha, theta, gains: wmr.control_law(rho, alpha, theta, gains, law=name)


def poses(run):
    return np.array([run.x, run.y, run.heading, run.rho, run.alpha, run.theta, run.v, run.omega])


@pytest.mark.parametrize("method", ["arc", "euler"])
@pytest.mark.parametrize("name", POSE_LAWS)
def test_a_built_in_law_given_as_a_function_gives_the_built_in_run(name, method):
    options = {"method": method, "wheels": wmr.Wheels(0.5, 3.0), "duration": 30.0}
    own = wmr.simulate(START, GOAL, GAINS, law=as_function(name), **options)
    built_in = wmr.simulate(START, GOAL, GAINS, law=name, **options)
    assert own.outcome is built_in.outcome
    np.testing.assert_allclose(poses(own), poses(built_in), rtol=0.0, atol=1e-12)
    assert own.peak_omega == pytest.approx(built_in.peak_omega, abs=1e-12)
    assert own.path_length == pytest.approx(built_in.path_length, abs=1e-12)


def test_a_moving_goal_is_followed_too():
    case = wmr.paper.circle, wmr.paper.CIRCLE_START, wmr.paper.CIRCLE_GAINS
    own = wmr.track(*case, law=as_function("corrected"), duration=20.0)
    built_in = wmr.track(*case, duration=20.0)
    np.testing.assert_allclose(poses(own), poses(built_in), rtol=0.0, atol=1e-12)


@pytest.mark.parametrize(
    "more",
    [
        {},
        {"wheels": wmr.Wheels(0.5, lag=0.2), "last_turn": wmr.LastTurn()},
        {"receiver": wmr.Receiver(0.1, 3.0, 0.3), "seed": 7, "arrival_radius": 0.3},
    ],
)
def test_a_sweep_by_a_function_is_the_sweep_by_name(more):
    gains = GAINS._replace(h=np.array([[0.1], [0.3]]), k_alpha=np.array([1.0, 2.0, 3.0]))
    options = {"method": "arc", "trajectories": True, "duration": 20.0} | more
    own = wmr.sweep(START, GOAL, gains, law=as_function("corrected"), **options)
    built_in = wmr.sweep(START, GOAL, gains, **options)
    for mine, theirs in zip(own, built_in, strict=True):
        for one, other in zip(mine, theirs, strict=True):
            np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-12)


def test_its_gains_are_what_the_function_understands_and_a_namedtuples_fields_broadcast():
    runs = wmr.sweep(START, GOAL, Slope(np.array([0.2, 0.3])), law=straight, method="arc")
    for i, slope in enumerate((0.2, 0.3)):
        alone = wmr.simulate(START, GOAL, Slope(slope), law=straight)
        assert runs.time[i] == alone.t[-1]
        assert runs.heading_error[i] == alone.heading_error[-1]
    by_key = wmr.simulate(
        START, GOAL, {"slope": 0.3}, law=lambda *polar: straight(*polar[:3], Slope(**polar[3]))
    )
    assert by_key.t[-1] == runs.time[1]


def test_a_function_that_is_compiled_is_taken_as_it_is():
    compiled = numba.njit(straight)
    for method in ("arc", "euler"):
        fast = wmr.simulate(START, GOAL, Slope(0.3), law=compiled, method=method)
        slow = wmr.simulate(START, GOAL, Slope(0.3), law=straight, method=method)
        np.testing.assert_allclose(poses(fast), poses(slow), rtol=0.0, atol=1e-12)
    runs = wmr.sweep(START, GOAL, Slope(np.array([0.3])), law=compiled, method="euler")
    assert runs.time[0] == fast.t[-1]


@pytest.mark.parametrize("drive", ["simulate", "sweep", "track"])
@pytest.mark.parametrize(
    ("law", "method", "message"),
    [
        (
            "my own",
            "arc",
            r"law = 'my own' .*'corrected', .*, or a function \(rho, alpha, theta, g",
        ),
        (straight, "continuous", r"'continuous' .* 'arc' or 'euler' is needed with .* straight"),
        (
            lambda rho, alpha, theta: (1.0, alpha),
            "arc",
            r"law = <lambda>\(rho, alpha, theta\) is not allowed: a .*\(rho, alpha, theta, gains\)",
        ),
        (lambda *_: 3.0, "arc", r"<lambda> at rho = .* = 3\.0 is not allowed: a pair of numbers"),
        (lambda *_: (math.nan, 1.0), "arc", r"= \(nan, 1\.0\) is not allowed: a pair of numbers"),
        (lambda *_: ("1", "2"), "arc", r"= \('1', '2'\) is not allowed: a pair of numbers"),
        (lambda *_: b"ab", "arc", r"= b'ab' is not allowed: a pair of numbers"),
        (lambda *_: {1.0, 0.5}, "arc", r"= \{.*\} is not allowed: a pair of numbers"),
        (lambda *_: {"v": 1.0, "omega": 0.5}, "arc", r"= \{'v': .*\} is not allowed: a pair of n"),
        (lambda rho, *_: None, "euler", r"= None is not allowed: a pair of numbers"),
    ],
)
def test_what_is_no_law_is_refused_by_a_sentence(drive, law, method, message):
    first = (wmr.paper.circle, START) if drive == "track" else (START, GOAL)
    with pytest.raises(ValueError, match=message):
        getattr(wmr, drive)(*first, Slope(1.0) if callable(law) else GAINS, law=law, method=method)


def test_a_law_is_asked_in_its_run_alone_with_floats_and_may_answer_with_any_pair():
    asked = []

    def law(rho, alpha, theta, gains):
        asked.append((rho, alpha, theta))
        return np.array([0.5 * rho, 2.0 * alpha]) if rho > 1.0 else [0.5 * rho, 2.0 * alpha]

    run = wmr.simulate(START, GOAL, None, law=law)
    assert np.array_equal(np.transpose(asked), [run.rho, run.alpha, run.theta])
    assert {type(number) for numbers in asked for number in numbers} == {float}


def test_what_numba_cannot_compile_is_said_in_a_sentence():
    with pytest.raises(ValueError, match=r"gains = \{'slope': 0\.3\} .* straight, which numba has"):
        wmr.simulate(START, GOAL, {"slope": 0.3}, law=numba.njit(straight))


def test_gains_that_are_no_numbers_are_given_to_each_run_as_they_are():
    Own = namedtuple("Own", "slope table")
    table = {"turn": 2.0}
    runs = wmr.sweep(
        START,
        GOAL,
        Own(np.array([0.2, 0.3]), table),
        law=lambda rho, alpha, theta, own: (
            own.slope * rho * math.cos(alpha),
            own.table["turn"] * alpha,
        ),
        method="arc",
    )
    assert runs.time.tolist() == [
        wmr.simulate(START, GOAL, Slope(slope), law=straight).t[-1] for slope in (0.2, 0.3)
    ]


def test_a_law_that_leaves_the_range_of_numbers_ends_the_run_there():
    run = wmr.simulate(START, GOAL, 1.0, law=lambda rho, alpha, theta, k: (-1e200 * rho * rho, k))
    assert run.outcome is wmr.Outcome.DIVERGED
    assert np.isfinite(poses(run)).all()


# A run of one's own -------------------------------------------------------------------------------

starts = st.builds(wmr.Pose, st.floats(-9, 9), st.floats(-9, 9), st.floats(-3, 3))
gains = st.builds(wmr.Gains, st.floats(0.1, 2), st.floats(0.5, 3), st.floats(0, 2), st.just(2.0))


@given(starts, starts, gains)
def test_poses_give_back_the_run_that_they_came_from(start, goal, gains):
    run = wmr.simulate(start, goal, gains, wheels=wmr.Wheels(1.0, 2.0))
    own = wmr.Trajectory.of_poses(run.t, run.x, run.y, run.heading, run.goal)
    np.testing.assert_allclose(poses(own)[:6], poses(run)[:6], rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(poses(own)[6:, :-1], poses(run)[6:, :-1], rtol=0.0, atol=1e-9)
    mine, theirs = wmr.arrival(own), wmr.arrival(run)
    assert (mine.arrived, mine.time) == (theirs.arrived, theirs.time)
    assert mine.path_length == pytest.approx(theirs.path_length, abs=1e-9)
    assert mine.heading_error == pytest.approx(theirs.heading_error, abs=1e-12)
    assert wmr.residual(own) == pytest.approx(wmr.residual(run), abs=1e-12)
    value = wmr.lyapunov(run.rho, run.alpha, run.theta, 1.0)  # (18)
    np.testing.assert_allclose(own.V, value, rtol=1e-12, atol=1e-12)


def test_a_log_that_does_not_begin_at_0_took_as_long_as_it_took():
    goal = wmr.Pose(2.0, 0.0, 0.0)
    run = wmr.Trajectory.of_poses([10.0, 11.0, 13.0], [0.0, 1.0, 2.0], 0.0, 0.0, goal)
    assert wmr.arrival(run).time == 3.0
    assert run.t.tolist() == [0.0, 1.0, 3.0]
    assert run.v.tolist() == [1.0, 0.5, 0.0]
    aside = wmr.Trajectory.of_poses([0.0, 1.0], 0.0, [0.0, 1.0], 0.0, goal)
    assert (aside.v[0], aside.path_length) == (0.0, 1.0)
    short = wmr.Trajectory.of_poses([0.0, 1.0], [0.0, 1.0], 0.0, 0.0, goal)
    assert not wmr.arrival(short).arrived
    near = wmr.Trajectory.of_poses([0.0, 1.0], [0.0, 1.0], 0.0, 0.0, goal, arrival_radius=1.0)
    assert wmr.arrival(near).arrived


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (
            ([0.0, 0.0], [0.0, 1.0], 0.0, 0.0),
            r"t = \[0\.0, 0\.0\] .* each later than the one before",
        ),
        (([], [], [], []), r"t = \[\] .* a row of times"),
        (([0.0, 1.0], [0.0, 1.0, 2.0], 0.0, 0.0), r"x has shape \(3,\)"),
        (([0.0, 1.0], [0.0, math.nan], 0.0, 0.0), r"x = \[0\.0, nan\] is not allowed"),
    ],
)
def test_poses_that_make_no_run_are_refused(given, message):
    with pytest.raises(ValueError, match=message):
        wmr.Trajectory.of_poses(*given, GOAL)


# The closed loop for other tools ------------------------------------------------------------------


@pytest.mark.parametrize("law", ["corrected", "barrier", as_function("corrected")])
def test_scipy_and_python_control_integrate_the_closed_loop(law):
    rates = wmr.closed_loop(GAINS, law)
    name = law if isinstance(law, str) else "corrected"
    ours = wmr.simulate(START, GOAL, GAINS, law=name, method="continuous", duration=8.0)
    first = [ours.rho[0], ours.alpha[0], ours.theta[0]]
    end = [ours.rho[-1], ours.alpha[-1], ours.theta[-1]]
    scipys = solve_ivp(rates, (0.0, 8.0), first, rtol=1e-9, atol=1e-9).y[:, -1]
    np.testing.assert_allclose(scipys, end, atol=1e-6)
    import control  # here, because this takes 2 s in each worker

    system = control.nlsys(lambda t, x, u, params: rates(t, x), inputs=0, states=3)
    times = np.linspace(0.0, 8.0, 9)
    controls = control.input_output_response(
        system, times, 0, first, solve_ivp_kwargs={"rtol": 1e-9, "atol": 1e-9}
    )
    np.testing.assert_allclose(controls.states[:, -1], end, atol=1e-6)


def test_the_closed_loop_takes_states_in_columns_and_the_goal():
    rates = wmr.closed_loop(GAINS)
    states = np.array([[10.0, 0.0], [0.1, 0.2], [1.0, -0.5]])
    together = rates(0.0, states)
    np.testing.assert_array_equal(together, np.transpose([rates(0.0, one) for one in states.T]))
    v, omega = wmr.control_law(*states, GAINS)
    expected = wmr.polar_rate(states[0, 0], states[1, 0], v[0], omega[0])
    np.testing.assert_allclose(together[:, 0], expected, rtol=1e-12)
    with pytest.raises(ValueError, match=r"law = 'kanayama' .* or a function"):
        wmr.closed_loop(GAINS, "kanayama")


@pytest.mark.parametrize("method", ["arc", "euler"])
def test_wheels_vary_in_a_sweep_as_gains_do(method):
    lags, fastest = np.array([[0.0], [0.3]]), np.array([math.inf, 2.0, 1.0])
    runs = wmr.sweep(START, GOAL, GAINS, method=method, wheels=wmr.Wheels(0.5, fastest, lag=lags))
    assert runs.time.shape == (2, 3)
    for i, lag in enumerate(lags[:, 0]):
        for j, speed in enumerate(fastest):
            wheels = wmr.Wheels(0.5, float(speed), lag=float(lag))
            alone = wmr.arrival(wmr.simulate(START, GOAL, GAINS, method=method, wheels=wheels))
            assert [field[i, j] for field in runs] == pytest.approx(list(alone), abs=1e-9)


@pytest.mark.parametrize(
    ("wheels", "message"),
    [
        ({"lag": [0.0, -1.0]}, r"wheels\.lag = \[0\.0, -1\.0\] .* at least 0"),
        ({"max_speed": np.array([1.0, math.nan])}, r"wheels\.max_speed = .* above 0"),
        ({"max_speed": np.array([math.inf, 0.0])}, r"wheels\.max_speed = .* above 0"),
        (
            {"min_speed": np.array([1.0, 2.0]), "max_speed": 1.5},
            r"wheels\.min_speed = .* max_speed",
        ),
    ],
)
def test_wheels_of_many_runs_are_checked(wheels, message):
    with pytest.raises(ValueError, match=message):
        wmr.sweep(START, GOAL, GAINS, method="arc", wheels=wmr.Wheels(0.5, **wheels))


@pytest.mark.parametrize(
    ("refused", "call"),
    [
        (
            "wheels.max_speed = .* not a numpy.MaskedArray: give the number in m/s",
            lambda masked: wmr.sweep(START, GOAL, GAINS, wheels=wmr.Wheels(0.5, masked)),
        ),
        (
            "slope = .* an array without a unit or a mask is needed, not a numpy.MaskedArray",
            lambda masked: wmr.sweep(START, GOAL, Slope(masked), law=straight, method="arc"),
        ),
        (
            "state = .* rho, alpha and theta is needed, not a numpy.MaskedArray",
            lambda masked: wmr.closed_loop(GAINS)(0.0, [masked, masked, masked]),
        ),
    ],
)
def test_no_mask_and_no_unit_is_dropped(refused, call):
    call(np.array([0.5, 0.6]))
    with pytest.raises(ValueError, match=refused):
        call(np.ma.array([0.5, 0.6], mask=[True, False]))
    with pytest.raises(ValueError, match=refused.replace("MaskedArray", "MaskedConstant")):
        call([0.5, np.ma.masked])
