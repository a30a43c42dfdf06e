"""Kernels that talk through files, and one for all pages that a process reads.

Of two kernels that start at once, both may pick the same TCP port.
"""

import os
from functools import cache, partialmethod
from multiprocessing.util import Finalize
from uuid import uuid4

from jupyter_client import KernelManager
from nbformat import NotebookNode
from nbformat.v4 import new_code_cell


def use_files() -> None:
    """Let all kernels that this process starts talk through files in /tmp, where there is one."""
    if os.name == "posix":
        KernelManager.__init__ = partialmethod(_begin, KernelManager.__init__)


def _begin(manager: KernelManager, begin, *arguments, **options) -> None:
    # Jupyter's own place for the files depends on the working directory, and the kernel's differs.
    files = {"transport": "ipc", "ip": f"/tmp/kernel-{uuid4().hex}"}
    begin(manager, *arguments, **(files | options))


def share() -> None:
    """Let one kernel execute all pages that MyST-NB reads in a process: to start takes longest."""
    from jupyter_cache.executors import utils

    utils.executenb = _execute


def _execute(notebook: NotebookNode, cwd: str, **options) -> None:
    import nbclient  # which the tests, that need the other function alone, need not load

    notebook.cells.insert(0, new_code_cell("%reset -f"))  # what the page before has defined
    nbclient.execute(notebook, cwd, _kernel(cwd), **options)
    del notebook.cells[0]


@cache
def _kernel(folder: str) -> KernelManager:
    manager = KernelManager()
    manager.start_kernel(extra_arguments=["--HistoryManager.hist_file=:memory:"], cwd=folder)
    Finalize(None, manager.shutdown_kernel, kwargs={"now": True}, exitpriority=0)
    return manager
