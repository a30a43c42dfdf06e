"""Sweeps against the continuous oracle, against the public functions step by step, and on executors that lose their workers."""

import math
import os
import signal
import subprocess
import sys
from concurrent.futures import Executor, Future, ThreadPoolExecutor

import numpy as np
import pytest

import wmrlib as wmr
from wmrlib import sweeping

ORIGIN = wmr.Pose(0.0, 0.0, 0.0)
PAPER = wmr.paper.outdoor()
CALM = wmr.Gains(k_rho=0.4, k_alpha=2.0, h=0.6, v_max=2.0)
LAWS = ("corrected", "printed", "aicardi")
LIMITS = wmr.WheelLimits(track_width=0.5, max_speed=1.0)


def scattered(count, seed=0):
    """Runs that arrive at very different times, and some that don't."""
    random = np.random.default_rng(seed)
    starts = wmr.Pose(
        random.uniform(-9, 9, count), random.uniform(-9, 9, count), random.uniform(-3, 3, count)
    )
    return (
        starts,
        ORIGIN,
        wmr.Gains(
            random.uniform(0.05, 1.0, count),
            random.uniform(0.5, 3.0, count),
            0.6,
            random.uniform(0.5, 2.0, count),
        ),
    )


def same(one, other):
    return all(np.array_equal(a, b, equal_nan=True) for a, b in zip(one, other, strict=True))


# The polar closed loop ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize(
    ("wheels", "tolerance"), [(None, 1e-8), (LIMITS, 1e-4)]
)  # a step over the edge of the limits loses its order
def test_runge_kutta_is_the_continuous_run(law, wheels, tolerance):
    headings = np.array([-2.0, 0.5, 3.0])
    runs = wmr.sweep(
        wmr.Pose(-3.0, 1.0, headings),
        wmr.Pose(1.0, 2.0, -1.0),
        CALM,
        law=law,
        dt=0.01,
        duration=30.0,
        wheels=wheels,
    )
    for i, heading in enumerate(headings):
        oracle = wmr.simulate(
            wmr.Pose(-3, 1, float(heading)),
            wmr.Pose(1, 2, -1),
            CALM,
            law=law,
            method="continuous",
            dt=0.01,
            duration=30.0,
            wheels=wheels,
        )
        truth = wmr.arrival(oracle)
        assert runs.arrived[i] == truth.arrived
        assert (runs.time[i], runs.heading_error[i]) == (
            pytest.approx(truth.time, abs=tolerance),
            pytest.approx(truth.heading_error, abs=tolerance),
        )
        assert runs.distance[i] == pytest.approx(0.05, abs=1e-12)
        assert runs.peak_omega[i] == pytest.approx(
            truth.peak_omega, rel=1e-3
        )  # the largest of the samples
        assert runs.path_length[i] == pytest.approx(
            truth.path_length, abs=3e-4
        )  # the oracle's is a sum of trapezoids


@pytest.mark.parametrize(("method", "factor"), [("rk4", 16.0), ("polar_euler", 2.0)])
def test_order_of_the_methods_up_to_the_moment_of_arrival(method, factor):
    truth = wmr.arrival(wmr.simulate(wmr.Pose(-3, 1, 0.5), ORIGIN, CALM, method="continuous"))
    coarse, fine = (
        wmr.sweep(wmr.Pose(-3, 1, 0.5), ORIGIN, CALM, method=method, dt=dt) for dt in (0.1, 0.05)
    )
    for field in ("time", "heading_error"):
        errors = [getattr(run, field) - getattr(truth, field) for run in (coarse, fine)]
        assert errors[0] / errors[1] == pytest.approx(factor, rel=0.25)


