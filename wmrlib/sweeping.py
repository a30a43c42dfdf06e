"""Many runs at once: on every core of this machine, or on any cluster that looks like a `concurrent.futures.Executor`."""

from __future__ import annotations

import math
import os
import warnings
from collections.abc import Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, ThreadPoolExecutor, wait
from contextlib import closing
from itertools import islice
from typing import NamedTuple

import numpy as np

from wmrlib._checks import choice, instance, same_shape, scalar
from wmrlib._loops import plane, polar, rows
from wmrlib.gains import NO_TUNING, Gains, WheelLimits, checked_wheels
from wmrlib.kinematics import Pose
from wmrlib.laws import POSE_LAWS
from wmrlib.runs import Arrival, sample_count

MOST_RECORDED = 50_000_000
_POLAR = {"rk4": polar.RK4, "polar_euler": polar.EULER}
_PLANE = {"arc": plane.ARC, "euler": plane.EULER}
_METHODS = (*_POLAR, *_PLANE)
_ROWS = (
    "starts.x",
    "starts.y",
    "starts.heading",
    "goals.x",
    "goals.y",
    "goals.heading",
    *(f"gains.{name}" for name in Gains._fields),
)
# A chunk is large enough to be worth sending and small enough to be stopped after: these are evaluations of the law.
_LOCAL_CHUNK, _REMOTE_CHUNK, _LONG_WORK = 4_000_000, 40_000_000, 40_000_000
_RECORDED_CHUNK = 1_000_000  # samples
_BAR_AFTER = 1.0  # s
_IN_FLIGHT = 128  # chunks handed over and not yet back: what is in memory beside the result


class Trajectories(NamedTuple):
    """Many runs, sample by sample: the shape of the sweep, and a last axis as long as `t`; NaN after the run's end.

    t: s; x, y: m; heading: rad; rho: m; alpha, theta: rad; v: m/s; omega: rad/s, as in Trajectory. "rk4" and "polar_euler" arrive
    between two samples: the last one is the one before; their alpha and theta never jump.
    """

    t: np.ndarray
    x: np.ndarray
    y: np.ndarray
    heading: np.ndarray
    rho: np.ndarray
    alpha: np.ndarray
    theta: np.ndarray
    v: np.ndarray
    omega: np.ndarray


class _Task(NamedTuple):
    """What all the runs have in common."""

    method: str
    limits: WheelLimits
    dt: float
    samples: int
    arrival_radius: float
    recorded: bool


def sweep(
    starts: Pose,
    goals: Pose,
    gains: Gains,
    *,
    law: str | np.ndarray = "corrected",
    method: str = "rk4",
    dt: float = 0.1,
    duration: float = 60.0,
    arrival_radius: float = 0.05,
    wheels: WheelLimits | None = None,
    trajectories: bool = False,
    executor: Executor | None = None,
    progress: bool = True,
) -> Arrival | tuple[Arrival, Trajectories]:
    """Many runs at once: starts, goals, gains and law (a name, or an array of names) broadcast, and so does each field of the Arrival.

    method: "rk4" integrates the closed loop in polar coordinates, (7)-(9) under the law, by Runge-Kutta steps of order 4 and "polar_euler"
    by Euler's; the law acts all the time, as in `simulate`'s "continuous". Arrival is looked for at the end of each step, and the step
    that arrives is shortened until it ends on the arrival radius. "arc" and "euler" hold the twist for dt seconds, and every entry then
    equals `arrival(simulate(...))` of that run. dt, duration, arrival_radius, wheels: as in `simulate`.

    trajectories: return (Arrival, Trajectories), up to fifty million samples in all.
    executor: where to run, for example dask's `Client.get_executor()`; without one, in threads on all cores. Chunks of runs are sent; one
    that is lost, because its worker died, is run here.
    progress: show a bar when the work takes longer than about a second.

    Ctrl-C (the square button in Jupyter) stops the sweep and keeps what is done: it warns, and the runs not done have arrived = False and
    NaN in every other field (the time of a run that did not arrive is infinite).
    Raises ValueError as `simulate`, and for shapes that don't broadcast.
    """
    fields = (
        *instance("starts", starts, Pose),
        *instance("goals", goals, Pose),
        *instance("gains", gains, Gains),
    )
    codes = _law_codes(law)
    shape = same_shape(**dict(zip(_ROWS, fields, strict=True)), law=codes)
    choice("method", method, _METHODS)
    samples, radius = sample_count(dt, duration), scalar("arrival_radius", arrival_radius, low=0.0)
    task = _Task(method, checked_wheels(wheels), float(dt), samples, radius, bool(trajectories))
    if executor is not None:
        instance("executor", executor, Executor)
    total = math.prod(shape)
    if trajectories and total * samples > MOST_RECORDED:
        raise ValueError(
            f"trajectories = True is not allowed for {total:,} runs of {samples:,} samples: at most {MOST_RECORDED:,} in all are needed"
        )
    summary = np.full((6, total), np.nan)
    record = np.full((8, total, samples), np.nan) if trajectories else None
    source = [np.broadcast_to(field, shape) for field in (*fields, codes)]
    done, bar = 0, _bar(total, total * _cost(task), progress)
    try:
        with bar, closing(_results(source, total, task, executor)) as results:
            for first, last, (metrics, rows) in results:
                if record is not None:
                    record[:, first:last] = rows
                summary[:, first:last] = metrics
                done += last - first
                bar.update(last - first)
    except KeyboardInterrupt:
        warnings.warn(
            f"interrupted: {done:,} of {total:,} runs are done, the others are NaN",
            RuntimeWarning,
            stacklevel=2,
        )
    metrics = _arrival(summary, shape)
    if record is None:
        return metrics
    return metrics, Trajectories(
        dt * np.arange(samples), *(row.reshape(*shape, samples) for row in record)
    )


