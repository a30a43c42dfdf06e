"""Positions in CSV tables and in GeoJSON."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

from wmrlib.tracks.fixes import NO_TIME, Fixes, number, timestamp

LATITUDE, LONGITUDE = {"lat", "latitude"}, {"lon", "lng", "long", "longitude"}
_COLUMNS = (LATITUDE, LONGITUDE, {"time", "timestamp", "datetime", "t"})
_DELIMITERS = ",;\t|"
_MOST_SECONDS = 1e11  # milliseconds since 1970 are more
_WGS84 = ("CRS84", "EPSG::4326", "EPSG:4326")


def read_csv(data: bytes) -> Fixes:
    """Rows under the first line that is neither blank nor a comment (#): the columns' names."""
    lines = data.decode("utf-8", errors="replace").splitlines(keepends=True)
    told = [i for i, line in enumerate(lines) if line.strip()]
    header = next((i for i in told if not lines[i].startswith("#")), None)
    if header is None:
        raise ValueError("it has no header that names the columns of latitude and longitude")
    delimiter, width, (y, x, t) = _header(lines[header])
    fixes = Fixes()
    for i in told[: told.index(header)]:
        fixes.skip("comment", i + 1)
    reader = csv.reader(lines[header:], delimiter=delimiter, strict=True)
    try:
        next(reader)
        done = reader.line_num
        for row in reader:
            line, height, done = header + done + 1, reader.line_num - done, reader.line_num
            filled = [bool(cell.strip()) for cell in row]
            if not any(filled):
                continue
            if row[0].startswith("#"):
                fixes.skip("comment", line)
            elif height > 1:
                fixes.skip("row with a cell over several lines", line)
            elif len(row) < width or any(filled[width:]):  # as a decimal comma makes them
                fixes.skip("row with more or fewer cells than the header", line)
            else:
                time = NO_TIME if t is None or not filled[t] else _time(row[t].strip())
                fixes.add(_number(row[y]), _number(row[x]), time, line)
    except csv.Error as error:
        raise ValueError(f"its table is broken: {error}") from None
    if fixes.lat and lines[-1].strip() and not lines[-1].endswith(("\n", "\r")):
        fixes.note("in a last line without an end, which may be cut off", len(lines))
    return fixes


def _header(line: str) -> tuple[str, int, list[Any]]:
    """The delimiter, the number of cells, and the columns of latitude, longitude and time."""
    shown = repr(line.strip()[:80])
    for delimiter in _DELIMITERS:
        try:
            cells = next(csv.reader([line], delimiter=delimiter))
        except csv.Error:  # 131072 characters without a delimiter
            continue
        names = [cell.strip().casefold() for cell in cells]
        found = [[i for i, name in enumerate(names) if name in known] for known in _COLUMNS]
        if found[0] and found[1]:
            for several in (columns for columns in found if len(columns) > 1):
                given = sorted({names[i] for i in several})
                raise ValueError(f"its header names more than one column of {given}: {shown}")
            return delimiter, len(names), [columns[0] if columns else None for columns in found]
    wanted = f"one of {sorted(LATITUDE)} and one of {sorted(LONGITUDE)}"
    first = f"as a table its first line {shown} does not name {wanted}"
    raise ValueError(f"it is no NMEA, GPX or GeoJSON, and {first}")


def _number(cell: str) -> float:
    """The number of a cell; a single comma is a decimal comma, since it does not end the cell."""
    return number(cell if "." in cell else cell.replace(",", ".", 1))


def _time(text: str) -> float | None:
    """Seconds or an ISO 8601 time; None if it is neither."""
    seconds = _number(text)
    if math.isfinite(seconds):
        return seconds if abs(seconds) < _MOST_SECONDS else None
    return timestamp(text)


def read_geojson(data: bytes) -> Fixes:
    """The positions of all points and lines, RFC 7946; a line cut at the date line is rejoined."""
    try:
        document = json.loads(data)
        lines = [list(line) for line in _lines(document)]
    except (ValueError, LookupError, TypeError, RecursionError) as error:
        raise ValueError(f"its JSON is not read: {error}") from None
    crs = document.get("crs")
    if crs and not str(crs).rstrip("'}\" ").endswith(_WGS84):
        raise ValueError(f"its coordinates are not degrees on WGS84, but {str(crs)[:80]}")
    fixes, place = Fixes("position"), 0
    cuts = [False, *(_is_cut(before, after) for before, after in pairwise(lines)), False]
    for line, cut_before, cut_after in zip(lines, cuts, cuts[1:], strict=False):
        for j, position in enumerate(line):
            place += 1
            if (j == 0 and cut_before) or (j == len(line) - 1 and cut_after):
                fixes.skip("cut at the date line", place)
            elif not _is_pair(position):
                fixes.skip("position that is no pair of numbers", place)
            else:
                fixes.add(float(position[1]), float(position[0]), NO_TIME, place)
    return fixes


def _lines(node: Any) -> Iterator[list]:
    """Each geometry as lists of positions, longitude before latitude."""
    kind = node.get("type") if isinstance(node, dict) else None
    if kind in ("FeatureCollection", "GeometryCollection"):
        for member in node["features" if kind == "FeatureCollection" else "geometries"]:
            yield from _lines(member)
    elif kind == "Feature":
        if node.get("geometry") is not None:
            yield from _lines(node["geometry"])
    elif kind == "Point":
        yield [node["coordinates"]]
    elif kind == "MultiPoint":
        yield from ([place] for place in node["coordinates"])
    elif kind in ("LineString", "MultiLineString"):
        yield from [node["coordinates"]] if kind == "LineString" else node["coordinates"]
    else:
        raise ValueError(f"it is no GeoJSON of points or lines, but of the kind {kind!r}")


def _is_pair(position: Any) -> bool:
    numbers = position[:2] if isinstance(position, list) else []
    return len(numbers) == 2 and all(
        type(value) is float or (type(value) is int and abs(value) < 1000) for value in numbers
    )


def _is_cut(before: list, after: list) -> bool:
    """Whether two lines meet at the date line as the two halves of one that was cut there."""
    if min(len(before), len(after)) < 2 or not (_is_pair(before[-1]) and _is_pair(after[0])):
        return False
    (lon, lat), (other_lon, other_lat) = before[-1][:2], after[0][:2]
    return lat == other_lat and {lon, other_lon} == {180.0, -180.0}
