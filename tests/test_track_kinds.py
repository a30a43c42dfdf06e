"""Logs that mislead: a property for each kind, of whatever example."""

import json
import math
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from test_tracks import gga, gpx, nmea_row, trk
from test_ubx import pvt

import wmrlib as wmr
from wmrbook.scatter import stationary_scatter
from wmrlib.tracks import Report, Track
from wmrlib.tracks.fixes import Reported
from wmrrobot.exports import along, at_rest
from wmrrobot.sheets import Robot

BEGIN = datetime(2026, 3, 1, 12, 0, 0, tzinfo=UTC)
few = settings.get_profile("few")


def iso(second):
    return (BEGIN + timedelta(seconds=second)).isoformat().replace("+00:00", "Z")


def remarks(track):
    return {**track.report.skipped, **track.report.noted}


# One value of a name, and one name of a value

PLACES = {
    "own": "{}",
    "extension": "<extensions>{}</extensions>",
    "deep": "<extensions><x:E><x:F>{}</x:F></x:E></extensions>",
}
ELEMENT = st.tuples(st.sampled_from(list(PLACES)), st.integers(1, 30), st.booleans())


@few
@given(st.sampled_from(["speed", "sat", "hdop"]), st.lists(ELEMENT, min_size=1, max_size=4))
def test_elements_of_one_name_are_never_joined(read, name, elements):
    inner = "".join(
        PLACES[place].format(f"<x:{name}>{str(value)[:1]}<!-- -->{str(value)[1:]}</x:{name}>"
                             if split else f"<{name}>{value}</{name}>")
        for place, value, split in elements
    )  # fmt: skip
    track = read(gpx(trk(f'<trkpt lat="1" lon="2">{inner}</trkpt>')))
    first = min(elements, key=lambda element: element[0] != "own")
    field = {"sat": "satellites"}.get(name, name)
    assert getattr(track, field).tolist() == [first[1]]
    differ = len({value for _, value, _ in elements}) > 1
    assert [*track.report.noted] == [f"with two values of {field}"] * differ


def test_elements_within_an_element_are_not_its_text(read):
    inner = "<speed>2<x:u>5</x:u>1</speed><extensions><speed>3</speed></extensions>"
    track = read(gpx(trk(f'<trkpt lat="1" lon="2">{inner}</trkpt>')))
    assert track.speed.tolist() == [3.0]


# A position among its neighbours

STRAYS = (
    "newest first",
    "newest first, one twice",
    "unset",
    "null island",
    "far",
    "date",
    "date back",
    "same time",
    "twice",
    "late",
)


def rest(n):
    """Fixes of a receiver at rest, a second apart: second, latitude, longitude."""
    east, north = np.random.default_rng(n).normal(0, 0.3, (2, n))
    points = wmr.point_at(wmr.GeoPoint(lat=33.27, lon=44.37), east, north)
    return [*zip(range(n), points.lat.tolist(), points.lon.tolist(), strict=True)]


def spoilt(rows, kind, k, size):
    """The same log with something of a kind at row k."""
    second, lat, lon = rows[k]
    stray = {
        "null island": (second + 0.5, 0.0, 0.0),
        "far": (second + 0.5, lat - size, lon),
        "same time": (second, lat, lon),
        "late": (second - max(1.5, 86.4 * size), lat, lon),
    }
    if kind.startswith("newest first"):
        return [*rows[: k + 1], *rows[k + ("twice" not in kind) :]][::-1]
    if kind == "unset":  # its t is not known, but its place is
        return [(-1.4e9 - size * 86400 + row[0], *row[1:]) for row in rows[:k]] + rows[k:]
    if kind in ("date", "date back"):
        step = 86400 * math.ceil(size) * (1 if kind == "date" else -1)
        return rows[:k] + [(second + step, lat, lon) for second, lat, lon in rows[k:]]
    return rows * 2 if kind == "twice" else [*rows[: k + 1], stray[kind], *rows[k + 1 :]]


