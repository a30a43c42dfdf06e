"""GPX files, read and written by gpxpy; nothing reaches gpxpy before defusedxml has refused what XML can be misused for."""

from __future__ import annotations

import math
import re
from datetime import UTC, datetime, timedelta
from typing import NamedTuple
from xml.etree.ElementTree import Element, ParseError, tostring
from xml.sax import SAXParseException
from xml.sax.handler import ContentHandler

import gpxpy
import numpy as np
from defusedxml import DefusedXmlException, sax
from defusedxml.ElementTree import fromstring
from gpxpy.gpx import GPX, GPXException, GPXTrack, GPXTrackPoint, GPXTrackSegment

from wmrlib.tracks.fixes import NO_TIME, Fixes, misplaced, number

_KINDS = ("trkpt", "rtept", "wpt")  # the first that a file has is its track
_READ = {"gpx", "rte", "trk", "trkseg", "time", *_KINDS}
_OTHERS = {
    "kml": "it is a KML file, not a GPX file; export it as GPX",
    "html": "it is a web page, not a GPX file",
    "trainingcenterdatabase": "it is a TCX file, not a GPX file; export it as GPX",
}
_WEB_PAGE = re.compile(rb"<(!doctype\s+)?html\b", re.IGNORECASE)


class _Place(NamedTuple):
    line: int
    lat: str | None
    lon: str | None
    times: list[str]


class _Outline(ContentHandler):
    """The root's name and the places of each kind with their lines, which gpxpy does not know."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.root = ""
        self.places: dict[str, list[_Place]] = {kind: [] for kind in _KINDS}

    def setDocumentLocator(self, locator):  # noqa: N802
        self.locator = locator

    def startElement(self, name, attrs):  # noqa: N802
        name = name.rpartition(":")[2]
        self.root = self.root or name
        if name in self.places:
            self.places[name].append(
                _Place(self.locator.getLineNumber(), attrs.get("lat"), attrs.get("lon"), [])
            )
        self.open.append(name)

    def endElement(self, name):  # noqa: N802
        self.open.pop()

    def characters(self, content):
        if len(self.open) > 1 and self.open[-1] == "time" and self.open[-2] in self.places:
            self.places[self.open[-2]][-1].times.append(content)


def read(data: bytes) -> Fixes:
    """The track points of all segments in order; of a file without any the route points, or else the waypoints."""
    outline = _Outline()
    try:
        sax.parseString(data, outline, forbid_dtd=True)
    except DefusedXmlException as error:
        if _WEB_PAGE.search(data[:1000]):
            raise ValueError(_OTHERS["html"]) from None
        raise ValueError(
            f"its XML holds a document type or an entity ({type(error).__name__}), which is not read"
        ) from None
    except (SAXParseException, LookupError, ValueError) as error:
        raise ValueError(
            _OTHERS.get(outline.root.casefold(), f"its XML is broken: {error}")
        ) from None
    if outline.root != "gpx":
        raise ValueError(
            _OTHERS.get(
                outline.root.casefold(), f"it is XML of the kind {outline.root!r}, not a GPX file"
            )
        )
    kind = next((kind for kind in _KINDS if outline.places[kind]), "trkpt")
    fixes = Fixes()
    for other in set(_KINDS) - {kind}:
        for place in outline.places[other]:
            fixes.skip("waypoint or route point beside the track", place.line)
    for place, point in zip(outline.places[kind], _points(data, outline, kind), strict=True):
        lat, lon = number(place.lat), number(place.lon)
        if place.lat is None or place.lon is None:
            fixes.skip("point without a latitude or longitude", place.line)
        elif misplaced(lat, lon):
            fixes.skip(misplaced(lat, lon), place.line)
        else:
            if point.time is None and "".join(place.times).strip():
                fixes.note("with an unreadable time", place.line)
            fixes.add(point.latitude, point.longitude, _seconds(point.time), place.line)
    return fixes


def _points(data: bytes, outline: _Outline, kind: str) -> list:
    """The points of one kind by gpxpy. It refuses a whole file for one bad number, so such a place stands at 0, 0 for it.

    For the same reason it is shown no height, number of satellites, bounds or extension: nothing here reads them.
    """
    try:
        root = fromstring(data, forbid_dtd=True)
    except (ParseError, LookupError, ValueError) as error:
        raise ValueError(f"its XML is broken: {error}") from None
    places = {kind: iter(outline.places[kind]) for kind in _KINDS}
    for element in list(root.iter()):
        name = _name(element)
        element[:] = [child for child in element if _name(child) in _READ]
        if name in _READ:
            element.tag = name  # whatever its prefix
        if name == "time":
            element.text = (element.text or "").strip()
        if name in places:
            place = next(places[name])
            if misplaced(number(place.lat), number(place.lon)):
                element.attrib.update(lat="0", lon="0")
    try:
        gpx = gpxpy.parse(tostring(root, encoding="unicode"))
    except RecursionError:
        raise ValueError("its XML is nested too deep") from None
    except (GPXException, ValueError) as error:
        raise ValueError(f"gpxpy does not read it: {error}") from None
    if kind == "wpt":
        found = gpx.waypoints
    elif kind == "rtept":
        found = [point for route in gpx.routes for point in route.points]
    else:
        found = [
            point for track in gpx.tracks for segment in track.segments for point in segment.points
        ]
    if len(found) != len(outline.places[kind]):
        raise ValueError(
            f"it has {len(outline.places[kind])} places <{kind}>, but only {len(found)} where GPX has them"
        )
    return found


def _name(element: Element) -> str:
    return element.tag.rpartition("}")[2]


def _seconds(time: datetime | None) -> float:
    if time is None:
        return NO_TIME
    return (time if time.tzinfo else time.replace(tzinfo=UTC)).timestamp()


def _date(begin: datetime, t: float) -> datetime | None:
    try:
        return (
            None if math.isnan(t) else begin.astimezone(UTC) + timedelta(seconds=t)
        )  # a clock that is put forward loses no hour
    except OverflowError:
        raise ValueError(
            f"t = {t:g} is not allowed: begin + t in the years 1 to 9999 is needed"
        ) from None


def text(
    lat: np.ndarray, lon: np.ndarray, t: np.ndarray | None, begin: datetime | None, name: str
) -> str:
    """A GPX 1.1 document of one track; a new segment where it crosses the date line, so that no viewer draws a line round the Earth."""
    lon = np.where(lon == 180.0, -180.0, lon)  # GPX 1.1: below 180
    track = GPXTrack(name=name)
    for i, place in enumerate(zip(lat.tolist(), lon.tolist(), strict=True)):
        if i == 0 or abs(lon[i] - lon[i - 1]) > 180.0:
            track.segments.append(GPXTrackSegment())
        track.segments[-1].points.append(
            GPXTrackPoint(*place, time=None if t is None else _date(begin, float(t[i])))
        )
    gpx = GPX()
    gpx.creator = "wmrlib"
    gpx.tracks.append(track)
    return gpx.to_xml(version="1.1")
