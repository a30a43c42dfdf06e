"""Odd hosts: the library computes the same, and warns once where compiled code can't be kept."""

import math
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import wmrlib as wmr
from wmrlib import compilation

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(os.name == "nt", reason="these tests need POSIX"),
]
ONE_CALL = "import wmrlib; print(wmrlib.wrap_angle(4.0))"
USED = """
import numpy as np, wmrlib as wmr
start, goal, gains = wmr.Pose(0.0, 0.0, 0.0), wmr.Pose(3.0, 2.0, 1.0), wmr.GENTLE_GAINS
results = [*wmr.sweep(wmr.Pose([0.0, 1.0], 0.0, 0.0), goal, gains, progress=False)]
for method in ("arc", "euler", "continuous"):
    results += wmr.arrival(wmr.simulate(start, goal, gains, method=method))
results += [*wmr.modes(gains), *wmr.control_law(1.0, 2.0, 0.5, gains)]
points = wmr.read_track("log.csv").points
results += [points.lat, points.lon]
import matplotlib
matplotlib.use("agg")
import wmrlib.symbolic
print([np.round(np.asarray(each, dtype=complex), 6).tolist() for each in results])
"""
FULL = "import resource as r; r.setrlimit(r.RLIMIT_FSIZE, (0, 0))"
NOBODY = "import os, pwd; del os.environ['HOME']; pwd.getpwuid = {}.__getitem__"
ASCII = {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
CACHE = {"NUMBA_CACHE_DIR": str(compilation.FOLDER.parent)}
KEPT = {  # the variables of a process that reads what this one has compiled, and Python's options
    "no folder for temporary files": ({"TMPDIR": "/nowhere"}, ()),
    "without docstrings and assertions": ({}, ("-OO",)),
    "an ASCII locale": (ASCII, ()),
    "every warning an error": ({"PYTHONWARNINGS": "error:::wmrlib"}, ()),
    "without numba's compiler": ({"NUMBA_DISABLE_JIT": "1"}, ()),
    "one thread": ({"NUMBA_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}, ()),
}
NOT_KEPT = {  # what a process does before it imports wmrlib, and its variables
    "a home that is a file": ("", {"HOME": "/dev/null"}),
    "a full disk": (FULL, {}),
    "no home": (NOBODY, {}),
    "a cache folder that can't be": ("", {"NUMBA_CACHE_DIR": "/dev/null/x"}),
}


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """A copy of the package that can keep nothing, beside an empty home and a log."""
    site = tmp_path_factory.mktemp("site")
    copied = shutil.ignore_patterns("__pycache__")
    shutil.copytree(Path(wmr.__file__).parent, site / "wmrlib", ignore=copied)
    (site / "wmrlib" / "__pycache__").touch()  # of a file nobody, root included, makes a folder
    (site / "home").mkdir()
    (site / "log.csv").write_text("lat,lon\n33.27,44.37\n", encoding="utf-8")
    return site


def run(site, code, variables, options=()):
    """What a process prints, and how often it warns that nothing can be kept."""
    kept = {name: value for name, value in os.environ.items() if name[:6] != "NUMBA_"}
    kept |= {"PYTHONPATH": str(site), "PYTHONDONTWRITEBYTECODE": "1", "HOME": str(site / "home")}
    kept |= {"MPLCONFIGDIR": str(site / "matplotlib")} | variables
    command = [sys.executable, *options, "-c", code]
    done = subprocess.run(command, env=kept, cwd=site, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout, done.stderr.count("RuntimeWarning: compiled code can't be kept in ")


@pytest.fixture(scope="module")
def usual(site):
    return run(site, USED, CACHE)


@pytest.mark.parametrize("host", KEPT)
def test_an_odd_host_changes_no_result(site, usual, host):
    variables, options = KEPT[host]
    assert run(site, USED, CACHE | variables, options) == usual
    assert usual[1] == 0


@pytest.mark.parametrize("host", NOT_KEPT)
def test_where_nothing_can_be_kept_it_runs_and_warns_once(site, host):
    code, variables = NOT_KEPT[host]
    printed, warned = run(site, f"{code}\n{ONE_CALL}", variables)
    assert (float(printed), warned) == (pytest.approx(4.0 - 2.0 * math.pi), 1)
    assert not any(path.is_file() for path in (site / "home").rglob("*"))
