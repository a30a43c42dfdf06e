"""A study too large for memory, planned from a sample: python tests/benchmarks/study.py [RUNS]

Which gains park soon from anywhere? Each of 10,000 gains drives from each of RUNS / 10,000 starts
in continuous time, 100 gains at a time, on a process a core, one of which is killed half way. RUNS
is 1e8 unless given.
"""

from __future__ import annotations

import os
import resource
import signal
import sys
import threading
import time
import warnings
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import active_children, get_context

import numpy as np
from timing import Row, show

import wmrlib as wmr

GAINS, SLAB, SAMPLE = 10_000, 100, 400
CORES = os.cpu_count() or 1
GOAL = wmr.Pose(0.0, 0.0, 0.0)


def study(runs: int) -> tuple[wmr.Pose, wmr.Gains]:
    """The starts, in a row, and the gains, in a column: every pair of them is a run."""
    draw, starts = np.random.default_rng(1).uniform, runs // GAINS
    far, sight = draw(5.0, 60.0, starts), draw(-np.pi, np.pi, starts)
    rate, damping = draw(0.3, 1.0, (GAINS, 1)), draw(0.7, 1.5, (GAINS, 1))
    frequency = draw(0.7, 1.4, (GAINS, 1)) * rate
    return (
        wmr.Pose(far * np.cos(sight), far * np.sin(sight), draw(-np.pi, np.pi, starts)),
        wmr.gains_for(rate, natural_frequency=frequency, damping=damping, v_max=4.0),
    )


def some(gains: wmr.Gains, which) -> wmr.Gains:
    return wmr.Gains(*(np.broadcast_to(each, (GAINS, 1))[which] for each in gains))


def drive(starts: wmr.Pose, gains: wmr.Gains, executor) -> wmr.Arrival:
    return wmr.sweep(starts, GOAL, gains, executor=executor, progress=False)


def planned(starts: wmr.Pose, gains: wmr.Gains) -> tuple[float, float]:
    """Seconds of one core for a run, and the standard error: ten slabs, a few starts of each."""
    draw, seconds = np.random.default_rng(2).integers, []
    with ThreadPoolExecutor(1) as one:
        for _ in range(11):
            some_starts = draw(starts.x.size, size=SAMPLE)
            pairs = (wmr.Pose(*(each[some_starts] for each in starts)),)
            pairs += (some(gains, draw(GAINS, size=SLAB)),)
            begin = time.process_time()
            drive(*pairs, one)
            seconds.append(time.process_time() - begin)
    each = np.array(seconds[1:]) / (SLAB * SAMPLE)  # the first may have compiled
    return each.mean(), each.std(ddof=1) / np.sqrt(each.size)


def kill_one_in(seconds: float) -> None:
    threading.Timer(seconds, lambda: os.kill(active_children()[0].pid, signal.SIGKILL)).start()


def peak_memory() -> float:
    """Megabytes of this process and of as many workers as there are cores, at most."""
    kinds = (resource.RUSAGE_SELF, 1), (resource.RUSAGE_CHILDREN, CORES)
    return sum(many * resource.getrusage(kind).ru_maxrss for kind, many in kinds) / 1024


def driven(starts: wmr.Pose, gains: wmr.Gains, each: float) -> tuple[np.ndarray, int, float]:
    """How soon each gain parks from 95 % of the starts, chunks lost and done again, megabytes."""
    soon, lost, parts = np.empty(GAINS), 0, GAINS // SLAB
    for begun in (range(parts // 2 + 1), range(parts // 2 + 1, parts)):
        with ProcessPoolExecutor(CORES, get_context("spawn")) as pool:
            for part in begun:
                slab = slice(part * SLAB, (part + 1) * SLAB)
                if part == parts // 2:
                    kill_one_in(0.5 * each * SLAB * starts.x.size / CORES)
                with warnings.catch_warnings(record=True) as said:
                    warnings.simplefilter("always")
                    done = drive(starts, some(gains, slab), pool)
                lost += len(said)
                time_taken = np.where(done.arrived, done.time, np.inf)
                soon[slab] = np.quantile(time_taken, 0.95, axis=1, method="higher")
                if said:  # it is as if nothing had happened
                    again = drive(starts, some(gains, slab), None)
                    assert all(map(np.array_equal, done, again))
    return soon, lost, peak_memory()


def rows(runs: int = 10**8) -> list[Row]:
    starts, gains = study(runs)
    each, error = planned(starts, gains)
    hours = runs * each / 3600
    print(f"Planned: {hours:.3g} core hours, {100 * error / each:.1g} % more or less", flush=True)
    begin, before = time.perf_counter(), os.times()
    soon, lost, megabytes = driven(starts, gains, each)
    took, after = time.perf_counter() - begin, os.times()
    assert lost, "no chunk was lost with its worker"
    spent = (sum(after[:4]) - sum(before[:4])) / 3600
    print(f"The best gains park from 95 % of the starts within {soon.min():.1f} s,")
    print(f"the median ones within {np.median(soon):.1f} s")
    title = f"A study of {runs:,} runs in continuous time, {CORES} processes, one of them killed"
    whole = runs * 8 * len(wmr.Arrival._fields)
    return [
        Row(title, "planned from a sample", hours, "core hours", 1.0),
        Row(title, "spent", spent, "core hours", spent / hours),
        Row(title, "time", took / 60, "min"),
        Row(title, "memory of all processes at most", megabytes, "MB"),
        Row(title, "all results at once would take", whole / 1e6, "MB"),
    ]


if __name__ == "__main__":
    show(rows(*(int(float(word)) for word in sys.argv[1:])))
