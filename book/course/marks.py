"""The gradebook's points as the tables that Moodle and Canvas import."""

from __future__ import annotations

import csv
from pathlib import Path

from nbgrader.api import Gradebook


def write(book: Gradebook, folder: Path) -> list[Path]:
    """Write marks-moodle.csv and marks-canvas.csv; what was not handed in stays empty.

    A student is known by the name of the folder, which has to be the user name there. Canvas
    finds an assignment by its name, and makes one that it does not know.
    """
    assignments = sorted((each.name, each.max_score) for each in book.assignments)
    names = [name for name, _ in assignments]
    reached: dict[str, dict[str, float]] = {}
    for name in names:
        for each in book.assignment_submissions(name):
            points = max(0.0, each.score - each.late_submission_penalty)
            reached.setdefault(each.student.id, {})[name] = points
    marks = {
        student: [f"{row[name]:g}" if name in row else "" for name in names]
        for student, row in sorted(reached.items())
    }
    moodle = [["Username", *names], *([student, *row] for student, row in marks.items())]
    canvas = [
        ["Student", "ID", "SIS User ID", "SIS Login ID", "Section", *names],
        ["    Points Possible", "", "", "", "", *(f"{most:g}" for _, most in assignments)],
        *([student, "", "", student, "", *row] for student, row in marks.items()),
    ]
    written = []
    for kind, rows in ("moodle", moodle), ("canvas", canvas):
        path = folder / f"marks-{kind}.csv"
        with path.open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows(rows)
        written.append(path)
    return written
