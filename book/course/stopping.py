"""Ctrl-C ends what runs, and interrupts nothing that is being written."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from threading import Event, current_thread, main_thread
from typing import Any

import psutil


@contextmanager
def heeding(handler: Any) -> Iterator[None]:
    """Let Ctrl-C do this, in the thread that hears it."""
    if current_thread() is not main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


@contextmanager
def stoppable() -> Iterator[Event]:
    """Let Ctrl-C set an event, and interrupt nothing that is being written."""
    stopped = Event()
    with heeding(lambda *_: stopped.set()):
        yield stopped


def end() -> None:
    """End what runs."""
    ours = psutil.Process()
    staying = [] if os.name == "nt" else ours.children()  # they fork the others, and clear up
    for child in set(ours.children(recursive=True)) - set(staying):
        with suppress(psutil.Error):
            child.kill()
