"""What a hand-in can't do: leave its cage, take more than it may, or say what it is worth."""

import contextlib
import copy
import json
import os
import shutil
import socket
import subprocess
import sys
import sysconfig
import tempfile
import time
from pathlib import Path

import cage
import damage
import graded
import handins
import nbformat
import pytest
import sandbox
from kernel import Limits

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not cage.holds(), reason="this system cages no process"),
]
LAUNCH = """
import json, subprocess, sys, tempfile
sys.path[:0] = {paths}
import cage
from pathlib import Path
with tempfile.TemporaryFile() as rules:
    cage.write_filter(rules)
    options = dict(reads=[Path({read!r})], rules=rules.fileno(), user=cage.next_user())
    command = cage.caged([sys.executable, "-c", sys.stdin.read()], **options)
    done = subprocess.run(command, pass_fds=[rules.fileno()], text=True, capture_output=True)
print(done.stdout or done.stderr)
"""
TRIES = '''
import ctypes, fcntl, json, mmap, os, socket, subprocess
libc = ctypes.CDLL(None, use_errno=True)

def call(number, *arguments):
    """A system call that has no name in Python."""
    if libc.syscall(number, *arguments) < 0:
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()))

def connect(path):
    with socket.socket(socket.AF_UNIX) as link:
        link.connect(path)

def fork_all():
    while True:
        os.fork() or os._exit(0)

tries = {
    "socket with a path": lambda: connect(PATHS["socket"]),
    "a home": lambda: os.listdir(PATHS["home"]),
    "passwords": lambda: open("/etc/shadow"),
    "core_pattern": lambda: open("/proc/sys/kernel/core_pattern", "w"),
    "sysrq": lambda: open("/proc/sysrq-trigger", "w"),
    "its root": lambda: open("/file", "w"),
    "a folder that it reads": lambda: open(PATHS["read"] + "/file", "w"),
    "a disk": lambda: os.mknod("/tmp/disk", 0o60600, os.makedev(8, 0)),
    "the library": lambda: open(os.__file__, "a"),
    "memory without a name": lambda: os.memfd_create("it"),
    "memory that outlives it": lambda: mmap.mmap(-1, 10**6),
    "shared memory": lambda: call(29, 0, 10**6, 0o1600),
    "a new user namespace": lambda: call(272, 0x10000000),
    "a clone in one": lambda: call(56, 0x10000000 | 17, 0, 0, 0, 0),
    "mount": lambda: call(165, b"none", b"/tmp", b"tmpfs", 0, 0),
    "ptrace": lambda: call(101, 16, os.getppid(), 0, 0),
    "keys": lambda: call(250, 0, -3, 1),
    "bpf": lambda: call(321, 0, 0, 0),
    "io_uring": lambda: call(425, 1, 0),
    "a virtual machine's socket": lambda: socket.socket(40, socket.SOCK_STREAM),
    "packets": lambda: socket.socket(17, socket.SOCK_RAW),
    "a network": lambda: socket.create_connection(("127.0.0.1", PATHS["port"]), 1),
    "its starter": lambda: os.kill(PATHS["pid"], 0),
    "other processes": lambda: open(f"/proc/{PATHS['pid']}/environ"),
}
told = {}
for name, attack in tries.items():
    try:
        attack()
        told[name] = ""
    except OSError as error:
        told[name] = error.strerror or type(error).__name__
print(json.dumps([os.getuid(), told, sorted(os.listdir("/")), sorted(os.listdir("/dev"))]))
'''


def launchers() -> list:
    """Whoever starts a cage: this user, and where that is root one who is not."""
    system, found = "/usr/bin/python3", [pytest.param([sys.executable], id="as this user")]
    if os.geteuid() == 0 and Path(system).exists():
        user = ["setpriv", "--reuid", "61234", "--regid", "61234", "--clear-groups"]
        found.append(pytest.param([*user, system], id="as another"))
    return found


@pytest.fixture
def outside():
    """A folder with a socket and a home, as who grades has them, and one that is shown."""
    listener, server = socket.socket(socket.AF_UNIX), socket.create_server(("127.0.0.1", 0))
    with tempfile.TemporaryDirectory() as name, listener, server:
        places = {each: Path(name, each) for each in ("home", "read", "socket")}
        for folder in Path(name), places["home"], places["read"]:
            folder.mkdir(exist_ok=True)
            folder.chmod(0o755)  # pytest's own are closed to others
        listener.bind(str(places["socket"]))
        listener.listen()
        places["socket"].chmod(0o777)
        paths = {key: str(place) for key, place in places.items()}
        yield paths | {"port": server.getsockname()[1], "pid": os.getpid()}


@pytest.mark.parametrize("launcher", launchers())
def test_nothing_leads_out_of_a_cage(outside, launcher):
    paths = [str(damage.COURSE), sysconfig.get_path("purelib")]
    if launcher[0] == "setpriv":  # who may not see into this user's folders
        copies = Path(outside["read"]).parent / "lib"
        copies.mkdir()
        for source in damage.COURSE / "cage.py", Path(paths[1], "pyseccomp.py"):
            shutil.copy(source, copies)
        paths = [str(copies)]
    code = LAUNCH.format(paths=paths, read=outside["read"])
    code, tries = [*launcher, "-c", code], f"PATHS = {outside}\n{TRIES}"
    done = subprocess.run(code, input=tries, text=True, capture_output=True, cwd="/")
    user, told, root, devices = json.loads(done.stdout or done.stderr)
    assert not [name for name, refusal in told.items() if not refusal]
    assert user != 0
    shown = (Path(each).parts[1] for each in (sys.prefix, sys.base_prefix, outside["read"]))
    ours = {"bin", "dev", "etc", "lib", "lib32", "lib64", "libx32", "proc", "sbin", "usr"}
    assert {*root} <= {"tmp", *ours, *shown}
    assert not {"mem", "kmsg", "sda", "vda", "fuse", "kvm"} & {*devices}


