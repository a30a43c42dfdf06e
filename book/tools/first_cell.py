"""Give each chapter the cell that installs the book's library where it is missing.

    python book/tools/first_cell.py

The cell stands below the chapter's title and is the same in all chapters. It has the address of the
repository, `Repository` among the `[project.urls]` of pyproject.toml; run this again when that
changes. Without an address the cell only says what to install.
"""

from __future__ import annotations

import json
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ID = "install"
METADATA = {
    "cellView": "form",  # Colab folds it
    "jupyter": {"source_hidden": True},
    "tags": ["remove-cell"],  # from the pages
}
SOURCE = """\
# @title Install the book's library, if it is missing
import importlib.metadata
import importlib.util
import subprocess
import sys

REPOSITORY = {repository}  # from pyproject.toml, by book/tools/first_cell.py

if importlib.util.find_spec("wmrbook") is None:
    if REPOSITORY:
        print("The book's library is being installed, which takes about a minute.")
        wanted = f"wmrlib[chapters] @ {{REPOSITORY}}/archive/HEAD.zip"
        command = [sys.executable, "-m", "pip", "install", "--quiet", wanted]
        done = subprocess.run(command, capture_output=True, text=True)
        print(done.stderr if done.returncode else "It is installed.")
        importlib.invalidate_caches()
    if importlib.util.find_spec("wmrbook") is None:
        raise ModuleNotFoundError(
            f"This chapter needs wmrlib. Download {{REPOSITORY or 'the book'}}"
            ' and run this in its folder: pip install ".[book]"'
        )
    for name in {{"matplotlib", "numpy"}} & sys.modules.keys():
        if sys.modules[name].__version__ != importlib.metadata.version(name):
            raise ImportError(f"{{name}} is now newer. Restart the kernel and run all again.")
"""


def address(kind: str = "Repository") -> str:
    """An address of the `[project.urls]` without a slash at its end, or nothing."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    return project.get("urls", {}).get(kind, "").rstrip("/")


def source(repository: str) -> str:
    """The cell's code, for the address of a repository or nothing."""
    return SOURCE.format(repository=json.dumps(repository)).rstrip("\n")


def with_cell(notebook: dict) -> dict:
    """The notebook with the cell of now; a new one comes below the title, and is counted."""
    cells = notebook["cells"]
    wanted = source(address()).splitlines(keepends=True)
    for cell in cells:
        if cell["id"] == ID:
            cell |= {"metadata": METADATA, "source": wanted}
            return notebook
    for cell in cells:
        for part in (cell, *cell.get("outputs", ())):
            if part.get("execution_count"):
                part["execution_count"] += 1
    cell = {"cell_type": "code", "execution_count": 1, "id": ID, "metadata": METADATA}
    cells.insert(1, cell | {"outputs": [], "source": wanted})
    return notebook


def main() -> None:
    """Write the cell into the chapters."""
    for path in sorted((ROOT / "notebooks").glob("[0-9][0-9]_*.ipynb")):
        notebook = with_cell(json.loads(path.read_text(encoding="utf-8")))
        text = json.dumps(notebook, ensure_ascii=False, indent=1)
        path.write_text(f"{text}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
