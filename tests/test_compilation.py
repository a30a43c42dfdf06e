"""The cache: nothing is compiled twice, and an edited formula is never run from an old binary."""

import os
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

import numba
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import wmrlib as wmr
from wmrlib import compilation

pytestmark = pytest.mark.slow

PACKAGE = Path(wmr.__file__).parent
TERM = "alpha + gains.h * theta"  # of the laws
RUN = """
import sys, numpy as np, wmrlib as w
from wmrlib import loops
kinds = {"float": (0.0, 0.0, 0.5), "int": (0, 0, 0.5)}
goal, path = w.Pose(3.0, 1.0, -1.0), np.array([[3.0], [1.0], [-1.0], [0.0], [0.0]])
for kind in sys.argv[1:]:
    how = (1.0, 2.0, 0.5, 4.0, 0.0, 0.0), 0, w.body.NO_LIMITS, True, 0.1, 0.05, 0.0, None, None
    print(*loops.held(np.empty((8, 300)), kinds[kind], path, *how)[2:])
stats = getattr(loops.held, "stats", None)
print(sum(stats.cache_misses.values()) if stats else None)
"""


@pytest.fixture
def copy(tmp_path):
    """A copy of the package in which nothing is compiled."""
    package = tmp_path / "site" / "wmrlib"
    return Path(shutil.copytree(PACKAGE, package, ignore=shutil.ignore_patterns("__pycache__")))


def process(copy, *kinds, code=RUN, **more):
    """A process that runs `code` with the copy."""
    variables = {name: value for name, value in os.environ.items() if name[:6] != "NUMBA_"}
    variables |= {"PYTHONPATH": str(copy.parent), "PYTHONDONTWRITEBYTECODE": "1"} | more
    options = {"cwd": copy.parent, "env": variables, "text": True, "stderr": subprocess.PIPE}
    command = [sys.executable, "-c", code, *kinds]
    return subprocess.Popen(command, stdout=subprocess.PIPE, **options)


def printed(process):
    """The numbers of a run, and how many functions it compiled."""
    out, err = process.communicate()
    assert process.returncode == 0, err
    *numbers, misses = out.split()
    return [float(number) for number in numbers], misses


def edited(copy, name, old, new):
    path = copy / name
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")


def test_a_second_process_compiles_nothing_an_edit_compiles_anew_and_plain_python_agrees(copy):
    first = printed(process(copy, "float"))
    assert first[1] == "1"
    assert printed(process(copy, "float")) == (first[0], "0")
    plain, _ = printed(process(copy, "float", NUMBA_DISABLE_JIT="1"))
    assert plain == pytest.approx(first[0], rel=1e-12)
    edited(copy, "laws.py", TERM, TERM.replace("+", "-"))
    numbers, misses = printed(process(copy, "float"))
    assert misses == "1"
    assert numbers != pytest.approx(first[0], rel=1e-3)


def test_what_the_package_cannot_keep_is_kept_at_home_or_not_at_all(copy):
    cache, home = copy / "__pycache__", copy.parent / "home"
    cache.touch()
    homes = {"HOME": str(home), "USERPROFILE": str(home)}
    assert printed(process(copy, "float", **homes))[1] == "1"
    assert printed(process(copy, "float", **homes))[1] == "0"
    shutil.rmtree(home)
    home.touch()
    failed = process(copy, "float", **homes, PYTHONWARNINGS="error::RuntimeWarning")
    assert "set NUMBA_CACHE_DIR to a folder for it" in failed.communicate()[1]
    assert printed(process(copy, "float", **homes))[1] != "0"


def test_what_was_compiled_is_read_where_nothing_may_be_written(copy, tmp_path):
    first = printed(process(copy, "float"))
    refuse = "import tempfile\ndef none(*_, **__): raise OSError(30, 'read-only')\n"
    refuse += "tempfile.TemporaryFile = none\n"
    home = {"HOME": str(tmp_path / "none"), "PYTHONWARNINGS": "error"}
    assert printed(process(copy, "float", code=refuse + RUN, **home)) == (first[0], "0")


def test_two_processes_at_once_keep_what_each_compiled(copy):
    for one in [process(copy, kind) for kind in ("float", "int")]:
        printed(one)
    assert int(printed(process(copy, "float", "int"))[1]) <= 1  # the later one's index counts
    assert printed(process(copy, "float", "int"))[1] == "0"


def test_a_slip_in_a_law_is_an_error_that_a_student_can_read(copy):
    edited(copy, "laws.py", TERM, TERM.replace("alpha", "alfa"))
    code = "import wmrlib as w\nw.simulate(w.Pose(0, 0, 0), w.Pose(3, 1, 0), w.GENTLE_GAINS)"
    _, err = process(copy, code=code).communicate()
    assert "NameError: name 'alfa' is not defined" in err
    assert "laws.py" in err
    assert err.count("\n") < 20


FACTOR = 1.7


def scaled(number):
    return number * FACTOR


