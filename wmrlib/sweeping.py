"""Many runs at once, on every core of this machine or on any `concurrent.futures.Executor`."""

from __future__ import annotations

import math
import os
import signal
import threading
import warnings
from collections.abc import Callable, Generator, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ThreadPoolExecutor, wait
from contextlib import closing, contextmanager
from itertools import islice
from typing import NamedTuple

import numpy as np

from wmrlib._checks import as_array, choice, instance, same_shape, scalar
from wmrlib._loops import plane, polar, rows
from wmrlib.gains import Gains, WheelLimits, checked_wheels
from wmrlib.kinematics import Pose
from wmrlib.laws import POSE_LAWS
from wmrlib.runs import Arrival, Trajectories, sample_count

MOST_RECORDED = 50_000_000
_METHODS = {
    "rk4": (polar, polar.RK4),
    "polar_euler": (polar, polar.EULER),
    "arc": (plane, plane.ARC),
    "euler": (plane, plane.EULER),
}
# A chunk is worth sending, and soon done when the sweep is stopped: evaluations of the law.
_LOCAL_CHUNK, _REMOTE_CHUNK, _LONG_WORK = 4_000_000, 40_000_000, 40_000_000
_RECORDED_CHUNK = 1_000_000  # samples
_BAR_AFTER = 1.0  # s
_HEARD_AFTER = 0.5  # s; so late a wait may hear Ctrl-C
_IN_FLIGHT = 128  # chunks handed over and not yet back: what is in memory beside the result


class _Task(NamedTuple):
    """What all the runs have in common."""

    method: str
    limits: WheelLimits
    dt: float
    samples: int
    arrival_radius: float
    recorded: bool

    @property
    def cost(self) -> int:
        """Evaluations of the law in one run."""
        return self.samples * (4 if self.method == "rk4" else 1)


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
    """Drive many runs at once and sum each one up.

    Ctrl-C (the square button in Jupyter) stops the sweep with a warning and keeps what is done; the
    other runs have arrived = False and NaN in every other field.

    Parameters
    ----------
    starts, goals : Pose, m and rad, whose fields broadcast with those of gains and law
    gains : Gains
    law : str or array of str, as in `simulate`
    method : "rk4" and "polar_euler": the law acts all the time, as in the "continuous" of
        `simulate`; (7)-(9) are integrated by Runge-Kutta steps of order 4 or by Euler's, the last
        of which is shortened to end on the arrival radius. "arc" and "euler": each entry equals
        `arrival(simulate(...))` of that run.
    dt, duration, arrival_radius, wheels : as in `simulate`
    trajectories : bool, whether to return the samples too, at most fifty million in all
    executor : Executor to which chunks of runs are sent, for example dask's
        `Client.get_executor()`; a chunk that is lost with its worker is run here. None: threads on
        all cores.
    progress : bool, whether to show a bar when the work takes longer than about a second

    Returns
    -------
    Arrival, or (Arrival, Trajectories) : of numbers for one run, of arrays for many

    Raises
    ------
    ValueError : as `simulate`, and for shapes that don't broadcast
    """
    given = (("starts", starts, Pose), ("goals", goals, Pose), ("gains", gains, Gains))
    fields = {
        f"{name}.{field}": values
        for name, value, kind in given
        for field, values in instance(name, value, kind)._asdict().items()
    }
    fields["law"] = _law_codes(law)
    shape = same_shape(**fields)
    choice("method", method, _METHODS)
    samples, radius = sample_count(dt, duration), scalar("arrival_radius", arrival_radius, low=0.0)
    task = _Task(method, checked_wheels(wheels), float(dt), samples, radius, bool(trajectories))
    if executor is not None:
        instance("executor", executor, Executor)
    total = math.prod(shape)
    if trajectories and total * samples > MOST_RECORDED:
        raise ValueError(
            f"trajectories = True is not allowed for {total:,} runs of {samples:,} samples: "
            f"at most {MOST_RECORDED:,} in all are needed"
        )
    summary = np.full((len(Arrival._fields), total), np.nan)
    record = np.full((rows.LYAPUNOV, total, samples if trajectories else 0), np.nan)
    source = [np.broadcast_to(field, shape) for field in fields.values()]
    watch = _watched(total, total * task.cost, progress)
    try:
        with watch as advance, closing(_results(source, total, task, executor, advance)) as results:
            for first, last, (metrics, paths) in results:
                summary[:, first:last], record[:, first:last] = metrics, paths
                advance(last - first)
    except KeyboardInterrupt:
        done = total - np.isnan(summary[rows.OUTCOME]).sum()
        message = f"interrupted: {done:,} of {total:,} runs are done, the others are NaN"
        warnings.warn(message, RuntimeWarning, stacklevel=2)
    outcome, *rest = (row.reshape(shape) if shape else float(row[0]) for row in summary)
    metrics = Arrival(outcome == rows.ARRIVED, *rest)
    if not trajectories:
        return metrics
    paths = record.reshape(rows.LYAPUNOV, *shape, samples)
    return metrics, Trajectories(dt * np.arange(samples), *paths)


