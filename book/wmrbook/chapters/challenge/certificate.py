"""The line that a student hands in for the tuning challenge, and whether it is true."""

from __future__ import annotations

import datetime
import re
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple
from urllib.parse import quote, unquote

from wmrbook.chapters.challenge import SEED, from_seed, rounded, score
from wmrbook.lines import checked, clean_name
from wmrlib.checks import instance
from wmrlib.gains import Gains

_MARK = "wmr-challenge"
_NUMBER = r"[0-9]{1,310}\.[0-9]{3}"
_FORM = re.compile(
    rf"{_MARK} seed=(?P<seed>[0-9]{{1,19}}) gains=(?P<gains>{_NUMBER}(?:,{_NUMBER}){{3}})"
    r" score=(?P<score>[0-9]{1,20}\.[0-9]{2}) name=(?P<name>[\w.~%-]{1,800})"
    r"(?: date=(?P<date>\d{4}-\d\d-\d\d))? check=(?P<check>[0-9a-f]{10})",
    re.ASCII,
)
_WANTED = f"{_MARK} seed=... gains=... score=... name=... check=... is needed"


class Entry(NamedTuple):
    """What a line says: name; gains; seed; points; date, a datetime.date or None."""

    name: str
    gains: Gains
    seed: int
    points: float
    date: datetime.date | None


@dataclass(frozen=True, slots=True)
class Verdict:
    """What `verify` found; true in an `if` when the whole line is true.

    entry: what the line says, or None if it can't be read; reason: a sentence.
    """

    ok: bool
    reason: str
    entry: Entry | None = None

    def __bool__(self) -> bool:
        return self.ok

    def __repr__(self) -> str:
        return f"<Verdict: {self.reason}>"


def certificate(
    name: str, gains: Gains, seed: int = SEED, date: datetime.date | None = None
) -> str:
    """The line to hand in: ``wmr-challenge seed=2026 gains=... score=22.20 name=Ada check=...``.

    name: 1 to 60 characters of any script, written as in an address (%20 for a space); several
    blanks become one. gains: k_rho, k_alpha, h, v_max, with 3 decimals. Raises ValueError as
    `challenge.score` and `challenge.from_seed`, and for a name that is too long, has no letter or
    digit, or has characters that are not seen (control characters, spaces without width, marks that
    turn the writing round).
    """
    game, gains = from_seed(seed), rounded(gains)
    points = _points(gains, game.seed)
    numbers = ",".join(f"{gain:.3f}" for gain in gains)
    text = f"{_MARK} seed={game.seed} gains={numbers} score={points:.2f}"
    text += f" name={quote(clean_name(name), safe='')}"
    if date is not None:
        text += f" date={instance('date', date, datetime.date).isoformat()[:10]}"
    return checked(text)


def verify(line: str) -> Verdict:
    """Whether a handed-in line is true: its form, its checksum and its score, computed again.

    Blanks around the line do not matter. Never raises for a text.
    """
    text = instance("line", line, str).strip()
    match = _FORM.fullmatch(text)
    if not match:
        return Verdict(False, f"this is no line of the challenge: {_WANTED}")
    if checked(text.rpartition(" check=")[0]) != text:
        return Verdict(False, "the checksum does not fit: a character was changed, lost or added")
    try:
        entry = _entry(match)
        points = f"{_points(rounded(entry.gains), entry.seed):.2f}"
    except (ValueError, OverflowError) as error:  # honest checksum, impossible content
        return Verdict(False, f"the line can't be scored: {error}")
    if points != match["score"]:
        reason = f"{entry.name} states {match['score']} points, but the gains give {points}"
        return Verdict(False, reason, entry)
    return Verdict(True, f"{entry.name}'s {points} points are what the gains give", entry)


@lru_cache(maxsize=4096)
def _points(gains: Gains, seed: int) -> float:
    return score(gains, from_seed(seed)).total


def _entry(match: re.Match) -> Entry:
    gains = Gains(*map(float, match["gains"].split(",")))
    name = clean_name(unquote(match["name"], errors="strict"))
    day = None if match["date"] is None else datetime.date.fromisoformat(match["date"])
    return Entry(name, gains, int(match["seed"]), float(match["score"]), day)
