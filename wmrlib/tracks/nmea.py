"""Positions in NMEA 0183; pynmea2 reads a sentence, and what it lets pass is caught here."""

from __future__ import annotations

import re
from datetime import date, time
from typing import Any, NamedTuple

import pynmea2

from wmrlib.tracks.fixes import Fixes

DAY = 86400.0
_PLACE = re.compile(r"[0-9]{2}[0-5][0-9]\.[0-9]+,[NS],[0-9]{3}[0-5][0-9]\.[0-9]+,[EW]")
_SENTENCE = re.compile(rb"^[ \t\x00]*\$\w{5},", re.MULTILINE)


class _Heard(NamedTuple):
    """A sentence of a known second; `usable` is False for a GGA that says there is no fix."""

    line: int
    sentence: pynmea2.TalkerSentence
    second: float
    usable: bool


def looks_like(data: bytes) -> bool:
    return bool(_SENTENCE.search(data.replace(b"\r", b"\n")))


def read(data: bytes) -> Fixes:
    """Every talker's GGA, and RMC for seconds without one; each epoch once, the first talker's."""
    fixes, heard = Fixes(), []
    for line, raw in enumerate(re.split(rb"\r\n|\r|\n", data), 1):
        text = raw.decode("latin-1").strip(" \t\x00")  # byte for byte, as the sum is made
        if not text:
            continue
        sentence = _parsed(text)
        if isinstance(sentence, str):
            fixes.skip(sentence, line)
            continue
        second = _second_of_day(sentence)
        trouble = _trouble(sentence, second)
        if trouble:
            fixes.skip(trouble, line)
        # Where a GGA says there is no fix, an RMC of that second is not believed either.
        if second is not None and (not trouble or sentence.sentence_type == "GGA"):
            heard.append(_Heard(line, sentence, second, not trouble))
    heard = _on_one_clock(heard)
    settled = {each.second for each in heard if each.sentence.sentence_type == "GGA"}
    used = set()
    for line, sentence, second, usable in heard:
        if not usable:
            continue
        if second in used or (sentence.sentence_type == "RMC" and second in settled):
            fixes.skip("same epoch again", line)
        elif fixes.add(sentence.latitude, sentence.longitude, second, line):
            used.add(second)
    return fixes


def _parsed(text: str) -> pynmea2.TalkerSentence | str:
    """Return the GGA or RMC, or why there is none."""
    if text.startswith("#"):
        return "comment"
    if not text.startswith(("$", "!")):
        return "line that is no sentence"
    try:
        sentence = pynmea2.parse(text, check=True)
    except pynmea2.ChecksumError:
        return "wrong checksum" if "*" in text else "sentence without a checksum"
    except pynmea2.SentenceTypeError:
        return "other sentence"
    except (ValueError, LookupError, TypeError):  # the last two: makers' own sentences, cut short
        return "unreadable sentence"
    known = isinstance(sentence, pynmea2.TalkerSentence)
    return sentence if known and sentence.sentence_type in ("GGA", "RMC") else "other sentence"


def _second_of_day(sentence: pynmea2.TalkerSentence) -> float | None:
    clock = sentence.timestamp
    if not isinstance(clock, time):
        return None
    return clock.hour * 3600.0 + clock.minute * 60.0 + clock.second + clock.microsecond * 1e-6


def _trouble(sentence: pynmea2.TalkerSentence, second: float | None) -> str | None:
    """Return why the sentence gives no position, or None."""
    if sentence.sentence_type == "GGA":
        fix, measured = sentence.gps_qual in range(1, 9), sentence.gps_qual not in (6, 7, 8)
    else:
        fix = sentence.status == "A" and sentence.mode_indicator != "N"
        measured = sentence.mode_indicator not in ("E", "M", "S")
    if not fix:
        return "sentence without a fix"
    if not measured:
        return "position estimated, put in by hand or simulated"
    if second is None:
        return "fix without a readable time"
    # pynmea2 would read 0 for what is missing, and 60 minutes as a degree.
    place = f"{sentence.lat},{sentence.lat_dir},{sentence.lon},{sentence.lon_dir}"
    return None if _PLACE.fullmatch(place) else "unreadable position"


def _on_one_clock(heard: list[_Heard]) -> list[_Heard]:
    """Count the seconds on from day to day, by RMC's dates or by the nearest time already known."""
    dates = [getattr(each.sentence, "datestamp", None) for each in heard]  # a GGA has none
    first: Any = next((day for day in dates if isinstance(day, date)), None)
    dated: list[Any] = [
        each.second + DAY * (day - first).days if isinstance(day, date) else None
        for each, day in zip(heard, dates, strict=True)
    ]
    ahead: list[Any] = [None]
    for second in reversed(dated):
        ahead.append(ahead[-1] if second is None else second)
    last, counted = None, []
    for each, second, next_dated in zip(heard, dated, reversed(ahead[1:]), strict=True):
        if second is None:
            known = [time for time in (last, next_dated) if time is not None]
            choices = [(each.second + DAY * round((k - each.second) / DAY), k) for k in known]
            second, _ = min(choices, key=lambda c: abs(c[0] - c[1]), default=(each.second, None))
        counted.append(each._replace(second=second))
        # Before its first fix a cold receiver may count from 0:00.
        if each.usable or last is None or second > last:
            last = second
    return counted
