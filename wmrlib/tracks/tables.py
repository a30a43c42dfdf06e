"""Positions in CSV tables, and in GeoJSON, read and written."""

from __future__ import annotations

import csv
import json
import math
from datetime import UTC, datetime
from itertools import pairwise

import numpy as np

from wmrlib.tracks.fixes import NO_TIME, Fixes, number

LATITUDE, LONGITUDE, TIME = (
    {"lat", "latitude"},
    {"lon", "lng", "long", "longitude"},
    {"time", "timestamp", "datetime", "t"},
)
_DELIMITERS = ",;\t|"
_MOST_SECONDS = 1e11  # milliseconds since 1970 are more
_WGS84 = ("CRS84", "EPSG::4326", "EPSG:4326")


def read_csv(data: bytes) -> Fixes:
    """Rows under the first line that is neither blank nor a comment (#), which names the columns. A number may have a decimal comma."""
    lines = data.decode("utf-8", errors="replace").splitlines(keepends=True)
    fixes, header = (
        Fixes(),
        next(
            (i for i, line in enumerate(lines) if line.strip() and not line.startswith("#")), None
        ),
    )
    if header is None:
        raise ValueError("it has no header that names the columns of latitude and longitude")
    delimiter, columns = _header(lines[header])
    for line in range(header):
        if lines[line].strip():
            fixes.skip("comment", line + 1)
    try:
        _rows(lines[header:], header, delimiter, columns, fixes)
    except csv.Error as error:
        raise ValueError(f"its table is broken: {error}") from None
    if fixes.lat and lines[-1].strip() and not lines[-1].endswith(("\n", "\r")):
        fixes.note("in a last line without an end, which may be cut off", len(lines))
    return fixes


def _header(line: str) -> tuple[str, list[str]]:
    for delimiter in _DELIMITERS:
        try:
            columns = [
                cell.strip().casefold() for cell in next(csv.reader([line], delimiter=delimiter))
            ]
        except csv.Error:  # 131072 characters without a delimiter
            continue
        if LATITUDE & {*columns} and LONGITUDE & {*columns}:
            for names in (LATITUDE, LONGITUDE, TIME):
                if sum(column in names for column in columns) > 1:
                    raise ValueError(
                        f"its header names more than one column of {sorted(names & {*columns})}: {line.strip()[:80]!r}"
                    )
            return delimiter, columns
    wanted = f"one of {sorted(LATITUDE)} and one of {sorted(LONGITUDE)}"
    raise ValueError(
        f"it is no NMEA, GPX or GeoJSON, and as a table its first line {line.strip()[:80]!r} does not name {wanted}"
    )


def _rows(lines: list[str], before: int, delimiter: str, columns: list[str], fixes: Fixes) -> None:
    y, x, t = (
        next((i for i, column in enumerate(columns) if column in names), None)
        for names in (LATITUDE, LONGITUDE, TIME)
    )
    reader = csv.reader(lines, delimiter=delimiter, strict=True)
    next(reader)
    done = reader.line_num
    for row in reader:
        line, height, done = before + done + 1, reader.line_num - done, reader.line_num
        if not any(cell.strip() for cell in row):
            continue
        if row[0].startswith("#"):
            fixes.skip("comment", line)
        elif height > 1:
            fixes.skip("row with a cell over several lines", line)
        elif len(row) < len(columns) or any(
            cell.strip() for cell in row[len(columns) :]
        ):  # as a decimal comma makes them
            fixes.skip("row with more or fewer cells than the header", line)
        else:
            time = NO_TIME
            if t is not None and row[t].strip():
                time = _time(row[t].strip())
                if math.isnan(time):
                    fixes.note("with an unreadable time", line)
            fixes.add(_number(row[y]), _number(row[x]), time, line)


def _number(cell: str) -> float:
    """The number of a cell; its one comma is a decimal comma: between cells it is none, or the cell would not hold it."""
    return number(cell if "." in cell else cell.replace(",", ".", 1))


def _time(text: str) -> float:
    """Seconds, or an ISO 8601 time (UTC unless it says otherwise)."""
    seconds = _number(text)
    if math.isfinite(seconds):
        return seconds if abs(seconds) < _MOST_SECONDS else NO_TIME
    try:
        time = datetime.fromisoformat(text)
    except ValueError:
        return NO_TIME
    return (time if time.tzinfo else time.replace(tzinfo=UTC)).timestamp()


