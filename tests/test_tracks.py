"""Positions out of files, against the sentences themselves, against the ellipsoid and by property; each bad file by itself."""

import json
import math
import random
from datetime import UTC, datetime, timedelta, tzinfo
from functools import reduce
from operator import xor
from pathlib import Path
from time import process_time
from xml.etree import ElementTree

import numpy as np
import pytest
from geographiclib.geodesic import Geodesic
from hypothesis import given
from hypothesis import strategies as st

import wmrlib as wmr
from wmrlib.tracks import Count, Report

LOG = Path(__file__).parent.parent / "notebooks" / "data" / "ublox5-standing.nmea"
GPX_11 = "{http://www.topografix.com/GPX/1/1}"
BEGIN = datetime(2026, 3, 1, 12, 0, 0, tzinfo=UTC)


@pytest.fixture
def read(tmp_path):
    """Read what a file would hold."""

    def of(content, name="file.txt"):
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return wmr.read_track(path)

    return of


def nmea(body):
    return f"${body}*{reduce(xor, body.encode('latin-1')):02X}"


def gga(clock="104706.00", lat="5405.6081,N", lon="01049.4791,E", quality=1, talker="GP"):
    return nmea(f"{talker}GGA,{clock},{lat},{lon},{quality},08,1.1,40.8,M,43.6,M,,0000")


def rmc(
    clock="104706.00", lat="5405.6081,N", lon="01049.4791,E", status="A", mode="A", day="240709"
):
    return nmea(f"GPRMC,{clock},{status},{lat},{lon},0.24,18.02,{day},,,{mode}")


def gpx(
    inner,
    head='<?xml version="1.0"?>',
    root='gpx version="1.1" creator="t" xmlns="http://www.topografix.com/GPX/1/1"',
):
    return f"{head}\n<{root}>\n{inner}\n</{root.split()[0]}>"


def trk(*points):
    return "<trk><trkseg>\n" + "\n".join(points) + "\n</trkseg></trk>"


GOOD = '<trkpt lat="33.27" lon="44.37"/>'

# NMEA ----------------------------------------------------------------------------------------------------------------


def test_the_real_log():
    track = wmr.read_track(LOG)
    assert track.source == "NMEA"
    assert len(track) == 9
    assert track.t.tolist() == list(range(9))
    assert track.points.lat[0] == pytest.approx(54 + 5.6081 / 60, abs=1e-12)
    assert track.points.lon[-1] == pytest.approx(10 + 49.4885 / 60, abs=1e-12)
    lines = LOG.read_text(encoding="utf-8").splitlines()
    counts = dict(track.report.skipped)
    assert counts.pop("comment") == (sum(line.startswith("#") for line in lines), 1)
    assert counts.pop("same epoch again") == (
        9,
        1 + next(i for i, line in enumerate(lines) if "RMC" in line),
    )
    assert counts.pop("other sentence").count == sum(line.startswith("$") for line in lines) - 18
    assert not counts
    assert not track.report.noted


def test_the_logs_rmc_alone_gives_the_same_positions(read):
    lines = LOG.read_text(encoding="utf-8").splitlines()
    track = read("\n".join(line for line in lines if "GGA" not in line))
    assert track.points.lon.tolist() == wmr.read_track(LOG).points.lon.tolist()
    assert track.points.lat.tolist() == wmr.read_track(LOG).points.lat.tolist()


@pytest.mark.parametrize("talker", ["GP", "GN", "GL", "GA", "GB", "BD", "QZ"])
def test_every_talker_is_heard(read, talker):
    assert len(read(gga(talker=talker))) == 1


def test_an_epoch_that_two_talkers_tell_of_counts_once(read):
    track = read(
        "\n".join([gga(talker="GN"), rmc(), gga(talker="GL", lat="5405.7000,N"), gga("104707.00")])
    )
    assert track.points.lat.tolist() == pytest.approx([54 + 5.6081 / 60] * 2)
    assert dict(track.report.skipped) == {"same epoch again": (2, 2)}


def test_south_and_west_are_negative(read):
    track = read(gga(lat="3351.5000,S", lon="15112.3000,W"))
    assert (track.points.lat[0], track.points.lon[0]) == (
        pytest.approx(-(33 + 51.5 / 60)),
        pytest.approx(-(151 + 12.3 / 60)),
    )


def test_time_goes_on_over_midnight(read):
    track = read("\n".join([gga("235959.00"), gga("000000.50"), gga("000001.00")]))
    assert track.t.tolist() == [0.0, 1.5, 2.0]


def test_a_night_without_a_fix_goes_by_the_receivers_clock(read):
    track = read(
        "\n".join(
            [
                gga("190000"),
                *(gga(f"{hour % 24:02d}0000", quality=0) for hour in range(20, 32)),
                gga("080000"),
                gga("080001"),
            ]
        )
    )
    assert track.t.tolist() == [0.0, 13 * 3600.0, 13 * 3600.0 + 1]
    assert dict(track.report.skipped) == {"sentence without a fix": (12, 2)}


@pytest.mark.parametrize("hour", range(24))
def test_a_receiver_that_starts_cold_and_counts_from_midnight_does_no_harm(read, hour):
    cold = [gga(f"0000{second:02d}", quality=0) for second in range(30)]
    track = read(
        "\n".join([gga(f"{hour:02d}0000"), *cold, gga(f"{hour:02d}0500"), gga(f"{hour:02d}0501")])
    )
    assert track.t.tolist() == [0.0, 300.0, 301.0]


