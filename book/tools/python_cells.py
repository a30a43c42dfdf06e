"""A Sphinx extension: cells that run in the page, and tasks that are checked there.

The page has Python, sympy and z3, but no numpy, no matplotlib and no code that numba compiles. A
statement of a chapter runs there if nothing that it names comes from one that can't, and a cell if
all that it *shows* can; what else it holds is left out, and the page says so. Nothing is marked by
hand.

Below a chapter's exercises stand graded tasks that can be checked in the page, see page_tasks.py.
Paper shows none of this.
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
from docutils import nodes
from page_tasks import CHAPTER, add_tasks, handed_in
from reference import ancestors

# What the page can import for a chapter. Of wmrlib it has more, for single numbers only.
THERE = {
    *("collections", "functools", "math", "sympy", "z3"),
    *("wmrbook.equations", "wmrbook.grading", "wmrbook.chapters.strict", "wmrlib.symbolic"),
}


class Cell(NamedTuple):
    """A cell as the page gets it; `place` is its index in the notebook."""

    place: int
    source: str
    before: str = ""  # code that must have run and is not shown
    left_out: int = 0  # lines
    checks: tuple[str, ...] = ()
    space: str = "chapter"  # cells of one space share their variables
    name: str = ""  # of an answer that it waits for, by which the page keeps it
    later: bool = False  # its check is not in the page


def runnable(notebook) -> list[Cell]:
    """Return the cells of a chapter that the page can run."""
    made, missing, hidden = [], set(), []
    for place, cell in enumerate(notebook.cells):
        if cell.cell_type != "code" or "task" in cell.metadata:
            continue
        runs, left = [], []
        for statement in _statements(cell.source):
            able = _can_run(statement, missing)
            (runs if able else left).append(statement)
            missing = missing - _binds(statement) if able else missing | _touches(statement)
        shows = [it for it in runs if _shows(it)]
        if cell.outputs and shows and not any(map(_shows, left)) and _tells(shows, left):
            lines = cell.source.splitlines()
            cut = {i for it in left for i in range(it.lineno - 1, it.end_lineno)}
            kept = "\n".join(line for i, line in enumerate(lines) if i not in cut).strip("\n")
            asked = re.search(r"grading\.(exercises\.\w+)", kept)
            name = asked[1] if asked else ""
            made.append((Cell(place, kept, left_out=len(cut), name=name), runs, hidden))
            hidden = []
        else:
            hidden = hidden + runs
    return _with_what_they_need(made)


def _with_what_they_need(made) -> list[Cell]:
    """Put before each cell what it needs of the cells that are not run."""
    cells, needed, imported = [], set(), set()
    for _, runs, hidden in made:
        imports = (it for it in (*hidden, *runs) if isinstance(it, ast.Import | ast.ImportFrom))
        imported = imported.union(*map(_binds, imports))
    for cell, runs, hidden in reversed(made):
        needed |= imported if cell.name else set()  # an answer may name any of them
        for statement in reversed(runs):
            needed |= _reads(statement)
        before = []
        for statement in reversed(hidden):
            if _touches(statement) & needed:
                before.insert(0, ast.unparse(statement))
                needed |= _reads(statement)
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


def _can_run(statement: ast.stmt, missing: set[str]) -> bool:
    return not _reads(statement) & missing and all(map(_is_there, ast.walk(statement)))


def _is_there(node: ast.AST) -> bool:
    if isinstance(node, ast.Import):
        return {it.name for it in node.names} <= THERE
    if isinstance(node, ast.ImportFrom):
        wanted = ({node.module, f"{node.module}.{it.name}"} for it in node.names)
        return not any(map(THERE.isdisjoint, wanted))
    return True


def _reads(statement: ast.stmt) -> set[str]:
    """The names that it takes from outside, and not those that it has given a value itself."""
    own = {statement.name} if isinstance(statement, ast.FunctionDef) else set()
    return _loads(compile(ast.Module([statement], []), "cell", "exec")) - own


def _loads(code: CodeType) -> set[str]:
    """The global names that it loads before it stores them; the compiler knows the local ones."""
    loads, own = set(), set()
    for step in dis.get_instructions(code):
        if isinstance(step.argval, CodeType):  # a function
            loads |= _loads(step.argval) - own
        elif step.opname in ("STORE_NAME", "STORE_GLOBAL"):
            own.add(step.argval)
        elif step.opname in ("LOAD_NAME", "LOAD_GLOBAL", "DELETE_NAME"):
            loads |= {step.argval} - own
    return loads


def _binds(statement: ast.stmt) -> set[str]:
    """The names that a statement gives a value, or a part of one; not those inside functions."""
    names, waiting = set(), [statement]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            names.add(node.name)
        elif isinstance(node, ast.Import | ast.ImportFrom):
            names |= {(it.asname or it.name).partition(".")[0] for it in node.names}
        else:
            if isinstance(getattr(node, "ctx", None), ast.Store):
                names |= _root(node)
            waiting += ast.iter_child_nodes(node)
    return names


def _touches(statement: ast.stmt) -> set[str]:
    """These, and those that it may change by a method, such as a list by `append`."""
    alone = (node.value for node in ast.walk(statement) if isinstance(node, ast.Expr))
    calls = (node.func for node in alone if isinstance(node, ast.Call))
    methods = (_root(call) for call in calls if isinstance(call, ast.Attribute))
    return _binds(statement).union(*methods)


def _root(node: ast.AST) -> set[str]:
    while isinstance(node, ast.Attribute | ast.Subscript | ast.Starred):
        node = node.value
    return {node.id} if isinstance(node, ast.Name) else set()


def _shows(statement: ast.stmt) -> bool:
    prints = any(isinstance(node, ast.Name) and node.id == "print" for node in ast.walk(statement))
    return isinstance(statement, ast.Expr) or prints


def _tells(shows: list[ast.stmt], left: list[ast.stmt]) -> bool:
    """Whether it shows more than words, which may stand for what is left out."""
    return not left or any(_reads(it) - {"print"} for it in shows)


def give_cells(app, doctree):
    """Tell the page which of its cells run, and what they need."""
    if not CHAPTER.match(app.env.docname):
        return
    text = [Path(app.env.doc2path(app.env.docname)).read_text(encoding="utf-8")]
    add_tasks(app, app.env.docname, text)
    notebook = nbformat.reads(text[0], as_version=4)
    cells = {cell.place: cell for cell in runnable(notebook)}
    for place, cell in enumerate(notebook.cells):
        if task := cell.metadata.get("task"):
            known = {"checks": tuple(task["checks"]), "space": "tasks"}
            cells[place] = Cell(place, cell.source, **(task | known))
    section = None
    for container in list(doctree.findall(nodes.container)):
        if cell := cells.get(container.get("cell_index")):
            container += _data("python-cell", cell._asdict())
            if cell.space == "tasks":
                section = next(it for it in ancestors(container) if isinstance(it, nodes.section))
                section["classes"].append("python-task")
    if section and (given := handed_in(CHAPTER.match(app.env.docname)[1])):
        section += _data("python-hand-in", given)


def _data(kind: str, given: dict) -> nodes.raw:
    text = json.dumps(given, ensure_ascii=False).replace("</", "<\\/")
    script = f'<script type="application/json" class="{kind}">{text}</script>'
    return nodes.raw("", script, format="html")


def leave_out_of_print(app, doctree, docname):
    """On paper nothing can be checked."""
    if app.builder.name != "html":
        for section in list(doctree.findall(nodes.section)):
            if "python-task" in section["classes"]:
                section.parent.remove(section)


def add_scripts(app, docname, template, context, doctree):
    """Load what runs cells where there are any."""
    if app.builder.name == "html" and "python-cell" in context.get("body", ""):
        app.add_js_file("python_cells.js")
        app.add_js_file("hand_in.js")
        app.add_css_file("python_cells.css")


def setup(app):
    app.connect("source-read", add_tasks)
    app.connect("doctree-read", give_cells, priority=400)
    app.connect("doctree-resolved", leave_out_of_print)
    app.connect("html-page-context", add_scripts)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
