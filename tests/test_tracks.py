"""Positions in files, against the sentences themselves, the ellipsoid and by property."""

import gzip
import json
import math
import re
from collections import Counter
from datetime import UTC, datetime, timedelta, timezone
from functools import reduce
from operator import xor
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from logs import STANDING

import wmrlib as wmr
from wmrlib.tracks import Count
from wmrlib.tracks.fixes import Fixes, Reported

GPX_11 = "{http://www.topografix.com/GPX/1/1}"
BEGIN = datetime(2026, 3, 1, 12, 0, 0, tzinfo=UTC)


def places(track):
    return track.points.lat.tolist(), track.points.lon.tolist()


def nmea(body):
    return f"${body}*{reduce(xor, body.encode('latin-1')):02X}"


FORMS = {  # the most trusted first
    "GGA": "{talker}GGA,{clock},{lat},{lon},{mode},{sats},1.1,40.8,M,43.6,M,,0000",
    "GNS": "{talker}GNS,{clock},{lat},{lon},{mode},{sats},1.1,40.8,43.6,,",
    "RMC": "{talker}RMC,{clock},{status},{lat},{lon},0.24,18.02,{day},,,{mode}",
    "GLL": "{talker}GLL,{lat},{lon},{clock},{status},{mode}",
}
FIX = {"clock": "104706.00", "lat": "5405.6081,N", "lon": "01049.4791,E", "talker": "GP"}
FIX |= {"sats": "08", "status": "A", "day": "240709"}


def nmea_row(kind, **fields):
    mode = 1 if kind == "GGA" else "A"
    return nmea(FORMS[kind].format(**{**FIX, "mode": mode, **fields}))


def gga(clock=FIX["clock"], **fields):
    return nmea_row("GGA", clock=clock, **fields)


def rmc(clock=FIX["clock"], **fields):
    return nmea_row("RMC", clock=clock, **fields)


def gpx(inner, head='<?xml version="1.0"?>', root=f'gpx version="1.1" xmlns="{GPX_11[1:-1]}"'):
    return f"{head}\n<{root}>\n{inner}\n</{root.split()[0]}>"


def trk(*points):
    return "<trk><trkseg>\n" + "\n".join(points) + "\n</trkseg></trk>"


def at(lat, time="", kind="trkpt"):
    return f'<{kind} lat="{lat}" lon="44.5">{time and f"<time>{time}</time>"}</{kind}>'


GOOD = '<trkpt lat="33.27" lon="44.37"/>'
LAT, LON = 54 + 5.6081 / 60, 10 + 49.4791 / 60  # of gga() and rmc()

# What all files share


def in_order(times):
    """How many positions the longest run whose times increase has, by trying all."""
    best = []
    for i, time in enumerate(times):
        best.append(1 + max((best[j] for j in range(i) if times[j] < time), default=0))
    return max(best, default=0)


def falls_or_stands(times):
    steps = np.diff([time for time in times if time is not None])
    stands = len(steps) > 3 and not steps.any()
    return stands or (steps < 0).sum() > max(3, 9 * (steps > 0).sum())


# A list that falls nearly all the way is turned round instead, and no position of a clock that
# stands is lost.
seconds = st.lists(st.none() | st.integers(0, 20), max_size=12)
seconds = seconds.filter(lambda times: not falls_or_stands(times))


def settled(*segments):
    fixes, line = Fixes(), 0
    for segment in segments:
        fixes.segment += 1
        for second in segment:
            time = math.nan if second is None else second
            fixes.add(33 + 1e-5 * line, 44.5, time, line)
            line += 1
    return fixes.settle()


@given(st.lists(seconds, max_size=4))
@example([[5, 7, 6], [1, 9, 2, 3]])  # 1 or 9: as long a run goes on from either
@example([[0, 1, 99, 99, 99, 2, 2], [-5, -5, -5, 0, 1]])  # a wrong time, however often
def test_a_time_out_of_order_costs_its_own_position_only(segments):
    (lat, _, time, *_), report = settled(*segments)
    alone = [settled(segment)[0][2] for segment in segments]
    np.testing.assert_array_equal(time, np.concatenate([[], *alone]))
    line = sum(map(len, segments))
    assert report.used == lat.size == line - sum(count for count, _ in report.skipped.values())
    numbers = np.round(1e5 * (lat - 33)).astype(int)
    used = dict(zip(numbers.tolist(), time.tolist(), strict=True))
    line, first_lost = 0, []
    for segment in segments:
        numbers = range(line, line + len(segment))
        stays = [used[k] for k in numbers if not math.isnan(used.get(k, math.nan))]
        assert stays == sorted({*stays})
        assert len(stays) == in_order([s for s in segment if s is not None])
        assert all(k in used for k, s in zip(numbers, segment, strict=True) if s is None)
        first_lost += [k for k in numbers if k not in used]
        line += len(segment)
    if first_lost:
        assert report.skipped.keys() <= {"time runs backwards", "same time again"}
        assert min(first for _, first in report.skipped.values()) == first_lost[0]


# NMEA