DATED = {
    "a day and an hour": ([rmc("080000", day="290224"), rmc("090000", day="010324")], [0, 90000]),
    "less than a day": (
        [rmc("100000", day="290224"), rmc("080000", day="010324"), rmc("080001", day="010324")],
        [0, 79200, 79201],
    ),
    "an afternoon": (
        [rmc(clock) for clock in ("080000", "080001", "210000", "210001")],
        [0, 1, 46800, 46801],
    ),
    "the same second of the next day": (
        [rmc("080000", day="311223"), rmc("080000", day="010124")],
        [0, 86400],
    ),
    "GGA before RMC": (
        [
            gga("080000"),
            rmc("080000", day="290224"),
            gga("070000"),
            rmc("070000", day="020324"),
            gga("070001"),
        ],
        [0, 169200, 169201],
    ),
    "RMC before GGA": (
        [
            rmc("080000", day="290224"),
            gga("080000"),
            rmc("070000", day="020324"),
            gga("070000"),
            gga("070000.5"),
        ],
        [0, 169200, 169200.5],
    ),
    "a GGA between two RMC is of the nearer one's day": (
        [
            rmc("080000", day="290224"),
            gga("080000.5"),
            gga("070000.5"),
            rmc("070001", day="020324"),
        ],
        [0, 0.5, 169200.5, 169201],
    ),
    "GGA of the evening before": (
        [gga("235959"), rmc("000000", day="010324"), gga("000001")],
        [0, 1, 2],
    ),
    "no date": ([rmc("235959", day=""), rmc("000001", day="990099")], [0, 2]),
    "date of no fix": (
        [
            rmc("080000", day="290224"),
            rmc("080001", day="060180", status="V"),
            rmc("080002", day="290224"),
        ],
        [0, 2],
    ),
}


@pytest.mark.parametrize("name", DATED)
def test_the_date_of_rmc_counts(read, name):
    sentences, times = DATED[name]
    track = read("\n".join(sentences))
    assert track.t.tolist() == times


@pytest.mark.parametrize("day", ["230709", "240708"])
def test_an_earlier_date_is_time_that_runs_backwards(read, day):
    assert dict(read("\n".join([rmc("080000"), rmc("090000", day=day)])).report.skipped) == {
        "time runs backwards": (1, 2)
    }


BAD_SENTENCES = {
    "wrong checksum": gga("104707.00").replace("*", "0*"),
    "sentence without a checksum": gga("104707.00")[:-3],
    "sentence without a fix": gga("104707.00", quality=0),
    "position estimated, put in by hand or simulated": gga("104707.00", quality=6),
    "unreadable position": gga("104707.00", lat="5460.0000,N"),  # pynmea2 makes 55 degrees of it
    "latitude not in -90 to 90": gga("104707.00", lat="9005.6081,N"),
    "longitude not in -180 to 180": gga("104707.00", lon="18049.4791,E"),
    "fix without a readable time": gga(""),
    "time runs backwards": gga("104705.00"),
    "other sentence": nmea("GPGLL,5405.6081,N,01049.4791,E,104707.000,A,A"),
    "line that is no sentence": "5405.6081,N,01049.4791,E",
    "comment": "# 54.09, 10.82",
    "same epoch again": rmc(lat="5405.7000,N"),
}


@pytest.mark.parametrize("reason", BAD_SENTENCES)
def test_what_gives_no_position_is_counted(read, reason):
    bad = BAD_SENTENCES[reason]
    track = read("\r\n".join([gga(), bad, bad, ""]))
    assert len(track) == 1
    assert track.points.lat[0] == pytest.approx(54 + 5.6081 / 60, abs=1e-12)
    assert dict(track.report.skipped) == {reason: Count(2, 2)}
    assert f"not used: 2 {reason} (first in line 2)" in repr(track.report)


@pytest.mark.parametrize(
    ("lat", "lon"),
    [
        (",N", ",E"),
        ("0,N", "01049.4791,E"),
        ("5405.6081,", "01049.4791,E"),
        ("5405.6081,X", "01049.4791,E"),
        ("5405,N", "01049,E"),
    ],
)
def test_a_field_that_pynmea2_would_read_as_zero_is_not_used(read, lat, lon):
    with pytest.raises(ValueError, match="unreadable position"):
        read(gga(lat=lat, lon=lon))


@pytest.mark.parametrize(
    ("status", "mode"), [("V", "A"), ("A", "N"), ("A", "E"), ("A", "S"), ("", "")]
)
def test_an_rmc_without_a_measured_fix_is_not_used(read, status, mode):
    with pytest.raises(
        ValueError, match=r"it is NMEA, but 1 (sentence without a fix|position estimated)"
    ):
        read(rmc(status=status, mode=mode))


def test_where_the_gga_says_no_fix_the_rmc_is_not_believed(read):
    with pytest.raises(
        ValueError, match=r"1 sentence without a fix \(first in line 2\); 1 same epoch again"
    ):
        read(rmc() + "\n" + gga(quality=0))


def test_where_the_gga_is_damaged_the_rmc_stands_in(read):
    track = read(gga().replace("5405", "5406") + "\n" + rmc())
    assert track.points.lat.tolist() == [pytest.approx(54 + 5.6081 / 60, abs=1e-12)]
    assert dict(track.report.skipped) == {"wrong checksum": (1, 1)}


