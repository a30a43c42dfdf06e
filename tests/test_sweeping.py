"""Sweeps against the continuous oracle, against the public functions, and interrupted."""

import math
import os
import signal
import warnings
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from itertools import product
from multiprocessing import get_context

import numpy as np
import pandas as pd
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from oracle import integrated
from scipy.integrate._ivp import dop853_coefficients

import wmrlib as wmr
from wmrlib import _dop853, sweeping, threads
from wmrlib.runs import METHODS, Arrival

ORIGIN = wmr.Pose(0.0, 0.0, 0.0)
PAPER = wmr.paper.outdoor()
CALM = wmr.Gains(k_rho=0.4, k_alpha=2.0, h=0.6, v_max=2.0)
LAWS = ("corrected", "printed", "aicardi")
LIMITS = wmr.Wheels(track_width=0.5, max_speed=1.0)


def scattered(count, seed=0):
    """Runs that arrive at very different times, and some that don't."""
    draw = np.random.default_rng(seed).uniform
    starts = wmr.Pose(draw(-9, 9, count), draw(-9, 9, count), draw(-3, 3, count))
    h = np.full(count, 0.6)
    gains = wmr.Gains(draw(0.05, 1.0, count), draw(0.5, 3.0, count), h, draw(0.5, 2.0, count))
    return starts, ORIGIN, gains


def same(one, other):
    return all(np.array_equal(a, b, equal_nan=True) for a, b in zip(one, other, strict=True))


def alike(one, other):
    """As a sweep promises: what is recorded ends its steps on samples."""
    options = {"rtol": 1e-6, "atol": 1e-6, "equal_nan": True}
    return all(np.allclose(a, b, **options) for a, b in zip(one, other, strict=True))


# The polar closed loop ---------------------------------------------------------------------------


def decades(low, high):
    return st.floats(math.log10(low), math.log10(high)).map(lambda x: 10.0**x)


turns = st.floats(-math.pi, math.pi)
starts = st.builds(
    lambda far, sight, heading: wmr.Pose(-far * math.cos(sight), -far * math.sin(sight), heading),
    decades(0.01, 100.0), turns, turns,
)  # fmt: skip
wide_gains = st.builds(
    wmr.Gains,
    decades(0.02, 10.0), decades(0.1, 20.0), decades(0.01, 20.0) | st.just(0.0), decades(0.1, 20.0),
)  # fmt: skip
limits = st.none() | st.builds(
    lambda *most: wmr.Wheels(*most), st.floats(0.2, 1.0), st.floats(0.3, 5.0)
)


def test_the_steps_have_the_coefficients_of_their_authors():
    stages = [np.pad(row, (0, 11 - len(row))) for row in _dop853.STAGES]
    for ours, theirs in (
        (_dop853.NODES[:12], dop853_coefficients.C[:12]),
        (stages, dop853_coefficients.A[1:12, :11]),
        (_dop853.WEIGHTS, dop853_coefficients.B[:12]),
        (_dop853.FIFTH, dop853_coefficients.E5[:12]),
        (_dop853.THIRD, dop853_coefficients.E3[:12]),
    ):
        np.testing.assert_allclose(ours, theirs, rtol=1e-14, atol=1e-15)


@settings(max_examples=40, deadline=None)
@example(wmr.Pose(-10, -5, 0), wmr.Pose(0, 0, 1), wmr.Gains(3, 0.5, 4, 8), LAWS[0], None, 0.05)
@example(wmr.Pose(-3, 1, -2.0), ORIGIN, CALM, "aicardi", LIMITS, 0.05)
# Backwards and forwards again, and |omega| is largest within a step.
@example(wmr.Pose(-5, 0, 1.8), wmr.Pose(0, 0, 2), wmr.Gains(0.4, 0.5, 2, 2), LAWS[0], None, 0.05)
@given(starts, turns.map(lambda heading: wmr.Pose(0, 0, heading)), wide_gains,
       st.sampled_from(LAWS), limits, decades(1e-3, 0.3))  # fmt: skip
