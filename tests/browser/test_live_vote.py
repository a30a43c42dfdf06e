"""A vote in class: two telephones, and the lecturer's slide, from the command to the bars."""

from __future__ import annotations

import contextlib
import signal
import subprocess
import sys

import pytest
from faults import violations
from live import ROOT, free_port, open_deck

pytestmark = [pytest.mark.slow, pytest.mark.needs("npm")]
SLOW_AT_FIRST = """(() => {
    const [real, later] = [fetch, (ms) => new Promise((done) => { setTimeout(done, ms); })];
    let votes = 0;
    window.fetch = async (...asked) => {
        if (asked[1]?.method === 'POST' && !votes++) await later(700);
        return real(...asked);
    };
})()"""
STILL = "* { transition: none !important; }"


@contextlib.contextmanager
def serving(which: str, port: int = 0):
    """The lecturer's link, the class's address and the process of a vote that is served."""
    command = [sys.executable, ROOT / "book/tools/vote.py", which]
    command += ["--address", "127.0.0.1", "--port", str(port or free_port())]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        try:
            links = (line.split()[-1] for line in server.stdout if " http" in line)
            yield next(links), next(links), server
            server.send_signal(signal.SIGINT)
            assert server.wait(10) == 0
        finally:
            server.kill()


@pytest.mark.parametrize(("which", "slide"), [("04", 4), ("questions", 3)])
def test_two_telephones_vote_and_the_slide_shows_the_bars_only_when_asked(
    which, slide, another_page
):
    ours, ada, bob = pages = [another_page() for _ in range(3)]
    for page, size in zip(pages, ((1280, 720), (390, 844), (390, 844)), strict=True):
        page.set_viewport_size(dict(zip(("width", "height"), size, strict=True)))
    with serving(which) as (link, address, _):
        open_deck(ours, link)
        ours.add_style_tag(content=STILL)
        assert "token" not in ours.url  # the projector shows it
        ada.goto(address)
        ada.get_by_text("Nothing is asked now.").wait_for()
        ours.evaluate("slide => deck.slide(slide)", slide)
        said, bars = (ours.locator(f".present .vote-{it}") for it in ("said", "bars"))
        ada.get_by_role("button").nth(1).click()
        ada.get_by_text("Your vote: B. You may change it.").wait_for()
        bob.add_init_script(SLOW_AT_FIRST)
        bob.goto(address)
        # A change of mind is one vote, and the last one, even where the first is slow to arrive.
        bob.get_by_role("button").nth(1).click()
        bob.get_by_role("button").nth(0).click()
        bob.get_by_text("Your vote: A. You may change it.").wait_for()
        ours.get_by_text("2 votes").locator("visible=true").wait_for()
        assert not bars.is_visible()
        assert ada.locator("[aria-pressed=true]").count() == 1
        ours.keyboard.press("v")
        counts = bars.locator("> span:not(:has(i))")
        for place, count in enumerate(("1", "1", "0")):
            counts.nth(place).filter(has_text=count).wait_for()
        widths = [it.bounding_box()["width"] for it in bars.locator("i").all()]
        assert widths[0] == widths[1] > 20 * widths[2]
        ada.reload()
        ada.get_by_text("Your vote: B. You may change it.").wait_for()
        ours.keyboard.press("c")
        ada.get_by_text("Your vote: B. The vote is closed.").wait_for()
        assert ada.get_by_role("button").first.is_disabled()
        # A code that a telephone's camera can find: black, with the four light modules round it.
        code = ours.locator(".present .vote-code svg")
        small = code.bounding_box()["width"]
        ours.keyboard.press("q")
        assert code.bounding_box()["width"] > 2.5 * small
        ours.keyboard.press("q")
        ada.add_style_tag(content=STILL)
        for page in (ours, ada) if which == "04" else ():
            for theme in "light", "dark":
                page.evaluate("it => { document.documentElement.dataset.theme = it; }", theme)
                assert not violations(page)
        ours.get_by_role("button", name="Vote again").locator("visible=true").click()
        ours.get_by_text("0 votes").locator("visible=true").wait_for()
        assert not bars.is_visible()
        assert said.inner_text() == "0 votes"
        ada.get_by_text("Choose one.").wait_for()
        ours.keyboard.press("PageDown")
        ada.get_by_text("Nothing is asked now.").wait_for()
        for page in pages:
            page.assert_quiet()
    ada.get_by_text("No connection. It tries again.").wait_for()


def test_a_vote_outlives_a_server_that_hangs_and_one_that_begins_anew(another_page):
    ours, ada, port = another_page(), another_page(), free_port()
    with serving("04", port) as (link, address, server):
        open_deck(ours, link)
        ours.evaluate("deck.slide(4)")
        ada.goto(address)
        ada.get_by_role("button").nth(1).click()
        ada.get_by_text("Your vote: B. You may change it.").wait_for()
        server.send_signal(signal.SIGSTOP)
        ada.get_by_role("button").nth(0).click()
        ada.get_by_text("No connection. Your vote is sent when it is back.").wait_for()
        server.send_signal(signal.SIGCONT)
        ada.get_by_text("Your vote: A. You may change it.").wait_for()
    ada.get_by_text("No connection. It tries again.").wait_for()
    with serving("04", port):
        ada.get_by_text("Nothing is asked now.").wait_for()
