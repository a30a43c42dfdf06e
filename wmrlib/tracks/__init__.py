"""Positions out of NMEA, GPX, CSV and GeoJSON files, never silently wrong; and a path back into GPX and GeoJSON.

A line that gives no position is counted with its reason, in the Report that comes with every Track; a file that gives none is an error.
"""

from __future__ import annotations

import math
import os
import re
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

import numpy as np

from wmrlib._checks import Real, instance, real, same_shape
from wmrlib.geodesy import GeoPoint, local_position, point_at
from wmrlib.tracks.fixes import Count, Fixes, Report

__all__ = [
    "Count",
    "Report",
    "Standing",
    "Track",
    "read_track",
    "standing",
    "write_geojson",
    "write_gpx",
]

_DECIMALS = 7  # of a degree: a centimetre
_NOT_IN_XML = re.compile("[^\t\n\r -\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


@dataclass(frozen=True, eq=False, slots=True)
class Track:
    """The positions of a file, in its order.

    points: GeoPoint of arrays (degrees), which can't be written to; t: seconds since the first position that has a time, NaN where there
    is none; source: "NMEA", "GPX", "CSV" or "GeoJSON"; report: the Report of what was used and what was not.
    """

    points: GeoPoint
    t: np.ndarray
    source: str
    report: Report

    def __len__(self) -> int:
        return self.t.size

    def __repr__(self) -> str:
        timed = self.t[~np.isnan(self.t)]
        span = f"over {timed[-1]:.6g} s" if timed.size else "without times"
        return f"<Track: {len(self)} positions from {self.source}, {span}; {sum(c.count for c in self.report.skipped.values())} not used>"

    @property
    def mean(self) -> GeoPoint:
        """The mean position: the point from which the positions' distances east and north add up to nothing."""
        return _mean(self.points)


@dataclass(frozen=True, eq=False, slots=True)
class Standing:
    """The scatter of a receiver that stands still.

    mean: GeoPoint; n: how many positions; east, north: metres of each from the mean; std_east, std_north: m; covariance: of (east, north),
    2 by 2, m^2 (both with n - 1); cep: m, the median distance from the mean (circular error probable);
    two_drms: m, 2 sqrt(std_east^2 + std_north^2).
    """

    mean: GeoPoint
    n: int
    east: np.ndarray
    north: np.ndarray
    std_east: float
    std_north: float
    covariance: np.ndarray
    cep: float
    two_drms: float

    def __repr__(self) -> str:
        mean = f"{self.mean.lat:.7f} deg N, {self.mean.lon:.7f} deg E"
        scatter = f"std {self.std_east:.3g} m east, {self.std_north:.3g} m north, CEP {self.cep:.3g} m, 2drms {self.two_drms:.3g} m"
        return f"<Standing: {self.n} positions about {mean}; {scatter}>"


def read_track(path: str | os.PathLike) -> Track:
    """The positions of a file: NMEA sentences, GPX, GeoJSON, or a CSV table; what a file is, its content says and not its name.

    NMEA: the GGA of every talker (GP, GN, GL, ...), and RMC for seconds of which no GGA tells; each epoch once, the first talker's; the
    date is RMC's. A sentence needs its checksum. GPX: the track points, or else the route's, or else the waypoints; a document type or an
    entity in the XML is refused. CSV: the first line names the columns: lat or latitude; lon, lng, long or longitude, in degrees; and if
    there is one time, timestamp, datetime or t, in seconds or ISO 8601. Between cells stands a comma, a semicolon, a tab or |; a number
    may have a decimal comma, in quotes where commas stand between cells. GeoJSON: all points and lines, RFC 7946. Text is UTF-8, or UTF-16
    with its byte order mark.
    What is not used (a wrong or missing checksum, no fix, a cut line, a latitude over 90, NaN, an epoch told twice, a time that runs
    backwards) is counted in `Track.report`, with its reason and first line. Raises ValueError, which says why, for a file from which no
    position comes, and OSError for one that can't be opened. Source: NMEA 0183 by pynmea2, GPX by gpxpy, safely by defusedxml.
    """
    data = Path(path).read_bytes()
    try:
        source, fixes = _read(data)
        report = fixes.report()
        if not report.used:
            found = "; ".join(
                f"{count} {reason} (first in {report.unit} {first})"
                for reason, (count, first) in report.skipped.items()
            )
            raise ValueError(f"it is {source}, but {found or 'holds no position'}")
    except ValueError as error:
        raise ValueError(f"no position in {str(path)!r}: {error}") from None
    lat, lon, time = (
        np.array(values, dtype=float) for values in (fixes.lat, fixes.lon, fixes.time)
    )
    timed = np.flatnonzero(~np.isnan(time))
    t = time - time[timed[0]] if timed.size else time
    for values in (lat, lon, t):
        values.flags.writeable = False
    points = GeoPoint(lat=lat, lon=lon)
    points.lat.flags.writeable = points.lon.flags.writeable = False
    return Track(points, t, source, report)


def standing(track: Track | GeoPoint) -> Standing:
    """Mean position and scatter of a receiver that stands still, see Standing for the fields and units.

    track: a Track, or a GeoPoint of arrays. Mean and scatter are computed in the local frame of the mean, where east and north are metres,
    and are right at the date line and at the poles too. Raises ValueError for fewer than two positions, or positions all over the Earth.
    """
    points = track.points if isinstance(track, Track) else instance("track", track, GeoPoint)
    n = math.prod(same_shape(lat=points.lat, lon=points.lon))
    if n < 2:
        raise ValueError(
            f"track has {n} position, which is not allowed: at least 2 are needed for a scatter"
        )
    mean = _mean(points)
    east, north = (np.ravel(values) for values in local_position(mean, points))
    covariance = np.cov(east, north)
    std_east, std_north = np.sqrt(np.diag(covariance)).tolist()
    two_drms = 2.0 * math.hypot(std_east, std_north)
    return Standing(
        mean,
        n,
        east,
        north,
        std_east,
        std_north,
        covariance,
        float(np.median(np.hypot(east, north))),
        two_drms,
    )


def write_gpx(
    path: str | os.PathLike,
    points: GeoPoint,
    *,
    t: Real | None = None,
    begin: datetime | None = None,
    name: str = "wmrlib",
) -> None:
    """Write positions as a track of a GPX 1.1 file, with 7 decimals (a centimetre), cut into segments at the date line.

    points: a GeoPoint of arrays; of a driven Trajectory, `point_at(origin, run.x, run.y)`. t: seconds, one a position (NaN for none),
    written as times after `begin`, a datetime with its time zone. Raises ValueError for no position, a t without `begin` or of another
    length, a `begin` without a time zone, times outside the years 1 to 9999, or a name that XML can't hold.
    """
    from wmrlib.tracks import gpx

    lat, lon = _rounded(points)
    if (t is None) != (begin is None):
        raise ValueError(
            f"t = {t!r} and begin = {begin!r} are not allowed together: both or none are needed"
        )
    if t is not None:
        if instance("begin", begin, datetime).utcoffset() is None:
            raise ValueError(
                f"begin = {begin!r} is not allowed: a datetime with its time zone is needed"
            )
        t = np.atleast_1d(real("t", t, nan=True))
        if t.shape != lat.shape:
            raise ValueError(
                f"mismatched lengths: t has shape {t.shape}, points have shape {lat.shape}; the same is needed"
            )
    Path(path).write_bytes(gpx.text(lat, lon, t, begin, _xml_name(name)).encode())


def write_geojson(path: str | os.PathLike, points: GeoPoint, *, name: str = "wmrlib") -> None:
    """Write positions as a GeoJSON Feature, RFC 7946: longitude before latitude, 7 decimals (a centimetre), cut at the date line.

    points: a GeoPoint of arrays; of a driven Trajectory, `point_at(origin, run.x, run.y)`. One position makes a Point, several make a
    LineString, or a MultiLineString if it is cut; `read_track` puts it together. Raises ValueError for no position, or a name that is
    no text or that UTF-8 can't hold (a lone surrogate).
    """
    from wmrlib.tracks import tables

    lat, lon = _rounded(points)
    Path(path).write_bytes(tables.geojson(lat, lon, _utf8_name(name)).encode())


def _read(data: bytes) -> tuple[str, Fixes]:
    whole = data  # XML says itself how it is encoded
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):  # as PowerShell's > writes
        data = data.decode("utf-16", errors="replace").encode()
    data = data.removeprefix(b"\xef\xbb\xbf")
    begin = data.lstrip()[:1]
    if not begin:
        raise ValueError("the file is empty")
    if begin == b"<":
        from wmrlib.tracks import gpx

        return "GPX", gpx.read(whole)
    from wmrlib.tracks import tables

    if begin in (b"{", b"["):
        return "GeoJSON", tables.read_geojson(data)
    from wmrlib.tracks import nmea

    if nmea.looks_like(data):
        return "NMEA", nmea.read(data)
    return "CSV", tables.read_csv(data)


