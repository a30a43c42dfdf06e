"""Make a reveal.js deck of each chapter: OUTPUT/index.html lists them, and all open from the disk with no network.

With --mark, make none: give the cells of the notebooks named the slide types that their authors have not given them.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
from pathlib import Path

import marks
import nbformat
from build import BOOK, NPM_FILES, ROOT, copy_javascript, environment, install_javascript
from nbconvert.exporters import SlidesExporter
from nbconvert.preprocessors import ExecutePreprocessor
from nbformat import NotebookNode

NOTEBOOKS = ROOT / "notebooks"
REVEAL_FILES = (
    "reveal.js/dist/re*.css",
    "reveal.js/dist/reveal.js",
    "reveal.js/plugin/notes/notes.js",
    "reveal.js/LICENSE",
)
BESIDE = (
    BOOK / "mathjax.js",
    BOOK / "_static" / "widgets.js",
    BOOK / "deck" / "deck.css",
    BOOK / "deck" / "deck.js",
)
SOLUTION = re.compile(r"\n*<details><summary>Solution</summary>\n\n(.*?)\n\n</details>", re.DOTALL)
LINK = re.compile(r"(?<!!)\[([^\]]+)\]\(([^)\s]+)\)")


def main(output: Path, chapters: list[str]) -> None:
    """Execute the chapters whose numbers are given, or all, and write their decks, what they load, and their list."""
    paths = sorted(NOTEBOOKS.glob("[0-9][0-9]_*.ipynb"))
    if missing := sorted(set(chapters) - {path.name[:2] for path in paths}):
        raise SystemExit(
            f"no chapter {', '.join(missing)}: two digits each, such as 00 04, are needed, and OUTPUT before --chapters"
        )
    install_javascript()
    copy_javascript(output / "vendor", NPM_FILES | {"reveal": REVEAL_FILES})
    for path in BESIDE:
        shutil.copy(path, output)
    for stale in output.glob("*.slides.html") if not chapters else ():
        stale.unlink()
    for path in paths:
        if not chapters or path.name[:2] in chapters:
            notebook = prepared(executed(path))
            exporter = SlidesExporter(
                extra_template_basedirs=[str(BOOK)],
                template_name="deck",
                exclude_input_prompt=True,
                exclude_output_prompt=True,
            )
            (output / f"{path.stem}.slides.html").write_text(
                exporter.from_notebook_node(notebook)[0], encoding="utf-8"
            )
            print(output / f"{path.stem}.slides.html", flush=True)
    (output / "index.html").write_text(
        contents(sorted(output.glob("*.slides.html"))), encoding="utf-8"
    )
    print(output / "index.html")


def executed(path: Path) -> NotebookNode:
    """The notebook with the outputs of now, and the whole state of its widgets."""
    os.environ.update(environment())  # the kernel inherits it
    notebook = nbformat.read(path, as_version=4)
    ExecutePreprocessor(timeout=120, store_widget_state=True).preprocess(
        notebook, {"metadata": {"path": str(path.parent)}}
    )
    return notebook


def prepared(notebook: NotebookNode) -> NotebookNode:
    """The notebook as a deck wants it: every cell typed, solutions as notes, links to other decks, and with a title."""
    cells = [part for cell in notebook.cells for part in marks.divided(cell)]
    for cell, kind in zip(cells, marks.slide_types(cells), strict=True):
        cell.metadata["slideshow"] = {"slide_type": kind}
        if cell.cell_type == "markdown":
            cell.source = LINK.sub(_deck_link, cell.source)
        for output in cell.get("outputs", ()):
            if "text/markdown" in output.get("data", {}):
                output.data["text/markdown"] = LINK.sub(_deck_link, output.data["text/markdown"])
    notebook.metadata["title"] = next(
        line for line in cells[0].source.splitlines() if line.startswith("# ")
    )[2:]
    notebook.cells = [part for cell in cells for part in _with_solution_in_notes(cell)]
    return notebook


def contents(decks: list[Path]) -> str:
    """The page that lists the decks and says which keys they know."""
    titles = {
        path.name: re.search("<title>(.*?)</title>", path.read_text(encoding="utf-8"))[1]
        for path in decks
    }
    items = "\n".join(
        f'<li>{int(name[:2])}. <a href="{name}">{title}</a></li>' for name, title in titles.items()
    )
    return (
        (BOOK / "deck" / "contents.html")
        .read_text(encoding="utf-8")
        .replace("<!-- decks -->", items)
    )


def _deck_link(link: re.Match) -> str:
    """A link to a chapter leads to its deck; one into the book, which need not be there, becomes its words."""
    words, address = link.groups()
    if chapter := re.fullmatch(r"(\d\d_\w+)\.ipynb(?:#.*)?", address):
        return f"[{words}]({chapter[1]}.slides.html)"
    return link[0] if address.startswith("https://") else words


def _with_solution_in_notes(cell: NotebookNode) -> list[NotebookNode]:
    solution = SOLUTION.search(cell.source) if cell.cell_type == "markdown" else None
    if not solution:
        return [cell]
    notes = nbformat.v4.new_markdown_cell(
        f"**Solution.** {solution[1]}", metadata={"slideshow": {"slide_type": "notes"}}
    )
    cell.source = SOLUTION.sub("", cell.source)
    return [cell, notes]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    default = BOOK / "_build" / "slides"
    parser.add_argument(
        "output",
        nargs="?",
        type=Path,
        default=default,
        metavar="OUTPUT",
        help="a folder; book/_build/slides by default",
    )
    parser.add_argument(
        "--chapters", nargs="+", default=[], metavar="NN", help="only these, such as 00 04"
    )
    parser.add_argument(
        "--mark",
        nargs="+",
        type=Path,
        metavar="NOTEBOOK",
        help="fill in the slide types that are missing in these",
    )
    arguments = parser.parse_args()
    if arguments.mark:
        for notebook in arguments.mark:
            marks.mark(notebook)
    else:
        main(arguments.output.resolve(), arguments.chapters)
