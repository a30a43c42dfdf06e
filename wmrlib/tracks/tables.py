"""Positions in CSV tables whose header names the columns."""

import csv
import math
import re
from collections.abc import Iterator
from functools import partial
from typing import TextIO

from wmrlib.tracks.fixes import KNOT, LONGEST, Fixes, Reported, number, reading, timestamp

_LAT, _LON = "(gps )?lat(itude)?", "(gps )?(lng|long?|longitude)"
_SIDE = "(dir|direction|ref|reference|hemi|hemisphere|indicator)"
_ROLES = {  # of a column, by the words of its name; the first six once in a header
    "lat": f"{_LAT}( deg| degrees)?( n s)?( e7)?",
    "lon": f"{_LON}( deg| degrees)?( e w)?( e7)?",
    "N/S": f"(n ?s|north south)( indicator)?|{_LAT} {_SIDE}",
    "E/W": f"(e ?w|east west)( indicator)?|{_LON} {_SIDE}",
    "time": "((gps |utc )?time|timestamp|date ?time|t)( utc)?( s| sec| seconds| ms| us)?",
    "date": "date( utc)?",
    "minutes": f"({_LAT}|{_LON}) ?(.* )?(m|mins?|minutes?|s|secs?|seconds?)",  # of a degree
    "fix": "(is |gps )?(valid|fix)",
    "quality": "(fix |gps )?quality",
    "fix mode": "(gps )?fix (mode|type)",
    "status": "(fix |gps )?status",
    "satellites": "(num(ber of)? )?(sv|sats?|satellites)( used)?|n ?sat|num ?sv",
    "hdop": "hdop",
    "speed": "((ground )?speed|speed over ground|sog) (m s|mps|km h|kmh|kph|knots?|kts?|kn|mph)",
    "course": "(course( over ground)?|cog)( deg| degrees)?",
}
_PER = {"e7": 1e7, "t": 1.0, "s": 1.0, "sec": 1.0, "seconds": 1.0, "ms": 1e3, "us": 1e6}
_PER |= dict.fromkeys(("h", "kmh", "kph"), 3.6) | {"mph": 1.0 / 0.44704}
_PER |= dict.fromkeys(("knot", "knots", "kt", "kts", "kn"), 1.0 / KNOT)
_FIX = {"yes", "true", "ok", "valid", "fix", "fixed", "float", "y", "a", "d", "p", "r", "f", "gps"}
_FIX |= {"gnss", "sps", "dgps", "pps", "rtk", "frtk", "1", "2", "3", "4", "5", "9", ""}
_QUALITY = {"float": 5.0, "frtk": 5.0, "rtk": 4.0, "pps": 3.0, "dgps": 2.0}  # first word to fit
_QUALITY |= dict.fromkeys(("sps", "gps", "gnss"), 1.0)  # "fixed" may be any fix
# The first word says so.
_GOOD = {"fix": _FIX, "quality": _FIX, "fix mode": _FIX - {"1"}, "status": _FIX | {"0"}}
_Columns = list[tuple[str, float]]  # the role, "" for none, and how many make one of its unit


def read(text: TextIO) -> Fixes:
    """Rows under the first line that names the columns; LookupError where none does."""
    fixes = Fixes()
    lines = _lines(text, fixes)
    try:
        header, delimiter, columns = _header(lines, fixes)
        rows = csv.reader(lines, delimiter=delimiter, strict=True)
        for row in rows:
            line = header + rows.line_num
            try:
                if "".join(row).strip():
                    fixes.add(*_position(columns, row), line, _reported(columns, row))
            except ValueError as error:
                fixes.skip(str(error), line)
    except csv.Error as error:
        raise ValueError(f"its table is broken: {error}") from None
    return fixes


def _lines(text: TextIO, fixes: Fixes) -> Iterator[str]:
    """The lines; a last one without an end is noted in `fixes`, since it may be cut off."""
    for row, line in enumerate(iter(partial(text.readline, LONGEST), ""), 1):
        yield line
        if len(line) == LONGEST and not line.endswith("\n"):
            raise csv.Error(f"a line has more than {LONGEST} characters")
        if fixes.table and line.strip() and not line.endswith(("\n", "\r")):
            fixes.noted.count("in a last line without an end, which may be cut off", row)


