"""Positions in GPX files; defusedxml refuses what XML can be misused for."""

from __future__ import annotations

import re
from io import BytesIO
from typing import Any, NamedTuple
from xml.sax import SAXParseException
from xml.sax.handler import ContentHandler, feature_namespaces

from defusedxml import DefusedXmlException, sax

from wmrlib.tracks.fixes import NO_TIME, Fixes, number, timestamp

# Where each kind of place belongs; the first kind that a file has is its track.
_PATHS = {
    "trkpt": ["gpx", "trk", "trkseg", "trkpt"],
    "rtept": ["gpx", "rte", "rtept"],
    "wpt": ["gpx", "wpt"],
}
_OTHERS = {
    "kml": "it is a KML file, not a GPX file; export it as GPX",
    "html": "it is a web page, not a GPX file",
    "trainingcenterdatabase": "it is a TCX file, not a GPX file; export it as GPX",
}
_WEB_PAGE = re.compile(rb"<(!doctype\s+)?html\b", re.IGNORECASE)


class _Place(NamedTuple):
    line: int
    path: list[str]
    lat: str | None
    lon: str | None
    times: list[str]


class _Outline(ContentHandler):
    """The places of a GPX file, each with its line."""

    _locator: Any

    def __init__(self) -> None:
        super().__init__()
        self.path: list[str] = []
        self.root = ""
        self.places: list[_Place] = []

    def startElementNS(self, name, qname, attrs):  # noqa: N802
        self.path.append(name[1])
        self.root = self.root or name[1]
        if name[1] in _PATHS:
            line, lat, lon = self._locator.getLineNumber(), (None, "lat"), (None, "lon")
            self.places.append(_Place(line, [*self.path], attrs.get(lat), attrs.get(lon), []))

    def endElementNS(self, name, qname):  # noqa: N802
        self.path.pop()

    def characters(self, content):
        if self.places and self.path == [*self.places[-1].path, "time"]:
            self.places[-1].times.append(content)


def read(data: bytes) -> Fixes:
    """The track points of all segments; without any the route points, or else the waypoints."""
    places = _places(data)
    kinds = [place.path[-1] for place in places]
    kind = next((kind for kind in _PATHS if kind in kinds), "trkpt")
    count, expected = kinds.count(kind), sum(place.path == _PATHS[kind] for place in places)
    if expected < count:
        raise ValueError(f"it has {count} places <{kind}>, but only {expected} where GPX has them")
    fixes = Fixes()
    for line, path, lat, lon, times in places:
        if path[-1] != kind:
            fixes.skip("waypoint or route point beside the track", line)
        elif lat is None or lon is None:
            fixes.skip("point without a latitude or longitude", line)
        else:
            text = "".join(times).strip()
            fixes.add(number(lat), number(lon), timestamp(text) if text else NO_TIME, line)
    return fixes


def _places(data: bytes) -> list[_Place]:
    outline, parser = _Outline(), sax.make_parser()
    parser.forbid_dtd = True
    parser.setFeature(feature_namespaces, True)
    parser.setContentHandler(outline)
    try:
        parser.parse(BytesIO(data))
        if outline.root == "gpx":
            return outline.places
        wrong = f"it is XML of the kind {outline.root!r}, not a GPX file"
    except DefusedXmlException as error:
        name = type(error).__name__
        wrong = f"its XML holds a document type or an entity ({name}), which is not read"
        if _WEB_PAGE.search(data[:1000]):
            outline.root = "html"
    except (SAXParseException, LookupError, ValueError) as error:
        wrong = f"its XML is broken: {error}"
    raise ValueError(_OTHERS.get(outline.root.casefold(), wrong))
