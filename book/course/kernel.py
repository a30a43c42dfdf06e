"""A kernel that a hand-in runs in: caged where the system can, and watched."""

from __future__ import annotations

import json
import os
import shutil
import socket
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from threading import Event, Thread
from typing import NamedTuple

import psutil
from cage import SCRATCH, caged, grouped, holds, next_user, write_filter
from judge import failure
from jupyter_client.kernelspec import KernelSpecManager
from jupyter_client.manager import AsyncKernelManager
from nbclient import NotebookClient
from nbclient.exceptions import DeadKernelError
from nbformat import NotebookNode

MOST_OUTPUT = 10_000_000  # bytes of a hand-in
MOST_PROCESSES = 128  # and threads
_PORTS = "shell_port", "iopub_port", "stdin_port", "control_port", "hb_port"
_KERNEL = """
import os, sys, threading
os.environ.pop("JPY_PARENT_PID", None)  # there, no parent has its number
memory, processes = int(sys.argv.pop(1)), int(sys.argv.pop(1))
sockets = [int(each) for each in sys.argv.pop(1).split(",") if each]
if sockets:  # they are made: in a cage no folder outlasts it in which it could make them
    import zmq
    bind = zmq.Socket.bind
    def bind_ours(socket, address):
        if address.startswith("ipc:"):
            socket.setsockopt(zmq.USE_FD, sockets[int(address.rpartition("-")[2]) - 1])
        return bind(socket, address)
    zmq.Socket.bind = bind_ours
try:
    import resource
    for name, most in ("AS", memory), ("FSIZE", 10**8), ("CORE", 0), ("NOFILE", 256):
        resource.setrlimit(getattr(resource, "RLIMIT_" + name), (most, most))
    if sockets:  # here none but its own processes count, since Linux 5.14
        resource.setrlimit(resource.RLIMIT_NPROC, (processes, processes))
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


class Client(NotebookClient):
    """One kernel, which is killed when it has printed too much.

    Also when it and what it started take too much memory: systems limit each process alone.
    """

    printed = 0
    why = ""

    def watch(self, memory: int, spared: int, ended: Event) -> None:
        """Kill it when it takes too much, until that event."""
        while not (self.why or ended.wait(0.4)):
            taken = 0
            for process in started(spared):
                with suppress(psutil.Error):
                    taken += process.memory_info().rss
            if taken > memory:
                self.kill(f"it took more than {memory / 1e9:g} GB")

    def kill(self, why: str) -> None:
        self.why = why
        self.km.provisioner.process.kill()

    def process_message(self, message, cell, index):
        self.printed += len(str(message["content"])) + sum(map(len, message["buffers"]))
        if self.printed > MOST_OUTPUT:
            return self.kill(f"it printed more than {MOST_OUTPUT // 10**6} MB")
        return super().process_message(message, cell, index)


class _Manager(AsyncKernelManager):
    def write_connection_file(self, **options: object) -> None:
        super().write_connection_file(**options)
        os.chmod(self.connection_file, 0o644)  # in a folder that nobody else reaches


class Place(NamedTuple):
    """Where kernels run: the folder whose `lib` they import, what hides, who may write to `lib`."""

    stage: Path
    hidden: list[Path]
    trusted: bool


@contextmanager
def running(
    notebook: NotebookNode,
    own: Path,
    place: Place,
    limits: Limits,
    left: Callable[..., int],
    spared: int,
) -> Iterator[Client]:
    """Give a client of a kernel in the folder `own`; when it ends, so does all that it started.

    `left` tells the seconds for the next cell; `spared` is a process that is not the kernel's.
    """
    (link := own / "link").mkdir(parents=True)
    ended = Event()
    groups = ExitStack()
    try:
        with ExitStack() as inherited:
            lib, home, fds = place.stage / "lib", Path("/tmp"), []
            if caging := holds():
                sockets = (_listening(f"{link}/k-{port + 1}") for port in range(len(_PORTS)))
                fds = [inherited.enter_context(each).fileno() for each in sockets]
            else:
                lib, home = own / "lib", own
                shutil.copytree(place.stage / "lib", lib)
            sizes = [str(limits.memory), str(MOST_PROCESSES), ",".join(map(str, fds))]
            command = [sys.executable, "-c", _KERNEL, *sizes, "-f", "{connection_file}"]
            if caging:
                rules = inherited.enter_context(tempfile.TemporaryFile())
                write_filter(rules)
                fds.append(rules.fileno())
                command = _in_cage(command, link, place, rules.fileno())
                most = limits.memory * 5 // 4 + SCRATCH  # the watch, which says why, comes first
                together = grouped(command, most, 2 * MOST_PROCESSES)
                command = groups.enter_context(together)
            client = Client(
                notebook,
                _manager(own, link, command),
                timeout_func=left,
                allow_errors=True,
                record_timing=False,
                shutdown_kernel="immediate",
                on_cell_executed=_failed,
            )
            where = {"cwd": own, "env": _environment(lib, home)}
            where |= {"pass_fds": fds} if fds else {}
            quiet = dict.fromkeys(("stdout", "stderr"), subprocess.DEVNULL)
            with client.setup_kernel(cleanup_kc=True, **where, **quiet):
                inherited.close()
                client.kc.stdin_channel.stop()  # nobody reads what would come there
                Thread(target=client.watch, args=(limits.memory, spared, ended)).start()
                yield client
    finally:
        ended.set()
        for process in started(spared):
            with suppress(psutil.Error):
                process.kill()
        groups.close()


def _in_cage(command: list[str], link: Path, place: Place, rules: int) -> list[str]:
    lib = place.stage / "lib"
    reads, writes = ([link], [lib]) if place.trusted else ([link, lib], [])
    user = None if place.trusted else next_user()
    return caged(command, reads=reads, writes=writes, hidden=place.hidden, rules=rules, user=user)


def started(spared: int) -> Iterator[psutil.Process]:
    """What this process has started, and what that has, but for one and what it forks."""
    for child in psutil.Process().children(recursive=True):
        with suppress(psutil.Error):
            if spared not in (child.pid, child.ppid()):
                yield child


def _listening(path: str) -> socket.socket:
    made = socket.socket(socket.AF_UNIX)
    made.bind(path)
    made.listen()
    return made


def _manager(own: Path, link: Path, command: list[str]) -> AsyncKernelManager:
    """What starts the command as a kernel."""
    spec = own / "kernels" / "hand-in"
    spec.mkdir(parents=True)
    settings = {"argv": command, "display_name": "hand-in", "language": "python"}
    (spec / "kernel.json").write_text(json.dumps(settings), encoding="utf-8")
    specs = KernelSpecManager(kernel_dirs=[str(spec.parent)], ensure_native_kernel=False)
    ways = dict(zip(_PORTS, range(1, 6), strict=True)) | {"transport": "ipc", "ip": f"{link}/k"}
    return _Manager(
        kernel_name="hand-in",
        kernel_spec_manager=specs,
        connection_file=str(link / "connection.json"),
        **(ways if os.name == "posix" else {}),
    )


def _environment(lib: Path, home: Path) -> dict[str, str]:
    """What a kernel is told: of this process's environment only what Python needs."""
    kept = "PATH", "LANG", "LC_ALL", "SYSTEMROOT", "VIRTUAL_ENV"
    threads = dict.fromkeys(("OMP", "OPENBLAS", "MKL", "NUMBA"), "2")
    return {
        **{name: os.environ[name] for name in kept if name in os.environ},
        **{f"{name}_NUM_THREADS": count for name, count in threads.items()},
        **dict.fromkeys(("HOME", "USERPROFILE", "TMPDIR", "TEMP"), str(home)),
        "PYTHONPATH": str(lib),
        "NUMBA_CACHE_DIR": str(lib / "wmrlib" / "__pycache__"),
        "MALLOC_ARENA_MAX": "2",  # each arena counts 64 MB of the memory
    }


def _failed(cell: NotebookNode, cell_index: int, execute_reply: dict) -> None:
    """Note an error that left no output."""
    content = execute_reply["content"]
    if content["status"] != "ok" and not any(o.output_type == "error" for o in cell.outputs):
        name = content.get("ename", content["status"])
        cell.outputs.append(failure("Stopped", name))
    if any(each.get("source") == "ask_exit" for each in content.get("payload", ())):
        raise DeadKernelError("exit")  # it would end while the next cell runs
