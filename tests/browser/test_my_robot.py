"""The panel of "My robot" says what wmrrobot.sheets says, run by run, and reads well."""

from __future__ import annotations

from functools import reduce
from operator import xor

import numpy as np
import pytest

pytest.importorskip("anywidget", reason="the panel needs anywidget")
from faults import crowded, violations
from host import mounted
from logs import STANDING, TEN_MINUTES

import wmrlib as wmr
from wmrbook.panel import MyRobot
from wmrrobot.exports import along, at_rest, files
from wmrrobot.sheets import RECEIVERS, RUNS, Robot, certificate, sheet, sure

DONE = "() => document.querySelector('.my-robot').dataset.done === 'true'"
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
    Robot(antenna_ahead=0.3, antenna_left=-0.2, compass=10.0, fix_period=0.5, acceleration=5.0),
    Robot(delay=1.5, dead_band=0.0),
    Robot(fix_period=2.0, compass=10.0, antenna_ahead=0.3),  # the odometry goes astray
]
WRONG = [
    {"track_width": 0.0},
    {"goal_lat": 133.0},
    {"goal_lat": 44.373264, "goal_lon": 33.274087},
    {"goal_lat": 34.2},
    {"goal_lat": 33.273580, "goal_lon": 44.373160, "sigma": 9.0},
    {"dead_band": 0.6},
    {"dead_band": 0.3},
    {"delay": 2.0},
    {"compass": 25.0},
    {"quality": 3.5},
    {"antenna_left": 6.0},
]


def opened(page, robot=ROBOTS[0]):
    panel = mounted(page, MyRobot(robot), width=900)
    page.wait_for_function(DONE, timeout=60_000)
    return panel


@pytest.mark.parametrize(
    "robot", [*ROBOTS[:2], *(pytest.param(it, marks=pytest.mark.slow) for it in ROBOTS[2:])]
)
def test_the_page_says_what_python_says(emptied_page, robot):
    results, numbers, ours = opened(emptied_page, robot).results(), sheet(robot), certificate(robot)
    given = results["sheet"]
    for name in ("x", "y", "heading", "distance", "radius", "longest_step"):
        assert given[name] == pytest.approx(getattr(numbers, name), abs=1e-7), name
    assert given["duration"] == numbers.duration
    assert given["rules"] == pytest.approx(numbers.rules._asdict())
    assert given["gains"] == pytest.approx(numbers.gains._asdict())
    assert given["turn"] == pytest.approx(numbers.turn._asdict())
    assert given["wheels"] == pytest.approx(numbers.wheels._asdict())
    assert results["files"] == files(robot)
    # A run that ends a sample later by a rounding ends elsewhere; hardly any does.
    for name in ("place", "heading"):
        theirs = np.array([end[name] for end in results["ends"]])
        assert np.mean(np.abs(theirs - getattr(ours, name)) < 1e-6) > 0.97
    assert results["parked"] == ours.parked == RUNS
    for name in ("place_rms", "heading_rms", "place_bound", "heading_bound", "time"):
        assert results[name] == pytest.approx(getattr(ours, name), rel=0.02), name


def test_drives_that_the_checks_stop_leave_no_bound(emptied_page):
    robot = Robot(antenna_ahead=5.0, antenna_left=5.0, compass=20.0)
    ours, results = certificate(robot), opened(emptied_page, robot).results()
    assert results["parked"] < sure(RUNS) > ours.parked
    assert abs(results["parked"] - ours.parked) < 5
    assert results["place_bound"] is None
    assert "did not park in time" in emptied_page.locator(".my-robot > [role=status]").inner_text()


def test_what_is_wrong_is_said_as_in_python(emptied_page):
    panel = opened(emptied_page)
    for wrong in WRONG:
        with pytest.raises(ValueError, match=r"is|are") as refusal:
            sheet(Robot(**wrong))
        panel.set(**wrong)
        assert emptied_page.locator(".my-robot [role=alert]").inner_text() == str(refusal.value)
        assert not emptied_page.locator(".my-results").is_visible()
        marked = emptied_page.locator("[aria-invalid=true]").all()
        names = [name for name in wrong if str(refusal.value).startswith(f"{name} ")]
        assert [it.get_attribute("name") for it in marked] == names
        panel.set(**Robot()._asdict())
        assert emptied_page.locator(".my-results").is_visible()


