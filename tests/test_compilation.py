"""The cache: nothing is compiled twice, and an edited formula is never run from an old binary."""

import os
import shutil
import stat
import subprocess
import sys
from pathlib import Path

import pytest

import wmrlib as wmr
from wmrlib import compilation

pytestmark = pytest.mark.slow
posix = pytest.mark.skipif(os.name == "nt", reason="modes and owners are POSIX's")

PACKAGE = Path(wmr.__file__).parent
TERM = "alpha + gains.h * theta"  # of the laws
RUN = """
import sys, numpy as np, wmrlib as w
from wmrlib import loops
kinds = {"float": (0.0, 0.0, 0.5), "int": (0, 0, 0.5)}
goal, path = w.Pose(3.0, 1.0, -1.0), np.array([[3.0], [1.0], [-1.0], [0.0], [0.0]])
for kind in sys.argv[1:]:
    how = (1.0, 2.0, 0.5, 4.0, 0.0, 0.0), 0, w.body.NO_LIMITS, w.body.NO_TURN, None
    sampling = loops.Sampling(0.1, True, 0.05, 0.0)
    print(*loops.held(np.empty((8, 300)), kinds[kind], path, *how, sampling)[2:])
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


SWEEP = """
import wmrlib as w
start, goal, wheels = w.Pose(0.0, 0.0, [0.0, 1.0]), w.Pose(3.0, 1.0, 0.0), w.Wheels(0.4, 1.0, 0.1)
receiver = w.Receiver(0.01, 10.0, 0.2)
how = {"method": "arc", "wheels": wheels, "receiver": receiver, "seed": 1, "progress": False}
print(*w.sweep(start, goal, w.GENTLE_GAINS, duration=2.0, **how).distance, "read")
"""


def test_what_a_sweep_with_a_receiver_compiled_is_read_again(copy):
    assert printed(process(copy, code=SWEEP)) == printed(process(copy, code=SWEEP))


FORMULA = """from wmrlib.compilation import formula
@formula
def changed(number):
    return 2.0 * number
"""
LOOP = """from wmrlib.compilation import compiled
from other.formulas import changed
@compiled
def twice(number):
    return changed(changed(number))
"""
PRINT = "from other.loop import twice\nprint(twice(3.0), sum(twice.stats.cache_misses.values()))"


def test_an_edit_in_another_package_compiles_its_functions_anew(copy):
    other = copy.parent / "other"
    other.mkdir()
    for name, text in {"__init__": "", "formulas": FORMULA, "loop": LOOP}.items():
        (other / f"{name}.py").write_text(text, encoding="utf-8")
    assert printed(process(copy, code=PRINT)) == ([12.0], "1")
    assert printed(process(copy, code=PRINT)) == ([12.0], "0")
    edited(other, "formulas.py", "2.0 *", "5.0 +")
    assert printed(process(copy, code=PRINT)) == ([13.0], "1")
    assert printed(process(copy, code=PRINT)) == ([13.0], "0")


def test_what_the_package_cannot_keep_is_kept_at_home_or_not_at_all(copy):
    cache, home = copy / "__pycache__", copy.parent / "home"
    cache.touch()
    homes = {"HOME": str(home), "USERPROFILE": str(home)}
    assert printed(process(copy, "float", **homes))[1] == "1"
    assert printed(process(copy, "float", **homes))[1] == "0"
    shutil.rmtree(home)
    home.touch()
    failed = process(copy, "float", **homes, PYTHONWARNINGS="error::RuntimeWarning")
    message = failed.communicate()[1]
    assert message.count("set NUMBA_CACHE_DIR to a folder of your own") == 1
    assert message.count("Not a directory") == 2
    assert printed(process(copy, "float", **homes))[1] != "0"


def test_a_slip_in_a_law_is_an_error_that_a_student_can_read(copy):
    edited(copy, "laws.py", TERM, TERM.replace("alpha", "alfa"))
    code = "import wmrlib as w\nw.simulate(w.Pose(0, 0, 0), w.Pose(3, 1, 0), w.GENTLE_GAINS)"
    _, err = process(copy, code=code).communicate()
    assert "NameError: name 'alfa' is not defined" in err
    assert "laws.py" in err
    assert err.count("File ") < 10


@posix
def test_parallel_first_starts_share_a_folder_and_warn_of_nothing(copy):
    """Also where the umask leaves new folders to everybody."""
    code = "import os; os.umask(0); from wmrlib.compilation import FOLDER as f; print(f.stat()[0])"
    strict = {"PYTHONWARNINGS": "error", "NUMBA_CACHE_DIR": str(copy.parent / "new" / "cache")}
    starts = [process(copy, code=code, **strict) for _ in range(3)]
    assert [printed(start) for start in starts] == [([], str(stat.S_IFDIR | 0o700))] * 3


BEYOND = """
import warnings, wmrlib as w
warnings.simplefilter("error")
how, far = {"method": "continuous", "duration": 0.3}, w.Pose(1e308, -1e308, 0.0)
goal, wild = w.Pose(3.0, 1.0, -1.0), w.Gains(1.0, 1.0, 1.0, 1e300)
for run in (
    w.simulate(w.Pose(0.0, 0.0, 0.5), goal, w.Gains(1e150, 1.0, 1.0, 1e150), **how),
    w.simulate(far, goal, wild, **how),
    w.simulate(far, goal, wild, law="barrier", **how),
):
    print(run.peak_omega, run.path_length, len(run), list(w.Outcome).index(run.outcome))