def run_chunk(runs: np.ndarray, task: _Task) -> tuple[np.ndarray, np.ndarray]:
    """The summary and samples of the runs in the columns of `runs`, whose last row is the law."""
    (module, step), count = _METHODS[task.method], runs.shape[1]
    summary = np.empty((len(Arrival._fields), count))
    record = np.empty((rows.LYAPUNOV, count, task.samples if task.recorded else 0))
    for law in np.unique(runs[-1]):
        members = np.flatnonzero(runs[-1] == law)
        common = int(law), task.limits, step, task.dt, task.samples, task.arrival_radius
        summary[:, members] = module.survey(runs[:-1, members], *common)
        if task.recorded:
            record[:, members] = module.record(runs[:-1, members], *common)
    return summary, record


def _results(source, total: int, task: _Task, executor: Executor | None, advance) -> Generator:
    """(first, last, result) of each chunk as it is done, with a bounded number under way."""

    def columns(first: int, last: int) -> np.ndarray:
        return np.array([field.flat[first:last] for field in source], dtype=float)

    allowed = getattr(os, "sched_getaffinity", None)  # not on every system
    cores = len(allowed(0)) if allowed else os.cpu_count() or 1
    size = _chunk_size(total, task, cores, executor)
    chunks = ((first, min(first + size, total)) for first in range(0, total, size))
    if executor is None and (cores == 1 or size >= total):
        yield from ((*chunk, run_chunk(columns(*chunk), task)) for chunk in chunks)
        return
    pool = executor
    waiting: dict[Future, tuple[int, int]] = {}
    if pool is None:  # compile here, where Ctrl-C is heard, and not in a thread
        laws = np.unique(source[-1])
        run_chunk(np.tile(laws, (len(source), 1)), task._replace(samples=2))
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
            advance(0)
            for future in wait(waiting, _HEARD_AFTER, FIRST_COMPLETED).done:
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
    size = min(work // task.cost, math.ceil(total / parts))
    if task.recorded:
        size = min(size, _RECORDED_CHUNK // task.samples)
    return polar.BLOCK * max(1, math.ceil(size / polar.BLOCK))


def _law_codes(law: str | np.ndarray) -> np.ndarray:
    names = as_array(law)
    codes = [POSE_LAWS[choice("law", name, POSE_LAWS)] for name in names.ravel().tolist()]
    return np.array(codes, dtype=float).reshape(names.shape)


@contextmanager
def _watched(total: int, work: int, wanted: bool) -> Iterator[Callable[[int], None]]:
    """Show a bar if the work is long; what is yielded takes the number of runs done.

    Ctrl-C is held back until it is called: raised in a wait, it could break the lock there.
    """
    pressed: list[bool] = []
    bar = None
    if wanted and work >= _LONG_WORK:
        from tqdm.auto import tqdm  # here, because it asks what it is shown in

        bar = tqdm(total=total, unit=" runs", unit_scale=True, delay=_BAR_AFTER)

    def advance(runs: int) -> None:
        if bar is not None:
            bar.update(runs)
        if pressed:
            raise KeyboardInterrupt

    usual = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    heard = usual and threading.current_thread() is threading.main_thread()
    if heard:
        signal.signal(signal.SIGINT, lambda *_: pressed.append(True))
    try:
        yield advance
    finally:
        if heard:
            signal.signal(signal.SIGINT, signal.default_int_handler)
        if bar is not None:
            bar.close()
