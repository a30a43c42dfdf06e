"""The line that a student hands in for the tuning challenge, and whether it is true."""

from __future__ import annotations

import datetime
import hashlib
import re
import unicodedata
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple
from urllib.parse import quote, unquote

from wmrbook.challenge import SEED, from_seed, rounded, score
from wmrlib._checks import instance
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
_LONGEST_NAME = 60
JOINERS = "\u200c\u200d"
"""Characters of format that names need, in Persian and in Indian scripts."""
_FILLERS = "\u034f\u115f\u1160\u17b4\u17b5\u2800\u3164\uffa0"  # unseen letters and marks


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
    text += f" name={quote(_clean(name), safe='')}"
    if date is not None:
        text += f" date={instance('date', date, datetime.date).isoformat()[:10]}"
    return f"{text} check={_checksum(text)}"


def verify(line: str) -> Verdict:
    """Whether a handed-in line is true: its form, its checksum and its score, computed again.

    Blanks around the line do not matter. Never raises for a text.
    """
    text = instance("line", line, str).strip()
    found = _FORM.fullmatch(text)
    if not found:
        return Verdict(False, f"this is no line of the challenge: {_WANTED}")
    if _checksum(text.rpartition(" check=")[0]) != found["check"]:
        return Verdict(False, "the checksum does not fit: a character was changed, lost or added")
    try:
        entry = _entry(found)
        points = f"{_points(rounded(entry.gains), entry.seed):.2f}"
    except (ValueError, OverflowError) as error:  # honest checksum, impossible content
        return Verdict(False, f"the line can't be scored: {error}")
    if points != found["score"]:
        reason = f"{entry.name} states {found['score']} points, but the gains give {points}"
        return Verdict(False, reason, entry)
    return Verdict(True, f"{entry.name}'s {points} points are what the gains give", entry)


@lru_cache(maxsize=4096)
def _points(gains: Gains, seed: int) -> float:
    return score(gains, from_seed(seed)).total


def _entry(found: re.Match) -> Entry:
    gains = Gains(*map(float, found["gains"].split(",")))
    name = _clean(unquote(found["name"], errors="strict"))
    day = None if found["date"] is None else datetime.date.fromisoformat(found["date"])
    return Entry(name, gains, int(found["seed"]), float(found["score"]), day)


def _clean(name: str) -> str:
    """The same name for the same person: composed characters, single blanks."""
    clean = " ".join(unicodedata.normalize("NFC", instance("name", name, str)).split())
    named = len(clean) <= _LONGEST_NAME and any(map(str.isalnum, clean))
    if not named or not all(map(_readable, clean)):
        wanted = f"1 to {_LONGEST_NAME} readable characters, one a letter or digit, are needed"
        raise ValueError(f"name = {name!r} is not allowed: {wanted}")
    return clean


def _readable(character: str) -> bool:
    """Whether it is seen, and leaves the direction of the writing alone."""
    control = unicodedata.category(character)[0] == "C"
    return character in JOINERS or not (control or character in _FILLERS)


def _checksum(text: str) -> str:
    return hashlib.sha256(text.encode("ascii", "backslashreplace")).hexdigest()[:10]
