"""The cache: nothing is compiled twice, and an edited formula is never run from an old binary."""

import os
import re
import shutil
import struct
import subprocess
import sys
import time
from hashlib import sha256
from pathlib import Path

import numba
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import wmrlib as wmr
from wmrlib import _compile, motion
from wmrlib._loops import plane

pytestmark = pytest.mark.slow

PACKAGE = Path(wmr.__file__).parent
TERM = "alpha + gains.h * theta"  # of the laws
FACTOR = 1.7
RUN = """
import wmrlib as w
from wmrlib import _compile, control
print(*w.control_law(3.0, 0.5, -1.0, w.Gains(1, 2, 0.5)))
stats = getattr(_compile.loop_over(control._numbers_to_law), "stats", None)
print(sum(stats.cache_misses.values()) if stats else None)
"""
TWO_KINDS = """
import sys
from wmrlib.motion import wrap
for angle in map(eval, sys.argv[1:]):
    print(wrap(angle))
print(sum(wrap.stats.cache_misses.values()))
"""


@pytest.fixture
def copy(tmp_path):
    """A copy of the package in which nothing is compiled."""
    package = tmp_path / "site" / "wmrlib"
    return Path(shutil.copytree(PACKAGE, package, ignore=shutil.ignore_patterns("__pycache__")))


def process(copy, code, *arguments, **more):
    """A process that runs `code` with the copy."""
    variables = {name: value for name, value in os.environ.items() if name[:6] != "NUMBA_"}
    variables |= {"PYTHONPATH": str(copy.parent), "PYTHONDONTWRITEBYTECODE": "1"} | more
    options = {"cwd": copy.parent, "env": variables, "text": True, "stderr": subprocess.PIPE}
    command = [sys.executable, "-c", code, *arguments]
    return subprocess.Popen(command, stdout=subprocess.PIPE, **options)


def printed(process):
    out, err = process.communicate()
    assert process.returncode == 0, err
    return out.split()


def test_a_second_process_compiles_nothing_an_edit_compiles_anew_and_plain_python_agrees(copy):
    def fresh(**more):
        *ends, misses = printed(process(copy, RUN, **more))
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


def test_what_the_package_cannot_keep_is_kept_at_home_and_what_it_has_is_found(copy):
    cache, home = copy / "__pycache__", copy.parent / "home"
    cache.touch()
    homes = {"HOME": str(home), "USERPROFILE": str(home)}
    assert printed(process(copy, TWO_KINDS, "4.0", **homes))[1] == "1"
    assert printed(process(copy, TWO_KINDS, "4.0", **homes))[1] == "0"
    cache.unlink()
    shutil.move(home / ".cache" / "wmrlib", cache)
    assert printed(process(copy, TWO_KINDS, "4.0", **homes))[1] == "0"
    assert not any((home / ".cache").iterdir())


def test_two_processes_at_once_keep_what_each_compiled(copy):
    angles = "4.5", "4"
    both = [process(copy, TWO_KINDS, angle) for angle in angles]
    alone = [printed(each) for each in both]
    assert [misses for _, misses in alone] == ["1", "1"]
    assert printed(process(copy, TWO_KINDS, *angles)) == [alone[0][0], alone[1][0], "0"]


LONG = "        total = math.cos(total * x) + factor\n" * 80  # or it is inlined
CLOSURES = f"""
import math, sys
from wmrlib._compile import compiled
def made(factor):
    @compiled
    def inner(x):
        total = x
{LONG}        return total
    @compiled
    def outer(x):
        return inner(x) + inner(2.0 * x) + inner(3.0 * x)
    return outer
print(*(made(float(each))(9.0) for each in sys.argv[1:]))
"""


def test_closures_of_one_name_are_told_apart_whichever_process_compiled_them(copy):
    """By default numba names them by a counter, which begins anew in each process."""
    alone = [printed(process(copy, CLOSURES, each))[0] for each in "234"]
    assert len(set(alone)) == 3
    for order in ("234", "432"):
        assert printed(process(copy, CLOSURES, *order)) == [alone["234".index(k)] for k in order]


@pytest.fixture(scope="module")
def kept(tmp_path_factory):
    """What is in the file of a compiled function, and that file."""
    folder = tmp_path_factory.mktemp("kept") / "new"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(_compile, "_FOLDERS", [folder])
        assert compiled_again() == (3.0 * FACTOR, 1)
        (file,) = folder.iterdir()
        yield file.read_bytes(), file


def scaled(number):
    return number * FACTOR


def compiled_again():
    made = _compile.compiled(scaled)
    return made(3.0), sum(made.stats.cache_misses.values())