def run_chunk(runs: np.ndarray, task: _Task) -> tuple[np.ndarray, np.ndarray | None]:
    """The summary of the runs in the columns of `runs` (rows: _ROWS and the law's code), and if asked for their samples."""
    summary = np.empty((6, runs.shape[1]))
    record = np.full((8, runs.shape[1], task.samples), np.nan) if task.recorded else None
    for law in np.unique(runs[-1]):
        members = np.flatnonzero(runs[-1] == law)
        summary[:, members] = _summary(runs[:-1, members], int(law), task)
        if record is not None:
            record[:, members] = _samples(runs[:-1, members], int(law), task)
    return summary, record


def _summary(runs: np.ndarray, law: int, task: _Task) -> np.ndarray:
    method, limits, dt, samples, radius, _ = task
    summary = np.empty((6, runs.shape[1]))
    if method in _PLANE:
        plane.survey(runs, law, limits, _PLANE[method], dt, samples, radius, summary)
        return summary
    states, step, steps = np.empty((polar.ROWS, runs.shape[1])), _POLAR[method], float(samples - 1)
    polar.begin(runs, steps, radius, states)
    polar.survey_of(step, law, limits.max_speed < math.inf)(states, limits, dt, radius)
    polar.conclude(states, law, limits, step, dt, steps, radius, summary)
    return summary


def _samples(runs: np.ndarray, law: int, task: _Task) -> np.ndarray:
    method, limits, dt, samples, radius, _ = task
    record = np.full((8, runs.shape[1], samples), np.nan)
    if method in _POLAR:
        polar.record(runs, law, limits, _POLAR[method], dt, radius, record)
        return record
    single = np.empty((9, samples))
    for i, run in enumerate(runs.T):
        reference = np.zeros((5, samples))
        reference[:3], tuning = run[3:6, None], NO_TUNING._replace(pose=Gains(*run[6:].tolist()))
        count, _ = plane.drive(
            tuple(run[:3].tolist()),
            reference,
            tuning,
            law,
            limits,
            _PLANE[method],
            dt,
            radius,
            single,
        )
        record[:, i, :count] = single[:8, :count]
    return record


def _results(
    source: list[np.ndarray], total: int, task: _Task, executor: Executor | None
) -> Iterator:
    """(first, last, result) of each chunk as it is done, with a bounded number of chunks under way."""

    def columns(first: int, last: int) -> np.ndarray:
        return np.array([field.flat[first:last] for field in source], dtype=float)

    cores = (
        len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    )
    size = _chunk_size(total, task, cores, executor)
    chunks = ((first, min(first + size, total)) for first in range(0, total, size))
    if executor is None and (cores == 1 or size >= total):
        yield from ((*chunk, run_chunk(columns(*chunk), task)) for chunk in chunks)
        return
    pool, waiting = executor, {}
    if pool is None:
        for law in np.unique(
            source[-1]
        ):  # compile here, where Ctrl-C is heard, and not in a thread
            run_chunk(
                np.full((len(source), 1), law, dtype=float),
                task._replace(samples=2, recorded=False),
            )
        pool = ThreadPoolExecutor(cores)
    try:
        while True:
            for chunk in islice(chunks, _IN_FLIGHT - len(waiting)):
                try:
                    waiting[pool.submit(run_chunk, columns(*chunk), task)] = chunk
                except RuntimeError:  # the executor is broken or closed
                    yield *chunk, run_chunk(columns(*chunk), task)
            if not waiting:
                return
            for future in wait(waiting, return_when=FIRST_COMPLETED).done:
                chunk = waiting.pop(future)
                lost = future.cancelled() or future.exception() is not None
                yield *chunk, run_chunk(columns(*chunk), task) if lost else future.result()
    finally:
        for future in waiting:
            future.cancel()
        if executor is None:
            pool.shutdown(cancel_futures=True)


def _chunk_size(total: int, task: _Task, cores: int, executor: Executor | None) -> int:
    """Whole blocks of runs, at least four chunks for each core that is known of."""
    work, parts = (_LOCAL_CHUNK, 4 * cores) if executor is None else (_REMOTE_CHUNK, 16)
    size = min(work // _cost(task), math.ceil(total / parts))
    if task.recorded:
        size = min(size, _RECORDED_CHUNK // task.samples)
    return polar.BLOCK * max(1, math.ceil(size / polar.BLOCK))


def _cost(task: _Task) -> int:
    """Evaluations of the law in one run."""
    return task.samples * (4 if task.method == "rk4" else 1)


def _law_codes(law: str | np.ndarray) -> np.ndarray:
    names = np.asarray(law)
    codes = [POSE_LAWS[choice("law", name, POSE_LAWS)] for name in names.ravel().tolist()]
    return np.array(codes, dtype=float).reshape(names.shape)


def _arrival(summary: np.ndarray, shape: tuple[int, ...]) -> Arrival:
    outcome, time, *rest = (row.reshape(shape) if shape else float(row[0]) for row in summary)
    arrived = outcome == rows.ARRIVED
    if shape:
        return Arrival(arrived, np.where(arrived | np.isnan(time), time, np.inf), *rest)
    return Arrival(arrived, time if arrived or math.isnan(time) else math.inf, *rest)


class _NoBar:
    """Stands in for the progress bar where the work is short."""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        return None

    def update(self, _):
        return None


def _bar(total: int, work: int, wanted: bool):
    if not wanted or work < _LONG_WORK:
        return _NoBar()
    from tqdm.auto import tqdm  # here, because it asks what it is shown in

    return tqdm(total=total, unit=" runs", unit_scale=True, delay=_BAR_AFTER)
