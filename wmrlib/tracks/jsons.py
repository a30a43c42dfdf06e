"""Positions in GeoJSON, and in the JSON lines of gpsd."""

import json
import math
from typing import Any, TextIO

from wmrlib.tracks import nmea
from wmrlib.tracks.fixes import Fixes, Reported, timestamp

_DEPTH = {"Point": 0, "MultiPoint": 1, "LineString": 1, "MultiLineString": 2}  # of its lists
_STATUS = {1.0: 1.0, 2.0: 2.0, 3.0: 4.0, 4.0: 5.0}  # of gpsd, as quality of GGA
_TIMES = ("coordTimes", "times", "time", "timestamp", "datetime", "date_time")
_Line = tuple[int, Any, Any]  # a feature's number, its positions and their times
_ESTIMATED = {5, 8}  # by dead reckoning alone, and simulated


def read(text: TextIO) -> tuple[str, Fixes]:
    """The source and the positions; ValueError for JSON of another kind."""
    if gpsd := "class" in _parsed(text.readline()):
        text.seek(0)
        fixes = _gpsd(text)
        if fixes.table:
            return "gpsd", fixes
    text.seek(0)
    found = {} if gpsd else _parsed(text.read())
    if str(found.get("type")) in {*_DEPTH, "Feature", "FeatureCollection"}:
        return "GeoJSON", _geojson(found)
    text.seek(0)  # gpspipe -r writes sentences below a few messages
    if sentences := nmea.read(nmea.numbered(text), Fixes()):
        return "NMEA", sentences
    if gpsd:
        return "gpsd", fixes
    raise ValueError("it is JSON, but not a whole GeoJSON or a gpsd log; export it as GPX")


def _parsed(text: str) -> dict[str, Any]:
    """The object of a text; empty if it holds none."""
    try:
        found = json.loads(text)
    except (ValueError, RecursionError):
        return {}
    return found if isinstance(found, dict) else {}


def _geojson(found: dict[str, Any]) -> Fixes:
    """The positions of all lines, each a segment; without any line those of the points."""
    fixes = Fixes(place="feature")
    lines, points = list[_Line](), list[_Line]()
    features = found.get("features") if found["type"] == "FeatureCollection" else [found]
    for row, feature in enumerate(features if isinstance(features, list) else [], 1):
        try:
            geometry = feature["geometry"] if feature["type"] == "Feature" else feature
            depth, places = _DEPTH[geometry["type"]], geometry["coordinates"]
            properties = feature.get("properties") or {}
            properties = {**properties, **(properties.get("coordinateProperties") or {})}
            times = next((properties[name] for name in _TIMES if name in properties), None)
            if depth < 2:
                places, times = [places], [times]
            for k, part in enumerate(places):
                own = times[k] if isinstance(times, list) and len(times) == len(places) else None
                if depth == 0:
                    points.append((row, [part], [own]))
                else:
                    several = isinstance(own, list) and len(own) == len(part)
                    lines.append((row, part, own if several else [None] * len(part)))
        except (KeyError, TypeError, AttributeError):
            fixes.skip("feature that is neither a line nor a point", row)
    for row, *_ in points if lines else []:
        fixes.skip("point beside the lines", row)
    for row, part, times in lines or points:
        fixes.segment += bool(lines)
        for place, time in zip(part, times, strict=True):
            lon, lat = (_float(x) for x in place[:2]) if _is_place(place) else (math.nan, math.nan)
            # As write_geojson has it, lines go on beyond the date line.
            lon = math.remainder(lon, 360.0) if 180.0 < abs(lon) < math.inf else lon
            seconds = math.nan if time is None else timestamp(str(time))
            fixes.add(lat, lon, seconds, row)
    return fixes


def _is_place(place: Any) -> bool:
    return isinstance(place, list) and len(place) > 1


def _float(value: Any) -> float:
    """The finite number of a value, or NaN."""
    return float(value) if type(value) in (int, float) and abs(value) < 1e300 else math.nan


def _gpsd(text: TextIO) -> Fixes:
    fixes = Fixes()
    for line, words in nmea.numbered(text):
        message = _parsed(words)
        if message.get("class") != "TPV":
            if words.strip():
                fixes.skip("other message" if message else "line that is no message", line)
            continue
        keys = ("lat", "lon", "mode", "status", "speed", "track", "eph")
        lat, lon, mode, status, *rest = (_float(message.get(key)) for key in keys)
        if mode not in (2, 3) or status in _ESTIMATED:
            fixes.skip("TPV without a fix", line)
            continue
        fixes.receiver = str(message.get("device", ""))
        speed, track, eph = rest
        time, course = message.get("time"), math.radians(track)
        reported = Reported(_STATUS.get(status, math.nan), speed=speed, course=course, accuracy=eph)
        fixes.add(lat, lon, math.nan if time is None else timestamp(str(time)), line, reported)
    return fixes
