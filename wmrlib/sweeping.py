"""Many runs at once, on every core of this machine."""

from __future__ import annotations

import math
import warnings
from collections.abc import Generator, Iterator
from contextlib import closing
from typing import NamedTuple

import numpy as np

from wmrlib import threads
from wmrlib.body import LastTurn, Wheels, checked_turn, checked_wheels, in_loops
from wmrlib.checks import as_array, choice, instance, real, refusal, same_shape, scalar
from wmrlib.engine import continuous, lanes, sampled
from wmrlib.gains import Gains
from wmrlib.kinematics import Pose, wrap_angle
from wmrlib.laws import POSE_LAWS
from wmrlib.receiver import Receiver
from wmrlib.runs import (
    ARRIVED,
    UNFINISHED,
    Arrival,
    Trajectories,
    checked_hysteresis,
    sample_count,
)

MOST_RECORDED = 50_000_000
_ENGINES = {"continuous": continuous, "arc": sampled, "euler": sampled}
# A chunk is worth a thread, and soon done when the sweep is stopped: evaluations of the law.
_CHUNK = 250_000, 4_000_000  # least, most
_LONG_WORK = 40_000_000


class _Task(NamedTuple):
    """What all the runs have in common."""

    method: str
    limits: Wheels
    motors: Wheels | None
    dt: float
    samples: int
    arrival_radius: float
    recorded: bool
    hysteresis: float
    end: LastTurn | None
    key: tuple[int, ...]  # to the random numbers of receivers, if there are any

    @property
    def cost(self) -> int:
        """Evaluations of the law in one run, about, or what takes as long."""
        if self.method == "continuous":
            return 700 + 14 * self.samples * self.recorded
        return self.samples * (4 if self.key else 1 + self.recorded)


def sweep(
    starts: Pose,
    goals: Pose,
    gains: Gains,
    *,
    law: str | np.ndarray = "corrected",
    method: str = "continuous",
    dt: float = 0.1,
    duration: float = 60.0,
    arrival_radius: float = 0.05,
    wheels: Wheels | None = None,
    last_turn: LastTurn | None = None,
    hysteresis: float = 0.0,
    receiver: Receiver | None = None,
    seed: int = 0,
    trajectories: bool = False,
    progress: bool = True,
) -> Arrival | tuple[Arrival, Trajectories]:
    """Drive many runs at once and sum each one up.

    "continuous" is right to 1e-6 (m, s, rad, or as a share of what is larger than 1), and to 1e-4
    with wheel limits, at whose edge the motion has a corner. The promise is for a law that settles:
    small errors grow where "printed" drives away from its goal's direction, and no step decides how
    such a run ends. A run of more than 100,000 steps is given up with a warning, as is what Ctrl-C
    (the square button in Jupyter) leaves undone: arrived = False and NaN in every other field.

    Parameters
    ----------
    starts, goals : Pose, m and rad, whose fields broadcast with those of gains and law
    gains : Gains
    law : str or array of str, as in `simulate`
    method : as in `simulate`; with "arc" and "euler" each entry is `arrival(simulate(...))` of that
        run, to 1e-9 unless the run magnifies rounding
    dt, duration, arrival_radius, wheels, last_turn, hysteresis : as in `simulate`; with
        "continuous", dt only says where the samples lie, and the last one within the duration ends
        the run; wheels that can't do at once what they are told need "arc" or "euler"
    receiver : Receiver, with "arc" and "euler" only, by what each run steers; its fields broadcast
        too. A run stops, and has arrived, where it believes to be within the radius; all that is
        returned is where it really is. None: it knows.
    seed : int from 0 to 2^64 - 1. A run's random numbers, two a sample, follow from it and from the
        run's place among all alone, on however many cores.
    trajectories : bool, whether to return the samples too, at most fifty million in all
    progress : bool, whether to show a bar when the work takes longer than about a second

    Returns
    -------
    Arrival, or (Arrival, Trajectories) : of numbers for one run, of arrays for many

    Raises
    ------
    ValueError : as `simulate`, and for shapes that don't broadcast

    Examples
    --------
    >>> import numpy as np
    >>> import wmrlib as wmr
    >>> start, goal, gains, _ = wmr.paper.outdoor()
    >>> runs = wmr.sweep(start, goal, gains._replace(h=[0.1, 0.3, 1.0]))
    >>> print(np.degrees(runs.heading_error).round(1))
    [ 65.8 -27.2 -22.4]
    """
    given: list[tuple] = [("starts", starts, Pose), ("goals", goals, Pose), ("gains", gains, Gains)]
    given += [] if receiver is None else [("receiver", receiver, Receiver)]
    fields = {
        f"{name}.{field}": values
        for name, value, kind in given
        for field, values in instance(name, value, kind)._asdict().items()
    }
    for name in ("starts.heading", "goals.heading"):
        fields[name] = wrap_angle(real(name, fields[name]))  # loops take directions
    fields["law"] = _law_codes(law)
    shape = same_shape(**fields)
    choice("method", method, _ENGINES)
    samples, radius = sample_count(dt, duration), scalar("arrival_radius", arrival_radius, low=0.0)
    if receiver and method == "continuous":
        raise refusal("method", method, "'arc' or 'euler'", ": a receiver is read at samples")
    if not isinstance(seed, int | np.integer) or isinstance(seed, bool) or not 0 <= seed < 2**64:
        raise refusal("seed", seed, "a whole number from 0 to 2**64 - 1")
    limits, motors = in_loops(checked_wheels(wheels))
    kept = checked_hysteresis(hysteresis, method)
    if motors is not None and method == "continuous":
        raise refusal("wheels", motors, "ideal wheels, or method 'arc' or 'euler',")
    end = checked_turn(last_turn, dt, method, radius)
    key, recorded = divmod(int(seed), 2**32)[::-1] if receiver else (), bool(trajectories)
    task = _Task(method, limits, motors, float(dt), samples, radius, recorded, kept, end, key)
    for name, value in (("trajectories", trajectories), ("progress", progress)):
        if not isinstance(value, bool | np.bool_):
            raise refusal(name, value, "True or False")
    total = math.prod(shape)
    if trajectories and total * samples > MOST_RECORDED:
        raise ValueError(
            f"trajectories = True is not allowed for {total:,} runs of {samples:,} samples: "
            f"at most {MOST_RECORDED:,} in all are needed"
        )
    summary = np.full((len(Arrival._fields), total), np.nan)
    record = np.empty((8, total, samples if trajectories else 0))
    source = [np.broadcast_to(field, shape).reshape(-1) for field in fields.values()]
    if receiver:
        source.insert(-1, np.arange(total))  # before the law: the run's number
    long = progress and total * task.cost >= _LONG_WORK
    with (
        threads.watched(total, long) as go_on,
        closing(_results(source, record, task, go_on)) as results,
    ):
        for (first, last), metrics in results:
            summary[:, first:last] = metrics
            go_on(last - first)
    for message in _shortcomings(summary):
        warnings.warn(message, RuntimeWarning, stacklevel=2)
    outcome, *rest = (row.reshape(shape) if shape else float(row[0]) for row in summary)
    metrics = Arrival(outcome == ARRIVED, *rest)
    if not trajectories:
        return metrics
    record[:, np.isnan(summary[lanes.OUTCOME])] = np.nan  # what is undone has not been written to
    return metrics, Trajectories(dt * np.arange(samples), *record.reshape(8, *shape, samples))


