"""Which part each cell of a chapter plays on its slides: the rule for cells whose author has not said so.

The part is the cell's metadata slideshow.slide_type, as Jupyter's editors show it. A section is a slide and its results are below it; what
reads a result is a fragment of the same slide; derivations and long prose are the speaker's notes.
"""

from __future__ import annotations

import math
import re
from pathlib import Path

import nbformat
from nbformat import NotebookNode

TYPES = ("slide", "subslide", "fragment", "-", "notes", "skip")
ROOM = 15.0  # lines of text on a slide
LONG = 5.0  # lines of plain prose that nobody reads from a wall
_WIDTH = 85  # characters in a line
_HEADING = re.compile(r"#{1,3} ")
_SOLUTION = re.compile(r"\n*<details>.*?</details>", re.DOTALL)


def mark(path: Path) -> None:
    """Write a slide type into each cell of a notebook that has none; a cell with a heading in its middle is divided there first."""
    notebook = nbformat.read(path, as_version=4)
    notebook.cells = [part for cell in notebook.cells for part in divided(cell)]
    for cell, kind in zip(notebook.cells, slide_types(notebook.cells), strict=True):
        cell.metadata["slideshow"] = {"slide_type": kind}
    nbformat.write(notebook, path)


def slide_types(cells: list[NotebookNode]) -> list[str]:
    """The slide type of each cell: its own, or else the rule's."""
    types, used = [], 0.0
    for cell in cells:
        kind = own_type(cell) or _rule(cell, used, begun="slide" in types[1:])
        if kind in ("slide", "subslide"):
            used = 0.0
        if kind not in ("notes", "skip"):
            used += lines(cell)
        types.append(kind)
    return types


def own_type(cell: NotebookNode) -> str:
    """The slide type that a cell's author gave it, or an empty string."""
    return cell.metadata.get("slideshow", {}).get("slide_type", "")


def divided(cell: NotebookNode) -> list[NotebookNode]:
    """A cell as it stands on slides: cut before each heading in its middle, and a section's claim cut from the derivation below it."""
    if cell.cell_type != "markdown" or own_type(cell):
        return [cell]
    texts = [
        piece
        for part in re.split(r"\n\n(?=#{2,3} )", cell.source)
        for piece in _claim_and_derivation(part)
    ]
    whole: list[str] = []
    for text in texts:
        if (
            whole and "\n" not in whole[-1] and _HEADING.match(whole[-1])
        ):  # a heading with nothing below it stays with the next
            whole[-1] += f"\n\n{text}"
        else:
            whole.append(text)
    if len(whole) == 1:
        return [cell]
    parts = [
        nbformat.v4.new_markdown_cell(text, id=cell.id if not count else f"{cell.id}-{count}")
        for count, text in enumerate(whole)
    ]
    for part in parts:
        part.metadata.update(cell.metadata)
    return parts


def lines(cell: NotebookNode) -> float:
    """About how many lines a cell takes on a slide; its code is folded, its solution in the notes."""
    if cell.cell_type == "markdown":
        return sum(map(_block_lines, _blocks(_SOLUTION.sub("", cell.source))))
    return sum(map(_output_lines, cell.get("outputs", ())))


def _rule(cell: NotebookNode, used: float, begun: bool) -> str:
    wanted = lines(cell)
    if cell.cell_type == "markdown":
        if heading := _HEADING.match(cell.source):
            return "subslide" if heading[0] == "### " else "slide"
        shown = "$$" in cell.source or re.search(r"^(?:- |\|)", cell.source, re.MULTILINE)
        if _is_derivation(cell.source) or wanted > (ROOM if shown else LONG):
            return "notes"
        if used + wanted <= ROOM:
            return "fragment"
        return "subslide" if shown else "notes"
    if "hide-cell" in cell.metadata.get("tags", ()) or not begun:
        return "skip"  # a solution's numbers, and the imports
    if not wanted:
        return "-"
    return "fragment" if used + wanted <= ROOM else "subslide"


def _is_derivation(text: str) -> bool:
    """Whether it goes step by step, in formulas."""
    steps = re.findall(r"^\d+\. .*(?:\n(?!\d+\. ).*)*", text, re.MULTILINE)
    return len(steps) > 1 and sum("$" in step for step in steps) > 1


def _claim_and_derivation(text: str) -> list[str]:
    if not text.startswith("## ") or text.startswith(("## Summary", "## Exercises")):
        return [text]
    blocks = _blocks(text)
    fits = [
        sum(map(_block_lines, blocks[: count + 1])) <= ROOM and not _is_derivation(block)
        for count, block in enumerate(blocks)
    ]
    if all(fits):
        return [text]
    cut = max(2, fits.index(False))
    return ["\n\n".join(part) for part in (blocks[:cut], blocks[cut:]) if part]


def _blocks(text: str) -> list[str]:
    """Paragraphs, lists, formulas, as they are divided by empty lines."""
    return text.split("\n\n")


def _block_lines(block: str) -> float:
    if block.startswith("$$"):
        return 2.5 + 1.5 * block.count(r"\\ ") + 1.5 * block.count("\\\\\n")
    if _HEADING.match(block):
        return 2.0
    items = re.split(r"\n(?=- |\d+\. |\|)", block)
    return (
        sum(math.ceil(len(item) / _WIDTH) for item in items) + 2.0 * (block.count("$$") // 2) + 0.5
    )


def _output_lines(output: NotebookNode) -> float:
    if output.output_type == "stream":
        return 0.9 * len(output.text.splitlines()) + 0.7
    data = output.get("data", {})
    if "application/vnd.jupyter.widget-view+json" in data:
        return ROOM  # a panel has a slide for itself
    if "text/markdown" in data:
        return ROOM - 2.5  # and a table, but for a heading
    if "image/png" in data:
        return 11.0
    if "text/latex" in data:
        return 3.0
    return 0.9 * len(data.get("text/plain", "").splitlines()) + 0.7
