"""The folder of a course, through nbgrader: releases, points and pages."""

from __future__ import annotations

import argparse
import json
import logging
import os
import re
import sys
import warnings
from contextlib import suppress
from functools import cached_property
from hashlib import sha256
from pathlib import Path
from typing import NamedTuple

import feedback
import nbformat
import policy
from cells import grade_id
from handins import Refused, assignments, repaired, write
from nbformat import NotebookNode
from nbgrader.api import Gradebook, MissingEntry, SubmittedAssignment
from nbgrader.apps import NbGraderAPI
from nbgrader.utils import compute_checksum, determine_grade, is_grade, is_solution, parse_utc
from sqlalchemy.exc import SAWarning
from traitlets.config.loader import PyFileConfigLoader

COURSE = Path(__file__).resolve().parent
SCHEME = re.compile("=== BEGIN MARK SCHEME ===.*?=== END MARK SCHEME ===", re.DOTALL)
TOOLS = str(Path(sys.executable).parent)  # nbgrader calls alembic by name
os.environ["PATH"] = os.pathsep.join([TOOLS, os.environ.get("PATH", "")])
KNOWN = "graded.json"  # beside the notebook that has run


class Points(NamedTuple):
    """What a hand-in has: points, the most that checks could give, and what to know of them."""

    reached: float
    most: float
    said: list[str]


def options(description: str) -> argparse.ArgumentParser:
    """What the commands of the course have in common."""
    how = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=description, formatter_class=how)
    parser.add_argument("assignments", nargs="*", metavar="ASSIGNMENT", help="ch01, or all")
    parser.add_argument("--course", type=Path, default=COURSE, help="the folder of the course")
    return parser