def test_a_hand_fills_in_fields_and_takes_the_files(emptied_page):
    panel = opened(emptied_page)
    menu = emptied_page.get_by_label("kind of fix")
    assert menu.input_value() == "RTK fixed"
    menu.select_option("SBAS")
    field = emptied_page.get_by_label("error of a position")
    assert float(field.input_value()) == RECEIVERS["SBAS"]["sigma"]
    panel.type(field, "0.5")
    assert menu.input_value() == "my own"
    panel.type(field, "")
    assert emptied_page.locator("[role=alert]").inner_text().startswith("sigma = NaN")
    panel.type(field, "0.5")
    emptied_page.wait_for_function(DONE, timeout=60_000)
    robot = Robot(**RECEIVERS["SBAS"] | {"sigma": 0.5})
    for name, text in files(robot).items():
        with emptied_page.expect_download() as saved:
            emptied_page.get_by_role("button", name=f"Save {name}").click()
        assert saved.value.suggested_filename == name
        assert saved.value.path().read_text(encoding="utf-8") == text


def sentence(body):
    return f"${body}*{reduce(xor, body.encode()):02X}"


def log_of_all_kinds():
    """A drive south-west of Greenwich's equator, with epochs of which no place is to be used."""
    gga = "GPGGA,{},0012.{:05d},S,00101.5,W,{},08,1.0,1,M,1,M,,"
    rmc = "GNRMC,{},A,0012.{:05d},S,00101.5,W,0,0,010326,,,A"
    rows = [
        gga.format("120000.00", 30000, 0),
        rmc.format("120000.00", 31000),  # the GGA denies it
        rmc.format("120001.00", 32000),
        gga.format("120001.00", 33000, 4),  # first
        gga.format("120002.00", 34000, 6),
        "GNGNS,120003.00,0012.35000,S,00101.5,W,AN,10,1,1,1,,",
        "GPGLL,0012.36000,S,00101.5,W,120004.00,A,A",
        "GPGGA,120005.00,0012.37,S,00191.5,W,1,08,1.0,1,M,1,M,,",  # 91 minutes
        rmc.format("120006.00", 38000).replace(",A,0012", ",V,0012"),
        "GPGLL,0012.39000,S,00101.6,W,120007.00,A",  # last
        gga.format("120008.00", 40000, 8),
        gga.format("", 41000, 1),
    ]
    rows += [
        gga.format("120011.00", 38500, 1),
        gga.format("120011.00", 38600, 5).replace("GP", "GN", 1),  # RTK, of another receiver
        gga.format("120012.00", 38700, 0),
        gga.format("120012.00", 38800, 1).replace("GP", "GN", 1),
        gga.format("120013.00", 0, 1).replace("0012", "0000").replace("00101.5", "00000.0"),
        gga.format("120040.00", 38900, 1).replace("00101", "00103"),  # far from the others
        *(gga.format(f"1201{k}.00", 39000 + k, 1) for k in range(15, 25)),
    ]
    lines = [sentence(row) for row in rows]
    lines += [f"# {sentence(gga.format('120009.00', 42000, 1))}"]
    lines += [sentence(gga.format("120010.00", 43000, 1))[:-2] + "00"]
    return "\r\n".join(lines) + "\r\n"


def test_a_log_fills_in_the_way_and_the_scatter(emptied_page, tmp_path):
    """As wmrlib reads it, with the same files at rest and the same way."""
    panel = opened(emptied_page)
    made = tmp_path / "made.nmea"
    made.write_bytes(log_of_all_kinds().encode())
    assert len(wmr.read_track(made)) == 17
    for path in (made, STANDING, TEN_MINUTES):
        track = wmr.read_track(path)
        for label, filled in (("from the log of a drive", along), ("from a log at rest", at_rest)):
            emptied_page.get_by_label(label).set_input_files(path)
            summary = f"{path.name}: {len(track)} fixes"
            emptied_page.wait_for_function(
                "said => document.querySelector('.my-heard').textContent === said", arg=summary
            )
            wanted, given = filled(Robot(), track)._asdict(), panel.state()
            changed = [name for name, value in Robot()._asdict().items() if wanted[name] != value]
            assert changed
            for name in changed:
                assert given[name] == pytest.approx(
                    wanted[name], rel=5.1e-4 * (name == "sigma"), abs=6e-8
                ), name
            emptied_page.evaluate("() => document.querySelector('.my-heard').textContent = ''")
    none = tmp_path / "none.nmea"
    none.write_text("$GPGGA,nothing*00")
    before = panel.state()
    emptied_page.get_by_label("from a log at rest").set_input_files(none)
    emptied_page.get_by_text("none.nmea: no NMEA sentence").wait_for()
    assert panel.state() == before


@pytest.mark.needs("npm")
def test_all_of_it_is_in_view_and_sound(emptied_page):
    opened(emptied_page)
    for width in (1920, 1366, 390, 320):
        emptied_page.set_viewport_size({"width": width, "height": 720})
        assert crowded(emptied_page, ".my-robot") == []
    assert violations(emptied_page, ".my-robot") == []