def compiled_again(folder, monkeypatch):
    """The result, and whether it was compiled."""
    monkeypatch.setattr(compilation, "FOLDER", folder)
    made = compilation.compiled(scaled)
    return made(3.0), sum(made.stats.cache_misses.values())


@settings(max_examples=40)
@given(begin=st.floats(0.0, 1.0), share=st.floats(0.0, 1.0), other=st.binary(max_size=9))
@example(0.0, 1.0, b"")
def test_a_file_whose_text_is_damaged_is_compiled_anew(tmp_path_factory, begin, share, other):
    folder = tmp_path_factory.mktemp("kept")
    with pytest.MonkeyPatch.context() as patch:
        assert compiled_again(folder, patch) == (3.0 * FACTOR, 1)
        assert compiled_again(folder, patch) == (3.0 * FACTOR, 0)
        (index,) = folder.glob("*.nbi")
        content = index.read_bytes()
        first = int(begin * len(content))
        last = first + int(share * (len(content) - first))
        index.write_bytes(content[:first] + other + content[last:])
        assert compiled_again(folder, patch)[0] == 3.0 * FACTOR
        assert compiled_again(folder, patch) == (3.0 * FACTOR, 0)


HEX = st.text("0123456789abcdef", min_size=16, max_size=16)
NAMES = HEX.map("compiled-{}".format) | st.sampled_from(["thesis", "compiled-thesis"])


@settings(max_examples=40, deadline=None)
@given(
    name=NAMES,
    days=st.sampled_from([29, 31, 400]),
    kind=st.sampled_from(["folder", "folder", "link"]),
    others=st.sets(st.sampled_from(["thesis", "loops.held-1.nbc.txt"]), max_size=1),
)
def test_only_what_older_versions_compiled_is_forgotten_and_after_a_month(
    tmp_path_factory, name, days, kind, others
):
    place, target = tmp_path_factory.mktemp("cache"), tmp_path_factory.mktemp("other")
    path, then = place / name, time.time() - 86400 * days
    if kind == "folder":
        path.mkdir()
    else:
        path.symlink_to(target)
    for file in {"loops.held-1.nbi", "loops.held-1.1.nbc", *others}:
        (path / file).write_text("kept")
    os.utime(path, (then, then))
    compilation._forget_old(place)
    old = kind == "folder" and re.fullmatch("compiled-[0-9a-f]{16}", name) and days > 30
    assert path.exists() == (not old or bool(others))
    if path.exists():
        assert {file.name for file in path.iterdir()} >= others
        assert old or len([*path.iterdir()]) == 2 + len(others)


def test_two_processes_may_forget_at_the_same_time(tmp_path, monkeypatch):
    old, unlink = tmp_path / "compiled-0123456789abcdef", Path.unlink
    old.mkdir()
    (old / "loops.held-1.nbi").touch()
    os.utime(old, (0, 0))
    monkeypatch.setattr(Path, "unlink", lambda path: [unlink(path) for _ in range(2)])
    compilation._forget_old(tmp_path)
    assert not [*old.iterdir()]


def test_processes_that_begin_at_once_all_keep_what_they_compile(monkeypatch, tmp_path):
    def made_meanwhile(folder):
        folder.mkdir(parents=True)
        return False

    monkeypatch.setattr(Path, "exists", made_meanwhile)
    place = tmp_path / "none" / "compiled"
    assert compilation._folder([place]) == place


def test_an_edit_to_any_compiled_module_and_another_compiler_lead_to_another_folder(
    monkeypatch, tmp_path
):
    users = {
        path
        for path in PACKAGE.rglob("*.py")
        if "wmrlib.compilation import" in path.read_text(encoding="utf-8")
        and path.parent.name != "symbolic"  # which prints modules that are compiled
    }
    assert PACKAGE / "engine" / "sampled.py" in users <= set(compilation._SOURCES)
    copies = [Path(shutil.copy(path, tmp_path / f"{k}.py")) for k, path in enumerate(users)]
    monkeypatch.setattr(compilation, "_SOURCES", copies)
    digests = {compilation._digest()}
    for path in copies:
        path.write_text("# an edit", encoding="utf-8")
        digests.add(compilation._digest())
    monkeypatch.setattr(numba, "__version__", "0.0")
    digests.add(compilation._digest())
    monkeypatch.setattr(sys.implementation, "cache_tag", "cpython-399")
    digests.add(compilation._digest())
    assert len(digests) == len(users) + 3


def test_one_entry_beside_a_number_and_read_only_arrays_bring_no_warning():
    one, fixed, goal = np.zeros(1), np.zeros(3), wmr.Pose(1.0, 0.0, 0.0)
    fixed.flags.writeable = False
    assert wmr.polar_error(wmr.Pose(one, one, one), goal).rho.tolist() == [1.0]
    assert wmr.polar_error(wmr.Pose(fixed, 0.0, 0.0), goal).rho.tolist() == [1.0] * 3
    assert wmr.wrap_angle(np.zeros((2, 3)).T).shape == (3, 2)
