"""What every reader of position files shares: the positions used, and an account of the rest."""

from __future__ import annotations

import math
import re
from array import array
from bisect import bisect_left
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

NO_TIME = math.nan
LONGEST = 1 << 16  # characters of a line that are read at once
# What ISO 8601 allows and datetime does not: what to read instead, and the seconds to add.
_BEYOND = (
    (re.compile(r"(?<=[T ])24(?=:00(?::00(?:[.,]0+)?)?(?:Z|[+-]|$))"), "00", 86400.0),
    (re.compile(r"(?<=:\d\d:)60(?!\d)"), "59", 1.0),  # a leap second
)


class Count(NamedTuple):
    """How often something was met, and the line where it was met first."""

    count: int  # type: ignore[assignment]  # hides tuple.count, which nobody calls here
    first: int


@dataclass(frozen=True)
class Report:
    """What was read from a file and what was not; `print` it.

    Parameters
    ----------
    used : int; number of positions
    skipped : mapping from the reason why a line gave no position to its Count
    noted : the same for positions that are used although something is amiss with them
    """

    used: int
    skipped: Mapping[str, Count]
    noted: Mapping[str, Count] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name in ("skipped", "noted"):
            rows = sorted(getattr(self, name).items(), key=lambda row: row[1].first)
            object.__setattr__(self, name, MappingProxyType(dict(rows)))

    def __reduce__(self) -> tuple:  # a mapping proxy can't be pickled
        return Report, (self.used, dict(self.skipped), dict(self.noted))

    def __repr__(self) -> str:
        rows = [f"{self.used} position{'' if self.used == 1 else 's'} used"]
        rows += [f"not used: {each}" for each in self.listed(self.skipped)]
        rows += [f"used, but: {each}" for each in self.listed(self.noted)]
        return "\n".join(rows)

    def listed(self, reasons: Mapping[str, Count]) -> list[str]:
        rows = reasons.items()
        return [f"{n} {reason} (first in line {first})" for reason, (n, first) in rows]


class Fixes:
    """The positions of one file as they are found, and the reasons why others are not used."""

    def __init__(self) -> None:
        self.lat, self.lon, self.time = array("d"), array("d"), array("d")
        self.lines, self._segments = array("q"), array("q")
        self.skipped: dict[str, Count] = {}
        self._noted: dict[str, Count] = {}

    def skip(self, reason: str, line: int, times: int = 1) -> None:
        count(self.skipped, reason, line, times)

    def note(self, reason: str, line: int, times: int = 1) -> None:
        count(self._noted, reason, line, times)

    def begin_segment(self) -> None:
        """From here on times may be earlier than before."""
        self._segments.append(len(self.lat))

    def add(self, lat: float, lon: float, time: float | None, line: int) -> bool:
        """Use a position (degrees; s, NaN if absent, None if unreadable), or count why not."""
        reason = misplaced(lat, lon)
        if reason is not None:
            self.skip(reason, line)
            return False
        if time is None:
            self.note("with an unreadable time", line)
        self.lat.append(lat)
        self.lon.append(lon)
        self.time.append(NO_TIME if time is None else time)
        self.lines.append(line)
        return True

    def extend(self, *columns: np.ndarray) -> None:
        """Use many positions at once: lat, lon and time as for `add`, in range, and lines."""
        rows: list[array] = [self.lat, self.lon, self.time, self.lines]
        for ours, values in zip(rows, columns, strict=True):
            ours.frombytes(np.asarray(values, ours.typecode).tobytes())

    def settle(self) -> tuple[np.ndarray, Report]:
        """The rows lat, lon and time of the positions in order, each epoch once, and the report."""
        table = np.array([self.lat, self.lon, self.time])
        segment = np.searchsorted(self._segments, np.arange(len(self.lat)), side="right")
        late = backwards(table[2], segment)
        kept = np.delete(np.arange(len(self.lat)), late)
        again = kept[1:][(np.diff(table[:, kept]) == 0.0).all(axis=0)]
        for reason, gone in (("time runs backwards", late), ("same epoch again", again)):
            if gone.size:
                self.skip(reason, self.lines[gone[0]], gone.size)
        table = np.delete(table, np.concatenate([late, again]), axis=1)
        return table, Report(table.shape[1], self.skipped, self._noted)


def number(text: str | None) -> float:
    """Return the number, or NaN if the text is none; Python's 1_000 is none."""
    try:
        return float(text) if text and "_" not in text else math.nan
    except ValueError:
        return math.nan


def timestamp(text: str) -> float | None:
    """Seconds since 1970 of an ISO 8601 time, in UTC unless it has a zone; None if it is none."""
    try:
        time = datetime.fromisoformat(text)
    except ValueError:
        for pattern, digits, seconds in _BEYOND:
            if pattern.search(text):
                before = timestamp(pattern.sub(digits, text))
                return None if before is None else before + seconds
        return None
    return (time if time.tzinfo else time.replace(tzinfo=UTC)).timestamp()


def misplaced(lat: float, lon: float) -> str | None:
    """Return why (lat, lon) is invalid, or None."""
    if -90.0 <= lat <= 90.0 and -180.0 <= lon <= 180.0:
        return None
    if not (math.isfinite(lat) and math.isfinite(lon)):
        return "latitude or longitude not a number"
    return "longitude not in -180 to 180" if -90.0 <= lat <= 90.0 else "latitude not in -90 to 90"


def count(met: dict[str, Count], what: str, line: int, times: int = 1) -> None:
    before, first = met.get(what, (0, line))
    met[what] = Count(before + times, min(first, line))


def backwards(time: np.ndarray, segment: np.ndarray) -> np.ndarray:
    """Which positions are left over by the longest run in order of time in each segment."""
    timed = np.flatnonzero(~np.isnan(time))
    back = timed[1:][np.diff(time[timed]) < 0.0]
    judged = timed[np.isin(segment[timed], segment[back])]
    if not judged.size:
        return judged
    parts = np.split(judged, np.flatnonzero(np.diff(segment[judged])) + 1)
    return np.concatenate([part[_left_over(time[part])] for part in parts])


def _left_over(time: np.ndarray) -> np.ndarray:
    """Which times the longest run in order leaves over."""
    _, rank = np.unique(time, return_inverse=True)
    # Patience sorting, from the last to the first.
    falling, ends = array("q", -rank), array("q")
    lengths = array("q", falling)  # in epochs, of the longest run that begins there, less one
    for i in reversed(range(len(falling))):
        lengths[i] = bisect_left(ends, falling[i])
        ends[lengths[i] : lengths[i] + 1] = array("q", [falling[i]])
    # Of runs as long, the one that begins first and then goes on with the nearest times.
    kept = lengths.index(len(ends) - 1)
    left = np.arange(rank.size) != kept
    for i in array("q", np.lexsort((rank, np.negative(lengths)))):
        same = (falling[i], lengths[i]) == (falling[kept], lengths[kept])
        if i > kept and (same or falling[i] < falling[kept]):
            left[i], kept = False, i
    return left