@pytest.mark.parametrize("kind", STRAYS)
@settings(few, max_examples=4)
@given(st.integers(20, 60), st.integers(0), st.floats(0.01, 20.0), st.booleans())
def test_what_does_not_fit_its_neighbours_spoils_nothing(read, kind, n, k, size, as_gpx):
    rows = rest(n)
    changed = spoilt(rows, kind, k % n or 1, size)
    if as_gpx:
        points = (f'<trkpt lat="{lat}" lon="{lon}"><time>{iso(second)}</time></trkpt>'
                  for second, lat, lon in changed)  # fmt: skip
        track = read(gpx(trk(*points)))
    else:
        track = read(["lat,lon,t", *(f"{lat},{lon},{second}" for second, lat, lon in changed), ""])
    unset = k % n or 1 if kind == "unset" else 0
    seconds = [*[math.nan] * unset, *range(n - unset)]
    np.testing.assert_allclose(track.t, seconds, atol=1e-6)
    assert track.points.lat.tolist() == [lat for _, lat, _ in rows]
    assert remarks(track)
    clean = np.array([[lat, lon] for _, lat, lon in rows]) - rows[0][1:]
    expected = np.sqrt(np.mean(np.var(clean * [111195, 111195 * math.cos(0.5807)], axis=0)))
    assert at_rest(Robot(), track).sigma == pytest.approx(expected, rel=1e-3)
    assert along(Robot(), track).start_lat == rows[0][1]


def walk(n, speed=1.4):
    """Fixes of a walk to the north, one a second: second, latitude, longitude."""
    return [(k, 33.27 + k * speed / 111195, 44.37) for k in range(n)]


def written(kind, rows):
    """The rows as GPX or as a table."""
    if kind == "CSV":
        return "\n".join(["time,lat,lon", *(f"{iso(s)},{lat},{lon}" for s, lat, lon in rows), ""])
    return gpx(trk(*(f'<trkpt lat="{lat}" lon="{lon}"><time>{iso(second)}</time></trkpt>'
                     for second, lat, lon in rows)))  # fmt: skip


