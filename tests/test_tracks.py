"""Positions in files, against the sentences themselves, the ellipsoid and by property."""

import copy
import gzip
import json
import math
import os
import pickle
import random
import re
import subprocess
import sys
import tracemalloc
from collections import Counter
from datetime import UTC, datetime, timedelta, tzinfo
from functools import reduce
from operator import xor
from pathlib import Path
from time import process_time
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

import wmrlib as wmr
from wmrlib.tracks import Count, Report
from wmrlib.tracks.fixes import Fixes, timestamp

LOG = Path(__file__).parent.parent / "notebooks" / "data" / "ublox5-standing.nmea"
GPX_11 = "{http://www.topografix.com/GPX/1/1}"
BEGIN = datetime(2026, 3, 1, 12, 0, 0, tzinfo=UTC)


@pytest.fixture
def read(tmp_path):
    """Read what a file would hold; a list is lines."""

    def of(content):
        if isinstance(content, list):
            content = "\n".join(content)
        path = tmp_path / "file.txt"
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return wmr.read_track(path)

    return of


def places(track):
    return track.points.lat.tolist(), track.points.lon.tolist()


def nmea(body):
    return f"${body}*{reduce(xor, body.encode('latin-1')):02X}"


def gga(clock="104706.00", lat="5405.6081,N", lon="01049.4791,E", quality=1, talker="GP"):
    return nmea(f"{talker}GGA,{clock},{lat},{lon},{quality},08,1.1,40.8,M,43.6,M,,0000")


def rmc(
    clock="104706.00", lat="5405.6081,N", lon="01049.4791,E", status="A", mode="A", day="240709"
):
    return nmea(f"GPRMC,{clock},{status},{lat},{lon},0.24,18.02,{day},,,{mode}")


def gpx(inner, head='<?xml version="1.0"?>', root=f'gpx version="1.1" xmlns="{GPX_11[1:-1]}"'):
    return f"{head}\n<{root}>\n{inner}\n</{root.split()[0]}>"


def trk(*points):
    return "<trk><trkseg>\n" + "\n".join(points) + "\n</trkseg></trk>"


GOOD = '<trkpt lat="33.27" lon="44.37"/>'
LAT, LON = 54 + 5.6081 / 60, 10 + 49.4791 / 60  # of gga() and rmc()

# What all files share


def in_order(times):
    """How long the longest run in order is, by trying all."""
    best = []
    for i, time in enumerate(times):
        best.append(1 + max((best[j] for j in range(i) if times[j] <= time), default=0))
    return max(best, default=0)


seconds = st.lists(
    st.none() | st.integers(0, 20), unique_by=lambda s: object() if s is None else s, max_size=12
)


def settled(*segments):
    fixes, line = Fixes(), 0
    for segment in segments:
        fixes.begin_segment()
        for second in segment:
            fixes.add(line % 90, len(segment), math.nan if second is None else second, line)
            line += 1
    return fixes.settle()


@given(st.integers(2, 9), st.integers(1, 3), st.integers(1, 8), st.sampled_from([-5.0, 99.0]))
def test_a_wrong_time_costs_itself_however_often_it_stands_there(count, often, place, wrong):
    times, place = [*range(count)], min(place, count - 1)
    assert settled(times[:place] + often * [wrong] + times[place:])[0][2].tolist() == times


@given(st.lists(seconds, max_size=4))
@example([[5, 7, 6], [1, 9, 2, 3]])  # 1 or 9: as long a run goes on from either
def test_a_time_out_of_order_costs_its_own_position_only(segments):
    (lat, _, time), report = settled(*segments)
    alone = [settled(segment)[0][2] for segment in segments]
    np.testing.assert_array_equal(time, np.concatenate([[], *alone]))
    line = sum(map(len, segments))
    kept = [[s for s in segment if s is not None] for segment in segments]
    untimed = sum(len(segment) for segment in segments) - sum(map(len, kept))
    assert report.used == lat.size == untimed + sum(map(in_order, kept))
    assert sum(count for count, _ in report.skipped.values()) == line - lat.size
    rows = iter(zip(lat.astype(int).tolist(), time.tolist(), strict=True))
    used, first_lost = dict(rows), []
    line = 0
    for segment in segments:
        numbers = range(line, line + len(segment))
        stays = [used[k] for k in numbers if not math.isnan(used.get(k, math.nan))]
        assert stays == sorted(stays)
        first_lost += [k for k in numbers if k not in used]
        line += len(segment)
    if first_lost:
        assert report.skipped["time runs backwards"].first == first_lost[0]


def test_a_report_tells_the_first_line_however_late_it_is_found():
    fixes = Fixes()
    for line in (3, 5, 8):
        fixes.add(1.0, 2.0, 0.0, line)
    fixes.skip("same epoch again", 7, 2)
    assert dict(fixes.settle()[1].skipped) == {"same epoch again": (4, 5)}


def test_of_two_runs_as_long_the_nearest_times_stay():
    for times, kept in [
        ([5, 3], [5]),
        ([1, 9, 2, 3], [1, 2, 3]),
        ([1, 2, 9, 3], [1, 2, 3]),
        ([4, 1, 5], [4, 5]),
    ]:
        assert settled(times)[0][2].tolist() == kept


TIMES = {
    "2016-12-31T23:59:59Z": 1483228799,
    "2016-12-31T23:59:60Z": 1483228800,
    "2016-12-31T23:59:60.5Z": 1483228800.5,
    "2017-01-01T05:29:60+05:30": 1483228800,
    "2016-12-31T24:00:00Z": 1483228800,
    "2016-12-31T24:00": 1483228800,
    "2016-12-31T24:00:00.000+01:00": 1483225200,
    "2017-01-01T00:00:00": 1483228800,
    "2017-01-01T00:00:00.1234567Z": 1483228800.123456,
    "2017-01-01T01:00:00,5+01:00": 1483228800.5,
    "2016-12-31T24:00:01Z": None,
    "2016-12-31T24:30:00Z": None,
    "2016-12-31T23:60:00Z": None,
    "2016-12-31T23:59:61Z": None,
    "2016-12-32T24:00:00Z": None,
    "24:00:00": None,
}


def test_times_as_iso_8601_has_them():
    for text, seconds in TIMES.items():
        assert timestamp(text) == seconds, text


def test_a_copy_of_a_track_holds_the_same_and_is_read_only(read):
    track = read(gpx(trk(GOOD, '<trkpt lat="91" lon="0"/>', '<trkpt lat="34" lon="45"/>')))
    copies = copy.copy(track), copy.deepcopy(track), pickle.loads(pickle.dumps(track))
    for same in (track, *copies):
        assert (places(same), same.t.tobytes()) == (places(track), track.t.tobytes())
        assert (same.source, same.report, repr(same)) == (track.source, track.report, repr(track))
        for values in (same.points.lat, same.points.lon, same.t):
            with pytest.raises(ValueError, match="read-only"):
                values[0] = 0.0
        with pytest.raises(TypeError):
            same.report.skipped["comment"] = Count(0, 0)


# NMEA


def test_the_real_log(read):
    track = wmr.read_track(LOG)
    assert (track.source, track.t.tolist()) == ("NMEA", list(range(9)))
    assert track.points.lat[0] == pytest.approx(LAT, abs=1e-12)
    assert track.points.lon[-1] == pytest.approx(10 + 49.4885 / 60, abs=1e-12)
    lines = LOG.read_text(encoding="utf-8").splitlines()
    first_rmc = 1 + next(i for i, line in enumerate(lines) if "RMC" in line)
    counts = dict(track.report.skipped)
    assert counts.pop("comment") == (sum(line.startswith("#") for line in lines), 1)
    assert counts.pop("same epoch again") == (18, first_rmc)  # RMC and GLL
    assert counts.pop("other sentence").count == sum(line.startswith("$") for line in lines) - 27
    assert not counts
    assert not track.report.noted
    assert repr(track) == "<Track: 9 positions from NMEA, over 8 s; 77 not used>"
    assert repr(Report(1, {})) == "1 position used"
    # RMC alone tells the same
    assert places(read([line for line in lines if "GGA" not in line])) == places(track)


def test_talkers_hemispheres_and_epochs(read):
    for talker in ("GP", "GN", "GL", "GA", "GB", "BD", "QZ"):
        assert len(read(gga(talker=talker))) == 1
    for quality in (1, 2, 3, 4, 5, 9):  # 9: by some receivers with the help of satellites
        assert len(read(gga(quality=quality))) == 1
    track = read([gga(talker="GN"), rmc(), gga(talker="GL", lat="5405.7000,N"), gga("104707.00")])
    assert track.points.lat.tolist() == pytest.approx([LAT] * 2)
    assert dict(track.report.skipped) == {"same epoch again": (2, 2)}
    south_west = places(read(gga(lat="3351.5000,S", lon="15112.3000,W")))
    assert south_west == (pytest.approx([-(33 + 51.5 / 60)]), pytest.approx([-(151 + 12.3 / 60)]))
    assert len(read(b"\x00\x00" + gga().encode())) == 1  # a receiver's zero bytes before the first
    # makers' own sentences, cut short
    bodies = ("PUBX,00", "PGRME", "PASHR,", "GPXXX,1", "PSRF", "PUBX,03,1", "PTNL,PJK", "CCGPQ,GGA")
    assert len(read([gga(), *map(nmea, bodies)])) == 1