def test_makers_sentences_cut_short_do_no_harm(read):
    bodies = ("PUBX,00", "PGRME", "PASHR,", "GPXXX,1", "PSRF", "PUBX,03,1", "PTNL,PJK", "CCGPQ,GGA")
    track = read("\n".join([gga(), *(nmea(body) for body in bodies)]))
    assert len(track) == 1


SENTENCES = [
    gga(f"1047{k:02d}.00", lat=f"54{k:02d}.6081,N", talker=("GP", "GN", "GL")[k % 3])
    for k in range(6)
]


@given(st.integers(0, 5), st.integers(0, 200), st.integers(0, 255))
def test_a_corrupted_byte_is_never_used_silently(tmp_path_factory, which, place, byte):
    """Whatever one byte becomes, the positions that come out are true ones, and what is lost is counted."""
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
    assert np.allclose(track.points.lon, 10 + 49.4791 / 60, rtol=0, atol=1e-12)
    inside = SENTENCES[which].index("*") > at - begin > 0
    if changed and inside:
        assert which not in kept
    if len(kept) < 6:
        assert track.report.skipped


# GPX -----------------------------------------------------------------------------------------------------------------


def test_gpx_points_and_times(read):
    points = (
        f'<trkpt lat="33.{k}" lon="-44.5"><ele>3</ele><time>2026-03-01T12:00:0{k}Z</time></trkpt>'
        for k in range(4)
    )
    track = read(gpx(trk(*points)))
    assert track.source == "GPX"
    assert track.points.lat.tolist() == [33.0, 33.1, 33.2, 33.3]
    assert track.points.lon.tolist() == [-44.5] * 4
    assert track.t.tolist() == [0, 1, 2, 3]


def test_gpx_with_a_prefix_or_in_utf_16_or_of_version_1_0(read):
    prefixed = gpx(
        trk(GOOD),
        root='g:gpx version="1.1" creator="t" xmlns:g="http://www.topografix.com/GPX/1/1"',
    )
    for name in ("trkseg", "trkpt", "trk"):
        prefixed = (
            prefixed.replace(f"<{name} ", f"<g:{name} ")
            .replace(f"<{name}>", f"<g:{name}>")
            .replace(f"</{name}>", f"</g:{name}>")
        )
    old = gpx(
        trk(GOOD), root='gpx version="1.0" creator="t" xmlns="http://www.topografix.com/GPX/1/0"'
    )
    wide = gpx(trk(GOOD), head='<?xml version="1.0" encoding="utf-16"?>').encode("utf-16")
    for content in (prefixed, old, wide, gpx(trk(GOOD), root="gpx")):
        assert read(content).points.lat.tolist() == [33.27]


def test_routes_and_waypoints_are_read_where_there_is_no_track(read):
    rte, wpt = '<rte><rtept lat="1" lon="2"/></rte>', '<wpt lat="3" lon="4"/>'
    assert read(gpx(wpt + rte)).points.lat.tolist() == [1.0]
    assert read(gpx(wpt)).points.lat.tolist() == [3.0]
    track = read(gpx(wpt + "\n" + rte + "\n" + trk(GOOD)))
    assert track.points.lat.tolist() == [33.27]
    assert track.report.skipped["waypoint or route point beside the track"].count == 2


BAD_POINTS = {
    "latitude or longitude not a number": '<trkpt lat="NaN" lon="44"/>',
    "latitude not in -90 to 90": '<trkpt lat="90.001" lon="44"/>',
    "longitude not in -180 to 180": '<trkpt lat="33" lon="-181"/>',
    "point without a latitude or longitude": '<trkpt lon="44"/>',
}


@pytest.mark.parametrize("reason", BAD_POINTS)
def test_bad_points_of_gpx_are_counted_with_their_line(read, reason):
    track = read(
        gpx(trk(GOOD, BAD_POINTS[reason], BAD_POINTS[reason], '<trkpt lat="34" lon="45"/>'))
    )
    assert track.points.lat.tolist() == [33.27, 34.0]
    assert dict(track.report.skipped) == {reason: (2, 5)}


@pytest.mark.parametrize("text", ["abc", "", "inf", "3_3", "33,27"])
def test_a_number_that_is_none_is_not_used(read, text):
    track = read(gpx(trk(GOOD, f'<trkpt lat="{text}" lon="44"/>')))
    assert track.points.lat.tolist() == [33.27]
    assert dict(track.report.skipped) == {"latitude or longitude not a number": (1, 5)}


def test_an_unreadable_time_is_noted_and_its_position_used(read):
    track = read(gpx(trk(GOOD, '<trkpt lat="34" lon="45"><time>yesterday</time></trkpt>')))
    assert len(track) == 2
    assert np.isnan(track.t).all()
    assert dict(track.report.noted) == {"with an unreadable time": (1, 5)}
    assert "used, but: 1 with an unreadable time" in repr(track.report)


