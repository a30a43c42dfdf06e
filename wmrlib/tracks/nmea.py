"""Positions out of NMEA 0183 sentences. pynmea2 reads a sentence and checks its sum; what it lets pass is looked at here."""

from __future__ import annotations

import re
from datetime import date
from datetime import time as clock
from itertools import accumulate
from typing import NamedTuple

import pynmea2

from wmrlib.tracks.fixes import Fixes

DAY = 86400.0
_LATITUDE = re.compile(r"[0-9]{2}[0-5][0-9]\.[0-9]+")  # ddmm.mm
_LONGITUDE = re.compile(r"[0-9]{3}[0-5][0-9]\.[0-9]+")  # dddmm.mm
_SENTENCE = re.compile(rb"^[ \t\x00]*\$\w{5},", re.MULTILINE)


class _Heard(NamedTuple):
    """What a sentence says of a second; its day is known of an RMC, its sentence is None where a GGA says that there is no fix."""

    line: int
    kind: str
    second: float
    day: int | None = None
    sentence: pynmea2.TalkerSentence | None = None


class _NoFixError(ValueError):
    """Why a sentence gives no position; `second` where it says so of a known time."""

    def __init__(self, reason: str, second: float | None = None) -> None:
        super().__init__(reason)
        self.reason, self.second = reason, second


def looks_like(data: bytes) -> bool:
    return bool(_SENTENCE.search(data.replace(b"\r", b"\n")))


def read(data: bytes) -> Fixes:
    """Every talker's GGA, and RMC where no GGA tells of that second; each epoch once, the first talker's."""
    fixes, heard = Fixes(), []
    for line, raw in enumerate(re.split(rb"\r\n|\r|\n", data), 1):
        text = raw.decode("latin-1").strip(" \t\x00")  # byte for byte, as the sum is made
        if not text:
            continue
        try:
            heard.append(_fix(line, text))
        except _NoFixError as no:
            fixes.skip(no.reason, line)
            if (
                no.second is not None
            ):  # the receiver's own no: an RMC of that second is not believed either
                heard.append(_Heard(line, "GGA", no.second))
    heard = _counted_on(heard)
    settled = {one.second for one in heard if one.kind == "GGA"}
    used = set()
    for line, kind, second, _, sentence in heard:
        if sentence is None:
            continue
        if second in used or (kind == "RMC" and second in settled):
            fixes.skip("same epoch again", line)
            continue
        before = len(fixes.lat)
        fixes.add(sentence.latitude, sentence.longitude, second, line)
        if len(fixes.lat) > before:
            used.add(second)
    return fixes


def _fix(line: int, text: str) -> _Heard:
    sentence = _parsed(text)
    kind = sentence.sentence_type if isinstance(sentence, pynmea2.TalkerSentence) else ""
    if kind not in ("GGA", "RMC"):
        raise _NoFixError("other sentence")
    time = sentence.timestamp
    second = None
    if isinstance(time, clock):
        second = time.hour * 3600.0 + time.minute * 60.0 + time.second + time.microsecond * 1e-6
    trouble = _trouble_of_gga(sentence) if kind == "GGA" else _trouble_of_rmc(sentence)
    if trouble:
        raise _NoFixError(trouble, second if kind == "GGA" else None)
    if second is None:
        raise _NoFixError("fix without a readable time")
    in_order = _LATITUDE.fullmatch(sentence.lat) and _LONGITUDE.fullmatch(sentence.lon)
    if not (
        in_order and sentence.lat_dir in ("N", "S") and sentence.lon_dir in ("E", "W")
    ):  # pynmea2 would make 0 or 60 minutes of it
        raise _NoFixError("unreadable position", second if kind == "GGA" else None)
    day = (
        sentence.datestamp.toordinal()
        if kind == "RMC" and isinstance(sentence.datestamp, date)
        else None
    )
    return _Heard(line, kind, second, day, sentence)


def _parsed(text: str) -> pynmea2.NMEASentence:
    if text.startswith("#"):
        raise _NoFixError("comment")
    if not text.startswith(("$", "!")):
        raise _NoFixError("line that is no sentence")
    try:
        return pynmea2.parse(text, check=True)
    except pynmea2.ChecksumError:
        raise _NoFixError(
            "wrong checksum" if "*" in text else "sentence without a checksum"
        ) from None
    except pynmea2.SentenceTypeError:
        raise _NoFixError("other sentence") from None
    except (
        ValueError,
        LookupError,
        TypeError,
    ):  # the last two from sentences of makers that are cut short
        raise _NoFixError("unreadable sentence") from None


def _trouble_of_gga(sentence) -> str | None:
    quality = sentence.gps_qual
    if quality in (6, 7, 8):
        return "position estimated, put in by hand or simulated"
    return None if quality in (1, 2, 3, 4, 5) else "sentence without a fix"


def _trouble_of_rmc(sentence) -> str | None:
    if sentence.status != "A" or sentence.mode_indicator == "N":
        return "sentence without a fix"
    return (
        "position estimated, put in by hand or simulated"
        if sentence.mode_indicator in ("E", "M", "S")
        else None
    )


def _counted_on(heard: list[_Heard]) -> list[_Heard]:
    """With seconds that are counted on from day to day: by the date of an RMC; or else from what was heard last, or the next RMC."""
    first = next((one.day for one in heard if one.day is not None), 0)
    dated = [None if one.day is None else one.second + DAY * (one.day - first) for one in heard]
    ahead = [*accumulate(reversed(dated), lambda later, this: later if this is None else this)][
        ::-1
    ]
    last, found = None, []
    for one, second, next_dated in zip(heard, dated, ahead, strict=True):
        if second is None:
            second = _nearest(one.second, [time for time in (last, next_dated) if time is not None])
        found.append(one._replace(second=second))
        if (
            one.sentence is not None or last is None or second > last
        ):  # a cold receiver without a fix may count from 0:00
            last = second
    return found


def _nearest(second: float, known: list[float]) -> float:
    """The second of the day, on the day that brings it nearest to one of the known times."""
    choices = [(second + DAY * round((time - second) / DAY), time) for time in known]
    return min(choices, key=lambda choice: abs(choice[0] - choice[1]), default=(second,))[0]