def test_the_default_is_as_right_as_promised(start, goal, gains, law, wheels, radius):
    assume(law != "printed" or gains.k_alpha > 1.5 * gains.k_rho * gains.v_max)  # which settles
    options = {"law": law, "wheels": wheels, "arrival_radius": radius, "duration": 30.0}
    run = wmr.sweep(start, goal, gains, **options)
    truth = integrated(start, goal, gains, **options)
    assert run.arrived == truth[0]
    run = run._replace(heading_error=truth[2] + wmr.wrap_angle(run.heading_error - truth[2]))
    tolerance = 1e-4 if wheels else 1e-6
    for name, value, right in zip(run._fields[1:], run[1:], truth[1:], strict=True):
        assert value == pytest.approx(right, abs=tolerance, rel=tolerance), name


@settings(max_examples=30, deadline=None)
@given(starts, wide_gains, st.sampled_from(("corrected", "aicardi")), st.floats(0.01, 0.5))
def test_the_samples_lie_on_the_same_run_and_dt_changes_nothing_else(start, gains, law, dt):
    options = {"law": law, "duration": 10.0, "dt": dt}
    run, paths = wmr.sweep(start, ORIGIN, gains, trajectories=True, **options)
    assert alike(run, wmr.sweep(start, ORIGIN, gains, **options))
    alone = wmr.simulate(start, ORIGIN, gains, method="continuous", **options)
    count = np.isfinite(paths.rho).sum()
    assert abs(count - (len(alone) - run.arrived)) <= 1
    count = min(count, len(alone) - run.arrived)
    for name in paths._fields[1:]:
        ours, theirs = getattr(paths, name)[:count], getattr(alone, name)[:count]
        off = ours - theirs if name != "heading" else wmr.wrap_angle(ours - theirs)
        assert np.all(np.abs(off) <= 1e-6 * (1.0 + np.abs(theirs))), name


def test_a_run_that_starts_within_the_radius_has_its_one_sample_whatever_the_method():
    start = wmr.Pose([0.01, 0.01], [0.0, 0.02], [0.3, 2.0])
    for method in METHODS:
        run, paths = wmr.sweep(start, ORIGIN, CALM, method=method, trajectories=True)
        assert (run.time == 0.0).all()
        assert (np.isfinite(paths.rho).sum(axis=-1) == 1).all()
        assert paths.rho[:, 0] == pytest.approx(run.distance)
        assert paths.x[:, 0] == pytest.approx(start.x)


def test_many_samples_are_no_reason_to_give_a_run_up():
    times = {"dt": 1e-5, "duration": 1.2}
    run, paths = wmr.sweep(wmr.Pose(-9.0, 2.0, 1.0), ORIGIN, CALM, trajectories=True, **times)
    alone = wmr.simulate(wmr.Pose(-9.0, 2.0, 1.0), ORIGIN, CALM, method="continuous", **times)
    assert run.distance == pytest.approx(alone.rho[-1], rel=1e-9)
    assert np.isfinite(paths.rho).sum() == len(alone) == 120_001


def test_hopeless_gains_are_given_up_with_a_warning():
    stiff = wmr.Gains(*([0.5, one] for one in (0.5, 1e6, 1.0, 4.0)))
    options = {"duration": 0.9, "trajectories": True}
    with pytest.warns(RuntimeWarning, match=r"1 of 2 runs are NaN: .* more than 100,000 steps"):
        run, paths = wmr.sweep(wmr.Pose(-9.0, 2.0, 1.0), ORIGIN, stiff, **options)
    assert np.isnan([field[1] for field in run[1:]]).all()
    assert not run.arrived[1]
    assert np.isnan(paths.x[1]).all()
    assert np.isfinite(run.heading_error[0])


extremes = st.sampled_from([0.0, 1e-150, 1e-9, 1.0, 1e9, 1e150, 1e300])


@settings(max_examples=60, deadline=None)
@given(extremes, turns | st.just(math.pi), st.tuples(*[extremes] * 3), extremes.filter(bool),
       st.sampled_from([0.0, 1e-9, 1.0]), st.sampled_from(METHODS))  # fmt: skip
