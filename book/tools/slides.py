"""Make a reveal.js deck of each chapter, from its stored outputs and panels.

With --lecturer the speaker's notes have the solutions of the exercises. With --questions make one
deck of the concept questions instead, with their answers. Both are for the lecturer alone, in
folders of their own, since the other decks are for everybody.

OUTPUT/index.html lists the decks, and all open from the disk with no network. Each cell's metadata
slideshow.slide_type, as Jupyter's editors show it, says which part it plays. Every slide gets a
title, and one with too many words or two figures goes on as the next.
"""

from __future__ import annotations

import itertools
import re
import shutil
from dataclasses import dataclass
from pathlib import Path

import nbformat
from build import (
    BOOK,
    NPM_FILES,
    ROOT,
    arguments,
    copy_javascript,
    install_javascript,
    without_solutions,
)
from kit import bundle
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
FIGURE = re.compile(r"<img [^>]*viewBox='0 0 ([\d.]+) ([\d.]+)'")
LIVE = "application/vnd.jupyter.widget-view+json"
WORDS = 60  # of prose on a slide, as many as a class reads while somebody talks
ROWS = 13  # of text below a title
TABLE = re.compile(r"^\|", re.MULTILINE)
LETTERS = 1700  # of a table's source, as many as stand on a slide
# Where prose may go on on the next slide: at a paragraph, at an item; in long ones at a sentence.
BLOCK = re.compile(r"(?<![,:])\n\n(?!- |1\. )(?=[^a-z$ ])|(?<!\n)\n(?=- |\d+\. )")
SENTENCE = re.compile(r"(?<!\d)[.?!]\)?\s+(?=[A-Z*\"$])")
QUOTED = re.compile(r"^> ?", re.MULTILINE)
DISPLAYED = re.compile(r"\$\$.*?\$\$", re.DOTALL)
FORMULA = re.compile(r"\$\$.*?\$\$|\$[^$]+\$", re.DOTALL)
HEADING = re.compile(r"(#{1,3} .*)\n*")
LEAD = re.compile(r"\*\*([^*\n]{3,45}?)(?:\.\*\*\s|\*\*\n\n)")
CAPTION = '<div class="caption">\n\n{}\n\n</div>'
LINK = re.compile(r"(?<!!)\[([^\]]+)\]\(([^)\s]+)\)")


@dataclass
class Part:
    """What is not cut: some prose, what a cell prints, or a figure or panel."""

    cell: NotebookNode
    joined: bool = False  # stays on the slide of the part before it
    price: float = 0.0  # of beginning a slide with it, in slides
    words: int = 0
    rows: float = 0.0  # of formulas and print
    columns: int = 0  # of the longest line that is printed
    shape: float = 0.0  # width over height of a figure
    live: bool = False  # a panel


def main(output: Path, chapters: list[str], lecturer: bool = False) -> None:
    """Write the decks of the chapters given by number, or of all, what they load, and a list."""
    paths = sorted(NOTEBOOKS.glob("[0-9][0-9]_*.ipynb"))
    if missing := sorted(set(chapters) - {path.name[:2] for path in paths}):
        raise SystemExit(
            f"no chapter {', '.join(missing)}: two digits each, such as 00 04, are needed, "
            "and OUTPUT before --chapters"
        )
    lay_out(output)
    for stale in output.glob("*.slides.html") if not chapters else ():
        stale.unlink()
    for path in paths:
        if not chapters or path.name[:2] in chapters:
            chapter = nbformat.read(path, as_version=4)
            chapter = chapter if lecturer else without_solutions(chapter)
            write(output / f"{path.stem}.slides.html", chapter)
    decks = sorted(output.glob("*.slides.html"))
    (output / "index.html").write_text(contents(decks), encoding="utf-8")
    print(output / "index.html")


def vote(output: Path) -> None:
    """Write the deck of the concept questions."""
    lay_out(output)
    write(output / "questions.html", questions())


def questions() -> NotebookNode:
    """Return the concept questions, made now, as a notebook."""
    from wmrbook.questions import deck, made

    cells = []
    for kind, content in deck.slides(made()):
        metadata = {"metadata": {"slideshow": {"slide_type": kind}}}
        if isinstance(content, str):
            cells.append(nbformat.v4.new_markdown_cell(content, **metadata))
        else:
            shown = nbformat.v4.new_output("display_data", content._repr_mimebundle_())
            cells.append(nbformat.v4.new_code_cell("", outputs=[shown], **metadata))
    return nbformat.v4.new_notebook(cells=cells)


def lay_out(output: Path) -> None:
    """Put what every deck loads into the folder."""
    install_javascript()
    copy_javascript(output / "vendor", NPM_FILES | {"reveal": REVEAL_FILES})
    bundle(output / "vendor" / "panels.js")
    for path in BESIDE:
        shutil.copy(path, output)


def write(deck: Path, notebook: NotebookNode) -> None:
    """Write one deck."""
    exporter = SlidesExporter(
        extra_template_basedirs=[str(BOOK)],
        template_name="deck",
        exclude_input_prompt=True,
        exclude_output_prompt=True,
        exclude_anchor_links=True,
    )
    deck.write_text(exporter.from_notebook_node(prepared(notebook))[0], encoding="utf-8")
    print(deck, flush=True)


