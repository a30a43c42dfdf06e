"""Who has the best gains: the line that a student hands in for the tuning challenge, and a text file of such lines for a class.

A line names who, the seed, the gains and the score, in ASCII, and ends in a checksum, the first ten hexadecimal digits of the SHA-256 of
what stands before it. The checksum finds a character that was lost or mistyped on the way. It is no signature: whoever can run this
module can make a line in any name. What can't be made up is the score, which is computed again from the gains wherever it is read.
"""

from __future__ import annotations

import datetime
import errno
import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from wmrbook.challenge import SEED, from_seed
from wmrbook.challenge.certificate import JOINERS, Entry, Verdict, certificate, verify
from wmrlib.gains import Gains

__all__ = [
    "Entry",
    "Ranked",
    "Ranking",
    "Refused",
    "Scoreboard",
    "Verdict",
    "certificate",
    "verify",
]

_JOINERS = dict.fromkeys(map(ord, JOINERS))
_UTF_16 = (
    b"\xff\xfe",
    b"\xfe\xff",
)  # how such a file begins: some editors and PowerShell's > make one


class Ranked(NamedTuple):
    """A place in the ranking: rank, from 1, shared by equal points; Entry, the best of its name; tries: how many lines that name has."""

    rank: int
    entry: Entry
    tries: int


class Refused(NamedTuple):
    """A line that is not ranked: its number in the file, from 1, its text, and why."""

    line: int
    text: str
    reason: str


@dataclass(frozen=True, slots=True, repr=False)
class Ranking:
    """A scoreboard as it was read: entries, a tuple of Ranked, the best first; refused, a tuple of Refused; others: how many lines are
    true and of another seed; seed.
    """

    entries: tuple[Ranked, ...]
    refused: tuple[Refused, ...]
    others: int
    seed: int

    def __repr__(self) -> str:
        names, lines = _counted(self.entries, "name"), _counted(self.refused, "line")
        told = f"{names} ranked, {lines} refused, {self.others} of other seeds"
        rows = [f"<Ranking: seed {self.seed}; {told}>"]
        if self.entries:
            rows.append(
                f"{'rank':>4}{'points':>9}{'tries':>7}   {'k_rho, k_alpha, h, v_max':<30}name"
            )
        for rank, entry, tries in self.entries:
            rows.append(
                f"{rank:>4}{entry.points:>9.2f}{tries:>7}   {', '.join(f'{gain:g}' for gain in entry.gains):<30}{entry.name}"
            )
        rows += [f"line {line} is not ranked: {reason}" for line, _, reason in self.refused]
        return "\n".join(rows)


class Scoreboard:
    """A text file of handed-in lines, one a line, and its ranking.

    path: of the file, which need not exist yet. Lines that are empty or begin with # are let alone, so that the file can be edited by
    hand; two boards are merged by joining their files. Lines are only ever added at the end, each by a single write under a lock of the
    operating system: what stands in the file, damaged or not, stays, and of two who write at once both are there.
    """

    def __init__(self, path: str | os.PathLike) -> None:
        self.path = Path(path)

    def __repr__(self) -> str:
        return f"<Scoreboard: {str(self.path)!r}>"

    def add(
        self, name: str, gains: Gains, seed: int = SEED, date: datetime.date | None = None
    ) -> str:
        """Add a try, and return its line.

        Raises ValueError as `certificate` and for a file in UTF-16, and OSError if the line can't be written, or only a part of it.
        """
        line = certificate(name, gains, seed, date)
        self._append(line)
        return line

    def add_line(self, line: str) -> Verdict:
        """Add a line that was handed in, if it is true; the Verdict says whether it is.

        Raises ValueError for another type and for a file in UTF-16, and OSError if the line can't be written, or only a part of it.
        """
        verdict = verify(line)
        if verdict:
            self._append(line.strip())
        return verdict

    def ranking(self, seed: int = SEED) -> Ranking:
        """Read the file and compute all scores again: the best try of each name, by points; a file that is not there has none.

        Names that differ only in upper and lower case, or in joiners, which are not seen, are one. Raises ValueError as
        `challenge.from_seed`, and OSError if the file can't be read.
        """
        seed, best, tries, refused, others = from_seed(seed).seed, {}, {}, [], 0
        for number, text in self._lines():
            verdict = verify(text)
            if not verdict:
                refused.append(Refused(number, text, verdict.reason))
            elif verdict.entry.seed != seed:
                others += 1
            else:
                key = verdict.entry.name.casefold().translate(_JOINERS)
                tries[key] = tries.get(key, 0) + 1
                if key not in best or verdict.entry.points < best[key].points:
                    best[key] = verdict.entry
        points = sorted(entry.points for entry in best.values())
        ordered = sorted(best, key=lambda key: (best[key].points, key))
        entries = tuple(
            Ranked(1 + points.index(best[key].points), best[key], tries[key]) for key in ordered
        )
        return Ranking(entries, tuple(refused), others, seed)

    def _lines(self) -> Iterator[tuple[int, str]]:
        content = self.path.read_bytes() if self.path.exists() else b""
        text = content.decode("utf-16" if content[:2] in _UTF_16 else "utf-8", "backslashreplace")
        for number, line in enumerate(text.split("\n"), start=1):
            stripped = line.strip().strip("\ufeff")  # the mark of UTF-8, where files were joined
            if stripped and not stripped.startswith("#"):
                yield number, stripped

    def _append(self, line: str) -> None:
        descriptor = os.open(
            self.path, os.O_RDWR | os.O_CREAT | os.O_APPEND | getattr(os, "O_BINARY", 0), 0o666
        )
        try:
            with _locked(descriptor):
                os.lseek(descriptor, 0, os.SEEK_SET)
                if os.read(descriptor, 2) in _UTF_16:
                    raise ValueError(
                        f"{str(self.path)!r} is in UTF-16, to which no line is added: save it as UTF-8 or ASCII"
                    )
                end = os.lseek(descriptor, 0, os.SEEK_END)
                os.lseek(descriptor, max(end - 1, 0), os.SEEK_SET)
                unfinished = os.read(descriptor, 1) not in (
                    b"",
                    b"\n",
                )  # edited by hand, or cut off
                data = f"{chr(10) * unfinished}{line}\n".encode("ascii")
                if os.write(descriptor, data) != len(data):
                    raise OSError(
                        errno.ENOSPC, "the line could not be written whole", str(self.path)
                    )
        finally:
            os.close(descriptor)


def _counted(rows: tuple, word: str) -> str:
    return f"{len(rows)} {word}" if len(rows) == 1 else f"{len(rows)} {word}s"


@contextmanager
def _locked(descriptor: int) -> Iterator[None]:
    """The file is this process's alone; the operating system lets go of it even if the process dies."""
    try:
        import fcntl
    except ImportError:  # Windows, where a byte far behind the end stands for the file
        import msvcrt

        os.lseek(descriptor, 2**30, os.SEEK_SET)
        msvcrt.locking(descriptor, msvcrt.LK_LOCK, 1)
        try:
            yield
        finally:
            os.lseek(descriptor, 2**30, os.SEEK_SET)
            msvcrt.locking(descriptor, msvcrt.LK_UNLCK, 1)
    else:
        fcntl.flock(descriptor, fcntl.LOCK_EX)
        try:
            yield
        finally:
            fcntl.flock(descriptor, fcntl.LOCK_UN)