def _header(lines: Iterator[str], fixes: Fixes) -> tuple[int, str, _Columns]:
    """The number of the line that names the columns, its delimiter, and the columns."""
    titles: list[str] = []
    for row, line in enumerate(lines, 1):
        excerpt, comment = repr(line.strip()[:80]), line.startswith("#")
        for delimiter in "" if comment or len(line) == LONGEST else ",;\t|":
            columns = [_column(cell) for cell in next(csv.reader([line], delimiter=delimiter))]
            roles = [role for role, _ in columns]
            if {"lat", "lon"} <= {*roles}:
                if "minutes" in roles or any(roles.count(role) > 1 for role in [*_ROLES][:6]):
                    wrong = "has a column twice, or minutes of a degree, which is not read"
                    raise ValueError(f"its header {excerpt} {wrong}")
                return row, delimiter, columns
        if line.strip():
            fixes.skip("comment" if comment else "line above the names of the columns", row)
            titles += [] if comment else [excerpt]
        if len(titles) > 9 or len(line) == LONGEST:
            break
    raise LookupError(f"as a table its first line {''.join(titles[:1])} does not name lat and lon")


def _column(name: str) -> tuple[str, float]:
    words = re.sub("(?<=[a-z])(?=[A-Z])|(?=[eE]7$)|[^A-Za-z0-9]+", " ", name).casefold().split()
    for role, pattern in _ROLES.items():
        if re.fullmatch(pattern, " ".join(words)):
            return role, _PER.get(words[-1], float(role != "time"))
    return "", 0.0


def _position(columns: _Columns, row: list[str]) -> tuple[float, float, float | None]:
    """Latitude, longitude and time of a row; ValueError says why it has none."""
    if row[0].startswith("#"):
        raise ValueError("comment")
    if len(row) < len(columns) or any(map(str.strip, row[len(columns) :])):  # decimal commas
        raise ValueError("row with more or fewer cells than the header")
    if "\n" in "".join(row) or "\r" in "".join(row):
        raise ValueError("row with a cell over several lines")
    per, cells = dict(columns), {"time": ""}
    for (role, _), cell in zip(columns, row, strict=False):
        cells[role] = cell.strip()
        words = re.findall("[a-z]+|-?[0-9]+", cell.casefold()) or [""]
        if words[0] not in _GOOD.get(role, words):
            raise ValueError("row without a measured fix")
    lat = _degrees(cells["lat"], "NS", cells.get("N/S")) / per["lat"]
    lon = _degrees(cells["lon"], "EW", cells.get("E/W")) / per["lon"]
    clock, seconds = cells["time"], _number(cells["time"])
    if not clock:
        return lat, lon, math.nan
    if "date" in per or math.isnan(seconds):
        day = cells.get("date", "").replace("/", "-")
        return lat, lon, timestamp(f"{day}T{clock}" if "date" in per else clock)
    # Without its unit none is guessed; since 1970 ms are more than 1e11.
    return lat, lon, seconds / per["time"] if per["time"] * 1e11 > abs(seconds) else None


def _reported(columns: _Columns, row: list[str]) -> Reported:
    per = dict(columns)
    cells = {role: cell.strip() for (role, _), cell in zip(columns, row, strict=False)}
    roles = per.keys() & {*Reported._fields} - {"quality"}
    reported = {role: reading(cells[role].replace(",", "."), 1.0 / per[role]) for role in roles}
    text = cells.get("quality", cells.get("fix", "")).casefold()
    number = reading(text.replace("9", "2")) if "quality" in per else math.nan
    words = re.findall("[a-z]+", text)
    reported["quality"] = next((_QUALITY[word] for word in _QUALITY if word in words), number)
    reported["course"] = reported.get("course", math.nan) * math.radians(1.0)
    return Reported(**reported)


def _degrees(cell: str, sides: str, side: str | None) -> float:
    """Degrees, NaN if there are none; ValueError where sign and hemisphere leave a doubt."""
    if side is not None and side.upper()[:1] not in {*sides}:
        raise ValueError("row without a readable hemisphere")
    text = (cell + (side or "")[:1]).upper()
    bare = text.strip(sides + " \xba\xb0\udcba\udcb0")  # degree signs, of Latin-1 too
    plus, minus = (letter in text.replace(bare, "", 1) for letter in sides)
    if (plus and (minus or bare[:1] in ("-", "\u2212"))) or (minus and bare[:1] == "+"):
        raise ValueError("sign and hemisphere that contradict each other")
    return -abs(_number(bare)) if minus else _number(bare)


def _number(cell: str) -> float:
    """The number of a cell; a single comma is a decimal comma, since it does not end the cell."""
    return number((cell if "." in cell else cell.replace(",", ".", 1)).replace("\u2212", "-"))