def log(words):
    """G080000 is a GGA, N080000 one without a fix, R080000/290224 an RMC with its date."""
    lines = []
    for word in words.split():
        kind, (clock, _, day) = word[0], word[1:].partition("/")
        if kind == "R":
            lines.append(rmc(clock, day=day))
        else:
            lines.append(gga(clock, quality=int(kind == "G")))
    return lines


NIGHT = " ".join(f"N{hour % 24:02d}0000" for hour in range(20, 32))  # goes by the receiver's clock
COLD = " ".join(f"N0000{second:02d}" for second in range(30))  # may count from midnight
CLOCKS = {
    "G235959.00 G000000.50 G000001.00": [0, 1.5, 2],
    f"G190000 {NIGHT} G080000 G080001": [0, 13 * 3600, 13 * 3600 + 1],
    "R080000/290224 R090000/010324": [0, 90000],
    "R100000/290224 R080000/010324 R080001/010324": [0, 79200, 79201],
    "R080000/240709 R080001/240709 R210000/240709 R210001/240709": [0, 1, 46800, 46801],
    "R080000/311223 R080000/010124": [0, 86400],
    "R235959/311299 R000000/010100 R000001/010100": [0, 1, 2],
    "G080000 R080000/290224 G070000 R070000/020324 G070001": [0, 169200, 169201],
    "R080000/290224 G080000 R070000/020324 G070000 G070000.5": [0, 169200, 169200.5],
    # a GGA between two RMC is of the nearer one's day
    "R080000/290224 G080000.5 G070000.5 R070001/020324": [0, 0.5, 169200.5, 169201],
    "G235959 R000000/010324 G000001": [0, 1, 2],
    "R235959/ R000001/990099": [0, 2],
    **{f"G{h:02d}0000 {COLD} G{h:02d}0500 G{h:02d}0501": [0, 300, 301] for h in range(24)},
}


def test_time_goes_on_from_day_to_day(read):
    for words, times in CLOCKS.items():
        assert read(log(words)).t.tolist() == times, words
    for words in ("R080000/240709 R090000/230709", "R080000/240709 R090000/240708"):
        backwards = read(log(words)).report.skipped
        assert dict(backwards) == {"time runs backwards": (1, 2)}
    day = " ".join(f"R08000{k}/240709" for k in range(9))
    for count, longer in ((4, [*range(9)]), (6, [k / 2 for k in range(12)])):
        # of a log that was appended, all is of the day before, and the shorter of the two is left
        before = (f"R09000{k}/230709 G09000{k}.5" for k in range(count))
        assert read(log(f"{day} {' '.join(before)}")).t.tolist() == longer
    no_fix = rmc("080001", day="060180", status="V")  # its date does not count
    sentences = [rmc("080000", day="290224"), no_fix, rmc("080002", day="290224")]
    assert read(sentences).t.tolist() == [0, 2]


@given(
    kinds=st.text("GR", min_size=9, max_size=30),
    wrong=st.integers(1, 28),
    day=st.sampled_from(["010180", "230709", "250709", "010199", "010149"]),
)
def test_a_wrong_date_costs_its_own_epoch_only(tmp_path_factory, kinds, wrong, day):
    words = [f"{kind}0800{second:02d}" for second, kind in enumerate(f"R{kinds}R")]
    words = [word + "/240709" * (word[0] == "R") for word in words]
    path, wrong = tmp_path_factory.mktemp("log") / "log.nmea", 1 + wrong % len(kinds)
    path.write_text("\n".join(log(" ".join(words))))
    assert wmr.read_track(path).t.tolist() == [*range(len(words))]
    words[wrong] = f"R0800{wrong:02d}/{day}"
    path.write_text("\n".join(log(" ".join(words))))
    track = wmr.read_track(path)
    assert track.t.tolist() == [second for second in range(len(words)) if second != wrong]
    assert dict(track.report.skipped) == {"time runs backwards": (1, 1 + wrong)}


NO_FIX, ESTIMATED = "sentence without a fix", "position estimated, put in by hand or simulated"
UNREADABLE = "unreadable position"
BAD_SENTENCES = {
    "wrong checksum": [gga().replace("*", "0*")],
    "sentence without a checksum": [gga()[:-3]],
    NO_FIX: [
        *(gga(quality=0), gga(quality=10), rmc(status="V"), rmc(mode="N")),
        rmc(status="", mode=""),
    ],
    ESTIMATED: [*(gga(quality=k) for k in (6, 8)), *(rmc(mode=mode) for mode in "EMS")],
    UNREADABLE: [  # not zero, nor 55 degrees
        *(gga(lat=lat) for lat in ("5460.0000,N", "0,N", "5405.6081,", "5405.6081,X")),
        *(gga(lat=",N", lon=",E"), gga(lat="5405,N", lon="01049,E")),
    ],
    "latitude not in -90 to 90": [gga(lat="9005.6081,N")],
    "longitude not in -180 to 180": [gga(lon="18049.4791,E")],
    "fix without a readable time": [gga("")],
    "other sentence": [nmea("GPVTG,18.02,T,,M,0.24,N,0.4,K,A")],
    "line that is no sentence": ["5405.6081,N,01049.4791,E"],
    "comment": ["# 54.09, 10.82"],
}


@pytest.mark.parametrize("reason", BAD_SENTENCES)
def test_a_sentence_that_gives_no_position_is_counted(read, reason):
    for bad in BAD_SENTENCES[reason]:
        track = read("\r\n".join([gga("104705.00"), bad, bad, ""]))
        assert places(track) == (pytest.approx([LAT]), pytest.approx([LON])), bad
        assert dict(track.report.skipped) == {reason: Count(2, 2)}
        assert f"not used: 2 {reason} (first in line 2)" in repr(track.report)
        if reason in (NO_FIX, ESTIMATED, UNREADABLE):
            with pytest.raises(ValueError, match=f"it is NMEA, but 1 {reason}"):
                read(bad)


SENTENCES = [
    gga(f"1047{k:02d}.00", lat=f"54{k:02d}.6081,N", talker=("GP", "GN", "GL")[k % 3])
    for k in range(6)
]


@given(st.integers(0, 5), st.integers(0, 200), st.integers(0, 255))
def test_a_corrupted_byte_is_never_used_silently(tmp_path_factory, which, place, byte):
    """Whatever one byte becomes, only true positions come out, and what is lost is counted."""
    truth = [54 + (k + 0.6081) / 60 for k in range(6)]
    data = bytearray("\r\n".join([*SENTENCES, ""]).encode())
    begin = sum(len(sentence) + 2 for sentence in SENTENCES[:which])
    at = begin + place % len(SENTENCES[which])
    changed = data[at] != byte
    data[at] = byte
    path = tmp_path_factory.getbasetemp() / "corrupted.nmea"
    path.write_bytes(data)
    track = wmr.read_track(path)
    kept = [k for k in range(6) if np.isclose(track.points.lat, truth[k], rtol=0, atol=1e-12).any()]
    assert len(kept) == len(track)  # no position but a true one
    assert np.allclose(track.points.lon, LON, rtol=0, atol=1e-12)
    if changed and SENTENCES[which].index("*") > at - begin > 0:
        assert which not in kept
    if len(kept) < 6:
        assert track.report.skipped


def gns(clock="104706.00", lat="5405.6081,N", lon="01049.4791,E", mode="AN", sats="08"):
    return nmea(f"GNGNS,{clock},{lat},{lon},{mode},{sats},1.1,40.8,43.6,,")


def gll(clock="104706.00", lat="5405.6081,N", lon="01049.4791,E", status="A", mode="A"):
    return nmea(f"GPGLL,{lat},{lon},{clock},{status},{mode}")


AIS = "!AIVDM,1,1,,B,177KQJ5000G?tO`K>RA1wUbN0TKH,0*5C"
PUBX = nmea("PUBX,00,104707.00,5405.6081,N,01049.4791,E,40.8,G3,2.1,2.0,0,0,0,1.1,1.2,0.9,8,0,0")


