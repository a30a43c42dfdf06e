"""What a class sent back: its lines, sorted into votes and tests, and their histograms."""

from __future__ import annotations

import itertools
import math
import os
import re
from collections import Counter, defaultdict
from typing import NamedTuple

import numpy as np

from wmrbook.lines import Line, Refused, read_all, same_name
from wmrbook.questions._asking import LETTERS, Question

TESTS = "pre", "post"
OPEN = "-"  # an answer that was not given
_DISTINCT = 8  # numbers; more are counted in classes


class Histogram(NamedTuple):
    """How often each label was chosen; right: the label of the right one, or ""."""

    title: str
    labels: tuple[str, ...]
    counts: tuple[int, ...]
    right: str = ""

    def text(self) -> str:
        """Return the histogram as lines of text, a bar of at most 40 characters each."""
        total, most = sum(self.counts), max(self.counts, default=0)
        width = max((len(label) for label in self.labels), default=0)
        rows = [f"{self.title}: {total} answers"]
        for label, count in zip(self.labels, self.counts, strict=True):
            bar = "#" * math.ceil(40 * count / max(most, 40))
            rows.append(f"  {label:<{width}} {count:4d} {bar}{' right' * (label == self.right)}")
        return "\n".join(rows)


class Class(NamedTuple):
    """A file of lines: the tests' sheets, {test: {name: letters}}, the votes, and the refused.

    votes: {(kind, id): values}, a text of each student.
    """

    sheets: dict[str, dict[str, str]]
    votes: dict[tuple[str, str], list[str]]
    refused: list[Refused]

    def right(self, test: str, questions: tuple[Question, ...]) -> dict[str, np.ndarray]:
        """Return which of a test's answers are right, a list of True and False of each name."""
        keys = np.array([question.key for question in questions])
        return {name: np.array(list(sheet)) == keys for name, sheet in self.sheets[test].items()}

    def histograms(self, questions: tuple[Question, ...]) -> dict[str, list[Histogram]]:
        """Return all histograms: of a test one for each question, of anything else one."""
        groups = {}
        labels = (*LETTERS, OPEN)
        for test, sheets in self.sheets.items():
            for at, question in enumerate(questions if sheets else ()):
                chosen = Counter(sheet[at] for sheet in sheets.values())
                title = f"{at + 1}. {question.id}"
                one = Histogram(title, labels, tuple(chosen[it] for it in labels), question.key)
                groups.setdefault(f"test {test}", []).append(one)
        for (kind, which), values in self.votes.items():
            groups[f"{kind} {which}"] = [_counted(f"{kind} {which}", values)]
        return groups


def read_class(path: str | os.PathLike, questions: tuple[Question, ...], mark: str) -> Class:
    """Read a class's file; mark: the fingerprint of the questions, without which a letter is none.

    Raises OSError if the file can't be read.
    """
    lines, refused = read_all(path, lambda line: _sheet(line, len(questions), mark))
    sheets, votes, spelled = {test: {} for test in TESTS}, defaultdict(list), {}
    for line in lines:
        if line.kind == "test":
            name = spelled.setdefault(same_name(line.name), line.name)
            sheets[_sheet(line, len(questions), mark)][name] = line.value
        else:
            votes[line.kind, line.id].append(line.value)
    return Class(sheets, dict(votes), refused)


def _sheet(line: Line, count: int, mark: str) -> str:
    """Which test a sheet of answers belongs to; "" for another kind of line."""
    if line.kind != "test":
        return ""
    test, _, theirs = line.id.partition("-")
    if test not in TESTS:
        raise ValueError(f"there is no test {line.id!r}: {' and '.join(TESTS)} are known")
    if theirs != mark:
        raise ValueError(f"it was made with another form ({theirs or 'none'}, not {mark})")
    if not re.fullmatch(f"[{LETTERS}{OPEN}]{{{count}}}", line.value):
        wanted = f"{count} letters of {LETTERS}, or {OPEN} for none, are needed"
        raise ValueError(f"its answers {line.value!r} are not allowed: {wanted}")
    return test


def _counted(title: str, values: list[str]) -> Histogram:
    """Numbers in classes of equal width if there are many different ones, else what was chosen."""
    try:
        numbers = [float(value) for value in values]
    except ValueError:
        numbers = [math.nan]
    if not all(map(math.isfinite, numbers)):
        chosen = Counter(values)
        ordered = sorted(chosen)
    elif len(set(numbers)) <= _DISTINCT:
        chosen = Counter(f"{number:g}" for number in numbers)
        ordered = sorted(chosen, key=float)
    else:
        counts, edges = np.histogram(numbers, np.histogram_bin_edges(numbers, "sturges"))
        pairs = itertools.pairwise(edges)
        names = tuple(f"{low:.3g} to {high:.3g}" for low, high in pairs)
        return Histogram(title, names, tuple(counts.tolist()))
    return Histogram(title, tuple(ordered), tuple(chosen[label] for label in ordered))
