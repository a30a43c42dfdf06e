"""Grade what the class has handed in: python book/course/grade.py [ASSIGNMENT ...]

It reads submitted/NAME/ASSIGNMENT/NOTEBOOK, repairs what can be repaired, runs each hand-in in
a process of its own, and ends with a table: graded, repaired and how, refused and why. Points
are then in gradebook.db, for nbgrader's other commands, and in marks-moodle.csv and
marks-canvas.csv; what students read is in feedback/NAME/ASSIGNMENT. What has not changed since
it was graded is not run again. The model's answers run first: an assignment in which they lose
points on this machine is not graded. Ctrl-C keeps what is graded so far.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Collection, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, ThreadPoolExecutor, wait
from contextlib import suppress
from pathlib import Path
from threading import Event
from typing import Any
from unicodedata import normalize

import handins
import marks
import nbformat
import roster
from cage import holds, next_user
from changes import HandIn, hash_of, look, sources
from gradebook import COURSE, Course, lost, options
from handins import Refused
from kernel import Limits
from nbgrader.api import MissingEntry
from roster import NAME
from sandbox import Sandbox, stops
from stopping import end, stoppable
from table import Row, nothing, table
from tqdm import tqdm

SECRETS = COURSE, COURSE.parents[1] / "tests", COURSE.parents[1] / ".git"


def grade(
    folder: Path,
    wanted: list[str],
    limits: Limits,
    jobs: int,
    students: Collection[str] = (),
    every: bool = False,
) -> list[Row]:
    """Grade the hand-ins of these assignments and students, or of all; return the table.

    every: also what has not changed since it was graded. Raises KeyboardInterrupt with a sentence
    when it is stopped, after it has written the marks.
    """
    people = roster.of(folder)
    with Course(folder) as course:
        rows, todo, names = _listed(course, wanted, students)
        releases, unfit = {}, {}
        for each in sorted({assignment for assignment, _, _ in todo}):
            try:
                releases[each] = course.release(each)
            except Refused as error:  # a task was changed that has been handed in
                unfit[each] = str(error)
        hashes = {each: hash_of(nbformat.writes(it), sources()) for each, it in releases.items()}
        fresh = []
        for assignment, student, place in todo:
            try:
                if assignment in unfit:
                    raise Refused(unfit[assignment])
                hand_in = look(course, assignment, student, place, hashes[assignment])
            except Exception as error:  # whatever it is, it stops nobody else
                rows.append(_refused(course, assignment, student, error))
                continue
            earlier = course.earlier(assignment, student)
            if every or earlier.get("key") != hand_in.known["key"]:
                fresh.append(hand_in)
            else:
                rows.append(_row(course, assignment, student, earlier.get("said", ""), False))
        with stoppable() as stopped:
            try:
                if fresh:
                    with Sandbox([folder, *SECRETS], limits) as sandbox:
                        what = sandbox, releases, fresh, names, jobs, stopped
                        rows.extend(_graded(course, *what))
            except KeyboardInterrupt:
                done = sum(row.anew and bool(row.points) for row in rows)
                said = f"Stopped: {done} of {len(fresh)} hand-ins are graded and in the marks;"
                said += " the same command goes on with the others."
                raise KeyboardInterrupt(said) from None
            finally:
                marks.write(course.book, folder)
    known = {each.username for each in people} or {row.student for row in rows}
    said = "not in students.csv and not in the marks; "
    return sorted(r if r.student in known else r._replace(said=said + r.said) for r in rows)


def _graded(
    course: Course,
    sandbox: Sandbox,
    releases: dict[str, nbformat.NotebookNode],
    fresh: list[HandIn],
    names: list[str],
    jobs: int,
    stopped: Event,
) -> Iterator[Row]:
    """Run the model of each assignment, then the hand-ins; a row for each that is done."""
    unfit = {}
    needed = sorted({each.assignment for each in fresh})

    def run_model(assignment: str) -> list[str]:
        return lost(sandbox.run(course.solved(assignment), "model", [], trusted=True))

    def run(it: HandIn) -> tuple:
        if it.assignment in unfit or stopped.is_set():
            raise Refused(unfit.get(it.assignment, "stopped"))
        notebook, how = sandbox.repaired(it.path, releases[it.assignment])
        return sandbox.run(notebook, it.student, names), it.odd + how

    bar = tqdm(total=len(needed) + len(fresh), unit="run", disable=None)
    with bar, ThreadPoolExecutor(jobs) as pool:
        for each, why in _each(pool, bar, stopped, run_model, needed):
            if why:
                unfit[each] = f"on this machine the model fails: {why}"
        for it, result in _each(pool, bar, stopped, run, fresh):
            try:
                if isinstance(result, Exception):
                    raise result
                ran, how = result
                said = [f"repaired: {', '.join(how)}"] * bool(how)
                said += handins.misnamed(ran, it.student) + stops(ran)
                known = it.known | {"said": "; ".join(said)}
                course.score(it.assignment, it.student, ran, it.stamp, known)
                yield _row(course, it.assignment, it.student, known["said"])
            except Exception as error:  # whatever it is, it stops nobody else
                yield _refused(course, it.assignment, it.student, error)


def _row(course: Course, assignment: str, student: str, said: str, anew: bool = True) -> Row:
    """The line of what is graded, and the page that belongs to it."""
    points = course.points(assignment, student)
    course.give_back(assignment, student)
    told = "; ".join(filter(None, [*points.said, said]))
    return Row(assignment, student, f"{points.reached:g}/{points.most:g}", told, anew)


def _refused(course: Course, assignment: str, student: str, error: Exception) -> Row:
    """The line of what can't be graded."""
    kind = "" if isinstance(error, Refused) else f"{type(error).__name__}: "
    said = f"refused: {kind}{error}"
    course.book.db.rollback()  # of what was begun
    with suppress(MissingEntry):
        course.book.find_submission(assignment, student)
        said += "; the points of an earlier hand-in stand"
    return Row(assignment, student, "", said)


