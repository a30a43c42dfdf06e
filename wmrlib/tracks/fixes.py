"""What every reader of position files shares: the positions used, and an account of the rest."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from types import MappingProxyType
from typing import NamedTuple

NO_TIME = math.nan


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
    unit : what `Count.first` counts: "line", or "position" for GeoJSON
    """

    used: int
    skipped: Mapping[str, Count]
    noted: Mapping[str, Count] = field(default_factory=dict)
    unit: str = "line"

    def __repr__(self) -> str:
        rows = [f"{self.used} position{'' if self.used == 1 else 's'} used"]
        rows += [f"not used: {each}" for each in self.listed(self.skipped)]
        rows += [f"used, but: {each}" for each in self.listed(self.noted)]
        return "\n".join(rows)

    def listed(self, reasons: Mapping[str, Count]) -> list[str]:
        rows = reasons.items()
        return [f"{n} {reason} (first in {self.unit} {first})" for reason, (n, first) in rows]


class Fixes:
    """The positions of one file as they are found, and the reasons why others are not used."""

    def __init__(self, unit: str = "line") -> None:
        self.lat: list[float] = []
        self.lon: list[float] = []
        self.time: list[float] = []
        self._skipped: dict[str, Count] = {}
        self._noted: dict[str, Count] = {}
        self._unit = unit
        self._last_time = -math.inf

    def skip(self, reason: str, line: int) -> None:
        _count(self._skipped, reason, line)

    def note(self, reason: str, line: int) -> None:
        _count(self._noted, reason, line)

    def add(self, lat: float, lon: float, time: float | None, line: int) -> bool:
        """Use a position (degrees; s, NaN if absent, None if unreadable), or count why not."""
        reason = _misplaced(lat, lon)
        if reason is None and time is not None and time <= self._last_time:
            if time < self._last_time:
                reason = "time runs backwards"
            elif (lat, lon) == (self.lat[-1], self.lon[-1]):
                reason = "same epoch again"
        if reason is not None:
            self.skip(reason, line)
            return False
        if time is None:
            self.note("with an unreadable time", line)
        self.lat.append(lat)
        self.lon.append(lon)
        self.time.append(NO_TIME if time is None else time)
        if not math.isnan(self.time[-1]):
            self._last_time = self.time[-1]
        return True

    def report(self) -> Report:
        skipped, noted = MappingProxyType(self._skipped), MappingProxyType(self._noted)
        return Report(len(self.lat), skipped, noted, self._unit)


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
        return None
    return (time if time.tzinfo else time.replace(tzinfo=UTC)).timestamp()


def _misplaced(lat: float, lon: float) -> str | None:
    """Return why (lat, lon) is invalid, or None."""
    if not (math.isfinite(lat) and math.isfinite(lon)):
        return "latitude or longitude not a number"
    if not -90.0 <= lat <= 90.0:
        return "latitude not in -90 to 90"
    return None if -180.0 <= lon <= 180.0 else "longitude not in -180 to 180"


def _count(reasons: dict[str, Count], reason: str, line: int) -> None:
    count, first = reasons.get(reason, (0, line))
    reasons[reason] = Count(count + 1, first)
