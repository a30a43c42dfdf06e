"""Make what students get: python book/course/package.py [ASSIGNMENT ...]

It writes students.zip: the released assignments, the chapters without the solutions of their
exercises, the packages that both import, and how to install them and hand in. Where students.csv
has the class, students/NAME.zip has each student's assignments, with the user name in them.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile

import nbformat
import roster
from exchange import named
from gradebook import COURSE, Course, options

ROOT = COURSE.parents[1]
sys.path.append(str(ROOT / "book" / "tools"))
from build import without_solutions  # noqa: E402

FOLDERS = "wmrlib", "book/wmrbook", "book/lab", "notebooks/data"
CLOSED = ROOT / "book" / "wmrbook" / "questions"  # it computes the keys of the pre- and post-test
FILES = "LICENSE", "environment.txt", "pyproject.toml"
LINK = re.compile(r"\[([^\]]+)\]\(\.\./book/[^)]*\)")  # to pages that are not in the package
START = """# From two GPS points to a parked robot

With Python 3.11 to 3.14, in this folder, on Linux or macOS, and on Windows:

{commands}

From its last `&&` on a command brings you back, without a network.
JupyterLab opens on the first chapter; the others are beside it in `notebooks`, and the exercises
to hand in are in `assignments`: write your answers where the cells say so. The checks below an
answer say whether it is right, and give a hint if not. Hand in the notebook under its own name.
"""


def main(folder: Path, wanted: list[str], output: Path) -> None:
    """Write the package with these assignments, or all, and a small one for each student."""
    with Course(folder) as course:
        released = {
            f"assignments/{each}/{course.sources[each].name}": nbformat.writes(course.release(each))
            for each in course.checked(wanted) or course.sources
        }
    _write(output, {**released, **dict(_book())})
    for student in roster.of(folder):
        own = {k: named(it.encode(), student.username) for k, it in released.items()}
        _write(folder / "students" / f"{student.username}.zip", own)
    print(output)


def _write(path: Path, files: dict[str, str | bytes]) -> None:
    path.parent.mkdir(exist_ok=True)
    with ZipFile(path, "w", ZIP_DEFLATED) as package:
        for name, text in files.items():
            package.writestr(f"robot/{name}", text)


def _book() -> Iterator[tuple[str, str | bytes]]:
    """The name and the content of each file but the assignments."""
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    commands = re.findall(r"^    py.*jupyter lab .*$", readme, re.MULTILINE)
    yield "README.md", START.format(commands="\n\n".join(commands))
    for path in sorted(each for folder in FOLDERS for each in (ROOT / folder).rglob("*")):
        parts = path.relative_to(ROOT).parts
        hidden = any(part.startswith((".", "__pycache__")) for part in parts)
        if path.is_file() and not hidden and CLOSED not in path.parents:
            yield "/".join(parts), path.read_bytes()
    for name in FILES:
        yield name, (ROOT / name).read_bytes()
    for path in sorted((ROOT / "notebooks").glob("*.ipynb")):
        chapter = without_solutions(nbformat.read(path, as_version=4))
        for cell in chapter.cells:
            cell.source = LINK.sub(r"\1", cell.source)
        yield f"notebooks/{path.name}", nbformat.writes(chapter)


if __name__ == "__main__":
    parser = options(__doc__)
    said = "the file; students.zip in the folder of the course by default"
    parser.add_argument("--output", type=Path, help=said)
    given = parser.parse_args()
    folder = given.course.resolve()
    main(folder, given.assignments, given.output or folder / "students.zip")
