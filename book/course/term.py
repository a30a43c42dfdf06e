"""Once a week: python book/course/term.py

It grades what is due and came anew, and prints what came in and what did not, what an assistant
must look at, what most got wrong, and what to vote on in the next lesson. students.csv has the
class, term.toml the due dates; both are in the folder of the course, and policy.py tells the form.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import textwrap
from collections import Counter, defaultdict
from collections.abc import Iterator
from contextlib import nullcontext
from datetime import UTC, datetime, timedelta
from pathlib import Path
from unicodedata import normalize

import grade
import nbformat
import policy
import roster
from alike import alike
from cells import visible
from gradebook import COURSE
from handins import assignments
from nbformat import NotebookNode
from nbgrader.api import Gradebook
from nbgrader.utils import determine_grade, is_grade, parse_utc
from sandbox import Limits
from table import Row

WEEK = timedelta(days=7)
MOST = 4  # of the mistakes in an assignment
SCREEN = 15  # lines of a part
TASK = re.compile(r"^## Task ([\d.]+): (.+)$", re.MULTILINE)
NUMBER = re.compile(r"[-+]?\d[\d.]*(?:e[-+]?\d+)?")
AWAITED = "was not answered"
USUAL = re.compile(r"^$|^repaired:|^\+ |for lateness$|^not in students.csv")  # and no trouble


class Week:
    """A course, or a group of it, at a time; a method that yields lines is a part of the report."""

    def __init__(self, folder: Path, now: datetime, group: str = "") -> None:
        self.folder, self.now = folder, now
        students, term = roster.of(folder), policy.read(folder)
        if not students or not term:
            needed = "term.toml, and students.csv with a column username, are needed"
            raise ValueError(f"{folder}: {needed}; the lecturer's guide shows both")
        self.term = term
        if group and group not in (groups := {each.group for each in students}):
            raise ValueError(f"no group {group}: there are {', '.join(sorted(groups))}")
        self.names = [each.username for each in students if group in ("", each.group)]
        self.others = {each.username for each in students} - {*self.names}
        self.due = [name for name, when in sorted(term.due.items()) if when <= now]
        recent = [name for name in self.due if now - term.due[name] < WEEK]
        self.current = recent or self.due[-1:]
        self.sources = assignments(folder)

    def handed_in(self, assignment: str) -> dict[str, datetime | None]:
        """Whose notebook is there, and when it came."""
        came = {}
        for path in sorted(self.folder.glob(f"submitted/*/{assignment}")):
            if any(path.glob("*.ipynb")):
                who, when = normalize("NFC", path.parent.name), policy.stamp(path)
                came[who] = policy.aware(parse_utc(when)) if when else None
        return came

    def came_in(self) -> Iterator[str]:
        """Who handed in what is due, late or not at all."""
        for each in self.current:
            came = {who: at for who, at in self.handed_in(each).items() if who in self.names}
            late = {who: self.term.days_late(each, who, at) for who, at in came.items()}
            late = [f"{who} by {days} day{'s' * (days > 1)}" for who, days in late.items() if days]
            missing = [who for who in self.names if who not in came]
            waits = [who for who in missing if self.term.due_for(each, who) > self.now]
            missing = [who for who in missing if who not in waits]
            unknown = sum(at is None for at in came.values())
            yield f"{each}: {len(came)} of {len(self.names)}" + "".join(
                f"; {what}: {listed(who)}"
                for what, who in (
                    ("late", late),
                    ("not yet, with an extension", waits),
                    ("missing", missing),
                    ("without a time", [str(unknown)] * bool(unknown)),
                )
                if who
            )

    def strangers(self) -> Iterator[str]:
        """Who is in submitted and not in the class, and the other way round."""
        homes = [path for path in (self.folder / "submitted").glob("[!.]*") if path.is_dir()]
        there = {normalize("NFC", path.name) for path in homes}
        if unknown := sorted(there - {*self.names} - self.others):
            yield f"in submitted and not in students.csv: {listed(unknown)}"
        if self.due and (silent := [each for each in self.names if each not in there]):
            yield f"nothing yet of: {listed(silent)}"

    def graded(self, rows: list[Row]) -> Iterator[str]:
        """What was graded anew."""
        new = [row for row in rows if row.points and row.anew]
        for each, count in sorted(Counter(row.assignment for row in new).items()):
            points = sum(float(it.points.split("/")[0]) for it in new if it.assignment == each)
            yield f"{each}: {count}, {points / count:.1f} points on average"

    def to_look_at(self, rows: list[Row]) -> Iterator[str]:
        """What the table says of hand-ins, what is marked by hand, and what looks copied."""
        for row in (row for row in rows if row.student not in self.others):
            if said := [it for it in row.said.split("; ") if not USUAL.search(it)]:
                yield f"{row.assignment} {row.student}: {'; '.join(said)}".strip()
        place = self.folder / "gradebook.db"
        with Gradebook(f"sqlite:///{place}") if place.exists() else nullcontext() as book:
            for each in book.assignments if book else ():
                those = (it for it in each.submissions if it.needs_manual_grade)
                if waiting := sorted({it.student.id for it in those} - self.others):
                    yield f"{each.name}: {len(waiting)} to mark by hand: {listed(waiting)}"
        for each in self.current:
            task_of, known = self.tasks(each)
            answers = defaultdict(dict)
            for student, notebook in self.ran(each):
                for cell in notebook.cells:
                    ours = cell.metadata.get("nbgrader", {})
                    if cell.cell_type == "code" and ours.get("solution"):
                        answers[ours.grade_id][student] = cell.source
            for name, sources in answers.items():
                for students, shared in alike(sources, known):
                    if {*students} - self.others:
                        who, what = ", ".join(students), ", ".join(shared[:3])
                        yield f"{each} {who}: alike in {task_of[name]}, and only there: {what}"

    def mistakes(self) -> Iterator[str]:
        """What most got wrong, in what is due now."""
        for each in self.current:
            task_of, _ = self.tasks(each)
            told, count = defaultdict(list), 0
            for _, notebook in self.ran(each):
                count += 1
                for task, hint in failed(notebook, task_of).items():
                    if hint.startswith("Stopped: "):  # which the table says
                        continue
                    told[task, NUMBER.sub("#", hint)].append(hint)
            for (task, _), hints in sorted(told.items(), key=lambda it: -len(it[1]))[:MOST]:
                if len(hints) > 1:
                    yield f"{each} {len(hints)} of {count} failed {task}: {hints[0]}"

    def votes(self) -> Iterator[str]:
        """What the deck of questions has for the next lesson."""
        from wmrbook.questions import of_chapter

        lessons = self.term.due | self.term.lessons
        later = sorted((when, each) for each, when in lessons.items() if when > self.now)
        for when, each in later[:1]:
            for title in of_chapter(chapter := int(each.removeprefix("ch"))):
                yield f"{title} (chapter {chapter}, by {when:%d %b})"

    def tasks(self, assignment: str) -> tuple[dict[str, str], str]:
        """The task that each cell belongs to, and all that the lecturer has written."""
        found, task = {}, ""
        source = nbformat.read(self.sources[assignment], as_version=4)
        for cell in source.cells:
            task = next((f"{one} ({it})" for one, it in TASK.findall(cell.source)), task)
            found[cell.metadata.nbgrader.grade_id] = task
        return found, "\n".join(cell.source for cell in source.cells)

    def ran(self, assignment: str) -> Iterator[tuple[str, NotebookNode]]:
        """The graded notebooks of an assignment, with their students."""
        for path in sorted(self.folder.glob(f"autograded/*/{assignment}/*.ipynb")):
            yield path.parts[-3], nbformat.read(path, as_version=4)


def failed(notebook: NotebookNode, task_of: dict[str, str]) -> dict[str, str]:
    """Why tasks lost points: the first hint of each, in one line."""
    found: dict[str, str] = {}
    for cell in filter(is_grade, notebook.cells):
        points, most = determine_grade(cell)
        if points is None or points >= most:  # None is for a person to say
            continue
        errors = [it for it in cell.get("outputs", ()) if it.output_type == "error"]
        for it in errors[:1]:
            said = it.evalue if it.ename == "Hint" else f"{it.ename}: {it.evalue}"
            said = AWAITED if "not written yet" in said else " ".join(said.split())
            found.setdefault(task_of[cell.metadata.nbgrader.grade_id], said)
    return found


def listed(names: list[str], most: int = 8) -> str:
    """Some of the names, and how many there are more."""
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(names[:most]) + more


def report(week: Week, rows: list[Row]) -> str:
    """The report as text, as wide as the window."""
    when = week.now.astimezone(next(iter(week.term.due.values())).tzinfo)
    later = sorted((at, each) for each, at in week.term.due.items() if at > week.now)
    due = f"next {later[0][1]}, due {later[0][0]:%a %d %b %H:%M}" if later else "nothing is left"
    text = [f"{when:%a %d %b %Y %H:%M}. Due: {', '.join(week.current) or 'nothing yet'}; {due}."]
    wide = shutil.get_terminal_size((100, 50)).columns
    for title, lines in (
        ("came in", week.came_in()),
        ("who", week.strangers()),
        ("graded", week.graded(rows)),
        ("look at", week.to_look_at(rows)),
        ("wrong", week.mistakes()),
        ("vote on", week.votes()),
    ):
        lines = [*lines]
        more = [f"and {len(lines) - SCREEN} more, in the table of grade.py"]
        for count, line in enumerate(lines[:SCREEN] + more * (len(lines) > SCREEN)):
            begin = f"{'' if count else title:<9}"
            text += textwrap.wrap(line, wide, initial_indent=begin, subsequent_indent=" " * 11)
    return visible("\n".join(text))


def main(folder: Path, now: datetime, look: bool = False, group: str = "") -> str:
    """Grade what is due, unless it is only to be looked at, and return the report."""
    week = Week(folder, now, group)
    jobs = os.cpu_count() or 1
    rows = [] if look or not week.due else grade.grade(folder, week.due, Limits(), jobs)
    return report(week, rows)


if __name__ == "__main__":
    form = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=form)
    parser.add_argument("--course", type=Path, default=COURSE, help="the folder of the course")
    parser.add_argument("--look", action="store_true", help="grade nothing")
    parser.add_argument("--group", default="", help="report of this group of students.csv alone")
    said = "another time than now, such as 2026-10-20T08:00+02:00"
    parser.add_argument("--now", type=datetime.fromisoformat, default=datetime.now(UTC), help=said)
    given = parser.parse_args()
    try:
        print(main(given.course.resolve(), given.now.astimezone(), given.look, given.group))
    except ValueError as error:
        raise SystemExit(str(error)) from None