def test_whoever_says_that_it_arrived_is_there(far, heading, gains, v_max, radius, method):
    options = {"method": method, "arrival_radius": radius, "duration": 1.0}
    with warnings.catch_warnings(action="ignore"):
        run = wmr.sweep(wmr.Pose(-far, 0.0, heading), ORIGIN, wmr.Gains(*gains, v_max), **options)
    if run.arrived:
        assert np.isfinite(run).all()
        assert run.distance <= radius * (1.0 + 1e-9)
        assert radius > 0.0 or far == 0.0
    else:
        assert run.time == math.inf or math.isnan(run.time)
        assert run.distance != 0.0 or far == 0.0 or radius == 0.0


# Shapes, laws, trajectories ----------------------------------------------------------------------


def test_laws_broadcast_too():
    gains = wmr.Gains(np.array([0.4, 0.2])[:, None], 2.0, 0.6, 2.0)
    goal, options = wmr.Pose(5.0, 0.0, 0.0), {"duration": 40.0, "trajectories": True}
    mixed, paths = wmr.sweep(PAPER.start, goal, gains, law=np.array(LAWS), **options)
    assert (mixed.time.shape, paths.x.shape) == ((2, 3), (2, 3, 401))
    for j, law in enumerate(LAWS):
        runs, alone = wmr.sweep(PAPER.start, goal, gains, law=law, **options)
        assert same(runs, [field[:, j, None] for field in mixed])
        assert same(alone[1:], [row[:, j, None] for row in paths[1:]])
    pair, *_ = wmr.sweep(PAPER.start, goal, gains, law=np.array(LAWS[1:]), **options)
    assert same(pair, [field[:, 1:] for field in mixed])
    empty = wmr.sweep(wmr.Pose(np.zeros((0, 2)), 0, 0), goal, CALM)
    assert empty.time.shape == (0, 2)


@pytest.mark.parametrize("method", ["arc", "euler"])
def test_sweeps_in_the_plane_are_the_runs_of_simulate(method):
    x, k_rho = np.array([-3.0, 0.0, 3.0]), np.array([0.4, 2.0])
    starts, gains = wmr.Pose(x[:, None], 1.0, 0.5), CALM._replace(k_rho=k_rho)
    for law, wheels in product(LAWS, (None, LIMITS)):
        options = {"law": law, "method": method, "wheels": wheels, "duration": 5.0}
        runs, paths = wmr.sweep(starts, ORIGIN, gains, trajectories=True, **options)
        assert 0 < runs.arrived.sum() < 6
        for i, j in np.ndindex(3, 2):
            start, alike = wmr.Pose(float(x[i]), 1.0, 0.5), CALM._replace(k_rho=float(k_rho[j]))
            alone = wmr.simulate(start, ORIGIN, alike, **options)
            single = tuple(wmr.arrival(alone))
            assert tuple(field[i, j] for field in runs) == pytest.approx(single, abs=1e-12)
            one = wmr.sweep(start, ORIGIN, alike, **options)
            assert one == pytest.approx(single, abs=1e-12)
            assert [type(field) for field in one] == [bool] + [float] * 5
            for name in paths._fields[1:]:
                row = getattr(paths, name)[i, j]
                assert row[: len(alone)] == pytest.approx(getattr(alone, name), abs=1e-12)
                assert np.isnan(row[len(alone) :]).all()


def alone(start, goal, gains, **options):
    """The run of `simulate`; without a sample, nothing but that it did not arrive."""
    run = wmr.simulate(start, goal, gains, **options)
    return wmr.arrival(run) if len(run) else Arrival(False, math.inf, *[math.nan] * 4)


@pytest.mark.parametrize("wheels", [None, LIMITS])
@pytest.mark.parametrize("method", METHODS)
def test_whoever_arrives_gives_its_place_to_the_next_and_nobody_notices(method, wheels):
    starts, goal, gains = scattered(1500)
    options = {"method": method, "wheels": wheels, "duration": 30.0}
    runs = wmr.sweep(starts, goal, gains, **options)
    assert 0.1 < runs.arrived.mean() < 0.9
    order = np.random.default_rng(1).permutation(1500)
    for some in (order, np.array([7])):
        moved, tuned = (type(values)(*(row[some] for row in values)) for values in (starts, gains))
        assert same(wmr.sweep(moved, goal, tuned, **options), [field[some] for field in runs])
    if method == "continuous":
        return
    for i in order[:50]:
        start, tuned = (type(row)(*(float(values[i]) for values in row)) for row in (starts, gains))
        single = alone(start, goal, tuned, **options)
        assert [field[i] for field in runs] == pytest.approx(single, rel=1e-9, abs=1e-9)


