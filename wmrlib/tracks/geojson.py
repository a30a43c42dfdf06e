"""Positions in GeoJSON, RFC 7946."""

from __future__ import annotations

import json
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

from wmrlib.tracks.fixes import NO_TIME, Fixes

_WGS84 = ("CRS84", "EPSG::4326", "EPSG:4326")


def read(text: str) -> Fixes:
    """The positions of all points and lines; a line cut at the date line is rejoined."""
    try:
        document = json.loads(text)
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
