"""Make the zip that students get: python book/course/package.py

It holds the assignments that `nbgrader generate_assignment` has released, the chapters without
their solutions, the packages that both import, and how to install them.
"""

from __future__ import annotations

import argparse
import re
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile

import nbformat

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "book" / "tools"))
from build import without_solutions  # noqa: E402

FILES = (
    *("LICENSE", "environment.txt", "pyproject.toml"),
    "notebooks/robot_in_one_page.py",  # two chapters point to it
)
FOLDERS = ("book/lab",)
CLOSED = ROOT / "book" / "wmrbook" / "questions"  # it computes the keys of the concept questions
LINK = re.compile(r"\[([^\]]+)\]\(\.\./book/[^)]*\)")  # to pages that are not in the zip
START = """# From two GPS points to a parked robot

With Python 3.11 to 3.14, in this folder, on Linux or macOS, and on Windows:

{commands}

To start JupyterLab again later, run only the part after the last `&&`.
JupyterLab opens on the first chapter. The other chapters are beside it in `notebooks`, and the
exercises to hand in are in `assignments`: write your answers where the cells say so. The checks
below an answer say whether it is right, and give a hint if not. Hand in the notebook under its
own name.
"""


def write(course: Path, output: Path) -> None:
    """Write the zip, with the assignments that the course has released."""
    released = sorted(course.glob("release/*/*.ipynb"))
    if not released:
        sys.exit(f"{course / 'release'} is empty: run `nbgrader generate_assignment` first")
    with ZipFile(output, "w", ZIP_DEFLATED) as package:
        for name, content in _book():
            package.writestr(f"robot/{name}", content)
        for path in released:
            package.write(path, f"robot/assignments/{path.parent.name}/{path.name}")


def _book() -> Iterator[tuple[str, str | bytes]]:
    """Yield the name and the content of each file but the assignments."""
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    commands = re.findall(r"^    py.*jupyter lab .*$", readme, re.MULTILINE)
    yield "README.md", START.format(commands="\n\n".join(commands))
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    packages = project["tool"]["hatch"]["build"]["targets"]["wheel"]["packages"]
    for path in sorted(path for name in (*packages, *FOLDERS) for path in (ROOT / name).rglob("*")):
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
    parser = argparse.ArgumentParser(description=__doc__)
    here = Path(__file__).resolve().parent
    parser.add_argument("--course", type=Path, default=here, help="the folder of the course")
    given = parser.parse_args()
    write(given.course, given.course / "students.zip")
    print(given.course / "students.zip")
