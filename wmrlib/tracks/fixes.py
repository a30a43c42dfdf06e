"""What every reader of position files shares: the positions that are used, and an account of everything that is not."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import NamedTuple

NO_TIME = math.nan


class Count(NamedTuple):
    """How often something was met, and where first: the line of the file (of a GeoJSON file, the number of the position)."""

    count: int
    first: int


@dataclass(frozen=True)
class Report:
    """What was read from a file and what was not; `print` it.

    used: positions; skipped: from the reason why a line gave no position to its Count; noted: the same for positions that are used
    although something is amiss with them; unit: "line", or "position" for a file whose lines say nothing (GeoJSON).
    """

    used: int
    skipped: Mapping[str, Count]
    noted: Mapping[str, Count] = field(default_factory=dict)
    unit: str = "line"

    def __post_init__(self) -> None:
        object.__setattr__(self, "skipped", MappingProxyType(dict(self.skipped)))
        object.__setattr__(self, "noted", MappingProxyType(dict(self.noted)))

    def __repr__(self) -> str:
        rows = [f"{self.used} position{'' if self.used == 1 else 's'} used"]
        for reasons in (self.skipped, self.noted):
            what = "not used" if reasons is self.skipped else "used, but"
            rows += [
                f"{what}: {count} {reason} (first in {self.unit} {first})"
                for reason, (count, first) in reasons.items()
            ]
        return "\n".join(rows)


class Fixes:
    """The positions of one file, as they are found, and the reasons why others are not used."""

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

    def add(self, lat: float, lon: float, time: float, line: int) -> None:
        """Use a position (degrees; s, NaN without a time), unless there is a reason not to."""
        reason = misplaced(lat, lon)
        if reason is None and time < self._last_time:
            reason = "time runs backwards"
        if (
            reason is None
            and time == self._last_time
            and (lat, lon) == (self.lat[-1], self.lon[-1])
        ):
            reason = "same epoch again"
        if reason is not None:
            self.skip(reason, line)
            return
        self.lat.append(lat)
        self.lon.append(lon)
        self.time.append(time)
        if not math.isnan(time):
            self._last_time = time

    def report(self) -> Report:
        return Report(len(self.lat), self._skipped, self._noted, self._unit)


def misplaced(lat: float, lon: float) -> str | None:
    """Why this is no position on the Earth, if it is none."""
    if not (math.isfinite(lat) and math.isfinite(lon)):
        return "latitude or longitude not a number"
    if not -90.0 <= lat <= 90.0:
        return "latitude not in -90 to 90"
    if not -180.0 <= lon <= 180.0:
        return "longitude not in -180 to 180"
    return None


def number(text: str | None) -> float:
    """The number that the text is, NaN if it is none; Python's 1_000 is none."""
    try:
        return float(text) if text and "_" not in text else math.nan
    except ValueError:
        return math.nan


def _count(reasons: dict[str, Count], reason: str, line: int) -> None:
    count, first = reasons.get(reason, (0, line))
    reasons[reason] = Count(count + 1, first)
