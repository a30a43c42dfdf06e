"""Wheels that can't do at once what they are told, the least speed, and the turn at the end."""

import math

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import wmrlib as wmr
from wmrlib.body import follow, hurry, roll

GOAL, GENTLE = wmr.Pose(0.0, 0.0, 0.5), wmr.GENTLE_GAINS
speeds = st.floats(-3.0, 3.0)
starts = st.builds(wmr.Pose, st.floats(-6, 6), st.floats(-6, 6), st.floats(-3, 3))
wheels_of_all_kinds = st.builds(
    wmr.Wheels,
    st.floats(0.2, 1.0),
    max_speed=st.floats(0.5, 3.0),
    min_speed=st.sampled_from([0.0, 0.1, 0.3]),
    acceleration=st.sampled_from([math.inf, 0.5, 2.0]),
    lag=st.sampled_from([0.0, 0.05, 0.3]),
    dead_band=st.sampled_from([0.0, 0.05]),
    encoder_step=st.just(0.0),
)


@settings(max_examples=100)
@example(1.0, 1.0, 2.0, 0.0, 0.1)
@example(0.0, 2.0, 2.0, 0.0, 0.1)  # on the ramp to the end
@example(0.0, 0.1, 2.0, 0.0, 0.1)  # there before
@given(speeds, speeds, st.floats(0.1, 9.0), st.floats(0.01, 2.0), st.floats(0.01, 2.0))
def test_a_wheel_follows_as_its_equation_of_motion_says(speed, commanded, acceleration, lag, dt):
    """Against s' = (told - s)/lag, limited, integrated by another method."""

    def rate(_, state):
        return [
            np.clip((commanded - state[0]) / max(lag, 1e-4), -acceleration, acceleration),
            state[0],
        ]

    exact = solve_ivp(rate, (0.0, dt), (speed, 0.0), rtol=1e-9, atol=1e-9, max_step=dt / 50).y
    mean, after = follow(speed, commanded, 1.0 / acceleration, lag, dt)
    near = 1e-4 if lag else 1e-3
    assert (after, mean * dt) == pytest.approx((exact[0, -1], exact[1, -1]), abs=near)


@given(st.lists(speeds, min_size=1, max_size=20), st.sampled_from([0.003, 0.01]))
def test_a_wheel_of_whole_steps_is_never_half_a_step_behind(commanded, step):
    wheels, body, wanted, rolled = wmr.Wheels(0.5, encoder_step=step), (0.0,) * 4, 0.0, 0.0
    for v in commanded:
        mean, omega, body = roll(v, 0.0, body, wheels, 0.1)
        wanted, rolled = wanted + 0.1 * v, rolled + 0.1 * mean
        assert omega == pytest.approx(0.0, abs=1e-9)
        assert abs(0.1 * mean / step - round(0.1 * mean / step)) < 1e-6
        assert abs(wanted - rolled) <= 0.5 * step + 1e-9


@example(0.0, 0.0, 0.1)  # on the goal
@example(1e-9, 0.0, 0.1)
@given(speeds | st.floats(-1e-8, 1e-8), st.floats(-4.0, 4.0), st.floats(0.0, 1.0))
def test_the_least_speed_never_turns_a_robot_faster_without_driving_it_faster(v, alpha, least):
    """A larger omega without a larger v would leave the path; with it, v is the least at most."""
    factor, least = hurry(v, alpha, least), least * abs(math.cos(alpha))
    assert 1.0 <= factor <= 1e9
    if factor > 1.0:
        assert factor * abs(v) <= least * (1.0 + 1e-9)
    if abs(v) > 1e-9:
        assert factor == pytest.approx(max(1.0, min(least / abs(v), 1e9)))
    if v == 0.0:
        assert factor == 1.0


@given(heading=st.floats(-3.0, 3.0), goal_heading=st.floats(-3.0, 3.0), least=st.floats(0.05, 0.5))
def test_on_its_goal_a_robot_with_a_least_speed_turns_as_one_without(heading, goal_heading, least):
    here = wmr.Pose(0.0, 0.0, heading)
    first = [
        wmr.simulate(here, here._replace(heading=goal_heading), GENTLE, wheels=wheels,
                     method="arc", dt=0.05, duration=0.05).omega[0]
        for wheels in (wmr.Wheels(0.5, 10.0), wmr.Wheels(0.5, 10.0, min_speed=least))
    ]  # fmt: skip
    assert first[1] == pytest.approx(first[0])


