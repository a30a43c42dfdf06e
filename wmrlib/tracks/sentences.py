"""The sentences of an NMEA 0183 log, found and checked a block at a time."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from typing import TextIO

import numpy as np

from wmrlib.tracks.fixes import Fixes

COMMENT, NO_SENTENCE = "comment", "line that is no sentence"
_BLOCK = 1 << 16  # characters
# Before a $ may stand a TAG block or a logger's clock, but also the end of a broken sentence.
_BROKEN = re.compile(rb"[^$!\\]*\*")
_MARKS, _DIGITS = np.zeros(256, bool), np.full(256, 4096)
_LETTER = np.array([byte < 128 and chr(byte).isalpha() for byte in range(256)])
_MARKS[list(b"$!*\r\n")] = True
_DIGITS[list(b"0123456789ABCDEFabcdef")] = [*range(16), *range(10, 16)]


def sentences(text: TextIO, kinds: Collection[str], fixes: Fixes) -> Iterator[tuple[int, str]]:
    """The line and the body of each sound sentence of these kinds; `fixes` counts all else."""
    line, wanted = 1, [int.from_bytes(kind.encode(), "big") for kind in kinds]
    while block := text.read(_BLOCK) + text.readline():
        data = block.encode("utf-8", "surrogateescape")
        data += b"" if data.endswith((b"\n", b"\r")) else b"\n"
        codes = np.frombuffer(data + b"\0\0", np.uint8)
        feed = codes == ord("\n")
        ends = np.flatnonzero(feed | ((codes == ord("\r")) & ~np.roll(feed, -1)))
        begin, end, row = _bodies(codes, ends)
        _count_the_rest(data, ends, begin, row, line, fixes)
        summed = codes[end] == ord("*")
        stated = 16 * _DIGITS[codes[end + 1]] + _DIGITS[codes[end + 2]]
        sums = np.bitwise_xor.reduceat(codes, np.column_stack([begin, end]).ravel())[::2]
        right = summed & (sums == stated)
        names = (codes[begin[:, None] + [2, 3, 4]] & 0xDF) @ np.array([1 << 16, 1 << 8, 1])
        good = right & np.isin(names, wanted) & (codes[begin + 5] == ord(","))
        for reason, which in (
            ("sentence without a checksum", ~summed),
            ("wrong checksum", summed & ~right),
            ("other sentence", right & ~good),
        ):
            if which.any():
                fixes.skip(reason, line + int(row[which.argmax()]), int(which.sum()))
        for i, a, b in np.column_stack([row, begin, end])[good].tolist():
            yield line + i, data[a:b].decode("latin-1")
        line += ends.size


def _bodies(codes: np.ndarray, ends: np.ndarray) -> tuple[np.ndarray, ...]:
    """Where bodies begin, after $, or after ! at the start of a line, where they end; their row."""
    marks = np.flatnonzero(_MARKS[codes])
    begins_line = np.isin(codes[marks - 1], list(b"\0\r\n\\"))  # before the first: the last, a 0
    marks = marks[(codes[marks] != ord("!")) | begins_line]
    begin, end = marks[:-1] + 1, marks[1:]
    long = np.isin(codes[begin - 1], list(b"$!")) & (end - begin > 4)
    long &= _LETTER[codes[begin]] & _LETTER[codes[np.minimum(begin + 1, end)]]
    begin, end = begin[long], end[long]
    row = np.searchsorted(ends, begin)
    comment = codes[np.append(0, ends + 1)[row]] == ord("#")
    return begin[~comment], end[~comment], row[~comment]


def _count_the_rest(
    data: bytes, ends: np.ndarray, begin: np.ndarray, row: np.ndarray, line: int, fixes: Fixes
) -> None:
    """Count the lines without a sentence, and what is broken before the first of a line."""
    starts = np.append(0, ends + 1)
    for i in np.setdiff1d(np.arange(ends.size), row).tolist():
        words = data[starts[i] : ends[i]].strip(b" \t\r\n\0")
        if words:
            fixes.skip(COMMENT if words.startswith(b"#") else NO_SENTENCE, line + i)
    first = np.diff(row, prepend=-1) > 0
    for i in np.flatnonzero(first & (begin - 1 > starts[row])):
        if _BROKEN.match(data, starts[row[i]], begin[i]):
            fixes.skip("unreadable sentence", line + int(row[i]))