HEX = st.text("0123456789abcdef", min_size=16, max_size=16)
OURS = HEX.map("drive-{}".format) | HEX.map("law_1-{}".format) | HEX.map("{0}{0}".format)
FOLDERS = HEX.map("compiled-{}".format)
ANY = st.sampled_from(["thesis", "compiled-thesis", "compiled-" + 17 * "0", "compiled-" + 15 * "f"])


@settings(max_examples=60, deadline=None)
@given(
    name=FOLDERS | FOLDERS.map(str.upper) | ANY,
    files=st.sets(OURS, max_size=3),
    others=st.sets(ANY | OURS.map("{}.txt".format), max_size=1),
    days=st.sampled_from([29, 31, 400]),
    kind=st.sampled_from(["folder", "folder", "link", "file"]),
)
def test_only_what_older_versions_compiled_is_forgotten_and_after_a_month(
    tmp_path_factory, name, files, others, days, kind
):
    place, target = tmp_path_factory.mktemp("cache"), tmp_path_factory.mktemp("other")
    path, then = place / name, time.time() - 86400 * days
    inside = target if kind == "link" else path
    if kind == "file":
        path.write_text("a file")
    else:
        inside.mkdir(exist_ok=True)
        for each in files | others:
            (inside / each).write_text("compiled")
    if kind == "link":
        path.symlink_to(target)
    os.utime(path, (then, then))
    _compile._forget_old(place)
    made = kind == "folder" and re.fullmatch("compiled-[0-9a-f]{16}", name) and days > 30
    assert path.exists() == (not made or bool(others))
    if kind != "file" and path.exists():
        assert {each.name for each in inside.iterdir()} == (others if made else files | others)


def test_two_processes_may_forget_at_the_same_time(tmp_path, monkeypatch):
    old, unlink = tmp_path / "compiled-0123456789abcdef", Path.unlink
    old.mkdir()
    (old / f"drive-{16 * 'a'}").touch()
    os.utime(old, (0, 0))
    monkeypatch.setattr(Path, "unlink", lambda path: [unlink(path) for _ in range(2)])
    monkeypatch.setattr(_compile, "_FOLDERS", [tmp_path / "compiled-new"])
    assert compiled_again() == (3.0 * FACTOR, 1)


@st.composite
def damage(draw):
    """What a file of these bytes becomes: a part of it is lost or replaced."""
    begin, end = sorted(draw(st.tuples(*[st.floats(0.0, 1.0)] * 2)))
    other = draw(st.binary(max_size=9))
    return lambda content: (
        content[: int(begin * len(content))] + other + content[int(end * len(content)) :]
    )


@settings(max_examples=40)
@given(damaged=damage())
@example(lambda content: content.replace(struct.pack("<d", FACTOR), struct.pack("<d", 8.0)))
@example(lambda content: sha256(b"not ours").digest() + b"not ours")
def test_a_damaged_file_is_compiled_anew(kept, damaged):
    content, file = kept
    file.write_bytes(damaged(content))
    assert compiled_again() == (3.0 * FACTOR, damaged(content) != content)
    assert compiled_again() == (3.0 * FACTOR, 0)


def test_what_is_compiled_for_something_else_is_kept_in_another_file(monkeypatch):
    def names(loop, *signature):
        paths = _compile._Cache(loop.py_func).files(signature, loop.targetctx.codegen())
        return {path.name for path in paths}

    chosen = [(0, 0, True), (1, 0, True), (0, 1, True), (0, 0, False)]
    loops = plane.conclude, plane.drive, *(plane.loop_of(*each) for each in chosen)
    loops += tuple(map(_compile.loop_over, motion.STEPS.values()))
    found = [names(loop) for loop in loops] + [names(plane.conclude, numba.float64)]
    assert len(set.union(*found)) == len(found)
    before = _compile._folders()
    monkeypatch.setattr(numba, "__version__", "0.0")
    assert not set(_compile._folders()) & set(before)
    monkeypatch.setattr(sys.implementation, "cache_tag", "cpython-399")
    assert len({*before, *_compile._folders()}) == 2 * len(before)


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
    folders = {*_compile._folders()}
    for path in copies:
        path.write_text("# an edit", encoding="utf-8")
        folders |= {*_compile._folders()}
    assert len(folders) == len(users) + 1
    assert all(folder.parent == tmp_path / "mine" for folder in folders)


def test_one_entry_beside_a_number_and_read_only_arrays_bring_no_warning():
    one, fixed, goal = np.zeros(1), np.zeros(3), wmr.Pose(1.0, 0.0, 0.0)
    fixed.flags.writeable = False
    assert wmr.polar_error(wmr.Pose(one, one, one), goal).rho.tolist() == [1.0]
    assert wmr.polar_error(wmr.Pose(fixed, 0.0, 0.0), goal).rho.tolist() == [1.0] * 3
    assert wmr.wrap_angle(np.zeros((2, 3)).T).shape == (3, 2)
