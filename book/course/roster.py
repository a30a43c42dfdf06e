"""The class: students.csv in the folder of a course, with a line for each student."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import NamedTuple


class Student(NamedTuple):
    """A student of the class; the user name is that in Moodle, in Canvas or on the hub."""

    username: str
    name: str = ""
    email: str = ""
    id: str = ""
    group: str = ""


def read(path: Path) -> list[Student]:
    """Return the students of a CSV file whose first line names its columns."""
    with path.open(encoding="utf-8-sig", newline="") as file:
        rows = list(csv.DictReader(file))
    return [
        Student(**{name: (row.get(name) or "").strip() for name in Student._fields}) for row in rows
    ]
