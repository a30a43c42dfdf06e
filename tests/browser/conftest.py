"""A real Chromium for the tests: started once a session, a fresh page for each test.

Which one, WMR_BROWSER says, see tests/conftest.py: chromium-headless-shell and the full Chromium
ask for different things, so that the tests are run with both where both are installed.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest
from filelock import FileLock
from live import PATIENCE, ROOT, confine, run

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
DRAWN = """async () => {
    await window.MathJax?.startup.promise;
    await document.fonts.ready;
    const type = 'application/vnd.jupyter.widget-view+json';
    const panels = [...document.querySelectorAll(`script[type="${type}"]`)];
    return panels.every(it => it.parentElement.querySelector('.jupyter-widgets'));
}"""


@pytest.fixture(scope="session")
def browser(find_tool):
    """Chromium, headless; without one, tests/conftest.py has skipped the test."""
    from playwright.sync_api import sync_playwright

    path = find_tool("browser")
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=path, headless=True, args=FLAGS)
        yield chromium
        chromium.close()


@pytest.fixture
def browser_page(browser):
    """A fresh playwright page that fails the test on any trouble, see `watched`."""
    page = watched(browser)
    yield page
    page.context.close()
    page.assert_quiet()


@pytest.fixture(scope="module")
def module_page(browser):
    page = watched(browser)
    yield page
    page.context.close()


@pytest.fixture
def emptied_page(module_page):
    """The same for what leaves nothing behind but its document: emptied, not made, for each."""
    module_page.goto("about:blank")
    module_page.mouse.move(0, 0)
    module_page.emulate_media(color_scheme="light", reduced_motion="no-preference")
    module_page.troubles.clear()
    yield module_page
    module_page.assert_quiet()


def watched(browser):
    """Return a page of its own context.

    `page.troubles` lists, as sentences, requests to the outside, failed loads, console errors and
    uncaught exceptions. `page.assert_quiet()` fails if there are any, and is called at the end. A
    test that provokes a trouble on purpose looks at `page.troubles` and clears it.
    """
    page = browser.new_context(viewport={"width": 1300, "height": 900}).new_page()
    troubles = page.troubles = []

    def assert_quiet():
        assert not troubles, "the page is not quiet:\n  " + "\n  ".join(troubles)

    def note(kind, what):
        troubles.append(f"{kind}: {what[:300]}")

    def asked(request):
        if not request.url.startswith(LOCAL):
            note("outside request", request.url)

    def failed(request):
        if request.failure != "net::ERR_ABORTED":  # the page itself gave it up, as when it closes
            note("failed load", f"{request.failure}, {request.url}")

    def answered(response):
        if response.status >= 400:
            note("failed load", f"{response.status}, {response.url}")

    def logged(message):
        if message.type == "error":
            note("console error", message.text)

    page.assert_quiet = assert_quiet
    page.on("request", asked)
    page.on("requestfailed", failed)
    page.on("response", answered)
    page.on("console", logged)
    page.on("pageerror", lambda error: note("uncaught exception", str(error)))
    return page


@pytest.fixture
def panel_core(browser_page):
    """A `browser_page` with the panel's model, simulation and axes."""
    from host import served

    served(browser_page)
    names = "model", "simulate", "surface"
    loads = ", ".join(f"import('/kit/{name}.js')" for name in names)
    script = f"Promise.all([{loads}]).then((all) => Object.assign(window, ...all, {{loaded: 1}}));"
    browser_page.add_script_tag(content=script)
    browser_page.wait_for_function("window.loaded")
    return browser_page


@pytest.fixture(scope="session")
def made_once(tmp_path_factory):
    """The function that makes a folder by its name, once for all processes of a run."""
    base = tmp_path_factory.getbasetemp()
    base = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base

    def folder(name: str, make: Callable[[Path], object]) -> Path:
        output = base / name
        with FileLock(f"{output}.lock"):
            if not (output / "made").exists():
                make(output)
                (output / "made").touch()
        return output

    return folder


@pytest.fixture(scope="session")
def site(made_once) -> Path:
    """The folder of the site. The environment variable BOOK_HTML can name one that is built."""
    if ready := os.environ.get("BOOK_HTML"):
        return Path(ready).resolve()
    return made_once("book", lambda output: run(ROOT, "book/tools/build.py", output)) / "html"


@pytest.fixture
def opened(site, browser_page):
    """Opens a page and waits until it is drawn; a request that leaves the site is a trouble."""
    confine(browser_page, site)

    def open_page(name: str):
        browser_page.goto(f"{site.as_uri()}/{name}", wait_until="load", timeout=PATIENCE)
        browser_page.wait_for_function(DRAWN, timeout=PATIENCE)
        return browser_page

    return open_page
