"""Positions in UBX, packed here byte by byte as u-blox's interface description has them."""

import math
import subprocess
import sys
from struct import pack

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from logs import TEN_MINUTES

import wmrlib as wmr

KINDS = {"pvt": b"\x01\x07", "place": b"\x01\x14", "baseline": b"\x01\x3c", "dop": b"\x01\x04"}
GGA = b"$GPGGA,104706.00,5405.6081,N,01049.4791,E,1,08,1.1,40.8,M,43.6,M,,0000*5F\r\n"
NO_PLACE, DAMAGED = "message without a position", "message that is damaged or cut off"


def frame(kind, payload):
    body, first, second = kind + pack("<H", len(payload)) + payload, 0, 0
    for byte in body:
        first = (first + byte) % 256
        second = (second + first) % 256
    return b"\xb5b" + body + bytes([first, second])


def pvt(k=0, lat=-331000000, fix=3, flags=1, valid=3, bad=0, second=None, size=92):
    """NAV-PVT of second k; flags: 1 fix, 2 differential, 64 RTK float, 128 RTK fixed."""
    clock = 2026, 3, 1, 12, 0, k if second is None else second
    payload = pack("<IHBBBBBBIi", 1000 * k + 5000, *clock, valid, 0, 250_000_000)
    payload += pack("<BBBBiiii", fix, flags, 0, 21, 441234567, lat + k, 0, 0)
    payload += pack("<IIiiiii", 14, 20, 0, 0, 0, 500, 27_000_000) + pack("<IIH", 0, 0, 150)
    payload += pack("<H", bad)
    return frame(KINDS["pvt"], payload.ljust(size, b"\0"))


def place(k=0, invalid=0, lat=-331000000):
    head = pack("<BBBB", 0, 0, 0, invalid) + pack("<Iii", 1000 * k + 5000, 441234567, lat + k)
    return frame(KINDS["place"], head + pack("<iibbbbII", 0, 0, 89, -12, 0, 0, 123, 0))


def baseline(k=0, flags=1 | 4 | 16 | 256):
    head = pack("<BBHI", 1, 0, 0, 1000 * k + 5000) + bytes(16) + pack("<i", 12_345_678)
    return frame(KINDS["baseline"], head.ljust(60, b"\0") + pack("<I", flags))


def dop(k=0):
    return frame(KINDS["dop"], pack("<I7H", 1000 * k + 5000, 1, 2, 3, 4, 87, 6, 7))


OTHER = frame(b"\x02\x15", bytes(range(256)) * 2)


@pytest.fixture(scope="module")
def read(tmp_path_factory):
    path = tmp_path_factory.mktemp("ubx") / "log.bin"

    def of(*parts):
        path.write_bytes(b"".join(parts))
        return wmr.read_track(path)

    return of


def test_eleven_minutes_of_a_receiver_at_rest():
    """The sentences alone, read as text, say the same."""
    track = wmr.read_track(TEN_MINUTES)
    assert (track.source, len(track), track.t[-1]) == ("NMEA", 655, 654.0)
    assert dict(track.report.skipped) == {
        "stretch of bytes that is no message": (1, 0),
        NO_PLACE: (655 + 654 + 654, TEN_MINUTES.read_bytes().index(b"\xb5b")),
        "same epoch again": (2 * 655, TEN_MINUTES.read_bytes().index(b"$GNRMC")),
        "other sentence": (655, TEN_MINUTES.read_bytes().index(b"$GNVTG")),
    }
    gga = [line for line in TEN_MINUTES.read_bytes().split(b"\r\n") if b"$GNGGA" in line]
    fields = [line[line.index(b"$GNGGA") :].decode().split(",") for line in gga]
    assert [float(field[8]) for field in fields] == track.hdop.tolist()
    assert [float(field[7]) for field in fields] == track.satellites.tolist()
    lat = [-int(field[2][:2]) - float(field[2][2:]) / 60 for field in fields]
    np.testing.assert_allclose(track.points.lat, lat, rtol=0, atol=1e-12)
    assert {*track.rtk} == {"none"}
    known = wmr.GeoPoint(lat=-45.8775915, lon=170.500124833)
    far = wmr.haversine_distance(known, track.points)
    assert far.max() < 6.0


