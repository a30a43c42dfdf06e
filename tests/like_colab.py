"""Does a chapter run alone, in an empty folder, where only the usual packages are?

    python tests/like_colab.py          # chapters 00, 10 and 12
    python tests/like_colab.py 04       # this one

A fresh environment gets from PyPI what Colab has already. The chapter's first cell then installs
this repository, from an address on the disk, by the way that it takes on the network.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.append(str(ROOT / "book" / "tools"))
import first_cell  # noqa: E402

USUAL = ["ipykernel", "ipywidgets", "matplotlib", "nbclient", "numba", "numpy", "scipy"]
PACKAGES = "wmrlib", "book/wmrbook", "book/robot/wmrrobot"
FILES = "pyproject.toml", "README.md", "LICENSE"


def main(numbers: list[str], home: Path) -> None:
    """Make the environment and the repository's zip, then run the chapters one after the other."""
    venv.create(home / "venv", with_pip=True)
    commands = home / "venv" / ("Scripts" if os.name == "nt" else "bin")
    subprocess.run([commands / "python", "-m", "pip", "install", "-q", *USUAL], check=True)
    address = archive(home / "robot")
    environment = {name: it for name, it in os.environ.items() if name != "PYTHONPATH"}
    for number in numbers:
        (path,) = (ROOT / "notebooks").glob(f"{number}_*.ipynb")
        notebook = json.loads(path.read_text(encoding="utf-8"))
        (cell,) = (cell for cell in notebook["cells"] if cell["id"] == first_cell.ID)
        cell["source"] = first_cell.source(address)
        alone = home / number / path.name
        alone.parent.mkdir()
        alone.write_text(json.dumps(notebook), encoding="utf-8")
        command = [commands / "jupyter", "execute", "--timeout=600", alone.name]
        subprocess.run(command, cwd=alone.parent, env=environment, check=True)
        assert [*alone.parent.iterdir()] == [alone], "the chapter leaves files behind"
        print(f"{path.name} runs alone", flush=True)


def archive(folder: Path) -> str:
    """Pack what a repository's zip has of the packages; return the repository's address."""
    inside = folder / "robot-HEAD"
    for name in PACKAGES:
        ignored = shutil.ignore_patterns("__pycache__")
        shutil.copytree(ROOT / name, inside / name, ignore=ignored)
    for name in FILES:
        shutil.copy(ROOT / name, inside)
    shutil.make_archive(str(folder / "archive" / "HEAD"), "zip", folder, inside.name)
    return folder.as_uri()


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        main(sys.argv[1:] or ["00", "10", "12"], Path(folder))
