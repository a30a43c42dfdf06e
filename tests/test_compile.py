"""The cache: nothing is compiled twice, and an edited formula is never answered from an old binary."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import wmrlib
import wmrlib as wmr

PACKAGE = Path(wmrlib.__file__).parent
RUN = """
import wmrlib as w
run = w.simulate(w.Pose(0, 0, 0), w.Pose(3, 1, 0.5), w.Gains(1, 2, 0.5), dt=0.05)
from wmrlib._loops import plane
stats = getattr(plane.drive, "stats", None)
print(float(run.x[-1]), float(run.heading[-1]), sum(stats.cache_misses.values()) if stats else None)
"""


@pytest.fixture
def copy(tmp_path):
    """A copy of the package whose cache is empty; a function runs a fresh Python on it."""
    shutil.copytree(PACKAGE, tmp_path / "wmrlib", ignore=shutil.ignore_patterns("__pycache__"))

    def run(**environment):
        settings = {key: value for key, value in os.environ.items() if not key.startswith("NUMBA_")}
        settings |= {"PYTHONPATH": str(tmp_path), "PYTHONDONTWRITEBYTECODE": "1"} | environment
        done = subprocess.run(
            [sys.executable, "-c", RUN],
            cwd=tmp_path,
            env=settings,
            capture_output=True,
            text=True,
            check=True,
        )
        return done.stdout.split()

    run.package = tmp_path / "wmrlib"
    return run


def test_second_process_compiles_nothing_and_an_edit_compiles_anew(copy):
    *first, misses = copy()
    assert misses == "1"
    *second, misses = copy()
    assert (second, misses) == (first, "0")

    control = copy.package / "laws.py"
    control.write_text(
        control.read_text().replace("alpha + gains.h * theta", "alpha - gains.h * theta")
    )
    *edited, misses = copy()
    assert misses == "1"
    assert edited != first


def test_the_same_lines_run_as_plain_python(copy):
    compiled, plain = copy(), copy(NUMBA_DISABLE_JIT="1")
    assert [float(value) for value in plain[:2]] == pytest.approx(
        [float(value) for value in compiled[:2]], rel=1e-12
    )


def test_a_cache_folder_of_the_readers_own(copy, tmp_path):
    copy(NUMBA_CACHE_DIR=str(tmp_path / "mine"))
    assert list((tmp_path / "mine").glob("compiled-*/*/*.nbi"))
    assert not list(copy.package.glob("__pycache__/compiled-*"))


def test_one_entry_beside_a_number_and_what_cannot_be_written_to_bring_no_warning():
    one, fixed = np.zeros(1), np.zeros(3)
    fixed.flags.writeable = False
    assert wmr.polar_error(wmr.Pose(one, one, one), wmr.Pose(1.0, 0.0, 0.0)).rho.tolist() == [1.0]
    assert (
        wmr.polar_error(wmr.Pose(fixed, 0.0, 0.0), wmr.Pose(1.0, 0.0, 0.0)).rho.tolist()
        == [1.0] * 3
    )
    assert wmr.wrap_angle(np.zeros((2, 3)).T).shape == (3, 2)
