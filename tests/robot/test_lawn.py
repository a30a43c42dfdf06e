"""The loop closed: what gpsd passes on, what parks, and how well, at a small size."""

import json
import math
import sys
from contextlib import closing

import gpsd
import lawn
import numpy as np
import pytest

pytestmark = pytest.mark.needs("compiler")
FIXED = lawn.RECEIVERS["RTK fixed"]


@pytest.fixture
def client():
    """What speaks with gpsd."""
    pytest.importorskip("gpsdclient", reason="this test needs gpsdclient: pip install '.[robot]'")


def test_without_the_client_it_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "gpsdclient", None)
    with pytest.raises(RuntimeError, match=r'gpsdclient: pip install "\.\[robot\]"'):
        gpsd.Gpsd("ubx")


@pytest.mark.needs("gpsd")
@pytest.mark.usefixtures("client")
@pytest.mark.parametrize("form", gpsd.FORMATS)
def test_gpsd_passes_on_what_was_sent(form):
    places = np.random.default_rng(1).uniform((-80, -179), (80, 179), (40, 2)).tolist()
    with closing(gpsd.Gpsd(form)) as link:
        for k, (lat, lon) in enumerate(places):
            sent = gpsd.Position(3599.0 + 0.2 * k, lat, lon, 0.02, (1, 2, 5, 4)[k % 4])
            got, wanted = link.pass_on(sent), gpsd.rounded(sent, form)
            assert got[1:3] == pytest.approx(wanted[1:3], abs=1e-9)  # gpsd gives 9 digits
            assert got[1:3] == pytest.approx(sent[1:3], abs=6e-8 if form == "ubx" else 2e-9)


@pytest.mark.needs("gpsd")
@pytest.mark.usefixtures("client")
def test_a_drive_through_gpsd_is_the_drive_without_it():
    assert lawn.through_gpsd(2, (lawn.CASE.goal,)) < 1e-3


def test_over_a_route_it_parks_at_the_last_pose():
    ended = lawn.run(lawn.DESIGNS["h = 0, last turn"], FIXED, 2, lawn.ROUTE)
    assert ended.parked, ended
    assert ended.distance < 0.3
    assert abs(ended.heading) < math.radians(5.0)
    assert ended.time > 70.0  # one goal takes 63 s


@pytest.mark.slow
def test_the_table_has_all_pairs_and_a_last_turn_the_best_headings(tmp_path, monkeypatch, capsys):
    file = tmp_path / "lawn.json"
    monkeypatch.setattr(
        sys, "argv", ["lawn.py", "--runs=4", "--jobs=1", "--gpsd=0", f"--json={file}"]
    )
    lawn.main()
    rows = json.loads(file.read_text(encoding="utf-8"))
    printed = capsys.readouterr().out.splitlines()
    assert len(rows) == len(lawn.DESIGNS) * len(lawn.RECEIVERS) == len(printed) - 1
    assert all(row["parked"] == 1.0 for row in rows)
    for receiver in lawn.RECEIVERS:
        off = {row["design"]: row for row in rows if row["receiver"] == receiver}
        turned = off["h = 0, last turn"]["heading_deg_rms"]
        assert turned < 0.5 * off["gentle"]["heading_deg_rms"]
    far = [row["place_m_rms"] for row in rows if row["design"] == "h = 0, last turn"]
    assert far[0] > far[2] > far[3]