LAUGHS = (
    '<!DOCTYPE gpx [<!ENTITY a "ha">'
    + "".join(
        f'<!ENTITY {b} "{f"&{a};" * 10}">' for a, b in zip("abcdefgh", "bcdefghi", strict=True)
    )
    + "]>"
)
REFUSED = {
    "billion laughs": (gpx(trk(GOOD) + "<x>&i;</x>", head=LAUGHS), "document type or an entity"),
    "external entity": (
        gpx(
            trk(GOOD) + "<x>&e;</x>",
            head='<!DOCTYPE gpx [<!ENTITY e SYSTEM "file:///etc/passwd">]>',
        ),
        "document type",
    ),
    "external subset": (
        gpx(trk(GOOD), head='<!DOCTYPE gpx SYSTEM "http://localhost:9/x.dtd">'),
        "document type",
    ),
    "empty document type": (gpx(trk(GOOD), head="<!DOCTYPE gpx>"), "document type"),
    "KML": (
        '<kml xmlns="http://www.opengis.net/kml/2.2"><Placemark/></kml>',
        "it is a KML file, not a GPX file; export it as GPX$",
    ),
    "KML cut off": ("<kml><Placemark>", "it is a KML file, not a GPX file; export it as GPX$"),
    "TCX": ("<TrainingCenterDatabase/>", "it is a TCX file, not a GPX file; export it as GPX$"),
    "web page": (
        "<!DOCTYPE html>\n<html><body><br></body></html>",
        "it is a web page, not a GPX file$",
    ),
    "web page without a document type": ("<HTML><br></HTML>", "it is a web page, not a GPX file$"),
    "one element": ("<time>x</time>", "it is XML of the kind 'time', not a GPX file$"),
    "nested too deep": (
        gpx("<trk>" * 3000 + GOOD + "</trk>" * 3000),
        "its XML is nested too deep$",
    ),
    "cut off": (gpx(trk(GOOD))[:-20], "its XML is broken"),
    "no point": (gpx(""), "holds no position"),
    "only bad points": (
        gpx(trk('<trkpt lat="91" lon="0"/>')),
        r"1 latitude not in -90 to 90 \(first in line 4\)",
    ),
    "points outside a track": (gpx("<trk>" + GOOD + "</trk>"), "has 1 places <trkpt>, but only 0"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_gpx_that_is_refused_says_why(read, name):
    content, message = REFUSED[name]
    with pytest.raises(ValueError, match=message):
        read(content, "walk.gpx")


IDLE = {
    "height": ("<ele>abc</ele>", ""),
    "satellites": ("<sat>8.0</sat><fix>5d</fix>", ""),
    "number": ("", "<rte><number>a</number></rte>"),
    "bounds": ("", '<bounds minlat="x"/>'),  # where GPX 1.0 has them
    "deep extensions": ("<extensions>" + "<a>" * 3000 + "</a>" * 3000 + "</extensions>", ""),
    "spaces about the time": ("", ""),
}


@pytest.mark.parametrize(
    "root", ["gpx", 'gpx version="1.1" creator="t" xmlns="http://www.topografix.com/GPX/1/1"']
)
@pytest.mark.parametrize("name", IDLE)
def test_what_is_not_read_of_gpx_may_hold_anything(read, name, root):
    inner, outer = IDLE[name]
    space = "\n " if name == "spaces about the time" else ""
    point = f'<trkpt lat="33.27" lon="44.37"><time>{space}2026-03-01T12:00:00Z{space}</time>{inner}</trkpt>'
    track = read(
        gpx(
            outer + trk(point, point.replace("33.27", "34").replace("12:00:00", "12:00:05")),
            root=root,
        )
    )
    assert track.points.lat.tolist() == [33.27, 34.0]
    assert track.t.tolist() == [0.0, 5.0]
    assert repr(track.report) == "2 positions used"


# CSV -----------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "header",
    ["lat,lon", "Latitude,Longitude", " LAT , lng", "latitude;long", "lat\tlongitude", "n|lat|lon"],
)
def test_headers(read, header):
    delimiter = next(d for d in ",;\t|" if d in header)
    row = delimiter.join(["7", "33.25", "44.5"] if header[0] == "n" else ["33.25", "44.5"])
    track = read(f"\ufeff# a comment\n{header}\n{row}\n")
    assert (track.points.lat.tolist(), track.points.lon.tolist(), track.source) == (
        [33.25],
        [44.5],
        "CSV",
    )


def test_the_columns_may_stand_the_other_way_round(read):
    assert read("lon,lat\n44.5,33.25\n").points.lat.tolist() == [33.25]


@pytest.mark.parametrize(
    "times",
    [
        ("5", "6.5"),
        ("2026-03-01T12:00:00Z", "2026-03-01T13:00:01.5+01:00"),
        ("2026-03-01 12:00:00", "2026-03-01 12:00:01.5"),
    ],
)
def test_times_are_seconds_or_iso(read, times):
    track = read(
        "time,lat,lon\n" + "\n".join(f"{time},33,44.{k}" for k, time in enumerate(times)) + "\n"
    )
    assert track.t.tolist() == [0.0, 1.5]


@pytest.mark.parametrize(
    "content",
    [
        "lat;lon;t\n33,5;44,25;0,5\n-1,5;2;1,75\n",
        "lat\tlon\tt\n33,5\t44,25\t0\n-1,5\t2\t1,25\n",
        'lat,lon,t\n"33,5","44,25",0\n-1.5,2,1.25\n',
    ],
)
def test_decimal_commas(read, content):
    track = read(content)
    assert (track.points.lat.tolist(), track.points.lon.tolist(), track.t.tolist()) == (
        [33.5, -1.5],
        [44.25, 2.0],
        [0.0, 1.25],
    )


@pytest.mark.parametrize("cell", ["1,2,3", "1,234.5", "1.2,3", ",", "33,5 N"])
def test_a_cell_of_more_than_a_decimal_comma_is_no_number(read, cell):
    assert dict(read(f"lat;lon\n{cell};44\n1;2\n").report.skipped) == {
        "latitude or longitude not a number": (1, 2)
    }


WIDE = {"UTF-8 with its mark": "utf-8-sig", "UTF-16": "utf-16", "UTF-16, big-endian": "utf-16-be"}
TEXTS = {
    "NMEA": gga(lat="3330.0000,N", lon="04415.0000,E") + "\r\n",
    "CSV": "lat,lon\r\n33.5,44.25\r\n",
    "GeoJSON": '{"type": "Point", "coordinates": [44.25, 33.5]}\r\n',
    "GPX": '<gpx><wpt lat="33.5" lon="44.25"/></gpx>',
}


@pytest.mark.parametrize("code", WIDE)
@pytest.mark.parametrize("source", TEXTS)
def test_text_as_windows_writes_it(read, source, code):
    track = read(
        (b"\xfe\xff" if code == "UTF-16, big-endian" else b"") + TEXTS[source].encode(WIDE[code])
    )
    assert (track.source, track.points.lat.tolist(), track.points.lon.tolist()) == (
        source,
        [33.5],
        [44.25],
    )
    assert repr(track.report) == "1 position used"


def test_the_first_sentence_after_nothing_but_zero_bytes_is_read(read):
    assert len(read(b"\x00\x00" + gga().encode())) == 1


def test_blank_lines_cost_no_time(read):
    begin = process_time()
    assert len(read("lat,lon\n1,2\n" + "\n" * 50_000)) == 1
    assert process_time() - begin < 1.5  # with a pattern that runs on over lines 5 s and more


BAD_ROWS = {
    "latitude not in -90 to 90": "1,91,44",
    "longitude not in -180 to 180": "1,33,200",
    "latitude or longitude not a number": "1,33.27 N,44",
    "row with more or fewer cells than the header": "1,33,27,44,37",  # decimal commas
    "row with a cell over several lines": '"1\n2",33,44',
    "same epoch again": "0,33.0,44.0",
    "time runs backwards": "-1,33.0,44.0",
    "comment": "# 1,33,44",
}


@pytest.mark.parametrize("reason", BAD_ROWS)
def test_bad_rows_are_counted_with_their_line(read, reason):
    track = read(f"time,lat,lon\n\n0,33.0,44.0\n{BAD_ROWS[reason]}\n2,34.0,45.0\n")
    assert track.points.lat.tolist() == [33.0, 34.0]
    assert dict(track.report.skipped) == {reason: (1, 4)}


@pytest.mark.parametrize(
    "row", ["33", "33,", ",44", "nan,44", "NaN,NaN", "inf,44", "1_0,44", "33 44"]
)
def test_rows_that_are_cut_or_no_numbers(read, row):
    assert read(f"lat,lon\n{row}\n1,2\n").points.lat.tolist() == [1.0]


def test_milliseconds_are_no_seconds_and_a_cut_last_line_is_told(read):
    track = read("lat,lon,t\n1,2,1767225600000\n3,4,5")
    assert dict(track.report.noted) == {
        "with an unreadable time": (1, 2),
        "in a last line without an end, which may be cut off": (1, 3),
    }
    assert np.isnan(track.t[0])


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("", "the file is empty"),
        (" \n\r\n", "the file is empty"),
        (b"\xff\xfe", "the file is empty"),
        (b"\x00" * 200_000, "it is no NMEA, GPX or GeoJSON, and as a table"),
        (
            b"x" * 200_000,
            "it is no NMEA, GPX or GeoJSON, and as a table its first line 'x{80}' does not name",
        ),
        ("var data=" + "1," * 100_000, "it is no NMEA, GPX or GeoJSON, and as a table"),
        ("lat,lon\n1," + "2" * 200_000, "its table is broken"),
        ("# lat,lon\n", "no header"),
        ("x,y\n1,2\n", r"'x,y' does not name one of \['lat', 'latitude'\]"),
        ("lat,y\n1,2\n", r"does not name .*'long'"),
        ("lat,latitude,lon\n1,1,2\n", r"more than one column of \['lat', 'latitude'\]"),
        ("lat,lon\n", "it is CSV, but holds no position"),
        ("lat,lon\n95,2\n", r"1 latitude not in -90 to 90 \(first in line 2\)"),
        ('lat,lon\n1,2\n"3,4\n', "its table is broken"),
        (b"\x89PNG\r\n\x1a\n\x00\x00", "does not name"),
        (gga(quality=0), r"it is NMEA, but 1 sentence without a fix"),
        ('{"type": "Polygon"}', "no GeoJSON of points or lines, but of the kind 'Polygon'"),
        ('{"type": "Point", "coordinates": [200, 91]}', "1 latitude not in -90 to 90"),
        (
            '{"type": "LineString", "coordinates": [[1, "2"], [true, 2], 3, [1e999, 0]]}',
            "3 position that is no pair of numbers",
        ),
        (
            '{"type": "Point", "coordinates": [1, 2], "crs": {"properties": {"name": "urn:ogc:def:crs:EPSG::3857"}}}',
            "not degrees",
        ),
        ('{"type": "Point", "coordinates": [1', "its JSON is not read"),
        ("[" * 100_000, "its JSON is not read"),
    ],
)
def test_a_file_without_a_position_says_why(read, content, message):
    with pytest.raises(ValueError, match=message) as error:
        read(content)
    assert "file.txt" in str(error.value)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(FileNotFoundError):
        wmr.read_track(tmp_path / "none.gpx")


