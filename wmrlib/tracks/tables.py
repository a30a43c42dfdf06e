"""Positions in CSV tables; what their times mean, `moments` tells."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterator
from functools import lru_cache
from typing import Any, NamedTuple, TextIO

from wmrlib.tracks.fixes import LONGEST, Fixes
from wmrlib.tracks.moments import Moments, plain_number

LATITUDE, LONGITUDE = {"lat", "latitude"}, {"lon", "lng", "long", "longitude"}
_TIME = {"time", "timestamp", "datetime", "date time", "t"}
_SIDES = {"dir", "direction", "ref", "reference", "hemi", "hemisphere", "indicator"}
_NORTH = {"n s", "ns", "north south", *(f"{name} {side}" for name in LATITUDE for side in _SIDES)}
_EAST = {"e w", "ew", "east west", *(f"{name} {side}" for name in LONGITUDE for side in _SIDES)}
_NORTH, _EAST = ({*names, *(f"{n} indicator" for n in names)} for names in (_NORTH, _EAST))
_BESIDE = {"deg", "degrees", "n", "s", "e", "w", "sec", "utc", "gps"}  # what a name may hold too
_UNITS = {"e7": 1e7, "ms": 1e3, "us": 1e6}  # how many make a degree or a second
_PARTS = (  # of a degree, where columns of their own hold them; the second also tells whether
    {"d", "deg", "degree", "degrees"},
    {"m", "min", "minute", "minutes"},
    {"s", "sec", "second", "seconds"},
)
# A minus and degree signs as they are typed, and as Latin-1 writes them.
_TYPED = {0x2212: "-", 0xBA: "\xb0", 0xDCB0: "\xb0", 0xDCBA: "\xb0"}
_MOST_TITLES = 9  # lines above the names of the columns
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


class NoHeaderError(ValueError):
    """No line names the columns."""


class _Columns(NamedTuple):
    """Where a row has what; a column that is missing is None."""

    delimiter: str
    width: int
    places: list[Any]  # latitude, longitude, time, date, N/S, E/W
    units: list[float]
    fixes: list[tuple[int, str]]
    parts: list[list[int | None]]  # minutes and seconds of the latitude, of the longitude
    timed: bool  # whether the time's column says its unit


def read_csv(text: TextIO) -> Fixes:
    """Rows under the first line that names the columns; few lines may stand above it."""
    fixes, last = Fixes(), [""]
    lines = _lines(text, last)
    try:
        header, columns = _names(lines, fixes)
        begin, moments = header + 1, Moments(columns.timed)
        reader = csv.reader(lines, delimiter=columns.delimiter, strict=True)
        for row in reader:
            following = header + 1 + reader.line_num
            _use(fixes, row, columns, moments, begin, following - begin)
            begin = following
    except csv.Error as error:
        raise ValueError(f"its table is broken: {error}") from None
    moments.settle(fixes)
    if fixes.lat and last[0].strip() and not last[0].endswith(("\n", "\r")):
        fixes.note("in a last line without an end, which may be cut off", begin - 1)
    return fixes


def _lines(text: TextIO, last: list[str]) -> Iterator[str]:
    """The lines, the latest of which is in `last`."""
    while line := text.readline(LONGEST):
        last[0] = line if line.isascii() else line.translate(_TYPED)
        yield last[0]
        if len(line) == LONGEST and not line.endswith("\n"):
            raise csv.Error(f"a line has more than {LONGEST} characters")


def _names(lines: Iterator[str], fixes: Fixes) -> tuple[int, _Columns]:
    """The line that names the columns, and what it says; a title may stand above it."""
    wrong = NoHeaderError("it has no header that names the columns of latitude and longitude")
    titles = list[int]()
    for header, line in enumerate(lines, 1):
        if line.startswith("#"):
            fixes.skip("comment", header)
        elif line.strip():
            try:
                columns = _header(line)
            except NoHeaderError as error:
                titles.append(header)
                wrong = wrong if len(titles) > 1 else error
                if len(titles) > _MOST_TITLES or len(line) == LONGEST:
                    break
            else:
                for title in titles:
                    fixes.skip("line above the names of the columns", title)
                return header, columns
    raise wrong


def _header(line: str) -> _Columns:
    shown = repr(line.strip()[:80])
    for delimiter in _DELIMITERS if len(line) < LONGEST else "":
        cells = next(csv.reader([line], delimiter=delimiter))
        apart = [re.sub("(?<=[a-z])(?=[A-Z])|(?=[eE]7$)", " ", cell).casefold() for cell in cells]
        words = [re.findall(r"[^\W_]+", cell) for cell in apart]
        full = [" ".join(each) for each in words]
        short = [" ".join(w for w in each if w not in _BESIDE | {*_UNITS}) for each in words]
        places: list[Any] = []
        parts = [_minutes(words, LATITUDE), _minutes(words, LONGITUDE)]
        for whole, *fine in parts:
            for i in (i for i in fine if i is not None):  # "lat s" is no latitude
                full[i] = short[i] = "a part of a degree"
            if whole is not None and fine[0] is not None:
                full[whole] = short[whole] = words[whole][0]
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
            timed = places[2] is not None and {*words[places[2]]} & {*_UNITS, *_PARTS[2]}
            return _Columns(delimiter, len(cells), places, units, fixes, parts, bool(timed))
    wanted = f"one of {sorted(LATITUDE)} and one of {sorted(LONGITUDE)}"
    first = f"as a table its first line {shown} does not name {wanted}"
    raise NoHeaderError(f"it is neither NMEA nor GPX, and {first}")


def _minutes(words: list[list[str]], names: set[str]) -> list[int | None]:
    """The columns of degrees, minutes and seconds, if there is one of minutes."""
    at: list[int | None] = []
    for part in _PARTS:
        found = [i for i, each in enumerate(words) if len(each) == 2 and each[0] in names]
        at.append(next((i for i in found if words[i][1] in part), None))
    return at if at[1] is not None else [None] * 3


def _use(
    fixes: Fixes, row: list[str], columns: _Columns, moments: Moments, line: int, lines: int
) -> None:
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
        lat, lon = (
            _with_parts(value, [row[i] for i in at[1:] if i is not None])
            for value, at in zip((lat, lon), columns.parts, strict=True)
        )
    except ValueError as error:
        return fixes.skip(str(error), line)
    time = moments.read("" if t is None else row[t], None if date is None else row[date], per_t)
    if moments.keep(fixes.add(lat / per_y, lon / per_x, time, line)) and None in said:
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
    bare, letters, value = cell, "", plain_number(cell)
    if not math.isfinite(value):
        text = cell.strip().upper()
        bare = text.strip(sides + " \N{DEGREE SIGN}")
        letters, value = text.replace(bare, "", 1), plain_number(bare)
    if side is not None:
        letter = side.strip().upper()[:1]
        if not letter or letter not in sides:
            raise ValueError("row without a readable hemisphere")
        letters += letter
    plus, minus, sign = sides[0] in letters, sides[1] in letters, bare.lstrip()[:1]
    if (plus and (minus or sign == "-")) or (minus and sign == "+"):
        raise ValueError("sign and hemisphere that contradict each other")
    return -abs(value) if minus else value


def _with_parts(degrees: float, cells: list[str]) -> float:
    """Degrees with the minutes and seconds of these cells; ValueError if they can't be such."""
    if not cells:
        return degrees
    parts = [plain_number(cell) for cell in cells]
    whole = [degrees, *parts[:-1]]  # only the last has decimals
    if not all(0.0 <= each < 60.0 for each in parts) or any(each % 1.0 for each in whole):
        raise ValueError("row without readable minutes or seconds")
    fine = sum(each / 60.0**power for power, each in enumerate(parts, 1))
    return math.copysign(abs(degrees) + fine, degrees)
