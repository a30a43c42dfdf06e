"""Who is in the class: students.csv in the course's folder, a line for each student."""

from __future__ import annotations

import csv
import re
from pathlib import Path
from typing import NamedTuple
from unicodedata import normalize

FILE = "students.csv"
NAME = re.compile(r"\w([\w.@ -]*[\w.@-])?")  # what paths, nbgrader and tables bear


class Student(NamedTuple):
    """A student: the user name that Moodle or Canvas knows, and what else is known."""

    username: str
    name: str = ""
    email: str = ""
    id: str = ""
    group: str = ""


def read(path: Path) -> list[Student]:
    """Read a roster: a CSV whose first line names its columns, `username` and any of the others.

    Raises ValueError with the file, the line and what is allowed.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(f"{path}: {error}; save it as CSV UTF-8") from None
    first = text.partition("\n")[0]
    reader = csv.reader(text.splitlines(), delimiter=max(",;\t", key=first.count), strict=True)
    try:
        lines = [(reader.line_num, line) for line in reader if any(line)]
    except csv.Error as error:
        raise ValueError(f"{path}: {error}") from None
    columns = [each.strip().casefold() for _, line in lines[:1] for each in line]
    if columns.count("username") != 1:
        wanted = f"username is needed of {', '.join(Student._fields)}"
        raise ValueError(f"{path}: the columns are {first.strip()!r}; {wanted}")
    students: dict[str, Student] = {}
    for number, line in lines[1:]:
        named = dict(zip(columns, map(str.strip, line), strict=False))
        one = Student(**{key: named.get(key, "") for key in Student._fields})
        where = f"{path}, line {number}: the user name {one.username!r}"
        if not NAME.fullmatch(normalize("NFC", one.username)):
            raise ValueError(f"{where}; letters, digits, blanks and _.@- are allowed")
        key = normalize("NFC", one.username).casefold()
        if key in students:
            raise ValueError(f"{where} stands there twice")
        students[key] = one
    if not students:
        raise ValueError(f"{path}: no student in it")
    return list(students.values())


def of(course: Path) -> list[Student]:
    """The roster of a course, or nothing if it has none."""
    path = course / FILE
    return read(path) if path.exists() else []


def by_moodle(people: list[Student], name: str) -> list[Student]:
    """Who Moodle calls by a name, before which their group and a hyphen may stand."""
    groups = {each.group for each in people}
    keys = {_words(name), *(_words(name.removeprefix(f"{group}-")) for group in groups)}
    return [each for each in people if {_words(each.name), _words(each.username)} & (keys - {()})]


def by_canvas(people: list[Student], name: str, number: str) -> list[Student]:
    """Whom Canvas calls by the letters of a name, the family's first, and by a number."""
    if found := [each for each in people if each.id == number]:
        return found
    key = "".join(_words(name))
    return [each for each in people if key in {*_turned(each.name), *_turned(each.username)}]


def _words(name: str) -> tuple[str, ...]:
    """The words of a name, in whatever order it has them."""
    return tuple(sorted(re.findall(r"\w+", normalize("NFKC", name).casefold())))


def _turned(name: str) -> set[str]:
    """The letters of a name, from each of its words on: any may begin the name of the family."""
    words = re.findall(r"\w+", normalize("NFKC", name).casefold())
    return {"".join(words[k:] + words[:k]) for k in range(len(words))}
