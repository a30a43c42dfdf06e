"""Positions in CSV tables."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterable, Iterator
from functools import lru_cache
from typing import Any, NamedTuple

from wmrlib.tracks.fixes import NO_TIME, Fixes, number, timestamp

LATITUDE, LONGITUDE = {"lat", "latitude"}, {"lon", "lng", "long", "longitude"}
_TIME = {"time", "timestamp", "datetime", "date time", "t"}
_SIDES = {"dir", "direction", "ref", "reference", "hemi", "hemisphere", "indicator"}
_NORTH = {"n s", "ns", "north south", *(f"{name} {side}" for name in LATITUDE for side in _SIDES)}
_EAST = {"e w", "ew", "east west", *(f"{name} {side}" for name in LONGITUDE for side in _SIDES)}
_NORTH, _EAST = ({*names, *(f"{n} indicator" for n in names)} for names in (_NORTH, _EAST))
_BESIDE = {"deg", "degrees", "n", "s", "e", "w", "sec", "utc", "gps"}  # what a name may hold too
_UNITS = {"e7": 1e7, "ms": 1e3, "us": 1e6}  # how many make a degree or a second
# Columns that tell whether there is a fix, and the digits that say no.
_FIX = dict.fromkeys(("valid", "is valid", "fix", "gps fix"), "0")
_FIX |= dict.fromkeys(("status", "fix status", "gps status"), "")
_FIX |= dict.fromkeys(("quality", "fix quality", "gps quality"), "0678")
_FIX |= dict.fromkeys(("fix mode", "fix type"), "01")
_NO = {"no", "not", "none", "nofix", "invalid", "void", "false", "v", "n", "-1"}
_YES = {"yes", "true", "ok", "valid", "fix", "fixed", "float", "y", "a", "d", "p", "r", "f"}
_YES |= {"gps", "gnss", "sps", "dgps", "pps", "rtk", "frtk"}
_ESTIMATED = {"estimated", "dead", "manual", "simulator", "simulation", "e", "m", "s"}
_DELIMITERS = ",;\t|"
_MOST_SECONDS = 1e11  # milliseconds since 1970 are more


class NoHeaderError(ValueError):
    """No line names the columns."""


class _Columns(NamedTuple):
    """Where a row has what; a column that is missing is None."""

    delimiter: str
    width: int
    places: list[Any]  # latitude, longitude, time, date, N/S, E/W
    units: list[float]
    fixes: list[tuple[int, str]]


def read_csv(text: Iterable[str]) -> Fixes:
    """Rows under the first line that is neither blank nor a comment (#): the columns' names."""
    fixes, last = Fixes(), [""]
    lines = _remembering(text, last)
    for header, line in enumerate(lines, 1):
        if line.strip() and not line.startswith("#"):
            break
        if line.strip():
            fixes.skip("comment", header)
    else:
        raise NoHeaderError("it has no header that names the columns of latitude and longitude")
    columns, begin = _header(line), header + 1
    reader = csv.reader(lines, delimiter=columns.delimiter, strict=True)
    try:
        for row in reader:
            following = header + 1 + reader.line_num
            _use(fixes, row, columns, begin, following - begin)
            begin = following
    except csv.Error as error:
        raise ValueError(f"its table is broken: {error}") from None
    if fixes.lat and last[0].strip() and not last[0].endswith(("\n", "\r")):
        fixes.note("in a last line without an end, which may be cut off", begin - 1)
    return fixes


def _remembering(text: Iterable[str], last: list[str]) -> Iterator[str]:
    for last[0] in text:
        yield last[0]


def _header(line: str) -> _Columns:
    shown = repr(line.strip()[:80])
    for delimiter in _DELIMITERS:
        try:
            cells = next(csv.reader([line], delimiter=delimiter))
        except csv.Error:  # 131072 characters without a delimiter
            continue
        apart = [re.sub("(?<=[a-z])(?=[A-Z])|(?=[eE]7$)", " ", cell).casefold() for cell in cells]
        words = [re.findall(r"[^\W_]+", cell) for cell in apart]
        full = [" ".join(each) for each in words]
        short = [" ".join(w for w in each if w not in _BESIDE | {*_UNITS}) for each in words]
        places: list[Any] = []
        for known in (LATITUDE, LONGITUDE, _TIME, {"date"}, _NORTH, _EAST):
            found = [i for i, name in enumerate(full) if name in known]
            found = found or [i for i, name in enumerate(short) if name in known]
            if len(found) > 1:
                given = sorted({cells[i].strip().casefold() for i in found})
                raise ValueError(f"its header names more than one column of {given}: {shown}")
            places.append(found[0] if found else None)
        if None not in places[:2]:
            units = [
                math.prod(_UNITS.get(word, 1.0) for word in words[i]) if i is not None else 1.0
                for i in places[:3]
            ]
            fixes = [(i, _FIX[name]) for i, name in enumerate(full) if name in _FIX]
            return _Columns(delimiter, len(cells), places, units, fixes)
    wanted = f"one of {sorted(LATITUDE)} and one of {sorted(LONGITUDE)}"
    first = f"as a table its first line {shown} does not name {wanted}"
    raise NoHeaderError(f"it is neither NMEA nor GPX, and {first}")


def _use(fixes: Fixes, row: list[str], columns: _Columns, line: int, lines: int) -> None:
    """Use a row's position, or count why not; a blank row counts for nothing."""
    if not "".join(row).strip():
        return
    if row[0].startswith("#"):
        return fixes.skip("comment", line)
    if lines > 1:
        return fixes.skip("row with a cell over several lines", line)
    width = columns.width
    if len(row) != width and (len(row) < width or any(map(str.strip, row[width:]))):
        return fixes.skip("row with more or fewer cells than the header", line)  # decimal commas
    said = [_without_fix(row[i], digits) for i, digits in columns.fixes]
    if reason := next(filter(None, said), None):
        return fixes.skip(reason, line)
    (y, x, t, date, north, east), (per_y, per_x, per_t) = columns.places, columns.units
    try:
        lat = _degrees(row[y], "NS", None if north is None else row[north])
        lon = _degrees(row[x], "EW", None if east is None else row[east])
    except ValueError as error:
        return fixes.skip(str(error), line)
    time: float | None = NO_TIME
    if t is not None and (text := row[t].strip()):
        time = _time(text, per_t) if date is None else _date_and_time(row[date], text)
    if fixes.add(lat / per_y, lon / per_x, time, line) and None in said:
        fixes.note("with an unknown word on its fix", line)


@lru_cache(maxsize=64)
def _without_fix(cell: str, digits: str) -> str | None:
    """Return why there is no fix by a cell, "" where there is one, or None if that is not known."""
    words = re.findall("[a-z]+|-?[0-9]+", cell.casefold())
    first = words[0] if words else "yes"  # an empty cell says nothing
    if first in _NO or first in tuple(digits.replace("678", "")):
        return "row without a fix"
    if first in _ESTIMATED or first in tuple(digits):
        return "position estimated, put in by hand or simulated"
    return "" if first in _YES or first.isdigit() else None


def _degrees(cell: str, sides: str, side: str | None) -> float:
    """Degrees, NaN if there are none; ValueError where sign and hemisphere leave a doubt."""
    bare, letters, value = cell, "", _number(cell)
    if not math.isfinite(value):
        text = cell.strip().upper()
        bare = text.strip(sides + " \N{DEGREE SIGN}")
        letters, value = text.replace(bare, "", 1), _number(bare)
    if side is not None:
        letter = side.strip().upper()[:1]
        if not letter or letter not in sides:
            raise ValueError("row without a readable hemisphere")
        letters += letter
    plus, minus, sign = sides[0] in letters, sides[1] in letters, bare.lstrip()[:1]
    if (plus and (minus or sign == "-")) or (minus and sign == "+"):
        raise ValueError("sign and hemisphere that contradict each other")
    return -abs(value) if minus else value


def _number(cell: str) -> float:
    """The number of a cell; a single comma is a decimal comma, since it does not end the cell."""
    try:
        return math.nan if "_" in cell else float(cell)
    except ValueError:
        return number("" if "." in cell else cell.replace(",", ".", 1))


def _time(text: str, per_second: float) -> float | None:
    """Seconds or an ISO 8601 time; None if it is neither."""
    seconds = math.nan if ":" in text else _number(text) / per_second
    if math.isfinite(seconds):
        return seconds if abs(seconds) < _MOST_SECONDS else None
    return timestamp(text)


def _date_and_time(date: str, time: str) -> float | None:
    """Seconds since 1970 of 2013/05/12 or 130512 and 12:34:56.7 or 123456; None if unreadable."""
    day, (clock, dot, fraction) = date.strip().replace("/", "-"), time.strip().partition(".")
    if day.isdigit() and len(day) < 7:  # a spreadsheet drops zeros in front
        day = ("19" if day.zfill(6) >= "80" else "20") + day.zfill(6)
    moment = timestamp(f"{day}T{clock.zfill(6) if clock.isdigit() else clock}{dot}{fraction}")
    return timestamp(time.strip()) if moment is None else moment