@pytest.mark.parametrize("sentence", [gga(), gns(), rmc(), gll()])
def test_a_sentence_is_found_whatever_stands_beside_it(read, sentence):
    body, checksum = sentence[1:].split("*")
    for content, left in [
        ("$" + sentence, {}),
        ("\\s:station$1,c:1241544035*4A\\".replace("$1", "") + sentence, {}),
        (f"2026-03-01 10:47:06.2 {sentence} ok", {}),
        (f"${body}*{checksum.lower()}", {}),
        (f"\0\0{sentence}\0", {}),
        (f"{AIS}\r{sentence}\r{PUBX}\r", {"other sentence": (2, 1)}),
        (f"{AIS}\r\n{AIS}{sentence}{PUBX}\r\n", {"other sentence": (3, 1)}),
        (f"\\s:x*00\\{AIS}\n{sentence}", {"other sentence": (1, 1)}),
        (f"\n\n$GPGGA,1047{sentence}", {"sentence without a checksum": (1, 3)}),
        (f"{sentence[30:]}{sentence}", {"unreadable sentence": (1, 1)}),
        (f"{sentence[30:]}\n{sentence}", {"line that is no sentence": (1, 1)}),
        (
            f"{sentence[30:]}{AIS[:-1]}{sentence}{PUBX}",
            {"unreadable sentence": (1, 1), "other sentence": (1, 1)},
        ),
        (nmea("GPTXT,01,01,02,Hello!") + sentence, {"other sentence": (1, 1)}),
        (f"# {sentence}\n{sentence}", {"comment": (1, 1)}),
        (f"{sentence[:-1]}\n{sentence}", {"wrong checksum": (1, 1)}),
        (f"${body}*\n{sentence}", {"wrong checksum": (1, 1)}),
        (f"$GP\n{sentence}", {"line that is no sentence": (1, 1)}),
    ]:
        for written in (content, content.encode("utf-16")):
            track = read(written)
            assert places(track) == (pytest.approx([LAT]), pytest.approx([LON])), content
            assert dict(track.report.skipped) == left, content


def test_the_most_trusted_sentence_of_an_epoch_decides(read):
    denied = "sentence of an epoch that a more trusted one says has no fix"
    kinds = [
        (gga(lat="5400.0000,N"), gga(quality=0)),
        (gns(lat="5401.0000,N"), gns(mode="NN")),
        (rmc(lat="5402.0000,N"), rmc(status="V")),
        (gll(lat="5403.0000,N"), gll(status="V")),
    ]
    for best, (good, none) in enumerate(kinds):
        worse = [fix for fix, _ in kinds[best:]]
        for order in (worse, worse[::-1]):
            track = read(order)
            assert track.points.lat.tolist() == pytest.approx([54 + best / 60])
            again = {"same epoch again": (3 - best, 1 if best < 3 and order[0] != good else 2)}
            assert dict(track.report.skipped) == (again if best < 3 else {})
            without = [none if each == good else each for each in order]
            if best < 3:
                first = 1 if without[0] != none else 2
                told = rf"{3 - best} {denied} \(first in line {first}\)"
                with pytest.raises(ValueError, match=told):
                    read(without)
        others = [fix for fix, _ in kinds[:best]]
        assert len(read([none, *others, gga("104707.00")])) == 2 - (best == 0)
    # no satellites: of two it is the other, and alone it is told
    track = read([gga().replace(",08,", ",00,"), gga()])
    assert dict(track.report.skipped) == {"wrong checksum": (1, 1)}
    satless = nmea(gga()[1:-3].replace(",08,", ",00,"))
    track = read([gga("104705.00"), satless, rmc(lat="5402.0000,N")])
    assert track.points.lat.tolist() == pytest.approx([LAT] * 2)
    assert dict(track.report.noted) == {"by a sentence that counts 0 satellites": (1, 2)}
    assert not read([satless, gga()]).report.noted
    # a position that is out of range denies nothing
    track = read([gga(lat="9005.6081,N"), rmc()])
    assert dict(track.report.skipped) == {"latitude not in -90 to 90": (1, 1)}
    # a fix that is said to be missing too early is none the less in its place
    track = read([gga("104706.00"), gga("104709.00", quality=0), *map(gga, ("104708", "104709"))])
    assert track.t.tolist() == [0, 2, 3]
    track = read([rmc("104706"), rmc("104707"), gga("104706"), gga("104707")])
    assert track.t.tolist() == [0, 1]
    # sentences that come late belong to their epoch
    late = [gga("235959.00"), gga("000000.00"), rmc("235959.00", day="310126"), gll("000000.00")]
    track = read(late)
    assert (len(track), track.t.tolist()) == (2, [0, 1])
    assert dict(track.report.skipped) == {"same epoch again": (2, 3)}


CLAIMS = ("fix", "none", "estimated", "unreadable", "damaged")
WRITTEN = {
    "GGA": lambda clock, claim: gga(clock, quality={"none": 0, "estimated": 6}.get(claim, 1)),
    "GNS": lambda clock, claim: gns(clock, mode={"none": "NN", "estimated": "EN"}.get(claim, "AN")),
    "RMC": lambda clock, claim: rmc(clock, mode={"none": "N", "estimated": "E"}.get(claim, "A")),
    "GLL": lambda clock, claim: gll(clock, mode={"none": "N", "estimated": "E"}.get(claim, "A")),
}
REASONS = {
    "none": "sentence without a fix",
    "estimated": "position estimated, put in by hand or simulated",
    "unreadable": "unreadable position",
    "damaged": "wrong checksum",
}
HEARD = st.lists(st.tuples(st.sampled_from(list(WRITTEN)), st.sampled_from(CLAIMS)), max_size=6)


@given(st.lists(HEARD, min_size=1, max_size=6), st.integers(1, 400))
def test_every_sentence_is_used_or_counted_with_its_reason(tmp_path_factory, epochs, block):
    """Epoch by epoch, against the rule itself; wherever the blocks end that are read at a time."""
    lines, expected, used = [], Counter(), 0
    first = {}
    for second, heard in enumerate(epochs):
        ranks = {"fix": [], "none": [], "estimated": []}
        for kind, claim in heard:
            line = WRITTEN[kind](f"2359{54 + second:02d}.0", claim)
            if claim == "unreadable":
                line = nmea(line[1:-3].replace("5405.6081", "5460.0000"))
            lines.append(line.replace(",E", ",F", 1) if claim == "damaged" else line)
            if claim != "fix":
                expected[REASONS[claim]] += 1
                first.setdefault(REASONS[claim], len(lines))
            ranks.setdefault(claim, []).append(list(WRITTEN).index(kind))
        fixes, denied = ranks["fix"], ranks["none"] + ranks["estimated"]
        if fixes and min(fixes) <= min(denied, default=9):
            used += 1
            expected["same epoch again"] += len(fixes) - 1
        else:
            reason = "sentence of an epoch that a more trusted one says has no fix"
            expected[reason] += len(fixes)
    path = tmp_path_factory.getbasetemp() / "generated.nmea"
    path.write_text("\n".join([*lines, ""]), newline="\r\n")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("wmrlib.tracks.sentences._BLOCK", block)
        if used:
            report = wmr.read_track(path).report
            assert report.used == used
            assert {why: count for why, (count, _) in report.skipped.items()} == +expected
            assert all(report.skipped[why].first == line for why, line in first.items())
            assert report.used + sum(count for count, _ in report.skipped.values()) == len(lines)
        else:
            with pytest.raises(ValueError, match="no position in") as error:
                wmr.read_track(path)
            for reason, count in (+expected).items():
                assert f"{count} {reason}" in str(error.value)


def test_large_logs_and_tables_are_streams(tmp_path):
    """At the peak a position takes 200 bytes, and a block at a time whatever it takes."""
    log = "\n".join(gga(f"{k // 3600:02d}{k // 60 % 60:02d}{k % 60:02d}") for k in range(20_000))
    table = "lat,lon,t,note\n" + "".join(f"1,2,{k},{'x' * 300}\n" for k in range(20_000))
    for text in (log, table):
        path = tmp_path / "large"
        path.write_text(text)
        tracemalloc.start()
        assert len(wmr.read_track(path)) == 20_000
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert peak < 20_000 * 200 + 2_000_000


# GPX


def test_gpx_in_utf_16_is_read_whatever_encoding_it_names(read):
    for name in ("utf-16", "UTF-8"):
        content = gpx(trk(GOOD), head=f'<?xml version="1.0" encoding="{name}"?>')
        assert places(read(content.encode("utf-16"))) == ([33.27], [44.37])


def test_routes_and_waypoints_are_read_where_there_is_no_track(read):
    rte, wpt = '<rte><rtept lat="1" lon="2"/></rte>', '<wpt lat="3" lon="4"/>'
    assert places(read(gpx(wpt + rte))) == ([1.0], [2.0])
    assert places(read(gpx(wpt))) == ([3.0], [4.0])


