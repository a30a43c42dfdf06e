"""Chunks of work on several threads; Ctrl-C stops them and keeps the finished chunks."""

from __future__ import annotations

import signal
import threading
import warnings
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent import futures
from contextlib import contextmanager, nullcontext
from itertools import islice
from typing import Any

import numba

CORES = numba.config.NUMBA_NUM_THREADS  # that this process may use
_BAR_AFTER = 1.0  # s
_POLL_SECONDS = 0.5  # s; longest time after which a wait notices Ctrl-C
_IN_FLIGHT = 128  # most chunks handed over and not yet back, which need memory beside the result


def spread(
    job: Callable, chunks: Iterable, arguments: Callable, go_on: Callable, executor: Any = None
) -> Generator:
    """Yield (chunk, result) in the order in which chunks finish; at most `_IN_FLIGHT` wait.

    The chunks are computed by one thread a core, or by a given `executor`, which is not shut down.
    A chunk that is lost with a worker of a given executor is computed here.
    """
    pool, chunks = executor or futures.ThreadPoolExecutor(CORES), iter(chunks)
    waiting: dict[futures.Future, Any] = {}
    going, lost = True, []
    try:
        while going:
            for chunk in islice(chunks, _IN_FLIGHT - len(waiting)):
                waiting[_submitted(pool, job, arguments(chunk))] = chunk
                if not go_on(0):
                    break
            if not waiting:
                return
            going = go_on(0)
            patience = _POLL_SECONDS if going else 0.0
            for future in futures.wait(waiting, patience, futures.FIRST_COMPLETED).done:
                chunk = waiting.pop(future)
                reason = executor and ("cancelled" if future.cancelled() else future.exception())
                lost += [reason] if reason else []
                yield chunk, job(*arguments(chunk)) if reason else future.result()
    finally:
        if lost:
            text = (
                f"the executor lost {len(lost)} chunks of runs, which were driven here: {lost[0]!r}"
            )
            warnings.warn(text, RuntimeWarning, stacklevel=5)
        for future in waiting:
            future.cancel()
        if executor is None:
            pool.shutdown(cancel_futures=True)


def _submitted(pool: Any, job: Callable, arguments: tuple) -> futures.Future:
    """The future of a job; of one that a broken pool does not take, the reason is its result."""
    try:
        return pool.submit(job, *arguments)
    except RuntimeError as reason:
        refused: futures.Future = futures.Future()
        refused.set_exception(reason)
        return refused


@contextmanager
def watched(total: int, show_bar: bool) -> Iterator[Callable[[int], bool]]:
    """Yield a function that takes the number of finished runs and returns whether to go on.

    Ctrl-C is only noted: raised in a wait, it could break the lock there.
    """
    pressed: list[bool] = []
    if show_bar:
        from tqdm.auto import tqdm  # imported here, because it looks for a notebook

        bar = tqdm(total=total, unit=" runs", unit_scale=True, delay=_BAR_AFTER)

    def go_on(runs: int) -> bool:
        if show_bar:
            bar.update(runs)
        return not pressed

    usual = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    handled = usual and threading.current_thread() is threading.main_thread()
    if handled:
        signal.signal(signal.SIGINT, lambda *_: pressed.append(True))
    with bar if show_bar else nullcontext():
        try:
            yield go_on
        finally:
            if handled:
                signal.signal(signal.SIGINT, signal.default_int_handler)