def test_accelerating_wheels_are_the_continuous_motion_in_the_limit():
    """Method "arc" holds a command for dt and averages the wheels; with less dt the error falls."""
    wheels = wmr.Wheels(0.5, 2.0, acceleration=1.0, lag=0.1)
    start, goal, *_ = wmr.paper.outdoor()
    exact = wmr.simulate(start, goal, GENTLE, method="continuous", dt=0.5, wheels=wheels)
    off = []
    for dt in (0.1, 0.05, 0.025):
        run = wmr.simulate(start, goal, GENTLE, dt=dt, wheels=wheels)
        every, count = round(0.5 / dt), len(exact) - 1
        x, y = run.x[::every][:count], run.y[::every][:count]
        off.append(np.hypot(x - exact.x[:count], y - exact.y[:count]).max())
    assert 0.2 > off[0] > 1.8 * off[1] > 3.2 * off[2]


@settings(max_examples=10, deadline=None)
@given(starts, st.floats(0.02, 0.2), st.floats(0.02, 0.08))
def test_a_dead_band_stalls_the_robot_where_the_formula_says(start, k_rho, dead):
    """Straight ahead, where v alone decides: rho = -ln(1 - v_dead/v_max)/k_rho."""
    start = wmr.Pose(-abs(start.x) - 3.0, 0.0, 0.0)
    gains, goal = wmr.Gains(k_rho, 2.0, 2.0), wmr.Pose(0.0, 0.0, 0.0)
    options = {"dt": 0.01, "duration": 600.0, "arrival_radius": 0.01}
    stalled = wmr.simulate(start, goal, gains, wheels=wmr.Wheels(0.5, dead_band=dead), **options)
    expected = -math.log1p(-dead / gains.v_max) / k_rho
    assume(expected < 3.0)
    assert not wmr.arrival(stalled).arrived
    assert stalled.rho[-1] == pytest.approx(expected, abs=0.011 * dead)
    mended = wmr.Wheels(0.5, dead_band=dead, min_speed=1.01 * dead)
    assert wmr.arrival(wmr.simulate(start, goal, gains, wheels=mended, **options)).arrived


@settings(max_examples=10, deadline=None)
@given(starts, st.floats(0.05, 0.5))
def test_a_least_speed_keeps_the_path_in_continuous_time(start, least):
    assume(math.hypot(start.x, start.y) > 0.5)
    options = {"method": "continuous", "arrival_radius": 0.02, "duration": 300.0}
    free, fast = (
        wmr.simulate(start, GOAL, GENTLE, wheels=wmr.Wheels(0.5, min_speed=speed), **options)
        for speed in (0.0, least)
    )
    slow, quick = wmr.arrival(free), wmr.arrival(fast)
    assert quick.time < slow.time
    assert quick.heading_error == pytest.approx(slow.heading_error, abs=1e-6)
    assert quick.path_length == pytest.approx(slow.path_length, abs=1e-5)
    assert (np.diff(fast.V) <= 1e-12).all()


@settings(max_examples=40, deadline=None)
@given(st.floats(0.1, 40.0), st.floats(0.3, 30.0), st.floats(-3.1, 3.1), st.floats(0.02, 0.3))
def test_a_last_turn_either_ends_or_is_refused(gain, most, heading, tolerance):
    """With a gain above 2 a period each turn overshoots by more than it turned."""
    dt = 0.1
    turn = wmr.LastTurn(tolerance, gain, min_rate=0.2, max_rate=most)
    start, goal = wmr.Pose(0.0, 0.0, heading), wmr.Pose(0.05, 0.0, 0.0)
    options = {"dt": dt, "arrival_radius": 0.2, "duration": 120.0, "last_turn": turn}
    if gain * dt >= 2.0 and most * dt > 2.0 * tolerance:
        with pytest.raises(ValueError, match=r"^last_turn\.gain = .* a period of 0\.1 s, is"):
            wmr.simulate(start, goal, GENTLE, **options)
    elif gain * dt < 1.95:  # from 2 down it ends ever later
        assert wmr.arrival(wmr.simulate(start, goal, GENTLE, **options)).arrived


