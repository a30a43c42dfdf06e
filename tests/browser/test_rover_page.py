"""The rover in its page: from the disk, on a click, as fast as the screen, and as in Python."""

from pathlib import Path
from urllib.parse import unquote, urlsplit

import numpy as np
import pytest

pytest.importorskip("anywidget", reason="the panel needs anywidget")
from faults import crowded, violations
from host import Panel, mounted
from live import PATIENCE

import wmrlib as wmr
from wmrbook.panel import Rover
from wmrbook.rover_model import ARRIVAL, FASTEST, PAGE_DRIVE, PAGE_GAINS, PERIOD, stored
from wmrbook.rover_model import TRACK_WIDTH as WIDTH

SMALL, READY, SECONDS = 4e6, 30e3, 10  # bytes and ms, at most; s of frames
ROVER = "document.querySelector('.rover')"
ENDED = f"() => {ROVER}.dataset.done === 'true'"
FRAMES = """seconds => new Promise(done => {
    const times = [], tick = (now) => {
        times.push(now);
        if (now - times[0] < 1e3 * seconds) requestAnimationFrame(tick); else done(times);
    };
    requestAnimationFrame(tick);
})"""


def test_on_a_click_it_drives_as_in_python_at_the_screens_pace(browser_page, opened, capsys):
    """And once more on the ground that a hand makes steep and slippery."""
    asked = []
    browser_page.on("request", lambda it: asked.append(urlsplit(it.url)))
    page = opened("rover.html")
    files = {unquote(it.path) for it in asked if it.scheme == "file"}
    assert not [name for name in files if "mujoco" in name]
    assert sum(Path(name).stat().st_size for name in files) < SMALL
    page.get_by_role("button", name="Give it a body").click(timeout=PATIENCE)
    page.wait_for_function(f"() => {ROVER}.dataset.ready", timeout=PATIENCE)
    ready = float(page.evaluate(f"{ROVER}.dataset.ready"))
    times = np.array(page.evaluate(FRAMES, SECONDS))
    rate, worst = (times.size - 1) / (times[-1] - times[0]) * 1e3, np.diff(times).max()
    with capsys.disabled():
        print(
            f"\nready in {ready:.0f} ms; {rate:.1f} frames/s over {SECONDS} s, worst {worst:.0f} ms"
        )
    assert ready < READY
    assert rate > 20.0  # 60 on a quiet machine; here others work too
    page.get_by_role("button", name="Four times").click()
    page.wait_for_function(ENDED, timeout=PATIENCE)
    found = Panel(page).found()
    assert found["arrived"]
    every = round(1.0 / PERIOD)
    np.testing.assert_allclose(found["path"][::every], stored()["page"], atol=2e-3)  # m, rad

    for name, presses in (("grip", "Home"), ("slope", "End")):
        slider = page.get_by_role("slider", name=name)
        slider.focus()
        slider.press(presses)
    page.wait_for_function(ENDED, timeout=PATIENCE)
    found = Panel(page).found()
    assert not found["arrived"]
    assert found["worst"]["slip"] > 0.3
    assert "the rover does not arrive" in page.locator(".rover-words").inner_text()


def test_the_kinematic_robot_is_wmrlibs_and_needs_no_engine(emptied_page):
    panel = mounted(emptied_page, Rover(), width=900)
    emptied_page.wait_for_function(ENDED, timeout=PATIENCE)
    for change in ({}, {"k_alpha": 1.0, "h": 0.3, "v_max": 4.0}):
        panel.set(**change)
        emptied_page.wait_for_function(ENDED, timeout=PATIENCE)
        gains = PAGE_GAINS._replace(**change)
        wheels = wmr.Wheels(WIDTH, max_speed=FASTEST)
        run = wmr.simulate(*PAGE_DRIVE, gains, dt=PERIOD, arrival_radius=ARRIVAL, wheels=wheels)
        ideal = panel.found()["ideal"]
        for name in ("t", "x", "y", "heading"):
            assert ideal[name][ideal["n"] - 1] == pytest.approx(getattr(run, name)[-1], abs=1e-9)
    emptied_page.get_by_role("button", name="Give it a body").click()
    emptied_page.get_by_text("pages alone.").wait_for()


@pytest.mark.needs("npm")
def test_all_of_it_is_in_view_and_sound(emptied_page):
    mounted(emptied_page, Rover())
    for width in (1366, 390, 320):
        emptied_page.set_viewport_size({"width": width, "height": 720})
        assert crowded(emptied_page, ".rover", 20) == []
    assert violations(emptied_page, ".rover") == []
