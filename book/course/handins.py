"""What a student handed in, and the released notebook with their answers in it."""

from __future__ import annotations

import re
import warnings
from collections import defaultdict
from pathlib import Path
from unicodedata import normalize

import nbformat
from cells import compiles, defined, grade_id, nbgrader
from nbformat import NotebookNode
from nbformat.warnings import DuplicateCellId, MissingIDFieldWarning

NAME = re.compile(r"""^name *= *["'](.*)["']""", re.MULTILINE)
MOST_BYTES = 10_000_000  # a release has 20 kB; a hundred figures fit, and nesting stays readable
for harmless in DuplicateCellId, MissingIDFieldWarning:  # a copied cell, an older notebook
    warnings.simplefilter("ignore", harmless)


class Refused(Exception):  # noqa: N818  (it is an answer, not a fault)
    """Why a hand-in can't be graded; the lecturer reads the sentence."""


def assignments(course: Path) -> dict[str, Path]:
    """The assignments of a course, and the lecturer's notebook of each."""
    return {path.parent.name: path for path in sorted(course.glob("source/*/*.ipynb"))}


def write(path: Path, content: str | bytes) -> None:
    """Write a file whole or not at all, also in the place of one that can't be written to."""
    path.parent.mkdir(parents=True, exist_ok=True)
    new = path.with_name(f".{path.name}.new")
    new.write_bytes(content if isinstance(content, bytes) else content.encode())
    new.replace(path)


def find(folder: Path, name: str) -> tuple[Path, list[str]]:
    """Return the notebook of a folder, and what is odd about its name; raises Refused."""
    if not folder.is_dir() or folder.is_symlink():
        raise Refused("not a folder; submitted/NAME/ASSIGNMENT/NOTEBOOK is needed")
    found = sorted(p for p in folder.glob("*.ipynb") if not p.name.startswith("."))
    if not found:
        raise Refused(f"no notebook in its folder; {name} is needed")
    path = folder / name if folder / name in found else found[0]
    names = ", ".join(each.name for each in found)
    if path.name != name and len(found) > 1:
        raise Refused(f"which is it? {names}; {name} is needed")
    odd = [f"was named {path.name}"] * (path.name != name)
    return path, [*odd, *[f"{path.name} was taken of {names}"] * (len(found) > 1)]


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

    An answer is found by its grade_id, or else by its cell's id, by a name that it defines or, if
    it is a text, by its place. Cells of the student's own stay where they were, and no stub is put
    back that would undo what they define. Raises Refused if nothing is of this release.
    """
    ids = [grade_id(cell) for cell in release.cells]
    asked = dict(zip(ids, release.cells, strict=True))
    answers = {name: [] for name, cell in asked.items() if nbgrader(cell).get("solution")}
    checks = {name for name, cell in asked.items() if nbgrader(cell).get("grade")} - {*answers}
    places = list(_places(handed_in.cells, asked, answers, checks))
    own, how, last, done = defaultdict(list), defaultdict(list), None, set()
    due = {name: next((c for c in ids[k:] if c in checks), None) for k, name in enumerate(ids)}
    seen = [name for name, _ in places if name]
    order, after = {name: k for k, name in enumerate(ids)}, _following([n for n, _ in places])
    foreign = {grade_id(cell) for cell in handed_in.cells} - {None, *ids}
    if len(foreign) >= len({*answers, *checks} & set(seen)):
        raise Refused("its cells are not of this assignment")
    for (name, by), cell, ahead in zip(places, handed_in.cells, after, strict=True):
        done |= checks & {name}
        if ahead and last and order[ahead] < order[last]:  # what follows here comes earlier there
            last = ids[order[ahead] - 1] if order[ahead] else None
        if name in answers and due[name] in done and {*answers[name]} - {asked[name].source}:
            how["copies dropped:"].append(name)  # it came too late for the check
        elif name in answers:
            answers[name].append(cell.source)
            if by != "grade_id":
                how["found without its metadata:"].append(name)
            elif cell.cell_type != asked[name].cell_type:
                how[f"was not a {asked[name].cell_type} cell:"].append(name)
        elif name is None and last in answers and _continues(answers[last], cell):
            answers[last].append(cell.source)
        elif name is None:
            own[last].append(_own(cell))
        elif name not in checks and _changed(asked[name], cell):
            own[name].append(_own(cell))
        elif _changed(asked[name], cell) and defined(rest := _added(asked[name], cell)):
            own[last].append(nbformat.v4.new_code_cell(rest))  # before the check
        last = name or last
    result = nbformat.from_dict(release)
    result.cells = own[None]
    whole = {name: _joined(parts, asked[name]) for name, parts in answers.items()}
    made = [defined(source) for name, (source, _) in whole.items() if answers[name]]
    made += [defined(c.source) for cells in own.values() for c in cells if c.cell_type == "code"]
    for name, cell in asked.items():
        cell = nbformat.from_dict(cell)
        if name in answers:
            stub, (cell.source, said) = defined(cell.source), whole[name]
            if said == "is missing:" and stub and stub <= set().union(*made):
                cell.source, said = "# another cell has it", "is in another cell:"
            if said:
                how[said].append(name)
        elif cell.cell_type == "code" and name not in seen:
            how["put back:"].append(name)
        elif seen.count(name) > 1 and cell.cell_type == "code":
            how["copies dropped:"].append(name)
        result.cells += [cell, *own[name]]
    return result, [f"{what} {', '.join(dict.fromkeys(names))}" for what, names in how.items()]


def misnamed(notebook: NotebookNode, student: str) -> list[str]:
    """Say so if the name in a notebook, which its numbers are made from, is not the student's."""
    for cell in notebook.cells:
        given = NAME.search(cell.source) if grade_id(cell) == "name" else None
        if given and _plain(given[1]) != _plain(student):
            return [f'its name is "{given[1]}": points may be lost by it']
    return []


