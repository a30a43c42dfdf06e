"""Positions in CSV tables whose header names the columns."""

import csv
import math
import re
from collections.abc import Iterator
from functools import partial
from itertools import chain, islice
from typing import NamedTuple, TextIO

from wmrlib.tracks.fixes import KNOT, LONGEST, Fixes, Reported, number, reading, timestamp

_OF = "((gps|gnss|fix|field|location) )*"  # as ROS and some apps name them
_LAT, _LON = f"{_OF}lat(itude)?", f"{_OF}(lng|long?|longitude)"
_SIDE = "(dir|direction|ref|reference|hemi|hemisphere|indicator)"
_TIME = "((date|up|i)?time|timestamp|i?tow|date|stamp|epoch|unix|ts|utc|clock|millis|elapsed"
_TIME += "|(milli)?sec(ond)?s?|hours?|datum|(uhr)?zeit|fecha|hora|heure)"
_PARTS = {"": 1.0, "m": 1e3, "milli": 1e3, "u": 1e6, "micro": 1e6, "n": 1e9, "nano": 1e9}
_SECONDS = ("s", "sec", "secs", "second", "seconds")
_PER = {part + word: per for part, per in _PARTS.items() for word in _SECONDS}
_UNIT = f"( ({'|'.join(_PER)}))?"
_ROLES = {  # of a column, by the words of its name; the first that fits
    "lat": f"{_LAT}( deg| degrees)?( n s)?( e7| wgs84)?",
    "lon": f"{_LON}( deg| degrees)?( e w)?( e7| wgs84)?",
    "N/S": f"(n ?s|north south)( indicator)?|{_LAT} {_SIDE}",
    "E/W": f"(e ?w|east west)( indicator)?|{_LON} {_SIDE}",
    "date": "((gps |utc )?date|date (gps|utc))",
    "time": f"((gps |utc )?time|timestamp|date ?time|t)( utc)?{_UNIT}|(seconds|ms) elapsed"
    f"|elapsed( time)?{_UNIT}|millis|micros",
    "minutes": f"({_LAT}|{_LON}) ?(.* )?(m|mins?|minutes?|s|secs?|seconds?)",  # of a degree
    "other time": f"(.* )?{_TIME}( .*)?|t (min(ute)?s?|h)",
    "fix": "((is|has|gps|gnss) )*(valid|fix)( ok| valid)?",
    "quality": "(fix |gps )?quality",
    "fix mode": "(gps )?fix mode",
    "fix type": "(gps )?fix type",
    "status": f"{_OF}status( status)?",
    "receiver": "((gps|gnss) )?(device|receiver|instance|tracker)( id| name)?",
    "satellites": "(num(ber of)? )?(sv|sats?|satellites)( used)?|n ?sats?|num ?sv",
    "hdop": "hdop",
    "accuracy": "(gps |horizontal |position )?accuracy( m| meters| metres)?|h ?acc m",
    "speed": "((ground |gps )?(speed|velocity)|speed over ground|sog)"
    "( m s| mps| km h| kmh| kph| knots?| kts?| kn| mph)?",
    "course": "(course( over ground)?|cog|bearing|direction)( deg| degrees)?",
}
_PER |= {"e7": 1e7, "t": 1.0, "mps": 1.0, "millis": 1e3, "micros": 1e6}
_PER |= dict.fromkeys(("h", "kmh", "kph"), 3.6) | {"mph": 1.0 / 0.44704}
_PER |= dict.fromkeys(("knot", "knots", "kt", "kts", "kn"), 1.0 / KNOT)
_PLAIN = ("sps", "gps", "gnss", "single", "autonomous")
_FIX = {*_PLAIN, *"yadprf123459", "yes", "true", "ok", "valid", "fix", "fixed", "float", ""}
_FIX |= {"dgps", "pps", "rtk", "frtk"}
_QUALITY = {"float": 5.0, "frtk": 5.0, "rtk": 4.0, "pps": 3.0, "dgps": 2.0}  # first word to fit
_QUALITY |= dict.fromkeys(_PLAIN, 1.0)  # "fixed" may be any fix
_FIX_TYPES = {"2": 1.0, "3": 1.0, "4": 2.0, "5": 5.0, "6": 4.0, "8": 3.0}  # MAVLink, ArduPilot
# The first word says so, unless another one denies it.
_GOOD = {"fix": _FIX, "quality": _FIX, "fix mode": _FIX - {"1"}, "status": _FIX | {"0"}}
_GOOD["fix type"] = _FIX - {"1", "9"} | _FIX_TYPES.keys() | {"7"}
_ARDUPILOT = {"Status": "fix type", "I": "receiver"}
_DENIED = {"no", "none", "not", "invalid"}
_MINUTES = re.compile(r"[-+NSEW ]*0[0-9]{3,}(\D|$)")
_FIRST = 100  # rows that tell which of several columns can be read


