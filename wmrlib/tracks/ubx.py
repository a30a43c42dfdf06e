"""Positions in UBX, the binary messages of u-blox, alone or mixed with NMEA sentences."""

import math
import re
from collections.abc import Iterator
from io import BufferedReader
from itertools import groupby
from mmap import ACCESS_READ, mmap
from typing import Any

import numpy as np

from wmrlib.checks import book_extra
from wmrlib.tracks import nmea
from wmrlib.tracks.fixes import Fixes, Reported, timestamp, trust
from wmrlib.tracks.neighbours import DISAGREEING, disagree

# Where a message or a sentence may begin, and the messages that are read, by class and id, with
# the lengths that they may have: out of any other pyubx2 reads numbers all the same.
_START = re.compile(rb"\xb5\x62|\$[A-Za-z]{2}[^$*\r\n\xb5]{4,200}(?:\*[0-9A-Fa-f]{0,2})?")
_SOMETHING = re.compile(rb"[^ \t\r\n\0]")
_PVT, _PLACE, _BASELINE, _DOP = b"\x01\x07", b"\x01\x14", b"\x01\x3c", b"\x01\x04"
_LENGTHS = {_PVT: (84, 92), _PLACE: (36,), _BASELINE: (64,), _DOP: (18,)}
_BLOCK = 1 << 22  # bytes, more than a message has
_ROUNDED = 2e-7  # degrees, between NAV-PVT and the digits of NAV-HPPOSLLH
_Epoch = dict[bytes, tuple[int, Any]]


def read(file: BufferedReader) -> tuple[str, Fixes] | None:
    """The source and the positions: NAV-PVT's, or else the sentences'; None without a message."""
    try:
        data = mmap(file.fileno(), 0, access=ACCESS_READ)
    except ValueError:  # empty
        return None
    with data:
        if data.find(b"\xb5\x62") < 0:
            return None
        kinds = {kind for _, kind, _ in _parts(data, Fixes())}
        if kinds <= {b""}:
            return None
        fixes = Fixes(place="byte")
        if _PVT not in kinds:
            return "NMEA", nmea.read(_sentences(data, fixes), fixes) or fixes
        for _, epoch in groupby(_messages(data, fixes), lambda message: message[2].iTOW):
            _use(_of_one(epoch, fixes), fixes)
        return "UBX", fixes


def _parts(data: mmap, fixes: Fixes) -> Iterator[tuple[int, bytes, bytes]]:
    """First byte, class and id, and the whole of each sound message; b"" for a sentence's kind."""
    at, size, sums = 0, len(data), _Sums(data)
    while match := _START.search(data, at):
        begin, end, kind = match.start(), match.end(), b""
        if _SOMETHING.search(data, at, begin):
            fixes.skip("stretch of bytes that is no message", at)
        if data[begin] != ord("$"):
            kind, length = data[end : end + 2], data[end + 2 : end + 4]
            end = begin + 8 + int.from_bytes(length, "little")
            if end > size or sums.of(begin + 2, end - 2) != data[end - 2 : end]:
                fixes.skip("message that is damaged or cut off", begin)
                at = begin + 2
                continue
        yield begin, kind, data[begin:end]
        at = end
    if _SOMETHING.search(data, at):
        fixes.skip("stretch of bytes that is no message", at)


class _Sums:
    """Checksums of any stretches, in order, at the cost of one: bytes may pretend to be lengths."""

    def __init__(self, data: mmap) -> None:
        self.data, self.begin, self.end = data, 0, 0

    def of(self, begin: int, end: int) -> bytes:
        """The sum of the bytes from begin to end, and that of the sums up to each of them."""
        if end > self.end:
            self.begin, self.end = begin, min(begin + _BLOCK, len(self.data))
            values = np.frombuffer(self.data[begin : self.end], np.uint8)
            self.first = np.append(np.uint8(0), np.cumsum(values, dtype=np.uint8))
            self.second = np.append(np.uint8(0), np.cumsum(self.first[1:], dtype=np.uint8))
        a, b = begin - self.begin, end - self.begin
        before, after = int(self.first[a]), int(self.first[b])
        rows = int(self.second[b]) - int(self.second[a]) - (b - a) * before
        return bytes([(after - before) & 255, rows & 255])