def _plain(name: str) -> str:
    return normalize("NFC", name).strip().casefold()


def _places(cells, asked, answers, checks):
    """Which released cell each cell is, and by what it was known; (None, "") if it is none.

    A guess must keep the order in which cells run: it stands between those that are known.
    """
    at = {name: k for k, name in enumerate(asked)}
    by_cell_id = {cell.id: name for name, cell in asked.items()}
    by_text = {cell.source.strip(): name for name, cell in asked.items() if name not in answers}
    by_name = {each: name for name in answers for each in defined(asked[name].source)}
    texts = [name for name in answers if asked[name].cell_type == "markdown"]
    ids = [name if (name := grade_id(cell)) in asked else None for cell in cells]
    here, known, last = {*ids}, [], None
    for name, cell in zip(ids, cells, strict=True):
        alike = by_text.get(cell.source.strip())
        if not (name or alike) and cell.cell_type == "code":  # or something was added to it
            alike = next((it for it in checks if asked[it].source in cell.source), None)
        known.append(name or (alike if alike not in here else None))

    def between(guesses, last, after):
        low, high = at.get(last, -1), at.get(after, len(at))
        fit = [it for it in guesses if it and it not in here and low <= at[it] < high]
        return min(fit, key=at.get, default=None)

    for k, (cell, after) in enumerate(zip(cells, _following(known), strict=True)):
        if cell.cell_type == "markdown" and not known[k]:
            known[k] = between(texts, last, after)
        last = known[k] or last
    runs = [name if name and asked[name].cell_type == "code" else None for name in known]
    last = None
    for name, sure, cell, after in zip(ids, known, cells, _following(runs), strict=True):
        guesses = [] if name else [by_cell_id.get(str(cell.get("id")))]
        if cell.cell_type == "code" and name not in answers:
            guesses += map(by_name.get, defined(cell.source))
        found = between(guesses, last, sure or after) or sure
        last = found if found and asked[found].cell_type == "code" else last
        yield found, "" if not found else "grade_id" if found == name else "guess"


def _following(names: list[str | None]) -> list[str | None]:
    """For each place, the next name behind it."""
    found, after = [], None
    for name in reversed(names):
        found.append(after)
        after = name or after
    return found[::-1]


def _changed(given: NotebookNode, cell: NotebookNode) -> bool:
    """Whether it is a given cell of code that the student has changed."""
    return given.cell_type == cell.cell_type == "code" and cell.source != given.source


def _added(given: NotebookNode, cell: NotebookNode) -> str:
    """What the student has written into a given cell, or the whole if that is not to be told."""
    return cell.source.replace(given.source, "", 1)


def _joined(parts: list[str], given: NotebookNode) -> tuple[str, str]:
    """Make one answer of the cells that bear its grade_id, and say what was done."""
    if not parts:
        return given.source, "is missing:"
    tried = [part for part in dict.fromkeys(parts) if part != given.source] or [given.source]
    if len(parts) == 1 or len(tried) == 1:
        return tried[0], "copies dropped:" if len(parts) > 1 else ""
    if given.cell_type != "code":
        return "\n\n".join(tried), "its parts joined:"
    whole = "\n".join(tried)
    if not compiles(whole):  # of a copy that is broken, the other one counts
        whole = "\n".join(filter(compiles, tried)) or tried[-1]
    return whole, "its parts joined:"


def _continues(parts: list[str], cell: NotebookNode) -> bool:
    """Whether a cell is the second half of one that was split: alone it is no program."""
    whole = "\n".join([*parts, cell.source])
    return cell.cell_type == "code" and not compiles(cell.source) and compiles(whole)


def _own(cell: NotebookNode) -> NotebookNode:
    """A cell of the student's own: its text, and none of its metadata."""
    make = getattr(nbformat.v4, f"new_{cell.cell_type}_cell", nbformat.v4.new_raw_cell)
    return make(cell.source)
