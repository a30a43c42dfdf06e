"""The audit as a list of rows, with links to the cells of the chapters that show each row."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from wmrbook.audit.row import Row, Verdict

SOURCE = "Judged from a converted text of the paper: a slip may be the conversion's."
SOURCE += " Its figures are not known."
_TAG = "audit:"


class Place(NamedTuple):
    """A cell that shows a row: its chapter, the heading above, and its place among the code cells.

    The chapters are executed in order, so that Jupyter shows this number beside the cell.
    """

    file: str
    chapter: int
    heading: str
    cell: int


def places(folder: str | Path | None = None) -> dict[str, list[Place]]:
    """From a row's item to the cells tagged ``audit:item`` in the chapters of a folder.

    By default the folder is the one in which Python runs, and it may lack the chapters.
    Raises ValueError if another holds no notebook whose name begins with a chapter's number.
    """
    notebooks = sorted(Path(folder or ".").glob("[0-9][0-9]_*.ipynb"))
    if folder and not notebooks:
        needed = "one with notebooks named like 04_lyapunov.ipynb is needed"
        raise ValueError(f"folder = {str(folder)!r} is not allowed: {needed}")
    places: dict[str, list[Place]] = {}
    for path in notebooks:
        heading, number = path.stem, 0
        for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
            if cell["cell_type"] == "markdown":
                text = "".join(cell["source"])
                headings = re.findall(r"^#{1,3} +(.+?) *$", text, re.MULTILINE)
                heading = [heading, *headings][-1]
            elif cell["cell_type"] == "code":
                number += 1
                place = Place(path.name, int(path.name[:2]), heading, number)
                for tag in cell["metadata"].get("tags", ()):
                    if tag.startswith(_TAG):
                        places.setdefault(tag.removeprefix(_TAG), []).append(place)
    return places


def missing(rows: Sequence[Row], where: Mapping[str, Sequence[Place]]) -> list[str]:
    """The items of the rows that no cell shows."""
    return [row.item for row in rows if not where.get(row.item)]


def tally(rows: Sequence[Row]) -> dict[Verdict, int]:
    """How many rows have each verdict, in the order of Verdict."""
    return {verdict: sum(row.verdict is verdict for row in rows) for verdict in Verdict}


class Table:
    """The rows to look at, with the cells that `places` found for them.

    They are one below the other, so that formulas have the width of a page or of a telephone.
    JupyterLab and MyST typeset the Markdown with its mathematics.
    """

    def __init__(self, rows: Sequence[Row], where: Mapping[str, Sequence[Place]]) -> None:
        self.rows = tuple(rows)
        self.where = where

    def _repr_mimebundle_(self, include=None, exclude=None):
        return {"text/markdown": self.markdown(), "text/plain": repr(self)}

    def markdown(self) -> str:
        """The source, and a list with an entry for each row."""
        return "\n".join([f"*{SOURCE}*", "", *map(self._entry, self.rows)])

    def _entry(self, row: Row) -> str:
        parts = [
            f"**{row.title} {row.verdict.value}.** {row.why}",
            f"*The paper:* {row.says}",
            f"*We find:* {row.holds}" if row.holds else "",
            f"*Shown in* {_linked(self.where.get(row.item, ()))}",
        ]
        return "- " + "\\\n  ".join(filter(None, parts))

    def __repr__(self) -> str:
        width = max((len(row.title) for row in self.rows), default=0)
        lines = (f"{row.title:{width}}  {row.verdict.value}: {row.why}" for row in self.rows)
        return "\n".join([SOURCE, *lines])


def _linked(cells: Sequence[Place]) -> str:
    """One link for each heading; cells under the same one share it."""
    numbers: dict[tuple[str, int, str], list[str]] = {}
    for file, chapter, heading, cell in cells:
        numbers.setdefault((file, chapter, heading), []).append(str(cell))
    links = []
    for (file, chapter, heading), among in numbers.items():
        title = re.sub(r"([\[\]])", r"\\\1", heading)
        links.append(f"[{chapter}, {title}]({file}), cell {', '.join(among)}")
    return "; ".join(links) or "in no chapter of this folder"
