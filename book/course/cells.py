"""What a cell is: the program in it, the names that it defines, and its name in the release."""

from __future__ import annotations

import re
import symtable
from functools import lru_cache

from IPython.core.inputtransformer2 import TransformerManager
from nbformat import NotebookNode

MOST_CODE = 100_000  # letters of a cell that may be a program
MOST_MAGIC = 50  # lines of IPython's own in it: it tokenises the whole cell once for each
MAGIC = re.compile(r"^[ \t]*[%!?,;/]|=[ \t]*[%!]|\?[ \t]*$", re.MULTILINE)
UNSEEN = re.compile(
    r"[\0-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff]"
)


def visible(text: str) -> str:
    """A text without what moves a terminal's cursor or turns the order of its letters."""
    return UNSEEN.sub("\ufffd", text.replace("\r\n", "\n"))


@lru_cache(maxsize=1000)
def _program(source: str) -> str | None:
    """A cell as Python, or None if it is no program."""
    if len(source) > MOST_CODE or len(MAGIC.findall(source)) > MOST_MAGIC:
        return None
    try:
        code = TransformerManager().transform_cell(source)
        compile(code, "<cell>", "exec")
    except (SyntaxError, ValueError, RuntimeError, MemoryError):  # deep nesting is the last two
        return None
    return code


def compiles(source: str) -> bool:
    return _program(source) is not None


def defined(source: str) -> set[str]:
    """The names that a cell defines; of one that is no program, those that begin a line."""
    if (code := _program(source)) is None:
        found = re.findall(r"^(?:def\s+(\w+)\s*\(|(\w+)\s*=[^=])", source, re.MULTILINE)
        return {function or value for function, value in found}
    symbols = symtable.symtable(code, "<cell>", "exec").get_symbols()
    return {each.get_name() for each in symbols if each.is_assigned() or each.is_imported()}


def nbgrader(cell: NotebookNode) -> dict:
    found = cell.metadata.get("nbgrader")
    return found if isinstance(found, dict) else {}


def grade_id(cell: NotebookNode) -> str | None:
    found = nbgrader(cell).get("grade_id")
    return found if isinstance(found, str) else None
