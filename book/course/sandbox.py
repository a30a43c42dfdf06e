"""Run a notebook's cells in a process that can do little harm, and keep what was earned.

A kernel that dies, hangs or floods loses the cell it was in. Another one takes over: it runs
the cells before that one again, but for checks and for what has ended a kernel, then the rest.
A check does not run there: judge.py asks the kernel for values, and says what they are worth.
"""

from __future__ import annotations

import ctypes
import logging
import multiprocessing
import os
import shutil
import signal
import sys
import tempfile
import time
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from multiprocessing import forkserver
from pathlib import Path
from typing import Any
from unittest.mock import patch

import handins
import nbformat
from handins import Refused
from judge import Bench, failure, limit
from kernel import Limits, Place, running
from nbclient.exceptions import CellTimeoutError, DeadKernelError
from nbformat import NotebookNode
from stopping import heeding

from wmrbook import grading

MESSAGES = 2_000_000_000  # bytes of what a kernel sends before anybody counts it
READING = 10  # s of a processor to read and repair a hand-in


class Sandbox:
    """Runs notebooks, each in a process of its own; use it in a `with` statement.

    hidden: folders that a notebook must not see, wherever Python stands. A notebook imports a copy
    of wmrlib and wmrbook.
    """

    def __init__(self, hidden: list[Path], limits: Limits) -> None:
        self.hidden, self.limits = hidden, limits

    def __enter__(self) -> Sandbox:
        import wmrbook
        import wmrlib
        from wmrlib.compilation import FOLDER

        self.stage = Path(tempfile.mkdtemp(prefix="wmr-"))
        for package in wmrlib, wmrbook:
            source = Path(package.__file__).parent
            copy = self.stage / "lib" / source.name  # without what older versions compiled
            shutil.copytree(source, copy, ignore=shutil.ignore_patterns("compiled-*"))
        compiled = self.stage / "lib" / "wmrlib" / "__pycache__"
        if FOLDER:
            shutil.copytree(FOLDER, compiled / FOLDER.name, dirs_exist_ok=True)
        self.processes = _processes()
        return self

    def __exit__(self, *_: object) -> None:
        shutil.rmtree(self.stage, ignore_errors=True)

    def repaired(self, path: Path, release: NotebookNode) -> tuple[NotebookNode, list[str]]:
        """Read and repair a hand-in as handins.py does, within limits; raises Refused."""
        with _folder(self.stage) as job:
            most = READING, self.limits.memory // 4
            self._apart(_repair, 20 * READING, job, path, release, *most)
            if not (job / "notebook.json").exists():
                raise Refused(f"{path.name} takes too long to read, or too much memory")
            done = nbformat.read(job / "notebook.json", as_version=4)
        return done, done.metadata.pop("how")

    def run(
        self, notebook: NotebookNode, student: str, others: Iterable[str], trusted: bool = False
    ) -> NotebookNode:
        """Return the notebook with its outputs; what a trusted one compiled, all need not.

        Because it compiles, it has five times as long. The checks are told who handed in and who
        else is in the class. Raises Refused for what is no fault of the notebook's.
        """
        cell, whole, memory = self.limits
        more = 5 if trusted else 1
        limits = Limits(more * cell, more * whole, memory)
        for cell in notebook.cells:
            if is_check(cell):  # nbgrader gives all points to a check without an output
                cell.outputs = [failure("Stopped", "it did not run")]
        told = {"WMR_STUDENT": student, "WMR_CLASS": ",".join(others)}
        with _folder(self.stage) as job:
            nbformat.write(notebook, job / "notebook.json")
            where = Place(self.stage, self.hidden, trusted)
            self._apart(_drive, limits.whole + 120, job, where, limits, told)
            return nbformat.read(job / "notebook.json", as_version=4)

    def _apart(self, function: Callable, seconds: float, job: Path, *given: Any) -> None:
        """Run `function(job, *given)` in a process of its own; raise Refused with its fault."""
        process = self.processes.Process(target=_noted, args=(function, job, *given))
        process.start()
        process.join(seconds)
        process.kill()
        process.join()
        with suppress(FileNotFoundError):
            raise Refused((job / "fault").read_text(encoding="utf-8"))