def test_an_unreadable_time_of_gpx_is_told_where_its_position_is_used(read):
    bad = '<trkpt lat="34" lon="200"><time>yesterday</time></trkpt>'
    assert not read(gpx(trk(GOOD, bad))).report.noted
    track = read(gpx(trk(GOOD, '<trkpt lat="34" lon="45"><time>yesterday</time></trkpt>')))
    assert len(track) == 2
    assert np.isnan(track.t).all()
    assert dict(track.report.noted) == {"with an unreadable time": (1, 5)}
    assert "used, but: 1 with an unreadable time" in repr(track.report)


def at(lat, time="", kind="trkpt"):
    return f'<{kind} lat="{lat}" lon="44.5">{time and f"<time>{time}</time>"}</{kind}>'


def test_the_time_of_a_place_tells_when_it_was_made(read):
    made = "with a time, which tells when it was made, not passed"
    days = random.Random(0).sample(range(10, 28), 9)
    for kind, inner in (("wpt", "{}"), ("rtept", "<rte>{}</rte>")):
        spots = [at(k, f"2026-03-{day}T12:00:00Z", kind) for k, day in enumerate(days)]
        track = read(gpx(inner.format("\n".join([*spots, spots[-1]]))))
        assert track.points.lat.tolist() == [*range(9), 8]
        assert np.isnan(track.t).all()
        assert (track.report.skipped, dict(track.report.noted)) == ({}, {made: (10, 3)})


def test_order_is_judged_within_a_segment(read):
    def segment(hour):
        times = [f"2026-03-01T{hour:02d}:{k:02d}:00Z" for k in range(50)]
        points = (at(f"{hour}.{k:02d}", time) for k, time in enumerate(times))
        return "<trkseg>" + "\n".join(points) + "</trkseg>"

    track = read(gpx("<trk>" + segment(9) + segment(8) + "</trk><trk>" + segment(7) + "</trk>"))
    assert (len(track), track.report.skipped) == (150, {})
    assert track.t.tolist() == [60 * k - hour for hour in (0, 3600, 7200) for k in range(50)]
    assert repr(track) == "<Track: 150 positions from GPX, over 10140 s; 0 not used>"


SCHEMA = "http://www.topografix.com/GPX/"
SPACES = {"gpx": "", "g:gpx": f' xmlns:g="{SCHEMA}1/1"', "gpx ": f' xmlns="{SCHEMA}1/0"'}
FATES = {
    "kept": '<{n}trkpt lat="{k}" lon="-180"/>',
    "timed": '<{n}trkpt lon="180.0" lat="{k}"><{n}time>2026-03-01T12:00:{k}Z</{n}time></{n}trkpt>',
    "latitude not in -90 to 90": '<{n}trkpt lat="{k}1" lon="4"/>',
    "longitude not in -180 to 180": '<{n}trkpt lat="{k}" lon="180.0000001"/>',
    "latitude or longitude not a number": '<{n}trkpt lat="{k}" lon="{odd}"/>',
    "point without a latitude or longitude": '<{n}trkpt {side}="{k}"></{n}trkpt>',
    "track point outside <trkseg>": '<{n}x><{n}trkpt lat="{k}" lon="4"/></{n}x>',
    "foreign": '<o:trkpt xmlns:o="urn:o" lat="{k}" lon="4"><{n}trkpt lat="{k}" lon="4"/></o:trkpt>',
    "extension": '<{n}extensions><{n}trkpt lat="{k}" lon="4"/></{n}extensions>',
}


@given(
    st.lists(st.lists(st.sampled_from(list(FATES)), max_size=6), max_size=5),
    st.lists(st.sampled_from(["wpt", "rtept"]), max_size=4),
    st.sampled_from(list(SPACES)),
    st.sampled_from(["utf-8", "utf-8-sig", "utf-16", "utf-16-be"]),
    st.sampled_from(["NaN", "abc", "", "inf", "3_3"]),
    st.sampled_from(["lat", "lon"]),
)
def test_every_position_of_gpx_is_kept_or_counted(
    tmp_path_factory, tracks, others, root, code, odd, side
):
    n, k, wanted = root[: root.index("g", -4)], 10, {}
    lines, lats = [f"<{root.strip()}{SPACES[root]}>"], []
    for other in others:
        place = f'<{n}{other} lat="1" lon="2"/>'
        lines.append(place if other == "wpt" else f"<{n}rte>{place}</{n}rte>")
    for fates in tracks:
        lines.append(f"<{n}trk><{n}trkseg/><{n}trkseg>")
        for fate in fates:
            lines.append(FATES[fate].format(n=n, k=k, odd=odd, side=side))
            if fate in ("kept", "timed"):
                lats.append(k)
            elif fate not in ("foreign", "extension"):
                wanted[fate] = wanted.get(fate, 0) + 1
            k += 1
        lines.append(f"</{n}trkseg></{n}trk>")
    if lats:
        beside = {"wpt": "waypoint", "rtept": "route point"}
        wanted |= {
            f"{beside[other]} beside the track points": others.count(other) for other in others
        }
    file = tmp_path_factory.getbasetemp() / "any.gpx"
    file.write_bytes("\n".join([*lines, f"</{root.strip()}>"]).encode(code))
    if lats:
        track = wmr.read_track(file)
        assert (track.source, track.points.lat.tolist()) == ("GPX", lats)
        assert set(track.points.lon.tolist()) <= {-180.0, 180.0}
        assert {reason: count for reason, (count, _) in track.report.skipped.items()} == wanted
        for reason, (_, first) in track.report.skipped.items():
            about = {"latitude not in -90 to 90": '1" lon'}.get(reason, "pt")
            assert about in lines[first - 1]
    elif wanted:
        with pytest.raises(ValueError, match="it is GPX, but") as error:
            wmr.read_track(file)
        assert all(
            f"{count} {reason} (first" in str(error.value) for reason, count in wanted.items()
        )


def test_gpx_takes_little_time_and_memory(tmp_path):
    file, n = tmp_path / "long.gpx", 40_000
    times = np.datetime_as_string(np.datetime64("2026-03-01T12:00:00") + np.arange(n))
    rows = (f"<ele>3</ele><time>{time}Z</time>" for time in times)
    file.write_text(
        gpx(trk(*(f'<trkpt lat="3{k}e-9" lon="4">{row}</trkpt>' for k, row in enumerate(rows))))
    )
    began = process_time()
    for _, element in ElementTree.iterparse(file):
        element.clear()
    bare, began = process_time() - began, process_time()
    assert len(wmr.read_track(file)) == n
    assert process_time() - began < 10 * bare
    tracemalloc.start()
    track = wmr.read_track(file)
    kept, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert len(track) == n
    assert kept / n < 40
    assert peak / n < 200


ENTITIES = "".join(
    f'<!ENTITY {b} "{f"&{a};" * 10}">' for a, b in zip("abcdefgh", "bcdefghi", strict=True)
)
LAUGHS = f'<!DOCTYPE gpx [<!ENTITY a "ha">{ENTITIES}]>'
EXTERNAL = '<!DOCTYPE gpx [<!ENTITY e SYSTEM "file:///etc/passwd">]>'
NO_GPX = [
    (gpx(trk(GOOD) + "<x>&i;</x>", head=LAUGHS), "document type or an entity"),
    (gpx(trk(GOOD) + "<x>&e;</x>", head=EXTERNAL), "document type"),
    (gpx(trk(GOOD), head='<!DOCTYPE gpx SYSTEM "http://localhost:9/x.dtd">'), "document type"),
    (gpx(trk(GOOD), head="<!DOCTYPE gpx>"), "document type"),
    ("<kml><Placemark/></kml>", "it is a KML file, not a GPX file; export it as GPX$"),
    ("<kml><Placemark>", "it is a KML file, not a GPX file; export it as GPX$"),  # cut off
    ("<TrainingCenterDatabase/>", "it is a TCX file, not a GPX file; export it as GPX$"),
    ("<!DOCTYPE html>\n<html><br></html>", "it is a web page, not a GPX file$"),
    ("<HTML><br></HTML>", "it is a web page, not a GPX file$"),
    ("<!-- saved --><!doctype html>\n<p>404 <br>", "it is a web page, not a GPX file$"),
    ("\n<!DOCTYPE HTML PUBLIC 'x' 'http://localhost:9/x'>", "it is a web page, not a GPX file$"),
    ("<!doctype html>".encode("utf-16"), "it is a web page, not a GPX file$"),
    ('<html xmlns="http://www.w3.org/1999/xhtml"><br>', "it is a web page, not a GPX file$"),
    (gpx("<desc><![CDATA[<html>]]></desc><trk>")[:-9], "its XML is broken"),
    ('<?xml version="1.0" encoding="none"?><gpx/>', "its XML is broken: unknown encoding: none"),
    ('<?xml version="1.0" encoding="gb2312"?><gpx/>', "multi-byte encodings are not supported"),
    (gzip.compress(gpx(trk(GOOD)).encode()), "it is compressed by gzip; unpack it$"),
    (b"PK\x03\x04" + bytes(40), "it is a zip archive, as a KMZ file is; unpack it"),
    (b"\x0e\x20\x54\x08\x10\x00\x00\x00.FIT" + bytes(40), "it is a FIT file; export it as GPX$"),
    ("<time>x</time>", "it is XML of the kind 'time', not a GPX file$"),
    (gpx("<trk>" * 3000 + GOOD + "</trk>" * 3000), "but 1 track point outside <trkseg>"),
    (gpx("<rte>" + GOOD + "</rte>"), r"1 track point outside <trkseg> \(first in line 3\)$"),
    (gpx(trk(GOOD))[:-20], "its XML is broken"),
    (gpx("<a:b/>"), "its XML is broken: .*unbound prefix"),
    (gpx(""), "it is GPX, but holds no position"),
    (gpx(trk('<trkpt lat="91" lon="0"/>')), r"1 latitude not in -90 to 90 \(first in line 4\)"),
]


