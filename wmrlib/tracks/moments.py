"""What the times of a table mean, as far as only all of them together tell."""

from __future__ import annotations

import math
import re
from array import array
from datetime import date

import numpy as np

from wmrlib.tracks.fixes import NO_TIME, Fixes, number, timestamp

DAY = 86400.0
_MOST_SECONDS = 1e11  # milliseconds since 1970 are more
_ORDERS = ((0, 1, 2), (2, 1, 0), (2, 0, 1))  # where year, month and day stand in a date
_EPOCH = date(1970, 1, 1).toordinal()
_UNREADABLE = "with an unreadable time"


class Moments:
    """The times of the positions, and the dates beside them, which `settle` adds."""

    def __init__(self, has_unit: bool) -> None:
        self.plain, self.dated = not has_unit, -1  # whether all are numbers without a unit
        self.dates: dict[str, int] = {}
        self.which = array("q")  # date of each position, -1 without

    def read(self, time: str, date: str | None, per_second: float) -> float | None:
        """Seconds, since midnight if they have a date; NaN without, None if unreadable."""
        self.dated, text = -1, time.strip()
        if not text:
            return NO_TIME
        if date is None:
            seconds = math.nan if ":" in text else plain_number(text) / per_second
            if math.isfinite(seconds):
                return seconds if abs(seconds) < _MOST_SECONDS else None
            self.plain = False
            return timestamp(text)
        self.plain = False
        clock, dot, fraction = text.partition(".")
        clock = clock.zfill(6) if clock.isdigit() else clock
        moment = timestamp(f"1970-01-01T{clock}{dot}{fraction}")
        if moment is None:
            return timestamp(text)
        self.dated = self.dates.setdefault(date.strip(), len(self.dates))
        return moment

    def keep(self, used: bool) -> bool:
        """Remember the date of a position if it is used."""
        if used:
            self.which.append(self.dated)
        return used

    def settle(self, fixes: Fixes) -> None:
        """Add the dates, and find out whether numbers are seconds."""
        if not self.which:
            return
        time, which = np.frombuffer(fixes.time), np.frombuffer(self.which, "q")
        if self.dates:
            days = np.append(_days([*self.dates]), 0.0)[which]
            time += DAY * days
            _note(fixes, _UNREADABLE, np.isnan(days))
        timed = np.isfinite(time)
        seconds = time[timed]
        steps = np.abs(np.diff(seconds))
        if not self.plain or not steps.any():
            return
        step = float(np.median(steps[steps > 0.0]))
        if step < 0.01 and seconds.min() > 2e4 and seconds.max() < 8e4:  # the years 1954 to 2119
            time *= DAY
            _note(fixes, "with a time in days, as spreadsheets count them", timed)
        elif step >= 100.0 and seconds.max() < 1e9 and not (seconds % 1.0).any():
            time[:] = NO_TIME
            unit = "with a time in seconds or milliseconds, which time_s or time_ms would tell"
            _note(fixes, unit, timed)


def plain_number(cell: str) -> float:
    """The number of a cell; a single comma is a decimal comma, since it does not end the cell."""
    try:
        return math.nan if "_" in cell else float(cell)
    except ValueError:
        return number("" if "." in cell else cell.replace(",", ".", 1))


def _note(fixes: Fixes, what: str, which: np.ndarray) -> None:
    if which.any():
        fixes.note(what, fixes.lines[int(which.argmax())], int(which.sum()))


def _days(dates: list[str]) -> np.ndarray:
    """The dates as numbers of days, NaN if unreadable, in the order that brings them nearest.

    A wrong order makes years of days. Where two orders are as good and not the same, none is.
    """
    readings = []
    for order in _ORDERS:
        days = np.array([_day(each, order) for each in dates])
        known = days[~np.isnan(days)]
        if known.size:
            readings.append((int(np.isnan(days).sum()), float(np.ptp(known)), days, known[0]))
    best = min((reading[:2] for reading in readings), default=())
    found = [(days, days - begin) for *how, days, begin in readings if tuple(how) == best]
    if found and all(np.array_equal(found[0][1], apart, equal_nan=True) for _, apart in found):
        return found[0][0]
    return np.full(len(dates), math.nan)


def _day(text: str, order: tuple[int, int, int]) -> float:
    """The day's number of 2013/05/12, 12.5.2013 or 130512 in this order, NaN if it is none."""
    parts = re.findall("[0-9]+", text)
    if len(parts) == 1 and len(text) < 7:  # a spreadsheet drops zeros in front
        parts = re.findall("..", text.zfill(6))
    elif len(parts) == 1 and len(text) == 8:
        parts = [text[:4], text[4:6], text[6:]]
        if not 1900 < int(parts[0]) < 2100:
            parts = [text[:2], text[2:4], text[4:]]
    if len(parts) != 3 or len(text) > 10:
        return math.nan
    year, month, day = (parts[i] for i in (_ORDERS[0] if len(parts[0]) > 2 else order))
    century = 0 if len(year) > 2 else 1900 if int(year) >= 80 else 2000
    try:
        return date(century + int(year), int(month), int(day)).toordinal() - _EPOCH
    except ValueError:
        return math.nan