SEEDS = [
    LOG.read_bytes()[:3000],
    gpx(trk(GOOD, GOOD)).encode(),
    b"lat,lon,t\n1,2,3\n4,5,6\n",
    b'{"type":"LineString","coordinates":[[1,2],[3,4]]}',
]


@pytest.mark.parametrize("seed", range(len(SEEDS)))
def test_whatever_a_file_holds_it_is_read_or_refused(read, seed):
    """Damaged files raise ValueError and nothing else, and never bring a position that is none."""
    draw, refused = random.Random(seed), 0
    for _ in range(300):
        data = bytearray(SEEDS[seed])
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


# What a file gives ---------------------------------------------------------------------------------------------------


def test_a_track_cannot_be_changed():
    track = wmr.read_track(LOG)
    for values in (track.points.lat, track.points.lon, track.t):
        with pytest.raises(ValueError, match="read-only"):
            values[0] = 0.0
    with pytest.raises(TypeError):
        track.report.skipped["comment"] = Count(0, 0)
    assert repr(track) == "<Track: 9 positions from NMEA, over 8 s; 77 not used>"
    assert repr(Report(1, {})) == "1 position used"


# A receiver that stands still ----------------------------------------------------------------------------------------


def test_scatter_of_the_log_against_the_ellipsoid():
    track = wmr.read_track(LOG)
    found = wmr.stationary_scatter(track)
    assert found.mean == track.mean
    lines = [
        Geodesic.WGS84.Inverse(found.mean.lat, found.mean.lon, lat, lon)
        for lat, lon in zip(track.points.lat, track.points.lon, strict=True)
    ]
    east = np.array([line["s12"] * math.sin(math.radians(line["azi1"])) for line in lines])
    north = np.array([line["s12"] * math.cos(math.radians(line["azi1"])) for line in lines])
    assert found.std_east == pytest.approx(east.std(ddof=1), rel=0.0057)
    assert found.std_north == pytest.approx(north.std(ddof=1), rel=0.0057)
    assert found.covariance[0, 1] == pytest.approx(np.cov(east, north)[0, 1], rel=0.012)
    assert (found.east[-1] > 2, found.north[-1] > 0.5) == (True, True)
    assert found.cep == pytest.approx(np.median(np.hypot(east, north)), rel=0.0057)
    assert found.two_drms == pytest.approx(2 * math.hypot(found.std_east, found.std_north))
    assert repr(found).startswith(
        "<StationaryScatter: 9 positions about 54.0934728 deg N, 10.8247669 deg E; std 3.55 m east, 0.444 m north"
    )


