"""Run a notebook's cells in a process that can do little harm, and keep what was earned.

A kernel that dies, hangs or floods loses the cell it was in. Another one takes over: it runs
the cells before that one again, but for checks and for what has ended a kernel, then the rest.

On Linux a kernel sees neither the course nor what others handed in nor a network, and what it
started ends with it (`unshare` of util-linux does this, and needs no root). Elsewhere it runs
in a folder of its own, under the limits that the system has.
"""

from __future__ import annotations

import ctypes
import functools
import json
import logging
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from threading import Event, Thread
from typing import NamedTuple

import nbformat
import psutil
from handins import Refused
from jupyter_client.kernelspec import KernelSpecManager
from jupyter_client.manager import AsyncKernelManager
from nbclient import NotebookClient
from nbclient.exceptions import CellTimeoutError, DeadKernelError
from nbformat import NotebookNode

DRIVER = "import sandbox; sandbox.drive()"
MOST_OUTPUT = 10_000_000  # bytes of a hand-in
UNSHARE = ["unshare", "--user", "--map-root-user", "--mount", "--pid", "--net", "--ipc"]
UNSHARE += ["--fork", "--kill-child", "--mount-proc"]
# Of the first folder only the current one inside is left, of the others nothing, and nothing but
# that one can be written to. The shell stays: as the first process of its namespace, a kernel could
# not be killed by a signal of its own.
HIDE = """
set -e
stage=$1; own=$PWD; shift; aside=$1
while [ "$1" != -- ]; do mount -t tmpfs none "$1"; shift; done
shift
mkdir "$aside/own"; mount --bind "$own" "$aside/own"
mounts=$(cat /proc/mounts)
echo "$mounts" | while read -r _ at _ options _; do
  at=$(printf %b "$at") flags=ro
  for each in nosuid nodev noexec noatime nodiratime relatime; do
    case ,$options, in *,$each,*) flags=$flags,$each ;; esac
  done
  case $at in
    "$aside" | "$aside/own" | /proc*) ;;
    *) mount -o "remount,bind,$flags" "$at" || true ;;
  esac
done 2>/dev/null
if [ -w / ] || [ -w "$stage" ]; then exit 1; fi
mount -t tmpfs -o size=64m none /dev/shm || true
mount -t tmpfs none "$stage"; mkdir -p "$own"
mount --bind "$aside/own" "$own"; umount "$aside/own"; rmdir "$aside/own"
mount -o remount,bind,ro "$stage"; mount -o remount,bind,ro "$aside"
cd "$own"
setpriv --bounding-set=-all --inh-caps=-all --no-new-privs "$@"
"""
KERNEL = """
import os, sys
os.environ.pop("JPY_PARENT_PID", None)  # there, no parent has its number
memory = int(sys.argv.pop(1))
try:
    import resource
    for name, most in ("AS", memory), ("FSIZE", 10**8), ("CORE", 0):
        resource.setrlimit(getattr(resource, "RLIMIT_" + name), (most, most))
except (ImportError, ValueError, OSError):  # Windows has no limits, macOS not all
    pass
from ipykernel.kernelapp import launch_new_instance
launch_new_instance()
"""


class Limits(NamedTuple):
    """What a hand-in may take: seconds a cell, seconds in all, bytes of memory."""

    cell: float = 60.0
    whole: float = 300.0
    memory: int = 4_000_000_000


@functools.cache
def hides() -> bool:
    """Whether this system can hide folders from a process: whether `confined` works."""
    with tempfile.TemporaryDirectory() as name:
        stage, aside = Path(name, "stage"), Path(name, "aside")
        aside.mkdir()
        (stage / "own").mkdir(parents=True)
        try:
            command = confined(["true"], stage, [aside])
            return not subprocess.run(command, cwd=stage / "own", capture_output=True).returncode
        except OSError:
            return False


def confined(
    command: list[str], stage: Path, hidden: Iterable[Path], network: bool = False
) -> list[str]:
    """Return a command that sees no hidden folder, and of the stage only its own, the current."""
    there = [str(each) for each in hidden if each.is_dir()]
    options = [each for each in UNSHARE if not (network and each == "--net")]
    return [*options, "sh", "-c", HIDE, "hide", str(stage), *there, "--", *command]


