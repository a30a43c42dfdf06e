"""The packages as a whole: what importing them costs, and what they say of themselves."""

import inspect
import subprocess
import sys

import wmrlib as wmr
import wmrrobot as wr

HEAVY = {"sympy", "matplotlib", "ipywidgets", "control", "scipy.integrate", "numba", "tqdm"}


def modules_after(statement):
    command = [sys.executable, "-c", f"import sys; {statement}; print(*sys.modules)"]
    return set(subprocess.check_output(command, text=True).split())


def test_importing_loads_nothing_heavy():
    assert not modules_after("import wmrlib, wmrrobot") & HEAVY


def test_a_simulation_loads_numba_and_nothing_else_heavy():
    drive = "w.simulate(w.Pose(0,0,0), w.Pose(1,1,0), w.Gains(2,1,1))"
    used = modules_after(f"import wmrlib as w; {drive}")
    assert used & HEAVY == {"numba"}


def test_every_public_name_is_there_and_says_what_it_is():
    for package, name in [(module, name) for module in (wmr, wr) for name in module.__all__]:
        value = getattr(package, name)
        if name not in ("EARTH_RADIUS_M", "GENTLE_GAINS", "RECEIVERS"):
            assert inspect.getdoc(value), name
            assert inspect.getdoc(value) != inspect.getdoc(type(value)), name