class _Column(NamedTuple):
    name: str
    place: int
    role: str  # "" for none
    per: float  # how many of its unit make one of the role's; 0 where it names none


def read(text: TextIO) -> Fixes:
    """Rows under the first line that names the columns; LookupError where none does."""
    fixes, cut_off = Fixes(), list[int]()
    lines = _lines(text, cut_off)
    try:
        header, delimiter, columns = _header(lines, fixes)
        rows = csv.reader(lines, delimiter=delimiter, strict=True)
        numbered = ((header + rows.line_num, row) for row in rows if "".join(row).strip())
        first = list(islice(numbered, _FIRST))
        used, unused = _chosen(columns, [row for _, row in first if len(row) >= len(columns)])
        for line, row in chain(first, numbered):
            try:
                lat, lon, time, doubt = _position(columns, used, row)
                fixes.receiver = row[used["receiver"].place] if "receiver" in used else ""
                fixes.add(lat, lon, time, line, _reported(used, row), doubt)
            except ValueError as error:
                fixes.skip(str(error), line)
    except csv.Error as error:
        raise ValueError(f"its table is broken: {error}") from None
    if fixes.table:
        begin = int(fixes.table[0])
        for reason in unused:
            fixes.noted.count(reason, begin, len(fixes))
        for line in cut_off:
            fixes.noted.count("in a last line without an end, which may be cut off", line)
    return fixes


def _lines(text: TextIO, cut_off: list[int]) -> Iterator[str]:
    """The lines; a last one without an end, which may be cut off, is put into `cut_off`."""
    for row, line in enumerate(iter(partial(text.readline, LONGEST), ""), 1):
        if len(line) == LONGEST and not line.endswith("\n"):
            raise csv.Error(f"a line has more than {LONGEST} characters")
        if line.strip() and not line.endswith(("\n", "\r")):
            cut_off.append(row)
        yield line


def _header(lines: Iterator[str], fixes: Fixes) -> tuple[int, str, list[_Column]]:
    """The number of the line that names the columns, its delimiter, and the columns."""
    titles: list[str] = []
    for row, line in enumerate(lines, 1):
        excerpt, comment = repr(line.strip()[:80]), line.startswith("#")
        for delimiter in "" if comment or len(line) == LONGEST else ",;\t|":
            names = next(csv.reader([line], delimiter=delimiter))
            columns = [_column(name.strip(), place) for place, name in enumerate(names)]
            if {"GMS", "GWk"} <= {*names}:  # ArduPilot's status is MAVLink's fix type
                columns = [c._replace(role=_ARDUPILOT.get(c.name, c.role)) for c in columns]
            if {"lat", "lon"} <= {column.role for column in columns}:
                return row, delimiter, columns
        if line.strip():
            fixes.skip("comment" if comment else "line above the names of the columns", row)
            titles += [] if comment else [excerpt]
        if len(titles) > 9 or len(line) == LONGEST:
            break
    needed = "as a table none of its first ten lines names lat and lon, or latitude and longitude"
    raise LookupError(f"{needed}; the first is {titles[0]}" if titles else needed)


