"""The panel of "My robot" says what wmrbook.robot_sheet says, run by run, and reads well."""

from __future__ import annotations

import math

import numpy as np
import pytest

pytest.importorskip("anywidget", reason="the panel needs anywidget")
from faults import axe
from host import mounted

from wmrbook.panel import MyRobot
from wmrbook.robot_sheet import RECEIVERS, RUNS, Robot, certificate, files, sheet, sure

DONE = "() => document.querySelector('.my-robot').dataset.done === 'true'"
FOUND = """() => { const { ends, ...found } = document.querySelector('.my-robot').found;
    const columns = ['place', 'heading'].map(name => [name, ends.map(it => it[name])]);
    return { ...found, ...Object.fromEntries(columns) }; }"""
WIDE = """() => [...document.querySelectorAll('.my-robot *')].filter(it => it.checkVisibility()
    && (it.getBoundingClientRect().right > innerWidth + 1
        || it.getBoundingClientRect().left < -1)).map(it => it.outerHTML.slice(0, 90))"""
SMALL = """() => [...document.querySelectorAll('.my-robot :is(button, input, select)')]
    .filter(it => it.checkVisibility() && it.getBoundingClientRect().height < 24)
    .map(it => it.outerHTML)"""
FAULTS = "async () => (await axe.run('.my-robot')).violations.map(it => [it.id, it.nodes[0].html])"
SLOW = {"track_width": 1.0, "acceleration": 0.2, "max_speed": 2.0}
QUICK = {"track_width": 0.2, "acceleration": 5.0, "dead_band": 0.0, "delay": 0.0}
ROBOTS = [  # among them, each term of each rule decides
    Robot(),
    Robot(**RECEIVERS["SBAS"]),  # in a run a wheel stops just as a period ends
    Robot(**RECEIVERS["SBAS"], dead_band=0.0, delay=0.0, goal_lon=44.3729, bearing=10.0),
    Robot(sigma=0.3, memory=0.0, period=0.1, delay=0.25, fix_period=1.0, track_width=0.8),
    Robot(sigma=0.0, memory=0.0, dead_band=0.15, delay=0.2, fix_period=0.5, **SLOW),
    Robot(sigma=1.5, memory=0.0, period=0.03, fix_period=0.125, compass=0.0, **QUICK),
    Robot(period=0.2, **QUICK | {"track_width": 1.5, "max_speed": 0.5}),
    Robot(goal_lat=33.279, **QUICK | {"acceleration": 0.1, "max_speed": 3.0, "delay": 0.1}),
]
WRONG = [
    {"track_width": 0.0},
    {"goal_lat": 133.0},
    {"goal_lat": 44.373264, "goal_lon": 33.274087},
    {"goal_lat": 34.2},
    {"goal_lat": 33.273580, "goal_lon": 44.373160, "sigma": 9.0},
    {"dead_band": 0.6},
    {"dead_band": 0.3},
]


def opened(page, robot=ROBOTS[0], width=900):
    panel = mounted(page, MyRobot(robot), width=width)
    page.wait_for_function(DONE, timeout=60_000)
    return panel


@pytest.mark.parametrize("robot", ROBOTS)
def test_the_page_says_what_python_says(emptied_page, robot):
    opened(emptied_page, robot)
    found, told, ours = emptied_page.evaluate(FOUND), sheet(robot), certificate(robot)
    given = found["sheet"]
    for name in ("x", "y", "heading", "distance", "radius", "longest_step", "min_speed"):
        assert given[name] == pytest.approx(getattr(told, name), abs=1e-7), name
    for name in ("duration", "oldest", "patience"):
        assert given[name] == getattr(told, name), name
    assert given["gains"] == pytest.approx(told.gains._asdict())
    assert given["turn"] == pytest.approx(told.turn._asdict())
    assert found["files"] == files(robot)
    # A run that ends a sample later by a rounding ends elsewhere; hardly any does.
    for name in ("place", "heading"):
        theirs = np.array(found[name])
        assert np.mean(np.abs(theirs - getattr(ours, name)) < 1e-6) > 0.97
    assert found["parked"] == ours.parked == RUNS
    for name in ("place_rms", "heading_rms", "place_bound", "heading_bound", "time"):
        assert found[name] == pytest.approx(getattr(ours, name), rel=0.02), name


def test_a_drive_that_does_not_end_leaves_no_bound(emptied_page):
    robot = Robot(delay=0.8, max_speed=2.8, acceleration=0.73, dead_band=0.0)
    opened(emptied_page, robot)
    ours, found = certificate(robot), emptied_page.evaluate(FOUND)
    assert found["parked"] < sure(RUNS) > ours.parked
    assert abs(found["parked"] - ours.parked) < 20
    assert found["place_bound"] is None or math.isinf(found["place_bound"])
    assert "did not end in time" in emptied_page.locator(".my-robot > [role=status]").inner_text()


@pytest.mark.parametrize("wrong", WRONG)
def test_what_is_wrong_is_said_as_in_python(emptied_page, wrong):
    panel = opened(emptied_page)
    with pytest.raises(ValueError, match=r"is|are") as refusal:
        sheet(Robot(**wrong))
    panel.set(**wrong)
    assert emptied_page.locator(".my-robot [role=alert]").inner_text() == str(refusal.value)
    assert not emptied_page.locator(".my-results").is_visible()
    marked = emptied_page.locator("[aria-invalid=true]")
    names = [marked.nth(k).get_attribute("name") for k in range(marked.count())]
    assert names == [name for name in wrong if str(refusal.value).startswith(f"{name} ")]
    panel.set(**Robot()._asdict())
    assert emptied_page.locator(".my-results").is_visible()


def test_a_hand_fills_in_fields_and_takes_the_files(emptied_page):
    opened(emptied_page)
    menu = emptied_page.get_by_label("kind of fix")
    assert menu.input_value() == "RTK fixed"
    menu.select_option("SBAS")
    field = emptied_page.get_by_label("error of a position")
    assert float(field.input_value()) == RECEIVERS["SBAS"]["sigma"]
    field.fill("0.5")
    field.press("Tab")
    assert menu.input_value() == "my own"
    field.fill("")
    field.press("Tab")
    assert emptied_page.locator("[role=alert]").inner_text().startswith("sigma = NaN")
    field.fill("0.5")
    field.press("Tab")
    emptied_page.wait_for_function(DONE, timeout=60_000)
    robot = Robot(**RECEIVERS["SBAS"] | {"sigma": 0.5})
    for name, text in files(robot).items():
        with emptied_page.expect_download() as saved:
            emptied_page.get_by_role("button", name=f"Save {name}").click()
        assert saved.value.suggested_filename == name
        assert saved.value.path().read_text(encoding="utf-8") == text


@pytest.mark.parametrize("width", [320, 390, 1366, 1920])
def test_all_of_it_is_in_view_and_sound(emptied_page, width):
    opened(emptied_page, width=width)
    assert emptied_page.evaluate(WIDE) == []
    assert emptied_page.evaluate(SMALL) == []
    emptied_page.add_script_tag(path=axe())
    assert emptied_page.evaluate(FAULTS) == []