CENTRES = {
    "paper": (33.27, 44.37),
    "date line": (10.0, 180.0),
    "other side": (-40.0, -180.0),
    "pole": (90.0, 0.0),
    "south pole": (-90.0, 70.0),
}


@pytest.mark.parametrize("name", CENTRES)
def test_mean_and_scatter_anywhere(name):
    """Positions laid about a centre with a known mean and scatter, over the date line and over the poles."""
    centre = wmr.GeoPoint(lat=CENTRES[name][0], lon=CENTRES[name][1])
    rng = np.random.default_rng(9)
    east, north = rng.normal(0, 3, 400), rng.normal(0, 1, 400)
    east, north = east - east.mean(), north - north.mean()
    found = wmr.stationary_scatter(wmr.point_at(centre, east, north))
    assert wmr.haversine_distance(found.mean, centre) < 1e-6
    assert math.hypot(found.std_east, found.std_north) == pytest.approx(
        math.hypot(east.std(ddof=1), north.std(ddof=1)), rel=1e-6
    )
    if "pole" not in name:  # there east depends on the longitude of the mean
        assert found.std_east == pytest.approx(east.std(ddof=1), rel=1e-6)
        assert found.covariance[0, 1] == pytest.approx(np.cov(east, north)[0, 1], abs=1e-6)
    assert abs(found.east.mean()) < 1e-6
    assert abs(found.north.mean()) < 1e-6


def test_the_mean_of_positions_far_apart_is_the_middle_of_their_frame():
    far = wmr.GeoPoint(lat=[60.0, 62.0, 40.0], lon=[170.0, -165.0, 179.0])
    mean = wmr.stationary_scatter(far).mean
    east, north = wmr.local_position(mean, far)
    assert (abs(east.mean()) < 1e-6, abs(north.mean()) < 1e-6) == (True, True)
    assert np.ptp(east) > 1e6


def test_half_the_positions_are_within_the_cep_and_nearly_all_within_2drms():
    rng = np.random.default_rng(1)
    found = wmr.stationary_scatter(
        wmr.point_at(wmr.paper.GPS_POINT_1, rng.normal(0, 2, 20_000), rng.normal(0, 2, 20_000))
    )
    assert found.cep == pytest.approx(2 * math.sqrt(2 * math.log(2)), rel=0.02)  # Rayleigh's median
    assert np.mean(np.hypot(found.east, found.north) < found.two_drms) == pytest.approx(
        1 - math.exp(-4), abs=0.003
    )


def test_standing_refuses_what_has_no_scatter():
    with pytest.raises(ValueError, match="track has 1 position"):
        wmr.stationary_scatter(wmr.GeoPoint(lat=[1.0], lon=[2.0]))
    with pytest.raises(ValueError, match="all over the Earth"):
        wmr.stationary_scatter(wmr.GeoPoint(lat=[0.0, 0.0], lon=[0.0, 180.0]))
    with pytest.raises(ValueError, match="a GeoPoint is needed, not a list"):
        wmr.stationary_scatter([1.0, 2.0])


# And back ------------------------------------------------------------------------------------------------------------