@pytest.mark.parametrize("wheels", [None, LIMITS])
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("method", ["rk4", "polar_euler"])
def test_every_step_once_more_with_the_public_functions(method, law, wheels):
    start, goal, dt = wmr.Pose(-3.0, 1.0, 2.5), wmr.Pose(2.0, 0.5, -1.0), 0.1

    def rates(state):
        v, omega = wmr.control_law(*state, CALM, law)
        v, omega = wmr.limit_wheels(v, omega, wheels) if wheels else (v, omega)
        return np.array([*wmr.polar_rate(state[0], state[1], v, omega), abs(v)]), abs(omega)

    def step(state, dt):
        first = rates(state)[0]
        if method == "polar_euler":
            return dt * first
        second = rates(state + 0.5 * dt * first[:3])[0]
        third = rates(state + 0.5 * dt * second[:3])[0]
        return dt / 6 * (first + 2 * second + 2 * third + rates(state + dt * third[:3])[0])

    state, length, peak, states = np.array(wmr.polar_error(start, goal)), 0.0, 0.0, []
    while True:
        states.append(state)
        peak = max(peak, rates(state)[1])
        change = step(state, dt)
        if state[0] + change[0] <= 0.05:
            break
        state, length = state + change[:3], length + change[3]
    low, high = 0.0, dt
    for _ in range(60):
        low, high = (
            (low, middle)
            if state[0] + step(state, middle := 0.5 * (low + high))[0] <= 0.05
            else (middle, high)
        )
    change = step(state, high)
    time, state, length = dt * (len(states) - 1) + high, state + change[:3], length + change[3]

    run, paths = wmr.sweep(
        start, goal, CALM, law=law, method=method, dt=dt, wheels=wheels, trajectories=True
    )
    expected = (
        True,
        time,
        wmr.wrap_angle(state[2] - state[1]),
        max(peak, rates(state)[1]),
        length,
        0.05,
    )
    assert run == pytest.approx(expected, abs=1e-10)
    n = len(states)
    assert (
        pytest.approx(np.array(states), abs=1e-10)
        == np.array([paths.rho[:n], paths.alpha[:n], paths.theta[:n]]).T
    )
    seen = wmr.polar_error(wmr.Pose(paths.x[:n], paths.y[:n], paths.heading[:n]), goal)
    assert seen.rho == pytest.approx(paths.rho[:n], abs=1e-12)
    assert np.abs(wmr.wrap_angle(seen.alpha - paths.alpha[:n])).max() < 1e-10
    assert np.abs(wmr.wrap_angle(seen.theta - paths.theta[:n])).max() < 1e-10
    assert (np.abs(paths.v[:n]), np.abs(paths.omega[:n])) == tuple(
        pytest.approx(np.array(row), abs=1e-10)
        for row in zip(*((rates(each)[0][3], rates(each)[1]) for each in states), strict=True)
    )
    assert all(np.isnan(row[n:]).all() for row in paths[1:])


def test_whoever_arrives_gives_its_place_to_the_next_and_nobody_notices():
    starts, goal, gains = scattered(1500)
    runs = wmr.sweep(starts, goal, gains, duration=30.0)
    assert 0.2 < runs.arrived.mean() < 0.9
    order = np.random.default_rng(1).permutation(1500)
    moved = wmr.sweep(
        wmr.Pose(*(row[order] for row in starts)),
        goal,
        wmr.Gains(*(np.broadcast_to(row, 1500)[order] for row in gains)),
        duration=30.0,
    )
    assert same(moved, [field[order] for field in runs])
    alone = wmr.sweep(
        wmr.Pose(*(float(row[7]) for row in starts)),
        goal,
        wmr.Gains(*(float(np.broadcast_to(row, 1500)[7]) for row in gains)),
        duration=30.0,
    )
    assert alone == tuple(field[7] for field in runs)


@pytest.mark.parametrize("method", sweeping._METHODS)
def test_edges(method):
    gains = wmr.Gains([0.4, 0.4, 1e308, 0.4], [2.0, 2.0, 1e308, 2.0], 0.6, [2.0, 2.0, 1e308, 2.0])
    runs = wmr.sweep(
        wmr.Pose([0.0, 1e3, 5.0, 1.0], 0.0, 1.0),
        ORIGIN,
        gains,
        method=method,
        duration=2.0,
        arrival_radius=0.0,
    )
    assert runs.arrived.tolist()[:3] == [
        True,
        False,
        False,
    ]  # on the goal already, too far, out of the range of numbers
    assert runs.time.tolist()[:3] == [0.0, math.inf, math.inf]
    assert np.isfinite(runs.distance).all()
    assert np.isfinite(runs.heading_error).all()
    assert (runs.path_length[0], runs.distance[0]) == (0.0, 0.0)
    assert runs.heading_error[0] == pytest.approx(1.0)
    assert runs.path_length[1] == pytest.approx(4.0, rel=0.3)