def _mean(points: GeoPoint) -> GeoPoint:
    """From the mean of the unit vectors, by Newton steps in the local frame."""
    lat, lon = np.radians(np.ravel(points.lat)), np.radians(np.ravel(points.lon))
    x, y, z = (
        np.mean(np.cos(lat) * np.cos(lon)),
        np.mean(np.cos(lat) * np.sin(lon)),
        np.mean(np.sin(lat) + 0.0 * lon),
    )
    if math.sqrt(x * x + y * y + z * z) < 0.5:
        raise ValueError(
            "points spread all over the Earth have no mean: points on one side of it are needed"
        )
    mean = GeoPoint(
        lat=math.degrees(math.atan2(z, math.hypot(x, y))), lon=math.degrees(math.atan2(y, x))
    )
    for _ in range(100):
        east, north = (float(np.mean(values)) for values in local_position(mean, points))
        mean = point_at(mean, east, north)
        if math.hypot(east, north) < 1e-7:  # m
            break
    return mean


def _rounded(points: GeoPoint) -> tuple[np.ndarray, np.ndarray]:
    instance("points", points, GeoPoint)
    lat, lon = np.broadcast_arrays(np.atleast_1d(points.lat), np.atleast_1d(points.lon))
    if lat.size == 0 or lat.ndim > 1:
        raise ValueError(
            f"points have shape {lat.shape}, which is not allowed: a list of at least one position is needed"
        )
    return np.round(lat, _DECIMALS) + 0.0, np.round(lon, _DECIMALS) + 0.0  # no -0.0


def _utf8_name(name: str) -> str:
    try:
        instance("name", name, str).encode()
    except UnicodeEncodeError:
        raise ValueError(
            f"name = {name!r} is not allowed: a text that UTF-8 can hold is needed"
        ) from None
    return name


def _xml_name(name: str) -> str:
    if _NOT_IN_XML.search(_utf8_name(name)):
        raise ValueError(
            f"name = {name!r} is not allowed: a text without control characters is needed"
        )
    return name
