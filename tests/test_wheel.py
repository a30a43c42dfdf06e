"""The wheel: what it carries, and that the library's first example runs from it alone."""

import os
import re
import subprocess
import sys
from pathlib import Path
from zipfile import ZipFile

import pytest

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    folder = tmp_path_factory.mktemp("wheel")
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", folder]
    subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
    (built,) = folder.glob("*.whl")
    return ZipFile(built)


def test_it_has_the_packages_and_nothing_else(wheel):
    files = set(wheel.namelist())
    (metadata,) = {name.split("/")[0] for name in files} - {"wmrlib", "wmrbook", "wmrrobot"}
    assert re.fullmatch(r"wmrlib-[\d.]+\.dist-info", metadata)
    in_the_tree = {
        path.relative_to(package.parent).as_posix()
        for package in (ROOT / "wmrlib", ROOT / "book/wmrbook", ROOT / "book/robot/wmrrobot")
        for path in package.rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    assert {name for name in files if not name.startswith(metadata)} == in_the_tree
    assert {"wmrlib/py.typed", "wmrrobot/c/wmr_drive.h", "wmrrobot/templates/my_robot.h"} <= files


def test_the_librarys_first_example_runs_from_it(wheel, tmp_path):
    wheel.extractall(tmp_path / "site")
    text = (ROOT / "book" / "api.md").read_text(encoding="utf-8")
    lines = re.search(r"```python\n(.*?)```", text, re.DOTALL)[1]
    done = subprocess.run(
        [sys.executable, "-c", f"{lines}\nprint(wmr.__file__)"],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": str(tmp_path / "site")},
        capture_output=True,
        text=True,
        check=True,
    )
    *printed, file = done.stdout.splitlines()
    assert printed
    assert Path(file).is_relative_to(tmp_path / "site")