class Sandbox:
    """Runs notebooks, each in a process of its own; use it in a `with` statement.

    hidden: folders that a notebook must not see, the first of which exists. What others
    run at the same time is hidden too. A notebook imports a copy of wmrlib and wmrbook.
    """

    def __init__(self, hidden: list[Path], limits: Limits) -> None:
        self.hidden = json.dumps(list(map(str, hidden)))
        self.limits = limits

    def __enter__(self) -> Sandbox:
        import wmrbook  # here, for a process that drives one notebook needs neither
        import wmrlib
        from wmrlib._compile import _FOLDERS

        self.stage = Path(tempfile.mkdtemp(prefix="wmr-"))
        for package in wmrlib, wmrbook:
            source = Path(package.__file__).parent
            copy = self.stage / "lib" / source.name  # without what older versions compiled
            shutil.copytree(source, copy, ignore=shutil.ignore_patterns("compiled-*"))
        self.compiled = self.stage / "lib" / "wmrlib" / "__pycache__"
        for folder in filter(Path.exists, _FOLDERS):
            shutil.copytree(folder, self.compiled / folder.name, dirs_exist_ok=True)
        return self

    def __exit__(self, *_: object) -> None:
        shutil.rmtree(self.stage, ignore_errors=True)

    def run(
        self, notebook: NotebookNode, student: str, others: Iterable[str], trusted: bool = False
    ) -> NotebookNode:
        """Return the notebook with its outputs; what a trusted one compiled, all need not.

        Because it compiles, it has five times as long. The checks are told who handed in and who
        else is in the class.
        """
        cell, whole, memory = self.limits
        more = 5 if trusted else 1
        limits = Limits(more * cell, more * whole, memory)
        for cell in notebook.cells:
            if _graded(cell):  # nbgrader gives all points to a check without an output
                cell.outputs = [_stopped("it did not run")]
        job = Path(tempfile.mkdtemp(dir=self.stage))
        result = job / "notebook.json"
        nbformat.write(notebook, result)
        told = {"WMR_STUDENT": student, "WMR_CLASS": ",".join(others)}
        settings = str(job), self.hidden, json.dumps(limits), json.dumps(told)
        with suppress(subprocess.TimeoutExpired):
            driver = subprocess.run(
                [sys.executable, "-c", DRIVER, *settings],
                cwd=Path(__file__).parent,
                capture_output=True,
                text=True,
                timeout=limits.whole + 120,
            )
            if driver.returncode:  # no fault of the notebook's, such as a full disk
                shutil.rmtree(job, ignore_errors=True)
                reason = driver.stderr.strip().rpartition("\n")[2]
                raise Refused(f"it could not be run, try again: {reason}")
        for compiled in job.glob("kernel-*/lib/wmrlib/__pycache__") if trusted else ():
            shutil.copytree(compiled, self.compiled, dirs_exist_ok=True)
        done = nbformat.read(result, as_version=4)
        shutil.rmtree(job, ignore_errors=True)
        return done


def stops(notebook: NotebookNode) -> list[str]:
    """What ended a kernel, and in which cells."""
    found = defaultdict(list)
    for cell in notebook.cells:
        name = cell.metadata.get("nbgrader", {}).get("grade_id", "a cell of their own")
        for output in cell.get("outputs", ()):
            if output.get("ename") == "Stopped":
                found[output.evalue].append(name)
    return [f"{', '.join(names)}: {why}" for why, names in found.items()]


class _Client(NotebookClient):
    """One kernel, which is killed when it has printed too much.

    Also when it and what it started take too much memory: systems limit each process alone.
    """

    printed = 0
    why = ""

    def watch(self, memory: int, ended: Event) -> None:
        """Kill it when it takes too much, until that event."""
        while not (self.why or ended.wait(0.5)):
            taken = 0
            for child in psutil.Process().children(recursive=True):
                with suppress(psutil.Error):
                    taken += child.memory_info().rss
            if taken > memory:
                self.why = f"it took more than {memory / 1e9:g} GB"
                self.km.provisioner.process.kill()

    def process_message(self, message, cell, index):
        self.printed += len(str(message["content"])) + sum(map(len, message["buffers"]))
        if self.printed > MOST_OUTPUT:
            self.why = f"it printed more than {MOST_OUTPUT // 10**6} MB"
            self.km.provisioner.process.kill()
            return None
        if message["msg_type"] == "execute_result" and _graded(cell):
            message["msg_type"] = message["header"]["msg_type"] = "display_data"  # no points
        return super().process_message(message, cell, index)


