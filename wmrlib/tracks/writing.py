"""A path written to GPX and GeoJSON."""

import json
import math
import os
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape

import numpy as np

from wmrlib.checks import Real, instance, real, refusal
from wmrlib.geodesy import GeoPoint, position_list

_GPX = """<?xml version="1.0" encoding="UTF-8"?>
<gpx xmlns="http://www.topografix.com/GPX/1/1" version="1.1" creator="wmrlib">
<trk><name>{}</name><trkseg>
{}
</trkseg></trk></gpx>
"""


def write_gpx(
    path: str | os.PathLike,
    points: GeoPoint,
    *,
    t: Real | None = None,
    begin: datetime | None = None,
    name: str = "wmrlib",
) -> None:
    """Write positions as one track of a GPX 1.1 file, with 7 decimals (a centimetre).

    Parameters
    ----------
    path, name : str or PathLike of the file, and printable str, the track's name
    points : GeoPoint of arrays; of a driven Trajectory, `point_at(origin, run.x, run.y)`
    t, begin : array, s after `begin` (one a position, NaN for none), and datetime with a time zone

    Raises
    ------
    ValueError : no position, a name that can't be printed, t without begin or of another length
    OSError : a file that can't be written

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import wmrlib as wmr
    >>> start, goal, gains, _ = wmr.paper.outdoor()
    >>> run = wmr.simulate(start, goal, gains)
    >>> file = Path(tempfile.mkdtemp()) / "drive.gpx"
    >>> wmr.write_gpx(file, wmr.point_at(wmr.paper.GPS_POINT_1, run.x, run.y))
    >>> len(wmr.read_track(file)) == len(run.t)
    True
    """
    lat, lon = _rounded(points, name)
    lon[lon == 180.0] = -180.0  # GPX 1.1: below 180
    rows = zip(lat, lon, _times(t, begin, lat.shape), strict=True)
    places = (f'<trkpt lat="{y:.7f}" lon="{x:.7f}">{time}</trkpt>' for y, x, time in rows)
    _replace(path, _GPX.format(escape(name), "\n".join(places)))


def write_geojson(path: str | os.PathLike, points: GeoPoint, *, name: str = "wmrlib") -> None:
    """Write positions as a GeoJSON Feature; parameters and errors as `write_gpx`.

    Across the date line longitudes go on beyond 180, so that no map draws a line round the Earth.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import wmrlib as wmr
    >>> file = Path(tempfile.mkdtemp()) / "way.geojson"
    >>> wmr.write_geojson(file, wmr.GeoPoint(lat=[52.1, 52.2], lon=13.4))
    >>> wmr.read_track(file).points.lat
    array([52.1, 52.2])
    """
    lat, lon = _rounded(points, name)
    places = np.column_stack([np.round(np.unwrap(lon, period=360.0), 7), lat]).tolist()
    kind, coordinates = ("LineString", places) if places[1:] else ("Point", places[0])
    geometry = {"type": kind, "coordinates": coordinates}
    feature = {"type": "Feature", "properties": {"name": name}, "geometry": geometry}
    _replace(path, json.dumps(feature, ensure_ascii=False) + "\n")


def _rounded(points: GeoPoint, name: str) -> tuple[np.ndarray, np.ndarray]:
    if not instance("name", name, str).isprintable():
        raise refusal("name", name, "printable text")
    lat, lon = position_list(points)
    return np.round(lat, 7) + 0.0, np.round(lon, 7) + 0.0  # no -0.0


def _times(t: Any, begin: datetime | None, shape: tuple[int, ...]) -> list[str]:
    if t is None and begin is None:
        return [""] * shape[0]
    if t is None or begin is None or instance("begin", begin, datetime).utcoffset() is None:
        needed = "both are needed, begin with its time zone"
        raise ValueError(f"t = {t!r} and begin = {begin!r} are not allowed together: {needed}")
    t = np.atleast_1d(real("t", t, nan=True))
    if t.shape != shape:
        raise ValueError(f"mismatched lengths: t has shape {t.shape}, points have shape {shape}")
    try:  # in UTC, so that a change to summer time loses no hour
        times = [math.isnan(s) or begin.astimezone(UTC) + timedelta(seconds=s) for s in t.tolist()]
    except OverflowError:
        raise refusal("t", t, "begin + t in the years 1 to 9999") from None
    return ["" if time is True else f"<time>{time.isoformat()[:-6]}Z</time>" for time in times]


def _replace(path: str | os.PathLike, text: str) -> None:
    """Write the file whole or leave it as it was: a disk may be full."""
    place = Path(path)
    new = place.with_name(f".{place.name}.new")
    try:
        new.write_text(text, "utf-8")
        new.replace(place)
    except OSError as error:  # it names the file that was asked for, not the one beside it
        raise OSError(error.errno, error.strerror, os.fspath(path)) from None
    finally:
        new.unlink(missing_ok=True)