def test_a_wrong_turn_of_theta_shows_in_the_heading():
    """A goal that looks back needs half a turn: the heading error on arrival is that of the pose, whatever the polar angles grew to."""
    run = wmr.sweep(
        wmr.Pose(-3, 0.01, 0),
        wmr.Pose(0, 0, math.pi),
        wmr.Gains(0.1, 2.0, 6.0),
        duration=120.0,
        arrival_radius=0.01,
    )
    assert run.arrived
    assert abs(run.heading_error) < math.radians(1.0)
    assert run.path_length > 3.5


# Shapes, laws, trajectories --------------------------------------------------------------------------------------------


def test_laws_broadcast_too():
    gains = wmr.Gains(np.array([0.4, 0.2])[:, None], 2.0, 0.6, 2.0)
    mixed, paths = wmr.sweep(
        PAPER.start,
        ORIGIN._replace(x=5.0),
        gains,
        law=np.array(LAWS),
        duration=40.0,
        trajectories=True,
    )
    assert mixed.time.shape == (2, 3)
    assert paths.x.shape == (2, 3, 401)
    for j, law in enumerate(LAWS):
        runs, alone = wmr.sweep(
            PAPER.start, ORIGIN._replace(x=5.0), gains, law=law, duration=40.0, trajectories=True
        )
        assert same(runs, [field[:, j, None] for field in mixed])
        assert same(alone[1:], [row[:, j, None] for row in paths[1:]])


@pytest.mark.parametrize("method", ["arc", "euler"])
def test_trajectories_in_the_plane_are_those_of_simulate(method):
    runs, paths = wmr.sweep(
        PAPER.start,
        wmr.Pose(3.0, [1.0, 2.0], 0.5),
        CALM,
        method=method,
        duration=20.0,
        trajectories=True,
    )
    for i, y in enumerate((1.0, 2.0)):
        alone = wmr.simulate(PAPER.start, wmr.Pose(3.0, y, 0.5), CALM, method=method, duration=20.0)
        for name in paths._fields[1:]:
            row = getattr(paths, name)[i]
            assert row[: len(alone)] == pytest.approx(getattr(alone, name), abs=1e-12)
            assert np.isnan(row[len(alone) :]).all()
        assert runs.time[i] == paths.t[len(alone) - 1]


def test_bad_input_names_argument_value_and_range():
    def sweep(**options):
        return wmr.sweep(ORIGIN, wmr.Pose(np.ones(1000), 0.0, 0.0), CALM, **options)

    with pytest.raises(
        ValueError, match=r"method = 'continuous' .* 'rk4', 'polar_euler', 'arc', 'euler' is needed"
    ):
        sweep(method="continuous")
    with pytest.raises(
        ValueError, match=r"law = 'kanayama' .* one of 'corrected', 'printed', 'aicardi'"
    ):
        sweep(law=["corrected", "kanayama"])
    with pytest.raises(ValueError, match=r"goals\.x has shape \(1000,\), law has shape \(2,\)"):
        sweep(law=["corrected", "printed"])
    with pytest.raises(
        ValueError,
        match=r"trajectories = True .* 1,000 runs of 100,001 samples: at most 50,000,000",
    ):
        sweep(trajectories=True, dt=0.01, duration=1000.0)
    with pytest.raises(ValueError, match=r"a WheelLimits is needed"):
        sweep(wheels=2.0)
    with pytest.raises(
        ValueError, match=r"executor = 4 is not allowed: a Executor is needed, not a int"
    ):
        sweep(executor=4)


FRESH = """
import wmrlib as w
from wmrlib._loops import polar
run = w.sweep(w.Pose(-3, 1, 0.5), w.Pose(0, 0, 0), w.Gains(0.4, 2.0, 0.6, 2.0), duration=1.0, arrival_radius=2.9)
stats = getattr(polar.survey_of(polar.RK4, 0, False), "stats", None)
print(run.time, run.heading_error, run.peak_omega, run.path_length, sum(stats.cache_misses.values()) if stats else None)
"""


def test_a_fresh_process_compiles_nothing_and_plain_python_gives_the_same():
    def fresh(**environment):
        done = subprocess.run(
            [sys.executable, "-c", FRESH],
            capture_output=True,
            text=True,
            check=True,
            env=os.environ | environment,
        )
        return done.stdout.split()

    fresh()  # fills the cache, if nobody has
    *compiled, misses = fresh()
    assert misses == "0"
    *plain, _ = fresh(NUMBA_DISABLE_JIT="1")
    assert [float(value) for value in plain] == pytest.approx(
        [float(value) for value in compiled], rel=1e-12
    )
    assert 0.1 < float(compiled[0]) < 1.0