class Course:
    """A course in a folder; use it in a `with` statement.

    nbgrader runs nothing here: what has run goes into autograded/ and into its gradebook.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        log = logging.getLogger("traitlets")  # what goes wrong is in the API's replies
        log.handlers, log.propagate = [logging.NullHandler()], False
        warnings.simplefilter("ignore", SAWarning)  # nbgrader adds a submission cell by cell
        config = PyFileConfigLoader("nbgrader_config.py", str(folder)).load_config()
        config.CourseDirectory.root = str(folder)
        self.api = NbGraderAPI(config=config)
        self.releases: dict[str, NotebookNode] = {}
        self.sources = assignments(folder)

    def __enter__(self) -> Course:
        return self

    def __exit__(self, *_: object) -> None:
        if "book" in vars(self):
            self.book.close()

    @cached_property
    def book(self) -> Gradebook:
        """The gradebook, which stays open: to open it takes longer than to write a hand-in."""
        return self.api.gradebook

    def checked(self, wanted: list[str]) -> list[str]:
        """The assignments that were asked for, if there are such."""
        if unknown := ", ".join(sorted(set(wanted) - set(self.sources))):
            raise SystemExit(f"no assignment {unknown}: there are {', '.join(self.sources)}")
        return wanted

    def release(self, assignment: str) -> NotebookNode:
        """What students get, made anew if it is older than its source or not in the gradebook."""
        if assignment in self.releases:
            return self.releases[assignment]
        source = self.sources[assignment]
        path = self.folder / "release" / assignment / source.name
        with self.api.gradebook as book:
            known = assignment in [each.name for each in book.assignments]
        if not known or not path.exists() or path.stat().st_mtime < source.stat().st_mtime:
            _checked(self.api.generate_assignment(assignment))
        self.releases[assignment] = nbformat.read(path, as_version=4)
        return self.releases[assignment]

    def solved(self, assignment: str) -> NotebookNode:
        """The release with the model's answers."""
        source = nbformat.read(self.sources[assignment], as_version=4)
        return repaired(source, self.release(assignment))[0]

    def earlier(self, assignment: str, student: str) -> dict[str, str]:
        """What is known of the hand-in that was graded last: see `score`; empty if none was."""
        with suppress(OSError, ValueError, MissingEntry):
            self.book.find_submission(assignment, student)
            known = json.loads((self._ran(assignment, student).parent / KNOWN).read_text("utf-8"))
            return known if isinstance(known, dict) else {}
        return {}

    def score(
        self, assignment: str, student: str, ran: NotebookNode, stamp: str, known: dict[str, str]
    ) -> None:
        """Store a hand-in that has run.

        stamp: when it was handed in, or nothing. known: the hashes of the answers ("answers") and
        of all that its points follow from ("key"), and what is said of it ("said").
        """
        again = self.earlier(assignment, student).get("answers") == known["answers"]
        self.book.update_or_create_student(student)
        when = {"timestamp": parse_utc(stamp) if stamp else None}
        submission = self.book.update_or_create_submission(assignment, student, **when)
        (notebook,) = submission.notebooks
        grades = {each.name: each for each in notebook.grades}
        comments = {each.name: each for each in notebook.comments}
        for cell in filter(is_grade, ran.cells):
            grade = grades[cell.metadata.nbgrader.grade_id]
            grade.auto_score, _ = determine_grade(cell)
            if grade.manual_score is None:
                grade.needs_manual_grade = grade.auto_score is None
            elif not again:
                grade.needs_manual_grade = True
        for cell in filter(is_solution, ran.cells):
            about = cell.metadata.nbgrader
            untouched = about.get("checksum") == compute_checksum(cell)
            comments[about.grade_id].auto_comment = "No response." if untouched else None
        given = {cell.source for cell in self.release(assignment).cells}
        path = self._ran(assignment, student)
        ran = feedback.harmless(ran, given)
        source = nbformat.read(self.sources[assignment], as_version=4).cells
        whole = {grade_id(it): it.source for it in source if SCHEME.search(it.source)}
        for cell in ran.cells:  # the formgrader shows what an assistant marks by
            cell.source = whole.get(grade_id(cell), cell.source)
        write(path.parent / KNOWN, "{}")  # until the points are in, too
        write(path, nbformat.writes(ran))
        self.book.db.commit()
        write(path.parent / KNOWN, json.dumps(known))

    def points(self, assignment: str, student: str) -> Points:
        """What a hand-in has now, after the penalty for lateness that is in force now."""
        submission = self.book.find_submission(assignment, student)
        (notebook,) = submission.notebooks
        notebook.late_submission_penalty = None
        if term := policy.read(self.folder):
            policy.settle(submission, term)
            days = term.days_late(assignment, student, policy.aware(submission.timestamp))
            notebook.late_submission_penalty = term.penalty(days, notebook.score) or None
        self.book.db.commit()
        pending = [each for each in notebook.grades if each.auto_score is each.manual_score is None]
        left = sum(each.max_score for each in pending)
        said = []
        if pending:
            said.append(f"+ {left:g} to be marked by hand: {_names(pending)}")
        if notebook.late_submission_penalty:
            said.append(f"{notebook.late_submission_penalty:g} points off for lateness")
        old = [e for e in notebook.grades if e.needs_manual_grade and e.manual_score is not None]
        if old:
            said.append(f"a manual score of an earlier hand-in stands, look at it: {_names(old)}")
        return Points(reached(submission), submission.max_score - left, said)

    def give_back(self, assignment: str, student: str) -> None:
        """Write the page that a student reads, if anything in it has changed."""
        path = self._ran(assignment, student)
        submission = self.book.find_submission(assignment, student)
        (notebook,) = submission.notebooks
        grades = {each.name: (each.score, each.max_score) for each in notebook.grades}
        comments = {each.name: each.comment for each in notebook.comments}
        place = self.folder / "feedback" / student / assignment / f"{path.stem}.html"
        penalty = notebook.late_submission_penalty or 0
        told = repr((sorted(grades.items()), sorted(comments.items()), penalty))
        mark = sha256(path.read_bytes() + told.encode() + feedback.source()).hexdigest()
        known = self.earlier(assignment, student)
        if known.get("page") == mark and place.exists():
            return
        ran = nbformat.read(path, as_version=4)
        for cell in ran.cells:
            cell.source = SCHEME.sub("", cell.source)
            about = cell.metadata.get("nbgrader", {})
            if is_grade(cell):
                about["score"], about["points"] = grades[about["grade_id"]]
            if is_solution(cell):
                about["comment"] = comments[about["grade_id"]]
        whole = {"score": reached(submission), "max_score": submission.max_score}
        page = feedback.page(ran, whole | {"notebook": path.stem, "late_penalty": penalty})
        write(place, page)
        write(path.parent / KNOWN, json.dumps(known | {"page": mark}))

    def _ran(self, assignment: str, student: str) -> Path:
        """Where a hand-in is that has run."""
        return self.folder / "autograded" / student / assignment / self.sources[assignment].name


def reached(submission: SubmittedAssignment) -> float:
    """The points of a hand-in after its penalty, in the table as in the marks."""
    return max(0.0, submission.score - (submission.late_submission_penalty or 0))


def lost(ran: NotebookNode) -> list[str]:
    """The checks that a notebook does not pass; what is marked by hand is none."""
    graded = [(cell, *determine_grade(cell)) for cell in ran.cells if is_grade(cell)]
    names = [(cell.metadata.nbgrader.grade_id, points, most) for cell, points, most in graded]
    return [name for name, points, most in names if points is not None and points < most]


def _names(each: list) -> str:
    return ", ".join(sorted(it.name for it in each))


def _checked(reply: dict) -> None:
    """Raise Refused with the error that nbgrader logs, if it did not succeed."""
    if not reply["success"]:
        said = reply.get("log") or reply["error"]
        errors = re.findall(r"^ *(\w*(?:Error|Exception): .*)", said, re.MULTILINE)
        raise Refused(f"nbgrader: {[*said.strip().splitlines(), *errors][-1]}")
