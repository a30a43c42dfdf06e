"""A path written to GPX and GeoJSON, cut at the date line so that none is drawn round the Earth."""

from __future__ import annotations

import json
import math
import os
import re
import secrets
import shutil
from contextlib import suppress
from datetime import UTC, datetime, timedelta
from itertools import pairwise
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape

import numpy as np

from wmrlib._checks import Real, instance, real, refusal
from wmrlib.geodesy import GeoPoint, position_list

_DECIMALS = 7  # of a degree: a centimetre
_GPX_11 = """<?xml version="1.0" encoding="UTF-8"?>
<gpx xmlns="http://www.topografix.com/GPX/1/1" version="1.1" creator="wmrlib">"""
_RETURN = {"\r": "&#13;"}  # a bare one is read as a line's end
_NOT_IN_XML = re.compile("[^\t\n\r -\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_NOT_IN_UTF8 = re.compile("[\ud800-\udfff]")


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
    path, name : str or PathLike of the file, and str, the track's name
    points : GeoPoint of arrays; of a driven Trajectory, `point_at(origin, run.x, run.y)`
    t, begin : array, s after `begin` (one a position, NaN for none), and datetime with a time zone

    Raises
    ------
    ValueError : no position, t or begin without the other, t of another length, a begin without a
        time zone, times outside the years 1 to 9999, or a name that XML can't hold
    OSError : a file that can't be written; one that was there stays as it was
    """
    lat, lon = _rounded(points)
    if (t is None) is not (begin is None):
        both = f"t = {t!r} and begin = {begin!r}"
        raise ValueError(f"{both} are not allowed together: both or none are needed")
    times = [""] * lat.size if begin is None else _times(t, begin, lat.shape)
    _check_name(name, _NOT_IN_XML)
    lon = np.where(lon == 180.0, -180.0, lon)  # GPX 1.1: below 180
    rows = [_GPX_11, f"<trk><name>{escape(name, _RETURN)}</name>"]
    for piece in _pieces(lon):
        places = (f'<trkpt lat="{lat[i]:.7f}" lon="{lon[i]:.7f}">{times[i]}</trkpt>' for i in piece)
        rows += ["<trkseg>", *places, "</trkseg>"]
    overwrite(path, "\n".join([*rows, "</trk>", "</gpx>", ""]).encode())


def write_geojson(path: str | os.PathLike, points: GeoPoint, *, name: str = "wmrlib") -> None:
    """Write positions as a GeoJSON Feature (RFC 7946) with 7 decimals (a centimetre).

    Parameters
    ----------
    path, name : str or PathLike of the file, and str, the property "name"
    points : GeoPoint of arrays; of a driven Trajectory, `point_at(origin, run.x, run.y)`

    Raises
    ------
    ValueError : no position, or a name that is no text or that UTF-8 can't hold
    OSError : as `write_gpx`
    """
    lat, lon = _rounded(points)
    _check_name(name, _NOT_IN_UTF8)
    places = np.column_stack([lon, lat])
    lines = [places[piece].tolist() for piece in _pieces(lon)]
    for before, after in pairwise(lines):
        (x, y), (next_x, next_y) = before[-1], after[0]
        side, gap = math.copysign(180.0, x), 360.0 - abs(next_x - x)
        share = abs(side - x) / gap if gap > 0.0 else 0.0
        crossing = round(y + share * (next_y - y), _DECIMALS)
        before.append([side, crossing])
        after.insert(0, [-side, crossing])
    kind, coordinates = "MultiLineString", lines
    if len(lines) == 1:
        kind, coordinates = ("LineString", lines[0]) if lat.size > 1 else ("Point", lines[0][0])
    geometry = {"type": kind, "coordinates": coordinates}
    feature = {"type": "Feature", "properties": {"name": name}, "geometry": geometry}
    text = json.dumps(feature, ensure_ascii=False, allow_nan=False) + "\n"
    overwrite(path, text.encode())


def overwrite(path: str | os.PathLike, data: bytes) -> None:
    """Replace a file's content at once; what was there stays where that fails."""
    if os.path.exists(path) or not os.path.basename(path):
        with open(path, "ab") as file:  # refused here, if it is read-only or a folder
            if not os.path.isfile(path):  # a pipe
                file.write(data)
                return
    target = Path(os.path.realpath(path))  # a link stays a link
    new = target.with_name(f".{secrets.token_hex(8)}.tmp")
    try:
        with new.open("xb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        if target.exists():
            shutil.copymode(target, new)
        new.replace(target)
    except OSError as error:  # it may name the new file
        raise OSError(error.errno, error.strerror, os.fspath(path)) from None
    finally:
        with suppress(OSError):
            new.unlink()


def _rounded(points: GeoPoint) -> tuple[np.ndarray, np.ndarray]:
    lat, lon = position_list(points)
    return np.round(lat, _DECIMALS) + 0.0, np.round(lon, _DECIMALS) + 0.0  # no -0.0


def _pieces(lon: np.ndarray) -> list[np.ndarray]:
    """The indices of the positions between one crossing of the date line and the next."""
    return np.split(np.arange(lon.size), np.flatnonzero(np.abs(np.diff(lon)) > 180.0) + 1)


def _times(t: Any, begin: datetime, shape: tuple[int, ...]) -> list[str]:
    if instance("begin", begin, datetime).utcoffset() is None:
        raise ValueError(f"begin = {begin!r} is not allowed: one with its time zone is needed")
    t = np.atleast_1d(real("t", t, nan=True))
    if t.shape != shape:
        raise ValueError(f"mismatched lengths: t has shape {t.shape}, points have shape {shape}")
    try:  # in UTC, so that a change to summer time loses no hour
        begin = begin.astimezone(UTC)
        times = [None if math.isnan(s) else begin + timedelta(seconds=s) for s in t.tolist()]
    except OverflowError:
        raise refusal("t", t, "begin + t in the years 1 to 9999") from None
    return [f"<time>{time.isoformat()[:-6]}Z</time>" if time else "" for time in times]


def _check_name(name: str, forbidden: re.Pattern) -> None:
    if found := forbidden.search(instance("name", name, str)):
        raise ValueError(f"name = {name!r} is not allowed: one without {found[0]!r} is needed")
