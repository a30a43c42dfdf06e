"""Make a reveal.js deck of each chapter, from its stored outputs and panels.

OUTPUT/index.html lists the decks, and all open from the disk with no network. Each cell's metadata
slideshow.slide_type, as Jupyter's editors show it, says which part it plays.
"""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import nbformat
from build import BOOK, NPM_FILES, ROOT, arguments, copy_javascript, install_javascript
from nbconvert.exporters import SlidesExporter
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
    """Write the decks of the chapters given by number, or of all, what they load, and a list."""
    paths = sorted(NOTEBOOKS.glob("[0-9][0-9]_*.ipynb"))
    if missing := sorted(set(chapters) - {path.name[:2] for path in paths}):
        raise SystemExit(
            f"no chapter {', '.join(missing)}: two digits each, such as 00 04, are needed, "
            "and OUTPUT before --chapters"
        )
    install_javascript()
    copy_javascript(output / "vendor", NPM_FILES | {"reveal": REVEAL_FILES})
    for path in BESIDE:
        shutil.copy(path, output)
    for stale in output.glob("*.slides.html") if not chapters else ():
        stale.unlink()
    exporter = SlidesExporter(
        extra_template_basedirs=[str(BOOK)],
        template_name="deck",
        exclude_input_prompt=True,
        exclude_output_prompt=True,
    )
    for path in paths:
        if not chapters or path.name[:2] in chapters:
            deck = output / f"{path.stem}.slides.html"
            notebook = prepared(nbformat.read(path, as_version=4))
            deck.write_text(exporter.from_notebook_node(notebook)[0], encoding="utf-8")
            print(deck, flush=True)
    decks = sorted(output.glob("*.slides.html"))
    (output / "index.html").write_text(contents(decks), encoding="utf-8")
    print(output / "index.html")


def prepared(notebook: NotebookNode) -> NotebookNode:
    """Return the notebook with a title, solutions as notes, and links to the other decks."""
    title = next(line for line in notebook.cells[0].source.splitlines() if line.startswith("# "))
    notebook.metadata["title"] = title[2:]
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            cell.source = LINK.sub(_deck_link, cell.source)
            if cell.source.startswith("**Figure "):
                cell.source = f'<div class="caption">\n\n{cell.source}\n\n</div>'
        for output in cell.get("outputs", ()):
            if "text/markdown" in output.get("data", {}):
                output.data["text/markdown"] = LINK.sub(_deck_link, output.data["text/markdown"])
    notebook.cells = [part for cell in notebook.cells for part in _with_solution_in_notes(cell)]
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
    """Lead to a chapter's deck; turn a link into the book, which may be absent, into words."""
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
    parser = arguments(__doc__, BOOK / "_build" / "slides")
    said = "only these, such as 00 04"
    parser.add_argument("--chapters", nargs="+", default=[], metavar="NN", help=said)
    given = parser.parse_args()
    main(given.output.resolve(), given.chapters)