def prepared(notebook: NotebookNode) -> NotebookNode:
    """Return the notebook with titles, solutions as notes, and links to the other decks."""
    title = next(line for line in notebook.cells[0].source.splitlines() if line.startswith("# "))
    notebook.metadata["title"] = title[2:]
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            cell.source = LINK.sub(_deck_link, cell.source)
        for output in cell.get("outputs", ()):
            if "text/markdown" in output.get("data", {}):
                output.data["text/markdown"] = LINK.sub(_deck_link, output.data["text/markdown"])
    cells = [part for cell in notebook.cells for part in _with_solution_in_notes(cell)]
    notebook.cells = _slides([cell for cell in cells if _kind(cell) != "skip"])
    for count, cell in enumerate(notebook.cells):  # those that were cut would share one
        cell.id = f"part-{count}"
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


def _kind(cell: NotebookNode) -> str:
    return cell.metadata.get("slideshow", {}).get("slide_type", "-")


def _slides(cells: list[NotebookNode]) -> list[NotebookNode]:
    """Begin each slide with a cell for its title, and go on on another one where it is full."""
    begins = [count for count, cell in enumerate(cells) if _kind(cell) in ("slide", "subslide")]
    made, heading, kind = [], "", None
    for begin, end in zip(begins, [*begins[1:], None], strict=True):
        first = cells[begin]
        kind = kind or _kind(first)
        if title := HEADING.match(first.source):
            first.source = first.source[title.end() :]
            heading = title[1]
        parts = [part for cell in cells[begin:end] for part in _parts(cell)]
        if not parts:  # a heading alone: what follows has its own
            continue
        for chunk in _cut(parts):
            made += [_heading(heading, kind, chunk[0].cell), *_joined(chunk)]
            kind, heading = "subslide", re.sub("^# ", "## ", heading)
        kind = None
    return made


def _heading(heading: str, kind: str, first: NotebookNode) -> NotebookNode:
    """The cell of a title, which takes a few bold words that the slide begins with."""
    lead = _lead(first)
    if lead and lead[1].lower() not in heading.lower():
        first.source = first.source[lead.end() :]
        heading += f": {lead[1]}"
    return nbformat.v4.new_markdown_cell(heading, metadata={"slideshow": {"slide_type": kind}})


def _lead(first: NotebookNode) -> re.Match | None:
    return LEAD.match(first.source) if first.cell_type == "markdown" else None


def _parts(cell: NotebookNode) -> list[Part]:
    if cell.cell_type == "code":
        seen = [it for it in cell.outputs if shape(it) is not None]
        texts = [it for it in cell.outputs if it not in seen]
        parts = [_printed(cell, texts)] if texts or not seen else []
        if len(texts) == 1 and TABLE.search(texts[0].get("data", {}).get("text/markdown", "")):
            first, *rest = (_part(cell, outputs=[it]) for it in _tables(texts[0]))
            parts = [_printed(first, first.outputs)]
            parts += [Part(_part(it, source=""), rows=ROWS) for it in rest]
        for it in seen:  # the code stands with what it printed
            figure = _part(cell, outputs=[it], source="" if parts else cell.source)
            parts.append(Part(figure, shape=shape(it), live=LIVE in it.data))
        return parts
    if _kind(cell) == "notes":
        return [Part(cell, joined=True)]
    if cell.source.startswith("**Figure "):
        return [Part(_part(cell, source=CAPTION.format(cell.source)), joined=True)]
    parts = []
    for text, price in _pieces(QUOTED.sub("", cell.source)):
        formulas = DISPLAYED.findall(text)
        rows = sum(2.6 + 1.3 * formula.count(r"\\") for formula in formulas)
        parts.append(
            Part(_part(cell, source=text), price=price, words=_count(text), rows=rows + 0.4)
        )
    return parts


def shape(output: NotebookNode) -> float | None:
    """How wide a figure is for its height; 0 for a panel, None for any other output."""
    data = output.get("data", {})
    figure = FIGURE.match(data.get("text/html", ""))
    return float(figure[1]) / float(figure[2]) if figure else 0.0 if LIVE in data else None


def _tables(output: NotebookNode) -> list[NotebookNode]:
    """A table as several, each with its head, that have room on a slide; text above it on each."""
    text = output.data["text/markdown"]
    begin = TABLE.search(text).start()
    line, *rows = text[begin:].splitlines(keepends=True)[1:]
    head = text[:begin] + text[begin:].splitlines(keepends=True)[0]
    pieces: list[list[str]] = [[]]
    for row in rows:
        if pieces[-1] and sum(map(len, pieces[-1])) + len(row) > LETTERS:
            pieces.append([])
        pieces[-1].append(row)
    tables = ("".join([head, line, *piece]) for piece in pieces)
    return [NotebookNode({**output, "data": NotebookNode({"text/markdown": it})}) for it in tables]


