"""Many runs at once, on every core of this machine."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Generator, Iterator
from contextlib import closing
from typing import Any, NamedTuple

import numpy as np

from wmrlib import threads
from wmrlib.body import (
    NO_TURN,
    LastTurn,
    Wheels,
    are_ideal,
    checked_turn,
    checked_wheels_of_many,
)
from wmrlib.checks import (
    as_array,
    choice,
    instance,
    real,
    refusal,
    same_shape,
    scalar,
    undropped,
)
from wmrlib.engine import continuous, sampled
from wmrlib.gains import Gains
from wmrlib.kinematics import Pose, wrap_angle
from wmrlib.laws import OWN_IS_WELCOME, POSE_LAWS, law_name, own_law
from wmrlib.loops import (
    LAW,
    NUMBER,
    OUTCOME,
    RECEIVER,
    Sampling,
    continuous_runs,
    held_runs,
    held_runs_by,
)
from wmrlib.receiver import Receiver, in_samples, key_of
from wmrlib.runs import (
    ARRIVED,
    METHODS,
    UNFINISHED,
    Arrival,
    Trajectories,
    checked_hysteresis,
    sample_count,
)

MOST_RECORDED = 50_000_000
MOST_TRIALS = 100_000  # a tenth of what a run on its own may take: thousands wait for one another
# A chunk is worth a thread, and soon done when the sweep is stopped: evaluations of the law.
_CHUNK = 250_000, 4_000_000  # least, most
_LONG_WORK = 40_000_000


class _Task(NamedTuple):
    """The settings that all runs of a sweep share."""

    continuous: bool
    sampling: Sampling
    samples: int
    limits: Wheels
    end: LastTurn
    key: tuple[int, int] | None  # to the random numbers of receivers; None without one
    side_by_side: bool  # in the lanes of `engine`; otherwise one by one, by the loops for one run
    own_law: Callable | None

    @property
    def cost(self) -> int:
        """The cost of a run, in evaluations of the law side by side."""
        if self.continuous:
            return 700 if self.side_by_side else 7_000 + 100 * self.samples
        return self.samples if self.side_by_side else 20 * self.samples


def sweep(
    starts: Pose,
    goals: Pose,
    gains: Gains | Any,
    *,
    law: str | np.ndarray | Callable = "corrected",
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
    executor: Any = None,
) -> Arrival | tuple[Arrival, Trajectories]:
    """Drive many runs at once and return a summary of each.

    "continuous" is right to 1e-6 (m, s, rad, or as a share of what is larger than 1), and to 1e-4
    with wheel limits, at whose edge the motion has a corner. The promise is for a law that settles:
    small errors grow where "printed" drives away from its goal's direction, and no step decides how
    such a run ends. A run of more than 100,000 steps, besides one for each sample that is returned,
    is given up with a warning (`simulate` takes a million), as is what Ctrl-C (the square button in
    Jupyter) leaves undone: arrived = False and NaN in every other field.

    Parameters
    ----------
    starts, goals : Pose, m and rad, whose fields broadcast with those of gains, wheels and law
    gains : Gains; for a law of your own a NamedTuple, whose arrays and lists of numbers broadcast
        too, or anything else, which each run is given as it is
    law : str or array of str, as in `simulate`; or a function of your own with "arc" and "euler",
        which is slower: about 20 us a step in plain Python, on one core in effect
    method : as in `simulate`, but "continuous" if you name none;
        with "arc" and "euler" each entry is `arrival(simulate(...))` of that
        run, to 1e-9 unless the run magnifies rounding
    dt, duration, arrival_radius, wheels, last_turn, hysteresis : as in `simulate`; with
        "continuous", dt only says where the samples lie, and the last one within the duration ends
        the run; wheels that do not reach a commanded speed at once need "arc" or "euler"
    receiver : Receiver, with "arc" and "euler" only: each run steers by the poses that it
        measures; its fields broadcast too. A run has arrived, and stops, when its measured pose is
        within the radius; all that is returned is true. None: runs steer by their true poses.
    seed : int from 0 to 2^64 - 1. A run's random numbers follow from it and from the
        run's place among all alone, on however many cores.
    trajectories : bool, whether to return the samples too, at most fifty million in all
    progress : bool, whether to show a bar when the work takes longer than about a second
    executor : None for the cores of this machine; or what has `submit` as the executors of
        `concurrent.futures` do, such as Dask's `client.get_executor()`. It is sent chunks of runs.
        The results are the same to the last bit. A chunk that is lost with its worker is driven
        here, with a warning.

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
    robot = checked_wheels_of_many(wheels)
    sensor = Receiver() if receiver is None else instance("receiver", receiver, Receiver)
    own, codes = (law, np.array(0.0)) if callable(law) else (None, _law_codes(law))
    if not own:
        instance("gains", gains, Gains)
    tuned = _varied(gains) if own else _fields("gains", gains)
    poses = _fields("starts", instance("starts", starts, Pose))
    poses |= _fields("goals", instance("goals", goals, Pose))
    numbers = dict.fromkeys(Gains._fields, 0.0) if own else tuned
    fields = poses | numbers | _fields("wheels", robot) | _fields("receiver", sensor)
    for name in ("starts.heading", "goals.heading"):
        fields[name] = wrap_angle(real(name, fields[name]))  # loops take directions
    shape = same_shape(**fields | tuned, law=codes)
    if choice("method", method, METHODS) == "continuous" and own:
        remark = f" with a law of your own, {law_name(own)}"
        raise refusal("method", method, "'arc' or 'euler'", remark)
    samples, dt = sample_count(dt, duration), float(dt)
    radius = scalar("arrival_radius", arrival_radius, low=0.0)
    if receiver and method == "continuous":
        raise refusal("method", method, "'arc' or 'euler'", ": a receiver is read at samples")
    words = key_of(seed)
    end = checked_turn(last_turn, dt, method, radius)
    hysteresis = checked_hysteresis(hysteresis, method)
    ideal = bool(np.all(are_ideal(robot)))
    if not ideal and method == "continuous":
        raise refusal("wheels", robot, "ideal wheels, or method 'arc' or 'euler',")
    submit = None if isinstance(executor, type) else getattr(executor, "submit", None)
    if executor is not None and not callable(submit):
        raise refusal("executor", executor, "None, or an executor as of concurrent.futures,")
    for name, value in (("trajectories", trajectories), ("progress", progress)):
        if not isinstance(value, bool | np.bool_):
            raise refusal(name, value, "True or False")
    total = math.prod(shape)
    gains_of = _gains_of_runs(gains, tuned, shape) if own else None
    if trajectories and total * samples > MOST_RECORDED:
        raise ValueError(
            f"trajectories = True is not allowed for {total:,} runs of {samples:,} samples: "
            f"at most {MOST_RECORDED:,} in all are needed"
        )
    sampling = Sampling(dt, method == "arc", radius, hysteresis)
    alike = {*map(type, robot)} == {float} and not robot.min_speed
    plain = ideal and alike and end == NO_TURN and not hysteresis
    side_by_side = plain and not receiver and not trajectories and not own
    key = words if receiver else None
    law_in_loop = own_law(own) if own else None
    setting = sampling, samples, robot, end, key, side_by_side, law_in_loop
    task = _Task(method == "continuous", *setting)
    summary = np.full((len(Arrival._fields), total), np.nan)
    record = np.empty((8, total, samples if trajectories else 0))
    number = np.arange(total).reshape(shape)
    rows = *fields.values(), number, codes
    source = [np.broadcast_to(row, shape).reshape(-1) for row in rows]
    long = progress and total * task.cost >= _LONG_WORK
    with (
        threads.watched(total, long) as go_on,
        closing(_results(source, gains_of, record, task, go_on, executor)) as results,
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
    record[:, np.isnan(summary[OUTCOME])] = np.nan  # a run that was not reached
    return metrics, Trajectories(
        sampling.dt * np.arange(samples), *record.reshape(8, *shape, samples)
    )


def run_chunk(
    runs: np.ndarray, own_gains: list | None, task: _Task, records: np.ndarray, first: int
) -> np.ndarray:
    """The summary of the runs in the columns of `runs`, whose rows are those of `loops`.

    Their samples, if they are wanted, are written where they stay, from run `first` of the records
    on: a copy of a hundred megabytes takes as long as to drive them.
    """
    whole, radius = (task.samples - 1) * task.sampling.dt, task.sampling.arrival_radius
    if task.side_by_side:
        summary = np.empty((len(Arrival._fields), runs.shape[1]))
        for law in np.unique(runs[LAW]):
            members = np.flatnonzero(runs[LAW] == law)
            setting = runs[:, members], int(law), task.limits
            if task.continuous:
                summary[:, members] = continuous.survey(*setting, whole, MOST_TRIALS, radius)
            else:
                summary[:, members] = sampled.survey(*setting, task.samples, task.sampling)
        return summary
    records[:, first : first + runs.shape[1]] = np.nan
    if task.continuous:
        samples = task.sampling.dt * np.arange(task.samples)
        t = samples if records.shape[2] else np.array([0.0, whole])
        return continuous_runs(runs, records, first, t, MOST_TRIALS, radius)
    sampled_setting = task.samples, task.end, task.key, task.sampling
    if task.own_law:
        return held_runs_by(task.own_law, own_gains, runs, records, first, *sampled_setting)
    return held_runs(runs, records, first, *sampled_setting)


def run_chunk_elsewhere(
    runs: np.ndarray, own_gains: list | None, task: _Task, recorded: bool
) -> tuple[np.ndarray, np.ndarray]:
    """The summary and the records of the runs, for a process that shares no memory with this."""
    records = np.empty((8, runs.shape[1], task.samples if recorded else 0))
    return run_chunk(runs, own_gains, task, records, 0), records


def _results(
    source: list, gains_of: Callable | None, records: np.ndarray, task: _Task, go_on, executor
) -> Generator:
    """(chunk, summary) as each is done; its records are then in their place."""
    total, recorded = source[0].size, records.shape[2] > 0

    def runs_of(chunk: Any) -> tuple[np.ndarray, list | None]:
        runs = np.array([row[chunk] for row in source], dtype=float)
        if task.key:
            receivers = runs[RECEIVER:NUMBER]
            runs[RECEIVER:NUMBER] = in_samples(receivers, task.sampling.dt, task.samples)
        return runs, gains_of and [gains_of(int(number)) for number in runs[NUMBER]]

    size = _chunk_size(total, task)
    chunks = [(first, min(first + size, total)) for first in range(0, total, size)]
    if executor is not None:
        elsewhere = threads.spread(
            run_chunk_elsewhere,
            chunks,
            lambda chunk: (*runs_of(slice(*chunk)), task, recorded),
            go_on,
            executor,
        )
        with closing(elsewhere):
            for chunk, (summary, written) in elsewhere:
                records[:, slice(*chunk)] = written
                yield chunk, summary
        return
    if len(chunks) > 1:  # compile here, and not in several threads
        few = runs_of(np.unique(source[LAW], return_index=True)[1])
        unwritten = np.empty((8, few[0].shape[1], 0))
        run_chunk(*few, task._replace(samples=2), unwritten, 0)
    here = threads.spread(
        run_chunk, chunks, lambda chunk: (*runs_of(slice(*chunk)), task, records, chunk[0]), go_on
    )
    with closing(here):
        yield from here


def _shortcomings(summary: np.ndarray) -> Iterator[str]:
    outcome = summary[OUTCOME]
    done, given_up = (~np.isnan(outcome)).sum(), (outcome == UNFINISHED).sum()
    if done < outcome.size:
        yield f"interrupted: {done:,} of {outcome.size:,} runs are done, the others are NaN"
    if given_up:
        most = f"{MOST_TRIALS:,} steps"
        yield f"{given_up:,} of {outcome.size:,} runs are NaN: their gains need more than {most}"


def _chunk_size(total: int, task: _Task) -> int:
    """The number of runs in a chunk: whole blocks, and four chunks a core in a long sweep."""
    least, most = _CHUNK
    size = math.ceil(min(most, max(least, total * task.cost / (4 * threads.CORES))) / task.cost)
    block = sampled.BLOCK if task.side_by_side else 1
    return block * math.ceil(size / block)


def _fields(name: str, values: Any) -> dict[str, Any]:
    return {f"{name}.{field}": value for field, value in values._asdict().items()}


def _varied(gains: Any) -> dict[str, Any]:
    """The fields of one's own gains that are arrays or lists of numbers, which broadcast."""
    fields = _fields("gains", gains) if hasattr(gains, "_asdict") else {}
    for name, it in fields.items():
        undropped(name, it)
    listed = {name: it for name, it in fields.items() if isinstance(it, np.ndarray | list)}
    return {name: it for name, it in listed.items() if as_array(it).dtype.kind in "iuf"}


def _gains_of_runs(gains: Any, varied: dict[str, Any], shape: tuple) -> Callable[[int], Any]:
    """The gains of a run by its number."""
    if not varied:
        return lambda number: gains
    rows = {name: np.broadcast_to(it, shape).reshape(-1) for name, it in varied.items()}

    def gains_of(number: int) -> Any:
        own = {name.partition(".")[2]: row[number].item() for name, row in rows.items()}
        return gains._replace(**own)

    return gains_of


def _law_codes(law: str | np.ndarray) -> np.ndarray:
    names = as_array(law)
    listed = names.ravel().tolist()
    listed = [law if name is ... else name for name in listed]  # ... if it is ragged
    welcome = OWN_IS_WELCOME if isinstance(law, str) else ""
    codes = [POSE_LAWS[choice("law", name, POSE_LAWS, welcome)] for name in listed]
    return np.array(codes, dtype=float).reshape(names.shape)
