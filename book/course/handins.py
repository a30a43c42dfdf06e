"""What a student handed in, and the released notebook with their answers in it."""

from __future__ import annotations

import re
import warnings
from collections import defaultdict
from pathlib import Path
from unicodedata import normalize

import nbformat
from IPython.core.inputtransformer2 import TransformerManager
from nbformat import NotebookNode
from nbformat.warnings import DuplicateCellId, MissingIDFieldWarning

NAME = re.compile(r"""^name *= *["'](.*)["']""", re.MULTILINE)
MOST_BYTES = 50_000_000
for harmless in DuplicateCellId, MissingIDFieldWarning:  # a copied cell, an older notebook
    warnings.simplefilter("ignore", harmless)


class Refused(Exception):  # noqa: N818  (it is an answer, not a fault)
    """Why a hand-in can't be graded; the lecturer reads the sentence."""


def find(folder: Path, name: str) -> tuple[Path, list[str]]:
    """Return the notebook of a folder, and what is odd about its name; raises Refused."""
    if not folder.is_dir() or folder.is_symlink():
        raise Refused("not a folder; submitted/NAME/ASSIGNMENT/NOTEBOOK is needed")
    found = sorted(p for p in folder.glob("*.ipynb") if not p.name.startswith("."))
    if not found:
        raise Refused(f"no notebook in its folder; {name} is needed")
    path = folder / name if folder / name in found else found[0]
    if path.name != name and len(found) > 1:
        names = ", ".join(each.name for each in found)
        raise Refused(f"which is it? {names}; {name} is needed")
    return path, [] if path.name == name else [f"was named {path.name}"]


def read(path: Path) -> NotebookNode:
    """Read a notebook of any format; raises Refused if it is none."""
    if path.is_symlink() or not path.is_file():
        raise Refused(f"{path.name} is not a file")
    size = path.stat().st_size
    if not size:
        raise Refused(f"{path.name} is empty")
    if size > MOST_BYTES:
        raise Refused(f"{path.name} has {size // 1_000_000} MB; clear its outputs")
    try:
        notebook = nbformat.reads(path.read_text(encoding="utf-8-sig"), as_version=4)
        for cell in notebook.cells:
            if not isinstance(cell.source, str) or not isinstance(cell.metadata, dict):
                raise TypeError("a cell has no text")
    except (OSError, UnicodeDecodeError) as error:
        raise Refused(f"{path.name} can't be read: {error}") from None
    except Exception as error:  # what a broken file raises depends on where it is broken
        reason = f"{type(error).__name__}: {error}".splitlines()[0][:100]
        raise Refused(f"{path.name} is no notebook: {reason}") from None
    return notebook


def repaired(handed_in: NotebookNode, release: NotebookNode) -> tuple[NotebookNode, list[str]]:
    """Return the release with the student's answers, and what had to be repaired.

    An answer is found by its grade_id, or else by its cell's id or by the name that it defines.
    Cells of the student's own stay where they were. Raises Refused if nothing is of this release.
    """
    ids = [_grade_id(cell) for cell in release.cells]
    asked = dict(zip(ids, release.cells, strict=True))
    answers = {name: [] for name, cell in asked.items() if _nbgrader(cell).get("solution")}
    checks = {name for name, cell in asked.items() if _nbgrader(cell).get("grade")}
    places = list(_places(handed_in.cells, asked, answers))
    own, how, last, done = defaultdict(list), defaultdict(list), None, set()
    due = {name: next((c for c in ids[k:] if c in checks), None) for k, name in enumerate(ids)}
    seen = [name for name, _ in places if name]
    foreign = {_grade_id(cell) for cell in handed_in.cells} - {None, *ids}
    if len(foreign) >= len({*answers, *checks} & set(seen)):
        raise Refused("its cells are not of this assignment")
    for (name, by), cell in zip(places, handed_in.cells, strict=True):
        done |= checks & {name}
        if name in answers and due[name] in done and {*answers[name]} - {asked[name].source}:
            how["copies dropped:"].append(name)  # it came too late for the check
        elif name in answers:
            answers[name].append(cell.source)
            if by != "grade_id":
                how["found without its metadata:"].append(name)
            elif cell.cell_type != "code":
                how["was not a code cell:"].append(name)
        elif name is None and last in answers and _continues(answers[last], cell):
            answers[last].append(cell.source)
        elif name is None or _changed(asked[name], cell):
            own[last if name is None else name].append(cell)
        last = name or last
    result = nbformat.from_dict(release)
    result.cells = [_own(cell) for cell in own[None]]
    for name, cell in asked.items():
        cell = nbformat.from_dict(cell)
        if name in answers:
            cell.source, said = _joined(answers[name], cell.source)
            if said:
                how[said].append(name)
        elif cell.cell_type == "code" and name not in seen:
            how["put back:"].append(name)
        elif seen.count(name) > 1 and cell.cell_type == "code":
            how["copies dropped:"].append(name)
        result.cells += [cell, *map(_own, own[name])]
    return result, [f"{what} {', '.join(dict.fromkeys(names))}" for what, names in how.items()]


