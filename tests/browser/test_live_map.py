"""The page with the live position: what it serves, to whom, and what it shows."""

import json
import math
import re
import threading
import time
import urllib.error
import urllib.request
from types import SimpleNamespace

import pytest
from live_map import LiveMap
from live_receiver import Fix

import wmrlib as wmr
from wmrlib.tracks.fixes import UNSAID

GOAL = wmr.GeoPoint(lat=48.1, lon=11.5)


def fix(east, north, old=0.0):
    said = UNSAID._replace(quality=4.0, satellites=17.0, hdop=0.7, accuracy=0.03)
    return Fix(wmr.point_at(GOAL, east, north), said, "now", time.monotonic() - old)


@pytest.fixture
def served():
    receiver = SimpleNamespace(latest=lambda: receiver.fix, fix=None, trouble="not connected yet")
    shown = LiveMap(receiver, GOAL, math.pi / 2, 20.0)
    thread = threading.Thread(target=shown.serve)
    thread.start()
    yield receiver, shown.address
    shown.close()
    thread.join()


def got(address, **headers):
    request = urllib.request.Request(address, headers=headers)
    with urllib.request.urlopen(request) as answer:
        return answer.read()


def test_it_says_where_the_receiver_is_and_nothing_that_json_can_not(served):
    receiver, address = served
    assert json.loads(got(address + "fix"))["says"] == "not connected yet"
    receiver.fix, receiver.trouble = fix(3.0, -4.0, old=1.5), ""
    told = json.loads(got(address + "fix"), parse_constant=pytest.fail)
    assert told["place"] == pytest.approx([3.0, -4.0], abs=1e-3)
    assert told["away"] == pytest.approx(5.0, abs=1e-3)
    assert told["age"] == pytest.approx(1.5, abs=1.0)
    assert told["said"] == {"quality": 4.0, "satellites": 17.0, "hdop": 0.7, "accuracy": 0.03}
    receiver.fix = fix(3.5, -4.0)
    assert len(json.loads(got(address + "fix"))["trail"]) == 2
    for path in ("../live.py", "live_map.py", "etc/passwd"):
        with pytest.raises(urllib.error.HTTPError, match="404"):
            got(address + path)
    with pytest.raises(urllib.error.HTTPError, match="403"):
        got(address + "fix", Host="another.example")
    with pytest.raises(ValueError, match=r"fence = 0\.0 .* above 0"):
        LiveMap(receiver, GOAL, 0.0, 0.0)


def test_the_page_follows(served, emptied_page):
    (receiver, address), page = served, emptied_page
    page.goto(address)
    says = page.get_by_role("status")
    page.wait_for_function("document.querySelector('#says').textContent.includes('not connected')")
    receiver.fix, receiver.trouble = fix(30.0, -4.0), ""
    page.wait_for_function("document.querySelector('.here')")
    page.wait_for_function("document.querySelector('#says').textContent.includes('RTK fixed')")
    assert re.match(r"30\.3 m from the goal\. RTK fixed, 17 satellites, HDOP 0\.7, within 0\.03 m",
                    says.inner_text())  # fmt: skip
    east, north = (float(page.locator(".here").get_attribute(name)) for name in ("cx", "cy"))
    assert 10.0 < east <= 20.0  # in the picture, though outside the fence
    assert north > 10.0  # to the south
    receiver.fix = fix(1.0, 2.0, old=60.0)
    page.wait_for_function("document.querySelector('#says').classList.contains('old')")
    assert "a robot should stand" in says.inner_text()