WAYS = {"gpx": wmr.write_gpx, "geojson": wmr.write_geojson}
paths = st.tuples(
    st.floats(-89.9, 89.9),
    st.sampled_from([0.0, 44.37, 179.9999, -179.9999, 180.0, -180.0]),
    st.integers(1, 12),
    st.integers(0, 2**32),
)


@pytest.mark.parametrize("kind", WAYS)
@given(paths)
def test_a_path_comes_back(kind, tmp_path_factory, path):
    """Within half of the last of seven decimals, over the date line too; nothing is added and nothing is lost."""
    lat, lon, n, seed = path
    rng = np.random.default_rng(seed)
    there = wmr.point_at(wmr.GeoPoint(lat=lat, lon=lon), rng.normal(0, 30, n), rng.normal(0, 30, n))
    file = tmp_path_factory.getbasetemp() / f"path.{kind}"
    WAYS[kind](file, there)
    back = wmr.read_track(file)
    assert len(back) == n
    assert np.abs(back.points.lat - there.lat).max() <= 0.5001e-7
    assert np.abs((back.points.lon - there.lon + 180) % 360 - 180).max() <= 0.5001e-7


def test_a_driven_run_comes_back_with_its_times(tmp_path):
    case = wmr.paper.outdoor()
    run = wmr.simulate(case.start, case.goal, case.gains, method="continuous")
    points = wmr.point_at(wmr.paper.GPS_POINT_1, run.x, run.y)
    wmr.write_gpx(tmp_path / "run.gpx", points, t=run.t, begin=BEGIN)
    back = wmr.read_track(tmp_path / "run.gpx")
    assert np.abs(back.t - run.t).max() < 1e-6
    assert (
        wmr.haversine_distance(
            wmr.GeoPoint(lat=back.points.lat[-1], lon=back.points.lon[-1]), wmr.paper.GPS_POINT_2
        )
        < 0.07
    )
    east, north = wmr.local_position(wmr.paper.GPS_POINT_1, back.points)
    assert np.hypot(east - run.x, north - run.y).max() < 0.01
    assert not back.report.skipped


def test_gpx_1_1_as_its_schema_asks(tmp_path):
    """Names, order, attributes and the range of values of the schema http://www.topografix.com/GPX/1/1/gpx.xsd."""
    points = wmr.GeoPoint(lat=[0.0, 1e-7, -1e-7, 5.0], lon=[179.9999999, 180.0, -180.0, -1e-7])
    wmr.write_gpx(
        tmp_path / "a.gpx",
        points,
        t=[0, 0.25, math.nan, 2],
        begin=BEGIN,
        name="<b> & \"c\" 'd' é بغداد",
    )
    root = ElementTree.parse(tmp_path / "a.gpx").getroot()
    assert root.tag == GPX_11 + "gpx"
    assert root.attrib["version"] == "1.1"
    assert root.attrib["creator"] == "wmrlib"
    (track,) = root
    name, *segments = track
    assert (track.tag, name.tag, {s.tag for s in segments}) == (
        GPX_11 + "trk",
        GPX_11 + "name",
        {GPX_11 + "trkseg"},
    )
    assert name.text == "<b> & \"c\" 'd' é بغداد"
    assert [len(segment) for segment in segments] == [1, 3]
    places = [point for segment in segments for point in segment]
    assert [point.attrib for point in places] == [
        {"lat": "0", "lon": "179.9999999"},
        {"lat": "0.0000001", "lon": "-180.0"},
        {"lat": "-0.0000001", "lon": "-180.0"},
        {"lat": "5.0", "lon": "-0.0000001"},
    ]
    assert all([child.tag for child in point] in ([GPX_11 + "time"], []) for point in places)
    times = [point.findtext(GPX_11 + "time") for point in places]
    assert times == [
        "2026-03-01T12:00:00Z",
        "2026-03-01T12:00:00.250000Z",
        None,
        "2026-03-01T12:00:02Z",
    ]


def test_geojson_is_longitude_first_and_cut_at_the_date_line(tmp_path):
    wmr.write_geojson(
        tmp_path / "a.json",
        wmr.GeoPoint(lat=[10.0, 11.0, 12.0], lon=[179.0, -179.0, -178.0]),
        name='"q"',
    )
    feature = json.loads((tmp_path / "a.json").read_text(encoding="utf-8"))
    assert feature["type"] == "Feature"
    assert feature["properties"] == {"name": '"q"'}
    assert feature["geometry"] == {
        "type": "MultiLineString",
        "coordinates": [
            [[179.0, 10.0], [180.0, 10.5]],
            [[-180.0, 10.5], [-179.0, 11.0], [-178.0, 12.0]],
        ],
    }
    track = wmr.read_track(tmp_path / "a.json")
    assert track.points.lat.tolist() == [10.0, 11.0, 12.0]
    assert dict(track.report.skipped) == {"cut at the date line": (2, 2)}
    wmr.write_geojson(tmp_path / "b.json", wmr.GeoPoint(lat=33.5, lon=44.25))
    assert json.loads((tmp_path / "b.json").read_text())["geometry"] == {
        "type": "Point",
        "coordinates": [44.25, 33.5],
    }


