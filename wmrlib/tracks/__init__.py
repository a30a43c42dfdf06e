"""Positions from files of receivers and apps, with a count of the lines that are not used."""

import os
from dataclasses import dataclass
from io import BufferedReader, TextIOWrapper

import numpy as np

from wmrlib.checks import real, refusal
from wmrlib.geodesy import GeoPoint, position_list
from wmrlib.tracks import gpx, jsons, nmea, tables, ubx
from wmrlib.tracks.fixes import Count, Fixes, Report, Reported
from wmrlib.tracks.writing import write_geojson, write_gpx

_NO_FORMAT = "it is neither NMEA, UBX, GPX, GeoJSON nor gpsd"

__all__ = ["Count", "Report", "Track", "read_track", "write_geojson", "write_gpx"]


@dataclass(frozen=True, eq=False, slots=True)
class Track:
    """The positions of a file, in its order, in arrays that can't be written to.

    `t` is in s since the first position that has a time, NaN where there is none, and increases
    within a segment of GPX or GeoJSON and in the whole of another file. `source` is "NMEA", "UBX",
    "GPX", "GeoJSON", "gpsd" or "CSV". `points` is a GeoPoint of arrays, `report` a `Report`, and
    the length of the track is the number of its positions. The other arrays hold the receiver's own
    reports, NaN where there is none: `quality` of the fix as in GGA (1 plain, 2 differential or
    SBAS, 3 precise, 4 RTK fixed, 5 RTK float); `satellites` in use; `hdop`; `speed` in m/s and
    `course` over ground in rad clockwise from north; `heading`, so too, of the line from one
    antenna to another; `accuracy`, its own estimate of the error in the plane, in m.

    Raises
    ------
    ValueError : by hand, an array of another length than `points`, or a value that is no number
    """

    points: GeoPoint
    t: np.ndarray
    source: str
    report: Report
    quality: np.ndarray
    satellites: np.ndarray
    hdop: np.ndarray
    speed: np.ndarray
    course: np.ndarray
    heading: np.ndarray
    accuracy: np.ndarray

    def __post_init__(self) -> None:
        lat, lon = position_list(self.points)
        points = GeoPoint(lat=lat, lon=lon)
        arrays = {name: getattr(self, name) for name in ("t", *Reported._fields)}
        for name, values in arrays.items():
            arrays[name] = np.atleast_1d(np.asarray(real(name, values, nan=True)))
            if arrays[name].shape != lat.shape:
                lengths = f"{name} has shape {arrays[name].shape}, points have shape {lat.shape}"
                raise ValueError(f"mismatched lengths: {lengths}")
            object.__setattr__(self, name, arrays[name])
        object.__setattr__(self, "points", points)
        for values in (points.lat, points.lon, *arrays.values()):
            values.flags.writeable = False

    @property
    def rtk(self) -> np.ndarray:
        """The RTK state of each position, "fixed", "float" or "none"; "" where none is reported."""
        kinds = [self.quality == 4.0, self.quality == 5.0, self.quality > 0.0]
        return np.select(kinds, ["fixed", "float", "none"], "")

    def __len__(self) -> int:
        return self.t.size

    def __repr__(self) -> str:
        timed = self.t[~np.isnan(self.t)]
        span = f"over {np.ptp(timed):.6g} s" if timed.size else "without times"
        left = sum(reason.count for reason in self.report.skipped.values())
        kinds = len(self.report.noted)
        notes = f", {kinds} note{'s' * (kinds != 1)} in its report" if kinds else ""
        return f"<Track: {len(self)} positions from {self.source}, {span}; {left} not used{notes}>"