# Chunks, bars, interruptions, executors ---------------------------------------------------------------------------------


@pytest.fixture
def small_chunks(monkeypatch):
    """Chunks of one block, so that a small sweep has many."""
    monkeypatch.setattr(sweeping, "_LOCAL_CHUNK", 1)
    monkeypatch.setattr(sweeping, "_REMOTE_CHUNK", 1)


CASE = scattered(5000, seed=2)
WHOLE = {"dt": 0.05, "duration": 30.0}


@pytest.fixture(scope="module")
def whole():
    with ThreadPoolExecutor(1) as one:
        return wmr.sweep(*CASE, **WHOLE, executor=one)


@pytest.mark.parametrize("recorded", [False, True])
def test_chunks_do_not_show(small_chunks, whole, recorded):
    runs = wmr.sweep(*CASE, **WHOLE, trajectories=recorded)
    if recorded:
        runs, paths = runs
        arrived = runs.arrived & (runs.time > 0.0)
        assert np.array_equal(
            np.isfinite(paths.x).sum(axis=-1)[arrived], np.ceil(runs.time[arrived] / 0.05)
        )
    assert same(runs, whole)


def test_a_bar_on_long_work_only(monkeypatch, capsys):
    monkeypatch.setattr(sweeping, "_BAR_AFTER", 0.0)
    wmr.sweep(*CASE, duration=1.0)
    assert capsys.readouterr().err == ""
    monkeypatch.setattr(sweeping, "_LONG_WORK", 0)
    wmr.sweep(*CASE, duration=1.0, progress=False)
    assert capsys.readouterr().err == ""
    wmr.sweep(*CASE, duration=1.0)
    assert "100%" in capsys.readouterr().err


def test_ctrl_c_keeps_what_is_done(monkeypatch, small_chunks, whole):
    class Interrupting(ThreadPoolExecutor):
        submitted = 0

        def submit(self, function, *arguments):
            self.submitted += 1
            if (
                self.submitted == 8
            ):  # as the terminal does it: a signal, which comes while others work
                return super().submit(os.kill, os.getpid(), signal.SIGINT)
            return super().submit(function, *arguments)

    monkeypatch.setattr(sweeping, "ThreadPoolExecutor", lambda _: Interrupting(1))
    with pytest.warns(
        RuntimeWarning, match=r"interrupted: [\d,]+ of 5,000 runs are done, the others are NaN"
    ):
        runs = wmr.sweep(*CASE, **WHOLE)
    done = ~np.isnan(runs.time)
    assert 0 < done.sum() < 5000
    assert same([field[done] for field in runs], [field[done] for field in whole])
    assert not runs.arrived[~done].any()
    assert all(np.isnan(field[~done]).all() for field in runs[1:])


class Losing(Executor):
    """Loses every third chunk, as if its worker had died, and after twelve takes no more."""

    def __init__(self):
        self.taken = 0

    def submit(self, function, *arguments):
        self.taken += 1
        if self.taken > 12:
            raise RuntimeError("cannot schedule new futures after shutdown")
        future = Future()
        if self.taken % 3 == 0:
            future.set_exception(ConnectionError("the worker is gone"))
        else:
            future.set_result(function(*arguments))
        return future


def test_lost_chunks_are_run_here(small_chunks, whole):
    assert same(wmr.sweep(*CASE, **WHOLE, executor=Losing()), whole)


def test_a_dask_cluster_that_loses_a_worker(small_chunks, whole):
    distributed = pytest.importorskip("distributed")

    class Killing(Executor):
        """Kills one of the cluster's processes when the first chunk comes back."""

        def __init__(self, executor, victim):
            self.executor, self.victim, self.killed = executor, victim, False

        def submit(self, function, *arguments):
            future = self.executor.submit(function, *arguments)
            future.add_done_callback(self.kill)
            return future

        def kill(self, _):
            if not self.killed:
                self.killed = True
                os.kill(self.victim, signal.SIGTERM if os.name == "nt" else signal.SIGKILL)

    with (
        distributed.LocalCluster(
            2, threads_per_worker=1, processes=True, dashboard_address=None, silence_logs=50
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        workers = client.run(os.getpid)
        assert len(workers) == 2
        with client.get_executor(pure=False) as executor:
            killing = Killing(executor, next(iter(workers.values())))
            runs = wmr.sweep(*CASE, **WHOLE, executor=killing)
        assert killing.killed
    assert same(runs, whole)
