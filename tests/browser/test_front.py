"""The front page's picture says what wmrlib finds, can be held by both poses, and reads well."""

from __future__ import annotations

import math
import re

import pytest

pytest.importorskip("anywidget", reason="the panel needs anywidget")
from faults import violations
from host import mounted

import wmrlib as wmr
from wmrbook.panel import Front

PICTURE = "() => document.querySelector('.front canvas').toDataURL()"
SAID = "() => document.querySelector('.front-words').textContent"


def off_deg(goal, gains) -> float:
    run = wmr.simulate(wmr.paper.outdoor().start, goal, gains, method="continuous")
    return abs(math.degrees(run.heading_error[-1]))


@pytest.mark.needs("npm")
def test_it_says_how_far_off_the_paper_s_gains_leave_the_robot_and_that_gentle_ones_park_it(
    emptied_page,
):
    mounted(emptied_page, Front(), width=390, height=768)
    _, goal, gains, _ = wmr.paper.outdoor()
    assert f"faces {off_deg(goal, gains):.0f}° the wrong way" in emptied_page.evaluate(SAID)
    slider = emptied_page.locator(".front-row input")
    slider.focus()
    slider.press("End")
    for _ in range(60):
        slider.press("ArrowRight")
    assert off_deg(goal, wmr.GENTLE_GAINS) < 3.0
    assert emptied_page.evaluate(SAID).endswith("With gentler gains it parks.")
    assert not violations(emptied_page, ".front")


def test_a_pose_that_is_turned_by_keys_is_driven_to_and_the_whole_way_stays_in_view(emptied_page):
    page = emptied_page
    mounted(page, Front(), width=1366, height=768)
    before = page.evaluate(SAID)
    turn = page.locator("[data-pose=goal][data-part=turn]")
    for _ in range(18):
        turn.press("ArrowLeft")
    text = page.evaluate(SAID)
    assert text != before
    heading = re.search(r"heading (.*?)°", turn.get_attribute("aria-label"))[1]
    _, goal, gains, _ = wmr.paper.outdoor()
    heading = float(heading.replace("\N{MINUS SIGN}", "-"))
    turned = goal._replace(heading=math.radians(heading))
    assert f"faces {off_deg(turned, gains):.0f}° the wrong way" in text
    start = page.locator("[data-pose=start]")
    assert start.locator("visible=true").count() == 0  # out of the picture
    page.get_by_role("button", name="The whole way").click()
    start.last.wait_for(state="visible")
    assert start.locator("visible=true").count() == 2
    page.get_by_role("button", name="Drive again").click()
    page.wait_for_timeout(200)
    assert page.get_by_role("button", name="The last metre").is_visible()
    assert start.locator("visible=true").count() == 2
