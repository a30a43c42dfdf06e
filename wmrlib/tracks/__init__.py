"""Positions in NMEA, GPX and CSV files, with an account of what is not used."""

from __future__ import annotations

import os
from dataclasses import dataclass
from io import BufferedReader, TextIOWrapper

import numpy as np

from wmrlib._checks import refusal
from wmrlib.geodesy import GeoPoint
from wmrlib.tracks import gpx, nmea, tables
from wmrlib.tracks.fixes import LONGEST, Count, Fixes, Report
from wmrlib.tracks.writing import write_geojson, write_gpx

__all__ = ["Count", "Report", "Track", "read_track", "write_geojson", "write_gpx"]

_BINARY = (
    (b"\x1f\x8b", 0, "compressed by gzip; unpack it"),
    (b"PK\x03\x04", 0, "a zip archive, as a KMZ file is; unpack it, and export KML as GPX"),
    (b".FIT", 8, "a FIT file; export it as GPX"),
)


@dataclass(frozen=True, eq=False, slots=True)
class Track:
    """The positions of a file, in its order, in arrays that can't be written to.

    Parameters
    ----------
    points, source, report : GeoPoint of arrays, "NMEA", "GPX" or "CSV", and Report
    t : array, s; since the first position that has a time, NaN where there is none; in order
        within a segment of GPX, and in the whole of another file
    """

    points: GeoPoint
    t: np.ndarray
    source: str
    report: Report

    def __post_init__(self) -> None:
        for values in (self.points.lat, self.points.lon, self.t):
            np.asarray(values).flags.writeable = False

    def __reduce__(self) -> tuple:  # a copy's arrays would be writeable
        return Track, (self.points, self.t, self.source, self.report)

    def __len__(self) -> int:
        return self.t.size

    def __repr__(self) -> str:
        timed = self.t[~np.isnan(self.t)]
        span = f"over {np.ptp(timed):.6g} s" if timed.size else "without times"
        left = sum(each.count for each in self.report.skipped.values())
        return f"<Track: {len(self)} positions from {self.source}, {span}; {left} not used>"


def read_track(path: str | os.PathLike) -> Track:
    """Read positions from NMEA sentences, GPX or a CSV table; the content tells which.

    NMEA: GGA of every talker, and for an epoch without one its GNS, RMC or GLL; each epoch once;
    not where the most trusted of these says that there is no fix; checksum needed.
    GPX: the track points, or else the route's, or else the waypoints, whose times tell when they
    were made and are not used; no document type or entity. Extensions are passed over.
    CSV: a line, with at most nine above it, names the columns: lat or latitude; lon, lng, long or
    longitude, in degrees or e7; optionally lat_deg, lat_min and lat_sec, N/S and E/W; time,
    timestamp, datetime or t, in seconds, ms, a spreadsheet's days or ISO 8601, or date and time;
    valid, fix, quality or status. Cells are separated by a comma, semicolon, tab or |; decimal
    commas are read, in quotes where commas separate cells. Of y/m/d, d/m/y and m/d/y, with or
    without separators, a file's dates are in the order that brings them nearest each other.
    Text is UTF-8, or UTF-16 with its byte order mark.
    Where times run backwards, the longest run in order is used (in GPX, of each segment).

    Parameters
    ----------
    path : str or PathLike

    Returns
    -------
    Track, whose `report` counts each line that is not used, by its reason

    Raises
    ------
    ValueError : a file without a position; the message says why
    OSError : a file that can't be opened
    """
    if not isinstance(path, str | os.PathLike):
        raise refusal("path", path, "a str or PathLike", f", not of type {type(path).__name__}")
    try:
        with open(path, "rb") as file:
            source, fixes = _read(file)
        (lat, lon, time), report = fixes.settle()
        if not report.used:
            reasons = "; ".join(report.listed(report.skipped))
            raise ValueError(f"it is {source}, but {reasons or 'holds no position'}")
    except ValueError as error:
        raise ValueError(f"no position in {os.fspath(path)!r}: {error}") from None
    timed = time[~np.isnan(time)]
    t = time - timed[0] if timed.size else time
    return Track(GeoPoint(lat=lat, lon=lon), t, source, report)


def _read(file: BufferedReader) -> tuple[str, Fixes]:
    head = file.peek()
    for mark, place, kind in _BINARY:
        if head.startswith(mark, place):
            raise ValueError(f"it is {kind}")
    wide = head.startswith((b"\xff\xfe", b"\xfe\xff"))  # as PowerShell's > writes
    # The checksums of NMEA are of bytes, which surrogates keep.
    coding, errors = ("utf-16", "replace") if wide else ("utf-8-sig", "surrogateescape")
    if head.decode(coding, errors).lstrip(" \t\r\n\0").startswith("<"):
        return "GPX", gpx.read(file)  # XML itself says how it is encoded
    with TextIOWrapper(file, coding, errors, newline="") as text:
        parts = iter(lambda: text.readline(LONGEST), "")
        begin = next((part.lstrip()[0] for part in parts if part.strip()), None)
        if begin is None:
            raise ValueError("the file is empty")
        text.seek(0)
        if begin in "{[":
            raise ValueError("it is JSON, but NMEA, GPX or CSV is needed")
        try:
            return "CSV", tables.read_csv(text)
        except tables.NoHeaderError:
            text.seek(0)
            if (fixes := nmea.read(text)) is None:
                raise
            return "NMEA", fixes