def test_the_real_log(read):
    track = wmr.read_track(STANDING)
    assert (track.source, track.t.tolist()) == ("NMEA", list(range(9)))
    assert track.points.lat[0] == pytest.approx(LAT, abs=1e-12)
    assert track.points.lon[-1] == pytest.approx(10 + 49.4885 / 60, abs=1e-12)
    lines = STANDING.read_text(encoding="utf-8").splitlines()
    starts = ["#" if line[:1] == "#" else line[3:6] for line in lines]
    assert dict(track.report.skipped) == {
        "comment": (starts.count("#"), 1),
        "same epoch again": (18, 1 + starts.index("RMC")),  # RMC and GLL
        "other sentence": (sum(line.startswith("$") for line in lines) - 27, 8),
    }
    assert not track.report.noted
    for values in (track.points.lat, track.points.lon, track.t):
        with pytest.raises(ValueError, match="read-only"):
            values[0] = 0.0
    # RMC alone tells the same
    assert places(read([line for line in lines if "GGA" not in line])) == places(track)


def log(words):
    """G080000 is a GGA, N080000 one without a fix, R080000/290224 an RMC with its date."""
    lines = []
    for word in words.split():
        kind, (clock, _, day) = word[0], word[1:].partition("/")
        if kind == "R":
            lines.append(rmc(clock, day=day))
        else:
            lines.append(gga(clock, mode=int(kind == "G")))
    return lines


NIGHT = " ".join(f"N{hour % 24:02d}0000" for hour in range(20, 32))
COLD = " ".join(f"N0000{second:02d}" for second in range(30))  # may count from midnight
CLOCKS = {
    "G235959.00 G000000.50 G000001.00": [0, 1.5, 2],
    f"G190000 {NIGHT} G080000 G080001": [0, 13 * 3600, 13 * 3600 + 1],
    "R080000/290224 R090000/010324": [0, 90000],
    "G235959 R000000/010324 G000001": [0, 1, 2],
    "R080000/240709 R080001/010180 R080002/240709 R080003/240709": [0, 1, 2, 3],
    "R235958/240709 R235959/240709 R000000/240709 R000001/250709": [0, 1, 2, 3],  # a late date
    "R152505/091209 R152506/091209 G143306 R143307/091209": [0, 1],  # an older log below
    "R235958/091209 G235959 G000000 G000001 R000002/101209": [0, 1, 2, 3, 4],
    "G235959 G235960 G000001": [0, 1, 2],
    f"G010000 {COLD} G010500 G010501": [0, 300, 301],
}


@pytest.mark.parametrize("words", CLOCKS)
def test_time_goes_on_from_day_to_day(read, words):
    assert read(log(words)).t.tolist() == CLOCKS[words]
    no_fix = rmc("080001", day="060180", status="V")  # its date does not count
    sentences = [rmc("080000", day="290224"), no_fix, rmc("080002", day="290224")]
    assert read(sentences).t.tolist() == [0, 2]


NO_FIX, UNREADABLE = "sentence without a fix", "unreadable position"
BAD_SENTENCES = {
    NO_FIX: [
        *(gga(mode=k) for k in (0, 6, 8, 10, "")),
        *(rmc(status="V"), rmc(status="", mode=""), nmea_row("GNS", mode="")),
        *(nmea_row(kind, sats=sats) for kind in ("GGA", "GNS") for sats in ("0", "00")),
    ],
    UNREADABLE: [  # not zero, nor 55 degrees
        *(gga(lat=lat) for lat in ("5460.0000,N", "0,N", "5405.6081,", "5405.6081,X")),
        *(gga(lat=",N", lon=",E"), gga(lat="5405,N", lon="01049,E")),
    ],
    "fix without a readable time": [gga("")],
}


@pytest.mark.parametrize("reason", BAD_SENTENCES)
def test_a_sentence_that_gives_no_position_is_counted(read, reason):
    for bad in BAD_SENTENCES[reason]:
        track = read("\r\n".join([gga("104705.00"), bad, gga("104707.00"), bad, ""]))
        assert places(track) == (pytest.approx([LAT] * 2), pytest.approx([LON] * 2)), bad
        assert dict(track.report.skipped) == {reason: Count(2, 2)}
        assert f"not used: 2 {reason} (first in line 2)" in repr(track.report)
        if reason in (NO_FIX, UNREADABLE):
            with pytest.raises(ValueError, match=f"it is NMEA, but 1 {reason}"):
                read(bad)


SENTENCES = [
    gga(f"1047{k:02d}.00", lat=f"54{k:02d}.6081,N", talker=("GP", "GN", "GL")[k % 3])
    for k in range(6)
]


