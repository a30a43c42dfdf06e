"""What comes in as a zip: all that a class has handed in, as Moodle and Canvas download it.

Moodle names a folder, or the begin of a file's name, `Ada Lovelace_123456_assignsubmission_file_`,
behind the name of a group and a hyphen if there are groups; Canvas names a file
`lovelaceada_LATE_12345_67890_NOTEBOOK`, by the letters of "Lovelace, Ada", by the number of the
user there and that of the upload. Who that is says the roster.
"""

from __future__ import annotations

import re
import stat
from collections import Counter, defaultdict
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from functools import cache
from pathlib import Path
from typing import NamedTuple
from unicodedata import normalize
from zipfile import BadZipFile, ZipFile, ZipInfo

import roster
from cells import visible
from handins import MOST_BYTES, assignments, write
from roster import Student

MOODLE = re.compile(r"(?P<name>[^_/]+)_\d+_assignsubmission_[a-z]+(?:_/|_|/)(?P<file>.+)")
CANVAS = re.compile(r"(?P<name>[^/]+?)(?P<late>_LATE)?_(?P<id>\d+)_(?P<upload>\d+)_(?P<file>[^/]+)")
GRADE_ID = re.compile(rb'"grade_id"\s*:\s*"([\w-]{1,99})"')
MOST_FILES = 10_000
MOST_IN_ALL = 2_000_000_000  # bytes
APART = timedelta(minutes=10)  # times of files that differ by less are those of the download


class File(NamedTuple):
    """A notebook of the zip, and how new it is: its time, or what numbers it."""

    assignment: str
    name: str
    content: bytes
    when: datetime | None
    rank: tuple
    late: bool


def store(folder: Path, name: str, content: bytes, when: datetime | None) -> Path:
    """Write a notebook into the folder of a hand-in under its own name, and its time."""
    stamp, place = folder / "timestamp.txt", folder / name
    if place.exists() and place.read_bytes() == content and not when:
        return place  # it has come before, perhaps with its time
    stamp.unlink(missing_ok=True)  # of an earlier one
    write(place, content)
    if when:
        write(stamp, f"{when.astimezone(UTC):%Y-%m-%d %H:%M:%S} UTC\n")
    return place


def unzip(path: Path, course: Path, assignment: str | None = None) -> tuple[list[Path], list[str]]:
    """Store the notebooks of a zip; return them, and what there is to say.

    Raises ValueError where nothing can be read: no roster, no zip, no such assignment.
    """
    known = assignments(course)
    if assignment and assignment not in known:
        raise ValueError(f"--assignment {assignment}: there are {', '.join(known)}")
    people = roster.of(course)
    if not people:
        columns = "username,name,email,id,group"
        raise ValueError(f"{course / roster.FILE} is needed to know who is who: a CSV, {columns}")
    said: list[str] = []
    found, others, strangers = defaultdict(list), defaultdict(list), defaultdict(list)
    try:
        with ZipFile(path) as package:
            for info, name in _sound(package, said):
                match = MOODLE.fullmatch(name) or CANVAS.fullmatch(name)
                if not match:
                    said.append(f"{name}: neither Moodle nor Canvas names a file so")
                    continue
                who = _who(match, people)
                if isinstance(who, str):
                    strangers[match["name"], who].append(name)
                    continue
                if not name.endswith(".ipynb"):
                    others[who].append(match["file"])
                    continue
                try:
                    content = _content(package, info)
                    key = assignment or _assignment(match["file"], content, course)
                    found[who].append(_file(info, match, key, content))
                except Exception as error:  # zlib's, and whatever a broken zip raises
                    said.append(f"{who.username}: {match['file']}: {error}")
                    found[who] += []
    except (BadZipFile, OSError) as error:
        raise ValueError(f"{path}: {error}") from None
    for (name, why), files in strangers.items():
        said.append(f"{name} ({len(files)} files): {why}")
    nothing = {who.username: names for who, names in others.items() if who not in found}
    said += [f"{who}: no notebook, but {', '.join(names)}" for who, names in nothing.items()]
    return _stored(course, known, found, said), said


def _stored(
    course: Path, known: dict[str, Path], found: dict[Student, list[File]], said: list[str]
) -> list[Path]:
    """Write what was found, of each assignment the newest."""
    times = [each.when for files in found.values() for each in files if each.when]
    timed = bool(times) and max(times) - min(times) >= APART
    if times and not timed:
        said.append("the zip has no times but that of its making: lateness is not known")
    copies = []
    for who, files in found.items():
        for assignment in sorted({each.assignment for each in files}):
            every = sorted((e for e in files if e.assignment == assignment), key=lambda e: e.rank)
            newest, where = every[-1], f"{who.username}, {assignment}"
            if len(every) > 1:
                names = ", ".join(each.name for each in every)
                said.append(f"{where}: {len(every)} notebooks, {names}; {newest.name} was taken")
            if newest.late:
                said.append(f"{where}: Canvas says that it is late")
            folder = course / "submitted" / who.username / assignment
            when = newest.when if timed else None
            copies.append(store(folder, known[assignment].name, newest.content, when))
    return copies


