"""The first chapter as an app: Voila with the book's settings."""

from __future__ import annotations

import re
import time

import psutil
import pytest
from live import PATIENCE, assert_slider_matters, chapters, sliders, voila

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def app(tmp_path_factory):
    with voila(chapters()[0], tmp_path_factory.mktemp("voila") / "log.txt") as app:
        yield app


def test_the_app_wants_its_token(app, browser_page):
    browser_page.goto(app.url, timeout=PATIENCE)
    assert "/login" in browser_page.url
    assert browser_page.locator(".jupyter-widgets").count() == 0


def test_a_slider_moves_the_picture_and_the_kernel_ends_with_its_page(app, browser_page):
    def kernels() -> set[int]:
        every = (each.info for each in psutil.process_iter(["pid", "ppid", "cmdline"]))
        return {each["pid"] for each in every if each["ppid"] == app.pid and each["cmdline"]}

    def come_to(count: int) -> None:
        end = time.monotonic() + 20
        while len(kernels()) != count and time.monotonic() < end:
            time.sleep(0.1)
        assert len(kernels()) == count

    browser_page.goto(app.link, timeout=PATIENCE)
    assert_slider_matters(browser_page, sliders(browser_page)[0])
    assert browser_page.locator(".jp-InputArea-editor:visible").count() == 0  # an app shows no code
    words = browser_page.locator("#rendered_cells").inner_text()
    assert "You need trigonometry" in words
    assert not re.search("Run All|next cell|Shift", words)  # nobody runs a cell here
    browser_page.assert_quiet()
    come_to(1)
    browser_page.reload(timeout=PATIENCE)
    sliders(browser_page)
    come_to(1)
    browser_page.goto("about:blank")
    come_to(0)