def misnamed(notebook: NotebookNode, student: str) -> list[str]:
    """Say so if the name in a notebook, which its numbers are made from, is not the student's."""
    for cell in notebook.cells:
        given = NAME.search(cell.source) if _grade_id(cell) == "name" else None
        if given and _plain(given[1]) != _plain(student):
            return [f'its name is "{given[1]}": points may be lost by it']
    return []


def _plain(name: str) -> str:
    return normalize("NFC", name).strip().casefold()


def _places(cells, asked, answers):
    """Which released cell each cell is, and by what it was known; (None, "") if it is none."""
    known = [_grade_id(cell) for cell in cells]
    by_cell_id = {cell.id: name for name, cell in asked.items()}
    by_text = {cell.source.strip(): name for name, cell in asked.items() if name not in answers}
    by_name = {each: name for name in answers for each in _defined(asked[name].source)}
    for name, cell in zip(known, cells, strict=True):
        guesses = [] if name in asked else [by_cell_id.get(cell.get("id"))]
        guesses.append(by_text.get(cell.source.strip()))
        if cell.cell_type == "code" and name not in answers:
            guesses += map(by_name.get, _defined(cell.source))
        found = next((each for each in guesses if each and each not in known), None)
        if found or name not in asked:
            yield found, "guess" if found else ""
        else:
            yield name, "grade_id"


def _joined(parts: list[str], stub: str) -> tuple[str, str]:
    """Make one answer of the cells that bear its grade_id, and say what was done."""
    if not parts:
        return stub, "is missing:"
    tried = [part for part in dict.fromkeys(parts) if part != stub] or [stub]
    if len(parts) == 1 or len(tried) == 1:
        return tried[0], "copies dropped:" if len(parts) > 1 else ""
    whole = "\n".join(tried)
    if not _compiles(whole):  # of a copy that is broken, the other one counts
        whole = "\n".join(filter(_compiles, tried)) or tried[-1]
    return whole, "its parts joined:"


def _continues(parts: list[str], cell: NotebookNode) -> bool:
    """Whether a cell is the second half of one that was split: alone it is no program."""
    whole = "\n".join([*parts, cell.source])
    return cell.cell_type == "code" and not _compiles(cell.source) and _compiles(whole)


def _changed(given: NotebookNode, cell: NotebookNode) -> bool:
    """Whether it is a given cell, not a check, to which the student has added something."""
    graded = _nbgrader(given).get("grade")
    return given.cell_type == "code" and not graded and cell.source != given.source


def _compiles(source: str) -> bool:
    try:
        compile(TransformerManager().transform_cell(source), "<cell>", "exec")
    except (SyntaxError, ValueError):
        return False
    return True


def _defined(source: str) -> list[str]:
    """The names that a cell defines, found in a text that may not compile."""
    found = re.findall(r"^(?:def\s+(\w+)\s*\(|(\w+)\s*=[^=])", source, re.MULTILINE)
    return [function or value for function, value in found]


def _nbgrader(cell: NotebookNode) -> dict:
    found = cell.metadata.get("nbgrader")
    return found if isinstance(found, dict) else {}


def _grade_id(cell: NotebookNode) -> str | None:
    return _nbgrader(cell).get("grade_id")


def _own(cell: NotebookNode) -> NotebookNode:
    """A cell of the student's own: its text, and none of its metadata."""
    make = getattr(nbformat.v4, f"new_{cell.cell_type}_cell", nbformat.v4.new_raw_cell)
    return make(cell.source)
