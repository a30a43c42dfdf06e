"""The positions of a file and the count of its unused lines, as every reader collects them."""

import math
import re
from array import array
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import NamedTuple

import numpy as np

from wmrlib.tracks import neighbours

LONGEST = 1 << 16  # characters of a line that are read at once
KNOT = 1852.0 / 3600.0  # m/s
_ZONE = re.compile(r" ?(?:UTC|GMT)? ?([+-][0-9]{2}:?[0-9]{2}|)$")  # as people write it
_SECOND_60 = re.compile(r"(:[0-5][0-9]):60")


class Reported(NamedTuple):
    """The receiver's report on a fix, in the units of Track; NaN where it reports nothing."""

    quality: float = math.nan
    satellites: float = math.nan
    hdop: float = math.nan
    speed: float = math.nan
    course: float = math.nan
    heading: float = math.nan
    accuracy: float = math.nan


UNREPORTED = Reported()
_WIDTH = 6 + len(Reported._fields)  # line, segment, lat, lon, time, Reported and receiver


def trust(quality: float) -> int:
    """How far a quality as in GGA is trusted, from 5 for RTK fixed to 1 for plain, 0 for none."""
    return {4.0: 5, 5.0: 4, 3.0: 3, 2.0: 2, 1.0: 1}.get(quality, 0)


class Count(NamedTuple):
    """The number of occurrences, `count`, and the line of the `first` (in UBX its byte)."""

    count: int  # type: ignore[assignment]  # hides tuple.count, which nobody calls here
    first: int


@dataclass(frozen=True)
class Report:
    """How much of a file was used, and how much was not, by its reason; `print` shows it all.

    Attributes
    ----------
    used : int, the number of positions
    skipped : mapping from a reason to the `Count` of lines that gave no position
    noted : likewise of positions that are used although something is amiss with them
    place : "line", "byte" or, of GeoJSON, "feature"
    """

    used: int
    skipped: Mapping[str, Count]
    noted: Mapping[str, Count] = field(default_factory=dict)
    place: str = "line"

    def __repr__(self) -> str:
        rows = [f"{self.used} position{'s' * (self.used != 1)} used"]
        for verdict, counts in (("not used", self.skipped), ("used, but", self.noted)):
            for reason, (times, first) in sorted(counts.items(), key=lambda row: row[1].first):
                rows.append(f"{verdict}: {times} {reason} (first in {self.place} {first})")
        return "\n".join(rows)


class Tally(dict[str, Count]):
    """Counts, by reason or by kind."""

    def count(self, reason: str, line: int, times: int = 1) -> None:
        """Count a reason once more, or several times."""
        before, first = self.get(reason, (0, line))
        self[reason] = Count(before + times, min(first, line))


