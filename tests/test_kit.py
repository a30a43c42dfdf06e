"""The panels' kit is linted, its types are checked, and its lines are no longer than Python's."""

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


def test_no_line_is_longer_than_in_python():
    kinds = {".js", ".mjs", ".css"}
    ours = [*BOOK.rglob("*.*"), *Path(__file__).parent.rglob("*.*")]
    skipped = {"node_modules", "_build", "vendor"}
    for path in ours:
        if path.suffix in kinds and not skipped & {*path.parts}:
            lines = path.read_text(encoding="utf-8").splitlines()
            wide = [number for number, line in enumerate(lines, 1) if len(line) > 100]
            assert not wide, f"{path}: {wide}"
