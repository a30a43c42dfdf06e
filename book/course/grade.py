"""Grade what the class has handed in: python book/course/grade.py [ASSIGNMENT ...]

It reads submitted/NAME/ASSIGNMENT/NOTEBOOK, repairs what can be repaired, runs each hand-in in
a process of its own, and ends with a table: graded, repaired and how, refused and why. Points
are then in gradebook.db, for nbgrader's other commands, and in marks-moodle.csv and
marks-canvas.csv; what students read is in feedback/NAME/ASSIGNMENT. The model's answers run
first: an assignment in which they lose points on this machine is not graded.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor, ThreadPoolExecutor, as_completed
from pathlib import Path
from typing import Any, NamedTuple
from unicodedata import normalize

import handins
import marks
from gradebook import COURSE, Course, lost, options
from handins import Refused
from sandbox import Limits, Sandbox, hides, stops
from tqdm import tqdm

SECRETS = COURSE, COURSE.parents[1] / "tests", COURSE.parents[1] / ".git"
NAME = re.compile(r"\w([\w.@ -]*[\w.@-])?")  # what paths, nbgrader and tables bear


class Row(NamedTuple):
    """A line of the table; points is empty where nothing was graded."""

    assignment: str
    student: str
    points: str
    said: str


def grade(folder: Path, wanted: list[str], limits: Limits, jobs: int) -> list[Row]:
    """Grade the hand-ins of these assignments, or of all; return the table."""
    with Course(folder) as course, Sandbox([folder, *SECRETS], limits) as sandbox:
        rows, todo = _listed(course, wanted)
        names = sorted({student for _, student, _ in todo})
        assignments = sorted({assignment for assignment, _, _ in todo})
        releases, unfit = {}, {}
        for each in assignments:
            try:
                releases[each] = course.release(each)
            except Refused as error:  # a task was changed that has been handed in
                unfit[each] = str(error)

        def run_model(assignment: str) -> list[str]:
            return lost(sandbox.run(course.solved(assignment), "model", [], trusted=True))

        def run(hand_in: tuple[str, str, Path]) -> tuple:
            assignment, student, place = hand_in
            if assignment in unfit:
                raise Refused(unfit[assignment])
            path, odd = handins.find(place, course.sources[assignment].name)
            notebook, how = handins.repaired(handins.read(path), releases[assignment])
            return sandbox.run(notebook, student, names), odd + how

        bar = tqdm(total=len(releases) + len(todo), unit="run", disable=None)
        with bar, ThreadPoolExecutor(jobs) as pool:
            for each, why in _each(pool, bar, run_model, releases):
                if why:
                    unfit[each] = f"on this machine the model fails: {why}"
            for (assignment, student, place), result in _each(pool, bar, run, todo):
                try:
                    if isinstance(result, Exception):
                        raise result
                    ran, how = result
                    points = course.score(assignment, student, ran, place)
                    course.give_back(assignment, student)
                    repairs = [f"repaired: {', '.join(how)}"] * bool(how)
                    said = "; ".join(repairs + handins.misnamed(ran, student) + stops(ran))
                except Exception as error:  # whatever it is, it stops nobody else
                    kind = "" if isinstance(error, Refused) else f"{type(error).__name__}: "
                    points, said = "", f"refused: {kind}{error}"
                rows.append(Row(assignment, student, points, " ".join(said.split())))
        with course.api.gradebook as book:
            marks.write(book, folder)
    return sorted(rows)


def _listed(course: Course, wanted: list[str]) -> tuple[list[Row], list[tuple]]:
    """What is refused by its name, and what is to be graded: assignment, student, folder."""
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
    return rows, todo


def _each(
    pool: Executor, bar: tqdm, function: Callable, items: Iterable
) -> Iterator[tuple[Any, Any]]:
    """Each item as it is done, with what the function returned or the exception it raised."""
    waiting = {pool.submit(function, item): item for item in items}
    for done in as_completed(waiting):
        yield waiting[done], done.exception() or done.result()
        bar.update()


def nothing(folder: Path, wanted: list[str]) -> str:
    """Say where the hand-ins of these assignments, or of all, are looked for."""
    first, *_ = sorted((folder / "source").glob(f"{wanted[0] if wanted else '*'}/*.ipynb"))
    place = folder / "submitted" / "NAME" / first.relative_to(folder / "source")
    return f"No hand-ins{' of ' * bool(wanted)}{', '.join(wanted)}. A student's goes to {place}"


def table(rows: list[Row]) -> str:
    """One line a hand-in, and a count."""
    graded = [row for row in rows if row.points]
    repairs = sum("repaired:" in row.said for row in graded)
    lines = [Row("", "student", "points", ""), *rows]
    wide = [max(len(row[k]) for row in lines) for k in range(3)]
    text = [
        f"{a:<{wide[0]}}  {s:<{wide[1]}}  {p:>{wide[2]}}  {said}".rstrip()
        for a, s, p, said in lines
    ]
    count = f"{len(graded)} graded, {repairs} of them repaired; {len(rows) - len(graded)} refused"
    return "\n".join([*text, count])


if __name__ == "__main__":
    parser = options(__doc__)
    said = "at once; as many as there are processors by default"
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help=said)
    said = "most seconds of a cell, 60 by default; five times that for a hand-in"
    parser.add_argument("--seconds", type=float, default=60.0, help=said)
    said = "most gigabytes of memory of a hand-in, 4 by default"
    parser.add_argument("--memory", type=float, default=4.0, help=said)
    given = parser.parse_args()
    for name in "jobs", "seconds", "memory":
        if not getattr(given, name) > 0:
            parser.error(f"--{name} {getattr(given, name)} is not allowed: more than 0 is needed")
    if not hides():
        print("Hand-ins can read what you can read here: the lecturer's guide says more.")
    if not (COURSE.parent / "node_modules" / "mathjax").exists():
        print("Feedback shows formulas as TeX: book/tools/build.py fetches what draws them.")
    most = Limits(given.seconds, 5 * given.seconds, int(given.memory * 1e9))
    folder = given.course.resolve()
    rows = grade(folder, given.assignments, most, given.jobs)
    print(table(rows) if rows else nothing(folder, given.assignments))
