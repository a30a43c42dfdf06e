"""Shared by all tests: the same examples on every machine, and what a test needs of the machine.

The environment variable WMR_BROWSER names the browser of the tests in a browser, by its command or
its path: `WMR_BROWSER=chromium`. Without it the first of `pdf.BROWSERS` that is installed is taken.
"""

from __future__ import annotations

import functools
import os
import shutil
import sys
from importlib.util import find_spec
from pathlib import Path

import compile_first
import kernels
import pytest
from hypothesis import settings
from pdf import BROWSERS

settings.register_profile("repeatable", deadline=None, derandomize=True, print_blob=True)
settings.register_profile("few", settings.get_profile("repeatable"), max_examples=20)
settings.load_profile("repeatable")
settings.register_profile("stress", deadline=None, print_blob=True, max_examples=1000)

ASKED = os.environ.get("WMR_BROWSER")
TOOLS = {  # what a test may need, the commands that are it, and what to install
    "arduino": (
        ("/usr/share/arduino/hardware/arduino/avr/platform.txt",),
        "Arduino's core (Debian: apt install arduino-core-avr)",
    ),
    "avr": (("avr-gcc",), "a compiler for AVR boards (Debian: apt install gcc-avr avr-libc)"),
    "browser": (
        (ASKED,) if ASKED else BROWSERS,
        f"{ASKED or 'Chromium or Chrome'} (Debian: apt install chromium)",
    ),
    "compiler": (("cc", "gcc"), "a C compiler (Debian: apt install gcc g++ libc6-dev)"),
    "gpsd": (("gpsd", "/usr/sbin/gpsd"), "gpsd (Debian: apt install gpsd)"),
    "libsimavr": (
        ("/usr/include/simavr/sim_avr.h",),
        "simavr as a library (Debian: apt install libsimavr-dev)",
    ),
    "npm": (("npm",), "npm (Debian: apt install npm)"),
    "simavr": (("simavr",), "simavr, which simulates AVR boards (Debian: apt install simavr)"),
}


@functools.cache
def command(tool: str) -> str | None:
    """The path of the command that is this tool, or None."""
    beside = os.pathsep.join([os.environ["PATH"], str(Path(sys.executable).parent), "/usr/sbin"])
    for name in TOOLS[tool][0]:
        mode = os.F_OK if name.endswith((".h", ".txt")) else os.X_OK
        if path := shutil.which(name, mode, beside):
            return path
    return None


def lacking(tool: str) -> str:
    """Why a test that needs the tool can't run here; empty if it can."""
    if tool == "browser" and not find_spec("playwright"):
        return "this test needs the Python package playwright"
    return "" if command(tool) else f"this test needs {TOOLS[tool][1]}"


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item):
    """Skip a test that lacks a tool before any fixture runs; where CI is set, fail it."""
    wanted = {tool for mark in item.iter_markers("needs") for tool in mark.args}
    if "browser" in item.fixturenames:
        wanted.add("browser")
    if "site" in item.fixturenames and not os.environ.get("BOOK_HTML"):
        wanted.add("npm")
    for reason in filter(None, map(lacking, sorted(wanted))):
        (pytest.fail if os.environ.get("CI") else pytest.skip)(reason)


@pytest.fixture(scope="session")
def find_tool():
    """The function that gives the path of a tool, or None."""
    return command


def pytest_configure(config):
    """Let the kernels of nbval, and of the applications that tests start, talk through files.

    And let Python keep what it compiles, where it was told not to: each of a hundred processes
    would compile all that it imports. Where several workers will run, their loops are compiled
    before they begin.
    """
    kernels.use_files()
    os.environ["JUPYTER_CONFIG_PATH"] = str(Path(__file__).parent / "jupyter")
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    sys.dont_write_bytecode = False
    if getattr(config.option, "numprocesses", None) and not hasattr(config, "workerinput"):
        compile_first.compile_all()


@pytest.hookimpl(tryfirst=True, optionalhook=True)
def pytest_xdist_auto_num_workers(config):
    """One worker more than cores: half of a browser's or a kernel's time is waiting."""
    return (os.cpu_count() or 1) + 1


def pytest_collection_modifyitems(items):
    """Begin with the tests of the pages: they build the site, which others would wait for."""
    items.sort(key=lambda item: item.path.name != "test_page.py")


@pytest.hookimpl(tryfirst=True)
def pytest_collection(session):
    """Show the header before the tests are collected, in a pipe too."""
    if reporter := session.config.pluginmanager.get_plugin("terminalreporter"):
        reporter.flush()


@pytest.fixture(scope="module")
def read(tmp_path_factory):
    """Read what a file would hold as a track; a list is lines."""
    from wmrlib.tracks import read_track

    path = tmp_path_factory.mktemp("tracks") / "file.txt"

    def of(content):
        if isinstance(content, list):
            content = "\n".join(content)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return read_track(path)

    return of