@pytest.mark.parametrize("size", [84, 92])
def test_nav_pvt_and_what_belongs_to_its_epoch(read, size):
    whole = [pvt(size=size), place(), baseline(), dop()]
    for parts in (whole, whole[::-1]):
        track = read(*parts, pvt(1, size=size), GGA, OTHER)
        assert (track.source, track.t.tolist()) == ("UBX", [0.0, 1.0])
        np.testing.assert_allclose(track.points.lat, [-33.100000012, -33.0999999], atol=1e-12)
        np.testing.assert_allclose(track.points.lon, [44.123456789, 44.1234567], atol=1e-12)
        np.testing.assert_allclose(track.accuracy, [0.0123, 0.014], atol=1e-12)
        np.testing.assert_allclose(track.heading, [math.radians(123.45678), math.nan])
        np.testing.assert_allclose(track.hdop, [0.87, math.nan])
        np.testing.assert_allclose(track.speed, 0.5)
        np.testing.assert_allclose(track.course, math.radians(270))
        assert track.satellites.tolist() == [21, 21]
        counts = {why: count for why, (count, _) in track.report.skipped.items()}
        assert counts == {"sentence beside NAV-PVT": 1, NO_PLACE: 1}
    assert repr(track.report).endswith(f"(first in byte {sum(map(len, parts)) + size + 8 + 75})")


def test_the_state_of_a_fix(read):
    for flags, quality, rtk in [(1, 1, "none"), (3, 2, "none"), (65, 5, "float"), (129, 4, "fixed"),
                                (131, 4, "fixed")]:  # fmt: skip
        track = read(pvt(flags=flags))
        assert (track.quality[0], track.rtk[0]) == (quality, rtk)
    for lost in ({"flags": 0}, {"flags": 128}, {"bad": 1}, *({"fix": k} for k in (0, 1, 5))):
        track = read(pvt(), pvt(1, **lost), pvt(2))
        assert track.t.tolist() == [0.0, 2.0]
        assert dict(track.report.skipped) == {"NAV-PVT without a fix": (1, 100)}
    for valid in (0, 1, 2):
        track = read(pvt(valid=valid))
        assert np.isnan(track.t).all()
        assert dict(track.report.noted) == {"with an unreadable time": (1, 0)}
    for doubt in (baseline(flags=1 | 4), baseline(flags=256)):
        assert np.isnan(read(pvt(), doubt).heading).all()
    assert read(pvt(), place(invalid=1)).points.lat[0] == pytest.approx(-33.1, abs=1e-12)
    track = read(pvt(), place(1), pvt(2))
    assert dict(track.report.skipped) == {"message of an epoch without NAV-PVT": (1, 100)}
    assert read(pvt(lat=910000000), pvt(1)).report.skipped == {"latitude not in -90 to 90": (1, 0)}


def test_a_file_without_a_position_says_why(read):
    for parts, message in [
        ((pvt(flags=0),), r"it is UBX, but 1 NAV-PVT without a fix \(first in byte 0\)$"),
        ((place(),), rf"it is NMEA, but 1 {NO_PLACE} \(first in byte 0\)$"),
        ((pvt()[:-1],), "it is neither NMEA, UBX, GPX, GeoJSON nor gpsd"),
        ((frame(KINDS["pvt"], bytes(83)),), "1 message of an unknown length"),
        ((b"\xb5b\x01\x07\xff\xff" * 10_000, OTHER), f"but 1.* {DAMAGED}"),
    ]:
        with pytest.raises(ValueError, match=message):
            read(*parts)


EPOCHS = [[pvt(k), place(k), dop(k), GGA, OTHER] for k in range(4)]
SOUND = b"".join(b"".join(epoch) for epoch in EPOCHS)
RIGHT = {round(5e-12 + (k - 331000000) * 1e-7 - off, 9) for k in range(4) for off in (0.0, 12e-9)}


@given(st.lists(st.tuples(st.integers(0, len(SOUND) - 1), st.integers(0, 255)), max_size=3),
       st.integers(0, len(SOUND)), st.binary(max_size=40))  # fmt: skip
@example([(4, 255), (5, 255)], len(SOUND), b"")  # a length far beyond the end
@example([(4, 255)], 100, pvt()[:50])
def test_no_damage_gives_a_wrong_position(read, changes, place, garbage):
    """Bytes changed, a stretch put in between: positions are right or missing, and counted."""
    data = bytearray(SOUND)
    for at, byte in changes:
        data[at] = byte
    data[place:place] = garbage
    track = read(data)
    assert {*np.round(track.points.lat, 9)} <= RIGHT or track.source == "NMEA"
    if track.source == "UBX":
        lost = sum(count for count, _ in track.report.skipped.values())
        assert len(track) == 4 or lost > 8
        assert len(track) >= 4 - len(changes) - 1
        assert (np.diff(track.t) > 0.0).all()


def test_pyubx2_is_needed_for_nav_pvt_alone(tmp_path):
    (tmp_path / "a.ubx").write_bytes(pvt())
    code = f"""import sys; sys.modules["pyubx2"] = None; import wmrlib as wmr
assert len(wmr.read_track({str(TEN_MINUTES)!r})) == 655
wmr.read_track({str(tmp_path / "a.ubx")!r})"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    wanted = 'ImportError: UBX needs pyubx2: pip install ".[book]" in the repository'
    assert done.stderr.splitlines()[-1] == wanted