def read_geojson(data: bytes) -> Fixes:
    """The positions of all points and lines in order, longitude before latitude, RFC 7946; a cut at the date line is put together."""
    try:
        document = json.loads(data)
        lines = list(_lines(document))
    except (ValueError, RecursionError) as error:
        raise ValueError(f"its JSON is not read: {error}") from None
    if (
        isinstance(document, dict)
        and (crs := document.get("crs"))
        and not str(crs).rstrip("'}\" ").endswith(_WGS84)
    ):
        raise ValueError(f"its coordinates are not degrees on WGS84, but {str(crs)[:80]}")
    fixes, place = Fixes("position"), 0
    cuts = {
        i for i, (before, after) in enumerate(pairwise(lines)) if _is_cut(before, after)
    }  # after which line
    for i, line in enumerate(lines):
        for j, position in enumerate(line):
            place += 1
            if (j == 0 and i - 1 in cuts) or (j == len(line) - 1 and i in cuts):
                fixes.skip("cut at the date line", place)
            elif not _is_pair(position):
                fixes.skip("position that is no pair of numbers", place)
            else:
                fixes.add(float(position[1]), float(position[0]), NO_TIME, place)
    return fixes


def _lines(node) -> list[list]:
    """Each geometry as lists of positions."""
    kind = node.get("type") if isinstance(node, dict) else None
    members = {"FeatureCollection": "features", "GeometryCollection": "geometries"}
    if kind in ("FeatureCollection", "GeometryCollection") and isinstance(
        node.get(members[kind]), list
    ):
        for member in node[members[kind]]:
            yield from _lines(member)
    elif kind == "Feature":
        if node.get("geometry") is not None:
            yield from _lines(node["geometry"])
    elif kind in ("Point", "LineString", "MultiPoint", "MultiLineString") and isinstance(
        places := node.get("coordinates"), list
    ):
        lines = {
            "Point": [[places]],
            "MultiPoint": [[place] for place in places],
            "MultiLineString": places,
        }.get(kind, [places])
        yield from (line if isinstance(line, list) else [line] for line in lines)
    else:
        raise ValueError(f"it is no GeoJSON of points or lines, but of the kind {kind!r}")


def _is_pair(position) -> bool:
    numbers = position[:2] if isinstance(position, list) else []
    return len(numbers) == 2 and all(
        type(value) is float or (type(value) is int and abs(value) < 1000) for value in numbers
    )


def _is_cut(before: list, after: list) -> bool:
    if min(len(before), len(after)) < 2:  # points, not lines
        return False
    end, begin = before[-1], after[0]
    return (
        _is_pair(end)
        and _is_pair(begin)
        and end[1] == begin[1]
        and {end[0], begin[0]} == {180.0, -180.0}
    )


def geojson(lat: np.ndarray, lon: np.ndarray, name: str) -> str:
    """A Feature: a LineString, cut into a MultiLineString where it crosses the date line, or a Point."""
    lines: list[list[list[float]]] = [[]]
    for i, (y, x) in enumerate(zip(lat.tolist(), lon.tolist(), strict=True)):
        if i and abs(x - lon[i - 1]) > 180.0:
            side, before = math.copysign(180.0, lon[i - 1]), lines[-1][-1]
            gap = 360.0 - abs(x - before[0])
            share = abs(side - before[0]) / gap if gap > 0.0 else 0.0
            crossing = round(before[1] + share * (y - before[1]), 7)
            lines[-1].append([side, crossing])
            lines.append([[-side, crossing]])
        lines[-1].append([x, y])
    if len(lines) > 1:
        geometry = {"type": "MultiLineString", "coordinates": lines}
    else:
        single = len(lines[0]) == 1
        geometry = {
            "type": "Point" if single else "LineString",
            "coordinates": lines[0][0] if single else lines[0],
        }
    feature = {"type": "Feature", "properties": {"name": name}, "geometry": geometry}
    return json.dumps(feature, ensure_ascii=False, allow_nan=False) + "\n"
