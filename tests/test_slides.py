"""The chapters say which part each cell plays on the slides, and the rule for cells that don't say it."""

import re
import sys
from pathlib import Path

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook, new_output

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT / "book" / "tools"))
import marks  # noqa: E402
import slides  # noqa: E402

CHAPTERS = sorted((ROOT / "notebooks").glob("[0-9][0-9]_*.ipynb"))
FORMULA = "$$\nV = 1\n$$"


@pytest.mark.parametrize("path", CHAPTERS, ids=lambda path: path.stem)
class TestChapter:
    @pytest.fixture
    def cells(self, path):
        return nbformat.read(path, as_version=4).cells

    def test_every_cell_has_a_slide_type(self, cells):
        assert {marks.own_type(cell) for cell in cells} <= set(marks.TYPES), (
            "run python book/tools/slides.py --mark on it"
        )

    def test_a_section_is_a_slide_and_nothing_else_is(self, cells):
        for cell in cells:
            headings = (
                re.findall(r"^#{1,2} ", cell.source, re.MULTILINE)
                if cell.cell_type == "markdown"
                else []
            )
            assert len(headings) <= 1, cell.source
            assert (marks.own_type(cell) == "slide") == bool(headings), cell.source

    def test_an_exercise_begins_a_slide_of_its_own(self, cells):
        exercises = [
            cell for cell in cells if cell.cell_type == "markdown" and "### Exercise" in cell.source
        ]
        assert len(exercises) >= 3
        for cell in exercises:
            assert cell.source.count("### Exercise") == 1
            assert marks.own_type(cell) in ("slide", "subslide")

    def test_it_has_slides_results_and_notes(self, cells):
        types = [marks.own_type(cell) for cell in cells]
        assert types.count("slide") + types.count("subslide") >= 12
        assert types.count("notes") >= 3
        shown = [
            cell for cell, kind in zip(cells, types, strict=True) if kind not in ("notes", "skip")
        ]
        assert (
            sum(
                "image/png" in output.get("data", {})
                for cell in shown
                for output in cell.get("outputs", ())
            )
            >= 1
        )

    def test_no_solution_is_on_a_slide(self, cells):
        for cell in cells:
            assert ("hide-cell" in cell.metadata.get("tags", ())) <= (
                marks.own_type(cell) in ("notes", "skip")
            )

    def test_marking_it_again_changes_nothing(self, path, tmp_path):
        copy = tmp_path / path.name
        copy.write_bytes(path.read_bytes())
        marks.mark(copy)
        assert copy.read_bytes() == path.read_bytes()


def test_the_proof_of_the_lyapunov_chapter_is_in_the_notes():
    cells = nbformat.read(ROOT / "notebooks" / "04_lyapunov.ipynb", as_version=4).cells
    steps = [
        marks.own_type(cell)
        for cell in cells
        if "**A bounded set that nobody leaves.**" in cell.source
        or "1. $V \\ge 0$ never" in cell.source
    ]
    assert steps == ["notes", "notes"]


def picture():
    return new_output("display_data", data={"image/png": "", "text/plain": "<Picture>"})


def text(lines):
    return new_output("stream", name="stdout", text="a line\n" * lines)


def types_of(*cells):
    return marks.slide_types(
        [
            new_markdown_cell("# Title"),
            new_code_cell("import math"),
            new_markdown_cell("## Section"),
            *cells,
        ]
    )[3:]


def test_a_title_and_a_section_begin_slides_and_imports_are_skipped():
    cells = [
        new_markdown_cell("# Title"),
        new_code_cell("import math"),
        new_markdown_cell("## Section\n\nA claim."),
    ]
    assert marks.slide_types(cells) == ["slide", "skip", "slide"]


def test_results_fill_a_slide_and_then_go_below_it():
    assert types_of(new_code_cell(outputs=[text(3)]), new_code_cell(outputs=[picture()])) == [
        "fragment",
        "subslide",
    ]


def test_what_reads_a_picture_stands_on_its_slide():
    assert types_of(new_code_cell(outputs=[picture()]), new_markdown_cell("It falls.")) == [
        "fragment",
        "fragment",
    ]


def test_code_without_a_result_takes_no_room():
    assert types_of(new_code_cell("x = 1")) == ["-"]


def test_a_panel_has_a_slide_for_itself():
    panel = new_output(
        "display_data",
        data={"application/vnd.jupyter.widget-view+json": {}, "text/plain": "VBox()"},
    )
    assert types_of(new_code_cell(outputs=[panel]), new_markdown_cell("- move h")) == [
        "subslide",
        "subslide",
    ]


def test_derivations_and_long_prose_are_notes_and_formulas_are_not():
    prose, steps = "word " * 100, "1. As $a > 0$,\n   so is $b$.\n2. Hence $b > 0$."
    assert types_of(*map(new_markdown_cell, (prose, steps, f"It is\n\n{FORMULA}"))) == [
        "notes",
        "notes",
        "fragment",
    ]


def test_exercises_are_slides_below_and_solutions_are_not_shown():
    solution = new_code_cell(outputs=[text(1)], metadata={"tags": ["hide-cell"]})
    assert types_of(new_markdown_cell("### Exercise 1.2: Why?\n\nSay why."), solution) == [
        "subslide",
        "skip",
    ]


def test_an_author_overrules_the_rule():
    cell = new_markdown_cell("word " * 100, metadata={"slideshow": {"slide_type": "subslide"}})
    assert types_of(cell) == ["subslide"]
    assert (
        marks.divided(
            new_markdown_cell("a\n\n## b", metadata={"slideshow": {"slide_type": "notes"}})
        )[0].source
        == "a\n\n## b"
    )


def test_a_cell_is_cut_at_its_headings_and_a_claim_from_its_derivation():
    cell = new_markdown_cell(
        f"Read.\n\n## Proof\n\nIt holds.\n\n1. $a$\n2. $b$\n\n{FORMULA}\n\n## Exercises\n\n### Exercise 1.1: Why?",
        id="c1",
    )
    parts = marks.divided(cell)
    assert [part.source.splitlines()[0] for part in parts] == [
        "Read.",
        "## Proof",
        "1. $a$",
        "## Exercises",
    ]
    assert "\n\n".join(part.source for part in parts) == cell.source
    assert len({part.id for part in parts}) == 4
    assert parts[0].id == "c1"


@pytest.mark.parametrize("wrong", ["7", "99", "OUT", "00_from_gps_to_a_parked_robot"])
def test_a_chapter_that_is_not_there_is_told_before_anything_is_made(tmp_path, wrong):
    with pytest.raises(
        SystemExit, match=rf"no chapter {wrong}: two digits each, such as 00 04, are needed"
    ):
        slides.main(tmp_path / "decks", ["00", wrong])
    assert not any(tmp_path.iterdir())


def test_marking_touches_nothing_but_the_slide_types(tmp_path):
    code = new_code_cell(
        "print(1)", outputs=[text(1)], execution_count=1, metadata={"tags": ["audit:eq-1"]}
    )
    nbformat.write(
        new_notebook(cells=[new_markdown_cell("# Title"), new_markdown_cell("## A"), code]),
        tmp_path / "n.ipynb",
    )
    marks.mark(tmp_path / "n.ipynb")
    cells = nbformat.read(tmp_path / "n.ipynb", as_version=4).cells
    assert [marks.own_type(cell) for cell in cells] == ["slide", "slide", "fragment"]
    assert cells[2].metadata.pop("slideshow")
    assert cells[2] == code
