"""The positions of a file and the count of its unused lines, as every reader collects them."""

import math
from array import array
from bisect import bisect_left
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import NamedTuple

import numpy as np

LONGEST = 1 << 16  # characters of a line that are read at once
KNOT = 1852.0 / 3600.0  # m/s


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


class Count(NamedTuple):
    """The number of occurrences, and the line (in UBX the byte) of the first."""

    count: int  # type: ignore[assignment]  # hides tuple.count, which nobody calls here
    first: int


@dataclass(frozen=True)
class Report:
    """The number of positions used, and for each reason the Count of lines that gave none.

    `noted` counts positions that are used although something is amiss with them, and `place` is
    "line" or "byte"; `print` it all.
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
        self.skipped, self.noted = Tally(), Tally()
        self.skip, self.place = self.skipped.count, place

    def add(
        self, lat: float, lon: float, time: float | None, line: int, reported: Reported = UNREPORTED
    ) -> None:
        """Use a position (degrees; s, NaN if absent, None if unreadable), or count why not."""
        if not (abs(lat) <= 90.0 and abs(lon) <= 180.0):
            wrong = "latitude not in -90 to 90", "longitude not in -180 to 180"
            nan = "latitude or longitude not a number"
            return self.skip(wrong[abs(lat) <= 90.0] if math.isfinite(lat + lon) else nan, line)
        if time is None:
            self.noted.count("with an unreadable time", line)
        time = math.nan if time is None else time
        self.table.extend((line, self.segment, lat, lon, time, *reported))

    def settle(self) -> tuple[np.ndarray, Report]:
        """The rows lat, lon, time and Reported of the positions by time, and the report."""
        table = np.frombuffer(self.table).reshape(-1, 5 + len(Reported._fields))
        parts = np.split(table, np.flatnonzero(np.diff(table[:, 1])) + 1)
        late = np.concatenate([_late(part[:, 4]) for part in parts])
        if late.any():
            self.skip("time runs backwards", int(table[late, 0][0]), int(late.sum()))
        table = table[~late, 2:].T
        return table, Report(table.shape[1], self.skipped, self.noted, self.place)


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
    """Seconds since 1970 of an ISO 8601 time, in UTC unless it has a zone; None if it is none."""
    try:
        time = datetime.fromisoformat(text)
    except ValueError:
        return None
    return (time if time.tzinfo else time.replace(tzinfo=UTC)).timestamp()


def _late(time: np.ndarray) -> np.ndarray:
    """Which positions are outside the longest run in order of time, counted in epochs."""
    timed, left = np.flatnonzero(~np.isnan(time)), np.zeros(time.size, bool)
    if not (np.diff(time[timed]) < 0.0).any():
        return left
    # Patience sorting, from the last to the first.
    falling, ends = array("d", -time[timed]), array("d")
    lengths = array("q", timed)  # in epochs, of the longest run that begins there, less one
    for i in reversed(range(timed.size)):
        lengths[i] = bisect_left(ends, falling[i])
        ends[lengths[i] : lengths[i] + 1] = array("d", [falling[i]])
    # Of runs as long, the one that begins first and then goes on with the nearest times.
    last, left[timed] = lengths.index(len(ends) - 1), True
    for i in np.lexsort((time[timed], np.negative(lengths))).tolist():
        same = (falling[i], lengths[i]) == (falling[last], lengths[last])
        if i >= last and (same or falling[i] < falling[last]):
            left[timed[i]], last = False, i
    return left