@settings(max_examples=10, deadline=None)
@given(starts, wheels_of_all_kinds, st.sampled_from([0.5, 1.0, 2.0]))
def test_the_last_turn_ends_within_its_tolerance_and_at_rest(start, wheels, h):
    least = 2.0 * max(wheels.dead_band, 0.02) / wheels.track_width * 1.05
    end = wmr.LastTurn(tolerance=0.1, min_rate=least, max_rate=max(1.0, least), leave=math.inf)
    assume(least * (0.02 + wheels.lag) < 0.1)  # it can stop within the tolerance
    gains = GENTLE._replace(h=h)
    wheels = wheels._replace(min_speed=max(wheels.min_speed, 2.5 * wheels.dead_band))
    assume(wheels.min_speed <= wheels.max_speed)
    assume(wheels.acceleration > 1.0)  # with less, and slow gains, it brakes too late for ever
    options = {"dt": 0.02, "duration": 200.0, "arrival_radius": 0.2, "wheels": wheels}
    run = wmr.simulate(start, GOAL, gains, last_turn=end, **options)
    assert wmr.arrival(run).arrived
    assert abs(run.heading_error[-1]) <= end.tolerance
    assert abs(run.v[-1]) < 0.02
    assert abs(run.omega[-1]) < 0.3
    assert run.rho[-1] < 0.2 + wheels.max_speed * (0.02 + wheels.lag) + (
        0.5 * wheels.max_speed**2 / wheels.acceleration
    )


@settings(max_examples=8, deadline=None)
@given(st.lists(starts, min_size=2, max_size=3), wheels_of_all_kinds, st.booleans())
def test_a_sweep_of_bodies_is_each_run_alone(poses, wheels, turns):
    end = wmr.LastTurn(tolerance=0.05, leave=1.5) if turns else None
    options = {"method": "arc", "duration": 20.0, "wheels": wheels, "arrival_radius": 0.1}
    many = wmr.Pose(*np.array(poses).T)
    runs, paths = wmr.sweep(many, GOAL, GENTLE, last_turn=end, trajectories=True, **options)
    for i, start in enumerate(poses):
        run = wmr.simulate(start, GOAL, GENTLE, last_turn=end, **options)
        nudged = wmr.simulate(
            start._replace(x=start.x + 1e-11), GOAL, GENTLE, last_turn=end, **options
        )
        count = min(len(run), len(nudged))
        if np.abs(run.x[:count] - nudged.x[:count]).max() > 1e-8 or len(run) != len(nudged):
            continue  # a threshold that rounding decides
        assert [field[i] for field in runs] == pytest.approx([*wmr.arrival(run)], abs=1e-6)
        np.testing.assert_allclose(paths.x[i, : len(run)], run.x, atol=1e-6)
        np.testing.assert_allclose(paths.omega[i, : len(run)], run.omega, atol=1e-5)
        assert np.isnan(paths.x[i, len(run) :]).all()


def test_a_receiver_decides_where_the_last_turn_begins():
    """By the place that the robot believes in; the heading, which is exact here, is met."""
    random = np.random.default_rng(5)
    starts = wmr.Pose(*random.uniform((-5, -5, -3), (5, 5, 3), (300, 3)).T)
    options = {"method": "arc", "arrival_radius": 0.2, "duration": 120.0}
    options |= {"receiver": wmr.Receiver(sigma=0.5, memory=300.0), "seed": 3}
    turned = wmr.sweep(starts, GOAL, GENTLE, last_turn=wmr.LastTurn(), **options)
    driven = wmr.sweep(starts, GOAL, GENTLE, **options)
    assert turned.arrived.all()
    assert np.abs(turned.heading_error).max() <= wmr.LastTurn().tolerance
    assert np.degrees(np.abs(driven.heading_error)).max() > 10.0
    place = [np.sqrt(np.mean(runs.distance**2)) for runs in (turned, driven)]
    assert place[0] == pytest.approx(place[1], rel=0.1)
    assert 0.5 < place[0] < 1.0  # sqrt(2) times 0.5 m, about


def test_a_turn_that_settles_sees_through_a_late_heading():
    """Once it has stood for as long as the heading is late, what it sees is what is."""
    late, random = 0.4, np.random.default_rng(7)
    starts = wmr.Pose(*random.uniform((-5, -5, -3), (5, 5, 3), (200, 3)).T)
    options = {"method": "arc", "dt": 0.05, "arrival_radius": 0.2, "duration": 200.0}
    options |= {"receiver": wmr.Receiver(heading_delay=late), "wheels": wmr.Wheels(0.5, 1.0)}
    turn = wmr.LastTurn(tolerance=0.1, gain=0.3, min_rate=0.1, max_rate=0.5, leave=math.inf)
    hasty = wmr.sweep(starts, GOAL, GENTLE, last_turn=turn, **options)
    ends = wmr.sweep(starts, GOAL, GENTLE, last_turn=turn._replace(settle=late + 0.05), **options)
    assert ends.arrived.all()
    assert np.abs(ends.heading_error).max() <= turn.tolerance
    assert np.abs(hasty.heading_error).max() > 1.5 * turn.tolerance