@pytest.mark.parametrize("kind", ["Point", "MultiPoint"])
def test_points_at_the_date_line_are_no_cut(read, kind):
    ends = [[[180.0, 10.0]], [[-180.0, 10.0]]]
    points = [{"type": kind, "coordinates": end[0] if kind == "Point" else end} for end in ends]
    track = read(json.dumps({"type": "GeometryCollection", "geometries": points}))
    assert track.points.lon.tolist() == [180.0, -180.0]
    track = read(json.dumps({"type": "MultiPoint", "coordinates": [[180.0, 10.0], [-180.0, 10.0]]}))
    assert track.points.lon.tolist() == [180.0, -180.0]


def test_geojson_collections(read):
    line = {"type": "LineString", "coordinates": [[1.5, 2.5, 30], [3, 4]]}
    features = [
        {"type": "Feature", "geometry": g}
        for g in (
            line,
            None,
            {
                "type": "GeometryCollection",
                "geometries": [{"type": "Point", "coordinates": [5, 6]}],
            },
        )
    ]
    track = read(json.dumps({"type": "FeatureCollection", "features": features}))
    assert (track.points.lon.tolist(), track.points.lat.tolist()) == (
        [1.5, 3.0, 5.0],
        [2.5, 4.0, 6.0],
    )


class SummerTime(tzinfo):
    """Central Europe in March 2026, where 2:00 on the 29th is 3:00."""

    def dst(self, time):
        return timedelta(hours=1 if time.replace(tzinfo=None) >= datetime(2026, 3, 29, 2) else 0)

    def utcoffset(self, time):
        return timedelta(hours=1) + self.dst(time)


PAIR = wmr.GeoPoint(lat=[1.0, 2.0], lon=[3.0, 4.0])


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda p: wmr.write_gpx(p, wmr.GeoPoint(lat=[], lon=[])),
            "at least one position is needed",
        ),
        (lambda p: wmr.write_gpx(p, [1, 2]), "a GeoPoint is needed"),
        (lambda p: wmr.write_gpx(p, PAIR, t=[0, 1]), "begin = None are not allowed together"),
        (
            lambda p: wmr.write_gpx(p, PAIR, t=[0, 1, 2], begin=BEGIN),
            r"t has shape \(3,\), points have shape \(2,\)",
        ),
        (
            lambda p: wmr.write_gpx(p, PAIR, t=[0, math.inf], begin=BEGIN),
            "a finite number or NaN is needed",
        ),
        (
            lambda p: wmr.write_gpx(p, PAIR, t=["a", "b"], begin=BEGIN),
            r"^t = \['a', 'b'\] is not allowed",
        ),
        (lambda p: wmr.write_gpx(p, PAIR, t={}, begin=BEGIN), r"^t = {} is not allowed"),
        (
            lambda p: wmr.write_gpx(p, PAIR, t=[True, False], begin=BEGIN),
            r"^t = \[True, False\] is not allowed",
        ),
        (
            lambda p: wmr.write_gpx(p, PAIR, t=[0, 1e18], begin=BEGIN),
            r"^t = 1e\+18 is not allowed: begin \+ t in the years 1 to 9999",
        ),
        (
            lambda p: wmr.write_gpx(p, PAIR, t=[0, 1], begin=datetime.max.replace(tzinfo=UTC)),
            r"^t = 1 is not allowed: begin \+ t",
        ),
        (
            lambda p: wmr.write_gpx(p, PAIR, t=[0, 1], begin=BEGIN.replace(tzinfo=None)),
            "with its time zone is needed",
        ),
        (lambda p: wmr.write_gpx(p, PAIR, name="a\x00b"), "without control characters"),
        (
            lambda p: wmr.write_gpx(p, PAIR, name="\ud800"),
            r"^name = '\\ud800' is not allowed: a text that UTF-8 can hold is needed$",
        ),
        (
            lambda p: wmr.write_geojson(p, PAIR, name="\ud800"),
            r"^name = '\\ud800' is not allowed: a text that UTF-8 can hold is needed$",
        ),
        (lambda p: wmr.write_geojson(p, PAIR, name=3), "a str is needed"),
    ],
)
def test_bad_input_to_the_writers(tmp_path, make, message):
    (tmp_path / "x").write_text("as it was")
    for path in (tmp_path / "x", tmp_path / "y"):
        with pytest.raises(ValueError, match=message):
            make(path)
    assert (tmp_path / "x").read_text() == "as it was"
    assert not (tmp_path / "y").exists()


def test_times_are_counted_from_begin_in_any_zone(tmp_path, read):
    begin = BEGIN.astimezone(None) + timedelta(seconds=1)
    wmr.write_gpx(tmp_path / "a.gpx", PAIR, t=[0, 3], begin=begin)
    assert wmr.read_track(tmp_path / "a.gpx").t.tolist() == [0.0, 3.0]


def test_times_are_counted_on_while_the_clocks_are_put_forward(tmp_path):
    begin = datetime(2026, 3, 29, 1, 30, tzinfo=SummerTime())
    wmr.write_gpx(tmp_path / "a.gpx", PAIR, t=[0, 3600], begin=begin)
    assert [time.text for time in ElementTree.parse(tmp_path / "a.gpx").iter(GPX_11 + "time")] == [
        "2026-03-29T00:30:00Z",
        "2026-03-29T01:30:00Z",
    ]


def test_a_single_position_may_have_a_single_time(tmp_path):
    wmr.write_gpx(tmp_path / "a.gpx", wmr.GeoPoint(lat=1.0, lon=2.0), t=0.5, begin=BEGIN)
    assert (
        ElementTree.parse(tmp_path / "a.gpx").find(f".//{GPX_11}time").text
        == "2026-03-01T12:00:00.500000Z"
    )
