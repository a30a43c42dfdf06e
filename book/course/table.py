"""What a lecturer reads: a line for each hand-in."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from cells import visible


class Row(NamedTuple):
    """A line of the table; points is empty where nothing was graded."""

    assignment: str
    student: str
    points: str
    said: str
    anew: bool = True  # and not as it was graded before


def nothing(folder: Path, wanted: list[str]) -> str:
    """Say where the hand-ins of these assignments, or of all, are looked for."""
    first, *_ = sorted((folder / "source").glob(f"{wanted[0] if wanted else '*'}/*.ipynb"))
    place = folder / "submitted" / "NAME" / first.relative_to(folder / "source")
    return f"No hand-ins{' of ' * bool(wanted)}{', '.join(wanted)}. A student's goes to {place}"


def table(rows: list[Row]) -> str:
    """One line a hand-in, and a count."""
    graded = [row for row in rows if row.points]
    repairs = sum("repaired:" in row.said for row in graded)
    lines = [Row("", "student", "points", ""), *rows]
    lines = [[visible(" ".join(text.split())) for text in row[:4]] for row in lines]
    wide = [max(len(row[k]) for row in lines) for k in range(3)]
    text = [
        f"{a:<{wide[0]}}  {s:<{wide[1]}}  {p:>{wide[2]}}  {said}".rstrip()
        for a, s, p, said in lines
    ]
    same = sum(not row.anew for row in graded)
    count = f"{len(graded)} graded, {repairs} of them repaired"
    count += f", {same} as before" * bool(same) + f"; {len(rows) - len(graded)} refused"
    return "\n".join([*text, count])