def _printed(cell: NotebookNode, outputs: list[NotebookNode]) -> Part:
    rows, columns = 0.0, 0
    for output in outputs:
        data = output.get("data", {})
        if "text/latex" in data:
            rows += 5.2 if "matrix" in data["text/latex"] else 2.6
        elif "text/markdown" in data:
            rows += ROWS
        else:
            lines = output.get("text", data.get("text/plain", "")).splitlines()
            rows += 0.95 * len(lines) + 0.6
            columns = max(columns, *map(len, lines))
    return Part(_part(cell, outputs=outputs), joined=True, rows=rows, columns=columns)


def _pieces(text: str) -> list[tuple[str, float]]:
    """The paragraphs and items of a text, and the sentences of those that fill a slide."""
    pieces = []
    for block in _split(text, BLOCK):
        price = 0.2 if re.match(r"- |\d+\. ", block) else 0.0
        for piece in _split(block, SENTENCE) if _count(block) > WORDS else [block]:
            if pieces and pieces[-1][0].count("**") % 2:  # bold goes on
                pieces[-1] = (f"{pieces[-1][0].rstrip()}** ", pieces[-1][1])
                piece = f"**{piece}"
            pieces.append((piece, price))
            price = 0.5
    return [piece for piece in pieces if piece[0].strip()]


def _split(text: str, where: re.Pattern) -> list[str]:
    whole = [formula.span() for formula in FORMULA.finditer(text)]
    ends = (match.end() for match in where.finditer(text))
    cuts = [0, *(at for at in ends if not any(a < at < b for a, b in whole)), len(text)]
    return [text[begin:end] for begin, end in itertools.pairwise(cuts)]


def _count(text: str) -> int:
    return len(re.findall(r"\S*\w\S*", FORMULA.sub(" x ", text)))


def _part(cell: NotebookNode, **changes) -> NotebookNode:
    return NotebookNode({**cell, "metadata": NotebookNode(cell.metadata), **changes})


def _cut(parts: list[Part]) -> list[list[Part]]:
    """Share what is to be shown among as few slides as hold it, and evenly."""
    for part, after in itertools.pairwise(parts):
        if part.cell.source.rstrip().endswith(":"):  # it says what follows
            after.price += 1.0
        elif part.live:  # what follows has no room beside a panel
            after.joined &= _kind(after.cell) == "notes"
        elif part.joined and after.words:  # it reads what stands before it
            after.price += 0.3
    begins = [count for count, part in enumerate(parts) if not count or not part.joined]
    best = {0: (0.0, [])}
    for end in [*begins[1:], len(parts)]:
        tried = [(best[at][0] + _cost(parts[at:end]), at) for at in begins if at < end]
        cost, begin = min(tried)
        best[end] = (cost, [*best[begin][1], parts[begin:end]])
    return best[len(parts)][1]


def _cost(chunk: list[Part]) -> float:
    """What a slide costs: one, more where it begins badly, is full, or says nothing."""
    words, pictures = sum(part.words for part in chunk), [it for it in chunk if it.shape or it.live]
    words -= _count(lead[1]) if (lead := _lead(chunk[0].cell)) else 0  # they go into the title
    rows, columns = sum(part.rows for part in chunk), max(part.columns for part in chunk)
    full = (rows + words / 11) / ROWS
    if pictures and pictures[0].live:
        full = max(rows / 2, columns)
    elif pictures:  # below the words, or beside them
        shape = pictures[0].shape
        narrow = max((shape / 1.7) ** 3, columns / (45 if shape > 1.2 else 58))
        full = min(full * 3.4, max(narrow, (rows + words / 6) / ROWS))
    over = max(1, full, words / WORDS, len(pictures)) - 1
    silent = 2 if words < 5 else 0
    over = over and 1 + 20 * over + (words > WORDS)
    return 1 + over + chunk[0].price + silent + 0.3 * (words / WORDS) ** 2


def _joined(chunk: list[Part]) -> list[NotebookNode]:
    """The cells of a slide, each of those that were cut in one again."""
    cells = []
    for part in chunk:
        if cells and part.cell.cell_type == "markdown" and cells[-1].id == part.cell.id:
            cells[-1].source += part.cell.source
        else:
            cells.append(part.cell)
    if _kind(cells[0]) != "notes":
        cells[0].metadata["slideshow"] = {"slide_type": "-"}
    for cell in cells[1:]:
        if _kind(cell) in ("slide", "subslide"):
            cell.metadata["slideshow"] = {"slide_type": "-"}
    return cells


if __name__ == "__main__":
    parser = arguments(__doc__, BOOK / "_build" / "slides")
    text = "only these, such as 00 04"
    parser.add_argument("--chapters", nargs="+", default=[], metavar="NN", help=text)
    text = "the concept questions, into book/_build/votes by default"
    parser.add_argument("--questions", action="store_true", help=text)
    given = parser.parse_args()
    place, own = given.output, "votes" if given.questions else "lecturer/slides"
    if place == parser.get_default("output") and (given.questions or given.lecturer):
        place = BOOK / "_build" / own
    if given.questions:
        vote(place.resolve())
    else:
        main(place.resolve(), given.chapters, given.lecturer)