def test_what_is_not_read_of_gpx_may_hold_anything(read):
    for inner, outer, space in [
        ("<ele>abc</ele>", "", ""),
        ("<sat>8.0</sat><fix>5d</fix>", "", ""),
        ("", "<rte><number>a</number></rte>", ""),
        ("", '<bounds minlat="x"/>', ""),  # where GPX 1.0 has them
        ("<extensions>" + "<a>" * 3000 + "</a>" * 3000 + "</extensions>", "", ""),
        ("<extensions><time>later</time></extensions>", "<time>now</time>", ""),
        ("", "", "\n "),
    ]:
        first, second = (
            f'<trkpt lat="{lat}" lon="44.37">{inner}<time>{space}{time}{space}</time></trkpt>'
            for lat, time in ((33.27, "2026-03-01T12:00:00Z"), (34, "2026-03-01T13:00:05+01:00"))
        )
        for root in ("gpx", 'gpx version="1.1"'):
            track = read(gpx(outer + trk(first, second), root=root))
            assert (track.points.lat.tolist(), track.t.tolist()) == ([33.27, 34.0], [0.0, 5.0])
            assert repr(track.report) == "2 positions used"


# CSV


def test_tables_of_every_kind(read):
    utc = "2026-03-01T12:00:00Z\n33,44.5,2026-03-01T13:00:01.5+01:00"
    for content, lat, lon, t in [
        ("\ufeff# a comment\nlat,lon\n33.25,44.5\n", [33.25], [44.5], [math.nan]),
        ("Latitude,Longitude\n33.25,44.5\n", [33.25], [44.5], [math.nan]),
        (" LAT , lng\n33.25,44.5\n", [33.25], [44.5], [math.nan]),
        ("latitude;long\n33.25;44.5\n", [33.25], [44.5], [math.nan]),
        ("lat\tlongitude\n33.25\t44.5\n", [33.25], [44.5], [math.nan]),
        ("n|lat|lon\n7|33.25|44.5\n", [33.25], [44.5], [math.nan]),
        ("lon,lat\n44.5,33.25\n", [33.25], [44.5], [math.nan]),
        ("t,lat,lon\n5,33,44.5\n6.5,33,44.5\n", [33, 33], [44.5] * 2, [0, 1.5]),
        (f"lat,lon,time\n33,44.5,{utc}\n", [33, 33], [44.5] * 2, [0, 1.5]),
        (f"lat,lon,datetime\n33,44.5,{utc.replace('T', ' ')}\n", [33] * 2, [44.5] * 2, [0, 1.5]),
        ("lat;lon;t\n33,5;44,25;0,5\n-1,5;2;1,75\n", [33.5, -1.5], [44.25, 2], [0, 1.25]),
        ("lat\tlon\tt\n33,5\t44,25\t0\n-1,5\t2\t1,25\n", [33.5, -1.5], [44.25, 2], [0, 1.25]),
        ('lat,lon,t\n"33,5","44,25",0\n-1.5,2,1.25\n', [33.5, -1.5], [44.25, 2], [0, 1.25]),
        ("lat,lon,t\n1,2,2026-03-01 12:00\n1,3,2026-03-01T12:00:01Z\n", [1, 1], [2, 3], [0, 1]),
    ]:
        track = read(content)
        assert (track.source, *places(track)) == ("CSV", lat, lon), content
        np.testing.assert_array_equal(track.t, t)


V900 = "INDEX,TAG,DATE,TIME,LATITUDE N/S,LONGITUDE E/W,HEIGHT,SPEED,HEADING,FIX MODE,VALID,PDOP\n"
V900_ROW = "{},T,090522,{},33.85{}S,151.21{}E,30,1,0,{},{},1.6\n"
BT747 = "INDEX,RCR,DATE,TIME,VALID,LATITUDE,N/S,LONGITUDE,E/W,HEIGHT(m),SPEED(km/h),NSAT\n"
BT747_ROW = "{},TD,{},{},{},{},{},{},{},30.5 M,1.25 km/h,9,\n"


def test_tables_of_data_loggers(read):
    """Hemispheres, dates and fixes in columns of their own."""
    rows = [("235959", 1, 2, "3D", "SPS"), ("5", 3, 4, "", "DGPS"), ("6", 5, 6, "2D", "")]
    begin, end, day = "090522", "090523", V900_ROW
    lines = [
        day.replace(begin, begin if k == 0 else end).format(k, *row) for k, row in enumerate(rows)
    ]
    track = read(V900 + "".join(lines))
    assert places(track) == ([-33.851, -33.853, -33.855], [151.212, 151.214, 151.216])
    assert track.t.tolist() == [0, 6, 7]
    assert repr(track.report) == "3 positions used"
    for bad in ("No fix", "no fix", "NO FIX", "V", "0", "invalid"):
        track = read(V900 + lines[0] + V900_ROW.format(1, "5", 3, 4, "", bad))
        assert dict(track.report.skipped) == {"row without a fix": (1, 3)}, bad
    for mode in ("0", "1", "none"):
        track = read(V900 + lines[0] + V900_ROW.format(1, "5", 3, 4, mode, "SPS"))
        assert dict(track.report.skipped) == {"row without a fix": (1, 3)}, mode
    track = read(V900 + lines[0] + V900_ROW.format(1, "235960", 3, 4, "", "Estimated mode"))
    assert list(track.report.skipped) == ["position estimated, put in by hand or simulated"]
    track = read(V900 + V900_ROW.format(1, "5", 3, 4, "", "banana"))
    assert dict(track.report.noted) == {"with an unknown word on its fix": (1, 2)}

    def second(day, clock, *place, valid="SPS"):
        place = place or ("33.8568", "S", "151.2153", "E")
        first = BT747_ROW.format(1, "2013/05/12", "23:59:59.500", "SPS", 1, "N", 2, "W")
        return read(BT747 + first + BT747_ROW.format(2, day, clock, valid, *place))

    track = second("2013/05/13", "00:00:01.250")
    assert (places(track), track.t.tolist()) == (([1, -33.8568], [-2, 151.2153]), [0, 1.75])
    for day, clock in [
        ("2013-05-13", "000001.25"),
        ("130513", "00:00:01,25".replace(",", ".")),
        ("20130513", "1.25"),
        ("2013/05/13", "2013-05-13T00:00:01.25Z"),
    ]:
        assert second(day, clock).t.tolist() == [0, 1.75], (day, clock)
    for day, clock in [("yesterday", "00:00:01"), ("2013/05/13", "250001"), ("", "000001")]:
        track = second(day, clock)
        assert dict(track.report.noted) == {"with an unreadable time": (1, 3)}, (day, clock)
    track = second("2013/05/13", "000001", "33.8568", "South", "151.2153", "w")
    assert places(track) == ([1, -33.8568], [-2, -151.2153])
    for side in ("", "E", "X", "+"):
        track = second("2013/05/13", "000001", "33.8568", side, "151.2153", "E")
        assert dict(track.report.skipped) == {"row without a readable hemisphere": (1, 3)}
    for number, reason in {"0": "row without a fix", "6": "position estimated, put in"}.items():
        table = f"lat,lon,fix quality\n1,2,{number}\n3,4,5\n"
        assert next(iter(read(table).report.skipped)).startswith(reason)
    assert len(read("lat,lon,status\n1,2,0\n3,4,A\n")) == 2


def degrees_in_words(value, sides):
    """Each way to write degrees that leaves no doubt, and each that contradicts itself."""
    size, (plus, minus) = f"{abs(value):.7f}", sides
    side, other, sign = (minus, plus, "-") if value < 0 else (plus, minus, "+")
    right = [f"{sign}{size}", f"{size}{side}", f"{side}{size}", f"{size} {side.lower()}"]
    right += [f"{sign}{size}{side}", f"{side} {sign}{size}", f"{size}\N{DEGREE SIGN}{side}"]
    return right, [f"{sign}{size}{other}", f"{other}{sign}{size}", f"{side}{size}{other}"]