@given(st.integers(0, 5), st.integers(0, 200), st.integers(0, 255))
def test_a_corrupted_byte_is_never_used_silently(read, which, place, byte):
    """Whatever one byte becomes, only true positions come out, and what is lost is counted."""
    data = bytearray("\r\n".join([*SENTENCES, ""]).encode())
    at = sum(len(sentence) + 2 for sentence in SENTENCES[:which]) + place % len(SENTENCES[which])
    changed, data[at] = data[at] != byte, byte
    track = read(bytes(data))
    minutes = (track.points.lat - 54) * 60 - 0.6081
    kept = np.round(minutes).astype(int).tolist()  # no position but a true one
    assert np.allclose(minutes, kept, rtol=0, atol=1e-10)
    assert sorted({*kept} & {*range(6)}) == kept
    assert np.allclose(track.points.lon, LON, rtol=0, atol=1e-12)
    if changed and SENTENCES[which].index("*") > place % len(SENTENCES[which]) > 0:
        assert which not in kept
    assert len(kept) == 6 or track.report.skipped


AIS = "!AIVDM,1,1,,B,177KQJ5000G?tO`K>RA1wUbN0TKH,0*5C"
PUBX = nmea("PUBX,00,104707.00,5405.6081,N,01049.4791,E,40.8,G3,2.1,2.0,0,0,0,1.1,1.2,0.9,8,0,0")
NO_SENTENCE = "line that is no sentence"


def test_a_sentence_is_found_whatever_stands_beside_it(read):
    sentence = gga()
    body, checksum = sentence[1:].split("*")
    for content, left in [
        (f"\\s:station,c:1241544035*4A\\{sentence}", {}),
        (f"${body}*{checksum.lower()}", {}),
        (f"\0\0{sentence}\0", {}),
        (f"{AIS}\r{sentence}\r{PUBX}\r", {NO_SENTENCE: (1, 1), "other sentence": (1, 3)}),
        (f"{AIS}{sentence}{PUBX}\r\n", {"other sentence": (1, 1)}),
        (f"\n\n$GPGGA,1047{sentence}", {"sentence without a checksum": (1, 3)}),
        (f"{sentence[30:]}{sentence}", {}),
        (nmea("GPTXT,01,01,02,Hello!") + sentence, {"other sentence": (1, 1)}),
        (f"# {sentence}\n{sentence}", {"comment": (1, 1)}),
        (f"${body}*\n{sentence}", {"wrong checksum": (1, 1)}),
        (nmea_row("RMC", mode=""), {}),  # as before 2000
        (nmea_row("GLL", mode=""), {}),
    ]:
        for written in (content, content.encode("utf-8-sig"), content.encode("utf-16")):
            track = read(written)
            assert places(track) == (pytest.approx([LAT]), pytest.approx([LON])), content
            assert dict(track.report.skipped) == left, content


KINDS = [*FORMS]
CLAIMS = ("fix", "none", "estimated", "unreadable", "damaged")
MODES = {  # of a claim; 9 is said by some receivers that have the help of satellites
    "GGA": {"none": "0", "estimated": "678", "fix": "123459"},
    **{kind: {"none": "N", "estimated": "EMS", "fix": "ADPRF"} for kind in KINDS[1:]},
}
TALKERS = ["GP", "GN", "GL", "GA", "GB", "BD", "QZ"]
REASONS = {"none": NO_FIX, "estimated": NO_FIX, "unreadable": UNREADABLE}
REASONS |= {"damaged": "wrong checksum"}
HEARD = st.lists(st.tuples(st.sampled_from(KINDS), st.sampled_from(CLAIMS)), max_size=6)
TRUST = {mode: trust for trust, modes in enumerate(["", "1A", "29D", "3P", "5F", "4R"])
         for mode in modes}  # fmt: skip


@given(st.lists(HEARD, min_size=1, max_size=6), st.sampled_from([("N", "E", 1), ("S", "W", -1)]))
def test_every_sentence_is_used_or_counted_with_its_reason(read, epochs, half):
    """Epoch by epoch, against the rule itself: RTK before the kind, which comes before the rest."""
    lines, expected, used, first = [], Counter(), [], {}
    north, east, sign = half
    for second, heard in enumerate([*epochs, [("GGA", "fix")]]):
        fixes, denied = [], []
        for kind, claim in heard:
            modes, k, rank = (
                MODES[kind].get(claim, MODES[kind]["fix"]),
                len(lines),
                KINDS.index(kind),
            )
            mode, minutes = modes[k % len(modes)], f"5.{6081 + k}"
            lat = "5460.0000" if claim == "unreadable" else f"540{minutes}"
            where = {"lat": f"{lat},{north}", "lon": f"01049.4791,{east}"}
            where |= {"mode": mode, "talker": TALKERS[k % 7]}
            line = nmea_row(kind, clock=f"2359{53 + second:02d}.0", **where)
            lines.append(line.replace("01049", "01048") if claim == "damaged" else line)
            if claim == "fix":
                trust = TRUST[mode]
                fixes.append((-max(trust, 3), rank, -trust, k, 54 + float(minutes) / 60))
            else:
                expected[REASONS[claim]] += 1
                first.setdefault(REASONS[claim], len(lines))
                denied += [rank] if claim in ("none", "estimated") else []
        if fixes and min(rank for _, rank, *_ in fixes) <= min(denied, default=9):
            used.append(sign * np.array([min(fixes)[-1], LON]))
            expected["same epoch again"] += len(fixes) - 1
        else:
            reason = "sentence of an epoch that a more trusted one says has no fix"
            expected[reason] += len(fixes)
    track = read("\r\n".join([*lines, ""]))
    assert np.transpose(places(track)) == pytest.approx(np.array(used), abs=1e-12)
    assert {why: count for why, (count, _) in track.report.skipped.items()} == +expected
    assert all(track.report.skipped[why].first == line for why, line in first.items())
    assert len(used) + expected.total() == len(lines)


