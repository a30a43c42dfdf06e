"""What a class costs a server: memory and time of each chapter's kernel, JupyterLab, and an app.

python tests/benchmarks/classroom.py [--keep]; --keep writes the table to book/classroom.json, which
the lecturer's guide shows. It starts a kernel for each chapter, JupyterLab, and Voila with readers
who all come at once. Memory is what a process has to itself (USS).
"""

from __future__ import annotations

import secrets
import sys
import tempfile
import time
import urllib.request
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

import nbformat
import psutil
from nbclient import NotebookClient
from timing import ROOT, Row, keep, machine, show

MEGABYTE = 1e6
READERS = (1, 2, 4, 8, 16)
TOKENS = {"jupyterlab": "IdentityProvider.token", "voila": "token"}
sys.path.insert(0, str(ROOT / "tests" / "browser"))
from live import chapters, free_port, serve  # noqa: E402  (it stands beside the browser tests)


def own_memory(*processes: psutil.Process) -> float:
    """MB that would be free without these processes and their children."""
    family = {one for process in processes for one in (process, *process.children(recursive=True))}
    return sum(one.memory_full_info().uss for one in family) / MEGABYTE


def students() -> list[Row]:
    rows = []
    for path in chapters():
        beside = {"metadata": {"path": path.parent}}
        client = NotebookClient(nbformat.read(path, as_version=4), resources=beside)
        begin = time.perf_counter()
        with client.setup_kernel():
            started = time.perf_counter() - begin
            for index, cell in enumerate(client.nb.cells):
                client.execute_cell(cell, index)
            seconds = time.perf_counter() - begin - started
            memory = own_memory(psutil.Process(client.km.provisioner.process.pid))
        rows.append(Row("A student's kernel, memory after all cells", path.stem, memory, "MB"))
        rows.append(Row("A student's kernel, time to run all cells", path.stem, seconds, "s"))
    return sorted(rows, key=lambda row: row.section)


def laboratory() -> list[Row]:
    options = "--allow-root", "--notebook-dir=notebooks"
    with served("jupyterlab", *options) as (process, address, seconds):
        assert "jupyter" in read(address("lab"))
        return [
            Row("A student's JupyterLab, without its kernels", "it starts", seconds, "s"),
            Row("A student's JupyterLab, without its kernels", "memory", own_memory(process), "MB"),
        ]


def readers() -> list[Row]:
    options = "--Voila.config_file_paths=book/voila", chapters()[0]
    with served("voila", *options) as (process, address, seconds):
        rows = [Row("An app's readers", "the server starts", seconds, "s")]
        empty = own_memory(process)
        rows.append(Row("An app's readers", "the server alone", empty, "MB"))
        for count in READERS:
            begin = time.perf_counter()
            with ThreadPoolExecutor(count) as pool:
                pages = list(pool.map(read, [address("")] * count))
            assert all("wmr" in page for page in pages)
            what, took = "come at once: the last page is complete", time.perf_counter() - begin
            rows.append(Row("An app's readers", f"{count} {what}", took, "s"))
        each = (own_memory(process) - empty) / sum(READERS)
        return [*rows, Row("An app's readers", "each reader's kernel", each, "MB")]


@contextmanager
def served(module: str, *options) -> Iterator[tuple]:
    """A running server: its process, its addresses by path, and the seconds it took to start."""
    token, begin = secrets.token_hex(8), time.perf_counter()
    url = f"http://127.0.0.1:{(port := free_port())}/"
    command = [sys.executable, "-m", module, "--no-browser", f"--port={port}"]
    command += [f"--{TOKENS[module]}={token}", *options]
    with (
        tempfile.TemporaryDirectory() as folder,
        serve(command, url, Path(folder, "log")) as server,
    ):
        seconds = time.perf_counter() - begin
        yield psutil.Process(server.pid), lambda path: f"{url}{path}?token={token}", seconds


def read(url: str) -> str:
    opener = urllib.request.build_opener(urllib.request.HTTPCookieProcessor())
    with opener.open(url, timeout=600) as answer:
        return answer.read().decode()


if __name__ == "__main__":
    if set(sys.argv[1:]) - {"--keep"}:
        sys.exit(__doc__)
    print(machine())
    table = [*laboratory(), *students(), *readers()]
    show(table)
    if "--keep" in sys.argv:
        keep("classroom.json", table)