def drive() -> None:
    """Run the notebook of a job and store it after each cell; the process has no other task."""
    job, limits = Path(sys.argv[1]), Limits(*json.loads(sys.argv[3]))
    hidden, told = json.loads(sys.argv[2]), json.loads(sys.argv[4])
    logging.disable()
    if sys.platform == "linux":  # what a kernel leaves behind becomes a child of this process
        ctypes.CDLL(None).prctl(36, 1, 0, 0, 0)  # PR_SET_CHILD_SUBREAPER
    result, began = job / "notebook.json", time.monotonic()
    notebook = nbformat.read(result, as_version=4)
    cells, deadly, place, kernels = notebook.cells, set(), 0, 0

    def left(_=None) -> int:
        return max(1, int(min(limits.cell, began + limits.whole - time.monotonic())))

    while place < len(cells) and time.monotonic() - began < limits.whole:
        kernels += 1
        own = job / f"kernel-{kernels}"
        shutil.copytree(job.parent / "lib", own / "lib")
        client = _Client(
            notebook,
            _manager(own, job.parent, hidden, limits),
            timeout_func=left,
            allow_errors=True,
            record_timing=False,
            shutdown_kernel="immediate",
            on_cell_executed=_failed,
        )
        at, ended = None, Event()
        quiet = dict.fromkeys(("stdout", "stderr"), subprocess.DEVNULL)
        try:
            with client.setup_kernel(
                cleanup_kc=True, cwd=own, env=_environment(own) | told, **quiet
            ):
                Thread(target=client.watch, args=(limits.memory, ended)).start()
                again = [k for k in range(place) if k not in deadly and not _graded(cells[k])]
                for at in [*again, *range(place, len(cells))]:
                    client.execute_cell(cells[at], at)
                    if client.why:
                        raise DeadKernelError(client.why)
                    if at >= place:
                        place = at + 1
                        _store(notebook, result)
        except Exception as error:  # what a cell shows may be no output at all
            slow = f"it took over {limits.cell:g} s, or the whole over {limits.whole:g} s"
            known = {CellTimeoutError: slow, DeadKernelError: "it ended Python"}
            why = known.get(type(error), "what it shows is no output that a notebook can hold")
            if at is None:
                raise
            deadly.add(at)
            cells[at].outputs = [_stopped(client.why or why)]
            place = max(place, at + 1)
            _store(notebook, result)
        finally:
            ended.set()
            for child in psutil.Process().children(recursive=True):
                with suppress(psutil.Error):
                    child.kill()


def _manager(own: Path, stage: Path, hidden: list[str], limits: Limits) -> AsyncKernelManager:
    """What starts a kernel that sees little, in its folder."""
    command = [sys.executable, "-c", KERNEL, str(limits.memory), "-f", "{connection_file}"]
    if hides():
        command = confined(command, stage, map(Path, hidden))
    spec = own / "kernels" / "hand-in"
    spec.mkdir(parents=True)
    settings = {"argv": command, "display_name": "hand-in", "language": "python"}
    (spec / "kernel.json").write_text(json.dumps(settings), encoding="utf-8")
    sockets = {"transport": "ipc", "ip": str(own / "k")} if os.name == "posix" else {}
    return AsyncKernelManager(
        kernel_name="hand-in",
        kernel_spec_manager=KernelSpecManager(
            kernel_dirs=[str(spec.parent)], ensure_native_kernel=False
        ),
        connection_file=str(own / "connection.json"),
        **sockets,
    )


def _environment(own: Path) -> dict[str, str]:
    """What a kernel is told: of this process's environment only what Python needs."""
    kept = "PATH", "LANG", "LC_ALL", "SYSTEMROOT", "VIRTUAL_ENV"
    threads = dict.fromkeys(("OMP", "OPENBLAS", "MKL", "NUMBA"), "2")
    return {
        **{name: os.environ[name] for name in kept if name in os.environ},
        **{f"{name}_NUM_THREADS": count for name, count in threads.items()},
        **dict.fromkeys(("HOME", "USERPROFILE", "TMPDIR", "TEMP"), str(own)),
        "PYTHONPATH": str(own / "lib"),
        "MALLOC_ARENA_MAX": "2",  # each arena counts 64 MB of the memory
    }


def _graded(cell: NotebookNode) -> bool:
    return cell.cell_type == "code" and bool(cell.metadata.get("nbgrader", {}).get("grade"))


def _stopped(why: str) -> NotebookNode:
    return nbformat.v4.new_output("error", ename="Stopped", evalue=why, traceback=[why])


def _failed(cell: NotebookNode, cell_index: int, execute_reply: dict) -> None:
    """Note an error that left no output; a text on stderr, for which nbgrader gives 0, is none."""
    for output in cell.outputs:
        if output.output_type == "stream":
            output.name = "stdout"
    content = execute_reply["content"]
    if content["status"] != "ok" and not any(o.output_type == "error" for o in cell.outputs):
        cell.outputs.append(_stopped(content.get("ename", content["status"])))
    if any(each.get("source") == "ask_exit" for each in content.get("payload", ())):
        raise DeadKernelError("exit")  # it would end while the next cell runs


def _store(notebook: NotebookNode, path: Path) -> None:
    whole = path.with_suffix(".new")
    nbformat.write(notebook, whole)
    whole.replace(path)
