"""The chapters check the library: flip one sign in it, and an assertion of the chapter fails."""

import os
import re
import shutil
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError

ROOT = Path(__file__).parent.parent
CHAPTERS = sorted((ROOT / "notebooks").glob("[0-9][0-9]_*.ipynb"))
NUMBER = r"(?<![\w.(])\d[\d.,]*(?:e[+-]?\d+)?(?![\d./])"  # neither 1/s nor (24)
FLIPS = {  # the formula: the chapter that derives it, its text, and what to make of it
    "the theta row (8)": (
        "03_polar_coordinates",
        r"(return -\w+ \* rho \* cos_alpha, (\w+) - omega), \2\b",
        r"\1, -\2",
    ),
    "omega's second term, which corrects (24)": (
        "04_lyapunov",
        r"(gains\.k_alpha \* alpha) \+ (\w+ \* sinc\(alpha\) \* \(alpha)",
        r"\1 - \2",
    ),
    "the bearing's arguments (15)": (
        "01_gps_to_metres",
        r"direction\((cos_lat2 \* sincos\(delta_lon\)\[0\]), (zeta_y)\)",
        r"direction(\2, \1)",
    ),
}


@pytest.mark.parametrize("path", CHAPTERS, ids=lambda path: path.stem)
def test_figures_have_captions_in_order(path):
    cells, wanted, captions = nbformat.read(path, as_version=4).cells, [], []
    for place, cell in enumerate(cells):
        texts = [it.get("data", {}).get("text/html", "") for it in cell.get("outputs", ())]
        solution = "hide-cell" in cell.metadata.get("tags", ())
        if any(text.startswith("<img") for text in texts) and not solution:
            wanted.append((place + 1, f"**Figure {int(path.stem[:2])}.{len(wanted) + 1}.** "))
        if caption := re.match(r"\*\*Figure .*?\*\* ", cell.source):
            captions.append((place, caption[0]))
    assert captions == wanted


@pytest.mark.parametrize("path", CHAPTERS[1:], ids=lambda path: path.stem)
def test_more_than_three_numbers_are_a_table(path):
    """Neither a block of print, an array nor a dictionary stands in the text; a short list may."""
    for cell in nbformat.read(path, as_version=4).cells:
        for output in cell.get("outputs", ()):
            data = output.get("data", {})
            plain = {"text/plain"}.issuperset(data)  # nothing that a page could typeset
            text = output.get("text", data.get("text/plain", "")) if plain else ""
            refused = "is not allowed: " in text  # a message of ours, with what it asks for
            assert refused or len(re.findall(NUMBER, text)) <= 3, (cell.id, text)
            listed = re.fullmatch(r"\[[-\d., ]*\]", text)
            assert listed or not re.search(r"array\(|^[{\[(]", text), (cell.id, text)


@pytest.mark.slow
@pytest.mark.parametrize("formula", FLIPS)
def test_a_chapter_fails_when_a_sign_flips(tmp_path, monkeypatch, formula):
    chapter, right, wrong = FLIPS[formula]
    package = tmp_path / "wmrlib"
    shutil.copytree(ROOT / "wmrlib", package, ignore=shutil.ignore_patterns("__pycache__"))
    texts = {path: path.read_text(encoding="utf-8") for path in package.glob("*.py")}
    (home,) = [path for path, text in texts.items() if re.search(right, text)]
    home.write_text(re.sub(right, wrong, texts[home]), encoding="utf-8")
    places = [tmp_path, ROOT / "book", ROOT / "book" / "robot"]
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(map(str, places)))
    monkeypatch.setenv("NUMBA_DISABLE_JIT", "1")  # compiling would take longer than the chapter

    notebook = nbformat.read(ROOT / "notebooks" / f"{chapter}.ipynb", as_version=4)
    folder = {"metadata": {"path": str(ROOT / "notebooks")}}
    with pytest.raises(CellExecutionError) as failed:
        NotebookClient(notebook, resources=folder).execute()
    assert failed.value.ename == "AssertionError"
