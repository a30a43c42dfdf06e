"""Judge answers where no hand-in reaches: the checks run here, and ask the kernel for values."""

from __future__ import annotations

import ast
import builtins
import multiprocessing
import os
import sys
from contextlib import redirect_stdout, suppress
from io import StringIO
from multiprocessing.connection import Client, Connection, Listener
from pathlib import Path
from typing import Any

import nbformat
import psutil
from cells import defined
from nbformat import NotebookNode

from wmrbook.grading._wire import Line

GIVEN = {"grade": False, "solution": False}
ANSWER = "import wmrbook.grading._wire as wire; wire.serve({!r}, globals())"


class Bench:
    """The process that judges one notebook; use it in a `with` statement."""

    def __init__(self, cells: list[NotebookNode], limits: Any, told: dict[str, str]) -> None:
        forks = sys.platform == "linux"
        context = multiprocessing.get_context("fork" if forks else "spawn")
        self.orders, theirs = context.Pipe()
        given = theirs, self.orders if forks else None, cells, limits, told
        self.process = context.Process(target=_judge, args=given)
        self.process.start()
        theirs.close()
        self.pid = self.process.pid

    def __enter__(self) -> Bench:
        return self

    def __exit__(self, *_: object) -> None:
        self.orders.close()
        self.process.join(1.0)
        self.process.kill()

    def verdict(self, client: Any, number: int, own: Path) -> list[NotebookNode]:
        """What a check shows, after what the answers print while it asks them."""
        path = str(own / "link" / f"asks-{number}")
        if os.name == "nt":
            path = rf"\\.\pipe\{own.parent.name}-{own.name}-{number}"
        self.orders.send((number, path))
        self._reply(number)
        cell = nbformat.v4.new_code_cell(ANSWER.format(path))
        check = client.nb.cells[number]
        try:
            client.execute_cell(cell, number)
        finally:
            client.nb.cells[number] = check  # the client had put the other in its place
            with suppress(OSError):  # had the kernel not called, the judge would wait for it
                Client(path).close()
        printed = [each for each in cell.outputs if each.output_type == "stream"]
        for each in printed:
            each.name = "stdout"  # for a text on stderr nbgrader gives 0
        return printed + self._reply(number)

    def _reply(self, number: int) -> Any:
        """The next reply that is about this check."""
        while (reply := self.orders.recv())[0] != number:
            pass
        return reply[1]


def _judge(
    orders: Connection, other: Connection | None, cells: list, limits: Any, told: dict
) -> None:
    """For each order (number of a check, path of a line) send (number, outputs of the check).

    Where it can, a process of its own does it: what a hand-in sends may take for ever, or end it.
    """
    if other:
        other.close()
    os.environ.update(told)
    limit(limits.memory)
    with suppress(EOFError, OSError):
        while True:
            number, path = orders.recv()
            given = [cell.source for cell in cells[:number] if _is_given(cell)]
            with Listener(path) as listener:
                if os.name == "posix":
                    os.chmod(path, 0o777)  # whoever the kernel is; only it sees the folder
                orders.send((number, None))
                task = cells[number].source, given, listener
                orders.send((number, _apart(task, limits.cell)))


def _apart(task: tuple, seconds: float) -> list[NotebookNode]:
    if "fork" not in multiprocessing.get_all_start_methods():
        return _verdict(*task)
    context = multiprocessing.get_context("fork")
    ours, theirs = context.Pipe()
    process = context.Process(target=lambda: theirs.send(_verdict(*task)))
    process.start()
    theirs.close()
    try:
        return ours.recv() if ours.poll(seconds) else [failure("Stopped", "it took too long")]
    except EOFError:
        return [failure("Stopped", "what it returns can't be judged")]
    finally:
        process.kill()
        process.join()


def _verdict(source: str, given: list[str], listener: Listener) -> list[NotebookNode]:
    """What the check shows: what it prints, or how it fails."""
    said = StringIO()
    try:
        with listener.accept() as link, redirect_stdout(said):
            line = Line(link, {})
            names = {"__name__": "__main__"}
            for name in _asked(source):
                _define(name, given, names, line)
            exec(compile(source, "<check>", "exec"), names)
    except BaseException as error:
        if isinstance(error, (EOFError, OSError)):
            return [failure("Stopped", "its kernel gave no answer")]
        return [failure(type(error).__name__, str(error))]
    return [nbformat.v4.new_output("stream", text=said.getvalue())]


def _define(name: str, given: list[str], names: dict, line: Line) -> None:
    """Define a name as the cells that are ours do; what none of them makes is an answer's."""
    if name in names or hasattr(builtins, name):
        return
    for k in reversed(range(len(given))):
        if name in defined(given[k]):
            for each in _asked(given[k]):
                _define(each, given[:k], names, line)
            exec(compile(given[k], "<given>", "exec"), names)
            return
    with suppress(NameError):  # the check itself says so
        names[name] = line.value(name)


def _asked(source: str) -> list[str]:
    """The names that a cell of ours uses, and does not define itself."""
    used = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Name)]
    own = defined(source) | {node.id for node in used if isinstance(node.ctx, ast.Store)}
    return list(dict.fromkeys(node.id for node in used if node.id not in own))


def _is_given(cell: NotebookNode) -> bool:
    ours = cell.metadata.get("nbgrader", {})
    return cell.cell_type == "code" and GIVEN.items() <= ours.items()


def failure(name: str, text: str) -> NotebookNode:
    """What a cell shows that fails."""
    lines = [f"{name}: {text}"]
    return nbformat.v4.new_output("error", ename=name, evalue=text, traceback=lines)


def limit(memory: int, seconds: int = 0) -> None:
    """Limit what this process takes from now on: bytes beyond what it has, seconds of a processor.

    It reads what somebody handed in. What it starts may raise the limit for itself.
    """
    if sys.platform == "linux":
        import resource

        most = {resource.RLIMIT_AS: psutil.Process().memory_info().vms + memory}
        most |= {resource.RLIMIT_CPU: seconds} if seconds else {}
        for kind, value in most.items():
            _, hard = resource.getrlimit(kind)  # of the system's, or of who started us
            wanted = value if hard == resource.RLIM_INFINITY else min(value, hard)
            resource.setrlimit(kind, (wanted, hard))