def _listed(
    course: Course, wanted: list[str], students: Collection[str]
) -> tuple[list[Row], list[tuple[str, str, Path]], list[str]]:
    """What is refused by its name; what is to be graded: assignment, student, folder; the class."""
    wanted = course.checked(wanted) or list(course.sources)
    known = ", ".join(course.sources)
    rows, todo = [], []
    for home in sorted((course.folder / "submitted").glob("[!.]*")):
        if not home.is_dir() or home.is_symlink():
            rows.append(Row("", home.name, "", "refused: not a folder of a student"))
        elif not NAME.fullmatch(normalize("NFC", home.name)):
            said = "refused: the name may have letters, digits, blanks and _.@- only"
            rows.append(Row("", home.name, "", said))
        else:
            for place in sorted(home.glob("[!.]*")):
                if place.name not in course.sources:
                    said = f"refused: no assignment {place.name}: there are {known}"
                    rows.append(Row("", home.name, "", said))
                elif place.name in wanted:
                    todo.append((place.name, home.name, place))
    names = sorted({student for _, student, _ in todo})
    if unknown := ", ".join(sorted(set(students) - {*names, *(row.student for row in rows)})):
        raise SystemExit(f"no hand-in of {unknown}: there are those of {', '.join(names)}")
    if students:
        rows = [row for row in rows if row.student in students]
        todo = [each for each in todo if each[1] in students]
    return rows, todo, names


def _each(
    pool: Executor, bar: tqdm, stopped: Event, function: Callable, items: Iterable
) -> Iterator[tuple[Any, Any]]:
    """Each item as it is done, with what the function returned or the exception it raised."""
    waiting = {pool.submit(function, item): item for item in items}
    while waiting:
        done, left = wait(waiting, timeout=0.5, return_when=FIRST_COMPLETED)
        if stopped.is_set():
            pool.shutdown(wait=False, cancel_futures=True)
            while wait(left, timeout=0.5).not_done:
                end()
            raise KeyboardInterrupt
        for each in done:
            yield waiting.pop(each), each.exception() or each.result()
            bar.update()


if __name__ == "__main__":
    parser = options(__doc__)
    said = "at once; as many as there are processors by default"
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help=said)
    said = "most seconds of a cell, 60 by default; five times that for a hand-in"
    parser.add_argument("--seconds", type=float, default=60.0, help=said)
    said = "most gigabytes of memory of a hand-in, 4 by default"
    parser.add_argument("--memory", type=float, default=4.0, help=said)
    said = "only this student, by the name of the folder; can be given several times"
    parser.add_argument("--student", action="append", metavar="NAME", help=said)
    said = "also what has not changed since it was graded"
    parser.add_argument("--all", action="store_true", help=said)
    given = parser.parse_args()
    for name in "jobs", "seconds", "memory":
        if not getattr(given, name) > 0:
            parser.error(f"--{name} {getattr(given, name)} is not allowed: more than 0 is needed")
    if not holds():
        if next_user() is not None:
            parser.error("here hand-ins would run as root: install bubblewrap, or be another user")
        print("Hand-ins can read what you can read here: the lecturer's guide says more.")
    most = Limits(given.seconds, 5 * given.seconds, int(given.memory * 1e9))
    folder = given.course.resolve()
    try:
        rows = grade(folder, given.assignments, most, given.jobs, given.student or (), given.all)
    except ValueError as error:
        sys.exit(str(error))
    except KeyboardInterrupt as stop:
        print(stop or "Stopped: nothing is graded.")
        sys.exit(130)
    print(table(rows) if rows else nothing(folder, given.assignments))