print("ended")
"""


def test_plain_python_ends_beyond_the_range_of_numbers_as_compiled_code_does(copy, capsys):
    plain = process(copy, code=BEYOND, NUMBA_DISABLE_JIT="1")
    exec(BEYOND, {})
    *compiled, _ = capsys.readouterr().out.split()
    assert printed(plain)[0] == pytest.approx([*map(float, compiled)], rel=1e-6)


def made(place, folder_mode=0o700, file_mode=0o600, place_mode=0o755):
    """A folder of compiled code, and beside it where it is looked for."""
    folder = place / "compiled"
    folder.mkdir(parents=True)
    (folder / "loops.held-1.nbi").touch()
    for path, mode in ((folder / "loops.held-1.nbi", file_mode), (folder, folder_mode)):
        path.chmod(mode)
    place.chmod(place_mode)
    return folder


@pytest.fixture
def shared_group(monkeypatch):
    """The groups of the folders have other members too."""
    monkeypatch.setattr(compilation, "_has_nobody_else", lambda group: False)


MODES = [
    ({}, True),
    ({"file_mode": 0o664}, True),
    ({"folder_mode": 0o755, "file_mode": 0o644}, True),
    ({"place_mode": 0o1777}, True),
    ({"folder_mode": 0o755, "file_mode": 0o664}, False),
    ({"folder_mode": 0o770}, False),
    ({"place_mode": 0o777}, False),
    ({"place_mode": 0o775}, False),
]


@posix
@pytest.mark.parametrize(("modes", "used"), MODES)
@pytest.mark.parametrize("between", [".", "a/b"])
def test_compiled_code_that_others_may_write_is_not_used(
    tmp_path, shared_group, modes, used, between
):
    place = tmp_path / "place"
    folder = made(place / between, **{k: m for k, m in modes.items() if k != "place_mode"})
    place.chmod(modes.get("place_mode", 0o755))
    assert compilation._folder([folder]) == (folder if used else None)
    assert (compilation._danger(folder) == "") == used


@posix
def test_a_group_of_the_user_alone_is_the_user(tmp_path, monkeypatch):
    """As the umask 002 has it; but for accounts that share a group, by either of two lists."""
    import grp
    import pwd

    folder = made(tmp_path / "place", 0o775, 0o664, 0o775)
    user, group = pwd.getpwuid(os.getuid()), grp.getgrgid(folder.stat().st_gid)
    cases = [
        ([user], group.gr_name, [], True),
        ([], user.pw_name, [], True),
        ([user, pwd.struct_passwd(("other", *user[1:]))], group.gr_name, [], False),
        ([user], group.gr_name, ["other"], False),
        ([], "staff", [], False),
    ]
    for accounts, name, members, used in cases:
        accounts = [pwd.struct_passwd((*row[:3], group.gr_gid, *row[4:])) for row in accounts]
        entry = grp.struct_group((name, "x", group.gr_gid, members))
        monkeypatch.setattr(pwd, "getpwall", lambda accounts=accounts: accounts)
        monkeypatch.setattr(grp, "getgrgid", lambda _, entry=entry: entry)
        assert compilation._folder([folder]) == (folder if used else None)


@posix
@pytest.mark.parametrize("whose", ["compiled", "compiled/loops.held-1.nbi", "."])
def test_compiled_code_of_somebody_else_is_not_used_but_roots_is(tmp_path, monkeypatch, whose):
    """Nor is a folder of the user's with a file from when it was open to others."""
    folder, read, user = made(tmp_path), os.lstat, os.geteuid()
    owners = {os.path.normpath(tmp_path / whose): 0}

    def owned(path, **options):
        state = read(path) if options.get("follow_symlinks") is False else os.stat_result(ask(path))
        owner = owners.get(os.fspath(path), state.st_uid)
        return os.stat_result((*state[:4], owner, *state[5:]))

    ask = os.stat
    monkeypatch.setattr(Path, "stat", owned)
    monkeypatch.setattr(Path, "lstat", lambda path: owned(path, follow_symlinks=False))
    assert compilation._folder([folder]) == folder
    owners = dict.fromkeys(owners, user + 1)
    assert compilation._folder([folder]) is None
    assert f"belongs to user {user + 1}" in compilation._danger(folder)


@posix
def test_a_link_is_not_used_and_a_new_folder_is_closed_to_others(tmp_path, monkeypatch):
    folder, link = tmp_path / "new" / "compiled", tmp_path / "link"
    link.symlink_to(tmp_path)
    assert compilation._folder([link, folder]) == folder
    assert folder.stat().st_mode & 0o777 == 0o700
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(link))  # where it leads to is looked at
    assert [folder.parent for folder in compilation._folders()] == [tmp_path]


@posix
def test_a_file_that_another_process_renames_meanwhile_does_no_harm(tmp_path, monkeypatch):
    folder, listed = made(tmp_path, 0o755, 0o644), Path.iterdir
    monkeypatch.setattr(Path, "iterdir", lambda path: [*listed(path), path / "gone.tmp"])
    assert compilation._folder([folder]) == folder