_HALF = math.pi / 2
HARD = {
    "on the goal": ((1.0, 2.0, 3.0), (1.0, 2.0, -1.0), CALM),
    "on the goal, with a minus": ((-0.0, -0.0, 1.0), (-0.0, -0.0, -1.0), CALM),
    "straight behind": ((3.0, 0.0, 0.0), (0.0, 0.0, 0.0), CALM),
    "straight behind, looking back": ((3.0, -0.0, -0.0), (0.0, 0.0, math.pi), CALM),
    "straight behind, no steering": ((0.0, 3.0, _HALF), (0.0, 0.0, -math.pi), (0.4, 0.0, 0.0, 2)),
    "on a seam": ((0.0, -3.0, -_HALF), (0.0, 0.0, _HALF), CALM),
    "no speed": ((-3.0, 1.0, 2.5), (0.0, 0.0, 0.0), (0.0, 2.0, 0.6, 2.0)),
    "many turns": ((-3.0, 1.0, 1e3), (2.0, 0.5, -1e5), CALM),
    "more turns than vectors know": ((-3.0, 1.0, 2e6), (2.0, 0.5, -1e300), CALM),
    "turns in each step": ((-3.0, 1.0, 2.5), (2.0, 0.5, -1.0), (0.4, 400.0, 0.6, 2.0)),
    "a million radians a step": ((-3.0, 1.0, 2.5), (2.0, 0.5, -1.0), (0.4, 2e7, 0.6, 2.0)),
    "far": ((-3e200, 1e200, 0.5), (0.0, 0.0, 0.0), (1e-200, 2.0, 0.6, 2e200)),
    "too far": ((-1e308, 1e308, 0.5), (1e308, -1e308, 0.0), CALM),
    "near": ((-3e-139, 1e-139, 0.5), (0.0, 0.0, 0.0), CALM),
    "too near from the second step": ((-1e-139, 0.0, 0.0), (0.0, 0.0, 1.0), (9.9999, 2, 0.6, 1)),
    "so near that squares lose digits": ((-3e-160, 1e-160, 0.5), (0.0, 0.0, 0.0), CALM),
    "so near that squares are 0": ((-3e-200, 1e-200, 0.5), (0.0, 0.0, 0.0), CALM),
    "as near as can be": ((5e-324, 0.0, 0.5), (0.0, 0.0, 0.0), CALM),
    "out of the range of numbers": ((-3.0, 1.0, 0.5), (0.0, 0.0, 0.0), (1e308, 1e308, 0.6, 1e308)),
    "out of it after some steps": ((-3.0, 1.0, 0.5), (0.0, 0.0, 0.0), (1e3, 2.0, 0.6, 1e3)),
}


@pytest.mark.parametrize("method", ["arc", "euler"])
def test_in_the_plane_hard_runs_too_are_those_of_simulate(method):
    """Side by side, as one may hurt its neighbours, and driven for five steps."""
    starts, goals, gains = (
        np.array(column, float).T for column in zip(*HARD.values(), strict=True)
    )
    runs = wmr.Pose(*starts), wmr.Pose(*goals), wmr.Gains(*gains)
    for law, radius in product(LAWS, (0.0, 1e-160, 0.05)):
        options = {"method": method, "law": law, "arrival_radius": radius, "duration": 0.5}
        swept = wmr.sweep(*runs, **options)
        for i, name in enumerate(HARD):
            ends = (type(row)(*(float(column[i]) for column in row)) for row in runs)
            single, mine, what = alone(*ends, **options), [field[i] for field in swept], (name, law)
            if np.isnan(single.distance):
                assert not mine[0], what
                continue
            assert mine[:2] == list(single[:2]), what
            assert abs(wmr.wrap_angle(mine[2] - single[2])) < 1e-9, what
            assert mine[3] == pytest.approx(single[3], rel=1e-9, abs=1e-14), what
            metres = {"rel": 1e-9, "abs": 1e-14 * np.abs(starts[:2, i]).max()}
            assert mine[4:] == pytest.approx(single[4:], **metres), what


