"""What a term asks for: the due dates, extensions and late policy of term.toml.

zone = "Europe/Berlin"

[due]                 # a day ends at midnight
ch00 = 2026-10-12
ch01 = 2026-10-19T18:00:00

[late]
per_day = 0.1         # of the points reached, for each day begun
most_days = 7         # later nothing counts

[extensions]          # days for a student or a group; or dates
tuesday = 1
"d.lee" = { ch01 = 2026-10-22 }

[lessons]             # where they are not in the week in which the chapter is due
ch01 = 2026-10-13
"""

from __future__ import annotations

import math
import tomllib
from contextlib import suppress
from datetime import UTC, date, datetime, timedelta
from pathlib import Path
from typing import Any, NamedTuple
from zoneinfo import ZoneInfo

import roster
from nbgrader.api import SubmittedAssignment
from nbgrader.utils import parse_utc

TABLES = {"zone", "due", "late", "extensions", "lessons"}
MOST_DAYS = 10_000
RULES = {"per_day": 0.0, "most_days": math.inf}


class Term(NamedTuple):
    """A term's rules; times have their zone."""

    due: dict[str, datetime]
    lessons: dict[str, datetime]
    extensions: dict[str, Any]
    groups: dict[str, str]
    per_day: float
    most_days: float

    def due_for(self, assignment: str, student: str) -> datetime | None:
        """When this student hands in: of what is granted to them and to their group, the latest."""
        if not (common := self.due.get(assignment)):
            return None
        granted = (self.extensions.get(who) for who in {student, self.groups.get(student)})
        each = (it.get(assignment) if isinstance(it, dict) else it for it in granted)
        dates = (common + it if isinstance(it, timedelta) else it for it in each if it)
        return max([common, *dates])

    def days_late(self, assignment: str, student: str, handed_in: datetime | None) -> int:
        """How many days have begun since it was due; 0 where it was in time, or nobody knows."""
        due = self.due_for(assignment, student)
        if not due or not handed_in:
            return 0
        return max(0, math.ceil((handed_in - due) / timedelta(days=1)))

    def penalty(self, days: int, points: float) -> float:
        """The points that so many days cost."""
        return points if days > self.most_days else points * min(1.0, days * self.per_day)


def read(folder: Path) -> Term | None:
    """The rules in a course's folder, or None without term.toml; ValueError says what is wrong."""
    path = folder / "term.toml"
    if not path.exists():
        return None
    try:
        told = tomllib.loads(path.read_text(encoding="utf-8-sig"))
        zone = ZoneInfo(told.get("zone", "UTC"))
    except (ValueError, OSError, KeyError, TypeError) as error:
        raise ValueError(f"{path}: {error}") from None
    for table in sorted(TABLES - {"zone"}):
        if not isinstance(told.get(table, {}), dict):
            raise ValueError(f"{path}: {table} = {told[table]!r}: lines below [{table}] are needed")
    if not told.get("due"):
        raise ValueError(f"{path}: [due] with an assignment and its date is needed")
    students = roster.of(folder)
    groups = {each.username: each.group for each in students if each.group}
    known = {each.username for each in students} | {*groups.values()}
    assignments = {each.name for each in folder.glob("source/*/")}
    granted, late = told.get("extensions", {}), told.get("late", {})
    days = [days for days in granted.values() if isinstance(days, dict)]
    for where, names, allowed in (
        ("", told, TABLES),
        ("[late] ", late, {*RULES}),
        ("[extensions] ", granted, known if students else {*granted}),
        *((f"[{table}] ", told.get(table, {}), assignments) for table in ("due", "lessons")),
        *(("[extensions] ", each, assignments) for each in days),
    ):
        if unknown := ", ".join(sorted({*names} - allowed)):
            raise ValueError(f"{path}: {where}{unknown}: there are {', '.join(sorted(allowed))}")
    for name, value in late.items():
        if isinstance(value, bool) or not isinstance(value, int | float) or not value >= 0:
            raise ValueError(f"{path}: [late] {name} = {value!r}: a number from 0 on is needed")

    def when(name: str, value: Any, days: bool = False) -> Any:
        if isinstance(value, datetime):
            return value if value.tzinfo else value.replace(tzinfo=zone)
        if isinstance(value, date):  # to its last second
            return datetime(value.year, value.month, value.day, 23, 59, 59, tzinfo=zone)
        number = isinstance(value, int | float) and not isinstance(value, bool)
        if days and number and 0 <= value <= MOST_DAYS:
            return timedelta(days=value)
        needed = f"2026-10-19 or 2026-10-19T18:00:00{' or days' * days} is needed"
        raise ValueError(f"{path}: {name} = {value!r}: {needed}")

    due, lessons = (
        {name: when(name, value) for name, value in told.get(table, {}).items()}
        for table in ("due", "lessons")
    )
    extensions = {
        who: {each: when(f"{who}: {each}", value, True) for each, value in it.items()}
        if isinstance(it, dict)
        else when(who, it, True)
        for who, it in granted.items()
    }
    return Term(due, lessons, extensions, groups, **(RULES | late))


def settle(submission: SubmittedAssignment, term: Term) -> None:
    """Tell nbgrader when an assignment is due, and what this student is granted."""
    name = submission.assignment.name
    if due := term.due.get(name):
        own = term.due_for(name, submission.student.id)
        submission.assignment.duedate = due.astimezone(UTC).replace(tzinfo=None)
        submission.extension = own.astimezone(UTC) - due.astimezone(UTC)


def aware(stamp: datetime | None) -> datetime | None:
    """A time of nbgrader's, which is UTC and does not say so."""
    return stamp and stamp.replace(tzinfo=UTC)


def stamp(folder: Path) -> str:
    """When a hand-in came, as timestamp.txt says; nothing where nobody can read that."""
    with suppress(OSError, ValueError, OverflowError):
        text = (folder / "timestamp.txt").read_text("utf-8").strip()
        return text if parse_utc(text) else ""
    return ""
