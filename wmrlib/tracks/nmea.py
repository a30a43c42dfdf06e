"""Positions in NMEA 0183: GGA, GNS, RMC and GLL of every talker, brought together by epochs."""

from __future__ import annotations

import math
import re
from array import array
from datetime import date
from functools import lru_cache
from typing import Any, TextIO

import numpy as np

from wmrlib.tracks.fixes import Fixes, backwards, misplaced
from wmrlib.tracks.sentences import COMMENT, NO_SENTENCE, sentences

DAY = 86400.0
_CLOCK = re.compile(r"(?:[01][0-9]|2[0-3])[0-5][0-9][0-5][0-9](?:\.[0-9]*)?")
_PLACE = re.compile(r"[0-9]{2}[0-5][0-9]\.[0-9]+,[NS],[0-9]{3}[0-5][0-9]\.[0-9]+,[EW]")
# The most trusted kind first: its rank, and the fields where its time and its position begin.
_KINDS = {"GGA": (0, 1, 2), "GNS": (1, 1, 2), "RMC": (2, 1, 3), "GLL": (3, 5, 1)}
_LAST = len(_KINDS)
_MODES = dict(zip("123456789", "ADPRFEMSD", strict=True))  # of the qualities of a GGA
_MEASURED, _OTHERWISE = frozenset("ADPRF"), frozenset("EMS")
_TOGETHER = 3.0  # s; the sentences of an epoch come within it
# The columns of the table of epochs. OTHER: the first line of its positions that are not used.
_LAT, _LON, _LINE, _OTHER, _COUNT, _RANK, _DENIED, _SECOND, _DAY, _WIDTH = range(10)


class _Epochs:
    """A row of numbers for each epoch: objects would take ten times the memory."""

    def __init__(self) -> None:
        self._table, self._rows, self._now = array("d"), dict[float, int](), math.nan

    def _row(self, second: float, day: float) -> int:
        """Where the epoch's row begins; one of another date is a new epoch."""
        row = self._rows.get(second)
        latest, self._now = self._now, second
        if row is not None and _apart(second, latest) <= _TOGETHER:
            if math.isnan(self._table[row + _DAY]):
                self._table[row + _DAY] = day
            if not abs(self._table[row + _DAY] - day) > 0:  # NaN is any day
                return row
        if len(self._rows) > 99:
            self._rows = {s: i for s, i in self._rows.items() if _apart(s, second) <= _TOGETHER}
        self._rows[second] = row = len(self._table)
        nowhere = math.nan, math.nan, math.inf, math.inf
        self._table.extend((*nowhere, 0, _LAST, _LAST, second, day))
        return row

    def deny(self, second: float, rank: float) -> None:
        """Hear that there is no fix."""
        denied = self._row(second, math.nan) + _DENIED
        self._table[denied] = min(rank, self._table[denied])

    def hear(
        self, second: float, day: float, rank: float, lat: float, lon: float, line: float
    ) -> None:
        """Hear of a position; the epoch's is the first one of the best rank."""
        row, table = self._row(second, day), self._table
        table[row + _COUNT] += 1
        if rank < table[row + _RANK]:
            table[row + _LAT], table[row + _LON], table[row + _RANK] = lat, lon, rank
            table[row + _LINE], line = line, table[row + _LINE]
        table[row + _OTHER] = min(line, table[row + _OTHER])

    def tell(self, fixes: Fixes) -> None:
        """Use the position of each epoch, and count the others."""
        columns = np.frombuffer(self._table).reshape(-1, _WIDTH).T
        count, rank, denied = columns[_COUNT], columns[_RANK], columns[_DENIED]
        heard, fixed = count > 0, rank <= denied
        time = _on_one_clock(columns[_SECOND], columns[_DAY], heard & fixed)
        lat, lon, line, other = columns[:_COUNT]
        # In the order of the positions: that there is no fix may have been said long before.
        used = np.argsort(np.where(heard & fixed, np.minimum(line, other), math.inf), kind="stable")
        used = used[: np.count_nonzero(heard & fixed)]
        fixes.extend(_degrees(lat[used]), _degrees(lon[used]), time[used], line[used])
        denier = "sentence of an epoch that a more trusted one says has no fix"
        doubted = heard & fixed & (rank % 1 > 0)
        for tell, reason, which, lines, times in (
            (fixes.skip, "same epoch again", fixed & (count > 1), other, count - 1),
            (fixes.skip, denier, heard & ~fixed, np.minimum(line, other), count),
            (fixes.note, "by a sentence that counts 0 satellites", doubted, line, heard),
        ):
            if which.any():
                tell(reason, int(lines[which].min()), int(times[which].sum()))