@given(st.floats(-90, 90), st.floats(-180, 180), st.data())
def test_a_sign_and_a_hemisphere_agree_or_the_row_is_refused(tmp_path_factory, lat, lon, data):
    path = tmp_path_factory.getbasetemp() / "signs.csv"
    lat, lon = round(lat, 7), round(lon, 7)
    ways, doubts = degrees_in_words(lat, "NS")
    y, x = data.draw(st.sampled_from(ways)), degrees_in_words(lon, "EW")[0]
    x = data.draw(st.sampled_from(x))
    wrong = data.draw(st.sampled_from(doubts))
    path.write_text(f"lon;lat\n{x};{y}\n{x};{wrong}\n{lon};{lat}\n", encoding="utf-8")
    track = wmr.read_track(path)
    assert places(track) == ([lat, lat], [lon, lon])
    assert dict(track.report.skipped) == {"sign and hemisphere that contradict each other": (1, 3)}


ODD = ["", "# 1,2,3,N", "1,2,3", "91,2,3,N", '"1,5",2,3,N', "1,2,x,S", "-1,2,3,S", "-1,2,3,N"]
ODD += ['1,2,"3\n",N', '"1\r\n2",3,4,N', "1_0,2,3,N", "1,2,3,n", "+1,2,3,S", "1,inf,3,N", ",,,"]
ROWS = st.sampled_from(["1,2,0,N", "1.5,-2,0.5,S", "3,4,2026-03-01T12:00:00Z,N", *ODD])


@given(st.lists(ROWS, max_size=12))
def test_every_row_is_kept_or_counted_with_its_line(tmp_path_factory, rows):
    path = tmp_path_factory.getbasetemp() / "rows.csv"
    lines = ["lat,lon,t,N/S", *rows, "5,6,7e9,N", ""]
    path.write_bytes("\n".join(lines).encode())
    report = wmr.read_track(path).report
    found = sum(row not in ("", ",,,") for row in rows) + 1
    assert report.used + sum(count for count, _ in report.skipped.values()) == found
    begins = {1 + "\n".join(lines[:k]).count("\n") + (k > 0) for k in range(len(lines))}
    assert {first for _, first in report.skipped.values()} <= begins


def test_names_of_columns_with_their_units(read):
    for header, row in {
        "LATITUDE N/S,LONGITUDE E/W,TIME": "33.5N,44.25E,5",
        "Latitude (deg),Longitude (deg),t [s]": "33.5,44.25,5",
        "lat_deg;lon_deg;time_s": "33.5;44.25;5",
        "latitudeE7,longitudeE7,time (ms)": "335000000,442500000,5000",
        "t_ms\tlat_e7\tlon_e7": "5000\t335000000\t442500000",
        "latitude (deg),lat,lon,t": "1,33.5,44.25,5",
        "lat,ns,lon,ew,t": "33.5,N,44.25,E,5",
    }.items():
        assert places(read(f"{header}\n{row}\n")) == ([33.5], [44.25]), header
    assert read("t_ms,lat,lon\n5000,1,2\n6500,3,4\n").t.tolist() == [0, 1.5]
    for header in ("lat (rad),lon (rad)", "position_lat,position_long"):
        with pytest.raises(ValueError, match="does not name"):
            read(f"{header}\n1,2\n")
    with pytest.raises(ValueError, match=r"more than one column of \['lat \(deg\)', 'lat_e7'\]"):
        read("lat (deg),lat_e7,lon\n1,2,3\n")


def test_text_as_windows_writes_it(read):
    for source, text in {
        "NMEA": gga(lat="3330.0000,N", lon="04415.0000,E") + "\r\n",
        "CSV": "lat,lon\r\n33.5,44.25\r\n",
        "GPX": '<gpx><wpt lat="33.5" lon="44.25"/></gpx>',
    }.items():
        big_endian = b"\xfe\xff" + text.encode("utf-16-be")
        for data in (text.encode("utf-8-sig"), text.encode("utf-16"), big_endian):
            track = read(data)
            assert (track.source, *places(track)) == (source, [33.5], [44.25])
            assert repr(track.report) == "1 position used"


def test_bad_rows_are_counted_with_their_line(read):
    width = "row with more or fewer cells than the header"
    no_number = "latitude or longitude not a number"
    cells = ["33 27 N", "nan", "inf", "1_0", "", '"1,2,3"', '"1,234.5"', '"1.2,3"', '","']
    for reason, row in [
        ("latitude not in -90 to 90", "1,91,44"),
        ("longitude not in -180 to 180", "1,33,200"),
        *((no_number, f"1,{cell},44") for cell in cells),
        (no_number, "yesterday,x,44"),
        (width, "1,33,27,44,37"),  # decimal commas
        (width, "1,33"),
        ("row with a cell over several lines", '"1\n2",33,44'),
        ("same epoch again", "0,33.0,44.0"),
        ("time runs backwards", "-1,33.0,44.0"),
        ("comment", "# 1,33,44"),
    ]:
        track = read(f"time,lat,lon\n\n0,33.0,44.0\n{row}\n2,34.0,45.0\n")
        assert track.points.lat.tolist() == [33.0, 34.0], row
        assert (dict(track.report.skipped), track.report.noted) == ({reason: (1, 4)}, {})
    # milliseconds are no seconds, and a last line that may be cut is told
    track = read("lat,lon,t\n1,2,1767225600000\n3,4,5")
    assert dict(track.report.noted) == {
        "with an unreadable time": (1, 2),
        "in a last line without an end, which may be cut off": (1, 3),
    }
    assert np.isnan(track.t[0])
    begin = process_time()
    assert len(read("lat,lon\n1,2\n" + "\n" * 50_000)) == 1
    assert process_time() - begin < 1.5  # with a pattern that runs on over lines 5 s and more


SIDES = ["Dir", "Direction", "Ref", "Hemi", "Hemisphere", "Indicator"]
PAIRS = [
    ("N/S", "E/W"),
    ("n_s", "e_w"),
    ("NS Indicator", "EW Indicator"),
    ("North/South", "East/West"),
]
PAIRS += [
    (f"{lat}{gap}{side}", f"{lon}{gap}{side}")
    for lat, lon in (("Lat", "Lon"), ("Latitude", "Longitude"))
    for gap in ("", " ", "_")
    for side in SIDES
]


def test_hemispheres_and_fixes_are_known_by_many_names(read):
    for north, east in PAIRS:
        track = read(f"Latitude,{north},Longitude,{east}\n33.5,S,70.6,W\n1.0,N,2.0,E\n")
        assert places(track) == ([-33.5, 1.0], [-70.6, 2.0]), north
    for name in ("fix", "fixType", "Fix_Type", "FixQuality", "gps fix", "is_valid", "isValid"):
        track = read(f"lat,lon,{name}\n0,0,0\n33.5,44,3\n")
        assert places(track) == ([33.5], [44.0]), name
        assert dict(track.report.skipped) == {"row without a fix": Count(1, 2)}
    for name, units in (("time_us", 1e6), ("gps time", 1.0), ("Date Time", 1.0), ("timeMs", 1e3)):
        track = read(f"{name},lat,lon\n{units:.0f},0,0\n{4 * units:.0f},33.5,44\n")
        assert track.t.tolist() == [0.0, 3.0], name


@given(
    st.integers(-89 * 3600 * 10**4, 89 * 3600 * 10**4),
    st.sampled_from([("lat_deg", "lat_min", "lat_sec"), ("Lat (D)", "Lat (M)", "Lat (S)")]),
    st.sampled_from(["sign", "N/S", "latHemi"]),
    st.booleans(),
    st.sampled_from(["33.5", "0.1"]),
    st.sampled_from(["60", "-1", "x", ""]),
)
def test_columns_of_minutes_are_read_or_the_row_is_refused(
    tmp_path_factory, size, names, side, seconds, broken, wrong
):
    """Ten-thousandths of a second of an arc; -0 deg is south, too."""
    whole, rest = divmod(abs(size), 3600 * 10**4)
    minutes, rest = divmod(rest, 60 * 10**4) if seconds else (rest / 60 / 10**4, 0)
    cells = [f"{whole}", f"{minutes!r}", f"{rest / 10**4!r}"][: 2 + seconds]
    names, letter = [*names[: 2 + seconds]], "S" if size < 0 else "N"
    if side == "sign":
        cells[0] = "-" * (size < 0) + cells[0]
    else:
        names, cells = [*names, side], [*cells, letter]
    path = tmp_path_factory.getbasetemp() / "minutes.csv"
    bad = [*cells]
    bad[seconds], bad[1 + seconds] = broken, wrong  # only the last part has decimals
    rows = [*names, "lon"], *([*row, "2.5"] for row in (cells, bad, cells))
    path.write_text("".join(",".join(row) + "\n" for row in rows))
    track = wmr.read_track(path)
    assert track.points.lat.tolist() == pytest.approx([size / 3600 / 10**4] * 2, abs=1e-12)
    assert dict(track.report.skipped) == {"row without readable minutes or seconds": (1, 3)}