def read_track(path: str | os.PathLike) -> Track:
    """Read positions from NMEA, UBX, GPX, GeoJSON, gpsd or a CSV table; the content tells which.

    - NMEA: GGA of every talker, and for an epoch without one its GNS, RMC or GLL; each epoch once,
      by its best fix; not where the most trusted kind says that there is no fix. Each sentence
      needs its checksum.
    - UBX, alone or mixed with NMEA: NAV-PVT, of its epoch NAV-HPPOSLLH's digits, NAV-RELPOSNED's
      heading and NAV-DOP's hdop; in a file without NAV-PVT the sentences. It takes pyubx2.
    - GPX: the track points, or else the route's, or else the waypoints (without their times); of
      two elements of one name the point's own.
    - GeoJSON: the lines, or else the points.
    - gpsd: its TPV.
    - CSV: one of the first ten lines names the columns: lat or latitude; lon, lng, long or
      longitude, in degrees (33.27, 33.27 N or "33,27") or e7; optionally N/S and E/W; t, time_s or
      time_ms, or time in ISO 8601, with a date (2026-03-01) beside it or not; valid, fix, quality,
      status or MAVLink's fix_type; satellites, hdop, accuracy (m), course (degrees), and speed with
      its unit, such as speed_m_s, speed_kmh or speed_kn; but no heading. Of several columns the
      best is used, and the report names the others.

    Where times do not increase, the longest run that does is used, and in a step of whole days
    while the clock goes on the date was wrong. Of a clock that shows only minutes, or stands, t
    has the first of each time. (0, 0) far from all others is not used, nor is a place that no
    vehicle reaches in the time, unless more than a quarter are such. All of this is within a
    segment of GPX or GeoJSON, and in the report. Of several receivers that a file names one is
    used, by its fixes and their number.

    Parameters
    ----------
    path : str or PathLike; text in UTF-8, or in UTF-16 with its byte order mark

    Returns
    -------
    Track, whose `report`, a `Report`, counts each line that is not used, by its reason

    Raises
    ------
    ValueError, OSError : a file without a position, with the reason; one that can't be opened

    Examples
    --------
    >>> import wmrlib as wmr
    >>> import wmrbook.data
    >>> log = wmr.read_track(wmrbook.data.path("ublox5-standing.nmea"))
    >>> log
    <Track: 9 positions from NMEA, over 8 s; 77 not used>
    >>> print(log.report)
    9 positions used
    not used: 7 comment (first in line 1)
    not used: 52 other sentence (first in line 8)
    not used: 18 same epoch again (first in line 15)
    """
    if not isinstance(path, str | os.PathLike):
        raise refusal("path", path, "a str or PathLike", f", not of type {type(path).__name__}")
    try:
        with open(path, "rb") as file:
            source, fixes = _read(file)
        (lat, lon, time, *reported), report = fixes.settle()
        if not report.used:
            reasons = repr(report).partition("not used: ")[2].replace("\nnot used: ", "; ")
            raise ValueError(f"it is {source}, but {reasons or 'holds no position'}")
    except ValueError as error:
        raise ValueError(f"no position in {os.fspath(path)!r}: {error}") from None
    begin = time[~np.isnan(time)][:1].sum()
    return Track(GeoPoint(lat=lat, lon=lon), time - begin, source, report, *reported)


def _read(file: BufferedReader) -> tuple[str, Fixes]:
    head = file.peek()
    if not head:
        raise ValueError("it is empty")
    if head.startswith((b"\x1f\x8b", b"PK\x03\x04")) or head[8:12] == b".FIT":
        raise ValueError("it is compressed, a KMZ or a FIT file; unpack it, or export it as GPX")
    wide = head.startswith((b"\xff\xfe", b"\xfe\xff"))  # as PowerShell's > writes
    # The checksums of NMEA are of bytes, which surrogates keep.
    coding, errors = ("utf-16", "replace") if wide else ("utf-8-sig", "surrogateescape")
    start = head.decode(coding, errors).lstrip(" \t\r\n\0")
    if start.startswith("<"):
        return "GPX", gpx.read(file)  # XML itself says how it is encoded
    if read := ubx.read(file):
        return read
    with TextIOWrapper(file, coding, errors, newline="") as text:
        if start.startswith(("{", "[{")):
            return jsons.read(text)
        try:
            return "CSV", tables.read(text)
        except LookupError as error:  # no header
            text.seek(0)
            if (fixes := nmea.read(nmea.numbered(text), Fixes())) is None:
                raise ValueError(f"{_NO_FORMAT}, and {error.args[0]}") from None
            return "NMEA", fixes
