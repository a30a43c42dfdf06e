"""Kernels that talk through files: of two that start at once, both may pick the same TCP port."""

import os
from functools import partialmethod
from uuid import uuid4

from jupyter_client import KernelManager


def use_files() -> None:
    """Let all kernels that this process starts talk through files in /tmp, where there is one."""
    if os.name == "posix":
        KernelManager.__init__ = partialmethod(_begin, KernelManager.__init__)


def _begin(manager: KernelManager, begin, *arguments, **options) -> None:
    # Jupyter's own place for the files depends on the working directory, and the kernel's differs.
    files = {"transport": "ipc", "ip": f"/tmp/kernel-{uuid4().hex}"}
    begin(manager, *arguments, **(files | options))