def test_minutes_beside_another_latitude_are_refused(read):
    for header in (
        "lat_deg,lat_min,lat,lon",
        "lat_deg,lat_sec,lon",
        "lat,latitude_min,latitude,lon",
    ):
        with pytest.raises(ValueError, match="more than one column"):
            read(f"{header}\n1,2,3,4\n")


DATES = ["%Y/%m/%d", "%d.%m.%Y", "%m/%d/%Y", "%y%m%d", "%d%m%y", "%m%d%y"]


@given(
    st.integers(0, 29_000),
    st.lists(st.integers(0, 3), min_size=1, max_size=6),
    st.sampled_from(DATES),
)
def test_the_order_of_a_date_is_that_of_the_whole_file(tmp_path_factory, begin, days, how):
    """Whatever is read is right; where two orders bring the dates as near, none is."""
    first = BEGIN.replace(year=1990, month=1, day=1) + timedelta(days=begin)
    dates = [first + timedelta(days=sum(days[:k])) for k in range(len(days) + 1)]
    path = tmp_path_factory.getbasetemp() / "dates.csv"
    rows = (f"{date.strftime(how)},12:00:{k:02d},{k},2\n" for k, date in enumerate(dates))
    path.write_text("date,time,lat,lon\n" + "".join(rows))
    track = wmr.read_track(path)
    right = [(date - first).total_seconds() + k for k, date in enumerate(dates)]
    if track.report.noted:
        assert dict(track.report.noted) == {"with an unreadable time": (len(dates), 2)}
        assert how[1] != "Y"
    else:
        assert track.t.tolist() == right


@pytest.mark.parametrize("how", DATES)
def test_days_that_follow_each_other_tell_their_order(read, how):
    for first in (datetime(2026, 5, 9), datetime(2009, 12, 30), datetime(2011, 10, 12)):
        days = [first + timedelta(days=k) for k in range(4)]
        rows = (f"{day.strftime(how)},12:00:00,{k},2\n" for k, day in enumerate(days))
        track = read("date,time,lat,lon\n" + "".join(rows))
        assert track.t.tolist() == [k * 86400 for k in range(4)], first


def test_numbers_that_are_no_seconds_are_days_or_refused(read):
    """Excel counts days, a board milliseconds since it was switched on."""
    days = [45292.5 + k / 86400 for k in range(5)]
    track = read("time,lat,lon\n" + "".join(f"{day:.9f},{k},2\n" for k, day in enumerate(days)))
    assert track.t == pytest.approx(range(5), abs=1e-4)
    assert dict(track.report.noted) == {"with a time in days, as spreadsheets count them": (5, 2)}
    board = "".join(f"{12345 + 200 * k},{k},2\n" for k in range(5))
    track = read("time,lat,lon\n" + board)
    assert np.isnan(track.t).all()
    (noted,) = track.report.noted
    assert "seconds or milliseconds" in noted
    for name, unit in (("time_ms", 1e3), ("time_s", 1.0)):
        track = read(f"{name},lat,lon\n{board}")
        assert track.t == pytest.approx([200 * k / unit for k in range(5)])
        assert not track.report.noted
    for times in (
        [45292 + k for k in range(5)],
        [0, 60, 120],
        [1.7e9, 1.7e9 + 300],
        [0, 99.5, 300],
    ):
        track = read("t,lat,lon\n" + "".join(f"{t!r},{k},2\n" for k, t in enumerate(times)))
        assert track.t == pytest.approx([t - times[0] for t in times])
        assert not track.report.noted


def test_what_spreadsheets_write_around_a_table_is_read(read):
    degree = "33,5\N{DEGREE SIGN}S;44,25\N{DEGREE SIGN}E"
    for head, code in (
        (head, code)
        for head in ("", "sep=;\n", "My drive; 2026\n\nby me\n")
        for code in ("utf-8", "latin-1", "utf-16")
    ):
        track = read(f"{head}lat;lon\n{degree}\n".encode(code))
        assert places(track) == ([-33.5], [44.25])
        titles = len([line for line in head.split("\n") if line])
        wanted = {"line above the names of the columns": (titles, 1)} if titles else {}
        assert dict(track.report.skipped) == wanted
    assert places(read("lat,lon\n\u22121.5,\u22122\n")) == ([-1.5], [-2.0])
    assert places(read("lat;lon\n\u22121,5;2\n")) == ([-1.5], [2.0])
    with pytest.raises(ValueError, match=r"first line 'one' does not name"):
        read("one\n" * 10 + "lat,lon\n1,2\n")


ENDLESS = {
    "gpx": gpx(f'<metadata name="{"x" * 8_000_000}"/>{trk(GOOD)}'),
    "comment": gpx(f"<!--{'x' * 8_000_000}-->{trk(GOOD)}"),
    "nmea": "$GPGGA," * 300_000,
    "one line": gga() * 20_000,
    "row": "lat,lon\n1,2\n" + "1," * 4_000_000,
    "header": "lat,lon," * 2_000_000,
}


