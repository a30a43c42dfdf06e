"""The recipes of CONTRIBUTING.md, followed word for word in a copy of the repository."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LEFT_OUT = shutil.ignore_patterns(".git", ".venv", "__pycache__", "_build", "node_modules")


def blocks(recipe: str) -> list[str]:
    """The code that a recipe gives, in order."""
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    section = text.partition(f"\n## {recipe}\n")[2].partition("\n## ")[0]
    found = re.findall(r"^ *```\w+\n(.*?)^ *```", section, re.DOTALL | re.MULTILINE)
    return [textwrap.dedent(block) for block in found]


def copied(folder: Path) -> Path:
    """A copy of the repository."""
    return shutil.copytree(ROOT, folder, ignore=LEFT_OUT, dirs_exist_ok=True)


def put(path: Path, text: str, before: str) -> None:
    """Put text in front of the one place that reads `before`."""
    whole = path.read_text(encoding="utf-8")
    assert whole.count(before) == 1, (path, before)
    path.write_text(whole.replace(before, text + before), encoding="utf-8")


def run(folder: Path, *arguments: str) -> None:
    """Run Python in the copy; where it fails, the test does."""
    places = os.pathsep.join(str(folder / place) for place in ("", "book", "book/robot"))
    environment = os.environ | {"PYTHONPATH": places, "PYTEST_ADDOPTS": ""}
    options = {"cwd": folder, "env": environment, "text": True, "encoding": "utf-8"}
    done = subprocess.run([sys.executable, *arguments], capture_output=True, **options)
    assert done.returncode == 0, done.stdout + done.stderr


def check(folder: Path, *tests: str) -> None:
    """Run tests of the copy."""
    options = ["-q", "-m", "", "-p", "no:cacheprovider", "-p", "no:nbval"]
    run(folder, "-m", "pytest", "--override-ini=addopts=", *options, *tests)
