"""Every formula of every chapter and assignment, as JupyterLab renders it where it stands.

What stands beside it must not get into it (a quote's `>` did), nor may it stay raw or fail: each
cell's formulas have the same symbols as when they stand alone, in a cell of their own.
"""

from __future__ import annotations

import re

import nbformat
import pytest
from live import PATIENCE, ROOT, chapters, jupyterlab, link
from markdown_it import MarkdownIt
from mdit_py_plugins.dollarmath import dollarmath_plugin

# Of each cell, in order: its formulas as the symbols in them, and the text around them.
RENDERED = r"""() => [
    ...document.querySelectorAll('.jp-MarkdownCell .jp-RenderedMarkdown')
].map(cell => ({
    formulas: [...cell.querySelectorAll('mjx-container')].map(it =>
        [...it.querySelectorAll('mjx-assistive-mml :is(mi, mo, mn, mtext, merror)')]
            .map(leaf => leaf.localName + leaf.textContent).join(' ')),
    red: cell.querySelectorAll('mjx-merror, merror, [data-mjx-error], [mathcolor=red]').length,
    text: (copy => {
        copy.querySelectorAll('mjx-container, code, pre').forEach(it => it.remove());
        return copy.textContent;
    })(cell.cloneNode(true)),
}))"""
pytestmark = pytest.mark.slow
RAW = re.compile(r"\$|\\[a-zA-Z({\[]")


def formulas(source: str) -> list[str]:
    """The formulas of a Markdown text, in their order, by another parser than those tested."""
    parser = MarkdownIt().enable("table").use(dollarmath_plugin, double_inline=True)
    matches = []
    for token in parser.parse(source):
        for it in (token, *(token.children or ())):
            if it.type == "math_inline":
                matches.append(f"${it.content}$")
            elif it.type.startswith("math"):
                matches.append(f"$${' '.join(it.content.split())}$$")
    return matches


@pytest.fixture(scope="module")
def cells():
    """The Markdown cells of chapters and assignments: where they are, their source, formulas."""
    every = [
        (f"{path.parent.name} {path.stem} [{place}]", cell.source, formulas(cell.source))
        for path in (*chapters(), *(ROOT / "book/course/source").glob("*/*.ipynb"))
        for place, cell in enumerate(nbformat.read(path, as_version=4).cells)
        if cell.cell_type == "markdown"
    ]
    return [cell for cell in every if cell[2]]


@pytest.fixture(scope="module")
def home(cells, tmp_path_factory):
    """A folder with one notebook of them all, and at its end each formula in a cell of its own."""
    folder = tmp_path_factory.mktemp("formulas")
    sources = [source for _, source, _ in cells] + list(apart(cells))
    notebook = nbformat.v4.new_notebook(cells=list(map(nbformat.v4.new_markdown_cell, sources)))
    notebook.metadata["kernelspec"] = {"name": "python3", "display_name": "Python 3"}
    nbformat.write(notebook, folder / "formulas.ipynb")
    return folder


def apart(cells) -> dict[str, None]:
    """Every formula once, in order."""
    return dict.fromkeys(formula for *_, alone in cells for formula in alone)


def faults(page, cells) -> list[str]:
    """What is wrong with the formulas that a page shows, a sentence each."""
    count = len(cells) + len(apart(cells))
    drawn = """count => [...document.querySelectorAll('.jp-MarkdownCell')].filter(
        cell => cell.querySelector('mjx-container mjx-assistive-mml')).length === count"""
    page.wait_for_function(drawn, arg=count, timeout=PATIENCE, polling=500)
    shown, wrong = page.evaluate(RENDERED), []
    alone = [cell["formulas"] for cell in shown[len(cells) :]]
    right = dict(zip(apart(cells), alone, strict=True))
    for (where, _, wanted), there in zip(cells, shown, strict=False):
        if len(there["formulas"]) != len(wanted):
            wrong.append(f"{where}: {len(there['formulas'])} of {len(wanted)} formulas")
        wrong += [
            f"{where}: {formula} shows {seen}"
            for formula, seen in zip(wanted, there["formulas"], strict=False)
            if [seen] != right[formula]
        ]
        if there["red"] or RAW.search(there["text"]):
            wrong.append(f"{where}: an error, or raw TeX: {RAW.search(there['text'])}")
    return wrong


def test_jupyterlab_renders_every_formula(home, cells, browser_page):
    with jupyterlab(home, "--config=book/lab/jupyter_lab_config.py") as url:
        token = link(home).partition("?")[2]
        browser_page.goto(f"{url}lab/tree/formulas.ipynb?reset&{token}", timeout=PATIENCE)
        assert faults(browser_page, cells) == []
        browser_page.goto("about:blank")  # it would miss its server
