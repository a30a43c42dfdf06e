"""Work in chunks, on threads or on an executor, which Ctrl-C stops and keeps what is done."""

from __future__ import annotations

import multiprocessing
import signal
import threading
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent import futures
from contextlib import contextmanager, nullcontext
from itertools import islice
from typing import Any

import numba

CORES = numba.config.NUMBA_NUM_THREADS  # that this process may use
_BAR_AFTER = 1.0  # s
_HEARD_AFTER = 0.5  # s; so late a wait may hear Ctrl-C
_IN_FLIGHT = 128  # chunks handed over and not yet back: what is in memory beside the result
_LOST = futures.BrokenExecutor, futures.CancelledError, ConnectionError, KeyboardInterrupt


def spread(job, chunks: Iterable, arguments, go_on, executor, lost: list) -> Generator:
    """(chunk, result) as each is done, on threads without an executor; a bounded number at a time.

    What is lost with its worker is done here, and why is added to `lost`. An error of the job
    itself is raised.
    """
    pool, chunks = executor or futures.ThreadPoolExecutor(CORES), iter(chunks)
    waiting: dict[futures.Future, Any] = {}
    going = True
    try:
        while going:
            for chunk in islice(chunks, _IN_FLIGHT - len(waiting)):
                try:
                    with _deaf_children() if executor else nullcontext():
                        future = pool.submit(_deaf, job, *arguments(chunk))
                    waiting[future] = chunk
                except (RuntimeError, OSError) as error:  # it is broken, closed or out of means
                    lost.append(error)
                    yield chunk, job(*arguments(chunk))
                if not go_on(0):
                    break
            if not waiting:
                return
            going = go_on(0)
            patience = _HEARD_AFTER if going else 0.0
            for future in futures.wait(waiting, patience, futures.FIRST_COMPLETED).done:
                chunk = waiting.pop(future)
                why = futures.CancelledError() if future.cancelled() else future.exception()
                if why is None:
                    yield chunk, future.result()
                elif not isinstance(why, _LOST) and "distributed." not in type(why).__module__:
                    raise why
                elif going:
                    lost.append(why)
                    yield chunk, job(*arguments(chunk))
    finally:
        for future in waiting:
            future.cancel()
        if executor is None:
            pool.shutdown(cancel_futures=True)


def _deaf(job: Callable, *arguments: Any) -> Any:
    """The job; Ctrl-C, which a terminal sends to a pool's processes too, is not theirs to hear."""
    worker = multiprocessing.parent_process() is not None
    if worker and threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGINT, signal.SIG_IGN)
    return job(*arguments)


@contextmanager
def _deaf_children() -> Iterator[None]:
    """Processes that begin here do not hear Ctrl-C, not even while they import their modules."""
    mask = getattr(signal, "pthread_sigmask", None)  # not on Windows
    before = mask(signal.SIG_BLOCK, {signal.SIGINT}) if mask else None
    try:
        yield
    finally:
        if mask:
            mask(signal.SIG_SETMASK, before)


@contextmanager
def watched(total: int, bar_wanted: bool) -> Iterator[Callable[[int], bool]]:
    """What is yielded takes the number of runs just done, and says whether to go on.

    Ctrl-C is only noted: raised in a wait, it could break the lock there.
    """
    pressed: list[bool] = []
    if bar_wanted:
        from tqdm.auto import tqdm  # here, because it asks what it is shown in

        bar = tqdm(total=total, unit=" runs", unit_scale=True, delay=_BAR_AFTER)

    def go_on(runs: int) -> bool:
        if bar_wanted:
            bar.update(runs)
        return not pressed

    usual = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    heard = usual and threading.current_thread() is threading.main_thread()
    if heard:
        signal.signal(signal.SIGINT, lambda *_: pressed.append(True))
    with bar if bar_wanted else nullcontext():
        try:
            yield go_on
        finally:
            if heard:
                signal.signal(signal.SIGINT, signal.default_int_handler)
