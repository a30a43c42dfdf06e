"""A Sphinx extension: cells that run in the page.

The page has Python, sympy and z3, but no numpy, no matplotlib and no code that numba compiles. A
statement of a chapter runs there if nothing that it names comes from one that can't, and a cell if
all that it *shows* can; what else it holds is left out, and the page says so. Nothing is marked by
hand.
"""

from __future__ import annotations

import ast
import dis
import json
import re
from collections.abc import Iterator
from pathlib import Path
from types import CodeType
from typing import NamedTuple

import nbformat
import plain_symbolic
from docutils import nodes

CHAPTER = re.compile(r"notebooks/(\d\d)_")
# What the page can import for a chapter; of wmrlib.symbolic it has less than the library.
THERE = {"math", "sympy", "wmrbook.equations", "wmrbook.chapters.strict", "wmrlib.symbolic"}


class Cell(NamedTuple):
    """A cell as the page gets it; `place` is its index in the notebook."""

    place: int
    source: str
    before: str = ""  # code that must have run and is not shown
    left_out: int = 0  # lines


def runnable(notebook) -> list[Cell]:
    """Return the cells of a chapter that the page can run."""
    made, missing, hidden = [], set(), []
    for place, cell in enumerate(notebook.cells):
        if cell.cell_type != "code":
            continue
        runs, left = [], []
        for statement in _statements(cell.source):
            reads, binds = _names(statement)
            able = not reads & missing and all(map(_is_there, ast.walk(statement)))
            (runs if able else left).append(statement)
            missing = missing - binds if able else missing | _touches(statement)
        shows = [it for it in runs if _shows(it)]
        if cell.outputs and shows and not any(map(_shows, left)) and _tells(shows, left):
            lines = cell.source.splitlines()
            cut = {i for it in left for i in range(it.lineno - 1, it.end_lineno)}
            source = "\n".join(line for i, line in enumerate(lines) if i not in cut).strip("\n")
            made.append((Cell(place, source, left_out=len(cut)), runs, hidden))
            hidden = []
        else:
            hidden = hidden + runs
    return _with_what_they_need(made)


def _with_what_they_need(made) -> list[Cell]:
    """Put before each cell what it needs of the cells that are not run."""
    cells, needed = [], set()
    for cell, runs, hidden in reversed(made):
        needed = needed.union(*(_names(statement)[0] for statement in runs))
        before = []
        for statement in reversed(hidden):
            if _touches(statement) & needed:
                before.insert(0, ast.unparse(statement))
                needed |= _names(statement)[0]
        cells.insert(0, cell._replace(before="\n".join(before)))
    return cells


def _statements(source: str) -> Iterator[ast.stmt]:
    """The statements of a cell; of an import from a package, one for each name."""
    for statement in ast.parse(source).body:
        if isinstance(statement, ast.ImportFrom):
            for name in statement.names:
                yield ast.copy_location(ast.ImportFrom(statement.module, [name], 0), statement)
        else:
            yield statement


def _is_there(node: ast.AST) -> bool:
    if isinstance(node, ast.Import):
        return {it.name for it in node.names} <= THERE
    if isinstance(node, ast.ImportFrom):
        return not THERE.isdisjoint({node.module, f"{node.module}.{node.names[0].name}"})
    if isinstance(node, ast.Attribute) and ast.unparse(node.value) == "symbolic":
        return node.attr in plain_symbolic.NAMES
    return True


def _names(statement: ast.stmt) -> tuple[set[str], set[str]]:
    """The names that a statement takes from before it, and those to which it gives a value."""
    reads, binds = _names_of(compile(ast.Module([statement], []), "cell", "exec"))
    calls_itself = {statement.name} if isinstance(statement, ast.FunctionDef) else set()
    return reads - calls_itself, binds


def _names_of(code: CodeType) -> tuple[set[str], set[str]]:
    """The global names that it loads before it stores them, and that it stores."""
    loads, stores = set(), set()
    for step in dis.get_instructions(code):
        if isinstance(step.argval, CodeType):  # a function; the compiler knows its local names
            loads |= _names_of(step.argval)[0] - stores
        elif step.opname in ("STORE_NAME", "STORE_GLOBAL"):
            stores.add(step.argval)
        elif step.opname in ("LOAD_NAME", "LOAD_GLOBAL", "DELETE_NAME"):
            loads |= {step.argval} - stores
    return loads, stores


def _touches(statement: ast.stmt) -> set[str]:
    """The names to which it gives a value, or a part of one, or that a method may change."""
    touched = _names(statement)[1]
    for node in ast.walk(statement):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
            changed = node.value.func  # such as turns.append
        else:
            changed = node if isinstance(getattr(node, "ctx", None), ast.Store) else None
        if isinstance(changed, ast.Attribute | ast.Subscript):
            while isinstance(changed, ast.Attribute | ast.Subscript):
                changed = changed.value
            touched |= {changed.id} if isinstance(changed, ast.Name) else set()
    return touched


def _shows(statement: ast.stmt) -> bool:
    prints = any(isinstance(node, ast.Name) and node.id == "print" for node in ast.walk(statement))
    return isinstance(statement, ast.Expr) or prints


def _tells(shows: list[ast.stmt], left: list[ast.stmt]) -> bool:
    """Whether it shows more than words, which may stand for what is left out."""
    return not left or any(_names(it)[0] - {"print"} for it in shows)


def give_cells(app, doctree):
    """Tell the page which of its cells run, and what they need."""
    if not CHAPTER.match(app.env.docname):
        return
    text = Path(app.env.doc2path(app.env.docname)).read_text(encoding="utf-8")
    cells = {cell.place: cell for cell in runnable(nbformat.reads(text, as_version=4))}
    for container in list(doctree.findall(nodes.container)):
        if cell := cells.get(container.get("cell_index")):
            fields = json.dumps(cell._asdict(), ensure_ascii=False).replace("</", "<\\/")
            script = f'<script type="application/json" class="python-cell">{fields}</script>'
            container += nodes.raw("", script, format="html")


def add_scripts(app, docname, template, context, doctree):
    """Load what runs cells where there are any."""
    if app.builder.name == "html" and "python-cell" in context.get("body", ""):
        app.add_js_file("python_cells.js")
        app.add_css_file("python_cells.css")


def setup(app):
    app.connect("doctree-read", give_cells, priority=400)
    app.connect("html-page-context", add_scripts)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
