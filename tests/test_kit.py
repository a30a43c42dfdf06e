"""The panels' kit is linted, and its types are checked."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from build import BOOK, MODULES, install_javascript


@pytest.mark.needs("npm")
@pytest.mark.parametrize("command", ["eslint wmrbook/panel", "tsc --project ."])
def test_linter_and_compiler_find_nothing(command):
    install_javascript()
    name, *arguments = command.split()
    program = shutil.which(name, path=MODULES / ".bin")
    folders = [str(Path(sys.executable).parent), os.environ["PATH"]]  # of a node from PyPI
    paths = os.environ | {"PATH": os.pathsep.join(folders)}
    done = subprocess.run(
        [program, *arguments], cwd=BOOK, env=paths, capture_output=True, text=True
    )
    assert not done.returncode, done.stdout + done.stderr
