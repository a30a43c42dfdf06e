"""Collect from the students' homes on a server, and give back:

    python book/course/exchange.py collect /home
    python book/course/exchange.py return /home

The notebooks of /home/NAME/robot/assignments go to submitted/NAME; the pages of feedback/NAME go
to /home/NAME/robot/feedback. jupyterhub_config.py hands out, into /home/NAME/robot.
"""

from __future__ import annotations

import argparse
import os
import shutil
from pathlib import Path
from zipfile import ZipFile

COURSE = Path(__file__).resolve().parent


def hand_out(home: Path, package: Path) -> None:
    """Unpack what students get; what is there stays, so that no answer is lost."""
    with ZipFile(package) as files:
        for name in files.namelist():
            if _inside(home, home / name) and not (home / name).exists():
                path = Path(files.extract(name, home))
                if name.startswith("robot/assignments/"):
                    path.write_bytes(named(path.read_bytes(), home.name))
                _own(home, path)


def named(notebook: bytes, student: str) -> bytes:
    """Write the user name into a released notebook whose numbers are made from it."""
    return notebook.replace(b'name = \\"\\"', f'name = \\"{student}\\"'.encode())


def collect(homes: Path, submitted: Path) -> list[Path]:
    """Copy what students have written; return the copies."""
    copies = []
    for path in sorted(homes.glob("*/robot/assignments/*/*.ipynb")):
        name, _, _, assignment, _ = path.relative_to(homes).parts
        if _inside(homes / name, path):
            copies.append(submitted / name / assignment / path.name)
            copies[-1].parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, copies[-1])
    return copies


def give_back(homes: Path, feedback: Path) -> list[Path]:
    """Copy the pages to the students; return the copies."""
    copies = []
    for path in sorted(feedback.glob("*/*/*.html")):
        name, assignment, _ = path.relative_to(feedback).parts
        copy = homes / name / "robot" / "feedback" / assignment / path.name
        if (homes / name).is_dir() and _inside(homes / name, copy):
            copy.parent.mkdir(parents=True, exist_ok=True)
            _own(homes / name, Path(shutil.copyfile(path, copy)))
            copies.append(copy)
    return copies


def _inside(home: Path, path: Path) -> bool:
    """Whether a path in a home does not lead out of it, by a link."""
    return path.resolve().is_relative_to(home.resolve())


def _own(home: Path, path: Path) -> None:
    """Give a file, and the folders that it is in, to the owner of the home."""
    if os.name == "posix" and os.geteuid() == 0:
        owner = home.stat()
        for each in (path, *path.parents):
            if each == home:
                break
            os.chown(each, owner.st_uid, owner.st_gid, follow_symlinks=False)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("what", choices=("collect", "return"))
    parser.add_argument("homes", type=Path, help="the folder with a home for each student")
    parser.add_argument("--course", type=Path, default=COURSE, help="the folder of the course")
    given = parser.parse_args()
    if given.what == "collect":
        done = collect(given.homes, given.course / "submitted")
    else:
        done = give_back(given.homes, given.course / "feedback")
    print(f"{len(done)} files")