@pytest.mark.parametrize("kind", ENDLESS)
def test_a_line_without_an_end_takes_little_time_and_memory(read, tmp_path, kind):
    path = tmp_path / "endless"
    path.write_text(ENDLESS[kind])
    tracemalloc.start()
    begin = process_time()
    if kind == "one line":
        assert len(wmr.read_track(path)) == 1
    else:
        with pytest.raises(ValueError, match=r"more than|without a checksum|neither NMEA"):
            wmr.read_track(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 12_000_000
    assert process_time() - begin < 30  # traced; the attribute alone took 140 s


# Whatever a file holds

NO_KIND = "it is neither NMEA nor GPX, and as a table"


def test_a_file_without_a_position_says_why(read, tmp_path):
    for content, message in [
        *NO_GPX,
        ("", "the file is empty"),
        (" \n\r\n", "the file is empty"),
        (b"\xff\xfe", "the file is empty"),
        (b"\x00" * 200_000, NO_KIND),
        (b"x" * 200_000, NO_KIND + " its first line 'x{80}' does not name"),
        ("var data=" + "1," * 100_000, NO_KIND),
        (b"\x89PNG\r\n\x1a\n\x00\x00", "does not name"),
        ("# lat,lon\n", "no header"),
        ("x,y\n1,2\n", r"'x,y' does not name one of \['lat', 'latitude'\]"),
        ("lat,y\n1,2\n", r"does not name .*'long'"),
        ("lat,latitude,lon\n1,1,2\n", r"more than one column of \['lat', 'latitude'\]"),
        ("lat,lon\n", "it is CSV, but holds no position"),
        ("lat,lon\n-95,2\n", r"1 latitude not in -90 to 90 \(first in line 2\)"),
        ("lat,lon\n1," + "2" * 200_000, "its table is broken"),
        ('lat,lon\n1,2\n"3,4\n', "its table is broken"),
        ('{"type": "Point", "coordinates": [1, 2]}', "it is JSON, but NMEA, GPX or CSV is needed"),
    ]:
        with pytest.raises(ValueError, match=message) as error:
            read(content)
        assert "file.txt" in str(error.value)
    with pytest.raises(FileNotFoundError):
        wmr.read_track(tmp_path / "none.gpx")
    with pytest.raises(OSError, match=re.escape(str(tmp_path))):
        wmr.read_track(tmp_path)


def test_whatever_a_file_holds_it_is_read_or_refused(read):
    """Damaged files raise ValueError and nothing else, and never bring a position that is none."""
    for seed, content in enumerate(
        [LOG.read_bytes()[:3000], gpx(trk(GOOD, GOOD)).encode(), b"lat,lon,t\n1,2,3\n4,5,6\n"]
    ):
        draw, refused = random.Random(seed), 0
        for _ in range(300):
            data = bytearray(content)
            for _ in range(draw.randint(1, 4)):
                at = draw.randrange(len(data))
                data[at : at + draw.randint(0, 3)] = draw.randbytes(draw.randint(0, 3))
            try:
                track = read(bytes(data))
            except ValueError:
                refused += 1
            else:
                assert len(track) == track.report.used > 0
        assert refused < 300


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
    wmr.write_geojson(file, there)
    text = file.read_text().split('"coordinates"')[1]
    written = re.findall(r"\[(-?[\d.e-]+), ?(-?[\d.e-]+)\]", text)
    found = {(float(lon), float(lat)) for lon, lat in written}
    assert found >= set(zip(points.lon, points.lat, strict=True))


def test_gpx_1_1_as_its_schema_asks(tmp_path):
    """Names, order, attributes and ranges of http://www.topografix.com/GPX/1/1/gpx.xsd."""
    points = wmr.GeoPoint(lat=[0.0, 1e-7, -1e-7, 5.0], lon=[179.9999999, 180.0, -180.0, -1e-7])
    title, file = "<b> & \"c\" 'd' ]]> \r é بغداد", tmp_path / "a.gpx"
    wmr.write_gpx(file, points, t=[0, 0.25, math.nan, 2], begin=BEGIN, name=title)
    root = ElementTree.parse(file).getroot()
    assert root.tag == GPX_11 + "gpx"
    assert (root.attrib["version"], root.attrib["creator"]) == ("1.1", "wmrlib")
    (track,) = root
    name, *segments = track
    assert (track.tag, name.tag, name.text) == (GPX_11 + "trk", GPX_11 + "name", title)
    assert {segment.tag for segment in segments} == {GPX_11 + "trkseg"}
    assert [len(segment) for segment in segments] == [1, 3]
    found = [point for segment in segments for point in segment]
    assert [tuple(point.attrib.items()) for point in found] == [
        (("lat", "0.0000000"), ("lon", "179.9999999")),
        (("lat", "0.0000001"), ("lon", "-180.0000000")),
        (("lat", "-0.0000001"), ("lon", "-180.0000000")),
        (("lat", "5.0000000"), ("lon", "-0.0000001")),
    ]
    assert all([child.tag for child in point] in ([GPX_11 + "time"], []) for point in found)
    day = "2026-03-01T12:00:0"
    times = [point.findtext(GPX_11 + "time") for point in found]
    assert times == [f"{day}0Z", f"{day}0.250000Z", None, f"{day}2Z"]


def test_geojson_is_longitude_first_and_cut_at_the_date_line(tmp_path):
    file = tmp_path / "a.json"
    crossing = wmr.GeoPoint(lat=[10.0, 11.0, 12.0], lon=[179.0, -179.0, -178.0])
    wmr.write_geojson(file, crossing, name='"q"')
    feature = json.loads(file.read_text(encoding="utf-8"))
    assert (feature["type"], feature["properties"]) == ("Feature", {"name": '"q"'})
    assert feature["geometry"] == {
        "type": "MultiLineString",
        "coordinates": [
            [[179.0, 10.0], [180.0, 10.5]],
            [[-180.0, 10.5], [-179.0, 11.0], [-178.0, 12.0]],
        ],
    }
    wmr.write_geojson(file, wmr.GeoPoint(lat=33.5, lon=44.25))
    point = {"type": "Point", "coordinates": [44.25, 33.5]}
    assert json.loads(file.read_text())["geometry"] == point
    wmr.write_geojson(file, wmr.GeoPoint(lat=[10.0, 11.0], lon=[1.0, 2.0]))
    line = {"type": "LineString", "coordinates": [[1.0, 10.0], [2.0, 11.0]]}
    assert json.loads(file.read_text())["geometry"] == line
    for write in (wmr.write_gpx, wmr.write_geojson):
        write(file, wmr.GeoPoint(lat=[-1e-9, 1.0], lon=[-1e-9, 1.0]))
        assert "-0" not in file.read_text()


FULL_DISK = """
import resource, signal, sys
import wmrlib as wmr
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (500, 500))
points = wmr.GeoPoint(lat=[k / 100 for k in range(200)], lon=0.0)
for write in (wmr.write_gpx, wmr.write_geojson):
    try:
        write(sys.argv[1], points)
    except OSError as error:
        print(error.filename == sys.argv[1])
"""


def test_a_full_disk_leaves_the_file_that_was_there(tmp_path):
    pytest.importorskip("resource")
    for file, files in ((tmp_path / "new", []), (tmp_path / "old", ["old"])):
        if files:
            file.write_text("as it was")
        command = [sys.executable, "-c", FULL_DISK, file]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        assert done.stdout.split() == ["True", "True"]
        assert os.listdir(tmp_path) == files
    assert (tmp_path / "old").read_text() == "as it was"


@pytest.mark.skipif(os.name != "posix", reason="links and permissions are POSIX's")
def test_a_file_is_replaced_where_it_is_and_as_it_was(tmp_path):
    target, link, pipe = tmp_path / "deep" / "there", tmp_path / "link", tmp_path / "pipe"
    target.parent.mkdir()
    link.symlink_to(target)
    mask = os.umask(0o027)
    try:
        wmr.write_geojson(link, PAIR)
    finally:
        os.umask(mask)
    assert target.stat().st_mode & 0o777 == 0o640
    target.chmod(0o604)
    wmr.write_gpx(link, PAIR)
    assert (link.is_symlink(), target.stat().st_mode & 0o777) == (True, 0o604)
    assert wmr.read_track(target).source == "GPX"
    os.mkfifo(pipe)
    reader = subprocess.Popen(["cat", pipe], stdout=subprocess.PIPE)
    wmr.write_geojson(pipe, PAIR)
    assert json.loads(reader.communicate()[0])["type"] == "Feature"
    assert pipe.is_fifo()
    for path, kind in ((tmp_path, IsADirectoryError), (tmp_path / "no" / "x", FileNotFoundError)):
        with pytest.raises(kind, match=re.escape(f"'{path}'") + "$"):
            wmr.write_gpx(path, PAIR)
    assert sorted(os.listdir(tmp_path)) == ["deep", "link", "pipe"]
    assert os.listdir(target.parent) == ["there"]
    if os.geteuid():  # who is root may write anywhere
        target.chmod(0o400)
        with pytest.raises(PermissionError):
            wmr.write_gpx(target, PAIR)


class SummerTime(tzinfo):
    """Central Europe in March 2026, where 2:00 on the 29th is 3:00."""

    def dst(self, time):
        return timedelta(hours=1 if time.replace(tzinfo=None) >= datetime(2026, 3, 29, 2) else 0)

    def utcoffset(self, time):
        return timedelta(hours=1) + self.dst(time)


PAIR = wmr.GeoPoint(lat=[1.0, 2.0], lon=[3.0, 4.0])


def test_times_of_gpx_in_any_zone_and_of_a_single_position(tmp_path):
    file = tmp_path / "a.gpx"
    wmr.write_gpx(file, PAIR, t=[0, 3], begin=BEGIN.astimezone(None) + timedelta(seconds=1))
    assert wmr.read_track(file).t.tolist() == [0.0, 3.0]
    for points, t, begin, times in [
        (  # the clocks are put forward meanwhile
            PAIR,
            [0, 3600],
            datetime(2026, 3, 29, 1, 30, tzinfo=SummerTime()),
            ["2026-03-29T00:30:00Z", "2026-03-29T01:30:00Z"],
        ),
        (wmr.GeoPoint(lat=1.0, lon=2.0), 0.5, BEGIN, ["2026-03-01T12:00:00.500000Z"]),
    ]:
        wmr.write_gpx(file, points, t=t, begin=begin)
        assert [time.text for time in ElementTree.parse(file).iter(GPX_11 + "time")] == times


def test_bad_input_to_the_writers(tmp_path):
    late, local = datetime.max.replace(tzinfo=UTC), BEGIN.replace(tzinfo=None)
    cases = [
        (wmr.write_gpx, PAIR, {"t": t, "begin": begin}, message)
        for t, begin, message in [
            ([0, 1], None, "begin = None are not allowed together"),
            (None, BEGIN, "t = None and begin = .* are not allowed together"),
            ([0, 1, 2], BEGIN, r"t has shape \(3,\), points have shape \(2,\)"),
            ([0, math.inf], BEGIN, "a finite number or NaN is needed"),
            (["a", "b"], BEGIN, r"^t = \['a', 'b'\] is not allowed"),
            ({}, BEGIN, r"^t = {} is not allowed"),
            ([True, False], BEGIN, r"^t = \[True, False\] is not allowed"),
            ([0, 1e18], BEGIN, r"^t = .*e\+18.* is not allowed: begin \+ t in the years"),
            ([0, 1], late, r"^t = .* is not allowed: begin \+ t"),
            ([0, 1], local, "with its time zone is needed"),
        ]
    ]
    cases.append(
        (
            wmr.write_gpx,
            PAIR,
            {"name": "a\x00b"},
            r"^name = 'a\\x00b' is not allowed: one without '\\x00'",
        )
    )
    for write in (wmr.write_gpx, wmr.write_geojson):
        cases += [
            (write, wmr.GeoPoint(lat=[], lon=[]), {}, "at least one position is needed"),
            (write, [1, 2], {}, "a GeoPoint is needed"),
            (write, PAIR, {"name": "\ud800"}, r"^name = '\\ud800' is not allowed: one without"),
            (write, PAIR, {"name": 3}, "a str is needed"),
        ]
    (tmp_path / "old").write_text("as it was")
    for write, points, options, message in cases:
        for path in (tmp_path / "old", tmp_path / "new"):
            with pytest.raises(ValueError, match=message):
                write(path, points, **options)
    assert (tmp_path / "old").read_text() == "as it was"
    assert not (tmp_path / "new").exists()