def _column(name: str, place: int) -> _Column:
    words = re.sub("(?<=[a-z])(?=[A-Z])|(?=[eE]7$)|[^A-Za-z0-9]+", " ", name).casefold().split()
    role = next((role for role in _ROLES if re.fullmatch(_ROLES[role], " ".join(words))), "")
    units = [_PER[word] for word in reversed(words) if word in _PER]
    return _Column(name, place, role, next(iter(units), float(role not in ("time", "speed"))))


def _chosen(columns: list[_Column], rows: list[list[str]]) -> tuple[dict[str, _Column], list[str]]:
    """The best column of each role, and why others are not used; `rows` are the first of all."""
    by_role: dict[str, list[_Column]] = {}
    for column in columns:
        by_role.setdefault(column.role, []).append(column)
    used = {role: same[0] for role, same in by_role.items() if role}
    if "N/S" in used and all(_number(row[used["N/S"].place]) > 1.0 for row in rows):
        del used["N/S"]  # RTKLIB's ns counts the satellites
        del by_role["N/S"]
    pairs = [(a, b) for a in by_role["lat"] for b in by_role["lon"] if _style(a) == _style(b)]
    if pairs:  # the first of the plainest
        used["lat"], used["lon"] = min(pairs, key=lambda pair: len(_style(pair[0])[0]))
    date = used.get("date")
    candidates = chain(*(by_role.get(role, []) for role in ("time", "other time", "date", "")))
    clocks = [(_best(column, date, rows), column) for column in candidates]
    # By another name a column is a time only if it can be read as one.
    clocks = [(key, column) for key, column in clocks if column.role or not key[0]]
    if clocks:
        used["time"] = min(clocks)[1]
    if "speed" in by_role:
        used["speed"] = max(by_role["speed"], key=lambda column: column.per > 0.0)
    reasons = [
        f"without their {other.name!r} beside {used[role].name!r}"
        for role in ("lat", "lon", "N/S", "E/W", "time", *Reported._fields)
        for other in by_role.get(role, [])
        if other != used[role]
    ]
    if "minutes" in by_role:
        name = used["minutes"].name
        cells = ([_number(row[used[k].place]) for row in rows] for k in ("lat", "lon"))
        if not all(any(x % 1.0 > 0.0 for x in degrees) for degrees in cells):
            raise ValueError(f"its column {name!r} has minutes of a degree, which is not read")
        reasons.append(f"without their {name!r} beside {used['lat'].name!r}")
    if "speed" in used and not used["speed"].per:
        # Android reports it in m/s, with these two beside it.
        if "accuracy" in by_role and any("bearing" in c.name.casefold() for c in columns):
            used["speed"] = used["speed"]._replace(per=1.0)
        else:
            reasons.append(f"without their {used.pop('speed').name!r}, which names no unit")
    return used, reasons


def _style(column: _Column) -> tuple[set[str], bool]:
    """The words of a name beside lat or lon, and whether those are written out."""
    name = column.name.casefold()
    words = re.sub("latitude|longitude|lat|long?|lng|[^a-z0-9]", " ", name).split()
    return {*words}, "itude" in name


def _best(column: _Column, date: _Column | None, rows: list[list[str]]) -> tuple[float, ...]:
    """A key for the least: what can be read, is a time by its name, differs, and has a zone."""
    seconds = [_seconds(column, date, row) for row in rows]
    known = {time for time in seconds if time is not None and not math.isnan(time)}
    cell = rows[0][column.place].strip() if rows else ""
    zone = re.search(r"(Z|:[0-9.]+[+-][0-9]{2}:?[0-9]{2})$", cell)
    kind = 0 if zone else 1 if math.isnan(_number(cell)) else 2 + (column.per == 1.0)
    return not known, column.role != "time", -len(known), kind, column.place