def stops(notebook: NotebookNode) -> list[str]:
    """What ended a kernel, and in which cells."""
    found = defaultdict(list)
    for cell in notebook.cells:
        name = cell.metadata.get("nbgrader", {}).get("grade_id", "a cell of their own")
        for output in cell.get("outputs", ()):
            if output.get("ename") == "Stopped":
                found[output.evalue].append(name)
    return [f"{', '.join(names)}: {why}" for why, names in found.items()]


def is_check(cell: NotebookNode) -> bool:
    """Whether it is ours and gives points; what an assistant marks by hand does not run."""
    ours = cell.metadata.get("nbgrader", {})
    return cell.cell_type == "code" and bool(ours.get("grade")) and not ours.get("solution")


@contextmanager
def _folder(stage: Path) -> Iterator[Path]:
    with tempfile.TemporaryDirectory(dir=stage, ignore_cleanup_errors=True) as name:
        yield Path(name)


def _processes() -> Any:
    """What starts processes; where it can, it forks them from one that has loaded all they need."""
    if "forkserver" not in multiprocessing.get_all_start_methods():
        return multiprocessing.get_context("spawn")
    context = multiprocessing.get_context("forkserver")
    checks = [f"wmrbook.grading.{name}" for name in grading.__all__ if name.islower()]
    context.set_forkserver_preload(["grade", "warm", *checks])
    path = os.pathsep.join(filter(None, sys.path))
    with patch.dict(os.environ, {"PYTHONPATH": path}), heeding(signal.SIG_IGN):
        forkserver.ensure_running()
    return context


def _noted(function: Callable, job: Path, *given: Any) -> None:
    """Run it; what goes wrong is no fault of the notebook's, such as a full disk."""
    try:
        function(job, *given)
    except Exception as fault:
        refused = isinstance(fault, Refused)
        why = "" if refused else f"it could not be run, try again: {type(fault).__name__}: "
        (job / "fault").write_text(f"{why}{fault}", encoding="utf-8")


def _repair(job: Path, path: Path, release: NotebookNode, seconds: int, memory: int) -> None:
    limit(memory, seconds)
    notebook, how = handins.repaired(handins.read(path), release)
    notebook.metadata["how"] = how
    handins.write(job / "notebook.json", nbformat.writes(notebook))


def _drive(job: Path, where: Place, limits: Limits, told: dict) -> None:
    """Run the notebook of a job and store it after each cell; the process has no other task."""
    logging.disable()
    limit(MESSAGES)
    if sys.platform == "linux":  # what a kernel leaves behind becomes a child of this process
        ctypes.CDLL(None).prctl(36, 1, 0, 0, 0)  # PR_SET_CHILD_SUBREAPER
    result, began = job / "notebook.json", time.monotonic()
    notebook = nbformat.read(result, as_version=4)
    cells, deadly, place, kernels = notebook.cells, set(), 0, 0

    def left(_=None) -> int:
        return max(1, int(min(limits.cell, began + limits.whole - time.monotonic())))

    with Bench(cells, limits, told) as bench:
        while place < len(cells) and time.monotonic() - began < limits.whole:
            kernels += 1
            own, at, client = job / f"kernel-{kernels}", None, None
            try:
                with running(notebook, own, where, limits, left, bench.pid) as client:
                    again = [k for k in range(place) if k not in deadly and not is_check(cells[k])]
                    for at in [*again, *range(place, len(cells))]:
                        if is_check(cells[at]):
                            cells[at].outputs = bench.verdict(client, at, own)
                        else:
                            client.execute_cell(cells[at], at)
                        if client.why:
                            raise DeadKernelError(client.why)
                        if at >= place:
                            place = at + 1
                            handins.write(result, nbformat.writes(notebook))
            except Exception as fault:  # what a cell shows may be no output at all
                slow = f"it took over {limits.cell:g} s, or the whole over {limits.whole:g} s"
                known = {CellTimeoutError: slow, DeadKernelError: "it ended Python"}
                known[MemoryError] = "it sent more than can be read"
                why = known.get(type(fault), "what it shows is no output that a notebook can hold")
                if at is None:
                    raise
                deadly.add(at)
                cells[at].outputs = [failure("Stopped", client.why or why)]
                place = max(place, at + 1)
                handins.write(result, nbformat.writes(notebook))