TAKES = {  # what a cell takes, and what is told of it; each is ten times what it may
    "files": (
        "import os\ntry:\n    for k in range(20):\n        open(f'/tmp/{k}', 'wb').write("
        "bytes(95_000_000))\nfinally:\n    for j in range(k + 1):\n        os.remove(f'/tmp/{j}')",
        "No space left on device",
    ),
    "shared": (
        "for k in range(10):\n    open(f'/dev/shm/{k}', 'wb').write(bytes(50_000_000))",
        "No space left on device",
    ),
    "processes": (
        "import subprocess\nmade = []\ntry:\n    for _ in range(1300):\n        made.append("
        "subprocess.Popen(['sleep', '99']))\nfinally:\n    [(it.kill(), it.wait()) for it in made]",
        "Resource temporarily unavailable",
    ),
    "a large file": ("open('/tmp/file', 'wb').truncate(10**9)", "File too large"),
    "open files": ("files = [open('/dev/null') for k in range(2560)]", "Too many open files"),
    "memory": ("x = bytearray(10**10)", "MemoryError"),
    "memory of many": (
        "import os, time\nfor k in range(10):\n    if not os.fork():\n"
        "        x = b'x' * 3 * 10**8\n        time.sleep(99)\ntime.sleep(99)",
        "it took more than 1 GB",
    ),
}


@pytest.mark.skipif(os.geteuid() != 0, reason="only root is sure to make control groups")
def test_what_processes_take_together_is_limited():
    """By the kernel itself, where it groups them: no process here takes much."""
    hoard = "import os, time\nfor _ in range(8):\n    if not os.fork():\n"
    hoard += "        x = b'x' * 10**8\n        time.sleep(0.3)\n        os._exit(0)\n"
    hoard += "print([os.waitstatus_to_exitcode(os.wait()[1]) for _ in range(8)])"
    ends = []
    for memory in 2 * 10**8, 4 * 10**9:
        with cage.grouped([sys.executable, "-c", hoard], memory, 50) as command:
            done = subprocess.run(command, capture_output=True, text=True)
            ends.append(-9 in json.loads(done.stdout or "[-9]"))
            groups = [Path(each) for each in command[3].split()]
        assert groups
        assert not [each for each in groups if each.exists()]  # they go with it
    assert ends == [True, False]


def notebook(*first: str):
    """An assignment with the model's answers, after cells of a student's own."""
    made = nbformat.read(graded.notebook("ch01"), as_version=4)
    made.cells[:0] = map(nbformat.v4.new_code_cell, first)
    return made


def split(half: str):
    """One of whose answers a second cell has, too."""
    made = notebook()
    (k,) = (k for k, cell in enumerate(made.cells) if cell.source.startswith("def distance"))
    made.cells.insert(k, copy.deepcopy(made.cells[k]))
    made.cells[k].source = half
    return made


def passed(ran) -> dict[str, bool]:
    """Which checks do not fail."""
    checks = [cell for cell in ran.cells if sandbox.is_check(cell)]
    fails = [any(o.output_type == "error" for o in cell.outputs) for cell in checks]
    names = [cell.metadata.nbgrader.grade_id for cell in checks]
    return dict(zip(names, [not each for each in fails], strict=True))


@pytest.fixture(scope="module")
def runner():
    with sandbox.Sandbox([damage.COURSE], Limits(cell=20.0, memory=1_000_000_000)) as runner:
        yield runner


def test_what_takes_too_much_ends_and_the_answers_count(runner):
    ran = runner.run(notebook(*(code for code, _ in TAKES.values())), "ada", [])
    for cell, (what, (_, told)) in zip(ran.cells, TAKES.items(), strict=False):
        assert told in str(cell.outputs), what
    assert all(passed(ran).values())


@pytest.mark.parametrize("code", [damage.CHEATS, damage.LIARS])
def test_no_verdict_falls_where_the_hand_in_runs(runner, code):
    """Neither for who changes the checks, nor for who answers them with what no float is."""
    for cell in (made := notebook()).cells:
        if "def distance" in cell.source:
            cell.source = f"from math import *\n{code}"
    found = passed(runner.run(made, "ada", []))
    assert not any(right for name, right in found.items() if name.startswith("distance"))


@pytest.mark.parametrize(
    "text",
    [
        json.dumps(split("%time x\n" * 6000)),
        json.dumps(split("(" * 3_000_000)),
        json.dumps(notebook()).replace('"metadata": {', '"metadata": {"x": ' + "[" * 10**6, 1),
        '{"cells": [], "metadata": ' + '{"x": ' * 90_000 + "1" + "}" * 90_000 + "}",
    ],
    ids=["many magics", "brackets", "nested", "nested and sound"],
)
def test_a_notebook_that_is_hard_to_read_is_read_or_refused_in_time(
    runner, tmp_path, monkeypatch, text
):
    monkeypatch.setattr(sandbox, "READING", 3)
    (tmp_path / "it.ipynb").write_text(text)
    began = time.monotonic()
    with contextlib.suppress(handins.Refused):
        release = notebook()
        for cell in release.cells:
            cell.source = graded.released(cell.source)
        found, _ = runner.repaired(tmp_path / "it.ipynb", release)
        assert [*passed(found)] == [*passed(notebook())]
    assert time.monotonic() - began < 30 * sandbox.READING