class Fixes:
    """The positions of one file in their order, and the reasons why others are not used."""

    def __init__(self, place: str = "line") -> None:
        self.table, self.segment = array("d"), 0  # in the next segment times may be earlier
        self.receiver, self._receivers = "", dict[str, int]()  # as the file names them
        self.skipped, self.noted = Tally(), Tally()
        self.skip, self.place = self.skipped.count, place

    def add(
        self,
        lat: float,
        lon: float,
        time: float | None,
        line: int,
        reported: Reported = UNREPORTED,
        doubt: str = "with an unreadable time",
    ) -> None:
        """Use a position (degrees; s, NaN if absent, None if in `doubt`), or count why not."""
        if not (abs(lat) <= 90.0 and abs(lon) <= 180.0):
            wrong = "latitude not in -90 to 90", "longitude not in -180 to 180"
            nan = "latitude or longitude not a number"
            return self.skip(wrong[abs(lat) <= 90.0] if math.isfinite(lat + lon) else nan, line)
        if time is None:
            self.noted.count(doubt, line)
        time = math.nan if time is None else time
        receiver = self._receivers.setdefault(self.receiver, len(self._receivers))
        self.table.extend((line, self.segment, lat, lon, time, *reported, receiver))

    def __len__(self) -> int:
        return len(self.table) // _WIDTH

    def settle(self) -> tuple[np.ndarray, Report]:
        """The rows lat, lon, time and Reported of the positions by time, and the report."""
        rows = np.frombuffer(self.table).reshape(-1, _WIDTH).copy()
        # Before the times: such a position often has a date of its own.
        rows = self._without(rows, neighbours.null_island(*rows[:, 2:4].T), "position at (0, 0)")
        changes = (np.diff(rows[:, -1]) != 0.0).sum()
        if changes > max(3, 0.02 * len(rows)):  # else one was plugged in again by another name
            trusted = [1 + trust(quality) for quality in rows[:, 5].tolist()]
            best = np.bincount(rows[:, -1].astype(int), trusted).argmax()
            rows = self._without(rows, rows[:, -1] != best, "position of another receiver")
        again = neighbours.copies(rows[:, 2:5], rows[:, 1])
        rows = self._without(rows, again, "same time and place again")
        parts = np.split(rows, np.flatnonzero(np.diff(rows[:, 1])) + 1)
        rows = np.concatenate([self._settled(part) for part in parts])
        timed = rows[~np.isnan(rows[:, 4])]
        early = timed[1:][np.diff(timed[:, 4]) <= 0.0]
        _count(self.noted, "where a segment begins before the end of the one before", early)
        report = Report(len(rows), self.skipped, self.noted, self.place)
        return rows[:, 2:-1].T, report

    def _without(self, rows: np.ndarray, left: np.ndarray, reason: str) -> np.ndarray:
        _count(self.skipped, reason, rows[left])
        return rows[~left]

    def _settled(self, part: np.ndarray) -> np.ndarray:
        """The positions of a segment that agree with one another."""
        if neighbours.newest_first(part[:, 4]):
            _count(self.noted, "in a list with the newest first, which is turned round", part)
            part = part[::-1].copy()
        part[:, 4], doubts = neighbours.with_its_date_right(part[:, 4])
        for reason, rows in doubts.items():
            _count(self.noted, reason, part[rows])
        unknown = neighbours.without_seconds(part[:, 4])
        part[unknown, 4] = math.nan
        _count(self.noted, "with the time of the one before, which t leaves out", part[unknown])
        time, quality = part[:, 4], part[:, 5].tolist()
        again = neighbours.second_best(time, lambda i: trust(quality[i]))
        unordered = neighbours.late(np.where(again, math.nan, time)) | again
        again = unordered & np.isin(time, time[~unordered])
        _count(self.skipped, "same time again", part[again])
        used = {row[4]: row for row in part[~unordered]} if again.any() else {}
        apart = [row for row in part[again] if neighbours.disagree(*row[2:4], *used[row[4]][2:4])]
        _count(self.noted, neighbours.DISAGREEING, np.array(apart))
        _count(self.skipped, "time runs backwards", part[unordered & ~again])
        part = part[~unordered]
        if neighbours.alternate(part[:, 2], part[:, 3]):
            _count(self.noted, "in a file that alternates between two receivers, perhaps", part)
        far, few = neighbours.unreachable(*part[:, 2:5].T)
        where = "place that no vehicle reaches in the time"
        if few:
            return self._without(part, far, where)
        _count(self.noted, f"at a {where}", part[far])  # times in a wrong unit, perhaps
        return part


def _count(tally: Tally, reason: str, rows: np.ndarray) -> None:
    if rows.size:
        tally.count(reason, int(rows[0, 0]), len(rows))


def number(text: str) -> float:
    """Return the number, or NaN if the text is none; Python's 1_000 is none."""
    try:
        return float(text.replace("_", "?"))
    except ValueError:
        return math.nan


def reading(text: str, unit: float = 1.0) -> float:
    """A number from 0 on in its unit, or NaN if the text is none."""
    value = number(text) * unit
    return value if 0.0 <= value < math.inf else math.nan


def timestamp(text: str) -> float | None:
    """Seconds since 1970 of an ISO 8601 time, in UTC unless it has a zone; None if it is none.

    The leap second 23:59:60 is one and so is 24:00:00, but a date alone is none.
    """
    words = _ZONE.sub(r"\1", text)
    clock = _SECOND_60.sub(r"\1:59", re.sub("[T ]24:00:00", "T23:59:60", words))
    try:
        time = datetime.fromisoformat(clock)
    except ValueError:
        return None
    if len(clock) < 12:
        return None
    return (time if time.tzinfo else time.replace(tzinfo=UTC)).timestamp() + (clock != words)