def says(track, **expected):
    """Each array of what a receiver says: NaN unless it is expected."""
    for field in Reported._fields:
        value = expected.get(field, math.nan)
        np.testing.assert_allclose(getattr(track, field), value, rtol=1e-12, err_msg=field)
        assert not getattr(track, field).flags.writeable
    assert track.rtk.tolist() == np.broadcast_to(expected.get("rtk", ""), len(track)).tolist()


ALL = {"satellites": 8, "hdop": 1.1, "speed": 0.24 * 1852 / 3600, "course": math.radians(18.02)}


@pytest.mark.parametrize("kind", KINDS)
def test_what_a_receiver_says_of_a_fix_is_kept(read, kind):
    modes = dict(zip("123459" if kind == "GGA" else "ADPRFD", (1, 2, 3, 4, 5, 2), strict=True))
    fields = {"GGA": ["satellites", "hdop"], "GNS": ["satellites", "hdop"], "GLL": []}
    expected = {field: ALL[field] for field in fields.get(kind, ["speed", "course"])}
    for mode, quality in modes.items():
        rtk = {4: "fixed", 5: "float"}.get(quality, "none")
        says(read(nmea_row(kind, mode=mode)), quality=quality, rtk=rtk, **expected)
    if kind == "GNS":  # a mode for each constellation
        says(read(nmea_row(kind, mode="ANRD")), quality=4, rtk="fixed", **expected)
    both = [nmea_row("GGA", mode=4), nmea_row(kind, mode="A" if kind != "GGA" else 4)]
    for lines in (both, both[::-1]):  # the most trusted first, in whatever order
        expected |= {"satellites": 8, "hdop": 1.1}
        says(read(lines), quality=4, rtk="fixed", **expected)
    empty = FORMS[kind].replace("{sats},1.1", ",nan").replace("0.24,18.02", "-1,")
    track = read(nmea(empty.format(**{**FIX, "mode": 1 if kind == "GGA" else "A"})))
    says(track, quality=1, rtk="none")


# GPX


NAN = "latitude or longitude not a number"
SCHEMA = "http://www.topografix.com/GPX/"
SPACES = {"gpx": "", "g:gpx": f' xmlns:g="{SCHEMA}1/1"', "gpx ": f' xmlns="{SCHEMA}1/0"'}
FATES = {
    "kept": '<{n}trkpt lat="33.000{k}" lon="-180"/>',
    "timed": '<{n}trkpt lon="180.0" lat="33.000{k}"><{n}ele>x</{n}ele><{n}time>{day}{k}Z </{n}time>'
    "<{n}extensions><{n}time>now</{n}time></{n}extensions></{n}trkpt>",
    "unread": '<{n}trkpt lon="180" lat="33.000{k}"><{n}time>yesterday</{n}time></{n}trkpt>',
    "latitude not in -90 to 90": '<{n}trkpt lat="91.{k}" lon="4"/>',
    "longitude not in -180 to 180": '<{n}trkpt lat="33.000{k}" lon="180.0000001"/>',
    NAN: '<{n}trkpt lat="33.000{k}" lon="{odd}"/>',
    "half": '<{n}trkpt {side}="{k}"></{n}trkpt>',
    "track point outside <trkseg>": '<{n}x><{n}trkpt lat="33.000{k}" lon="4"/></{n}x>',
    "holds": '<{n}trkpt lat="33.000{k}" lon="180"><{n}x><{n}trkpt lat="9" lon="9"/></{n}x>'
    "</{n}trkpt>",
}