def run_chunk(runs: np.ndarray, task: _Task, record: np.ndarray, first: int) -> np.ndarray:
    """The summary of the runs in the columns of `runs`, whose last row is the law.

    Their samples are written where they stay, from run `first` of the record on: a copy of a
    hundred megabytes takes as long as to drive them.
    """
    laws = np.unique(runs[-1])
    if laws.size == 1:
        survey, law = _ENGINES[task.method].survey, lanes.as_type(int(laws[0]))
        record[:, first : first + runs.shape[1]] = np.nan
        return survey(runs[:-1], record, first, law, task)
    summary = np.empty((len(Arrival._fields), runs.shape[1]))
    for law in laws:
        members = np.flatnonzero(runs[-1] == law)
        own = np.empty((8, members.size, record.shape[2]))
        summary[:, members] = run_chunk(runs.take(members, axis=1), task, own, 0)
        record[:, first + members] = own
    return summary


def _results(source, record: np.ndarray, task: _Task, go_on) -> Generator:
    def arguments(chunk: tuple[int, int]) -> tuple:
        runs = np.array([field[slice(*chunk)] for field in source], dtype=float)
        return runs, task, record, chunk[0]

    total = source[0].size
    size = _chunk_size(total, task)
    chunks = [(first, min(first + size, total)) for first in range(0, total, size)]
    if len(chunks) > 1:  # compile here, and not in several threads
        few = np.tile(np.unique(source[-1]), (len(source), 1))
        short = np.empty((8, few.shape[1], 2 * task.recorded))
        run_chunk(few, task._replace(samples=2), short, 0)
    return threads.spread(run_chunk, chunks, arguments, go_on)


def _shortcomings(summary: np.ndarray) -> Iterator[str]:
    outcome = summary[lanes.OUTCOME]
    done, given_up = (~np.isnan(outcome)).sum(), (outcome == UNFINISHED).sum()
    if done < outcome.size:
        yield f"interrupted: {done:,} of {outcome.size:,} runs are done, the others are NaN"
    if given_up:
        most = f"{continuous.MOST_TRIALS:,.0f} steps"
        yield f"{given_up:,} of {outcome.size:,} runs are NaN: their gains need more than {most}"


def _chunk_size(total: int, task: _Task) -> int:
    """Whole blocks of runs, if they run in blocks; if worth it, four chunks for each core."""
    least, most = _CHUNK
    size = math.ceil(min(most, max(least, total * task.cost / (4 * threads.CORES))) / task.cost)
    block = sampled.VECTORS if task.key or task.recorded else sampled.BLOCK
    return block * math.ceil(size / block)


def _law_codes(law: str | np.ndarray) -> np.ndarray:
    names = as_array(law)
    each = [law if name is ... else name for name in names.ravel().tolist()]  # ... if it is ragged
    codes = [POSE_LAWS[choice("law", name, POSE_LAWS)] for name in each]
    return np.array(codes, dtype=float).reshape(names.shape)
