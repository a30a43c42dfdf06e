"""The sentences of an NMEA 0183 log, found and checked."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from typing import TextIO

import numpy as np

from wmrlib.tracks.fixes import LONGEST, Fixes

COMMENT, NO_SENTENCE = "comment", "line that is no sentence"
_BLOCK = 1 << 16  # characters
# A body after $, or after ! where a line or a TAG block ends; what is stated as its checksum.
_SENTENCE = re.compile(
    r"(?:\$|(?<![^\0\\])!)([A-Za-z]{2}[^$*\r\n]{3}[^$*!\r\n]*(?:(?<![\0\\])![^$*!\r\n]*)*)"
    r"(\*[0-9A-Fa-f]{0,2})?"
)
# Before a $ may stand a TAG block or a logger's clock, but also the end of a broken sentence.
_BROKEN = re.compile(r"[^$!\\]*\*")


def sentences(
    text: TextIO, kinds: Collection[str], fixes: Fixes
) -> Iterator[tuple[int, list[str]]]:
    """The line and the fields of each sound sentence of these kinds; `fixes` counts all else."""
    for lines in _blocks(text):
        rows = [(n, *each) for n, words in lines for each in _in(words, n, fixes)]
        bodies = [body.encode("utf-8", "surrogateescape") for _, body, _ in rows]
        begins = np.cumsum([0, *map(len, bodies)])[: len(rows)]
        codes = np.frombuffer(b"".join(bodies), np.uint8)
        sums = np.bitwise_xor.reduceat(codes, begins).tolist() if rows else []
        for (line, body, stated), right in zip(rows, sums, strict=True):
            if not stated:
                fixes.skip("sentence without a checksum", line)
            elif stated.upper() != f"*{right:02X}":
                fixes.skip("wrong checksum", line)
            elif body[2:5].upper() not in kinds or body[5:6] != ",":
                fixes.skip("other sentence", line)
            else:
                yield line, body.split(",")


def _blocks(text: TextIO) -> Iterator[list[tuple[int, str]]]:
    """Lines with their numbers, some at a time; a very long line in parts that begin with a $."""
    line, rest, block, size = 1, "", list[tuple[int, str]](), 0
    while words := rest + text.readline(LONGEST):
        ends, rest = words.endswith(("\n", "\r")), ""
        if len(words) >= LONGEST and not ends and (cut := words.rfind("$")) > 0:
            words, rest = words[:cut], "#" if words[0] == "#" else words[cut:]
        block.append((line, words))
        line, size = line + ends, size + len(words)
        if size >= _BLOCK:
            yield block
            block, size = [], 0
    yield block


def _in(words: str, line: int, fixes: Fixes) -> list[tuple[str, str]]:
    """The bodies of a line, each with what is stated as its checksum."""
    found = [] if words.startswith("#") else _SENTENCE.findall(words)
    if found and _BROKEN.match(words):
        fixes.skip("unreadable sentence", line)
    if not found and (rest := words.strip(" \t\r\n\0")):
        fixes.skip(COMMENT if rest.startswith("#") else NO_SENTENCE, line)
    return found