@given(
    st.lists(st.lists(st.sampled_from(list(FATES)), max_size=6), max_size=5),
    st.lists(st.sampled_from(["wpt", "rtept"]), max_size=4),
    st.sampled_from(list(SPACES)),
    st.sampled_from(["utf-8", "utf-8-sig", "utf-16", "utf-16-be"]),
    st.sampled_from(["NaN", "abc", "", "inf", "3_3"]),
    st.sampled_from(["lat", "lon"]),
)
def test_every_position_of_gpx_is_kept_or_counted(read, tracks, others, root, code, odd, side):
    n, k, wanted, times = root[: root.index("g", -4)], 10, {}, []
    lines, lats = [f"<{root.strip()}{SPACES[root]}>"], []
    for other in others:  # whose times tell when they were made, not when they were passed
        time = f"<{n}time>2026-03-01T12:00:0{9 - len(lines)}Z</{n}time>"
        place = f'<{n}{other} lat="{len(lines)}" lon="180">{time}</{n}{other}>'
        lines.append(place if other == "wpt" else f"<{n}rte>{place}</{n}rte>")
    for i, fates in enumerate(tracks):  # a segment may be earlier than the one before it
        lines.append(f"<{n}trk><{n}trkseg/><{n}trkseg>")
        for fate in fates:
            day = f"2026-03-0{9 - i}T12:00:"
            lines.append(FATES[fate].format(n=n, k=k, odd=odd, side=side, day=day))
            lats += [float(f"33.000{k}")] * (fate in ("kept", "timed", "unread", "holds"))
            times += [k - 86400 * i] * (fate == "timed")
            if fate not in ("kept", "timed", "unread"):
                why = {"half": NAN, "holds": "track point outside <trkseg>"}.get(fate, fate)
                wanted[why] = wanted.get(why, 0) + 1
            k += 1
        lines.append(f"</{n}trkseg></{n}trk>")
    words = {"trkpt": "track point", "rtept": "route point", "wpt": "waypoint"}
    met = {*others, *(["trkpt"] if any(tracks) else [])}
    used = next((kind for kind in words if kind in met), "")
    if used != "trkpt":
        lats = [place for place, other in enumerate(others, 1) if other == used]
    if lats:
        beside = {other: f"{words[other]} beside the {words[used]}s" for other in met - {used}}
        wanted |= {reason: others.count(other) for other, reason in beside.items()}
    if lats:
        track = read("\n".join([*lines, f"</{root.strip()}>"]).encode(code))
        assert (track.source, track.points.lat.tolist()) == ("GPX", lats)
        assert set(track.points.lon.tolist()) <= {-180.0, 180.0}
        assert track.t[~np.isnan(track.t)].tolist() == [moment - times[0] for moment in times]
        noted = sum(count for count, _ in track.report.noted.values())
        early = int((np.diff(times) < 0).sum())  # segments that begin before the last one's end
        assert noted == early + sum(fates.count("unread") for fates in tracks)
        assert {reason: count for reason, (count, _) in track.report.skipped.items()} == wanted
        assert all("pt" in lines[first - 1] for _, first in track.report.skipped.values())


EXTERNAL = '<!DOCTYPE gpx [<!ENTITY e SYSTEM "file:///etc/passwd">]>'
NO_GPX = [
    (gpx(trk(GOOD) + "<x>&e;</x>", head=EXTERNAL), "document type or an entity"),
    ("<kml><Placemark>", "it is a KML file, not a GPX file; export it as GPX$"),  # cut off
    ("<!DOCTYPE html>\n<html><br></html>", "document type"),
    (gpx("<desc><![CDATA[<html>]]></desc><trk>")[:-9], "its XML is broken"),
    (gzip.compress(gpx(trk(GOOD)).encode()), "it is compressed, a KMZ or a FIT file; unpack it"),
    (b"\x0e\x20\x54\x08\x10\x00\x00\x00.FIT" + bytes(40), "or a FIT file; unpack it, or export"),
    (gpx(""), "it is GPX, but holds no position"),
    (gpx(trk('<trkpt lat="91" lon="0"/>')), r"1 latitude not in -90 to 90 \(first in line 4\)"),
]


# CSV


def test_tables_of_every_kind(read):
    utc = "2026-03-01T12:00:00Z\n33,44.5,2026-03-01T13:00:01.5+01:00"
    for content, lat, lon, t in [
        ("\ufeff# a comment\nlat,lon\n33.25,44.5\n", [33.25], [44.5], [math.nan]),
        (" LAT , lng\n33.25,44.5\n", [33.25], [44.5], [math.nan]),
        ("n|lat|lon\n7|33.25|44.5\n", [33.25], [44.5], [math.nan]),
        (f"lat,lon,time\n33,44.5,{utc}\n", [33, 33], [44.5] * 2, [0, 1.5]),
        (f"lat,lon,datetime\n33,44.5,{utc.replace('T', ' ')}\n", [33] * 2, [44.5] * 2, [0, 1.5]),
        ("lat;lon;t\n33,5;44,25;0,5\n-1,5;2;1,75\n", [33.5, -1.5], [44.25, 2], [0, 1.25]),
        ('lat,lon,t\n"33,5","44,25",0\n-1.5,2,1.25\n', [33.5, -1.5], [44.25, 2], [0, 1.25]),
        ("lat,lon,t\n1,2,2026-03-01 12:00\n1,3,2026-03-01T12:00:01Z\n", [1, 1], [2, 3], [0, 1]),
    ]:
        track = read(content)
        assert (track.source, *places(track)) == ("CSV", lat, lon), content
        np.testing.assert_array_equal(track.t, t)


LOGGER = "INDEX,DATE,TIME,LATITUDE,N/S,LONGITUDE,E/W,{},NSAT\n"
ROW = "{},{},{},{},{},{},{},{},9\n"
FIX_COLUMNS = {  # the cells that say a measured fix, and those that don't
    "VALID": (["SPS", "DGPS", "fixed", "1", ""], ["No fix", "0", "Estimated mode", "?x"]),
    "fix quality": (["1", "4", "9"], ["0", "6", "7", "8"]),
}