def _position(
    columns: list[_Column], used: dict[str, _Column], row: list[str]
) -> tuple[float, float, float | None, str]:
    """Latitude, longitude, time and, of one that is not read, why; or ValueError."""
    if row[0].startswith("#"):
        raise ValueError("comment")
    if len(row) < len(columns) or any(map(str.strip, row[len(columns) :])):  # decimal commas
        raise ValueError("row with more or fewer cells than the header")
    if "\n" in "".join(row) or "\r" in "".join(row):
        raise ValueError("row with a cell over several lines")
    for column in columns:
        if good := _GOOD.get(column.role):
            words = re.findall("[a-z]+|-?[0-9]+", row[column.place].casefold()) or [""]
            if words[0] not in good or not _DENIED.isdisjoint(words):
                raise ValueError("row without a measured fix")
    cells = {role: row[column.place].strip() for role, column in used.items()}
    lat = _degrees(cells["lat"], "NS", cells.get("N/S")) / used["lat"].per
    lon = _degrees(cells["lon"], "EW", cells.get("E/W")) / used["lon"].per
    if (clock := used.get("time")) is None:
        return lat, lon, math.nan, ""
    doubt = f"with an unreadable time in column {clock.name!r}"
    if not (clock.per and clock.role == "time") and math.isfinite(_number(cells["time"])):
        doubt = f"with a number in column {clock.name!r}, which would have to be t or time_ms"
    return lat, lon, _seconds(clock, used.get("date"), row), doubt


def _seconds(column: _Column, date: _Column | None, row: list[str]) -> float | None:
    """The time in a column, with a date beside it or not; NaN if empty, None if unreadable."""
    text = row[column.place].strip()
    if not text:
        return math.nan
    if column.per and column.role == "time" and math.isfinite(seconds := _number(text)):
        # Since 1970 ms are more than 1e11.
        return seconds / column.per if column.per * 1e11 > abs(seconds) else None
    if date is None or date == column or re.match("[0-9]{4}[-/]", text):
        return timestamp(text.replace("/", "-"))
    return timestamp(f"{row[date.place].strip().replace('/', '-')}T{text}")


def _reported(used: dict[str, _Column], row: list[str]) -> Reported:
    reported = {
        role: reading(row[column.place].strip().replace(",", "."), 1.0 / column.per)
        for role, column in used.items()
        if role in Reported._fields
    }
    kind = next((role for role in ("quality", "fix type", "fix") if role in used), "")
    text = row[used[kind].place].strip().casefold() if kind else ""
    words, number = re.findall("[a-z]+", text), reading(text.replace("9", "2"))
    if kind != "quality":
        number = _FIX_TYPES.get(text, math.nan) if kind == "fix type" else math.nan
    reported["quality"] = next((_QUALITY[word] for word in _QUALITY if word in words), number)
    reported["course"] = reported.get("course", math.nan) * math.radians(1.0)
    return Reported(**reported)


def _degrees(cell: str, sides: str, side: str | None) -> float:
    """Degrees, NaN if there are none; ValueError where sign and hemisphere leave a doubt."""
    if side is not None and side.upper()[:1] not in {*sides}:
        raise ValueError("row without a readable hemisphere")
    if _MINUTES.match(cell):
        raise ValueError("latitude or longitude in degrees and minutes (ddmm)")
    text = (cell + (side or "")[:1]).upper()
    bare = text.strip(sides + " \xba\xb0\udcba\udcb0")  # degree signs, of Latin-1 too
    plus, minus = (letter in text.replace(bare, "", 1) for letter in sides)
    if (plus and (minus or bare[:1] in ("-", "\u2212"))) or (minus and bare[:1] == "+"):
        raise ValueError("sign and hemisphere that contradict each other")
    return -abs(_number(bare)) if minus else _number(bare)


def _number(cell: str) -> float:
    """The number of a cell; a single comma is a decimal comma, since it does not end the cell."""
    return number((cell if "." in cell else cell.replace(",", ".", 1)).replace("\u2212", "-"))