def read(text: TextIO) -> Fixes | None:
    """Each epoch's position once, by the kind of sentence trusted most; None without a sentence."""
    fixes, epochs = Fixes(), _Epochs()
    for line, fields in sentences(text, _KINDS, fixes):
        if trouble := _trouble(epochs, fields, line):
            fixes.skip(trouble, line)
    epochs.tell(fixes)
    return fixes if fixes.lat or fixes.skipped.keys() - {COMMENT, NO_SENTENCE} else None


def _trouble(epochs: _Epochs, fields: list[str], line: int) -> str | None:
    """Hear a sentence; return why it gives no position, or None."""
    rank, at_time, at_place = _KINDS[fields[0][2:].upper()]
    fields += [""] * 13
    mode, clock = _mode(rank, fields), fields[at_time]
    timed = _CLOCK.fullmatch(clock)
    second = int(clock[:2]) * 3600 + int(clock[2:4]) * 60 + float(clock[4:]) if timed else 0.0
    if _MEASURED.isdisjoint(mode):
        if timed:
            epochs.deny(second, rank)
        if _OTHERWISE.isdisjoint(mode):
            return "sentence without a fix"
        return "position estimated, put in by hand or simulated"
    if not timed:
        return "fix without a readable time"
    place = fields[at_place : at_place + 4]
    if not _PLACE.fullmatch(",".join(place)):
        return "unreadable position"
    lat, lon = float(place[0]), float(place[2])
    if lat > 9000.0 or lon > 18000.0:
        return misplaced(lat / 100, lon / 100)
    lat, lon = -lat if place[1] == "S" else lat, -lon if place[3] == "W" else lon
    doubt = 0.5 if rank < 2 and fields[7] in ("0", "00") else 0.0  # it says 0 satellites
    epochs.hear(second, _day(fields[9]) if rank == 2 else math.nan, rank + doubt, lat, lon, line)
    return None


def _mode(rank: int, fields: list[str]) -> str:
    """The mode indicator: a letter, of GNS one for each system of satellites."""
    if rank < 2:
        return fields[6] if rank else _MODES.get(fields[6], "N")
    status, mode = (fields[2], fields[12]) if rank == 2 else (fields[6], fields[7])
    return (mode or "A") if status == "A" else "N"


@lru_cache(maxsize=8)
def _day(text: str) -> float:
    """The number of the day ddmmyy, NaN if it is none; GPS began in 1980."""
    try:
        day, month, year = (int(text[i : i + 2]) for i in (0, 2, 4))
        return date(year + (1900 if year >= 80 else 2000), month, day).toordinal()
    except ValueError:
        return math.nan


def _degrees(value: np.ndarray) -> np.ndarray:
    """Degrees of dddmm.mmm."""
    whole = np.trunc(value / 100.0)
    return whole + (value - 100.0 * whole) / 60.0


def _apart(second: float, other: float) -> float:
    """The time between two seconds of the day, over midnight if that is shorter."""
    return abs((second - other + DAY / 2) % DAY - DAY / 2)


def _on_one_clock(second: np.ndarray, day: np.ndarray, fixed: np.ndarray) -> np.ndarray:
    """Count the seconds on from day to day, by dates or by the nearest time already known."""
    dated, believed = np.flatnonzero(~np.isnan(day)), np.zeros(day.size, bool)
    time = day.copy()
    if dated.size:
        time = second + DAY * (day - day[dated[0]])
        odd = np.isin(np.arange(dated.size), backwards(time[dated], np.zeros(dated.size)))
        # A wrong date is its epoch's own fault; where most around are as odd, a log was appended.
        believed[dated] = ~odd | (np.convolve(odd, np.ones(7))[3:-3] > 3.0)
    following = np.where(believed, np.arange(day.size), day.size)
    ahead = np.append(time, math.nan)[np.minimum.accumulate(following[::-1])[::-1]]
    cells: Any = time.data
    last = math.nan
    rows = zip(second.copy().data, ahead.data, fixed.data, believed.data, strict=True)
    for row, (each, later, use, sure) in enumerate(rows):
        if math.isnan(cells[row]):
            choices = [(each + DAY * round((k - each) / DAY), k) for k in (last, later) if k == k]
            cells[row], _ = min(choices, key=lambda c: abs(c[0] - c[1]), default=(each, each))
        elif not sure:
            continue
        # Before its first fix a cold receiver may count from 0:00.
        if use or not cells[row] <= last:
            last = cells[row]
    return time