@pytest.mark.parametrize("name", FIX_COLUMNS)
def test_tables_of_data_loggers(read, name):
    """Hemispheres, dates and fixes in columns of their own."""
    good, bad = FIX_COLUMNS[name]
    first = ROW.format(1, "2013/05/12", "23:59:59.500", 1, "N", 2, "W", good[0])
    for fix in good:
        row = ROW.format(2, "2013-05-13", "000001.25", 33.8568, "South", 151.2153, "e", fix)
        track = read(LOGGER.format(name) + first + row)
        assert (places(track), track.t.tolist()) == (([1, -33.8568], [-2, 151.2153]), [0, 1.75])
    for fix in bad:
        track = read(LOGGER.format(name) + first + row.replace(f",{good[-1]},9", f",{fix},9"))
        assert dict(track.report.skipped) == {"row without a measured fix": (1, 3)}, fix
    for side in ("", "W", "X", "+"):
        track = read(LOGGER.format(name) + first + row.replace("South", side))
        assert dict(track.report.skipped) == {"row without a readable hemisphere": (1, 3)}


FORM, LINES = "row with more or fewer cells than the header", "row with a cell over several lines"
ODD = {
    "comment": ["# 1,2,3,N"],
    "latitude not in -90 to 90": ["91,2,3,N"],
    "longitude not in -180 to 180": ["1,200,3,N"],
    NAN: [f"1,{text},3,N" for text in ("nan", "inf", "1_0", "", '"1,2,3"', '"1,234.5"', '","')],
    FORM: ["1,2,3", "1,2,3,4,N"],  # decimal commas
    LINES: ['1,2,"3\n",N', '"1\r\n2",3,4,N'],
    "sign and hemisphere that contradict each other": ["-1,2,3,N", "+1,2,3,S", "-1S,2,3,N"],
    "used": ["1,2,0,N", "1.5,-2,0.5,S", "3,4,2026-03-01T12:00:00Z,N", '"1,5",2,3,N', "1,2,3,n"],
    "used, without a time": ["1,2,x,S", "-1,2,,S"],
    "empty": ["", ",,,"],
}
ROWS = st.sampled_from([(row, fate) for fate, rows in ODD.items() for row in rows])


@given(st.lists(ROWS, max_size=12))
def test_every_row_is_kept_or_counted_with_its_line(read, rows):
    lines = ["lat,lon,t,N/S", *(row for row, _ in rows), "5,6,7e9,N", ""]
    report = read(lines).report
    fates = Counter(fate for _, fate in rows)
    counts = {reason: count for reason, (count, _) in report.skipped.items()}
    late = sum(counts.pop(why, 0) for why in ("time runs backwards", "same time again"))
    assert counts == {
        fate: n for fate, n in fates.items() if "used" not in fate and fate != "empty"
    }
    assert report.used + late == 1 + fates["used"] + fates["used, without a time"]
    ends = {1 + "\n".join(lines[:k]).count("\n") for k in range(1, len(lines))}
    assert {first for _, first in report.skipped.values()} <= ends


def test_what_a_phone_or_a_table_says_of_a_fix_is_kept(read):
    inner = "<{0}sat>7</{0}sat><{0}hdop>0.9</{0}hdop><x><{0}speed>1.5</{0}speed></x>"
    point = '<trkpt lat="1" lon="2">{}<course>90</course><fix>{}</fix></trkpt>'
    whole = {"satellites": 7, "hdop": 0.9, "speed": 1.5, "course": math.pi / 2, "rtk": "none"}
    for fix, quality in {"2d": 1, "3d": 1, "dgps": 2, "pps": 3}.items():
        says(read(gpx(trk(point.format(inner.format(""), fix)))), quality=quality, **whole)
    two = trk(point.format(inner.format("g:"), "dgps"), '<trkpt lat="1" lon="3"/>')
    track = read(gpx(two, root=f'gpx version="1.1" xmlns:g="{GPX_11[1:-1]}"'))
    says(track, **{name: [value, math.nan] for name, value in {**whole, "quality": 2}.items()
                   if name != "rtk"}, rtk=["none", ""])  # fmt: skip
    speeds = {"speed (m/s)": 1.5, "Ground speed [km/h]": 5.4, "speed_kn": 1.5 * 3600 / 1852}
    speeds |= {"SOG knots": 1.5 * 3600 / 1852, "speed_mph": 1.5 / 0.44704, "speed_mps": 1.5}
    for name, speed in speeds.items():
        text = f"lat;lon;{name};course;NSAT;hdop;quality\n1;2;{speed!r};90,0;7;0,9;2\n"
        says(read(text), quality=2, **whole)
    words = {"SPS": 1, "gps": 1, "DGPS": 2, "pps": 3, "RTK": 4, "RTK float": 5, "FRTK": 5, "9": 2}
    words |= {"Fixed RTK": 4, "Float-RTK": 5}
    for word, quality in words.items():
        rtk = {4: "fixed", 5: "float"}.get(quality, "none")
        says(read(f"lat,lon,fix quality\n1,2,{word}\n"), quality=quality, rtk=rtk)
    for header, row in {  # neither of these names a unit, or a quality
        "speed": "3", "heading": "3", "fix": "fixed", "valid": "1", "status": "4", "hdop": "-1"
    }.items():  # fmt: skip
        says(read(f"lat,lon,{header}\n1,2,{row}\n"))


