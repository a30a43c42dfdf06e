"""The gradebook's points as the tables that Moodle and Canvas import."""

from __future__ import annotations

import csv
from pathlib import Path

import roster
from gradebook import reached
from nbgrader.api import Gradebook


def write(book: Gradebook, folder: Path) -> list[str]:
    """Write marks-moodle.csv and marks-canvas.csv; return whose points are in neither.

    What was not handed in stays empty. With a roster, the students are those on it; else those
    who have handed in, by the name of the folder, which has to be the user name there. Canvas
    finds an assignment by its name, and makes one that it does not know.
    """
    assignments = sorted((each.name, each.max_score) for each in book.assignments)
    names = [name for name, _ in assignments]
    points: dict[str, dict[str, float]] = {}
    for name in names:
        for each in book.assignment_submissions(name):
            points.setdefault(each.student.id, {})[name] = reached(each)
    students = roster.of(folder) or [roster.Student(each) for each in sorted(points)]
    marks = [
        (it, [f"{row[name]:g}" if name in row else "" for name in names])
        for it in students
        for row in [points.get(it.username, {})]
    ]
    moodle = [["Username", *names], *([it.username, *row] for it, row in marks)]
    canvas = [
        ["Student", "ID", "SIS User ID", "SIS Login ID", "Section", *names],
        ["    Points Possible", "", "", "", "", *(f"{most:g}" for _, most in assignments)],
        *([it.name or it.username, it.id, "", it.username, "", *row] for it, row in marks),
    ]
    for kind, rows in ("moodle", moodle), ("canvas", canvas):
        with (folder / f"marks-{kind}.csv").open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows(rows)
    return sorted(points.keys() - {it.username for it in students})
