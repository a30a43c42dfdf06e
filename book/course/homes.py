"""Files in a student's home, where the student may exchange anything for anything at any time.

No link in a home is followed: each folder is opened from the descriptor of the one around it, and
a file is looked at and copied through its own descriptor. Windows has no such descriptors; there
a path is looked at before it is used.
"""

from __future__ import annotations

import os
import secrets
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import NamedTuple

SAFE = os.open in os.supports_dir_fd and os.listdir in os.supports_fd
LOOK = getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_CLOEXEC", 0)
LOOK |= getattr(os, "O_BINARY", 0)
FOLDER = LOOK | getattr(os, "O_DIRECTORY", 0)
MOST_NAMES = 1000  # files in a folder of a student


class Unfit(Exception):  # noqa: N818  (it is an answer, not a fault)
    """Why a file or a folder of a home can't be used."""


class Place(NamedTuple):
    """A folder of a home: its descriptor, or, on Windows, its path."""

    fd: int | None
    path: str
    owner: tuple[int, int]

    def at(self, name: str) -> tuple[str, int | None]:
        """What `os` takes for a file in it: a name, and what the name is relative to."""
        path = name if SAFE else os.path.join(self.path, name)
        if not SAFE and (os.path.islink(path) or os.path.realpath(path) != path):
            raise Unfit(f"{name} is a link")
        return path, self.fd

    def names(self) -> list[str]:
        """The names in it; raises Unfit where there are too many."""
        found = []
        with os.scandir(self.fd if SAFE else self.path) as entries:
            for entry in entries:
                if len(found) == MOST_NAMES:
                    raise Unfit(f"{Path(self.path).name} has more than {MOST_NAMES} files")
                found.append(entry.name)
        return found

    def give(self, fd: int) -> None:
        """Make the owner of the home the owner of a file."""
        if SAFE and os.geteuid() == 0:
            os.fchown(fd, *self.owner)


@contextmanager
def folder(home: Path, *parts: str, make: bool = False) -> Iterator[Place]:
    """Open a folder of a home, and make it if it is to be; raises Unfit or FileNotFoundError."""
    home = Path(os.path.realpath(home))  # the home itself may be a link: its student made none
    about = home.stat()
    owner = about.st_uid, about.st_gid
    place = Place(os.open(home, FOLDER) if SAFE else None, str(home), owner)
    try:
        for part in parts:
            made = False
            if make:
                with suppress(FileExistsError):
                    name, at = place.at(part)
                    os.mkdir(name, 0o755, dir_fd=at)
                    made = True
            inner = place._replace(path=os.path.join(place.path, part))
            if SAFE:
                try:
                    inner = inner._replace(fd=os.open(part, FOLDER, dir_fd=place.fd))
                except FileNotFoundError:
                    raise
                except OSError as error:
                    raise Unfit(f"{part} is no folder: {error.strerror}") from None
                os.close(place.fd)
            elif not os.path.isdir(place.at(part)[0]):
                kind = Unfit if os.path.lexists(inner.path) else FileNotFoundError
                raise kind(f"{part} is no folder")
            place = inner
            # Between the two steps another folder may have come in the place of the new one.
            if made and SAFE and os.fstat(place.fd).st_uid == os.geteuid() and not place.names():
                place.give(place.fd)
        yield place
    finally:
        if SAFE:
            os.close(place.fd)


@contextmanager
def opened(place: Place, name: str) -> Iterator[tuple[int, os.stat_result]]:
    """Open a file to read, which waits for nobody; raises Unfit if it is anything else."""
    path, at = place.at(name)
    try:
        fd = os.open(path, os.O_RDONLY | LOOK, dir_fd=at)
    except OSError as error:
        raise Unfit(f"{name} can't be read: {error.strerror}") from None
    try:
        about = os.fstat(fd)
        if not stat.S_ISREG(about.st_mode):
            raise Unfit(f"{name} is not a file")
        if about.st_nlink > 1 and SAFE and about.st_uid != place.owner[0]:
            raise Unfit(f"{name} is a file of somebody else's")
        yield fd, about
    finally:
        os.close(fd)


def read(fd: int, name: str, most: int) -> bytes:
    """The content of an open file, of which no more than that many bytes are read."""
    parts, left = [], most + 1 if os.fstat(fd).st_size <= most else 0
    while left > 0 and (part := os.read(fd, min(left, 1 << 20))):
        parts.append(part)
        left -= len(part)
    if left <= 0:
        raise Unfit(f"{name} has more than {most // 1_000_000} MB; clear its outputs")
    return b"".join(parts)


def write(place: Place, name: str, content: bytes, replace: bool = True) -> bool:
    """Write a file whole, in the place of what has its name unless that is to stay.

    A new file is made, which nobody else has open, and then gets the name. Return whether it did.
    """
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | LOOK
    target, at = place.at(name)
    aside, _ = place.at(f".{secrets.token_hex(8)}.new") if replace else (target, at)
    try:
        fd = os.open(aside, flags, 0o644, dir_fd=at)
    except FileExistsError:
        return False
    try:
        with os.fdopen(fd, "wb") as file:
            place.give(fd)
            file.write(content)
        if replace:
            os.replace(aside, target, src_dir_fd=at, dst_dir_fd=at)
    except BaseException:
        with suppress(OSError):
            os.unlink(aside, dir_fd=at)
        raise
    return True
