"""The line that a student hands in for the tuning challenge, and a class's text file of lines.

A line names who, the seed, the gains and the score, in ASCII, and ends in a checksum, the first ten
hexadecimal digits of the SHA-256 of what stands before it. The checksum finds a character that was
lost or mistyped. It is no signature: whoever can run this module can make a line in any name. What
can't be made up is the score, which is computed again from the gains wherever it is read.
"""

from __future__ import annotations

import datetime
import math
import os
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from filelock import FileLock

from wmrbook.chapters.challenge import SEED, from_seed, score
from wmrbook.chapters.challenge.certificate import Entry, Verdict, certificate, verify
from wmrbook.lines import UTF_16, Refused, numbered, same_name
from wmrlib.gains import Gains

_DECIDING = 20  # sets of drives: near the best score, gains that differ in a digit tie in one


class Ranked(NamedTuple):
    """A place in the ranking: the best entry of a name, and how many lines that name has.

    rank counts from 1 and is shared by equal points, unless a decider tells them apart.
    """

    rank: int
    entry: Entry
    tries: int


@dataclass(frozen=True, slots=True, repr=False)
class Ranking:
    """A scoreboard as it was read, the best first; others: how many lines have another seed.

    decider: the first seed of the drives by which equal points were ranked, or None.
    """

    entries: tuple[Ranked, ...]
    refused: tuple[Refused, ...]
    others: int
    seed: int
    decider: int | None = None

    def __repr__(self) -> str:
        names, lines = _counted(self.entries, "name"), _counted(self.refused, "line")
        counts = f"{names} ranked, {lines} refused, {self.others} of other seeds"
        decided = "" if self.decider is None else f"; ties decided by seed {self.decider}"
        rows = [f"<Ranking: seed {self.seed}; {counts}{decided}>"]
        columns = "{:>4}{:>9}{:>7}   {:<30}{}"
        if self.entries:
            rows.append(
                columns.format("rank", "points", "tries", "k_rho, k_alpha, h, v_max", "name")
            )
        for rank, entry, tries in self.entries:
            gains = ", ".join(f"{gain:g}" for gain in entry.gains)
            rows.append(columns.format(rank, f"{entry.points:.2f}", tries, gains, entry.name))
        rows += [f"line {line} is not ranked: {reason}" for line, _, reason in self.refused]
        return "\n".join(rows)


class Scoreboard:
    """A text file of handed-in lines, one a line, and its ranking.

    path: of the file, which need not exist yet. Empty lines and those that begin with # are let
    alone, so that the file can be edited by hand; joined files make one board. Lines are only ever
    added at the end, under a lock (a file beside it that ends in .lock): what stands in the file,
    damaged or not, stays, and of two who write at once both are there.
    """

    def __init__(self, path: str | os.PathLike) -> None:
        self.path = Path(path)

    def __repr__(self) -> str:
        return f"<Scoreboard: {str(self.path)!r}>"

    def add(
        self, name: str, gains: Gains, seed: int = SEED, date: datetime.date | None = None
    ) -> str:
        """Add a try, and return its line.

        Raises ValueError as `certificate` and for a file in UTF-16, and OSError if the line can't
        be written whole.
        """
        line = certificate(name, gains, seed, date)
        self._append(line)
        return line

    def add_line(self, line: str) -> Verdict:
        """Add a line that was handed in, if it is true; raises as `add`."""
        verdict = verify(line)
        if verdict:
            self._append(line.strip())
        return verdict

    def ranking(self, seed: int = SEED, decider: int | None = None) -> Ranking:
        """Read the file and compute all scores again: the best try of each name, by points.

        decider: a seed; of equal points those rank first whose gains have fewer points in the
        drives of this seed and the 19 after it. A file that is not there has no lines. Names that
        differ only in upper and lower case, or in joiners, which are not seen, are one. Raises
        ValueError as `challenge.from_seed`, and OSError if the file can't be read.
        """
        seed = from_seed(seed).seed
        first = None if decider is None else from_seed(decider).seed
        more = [] if first is None else [from_seed(first + k) for k in range(_DECIDING)]
        best, tries, refused, others = {}, {}, [], 0

        def order(entry: Entry) -> tuple[float, float]:
            cases = (case for game in more for case in score(entry.gains, game).cases)
            return entry.points, round(math.fsum(case.points for case in cases), 6)

        for number, text in numbered(self._content()):
            verdict = verify(text)
            if not verdict:
                refused.append(Refused(number, text, verdict.reason))
            elif verdict.entry.seed != seed:
                others += 1
            else:
                key = same_name(verdict.entry.name)
                tries[key] = tries.get(key, 0) + 1
                candidate = order(verdict.entry), verdict.entry
                if key not in best or candidate[0] < best[key][0]:
                    best[key] = candidate
        ordered = sorted(best, key=lambda key: (best[key][0], key))
        points = [best[key][0] for key in ordered]
        entries = tuple(
            Ranked(1 + points.index(best[key][0]), best[key][1], tries[key]) for key in ordered
        )
        return Ranking(entries, tuple(refused), others, seed, first)

    def _content(self) -> bytes:
        return self.path.read_bytes() if self.path.exists() else b""

    def _append(self, line: str) -> None:
        with FileLock(f"{self.path}.lock", poll_interval=0.005):
            content = self._content()
            if content.startswith(UTF_16):
                remedy = "to which no line is added: save it as UTF-8 or ASCII"
                raise ValueError(f"{str(self.path)!r} is in UTF-16, {remedy}")
            unfinished = content and not content.endswith(b"\n")  # edited by hand, or cut off
            with self.path.open("ab") as file:
                file.write(b"\n" * bool(unfinished) + line.encode("ascii") + b"\n")


def _counted(rows: tuple, word: str) -> str:
    return f"{len(rows)} {word}" if len(rows) == 1 else f"{len(rows)} {word}s"
