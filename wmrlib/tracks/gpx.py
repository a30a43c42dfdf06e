"""Positions in GPX files, read as a stream; without a document type XML has no entities."""

from __future__ import annotations

import re
from io import BufferedReader
from typing import Any
from xml.parsers import expat

from wmrlib.tracks.fixes import NO_TIME, Count, Fixes, count, number, timestamp

# Where each kind of place belongs; the first kind that a file has is its track.
_PARENT = {"trkpt": "trkseg", "rtept": "rte", "wpt": "gpx"}
_WORDS = {"trkpt": "track point", "rtept": "route point", "wpt": "waypoint"}
_SPACES = {"", "http://www.topografix.com/GPX/1/0", "http://www.topografix.com/GPX/1/1"}
_FOREIGN = "extensions"
_OTHERS = {
    "kml": "it is a KML file, not a GPX file; export it as GPX",
    "html": "it is a web page, not a GPX file",
    "trainingcenterdatabase": "it is a TCX file, not a GPX file; export it as GPX",
}
_BLOCK = 1 << 18  # bytes
_WEB_PAGE = re.compile(rb"<(!doctype\s+)?html\b", re.IGNORECASE)


class _Outline:
    """The places of a GPX file, by their kind; expat calls the methods."""

    def __init__(self, parser: expat.XMLParserType) -> None:
        self.places = {kind: Fixes() for kind in _PARENT}
        self.met: dict[str, Count] = {}
        self.path: list[str] = []
        self.spaces: set[str] = set()
        self.clock: list[str] = []
        self.parser = parser
        parser.buffer_text = True
        parser.StartDoctypeDeclHandler = self.doctype
        parser.StartElementHandler = self.root
        parser.EndElementHandler = self.end

    def doctype(self, name: str, *_: Any) -> None:
        wrong = "its XML holds a document type or an entity, which is not read"
        raise ValueError(_OTHERS.get(name.casefold(), wrong))

    def root(self, name: str, _: Any) -> None:
        space, _, kind = name.rpartition(" ")
        if kind != "gpx":
            wrong = f"it is XML of the kind {kind!r}, not a GPX file"
            raise ValueError(_OTHERS.get(kind.casefold(), wrong))
        self.path.append(kind)
        self.spaces = {space, *_SPACES}
        self.parser.StartElementHandler = self.start

    def start(self, name: str, attributes: dict[str, str]) -> None:
        parent, (space, _, name) = self.path[-1], name.rpartition(" ")
        if parent == _FOREIGN or space not in self.spaces:
            name = _FOREIGN
        elif name in _PARENT:
            line = self.parser.CurrentLineNumber
            count(self.met, name, line)
            if parent == _PARENT[name]:
                self.place = attributes.get("lat"), attributes.get("lon"), line
            else:
                self.places[name].skip(f"{_WORDS[name]} outside <{_PARENT[name]}>", line)
                name = ""
        elif name == "time" and parent in _PARENT:
            self.parser.CharacterDataHandler = self.clock.append
        elif name == "trkseg":
            self.places["trkpt"].begin_segment()
        self.path.append(name)

    def end(self, _: Any) -> None:
        name = self.path.pop()
        if name == "time":
            self.parser.CharacterDataHandler = None
        elif name in _PARENT:
            (lat, lon, line), time = self.place, "".join(self.clock).strip()
            self.clock.clear()
            fixes, passed = self.places[name], name == "trkpt"
            second = timestamp(time) if passed and time else NO_TIME
            if lat is None or lon is None:
                fixes.skip("point without a latitude or longitude", line)
            elif fixes.add(number(lat), number(lon), second, line) and time and not passed:
                fixes.note("with a time, which tells when it was made, not passed", line)


def read(file: BufferedReader) -> Fixes:
    """The track points of all segments; without any the route points, or else the waypoints."""
    head = file.peek()
    encoding = "utf-16" if head.startswith((b"\xff\xfe", b"\xfe\xff")) else None
    outline = _Outline(expat.ParserCreate(encoding, " "))
    try:
        read = 0
        while block := file.read(_BLOCK):
            outline.parser.Parse(block)
            read += len(block)
            # What is not complete, expat reads again with each block.
            if read - max(0, outline.parser.CurrentByteIndex) > 8 * _BLOCK:
                raise ValueError("its XML holds a tag of more than 2 MB")
        outline.parser.Parse(b"", True)
    except (expat.ExpatError, LookupError) as error:
        page = not outline.spaces and _WEB_PAGE.search(head.replace(b"\0", b""))
        raise ValueError(_OTHERS["html"] if page else f"its XML is broken: {error}") from None
    finally:
        del outline.parser  # it refers to the outline, which would be kept
    kind, *others = [kind for kind in _PARENT if kind in outline.met] or ["trkpt"]
    for other in others:
        times, line = outline.met[other]
        outline.places[kind].skip(f"{_WORDS[other]} beside the {_WORDS[kind]}s", line, times)
    return outline.places[kind]
