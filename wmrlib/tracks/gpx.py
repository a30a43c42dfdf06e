"""Positions in GPX files, read as a stream; without a document type XML has no entities."""

import math
from io import BufferedReader
from xml.parsers import expat

from wmrlib.tracks.fixes import Fixes, Reported, Tally, number, reading, timestamp

# The parent and the name of each kind of place; the first kind that a file has is its track.
_PARENT = {"trkpt": "trkseg", "rtept": "rte", "wpt": "gpx"}
_WORDS = {"trkpt": "track point", "rtept": "route point", "wpt": "waypoint"}
_REPORTED = {"sat": "satellites", "hdop": "hdop", "speed": "speed", "course": "course"}
_REPORTED |= {"bearing": "course", "accuracy": "accuracy", "accuracy_horizontal": "accuracy"}
_FIELDS = {"time": "time", "fix": "fix"} | _REPORTED
_QUALITY = {"2d": 1.0, "3d": 1.0, "dgps": 2.0, "pps": 3.0}
_BLOCK = 1 << 18  # bytes


def read(file: BufferedReader) -> Fixes:
    """The track points of all segments; without any the route points, or else the waypoints."""
    wide = file.peek().startswith((b"\xff\xfe", b"\xfe\xff"))
    parser = expat.ParserCreate("utf-16" if wide else None)
    places, counts = {kind: Fixes() for kind in _PARENT}, Tally()
    path, place, pieces = list[str](), list[float](), list[str]()
    broken = ""
    values = dict[str, tuple[bool, str]]()  # of the point; whether it is within extensions, text

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
        elif name == "trkseg":
            places["trkpt"].segment += 1
        pieces.clear()  # of the text of one element
        parser.CharacterDataHandler = pieces.append if name in _FIELDS else None
        path.append(name)

    def end(_: str) -> None:
        parser.CharacterDataHandler = None
        name, text = path.pop(), "".join(pieces).strip()
        pieces.clear()
        if name in _PARENT:
            use(name)
        elif text and (kind := next(filter(path.__contains__, _PARENT), None)):
            field, inside = _FIELDS[name], path[-1] != kind
            if (field in Reported._fields and math.isnan(reading(text))) or (
                field == "time" and inside
            ):
                return
            before = values[field][1] if field in values else text
            if text != before and number(text) != number(before):
                places[kind].noted.count(f"with two values of {field}", int(place[2]))
            # The point's own child comes first, then the first within its extensions.
            if field not in values or inside < values[field][0]:
                values[field] = inside, text

    def use(name: str) -> None:
        texts = {field: text for field, (_, text) in values.items()}
        values.clear()
        lat, lon, line = place
        if texts.get("fix") == "none":
            return places[name].skip(f"{_WORDS[name]} without a fix", int(line))
        # The time of a waypoint tells when it was made, not when it was passed.
        time = texts.get("time") if name == "trkpt" else None
        reported = {field: reading(texts.get(field, "")) for field in _REPORTED.values()}
        reported["course"] *= math.radians(1.0)
        reported["quality"] = _QUALITY.get(texts.get("fix", ""), math.nan)
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
        if not any(fixes.table for fixes in places.values()):
            raise ValueError(f"its XML is broken: {error}") from None
        broken = f"rest of the file, whose XML is broken: {str(error).partition(':')[0]}"
    finally:
        parser.StartElementHandler = parser.EndElementHandler = None  # which refer to the places
    kind, *others = [kind for kind in _PARENT if kind in counts] or ["trkpt"]
    for other in others:
        times, line = counts[other]
        places[kind].skip(f"{_WORDS[other]} beside the {_WORDS[kind]}s", line, times)
    if broken:
        places[kind].skip(broken, parser.ErrorLineNumber)
    return places[kind]
