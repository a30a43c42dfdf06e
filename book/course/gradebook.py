"""The folder of a course, through nbgrader: releases, points and pages."""

from __future__ import annotations

import argparse
import logging
import os
import re
import shutil
import sys
import tempfile
import warnings
from contextlib import suppress
from pathlib import Path

import nbformat
from handins import Refused, repaired
from nbformat import NotebookNode
from nbgrader.apps import NbGraderAPI
from nbgrader.converters import Autograde, GenerateFeedback
from nbgrader.preprocessors import CheckCellMetadata, Execute, OverwriteCells
from nbgrader.utils import capture_log, determine_grade, is_grade, parse_utc
from sqlalchemy.exc import SAWarning
from traitlets.config.loader import PyFileConfigLoader

COURSE = Path(__file__).resolve().parent


def options(description: str) -> argparse.ArgumentParser:
    """What the commands of the course have in common."""
    how = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=description, formatter_class=how)
    parser.add_argument("assignments", nargs="*", metavar="ASSIGNMENT", help="ch01, or all")
    parser.add_argument("--course", type=Path, default=COURSE, help="the folder of the course")
    return parser


class Course:
    """A course in a folder; use it in a `with` statement.

    nbgrader runs nothing here: it is given notebooks that have run, in place of submitted/.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        log = logging.getLogger("traitlets")  # what goes wrong is in the API's replies
        log.handlers, log.propagate = [logging.NullHandler()], False
        warnings.simplefilter("ignore", SAWarning)  # nbgrader adds a submission cell by cell
        tools = str(Path(sys.executable).parent)  # nbgrader calls alembic by name
        os.environ["PATH"] = os.pathsep.join([tools, os.environ.get("PATH", "")])
        self.ran = Path(tempfile.mkdtemp(prefix=".ran-", dir=folder))
        config = PyFileConfigLoader("nbgrader_config.py", str(folder)).load_config()
        config.CourseDirectory.root = str(folder)
        config.CourseDirectory.submitted_directory = self.ran.name
        steps = Autograde.autograde_preprocessors.default()
        config.Autograde.autograde_preprocessors = [step for step in steps if step is not Execute]
        config.Autograde.sanitize_preprocessors = [OverwriteCells, CheckCellMetadata]
        self.api = NbGraderAPI(config=config)
        self.sources = {path.parent.name: path for path in sorted(folder.glob("source/*/*.ipynb"))}

    def __enter__(self) -> Course:
        return self

    def __exit__(self, *_: object) -> None:
        shutil.rmtree(self.ran)

    def checked(self, wanted: list[str]) -> list[str]:
        """The assignments that were asked for, if there are such."""
        if unknown := ", ".join(sorted(set(wanted) - set(self.sources))):
            raise SystemExit(f"no assignment {unknown}: there are {', '.join(self.sources)}")
        return wanted

    def release(self, assignment: str) -> NotebookNode:
        """What students get, made anew if it is older than its source or not in the gradebook."""
        source = self.sources[assignment]
        path = self.folder / "release" / assignment / source.name
        with self.api.gradebook as book:
            known = assignment in [each.name for each in book.assignments]
        if not known or not path.exists() or path.stat().st_mtime < source.stat().st_mtime:
            _checked(self.api.generate_assignment(assignment))
        return nbformat.read(path, as_version=4)

    def solved(self, assignment: str) -> NotebookNode:
        """The release with the model's answers."""
        source = nbformat.read(self.sources[assignment], as_version=4)
        return repaired(source, self.release(assignment))[0]

    def score(self, assignment: str, student: str, ran: NotebookNode, handed_in: Path) -> str:
        """Store a hand-in that has run; return its points, such as "7/9"."""
        folder = self.ran / student / assignment
        folder.mkdir(parents=True)
        with suppress(OSError, ValueError):  # for penalties
            parse_utc(stamp := (handed_in / "timestamp.txt").read_text(encoding="utf-8").strip())
            (folder / "timestamp.txt").write_text(stamp, encoding="utf-8")
        nbformat.write(ran, folder / self.sources[assignment].name)
        _checked(self.api.autograde(assignment, student))
        with self.api.gradebook as book:
            graded = book.find_submission(assignment, student)
            return f"{graded.score:g}/{graded.max_score:g}"

    def give_back(self, assignment: str, student: str) -> None:
        """Write the page that a student reads."""
        ours = self.api.coursedir
        ours.assignment_id, ours.student_id = assignment, student
        page = GenerateFeedback(coursedir=ours, parent=self.api)
        page.force = True
        _checked(capture_log(page))


def lost(ran: NotebookNode) -> list[str]:
    """The checks that a notebook does not pass."""
    graded = [(cell, determine_grade(cell)) for cell in ran.cells if is_grade(cell)]
    return [cell.metadata.nbgrader.grade_id for cell, (points, most) in graded if points < most]


def _checked(reply: dict) -> None:
    """Raise Refused with the error that nbgrader logs, if it did not succeed."""
    if not reply["success"]:
        said = reply.get("log") or reply["error"]
        errors = re.findall(r"^ *(\w*(?:Error|Exception): .*)", said, re.MULTILINE)
        raise Refused(f"nbgrader: {[*said.strip().splitlines(), *errors][-1]}")
