"""A real Chromium for the tests that need one: started once a session, a fresh page for each test."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest

import wmrlib

FLAGS = [
    "--headless=new",
    "--no-sandbox",  # so that it runs as root, as in a container
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
LOCAL = (
    "file:",
    "data:",
    "blob:",
    "about:",
    "http://127.0.0.1",
    "http://localhost",
    "ws://127.0.0.1",
    "ws://localhost",
)
NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")


def _missing(reason: str):
    """Skip, or fail where a browser is required: in CI."""
    (pytest.fail if os.environ.get("CI") else pytest.skip)(reason)


@pytest.fixture(scope="session")
def browser():
    """Chromium, headless; skips where there is none, and fails instead if the environment variable CI is set."""
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        _missing("this test needs a browser, and playwright is not installed")
    path = next(filter(None, map(shutil.which, NAMES)), None)
    if path is None:
        _missing(f"this test needs a browser, and none of {', '.join(NAMES)} is on the PATH")
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=path, headless=True, args=FLAGS)
        yield chromium
        chromium.close()


@pytest.fixture
def browser_page(browser):
    """A fresh playwright page that fails the test on any trouble.

    `page.troubles` lists requests to the outside, failed loads, console errors and uncaught exceptions, as sentences.
    `page.assert_quiet()` fails if there are any; it is called at the end of the test too. A test that provokes a trouble on purpose
    looks at `page.troubles` and clears it.
    """
    context = browser.new_context(viewport={"width": 1300, "height": 900})
    page = context.new_page()
    troubles = page.troubles = []

    def assert_quiet():
        assert not troubles, "the page is not quiet:\n  " + "\n  ".join(troubles)

    page.assert_quiet = assert_quiet
    page.on(
        "request",
        lambda it: (
            None
            if it.url.startswith(LOCAL)
            else troubles.append(f"outside request: {it.url[:200]}")
        ),
    )
    page.on(
        "requestfailed", lambda it: troubles.append(f"failed load: {it.url[:200]}: {it.failure}")
    )
    page.on(
        "response",
        lambda it: (
            troubles.append(f"failed load: {it.url[:200]}: {it.status}")
            if it.status >= 400
            else None
        ),
    )
    page.on(
        "console",
        lambda it: (
            troubles.append(f"console error: {it.text[:300]}") if it.type == "error" else None
        ),
    )
    page.on("pageerror", lambda it: troubles.append(f"uncaught exception: {str(it)[:300]}"))
    yield page
    context.close()
    assert_quiet()


@pytest.fixture
def panel_core(browser_page):
    """A `browser_page` with the panel's model and simulation in it, loaded as one ES module, as the panel does."""
    from wmrlib import symbolic

    panel = Path(wmrlib.__file__).parent / "explorer" / "js"
    text = "".join(
        (panel / name).read_text(encoding="utf-8") for name in ("model.js", "simulate.js")
    )
    printed = map(symbolic.javascript_name, symbolic.FORMULAS)
    names = ", ".join(("simulate", "summarise", "landscape", "modes", "wrap", *printed))
    browser_page.goto("about:blank")
    browser_page.add_script_tag(
        type="module", content=f"{text}\nObject.assign(window, {{ {names}, loaded: true }});"
    )
    browser_page.wait_for_function("window.loaded")
    return browser_page