@few
@given(
    st.sampled_from(["CSV", "GPX"]), st.sampled_from([rest, walk]), st.integers(5, 200),
    st.integers(0, 59), st.booleans(),
)  # fmt: skip
def test_a_clock_that_shows_minutes_or_stands_costs_no_position(read, kind, log, n, begin, stands):
    rows = log(n)
    minutes = [0 if stands else (begin + k) // 60 for k in range(n)]
    assume(4 * len({*minutes}) <= n)
    pairs = zip(minutes, rows, strict=True)
    track = read(written(kind, [(60 * minute, *row[1:]) for minute, row in pairs]))
    assert track.points.lat.tolist() == [lat for _, lat, _ in rows]
    first = [minute not in minutes[:k] for k, minute in enumerate(minutes)]
    np.testing.assert_array_equal(track.t, np.where(first, np.multiply(minutes, 60.0), math.nan))
    assert [*remarks(track)] == ["with the time of the one before, which t leaves out"]


@few
@given(st.integers(2, 40), st.lists(st.tuples(st.integers(0, 39), st.integers(0, 39)), max_size=3))
def test_a_position_is_read_once_though_another_segment_has_it_too(read, n, others):
    """As of a receiver that exports its active log and the same drive, saved."""
    parts = [range(n), *(range(min(ends), min(n, max(ends))) for ends in others)]
    segments = [trk(*(f'<trkpt lat="{33 + k * 1e-5:.5f}" lon="44.5"><time>{iso(k)}</time></trkpt>'
                      for k in part)) for part in parts]  # fmt: skip
    track = read(gpx("".join(segments)))
    assert track.t.tolist() == [*range(n)]
    again = sum(map(len, parts[1:]))
    assert sum(count for count, _ in remarks(track).values()) == again


OFFSETS = st.tuples(st.floats(-30, 30), st.floats(0.01, 0.99), st.booleans(), st.booleans())


@few
@given(st.sampled_from(["gpsd", "device", "ArduPilot"]), st.sampled_from([rest, walk]), OFFSETS)
def test_of_several_receivers_with_names_one_is_used(read, kind, log, offsets):
    """The one that is trusted more, or else the one with more positions, or the first."""
    metres, later, better, first = offsets
    north = metres / 111195
    lines = []
    for second, lat, lon in log(30):
        pair = [(second, lat, "A", 3 if better else 1),
                (second + later, lat + north, "B", 1)]  # fmt: skip
        for t, y, name, quality in pair if first or not better else pair[::-1]:
            if kind == "gpsd":
                lines.append(json.dumps(
                    {"class": "TPV", "mode": 3, "status": quality, "time": iso(t), "lat": y,
                     "lon": lon, "device": name}))  # fmt: skip
            elif kind == "device":
                lines.append(f"{iso(t)},{y},{lon},{name},{'RTK' if quality == 3 else 'SPS'}")
            else:
                lines.append(f"{1e6 * (t + 9)},{'AB'.index(name)},{2 * quality},7,7,{y},{lon}")
    head = {"device": ["time,lat,lon,Device ID,quality"],
            "ArduPilot": ["TimeUS,I,Status,GMS,GWk,Lat,Lng"]}.get(kind, [])  # fmt: skip
    track = read([*head, *lines, ""])
    assert track.points.lat.tolist() == [lat for _, lat, _ in log(30)]
    np.testing.assert_allclose(track.t, np.arange(30.0), atol=1e-6)
    assert [*track.report.skipped] == ["position of another receiver"]


@few
@given(st.lists(st.integers(0, 99), max_size=3))
def test_a_receiver_that_is_plugged_in_again_is_the_same(read, at):
    """By another name, as /dev/ttyACM1 after /dev/ttyACM0."""
    rows = [
        f"{lat},{lon},{second},ACM{sum(second > k for k in at)}" for second, lat, lon in walk(100)
    ]
    track = read(["lat,lon,t,device", *rows, ""])
    assert (track.t.tolist(), remarks(track)) == ([*range(100)], {})


@few
@given(st.integers(-90, 90))
def test_segments_whose_times_overlap_are_noted(read, later):
    """Two receivers, or two drives in another order: t does not increase where one begins."""
    segments = [
        trk(*(f'<trkpt lat="{lat}" lon="44.5"><time>{iso(k + later * part)}</time></trkpt>'
              for k, lat, _ in walk(30, 1.0 + part))) for part in (0, 1)
    ]  # fmt: skip
    track = read(gpx("".join(segments)))
    note = {"where a segment begins before the end of the one before": 1} if later < 30 else {}
    assert {reason: row.count for reason, row in track.report.noted.items()} == note


@few
@given(st.sampled_from([rest, walk]), st.integers(20, 60), st.floats(5, 30), st.floats(0.01, 0.99))
def test_of_two_receivers_without_names_the_report_tells(read, log, n, metres, later):
    """At rest, and on a walk: there is no telling whose a position is."""
    note = "in a file that alternates between two receivers, perhaps"
    rows = log(n)
    second = [(s + later, lat, lon + metres / 92960) for s, lat, lon in rows]
    both = [row for pair in zip(rows, second, strict=True) for row in pair]
    assert note in remarks(read(written("GPX", both)))
    assert remarks(read(written("GPX", rows))) == {}
    cells = np.random.default_rng(n).integers(0, 2, n) * 1e-4  # of an app that rounds
    rounded = [(s, lat + cell, lon) for (s, lat, lon), cell in zip(rows, cells, strict=True)]
    assert note not in remarks(read(written("GPX", rounded)))


@few
@given(st.integers(20, 60), st.lists(st.floats(1.0, 160.0), min_size=1, max_size=4), st.integers(0))
def test_strays_without_a_time_do_not_count_at_rest(n, sizes, seed):
    """Times tell nothing here: strays are known by their distance from the others alone."""
    rows = rest(n)
    lat, lon = (np.array([row[k] for row in rows]) for k in (1, 2))
    clean = stationary_scatter(wmr.GeoPoint(lat=lat, lon=lon))
    at = np.random.default_rng(seed).integers(0, n, len(sizes))
    lat, lon = np.insert(lat, at, 33.27), np.insert(lon, at, 44.37 - np.array(sizes))
    scatter = stationary_scatter(wmr.GeoPoint(lat=lat, lon=lon))
    assert (scatter.n, scatter.left_out, clean.left_out) == (n, len(sizes), 0)
    assert scatter.std_east == pytest.approx(clean.std_east)
    assert f"{n} positions ({len(sizes)} left out) about" in repr(scatter)


def test_times_that_are_right_are_left_alone(read):
    """A fix a day, an hour's fixes with a day missing, a night, a trip from (0, 0), a flight."""
    day, hour = 86400, 3600
    for seconds in ([0, day + 1, 2 * day, 3 * day + 2], [0, hour, 2 * hour, day + 3 * hour],
                    [0, 1, 2, 9 * hour, 9 * hour + 1]):  # fmt: skip
        track = read(["lat,lon,t", *(f"1,2,{second}" for second in seconds), ""])
        assert (track.t.tolist(), remarks(track)) == (seconds, {})
    track = read("lat,lon,t\n1,2,0\n1,2,1\n1,2,90000\n")
    assert track.t.tolist() == [0, 1, 90000]
    assert dict(remarks(track)) == {"after more than a day without a position": (1, 4)}
    east = np.arange(10.0)
    points = wmr.point_at(wmr.GeoPoint(lat=0.0, lon=0.0), east, 0.0 * east)
    rows = zip(points.lat, points.lon, strict=True)
    assert len(read(["lat,lon", *(f"{lat},{lon}" for lat, lon in rows), ""])) == 10
    flight = [f"{lat},2,{second}" for second, lat in enumerate(np.arange(0, 0.1, 0.0025))]
    assert remarks(read(["lat,lon,t", *flight, ""])) == {}


def test_many_steps_that_no_vehicle_makes_are_noted_and_kept(read):
    """The unit of time is wrong, perhaps."""
    track = read(["lat,lon,t", *(f"{k},2,{k}" for k in range(8)), ""])
    assert len(track) == 8
    assert dict(track.report.noted) == {"at a place that no vehicle reaches in the time": (7, 3)}
    assert "over 7 s; 0 not used, 1 note in its report>" in repr(track)


# Columns

CLOCKS = {  # of second k: as good as the others, or not to be read
    "time": lambda k: iso(k),
    "utc time": lambda k: iso(k)[:-1].replace("T", " ") + " UTC",
    "timestamp_ms": lambda k: f"{1772366400000 + 1000 * k}",
    "seconds_elapsed": lambda k: f"{k + 0.25}",
    "Local time": lambda k: (BEGIN + timedelta(hours=3, seconds=k)).isoformat(),
    "timestamp": lambda k: f"{1772366400 + k}",
    "Time of day": lambda k: f"{k} o'clock",
    "date": lambda k: "2026-03-01",
}
UNREADABLE = {"timestamp", "Time of day", "date"}


@few
@given(st.permutations([*CLOCKS]), st.integers(1, 4), st.integers(0, 4))
def test_the_best_of_several_columns_is_read(read, names, times, before):
    names = names[:times]
    header = [*names[:before], "lat", "lon", "latitude", "longitude", *names[before:]]
    rows = [
        [CLOCKS[name](k) if name in CLOCKS else f"{k + 3.5}e-5" for name in header]
        for k in range(5)
    ]
    track = read("\n".join(",".join(row) for row in [header, *rows, []]))
    noted = " ".join(track.report.noted)
    assert "without their 'latitude' beside 'lat'" in noted
    readable = [name for name in names if name not in UNREADABLE]
    assert np.isnan(track.t).all() == (not readable)
    if readable:
        assert track.t.tolist() == [0, 1, 2, 3, 4]
        assert "unreadable" not in noted
    else:
        assert any(f"in column '{name}'" in noted for name in names)


def test_the_best_column_can_be_read_tells_most_and_comes_with_its_twin(read):
    track = read("timestamp,Local time,lat,lon\n1772366400,2026-03-01 12:00:00,1,2\n")
    assert track.t.tolist() == [0.0]  # a number without a unit is none
    track = read(f"name,lat,lon,Averaging start\np,1,2,{iso(0)}\nq,1,2,{iso(9)}\n")
    assert track.t.tolist() == [0.0, 9.0]
    rows = [f"2026-03-01T12:00:0{k // 4}Z,{250 * k},1,2" for k in range(8)]
    track = read(["time,time_ms,lat,lon", *rows, ""])
    assert track.t.tolist() == [0.25 * k for k in range(8)]
    for head in (
        "lat,gps_lat,gps_lon,latitude,longitude,lon",
        "lat,x,location_lon,y,location_lat,lon",
    ):
        track = read(f"{head}\n1,2,3,4,5,6\n")
        assert [x.tolist() for x in (track.points.lat, track.points.lon)] == [[1.0], [6.0]]
    track = read("location_lat,location_lon,lat,lon\n1,2,3,4\n")
    assert (track.points.lat[0], track.points.lon[0]) == (3.0, 4.0)
    with_a_name = read("seconds,lat,lon\n7,1,2\n").report.noted
    assert [*with_a_name] == [
        "with a number in column 'seconds', which would have to be t or time_ms"
    ]


SECONDS = ["s", "sec", "secs", "second", "seconds"]
UNITS = {part + word: 10**power for part, power in
         {"": 0, "m": 3, "milli": 3, "u": 6, "micro": 6, "n": 9, "nano": 9}.items()
         for word in SECONDS}  # fmt: skip


@pytest.mark.parametrize("unit", UNITS)
def test_a_time_is_read_in_any_unit_that_its_column_names(read, unit):
    for name in (f"time ({unit})", f"t_{unit}", f"elapsed[{unit}]", f"timestamp_{unit.upper()}"):
        rows = [f"{round(k * UNITS[unit] / 4)},1,2" for k in (0, 4, 8)]
        track = read([f"{name},lat,lon", *rows, ""])
        assert (track.t.tolist(), remarks(track)) == ([0.0, 1.0, 2.0], {})
    track = read(
        f"time_{unit},date time,lat,lon\n0,{iso(0)},1,2\n{UNITS[unit] // 2},{iso(0)},1,2\n"
    )
    assert track.t.tolist() == ([0.0, 0.5] if UNITS[unit] > 1 else [0.0])


MEASURED = ["gnssFixOK", "has_fix", "gps_fix_valid", "is_valid", "status.status"]
MEASURED += ["field.status.status", "/gps/fix/status/status"]


@pytest.mark.parametrize("name", MEASURED)
def test_a_column_that_says_whether_there_is_a_fix_is_known(read, name):
    good, bad = ("0", "-1") if "status.status" in name or "/" in name else ("1", "V")
    head = "field.latitude,/gps/fix/longitude"
    track = read(f"{head},{name}\n33,44,{good}\n34,45,{bad}\n")
    assert track.points.lat.tolist() == [33.0]
    assert dict(track.report.skipped) == {"row without a measured fix": (1, 3)}


def test_ns_counts_satellites_where_it_holds_numbers(read):
    """As in the tables of RTKLIB, which have no ew."""
    head = "%  GPST,latitude(deg),longitude(deg),height(m),Q,ns"
    track = read(f"{head}\n2026/03/01 12:00:00.000,-33.5,44.5,30,1,9\n")
    assert (track.points.lat[0], track.points.lon[0]) == (-33.5, 44.5)
    with pytest.raises(ValueError, match="without a readable hemisphere"):
        read("lat,lon,N/S\n33.5,44.5,1\n")


APPS = {  # header, row
    "phyphox": ('"Time (s)","Latitude (°)","Longitude (°)","Height (m)","Velocity (m/s)",'
                '"Direction (°)","Horizontal Accuracy (m)","Vertical Accuracy (m)"',
                "0.5,33.5,44.5,30,1.5,90,4,9"),
    "GPSLogger": ("time,lat,lon,elevation,accuracy,bearing,speed,satellites,timestamp_ms",
                  "2026-03-01T12:00:00.000Z,33.5,44.5,30,4,90,1.5,9,1772366400000"),
    "BasicAirData": ("type,date time,latitude,longitude,accuracy(m),altitude(m),speed(m/s),"
                     "bearing(deg),sat_used,name", "T,2026-03-01 12:00:00.000,33.5,44.5,4,30,1.5,"
                     "90,9,x"),
    "Sensor Logger": ("time,seconds_elapsed,bearingAccuracy,speedAccuracy,horizontalAccuracy,"
                      "speed,bearing,altitude,longitude,latitude",
                      "1772366400000000000,0.5,5,5,4,1.5,90,30,44.5,33.5"),
}  # fmt: skip


@pytest.mark.parametrize("app", APPS)
def test_what_an_app_calls_accuracy_speed_and_direction_is_known(read, app):
    track = read([*APPS[app], ""])
    assert (track.points.lat[0], track.points.lon[0], track.t[0]) == (33.5, 44.5, 0.0)
    assert (track.speed[0], track.accuracy[0]) == (1.5, 4.0)
    assert track.course[0] == pytest.approx(math.pi / 2)


@pytest.mark.parametrize(
    "name", ["ts", "epoch", "gps_tow", "TimeUTC", "fixTime", "Datum", "iTOW", "unix_s", "seconds"]
)
def test_no_column_named_like_a_time_is_passed_over_silently(read, name):
    for cell in ("1772366400", "01.03.2026", "noon"):
        track = read(f"{name},lat,lon\n{cell},33,44\n")
        assert np.isnan(track.t[0])
        assert f"in column {name!r}" in repr(track.report)


def test_a_column_that_is_not_used_is_named(read):
    track = read("lat,lon,lat_min,speed\n33.25,44.5,15,3\n33.5,44.5,30,3\n")
    assert dict(track.report.noted) == {
        "without their 'lat_min' beside 'lat'": (2, 2),
        "without their 'speed', which names no unit": (2, 2),
    }
    track = read("fixTime,lat,lon,speed,course,accuracy\n,33,44,10,90,3\n")  # in knots, by Traccar
    assert "'speed', which names no unit" in repr(track.report)
    with pytest.raises(ValueError, match="column 'lat_min' has minutes of a degree"):
        read("lat,lon,lat_min\n33,44,15\n")
    degrees = "latitude or longitude in degrees and minutes (ddmm)"
    assert dict(read("lat,lon\n0012.4143,00022.4\n1,2\n").report.skipped) == {degrees: (1, 2)}


FIX_TYPES = {0: None, 1: None, 2: 1, 3: 1, 4: 2, 5: 5, 6: 4, 8: 3}


def test_fix_types_of_mavlink_and_ardupilot(read):
    heads = "lat,lon,fix_type", "Lat,Lng,Status,GMS,GWk,NSats,HDop"
    for head in heads:
        rest = ",1,1,9,0.7" if "GWk" in head else ""
        for number, quality in FIX_TYPES.items():
            track = read(f"{head}\n33,44,3{rest}\n33,44,{number}{rest}\n")
            assert track.quality.tolist() == [1.0] + [quality] * (quality is not None)
    for word in ("GPS_FIX_TYPE_NO_FIX", "no fix", "NO_GPS", "none"):
        track = read(f"lat,lon,fix_type\n33,44,3D\n33,44,{word}\n")
        assert dict(track.report.skipped) == {"row without a measured fix": (1, 3)}
    track = read("lat,lon,fix_type\n33,44,GPS_FIX_TYPE_RTK_FIXED\n33,44,RTK_FLOAT\n")
    assert track.rtk.tolist() == ["fixed", "float"]


# Several receivers

WORST_FIRST = "12354"
TALKERS = st.lists(
    st.tuples(st.sampled_from(["GP", "GN", "GL", "GA"]), st.sampled_from("12345"),
              st.sampled_from([0, 9])), min_size=1, max_size=5,
)  # fmt: skip


@few
@given(TALKERS)
def test_of_several_talkers_the_best_fix_counts(read, talkers):
    lines = [
        gga(talker=talker, mode=mode, lat=f"540{minutes}.6081,N")
        for talker, mode, minutes in talkers
    ]
    track = read(lines)
    best = max(talkers, key=lambda row: WORST_FIRST.index(row[1]))
    assert track.quality.tolist() == [float(best[1])]
    assert track.points.lat[0] == pytest.approx(54 + (best[2] + 0.6081) / 60, abs=1e-12)
    apart = len({minutes for *_, minutes in talkers}) > 1
    wanted = ["of an epoch in which two positions are more than 20 m apart"] * apart
    assert [*track.report.noted] == wanted


def test_two_receivers_disagree_whatever_the_file(read):
    first, second = ["1,2,0", "1,2,1"], ["1.001,2,0", "1.001,2,1"]
    for rows in (first + second, [first[0], second[0], first[1], second[1]]):
        track = read(["lat,lon,t", *rows, ""])
        assert (track.points.lat.tolist(), track.t.tolist()) == ([1.0, 1.0], [0.0, 1.0])
        assert track.report.skipped["same time again"].count == 2
        assert [*track.report.noted] == [
            "of an epoch in which two positions are more than 20 m apart"
        ]


@few
@given(st.lists(st.sampled_from("12345"), min_size=1, max_size=6))
def test_of_several_positions_with_one_time_the_best_counts(read, qualities):
    rows = [f"{33 + k * 1e-5},44,1,{quality}" for k, quality in enumerate(qualities)]
    track = read(["lat,lon,t,quality", "33,44,0,1", *rows, "33,44,2,1", ""])
    best = max(range(len(rows)), key=lambda k: (WORST_FIRST.index(qualities[k]), -k))
    assert track.points.lat.tolist() == [33.0, 33 + best * 1e-5, 33.0]


def test_rtk_of_another_kind_of_sentence_counts(read):
    track = read([gga(mode=1), nmea_row("GNS", mode="ANR", talker="GN"), gga(mode=0)])
    assert track.rtk.tolist() == ["fixed"]


@few
@given(st.lists(st.tuples(st.sampled_from([1, 3, 65, 131, 0]), st.sampled_from([0, 10_000])),
                min_size=2, max_size=4))  # fmt: skip
def test_of_two_receivers_in_one_ubx_file_the_best_counts(tmp_path_factory, receivers):
    path = tmp_path_factory.getbasetemp() / "two.ubx"
    messages = [pvt(lat=-331000000 + off, flags=flags, second=1) for flags, off in receivers]
    path.write_bytes(b"".join(messages))
    quality = {1: 1.0, 3: 2.0, 65: 5.0, 131: 4.0, 0: math.nan}
    fixed = [row for row in dict.fromkeys(receivers) if row[0]]
    assume(fixed)
    track = wmr.read_track(path)
    flags, off = max(fixed, key=lambda row: WORST_FIRST.index(f"{quality[row[0]]:.0f}"))
    assert (track.quality[0], track.points.lat[0]) == (
        quality[flags],
        pytest.approx(-33.1 + off * 1e-7, abs=1e-9),
    )
    apart = {off for _, off in fixed} == {0, 10_000}
    noted = ["of an epoch in which two positions are more than 20 m apart"]
    noted = noted if apart else ["of an epoch with two receivers"]
    assert [*track.report.noted] == noted * (len(fixed) > 1)


# Broken off, and other formats


@few
@given(st.floats(0.0, 1.0))
def test_a_gpx_file_that_breaks_off_keeps_its_points(read, share):
    points = [f'<trkpt lat="{33 + k * 1e-5}" lon="44.5"><time>{iso(k)}</time></trkpt>'
              for k in range(9)]  # fmt: skip
    text = gpx(trk(*points))
    text = text[: int(share * len(text))]
    whole = text.count("</trkpt>")
    if whole:
        track = read(text)
        assert len(track) == whole
        (reason,) = track.report.skipped
        assert reason.startswith("rest of the file, whose XML is broken")
    else:
        with pytest.raises(ValueError, match="no position in"):
            read(text)


@few
@given(
    st.lists(st.tuples(st.floats(-89, 89), st.floats(-180, 180)), min_size=1, max_size=6),
)
def test_what_write_geojson_writes_is_read(tmp_path_factory, places):
    path = tmp_path_factory.getbasetemp() / "a.geojson"
    lat, lon = np.transpose(places)
    assume(max(abs(lat).max(), abs(lon).max()) > 1.0)
    wmr.write_geojson(path, wmr.GeoPoint(lat=lat, lon=lon))
    points = wmr.read_track(path).points
    nowhere = (abs(lat) < 1e-6) & (abs(lon) < 1e-6)
    if not nowhere.any():
        assert points.lat == pytest.approx(lat, abs=1e-7)
        assert np.abs((points.lon - lon + 180) % 360 - 180).max() <= 1e-7


def test_json_of_others(read):
    def feature(kind, coordinates, **properties):
        geometry = {"type": kind, "coordinates": coordinates}
        return {"type": "Feature", "geometry": geometry, "properties": properties}

    def collection(*features):
        return json.dumps({"type": "FeatureCollection", "features": features}, indent=1)

    line = feature("LineString", [[2, 1, 30], [2, 1.00001]], coordTimes=[iso(0), iso(1)])
    track = read(collection(line, feature("Point", [5, 6]), feature("Polygon", [[[1, 2]]])))
    assert (track.source, track.points.lat.tolist()) == ("GeoJSON", [1.0, 1.00001])
    assert (track.points.lon.tolist(), track.t.tolist()) == ([2.0, 2.0], [0.0, 1.0])
    assert dict(track.report.skipped) == {
        "point beside the lines": (1, 2),
        "feature that is neither a line nor a point": (1, 3),
    }
    for name in ("time", "timestamp", "datetime"):
        points = [feature("Point", [2, 1], **{name: iso(k)}) for k in range(3)]
        assert read(collection(*points)).t.tolist() == [0, 1, 2]
    times = {"times": [iso(0), iso(1)]}  # as togeojson has them today
    line = feature("LineString", [[2, 1], [2, 1.00001]], coordinateProperties=times)
    assert read(collection(line)).t.tolist() == [0, 1]
    lines = feature("MultiLineString", [[[2, 1]], [["x", 1], 3, [2, 1.5]]])
    assert read(json.dumps(lines)).points.lat.tolist() == [1.0, 1.5]
    tpv = {"class": "TPV", "mode": 3, "status": 3, "lat": 1.0, "lon": 2.0, "speed": 1.5}
    tpv |= {"track": 90.0, "eph": 0.02, "time": iso(0)}
    messages = [{"class": "VERSION"}, tpv, {**tpv, "mode": 1}, {**tpv, "time": iso(1)}]
    text = "\n".join(map(json.dumps, messages))
    track = read(text)
    assert (track.source, track.t.tolist(), track.rtk[0]) == ("gpsd", [0, 1], "fixed")
    assert (track.speed[0], track.accuracy[0]) == (1.5, 0.02)
    assert track.course[0] == pytest.approx(math.pi / 2)
    assert track.report.skipped["TPV without a fix"] == (1, 3)
    for head in ('{"class":"VERSION"}', '{"battery": 12.1}'):
        assert read(f"{head}\n{gga()}\n").source == "NMEA"
    for bad, why in [
        ('{"type": "Topology"}', "export it as GPX"),
        ('{"type": ', "not a whole GeoJSON"),
        (collection(feature("Polygon", [])), "neither a line nor a point"),
    ]:
        with pytest.raises(ValueError, match=why):
            read(bad)


# A Track of one's own


def test_a_track_by_hand_has_one_value_a_position():
    points = wmr.GeoPoint(lat=[1.0, 2.0], lon=[3.0, 4.0])
    nothing = dict.fromkeys(Reported._fields, np.full(2, math.nan))
    t = np.arange(2.0)
    track = Track(points, t, "mine", Report(2, {}), **nothing)
    assert len(track) == 2
    t[0] = 5.0  # is the caller's
    assert track.t[0] == 0.0
    for change, message in [
        ({"t": [0.0]}, r"t has shape \(1,\), points have shape \(2,\)"),
        ({"speed": [1.0, 2.0, 3.0]}, r"speed has shape \(3,\)"),
        ({"hdop": [math.inf, 1.0]}, "hdop = .* a finite number or NaN is needed"),
        ({"points": [1, 2]}, "a GeoPoint is needed"),
    ]:
        with pytest.raises(ValueError, match=message):
            Track(**{"points": points, "t": t, "source": "", "report": None, **nothing, **change})
