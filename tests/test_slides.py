"""Each cell of a chapter says which part it plays on the slides, and a deck is made by that."""

import re
from pathlib import Path

import nbformat
import pytest
import slides
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook, new_output

CHAPTERS = sorted((Path(__file__).parent.parent / "notebooks").glob("[0-9][0-9]_*.ipynb"))
SEEN = {"text/html", "text/markdown", "application/vnd.jupyter.widget-view+json"}


def kind(cell):
    return cell.metadata.get("slideshow", {}).get("slide_type")


def formats(cell):
    return {name for output in cell.get("outputs", ()) for name in output.get("data", ())}


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
    shown = [cell for cell in cells if kind(cell) not in ("notes", "skip")]
    begins = [count for count, cell in enumerate(shown) if kind(cell) in ("slide", "subslide")]
    assert len(begins) >= 12
    for begin, end in zip(begins, [*begins[1:], None], strict=True):
        slide = shown[begin:end]  # more than what a cell printed
        assert any(cell.cell_type == "markdown" or SEEN & formats(cell) for cell in slide), slide
    assert any("text/html" in formats(cell) for cell in shown)


def test_a_deck_has_a_title_its_own_links_and_solutions_as_notes():
    prose = "See [this](04_lyapunov.ipynb#x), [that](../book/use.md), [there](https://a.org)."
    solution = "\n\n<details><summary>Solution</summary>\n\nTwo.\n\n</details>"
    table = new_output("display_data", data={"text/markdown": prose})
    cells = [
        new_markdown_cell(f"# A title\n\n{prose}"),
        new_markdown_cell(f"### Exercise{solution}"),
        new_code_cell("1", outputs=[table]),
    ]
    deck = slides.prepared(new_notebook(cells=cells))
    linked = "See [this](04_lyapunov.slides.html), that, [there](https://a.org)."
    assert deck.metadata["title"] == "A title"
    assert deck.cells[0].source == f"# A title\n\n{linked}"
    assert deck.cells[3].outputs[0].data["text/markdown"] == linked
    assert [cell.source for cell in deck.cells[1:3]] == ["### Exercise", "**Solution.** Two."]
    assert kind(deck.cells[2]) == "notes"


def test_a_chapter_that_is_not_there_is_told_before_anything_is_made(tmp_path):
    for wrong in ("7", "99", "OUT", "00_from_gps_to_a_parked_robot"):
        with pytest.raises(SystemExit, match=f"no chapter {wrong}: two digits each, such as 00 04"):
            slides.main(tmp_path / "decks", ["00", wrong])
    assert not any(tmp_path.iterdir())