def test_bad_input_names_argument_value_and_range(monkeypatch):
    many, samples = {"trajectories": True, "dt": 0.01, "duration": 1000.0}, "100,001 samples"
    for options, message in [
        ({"method": "heun"}, "'arc', 'euler', 'continuous' is needed"),
        ({"law": ["corrected", "kanayama"]}, "law = 'kanayama' .* one of .*'corrected', 'printed'"),
        ({"law": ["corrected", ["printed"]]}, r"law = \['corrected', \['printed'\]\] is not"),
        ({"law": ["printed"] * 2}, r"goals\.x has shape \(1000,\), law has shape \(2,\)"),
        (many, f"trajectories = True .* 1,000 runs of {samples}: at most 50,000,000"),
        ({"trajectories": "no"}, "trajectories = 'no' is not allowed: True or False is needed"),
        ({"progress": 1}, "progress = 1 is not allowed: True or False is needed"),
    ]:
        valid = {"starts": ORIGIN, "goals": wmr.Pose(np.ones(1000), 0.0, 0.0), "gains": CALM}
        with pytest.raises(ValueError, match=message):
            wmr.sweep(**valid | options)
    few = {"trajectories": True, "duration": 1.0}
    monkeypatch.setattr(sweeping, "MOST_RECORDED", 11_000)
    assert wmr.sweep(**valid, **few)[1].x.shape == (1000, 11)
    monkeypatch.setattr(sweeping, "MOST_RECORDED", 10_999)
    with pytest.raises(ValueError, match="1,000 runs of 11 samples: at most 10,999 "):
        wmr.sweep(**valid, **few)


# Chunks, bars, interruptions ---------------------------------------------------------------------


@pytest.fixture
def small_chunks(monkeypatch):
    """Chunks of one block, so that a small sweep has many."""
    monkeypatch.setattr(sweeping, "_CHUNK", (1, 1))


CASE = scattered(5000, seed=2)
WHOLE = {"dt": 0.05, "duration": 30.0}


@pytest.fixture(scope="module")
def whole():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sweeping, "_CHUNK", (10**9, 10**9))
        return wmr.sweep(*CASE, **WHOLE)


def test_chunks_do_not_show(small_chunks, whole):
    assert same(wmr.sweep(*CASE, **WHOLE), whole)
    runs, paths = wmr.sweep(*CASE, **WHOLE, trajectories=True)
    assert alike(runs, whole)
    counts, arrived = np.isfinite(paths.x).sum(axis=-1), runs.arrived & (runs.time > 0.0)
    assert np.array_equal(counts[arrived], np.ceil(runs.time[arrived] / 0.05))


def test_a_bar_on_long_work_only(monkeypatch, capsys):
    monkeypatch.setattr(threads, "_BAR_AFTER", 0.0)
    wmr.sweep(*CASE, duration=1.0)
    monkeypatch.setattr(sweeping, "_LONG_WORK", 0)
    wmr.sweep(*CASE, duration=1.0, progress=False)
    assert capsys.readouterr().err == ""
    wmr.sweep(*CASE, duration=1.0)
    assert "100%" in capsys.readouterr().err


