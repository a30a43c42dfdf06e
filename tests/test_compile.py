"""The cache: nothing is compiled twice, and an edited formula is never run from an old binary."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import wmrlib as wmr
from wmrlib import _compile

PACKAGE = Path(wmr.__file__).parent
TERM = "alpha + gains.h * theta"  # of the laws
RUN = """
import wmrlib as w
run = w.simulate(w.Pose(0, 0, 0), w.Pose(3, 1, 0.5), w.Gains(1, 2, 0.5), dt=0.05)
from wmrlib._loops import plane
stats = getattr(plane.drive, "stats", None)
print(float(run.x[-1]), float(run.heading[-1]), sum(stats.cache_misses.values()) if stats else None)
"""


def test_a_second_process_compiles_nothing_an_edit_compiles_anew_and_plain_python_agrees(tmp_path):
    copy = tmp_path / "wmrlib"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))

    def fresh(**more):
        settings = {name: value for name, value in os.environ.items() if name[:6] != "NUMBA_"}
        settings |= {"PYTHONPATH": str(tmp_path), "PYTHONDONTWRITEBYTECODE": "1"} | more
        options = {"cwd": tmp_path, "env": settings, "text": True, "check": True}
        command = [sys.executable, "-c", RUN]
        *ends, misses = subprocess.run(command, capture_output=True, **options).stdout.split()
        return [float(end) for end in ends], misses

    first = fresh()
    assert first[1] == "1"
    assert fresh() == (first[0], "0")
    plain, _ = fresh(NUMBA_DISABLE_JIT="1")
    assert plain == pytest.approx(first[0], rel=1e-12)
    law = next(path for path in copy.glob("*.py") if TERM in path.read_text(encoding="utf-8"))
    text = law.read_text(encoding="utf-8").replace(TERM, TERM.replace("+", "-"))
    law.write_text(text, encoding="utf-8")
    edited, misses = fresh()
    assert misses == "1"
    assert edited != pytest.approx(first[0], rel=1e-3)


def test_an_edit_to_any_compiled_module_leads_to_another_folder(monkeypatch, tmp_path):
    users = {
        path
        for path in PACKAGE.rglob("*.py")
        if "wmrlib._compile import" in path.read_text(encoding="utf-8")
    }
    assert PACKAGE / "_loops" / "polar.py" in users <= set(_compile._SOURCES)
    copies = [Path(shutil.copy(path, tmp_path / f"{k}.py")) for k, path in enumerate(users)]
    monkeypatch.setattr(_compile, "_SOURCES", copies)
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "mine"))
    folders = {_compile._cache_folder()}
    for path in copies:
        path.write_text("# an edit", encoding="utf-8")
        folders.add(_compile._cache_folder())
    assert len(folders) == len(users) + 1
    assert all(Path(folder).parent == tmp_path / "mine" for folder in folders)


def test_where_the_package_cannot_be_written_to_the_cache_is_at_home_or_numbas(
    monkeypatch, tmp_path
):
    (tmp_path / "file").touch()
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    monkeypatch.setattr(_compile, "_PACKAGE", tmp_path / "file")
    monkeypatch.setattr(Path, "home", lambda: tmp_path)
    assert Path(_compile._cache_folder()).parent == tmp_path / ".cache" / "wmrlib"
    monkeypatch.setattr(Path, "home", lambda: tmp_path / "file")
    assert _compile._cache_folder() == ""


def test_one_entry_beside_a_number_and_read_only_arrays_bring_no_warning():
    one, fixed, goal = np.zeros(1), np.zeros(3), wmr.Pose(1.0, 0.0, 0.0)
    fixed.flags.writeable = False
    assert wmr.polar_error(wmr.Pose(one, one, one), goal).rho.tolist() == [1.0]
    assert wmr.polar_error(wmr.Pose(fixed, 0.0, 0.0), goal).rho.tolist() == [1.0] * 3
    assert wmr.wrap_angle(np.zeros((2, 3)).T).shape == (3, 2)
