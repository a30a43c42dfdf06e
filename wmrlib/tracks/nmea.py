"""Positions in NMEA 0183: GGA, GNS, RMC and GLL of every talker, brought together by epochs."""

import math
import re
from collections.abc import Iterable, Iterator
from functools import reduce
from itertools import groupby
from operator import xor
from typing import TextIO

from wmrlib.tracks.fixes import (
    KNOT,
    LONGEST,
    UNREPORTED,
    Fixes,
    Reported,
    reading,
    timestamp,
    trust,
)
from wmrlib.tracks.neighbours import DISAGREEING, disagree

# A body, with anything before and after it, and the checksum that is stated.
_SENTENCE = re.compile(r"\$([A-Za-z]{2}[^$*\r\n]{3}[^$*\r\n]*)(\*[0-9A-Fa-f]{0,2})?")
_CLOCK = re.compile(r"([01][0-9]|2[0-3])([0-5][0-9])((?:[0-5][0-9]|60)(?:\.[0-9]*)?)")
_PLACE = re.compile(r"([0-9]{2})([0-5][0-9]\.[0-9]+),([NS]),([0-9]{3})([0-5][0-9]\.[0-9]+),([EW])")
# The most trusted kind first: its rank, and where its time, its place, its modes and its status
# are; of GGA and GNS the number of satellites is the status. Before 2000 RMC and GLL had no mode.
_KINDS = {
    "GGA": (0, 1, 2, 6, 7),
    "GNS": (1, 1, 2, 6, 7),
    "RMC": (2, 1, 3, 12, 2),
    "GLL": (3, 5, 1, 7, 6),
}
_QUALITY = {"R": 4.0, "F": 5.0, "P": 3.0, "D": 2.0, "A": 1.0}  # of a mode, the best first
_DAY = 86400.0  # s


def read(lines: Iterable[tuple[int, str]], fixes: Fixes) -> Fixes | None:
    """Each epoch's position once, by the kind of sentence trusted most; None without a sentence."""
    last, zero, guess = 0.0, 0.0, 0.0
    undated = list[int]()  # where in the table the times of this day are, since the last date
    for second, epoch in groupby(_sentences(lines, fixes), lambda sentence: sentence[2]):
        sentences = sorted(epoch)
        denied = sentences[0][1]
        sentences.sort(key=_order)
        _, _, _, line, lat, lon, *_ = sentences[0]
        if not denied:
            day = _DAY * math.ceil((last - 60.0 - second) / _DAY)  # undated, time goes on
            undated = undated if day == guess else []
            guess = day
            if dated := max(sentence[6] for sentence in sentences):
                zero = zero or dated - day
                day = dated - zero
                for place in undated:  # now it is known better
                    fixes.table[place] += day - guess
                undated, guess = [], day
            last = second + day
            # Where several sentences report a value, the most trusted one counts.
            positions = [sentence for sentence in sentences if not sentence[1]]
            reports = zip(*(sentence[7] for sentence in positions), strict=True)
            reported = (next((x for x in values if x == x), math.nan) for values in reports)
            before = len(fixes.table)
            fixes.add(lat, lon, last, line, Reported(*reported))
            if not dated and len(fixes.table) > before:
                undated.append(before + 4)
            if any(disagree(lat, lon, *sentence[4:6]) for sentence in positions):
                fixes.noted.count(DISAGREEING, line)
        doubt = "sentence of an epoch that a more trusted one says has no fix"
        for _, denies, _, line, *_ in sentences if denied else sentences[1:]:
            others = doubt if denied else "same epoch again"
            fixes.skip("sentence without a fix" if denies else others, line)
    known = fixes.skipped.keys() - {"comment", "line that is no sentence"}
    return fixes if fixes.table or known else None


def _order(sentence: tuple) -> tuple[bool, int, int, int]:
    """Which of an epoch's sentences comes first: RTK of whatever kind, or else the kind decides."""
    rank, denies, *_, reported = sentence
    quality = trust(reported.quality)
    return denies, -max(quality, trust(3.0)), rank, -quality


def numbered(text: TextIO) -> Iterator[tuple[int, str]]:
    """The lines, or parts of long ones, and their numbers."""
    line = 1
    while words := text.readline(LONGEST):
        yield line, words
        line += words.endswith(("\n", "\r"))


def _sentences(lines: Iterable[tuple[int, str]], fixes: Fixes) -> Iterator[tuple]:
    """The contents of sound sentences of known kinds; `fixes` counts all others."""
    for line, words in lines:
        matches = [] if words.startswith("#") else _SENTENCE.findall(words)
        if not matches and (rest := words.strip(" \t\r\n\0")):
            fixes.skip("comment" if rest.startswith("#") else "line that is no sentence", line)
        for body, stated in matches:
            try:
                yield _parsed(body, stated.upper(), line)
            except ValueError as error:
                fixes.skip(str(error), line)


def _parsed(body: str, stated: str, line: int) -> tuple:
    """Rank, whether it denies a fix, second, line, lat, lon, date, Reported; or ValueError."""
    checksum = f"*{reduce(xor, body.encode('utf-8', 'surrogateescape')):02X}"
    fields = [*body.split(","), *[""] * 13]
    if stated != checksum:
        raise ValueError("wrong checksum" if stated else "sentence without a checksum")
    if (kind := fields[0][2:].upper()) not in _KINDS:
        raise ValueError("other sentence")
    rank, at_time, at_place, at_mode, at_status = _KINDS[kind]
    clock, modes, status = _CLOCK.fullmatch(fields[at_time]), fields[at_mode], fields[at_status]
    second = int(clock[1]) * 3600 + int(clock[2]) * 60 + float(clock[3]) if clock else 0.0
    sound = status == "A" if rank > 1 else status not in ("0", "00")
    measured = {*"ADPRF"} & {*(modes or "A" * (rank > 1))} if rank else modes in {*"123459"}
    fixed = sound and bool(measured)  # not estimated or put in by hand
    place = _PLACE.fullmatch(",".join(fields[at_place : at_place + 4]))
    if not clock:
        raise ValueError("fix without a readable time" if fixed else "sentence without a fix")
    if not fixed:
        return rank, True, second, line, 0.0, 0.0, 0.0, UNREPORTED
    if not place:
        raise ValueError("unreadable position")
    lat, lon = (int(place[i]) + float(place[i + 1]) / 60.0 for i in (1, 4))
    lat, lon = -lat if place[3] == "S" else lat, -lon if place[6] == "W" else lon
    day = (
        timestamp(f"20{fields[9][4:]}-{fields[9][2:4]}-{fields[9][:2]}T00:00") if rank == 2 else 0.0
    )
    return rank, False, second, line, lat, lon, day or 0.0, _reported(rank, modes, fields)


def _reported(rank: int, modes: str, fields: list[str]) -> Reported:
    best = (quality for mode, quality in _QUALITY.items() if mode in modes)
    reported = Reported(next(best, math.nan) if rank else reading(modes.replace("9", "2")))
    if rank == 2:
        speed, course = reading(fields[7], KNOT), reading(fields[8], math.radians(1.0))
        return reported._replace(speed=speed, course=course)
    if rank > 2:
        return reported
    return reported._replace(satellites=reading(fields[7]), hdop=reading(fields[8]))
