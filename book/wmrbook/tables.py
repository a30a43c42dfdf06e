"""Small tables that a cell shows in place of a printout."""

from __future__ import annotations

from collections.abc import Iterable


class Table:
    """Lines such as "3 m | 20 deg" below a head: Markdown, which Jupyter and the book typeset.

    later: how the columns after the first are aligned, to the right for numbers.
    """

    def __init__(self, head: str, lines: Iterable[str], later: str = "-:") -> None:
        rule = "|".join([":-", *[later] * head.count("|")])
        self.text = "\n".join(f"| {line} |" for line in (head, rule, *lines))

    def __repr__(self) -> str:
        return self.text

    _repr_markdown_ = __repr__