def test_columns_are_known_by_many_names_and_units(read):
    for north, east in [("NS Indicator", "EW Indicator"), ("LatDir", "LonDir")]:
        track = read(f"Latitude,{north},Longitude,{east}\n33.5,S,70.6,W\n1.0,N,2.0,E\n")
        assert places(track) == ([-33.5, 1.0], [-70.6, 2.0]), north
    for name, units in (("time_us", 1e6), ("gps time s", 1.0), ("timeMs", 1e3), ("t [s]", 1.0)):
        track = read(f"{name},lat (deg),lon_deg\n{units:.0f},33.5,44\n{4 * units:.0f},33.5,44\n")
        assert track.t.tolist() == [0.0, 3.0], name
    for header in ("latitudeE7,longitudeE7", "lat_e7,lon_e7"):
        assert places(read(f"{header}\n335000000,442500000\n")) == ([33.5], [44.25])
    for header in ("lat (rad),lon (rad)", "position_lat,position_long"):
        with pytest.raises(ValueError, match="none of its first ten lines names"):
            read(f"{header}\n1,2\n")


def test_what_would_have_to_be_guessed_is_not_read(read):
    """Degrees beside a column of minutes, dates in any other order, numbers without a unit."""
    for name in ("lat_min", "latMinutes", "Long. seconds"):
        with pytest.raises(ValueError, match="minutes of a degree, which is not read"):
            read(f"lat_deg,{name},lon_deg\n33,16.2,44\n")
    for day in ("09.05.2026", "05/09/2026", "260509"):
        track = read(f"date,time,lat,lon\n{day},12:00:00,1,2\n")
        assert places(track) == ([1.0], [2.0])
        assert dict(track.report.noted) == {"with an unreadable time in column 'time'": (1, 2)}
        assert np.isnan(track.t).all()
    for number in ("45292.5", "12345", "1767225600", "-5"):  # of Excel, since switched on
        noted = dict(read(f"time,lat,lon\n{number},1,2\n").report.noted)
        assert noted == {
            "with a number in column 'time', which would have to be t or time_ms": (1, 2)
        }


def test_what_windows_and_spreadsheets_write_around_a_table_is_read(read):
    row = "33,5\N{DEGREE SIGN}S;44,25\N{DEGREE SIGN}E\r\n\u22121,5;2\r\n"
    for head, titles in (("", 0), ("sep=;\r\n", 1), ("My drive; 2026\r\n\r\nby me\r\n", 2)):
        for code in ("utf-8", "utf-8-sig", "utf-16"):
            track = read(f"{head}lat;lon\r\n{row}".encode(code))
            assert places(track) == ([-33.5, -1.5], [44.25, 2.0])
            above = {"line above the names of the columns": (titles, 1)} if titles else {}
            assert dict(track.report.skipped) == above
    assert places(read(f"lat;lon\n{row[:15]}\n".encode("latin-1"))) == ([-33.5], [44.25])
    with pytest.raises(ValueError, match=r"none of its first ten lines names .* 'one'$"):
        read("one\n" * 10 + "lat,lon\n1,2\n")


# Whatever a file holds

NO_KIND = "it is neither NMEA, UBX, GPX, GeoJSON nor gpsd, and as a table none"


def test_a_file_without_a_position_says_why(read, tmp_path):
    for content, message in [
        *NO_GPX,
        ("", "it is empty$"),
        ("\n", f"{NO_KIND}.* longitude$"),
        ("x,y\n1,2\n", f"{NO_KIND}.* names lat and lon, or .*; the first is 'x,y'$"),
        ("lat,lon\n", "it is CSV, but holds no position"),
        ("lat,lon\n-95,2", r"1 latitude not in -90 to 90 \(first in line 2\)$"),
    ]:
        with pytest.raises(ValueError, match=message) as error:
            read(content)
        assert "file.txt" in str(error.value)
    with pytest.raises(FileNotFoundError):
        wmr.read_track(tmp_path / "none.gpx")
    with pytest.raises(OSError, match=re.escape(str(tmp_path))):
        wmr.read_track(tmp_path)


# And back


@given(
    st.floats(-89.9, 89.9),
    st.sampled_from([0.0, 44.37, 179.9999, -179.9999, 180.0, -180.0]),
    st.integers(1, 12),
    st.integers(0, 2**32),
)
def test_a_path_comes_back(tmp_path_factory, lat, lon, n, seed):
    """Within half of the last of seven decimals; nothing is added and nothing is lost."""
    rng = np.random.default_rng(seed)
    there = wmr.point_at(wmr.GeoPoint(lat=lat, lon=lon), rng.normal(0, 30, n), rng.normal(0, 30, n))
    file = tmp_path_factory.getbasetemp() / "path"
    wmr.write_gpx(file, there)
    points = wmr.read_track(file).points
    assert points.lat.size == n
    assert np.abs(points.lat - there.lat).max() <= 0.5001e-7
    assert np.abs((points.lon - there.lon + 180) % 360 - 180).max() <= 0.5001e-7