def _sound(package: ZipFile, said: list[str]) -> Iterator[tuple[ZipInfo, str]]:
    """The files of a zip and their names; what is refused is said by its name."""
    infos = [each for each in package.infolist() if not each.is_dir()]
    if len(infos) > MOST_FILES or sum(each.file_size for each in infos) > MOST_IN_ALL:
        most = f"{MOST_FILES} files and {MOST_IN_ALL // 10**9} GB"
        raise BadZipFile(f"it has {len(infos)} files; {most} at most are read")
    names = [_name(each) for each in infos]
    count = Counter(names)
    for info, name in zip(infos, names, strict=True):
        parts = re.split(r"[/\\]", name or "")
        kind = stat.S_IFMT(info.external_attr >> 16)
        if name is None:
            why = "its name is in an encoding that the zip does not tell"
        elif ".." in parts or name[:1] in "/\\" or "\\" in name or re.match("[A-Za-z]:", name):
            why = "its name leads out of the zip"
        elif visible(name) != name or "\n" in name:
            why = "its name has letters that are not to be seen"
        elif kind not in (0, stat.S_IFREG):
            why = "it is a link or the like"
        elif count[name] > 1:
            why = "the zip has several files of this name"
        elif info.flag_bits & 1:
            why = "it is encrypted"
        elif info.file_size > MOST_BYTES:
            why = f"it has more than {MOST_BYTES // 10**6} MB"
        else:
            yield info, name
            continue
        said.append(f"{name or info.filename}: refused: {why}")


def _name(info: ZipInfo) -> str | None:
    """The name of a file in a zip, or None if its encoding is not known."""
    name = info.orig_filename
    if not info.flag_bits & 0x800 and not name.isascii():  # by rule it is that of the first PCs
        try:
            name = name.encode("cp437").decode("utf-8")
        except UnicodeError:
            return None
    return normalize("NFC", name)


def _who(match: re.Match, people: list[Student]) -> Student | str:
    """Whose file it is, or what to do to know it."""
    if match.re is CANVAS:
        found = roster.by_canvas(people, match["name"], match["id"])
        more = f" or the id {match['id']}"
    else:
        found, more = roster.by_moodle(people, match["name"]), ""
    if len(found) == 1:
        return found[0]
    if found:
        names = ", ".join(each.username for each in found)
        return f"not stored: it may be {names}; put it into submitted/USERNAME/ASSIGNMENT by hand"
    return f"not stored: nobody in {roster.FILE} has this name{more}; write it there"


def _content(package: ZipFile, info: ZipInfo) -> bytes:
    """A file of the zip, of which no more is unpacked than a notebook may have."""
    with package.open(info) as file:
        content = file.read(MOST_BYTES + 1)
    if len(content) > MOST_BYTES:
        raise ValueError(f"refused: it has more than {MOST_BYTES // 10**6} MB")
    if not content.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"{"):
        raise ValueError("refused: it is empty or no notebook, and would replace an earlier one")
    return content


def _file(info: ZipInfo, match: re.Match, assignment: str, content: bytes) -> File:
    """A notebook that was read. Canvas writes into a zip no time but its own, and numbers each."""
    name = Path(match["file"]).name
    if match.re is CANVAS:
        return File(assignment, name, content, None, (int(match["upload"]),), bool(match["late"]))
    return File(assignment, name, content, _when(info), (info.date_time, name), False)


def _assignment(name: str, content: bytes, course: Path) -> str:
    """Which assignment a notebook is of, by the ids of its cells, or else by its name."""
    ids = {*GRADE_ID.findall(content)}
    alike = {path: len(ids & known) for path, known in _ids(course).items()}
    most = max([*alike.values(), len(ids) // 2 + 1])
    best = [path for path, count in alike.items() if count == most]
    stem = re.sub(r"( ?\(\d+\)|-\d+| - Copy)+$", "", Path(name).stem)
    best = best if len(best) == 1 else [path for path in alike if path.stem == stem]
    if len(best) != 1:
        raise ValueError("not stored: of which assignment is it? say it by --assignment")
    return best[0].parent.name


@cache
def _ids(course: Path) -> dict[Path, set[bytes]]:
    """The ids of the cells of each assignment."""
    paths = assignments(course).values()
    return {path: {*GRADE_ID.findall(path.read_bytes())} for path in paths}


def _when(info: ZipInfo) -> datetime | None:
    """The time of a file: in UTC where the zip has it so, else as this machine's clocks go."""
    extra = info.extra
    while len(extra) >= 4:
        kind, size = extra[:2], int.from_bytes(extra[2:4], "little")
        if kind == b"UT" and size >= 5 and extra[4] & 1:
            return datetime.fromtimestamp(int.from_bytes(extra[5:9], "little", signed=True), UTC)
        extra = extra[4 + size :]
    try:
        when = datetime(*info.date_time).astimezone(UTC)
    except ValueError:
        return None
    return when if when.year > 1980 else None
