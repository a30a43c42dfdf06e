"""Positions in GPX files, read as a stream; without a document type XML has no entities."""

import math
from collections import defaultdict
from io import BufferedReader
from xml.parsers import expat

from wmrlib.tracks.fixes import Fixes, Reported, Tally, number, reading, timestamp

# The parent and the name of each kind of place; the first kind that a file has is its track.
_PARENT = {"trkpt": "trkseg", "rtept": "rte", "wpt": "gpx"}
_WORDS = {"trkpt": "track point", "rtept": "route point", "wpt": "waypoint"}
_REPORTED = {"sat": "satellites", "hdop": "hdop", "speed": "speed", "course": "course"}
_QUALITY = {"2d": 1.0, "3d": 1.0, "dgps": 2.0, "pps": 3.0}
_BLOCK = 1 << 18  # bytes


def read(file: BufferedReader) -> Fixes:
    """The track points of all segments; without any the route points, or else the waypoints."""
    wide = file.peek().startswith((b"\xff\xfe", b"\xfe\xff"))
    parser = expat.ParserCreate("utf-16" if wide else None)
    places, counts = {kind: Fixes() for kind in _PARENT}, Tally()
    path, place, texts = list[str](), list[float](), defaultdict[str, list[str]](list)

    def refuse(*_: object) -> None:
        raise ValueError("its XML holds a document type or an entity, which is not read")

    def start(name: str, attributes: dict[str, str]) -> None:
        name, line = name.rpartition(":")[2], parser.CurrentLineNumber
        if not path and name != "gpx":
            raise ValueError(f"it is a {name.upper()} file, not a GPX file; export it as GPX")
        if name in _PARENT:
            counts.count(name, line)
            if path[-1] == _PARENT[name]:
                place[:] = [*(number(attributes.get(key, "")) for key in ("lat", "lon")), line]
            else:
                places[name].skip(f"{_WORDS[name]} outside <{_PARENT[name]}>", line)
                name = ""
        elif (name == "time" and path[-1] in _PARENT) or (
            (name in _REPORTED or name == "fix") and not _PARENT.keys().isdisjoint(path)
        ):
            parser.CharacterDataHandler = texts[name].append
        elif name == "trkseg":
            places["trkpt"].segment += 1
        path.append(name)

    def end(_: str) -> None:
        parser.CharacterDataHandler = None
        if (name := path.pop()) in _PARENT:
            # The time of a waypoint tells when it was made, not when it was passed.
            words = {key: "".join(parts).strip() for key, parts in texts.items()}
            texts.clear()
            time = words.get("time") if name == "trkpt" else None
            reported = {field: reading(words.get(key, "")) for key, field in _REPORTED.items()}
            reported["course"] *= math.radians(1.0)
            reported["quality"] = _QUALITY.get(words.get("fix", ""), math.nan)
            lat, lon, line = place
            seconds = timestamp(time) if time else math.nan
            places[name].add(lat, lon, seconds, int(line), Reported(**reported))

    parser.StartDoctypeDeclHandler = refuse
    parser.StartElementHandler, parser.EndElementHandler = start, end
    try:
        while block := file.read(_BLOCK):
            parser.Parse(block)
            # Expat reads again with each block all of a tag that is not complete.
            if file.tell() - max(0, parser.CurrentByteIndex) > 8 * _BLOCK:
                raise ValueError("its XML holds a tag of more than 2 MB")
        parser.Parse(b"", True)
    except (expat.ExpatError, LookupError) as error:
        raise ValueError(f"its XML is broken: {error}") from None
    finally:
        parser.StartElementHandler = parser.EndElementHandler = None  # which refer to the places
    kind, *others = [kind for kind in _PARENT if kind in counts] or ["trkpt"]
    for other in others:
        times, line = counts[other]
        places[kind].skip(f"{_WORDS[other]} beside the {_WORDS[kind]}s", line, times)
    return places[kind]