@pytest.fixture
def ctrl_c():
    """Started in the background, a process inherits that SIGINT is ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def test_ctrl_c_keeps_what_is_done(monkeypatch, ctrl_c, small_chunks, whole):
    class Interrupting(ThreadPoolExecutor):
        submitted = 0

        def submit(self, function, *arguments):
            def interrupted(*arguments):  # by a signal, as from the terminal, while others work
                signal.raise_signal(signal.SIGINT)
                return function(*arguments)

            self.submitted += 1
            return super().submit(interrupted if self.submitted == 8 else function, *arguments)

    monkeypatch.setattr(threads.futures, "ThreadPoolExecutor", lambda _: Interrupting(1))
    message = r"^interrupted: [\d,]+ of 5,000 runs are done, the others are NaN$"
    with pytest.warns(RuntimeWarning, match=message) as warned:
        runs = wmr.sweep(*CASE, **WHOLE)
    done = ~np.isnan(runs.time)
    assert 0 < done.sum() < 5000
    assert f"interrupted: {done.sum():,} of" in str(warned[0].message)
    assert same([field[done] for field in runs], [field[done] for field in whole])
    assert not runs.arrived[~done].any()
    assert all(np.isnan(field[~done]).all() for field in runs[1:])


# On other processes ------------------------------------------------------------------------------


class Losing:
    """An executor that ends one of its own workers when it is given the third chunk."""

    def __init__(self, executor, workers):
        self.executor, self.workers, self.submitted = executor, workers, 0

    def submit(self, function, *arguments):
        self.submitted += 1
        if self.submitted == 3:
            os.kill(self.workers()[0], signal.SIGKILL)
        return self.executor.submit(function, *arguments)


MANY_KINDS = [
    {},
    {"method": "arc", "receiver": wmr.Receiver(0.1, 3.0), "seed": 5, "arrival_radius": 0.3},
    {"method": "euler", "trajectories": True, "duration": 20.0},
]


def same_elsewhere(executor, monkeypatch, more):
    monkeypatch.setattr(sweeping, "_CHUNK", (1, 200_000))
    starts, goal, gains = scattered(1500)
    here = wmr.sweep(starts, goal, gains, **more)
    there = wmr.sweep(starts, goal, gains, executor=executor, **more)
    pairs = zip(here, there, strict=True) if "trajectories" in more else [(here, there)]
    return all(same(one, other) for one, other in pairs)


@pytest.mark.skipif(os.name == "nt", reason="SIGKILL is POSIX's")
def test_a_lost_worker_costs_time_and_no_run(monkeypatch):
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        pool.submit(os.getpid).result()
        losing = Losing(pool, lambda: list(pool._processes))
        with pytest.warns(
            RuntimeWarning, match=r"the executor lost \d+ chunks .* were driven here"
        ):
            assert same_elsewhere(losing, monkeypatch, MANY_KINDS[1])
        assert losing.submitted > 3


def test_what_is_no_executor_is_refused():
    with pytest.raises(ValueError, match=r"executor = 2 is not allowed: None, or an executor as"):
        wmr.sweep(PAPER.start, ORIGIN, CALM, executor=2)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::DeprecationWarning")
@pytest.mark.parametrize("more", MANY_KINDS)
def test_a_dask_cluster_gives_the_same_to_the_last_bit_while_a_worker_is_lost(monkeypatch, more):
    import distributed  # here, because only this slow test needs the second that it takes

    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as two,
        distributed.Client(two) as client,
    ):
        losing = Losing(client.get_executor(), lambda: list(client.run(os.getpid).values()))
        assert same_elsewhere(losing, monkeypatch, more)
        assert losing.submitted > 3


def test_runs_are_a_table_of_pandas():
    start, goal, gains, _ = wmr.paper.outdoor()
    weights = np.array([0.1, 0.3, 1.0])
    drive = {"method": "arc", "duration": 30.0}
    runs, samples = wmr.sweep(start, goal, gains._replace(h=weights), trajectories=True, **drive)
    table = pd.DataFrame(runs._asdict(), index=pd.Index(weights, name="h"))
    assert [*table] == [*Arrival._fields]
    assert table.arrived.dtype == bool
    assert table.time[0.3] == runs.time[1]
    _, one = wmr.sweep(start, goal, gains, trajectories=True, **drive)
    driven = pd.DataFrame(one._asdict()).set_index("t").dropna()
    assert driven.rho.iloc[-1] == samples.rho[1, len(driven) - 1]
    # And back: a column of a table is an array.
    again = wmr.sweep(start, goal, gains._replace(h=table.index), trajectories=True, **drive)
    assert again[0] == runs