def _sentences(data: mmap, fixes: Fixes) -> Iterator[tuple[int, str]]:
    for byte, kind, part in _parts(data, fixes):
        if not kind:
            yield byte, part.decode("utf-8", "surrogateescape")
        else:
            fixes.skip("message without a position", byte)


def _messages(data: mmap, fixes: Fixes) -> Iterator[tuple[int, bytes, Any]]:
    """First byte, class and id, and the parsed message, of each message that is used."""
    with book_extra("UBX"):
        from pyubx2 import UBXReader
    for byte, kind, part in _parts(data, fixes):
        if kind in _LENGTHS and len(part) - 8 in _LENGTHS[kind]:
            yield byte, kind, UBXReader.parse(part)
        else:
            odd = "of an unknown length" if kind in _LENGTHS else "without a position"
            fixes.skip(f"message {odd}" if kind else "sentence beside NAV-PVT", byte)


def _of_one(messages: Iterator[tuple[int, bytes, Any]], fixes: Fixes) -> _Epoch:
    """The best NAV-PVT of an epoch and the messages that belong to it; others are counted."""
    by_kind: dict[bytes, list[tuple[int, Any]]] = {}
    for byte, kind, message in messages:
        same = by_kind.setdefault(kind, [])
        if any(message.payload == before.payload for _, before in same):
            fixes.skip("message again", byte)
        else:
            same.append((byte, message))
    several = len(by_kind.get(_PVT, ())) > 1
    order = sorted(by_kind.get(_PVT, ()), key=lambda row: -trust(_quality(row[1])))
    first, pvt = order[0] if order else (0, None)
    rivals = [message for _, message in order[1:] if trust(_quality(message))]
    if pvt and rivals:
        apart = any(disagree(pvt.lat, pvt.lon, rival.lat, rival.lon) for rival in rivals)
        fixes.noted.count(DISAGREEING if apart else "of an epoch with two receivers", first)
    epoch: _Epoch = {}
    for kind, rows in by_kind.items():
        for byte, message in rows:
            if kind == _PLACE and pvt:
                apart = max(abs(message.lat - pvt.lat), abs(message.lon - pvt.lon))
                belongs = message.invalidLlh or apart < _ROUNDED
            else:
                belongs = message is pvt or not (several or rows[1:])
            if belongs and kind not in epoch:
                epoch[kind] = byte, message
            else:
                fixes.skip("message of another receiver", byte)
    return epoch


def _quality(pvt: Any) -> float:
    """As in GGA, NaN without a fix."""
    if not pvt.gnssFixOk or pvt.fixType not in (2, 3, 4) or pvt.invalidLlh:
        return math.nan
    return {2: 4.0, 1: 5.0}.get(pvt.carrSoln, 2.0 if pvt.diffSoln else 1.0)


def _use(epoch: _Epoch, fixes: Fixes) -> None:
    """Use the position of one epoch, or count why not."""
    if _PVT not in epoch:
        for byte, _ in epoch.values():
            fixes.skip("message of an epoch without NAV-PVT", byte)
        return
    byte, pvt = epoch[_PVT]
    if math.isnan(quality := _quality(pvt)):
        return fixes.skip("NAV-PVT without a fix", byte)
    place, baseline, dop = (epoch.get(kind, (0, None))[1] for kind in (_PLACE, _BASELINE, _DOP))
    best = pvt if place is None or place.invalidLlh else place
    time = None
    if pvt.validDate and pvt.validTime:
        clock = f"{pvt.hour:02d}:{pvt.min:02d}:{pvt.second:02d}"
        time = timestamp(f"{pvt.year:04d}-{pvt.month:02d}-{pvt.day:02d}T{clock}")
    aims = baseline is not None and baseline.relPosValid and baseline.relPosHeadingValid
    reported = Reported(
        quality=quality,
        satellites=pvt.numSV,
        hdop=math.nan if dop is None else dop.hDOP,
        speed=1e-3 * pvt.gSpeed,
        course=math.radians(pvt.headMot % 360.0),
        heading=math.radians(baseline.relPosHeading % 360.0) if aims else math.nan,
        accuracy=1e-3 * best.hAcc,
    )
    fixes.add(best.lat, best.lon, time and time + 1e-9 * pvt.nano, byte, reported)
