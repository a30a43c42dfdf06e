"""Each cell of a chapter says which part it plays on the slides, and a deck is made by that."""

import re
from collections import Counter
from pathlib import Path

import nbformat
import pytest
import slides
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook, new_output

CHAPTERS = sorted((Path(__file__).parent.parent / "notebooks").glob("[0-9][0-9]_*.ipynb"))


def kind(cell):
    return cell.metadata.get("slideshow", {}).get("slide_type")


@pytest.mark.parametrize("path", CHAPTERS, ids=lambda path: path.stem)
def test_a_chapters_cells_make_slides(path):
    cells = nbformat.read(path, as_version=4).cells
    types = [kind(cell) for cell in cells]
    assert set(types) <= {"slide", "subslide", "fragment", "-", "notes", "skip"}, types
    assert cells[0].source.startswith("# ")
    for cell in cells:
        prose = cell.source if cell.cell_type == "markdown" else ""
        titles = re.findall(r"^#{1,2} ", prose, re.MULTILINE)
        assert len(titles) == (kind(cell) == "slide"), cell.source
        if "### Exercise" in prose:
            assert prose.count("### Exercise") == 1
            assert kind(cell) in ("slide", "subslide"), cell.source
        if kind(cell) == "notes":  # what is derived or computed is for the class to see
            assert prose, cell.source
            assert "$$" not in prose, cell.source
        if "hide-cell" in cell.metadata.get("tags", ()):  # it computes a solution
            assert kind(cell) == "skip", cell.source


def printed(cells):
    """The outputs, and the rows of those that are tables, which may go on on the next slide."""
    for output in (output for cell in cells for output in cell.get("outputs", ())):
        table = output.get("data", {}).get("text/markdown", "")
        rows = [line for line in table.splitlines() if line.startswith("|")]
        yield from rows[2:] or [output]


@pytest.mark.parametrize("path", CHAPTERS, ids=lambda path: path.stem)
def test_a_deck_shows_all_that_a_chapter_shows_and_each_slide_begins_with_a_title(path):
    chapter = nbformat.read(path, as_version=4)
    asked = [cell for cell in chapter.cells if kind(cell) != "skip"]
    words = said(asked)
    cells = slides.prepared(chapter).cells
    words -= Counter(("Exercises", "details", "details", "summary", "summary") * len(asked))
    assert not words - said(cells), "words that no slide shows"
    assert [*printed(cells)] == [*printed(asked)]  # their links lead to decks now
    begins = [count for count, cell in enumerate(cells) if kind(cell) in ("slide", "subslide")]
    assert len({cell.id for cell in cells}) == len(cells)
    assert begins[0] == 0
    for begin, end in zip(begins, [*begins[1:], None], strict=True):
        heading, *shown = cells[begin:end]
        assert not any(cell.source.count("$$") % 2 for cell in shown), heading.source
        outputs = [output for cell in shown for output in cell.get("outputs", ())]
        assert re.fullmatch(r"#{1,3} \S.*", heading.source)
        assert sum(slides.shape(it) is not None for it in outputs) <= 1, heading.source
        for cell in shown:
            assert cell.cell_type == "code" or cell.source.strip(), heading.source


def said(cells):
    """How often the cells say each word."""
    text = " ".join(cell.source for cell in cells if cell.cell_type == "markdown")
    return Counter(re.findall(r"\w+", slides.LINK.sub(r"\1", text)))


def test_a_deck_has_a_title_its_own_links_and_solutions_as_notes():
    prose = "See [this](04_lyapunov.ipynb#x), [that](../book/use.md), [there](https://a.org)."
    begins = {"slideshow": {"slide_type": "slide"}}
    solution = "\n\n<details><summary>Solution</summary>\n\nTwo.\n\n</details>"
    table = new_output("display_data", data={"text/markdown": prose})
    cells = [
        new_markdown_cell(f"# A title\n\n{prose}", metadata=begins),
        new_markdown_cell(f"### Exercise 1\n\nOne and one?{solution}", metadata=begins),
        new_code_cell("1", outputs=[table]),
    ]
    deck = slides.prepared(new_notebook(cells=cells))
    linked = "See [this](04_lyapunov.slides.html), that, [there](https://a.org)."
    assert deck.metadata["title"] == "A title"
    assert [cell.source for cell in deck.cells] == [
        "# A title",
        linked,
        "### Exercise 1",
        "One and one?",
        "**Solution.** Two.",
        "1",
    ]
    assert deck.cells[-1].outputs[0].data["text/markdown"] == linked
    assert [kind(cell) for cell in deck.cells[:-1]] == ["slide", "-", "slide", "-", "notes"]


def test_a_full_slide_goes_on_under_its_title_and_a_heading_alone_is_no_slide():
    sentence = f"$x$ is so {'very ' * 24}long. "  # 28 words
    why = f"**Why so.** {sentence * 2}"
    sources = ("# A", f"## B\n\n{sentence * 3}", why, "## C", "### D\n\nE.")
    kinds = ("slide", "slide", "fragment", "slide", "subslide")
    cells = [
        new_markdown_cell(source, metadata={"slideshow": {"slide_type": name}})
        for source, name in zip(sources, kinds, strict=True)
    ]
    titles = [
        (cell.source, kind(cell))
        for cell in slides.prepared(new_notebook(cells=cells)).cells
        if cell.source.startswith("#")
    ]
    assert titles == [
        ("## B", "slide"),
        ("## B", "subslide"),
        ("## B: Why so", "subslide"),
        ("### D", "slide"),
    ]


def test_a_chapter_that_is_not_there_is_told_before_anything_is_made(tmp_path):
    for wrong in ("7", "99", "OUT", "00_from_gps_to_a_parked_robot"):
        with pytest.raises(SystemExit, match=f"no chapter {wrong}: two digits each, such as 00 04"):
            slides.main(tmp_path / "decks", ["00", wrong])
    assert not any(tmp_path.iterdir())