GPX_FILE = """<?xml version="1.0" encoding="UTF-8"?>
<gpx xmlns="http://www.topografix.com/GPX/1/1" version="1.1" creator="wmrlib">
<trk><name>&lt;b&gt; &amp; "c" 'd' ]]&gt; é بغداد</name><trkseg>
<trkpt lat="0.0000000" lon="179.9999999"><time>2026-03-01T12:00:00Z</time></trkpt>
<trkpt lat="0.0000001" lon="-180.0000000"><time>2026-03-01T12:00:00.250000Z</time></trkpt>
<trkpt lat="-0.0000001" lon="-180.0000000"></trkpt>
<trkpt lat="5.0000000" lon="-0.0000001"><time>2026-03-01T12:00:02Z</time></trkpt>
</trkseg></trk></gpx>
"""


def test_gpx_1_1_as_its_schema_asks(tmp_path):
    """Names, order, attributes and ranges of http://www.topografix.com/GPX/1/1/gpx.xsd."""
    points = wmr.GeoPoint(lat=[0.0, 1e-7, -1e-7, 5.0], lon=[179.9999999, 180.0, -180.0, -1e-7])
    title, file = "<b> & \"c\" 'd' ]]> é بغداد", tmp_path / "a.gpx"
    begin, t = BEGIN.astimezone(timezone(timedelta(hours=5, minutes=30))), [0, 0.25, math.nan, 2]
    wmr.write_gpx(file, points, t=t, begin=begin, name=title)
    assert file.read_text(encoding="utf-8") == GPX_FILE
    assert ElementTree.parse(file).findtext(f"*/{GPX_11}name") == title
    np.testing.assert_array_equal(wmr.read_track(file).t, t)
    wmr.write_gpx(file, wmr.GeoPoint(lat=1.0, lon=2.0), t=0.5, begin=BEGIN)
    assert "<time>2026-03-01T12:00:00.500000Z</time>" in file.read_text()


def test_geojson_is_longitude_first_and_goes_on_across_the_date_line(tmp_path):
    file = tmp_path / "a.json"
    for lat, lon, kind, coordinates in [
        ([10.0, 11.0], [179.0, -179.5], "LineString", [[179.0, 10.0], [180.5, 11.0]]),
        (33.5, 44.25, "Point", [44.25, 33.5]),
    ]:
        wmr.write_geojson(file, wmr.GeoPoint(lat=lat, lon=lon), name='"q"')
        feature = json.loads(file.read_text(encoding="utf-8"))
        assert (feature["type"], feature["properties"]) == ("Feature", {"name": '"q"'})
        assert feature["geometry"] == {"type": kind, "coordinates": coordinates}
    for write in (wmr.write_gpx, wmr.write_geojson):
        write(file, wmr.GeoPoint(lat=[-1e-9, 1.0], lon=[-1e-9, 1.0]))
        assert "-0" not in file.read_text()


PAIR = wmr.GeoPoint(lat=[1.0, 2.0], lon=[3.0, 4.0])


def test_bad_input_to_the_writers(tmp_path):
    cases = [
        (wmr.write_gpx, PAIR, {"t": t, "begin": begin}, message)
        for t, begin, message in [
            ([0, 1], None, "begin = None are not allowed together"),
            (None, BEGIN, "t = None and begin = .* are not allowed together"),
            ([0, 1, 2], BEGIN, r"t has shape \(3,\), points have shape \(2,\)"),
            ([0, math.inf], BEGIN, "a finite number or NaN is needed"),
            ([0, 1e18], BEGIN, r"^t = .*e\+18.* is not allowed: begin \+ t in the years"),
            ([0, 1], BEGIN.replace(tzinfo=None), "begin with its time zone"),
        ]
    ]
    for write in (wmr.write_gpx, wmr.write_geojson):
        cases += [
            (write, wmr.GeoPoint(lat=[], lon=[]), {}, "at least one position is needed"),
            (write, [1, 2], {}, "a GeoPoint is needed"),
            (write, PAIR, {"name": "\ud800"}, r"^name = '\\ud800' is not allowed: printable"),
            (write, PAIR, {"name": "a\x00b"}, r"^name = 'a\\x00b' is not allowed: printable"),
            (write, PAIR, {"name": 3}, "a str is needed"),
        ]
    for write, points, options, message in cases:
        with pytest.raises(ValueError, match=message):
            write(tmp_path / "new", points, **options)
    for write in (wmr.write_gpx, wmr.write_geojson):
        place = tmp_path / "no folder" / "new.gpx"
        with pytest.raises(FileNotFoundError, match=re.escape(repr(str(place))) + "$"):
            write(place, PAIR)
    assert not [*tmp_path.iterdir()]
