"""Collect what students have written, and give back:

    python book/course/exchange.py unzip submissions.zip
    python book/course/exchange.py collect /home
    python book/course/exchange.py return /home

unzip takes what Moodle or Canvas downloads for an assignment, and students.csv in the folder of
the course to know who is who. collect takes from /home/NAME/robot/assignments, on a server. Both
put notebooks into submitted/NAME, with a timestamp.txt where the time is known. return puts the
pages of feedback/NAME into /home/NAME/robot/feedback. jupyterhub_config.py hands out, into
/home/NAME/robot. What is wrong with one student's files is said in a line and stops nobody else.
"""

from __future__ import annotations

import argparse
import json
import sys
from datetime import UTC, datetime
from pathlib import Path
from zipfile import ZipFile

import homes
import incoming
from cells import visible
from handins import MOST_BYTES, assignments
from homes import Unfit

COURSE = Path(__file__).resolve().parent
MOST_GIVEN = 1_000_000  # bytes of a notebook that is read here; a release has 20 kB
SLACK = 60  # s that a file may be younger than the time it bears


def hand_out(home: Path, package: Path) -> list[str]:
    """Unpack what students get; what is there stays, so that no answer is lost. Return troubles."""
    said = []
    with ZipFile(package) as files:
        for name in files.namelist():
            *parts, last = name.split("/")
            try:
                if {"", ".", ".."} & {*parts, last}:
                    raise Unfit("its name is none")
                with homes.folder(home, *parts, make=True) as place:
                    content = files.read(name)
                    if last.endswith(".ipynb") and "assignments" in parts:
                        content = named(content, home.name)
                    homes.write(place, last, content, replace=False)
            except (OSError, Unfit) as error:
                said.append(f"{name}: {error}")
    return said


def named(notebook: bytes, student: str) -> bytes:
    """Write the user name into a released notebook whose numbers are made from it."""
    return notebook.replace(b'name = \\"\\"', f'name = \\"{student}\\"'.encode())


def collect(students: Path, course: Path) -> tuple[list[Path], list[str]]:
    """Copy the newest notebook of each assignment; return the copies and what there is to say."""
    copies, said = [], []
    sources = assignments(course)
    for home in sorted(students.iterdir()):
        for assignment, source in sources.items():
            try:
                with homes.folder(home, "robot", "assignments", assignment) as place:
                    content, when, remarks = _newest(place, source.name)
                said += [f"{home.name}, {assignment}: {each}" for each in remarks]
                if content is not None and _begun(content, course, assignment, home.name):
                    to = course / "submitted" / home.name / assignment
                    copies.append(incoming.store(to, source.name, content, when))
            except FileNotFoundError:
                continue  # not begun
            except NotADirectoryError:
                break  # a file beside the homes
            except (OSError, Unfit) as error:
                said.append(f"{home.name}: not collected: {error}")
    return copies, list(dict.fromkeys(said))


def _begun(content: bytes, course: Path, assignment: str, student: str) -> bool:
    """Whether a notebook has a cell with anything that the student was not given."""
    if len(content) > MOST_GIVEN:
        return True
    try:
        (release,) = (course / "release" / assignment).glob("*.ipynb")
        given, now = (
            {"".join(cell["source"]) for cell in json.loads(text)["cells"]}
            for text in (named(release.read_bytes(), student), content)
        )
    except (OSError, ValueError, LookupError, TypeError, RecursionError):  # it is for the table
        return True
    return not now <= given | {""}


def _newest(place: homes.Place, release: str) -> tuple[bytes | None, datetime, list[str]]:
    """The notebook of a folder that was written last, its time, and what is odd about it."""
    said, best = [], None
    names = sorted(each for each in place.names() if each.endswith(".ipynb") and each[0] != ".")
    for name in names:
        try:
            with homes.opened(place, name) as (fd, about):
                rank = about.st_mtime_ns, name == release
                if best is None or rank > best[0]:
                    best = rank, name, homes.read(fd, name, MOST_BYTES), about
        except Unfit as error:
            said.append(f"not collected: {error}")
    if best is None:
        return None, datetime.now(UTC), said
    _, name, content, about = best
    if len(names) > 1:
        said.append(f"{len(names)} notebooks, {', '.join(names)}; {name} was taken")
    if about.st_ctime - about.st_mtime > SLACK and sys.platform != "win32":
        changed = datetime.fromtimestamp(about.st_ctime, UTC)
        said.append(f"{name} was changed or moved at {changed:%Y-%m-%d %H:%M} UTC, after its time")
    return content, datetime.fromtimestamp(about.st_mtime, UTC), said


def give_back(students: Path, feedback: Path) -> tuple[list[Path], list[str]]:
    """Copy the pages to the students; return the copies and what there is to say."""
    copies, said = [], []
    for path in sorted(feedback.glob("*/*/*.html")):
        name, assignment, _ = path.relative_to(feedback).parts
        try:
            with homes.folder(students / name, "robot", "feedback", assignment, make=True) as place:
                homes.write(place, path.name, path.read_bytes())
            copies.append(students / name / "robot" / "feedback" / assignment / path.name)
        except FileNotFoundError:
            said.append(f"{name}, {assignment}: not returned: {students / name} is no home")
        except (OSError, Unfit) as error:
            said.append(f"{name}, {assignment}: not returned: {error}")
    return copies, said


if __name__ == "__main__":
    form = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=form)
    parser.add_argument("what", choices=("unzip", "collect", "return"))
    said = "the zip, or the folder with a home for each student"
    parser.add_argument("place", type=Path, help=said)
    parser.add_argument("--course", type=Path, default=COURSE, help="the folder of the course")
    said = "the assignment that is in the zip; by default each notebook says which it is"
    parser.add_argument("--assignment", help=said)
    given = parser.parse_args()
    try:
        if given.what == "unzip":
            done, said = incoming.unzip(given.place, given.course, given.assignment)
        elif given.what == "collect":
            done, said = collect(given.place, given.course)
        else:
            done, said = give_back(given.place, given.course / "feedback")
    except (OSError, ValueError) as error:
        sys.exit(visible(str(error)))
    print(*(visible(" ".join(each.split())) for each in said), f"{len(done)} files", sep="\n")
