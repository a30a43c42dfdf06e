"""The Python that a page carries: Pyodide, sympy and the parts of wmrlib that need no more.

A page from the disk may not fetch, but it may load scripts: each part is one, in base64. Pyodide
(MPL-2.0) comes unchanged from npm, sympy, mpmath and lazy_loader with their licences out of this
environment, wmrlib and wmrbook out of this repository. Where those need numpy, numba or a part that
is not here, book/in_page/stand_ins has a module in its place.
"""

from __future__ import annotations

import base64
import gzip
import io
import json
import zipfile
from collections.abc import Iterator
from importlib.metadata import distribution
from pathlib import Path

BOOK = Path(__file__).resolve().parents[1]
IN_PAGE = BOOK / "in_page"
STAND_INS = IN_PAGE / "stand_ins"
INSTALLED = ("sympy", "mpmath", "lazy_loader")
LEFT_OUT = {"tests", "benchmarks", "__pycache__", "explorer", "figures", "audit", "challenge"}
KINDS = {".py", ".pyi", ".lark", ".g4", ".h"}
FIXED = (1980, 1, 1, 0, 0, 0)  # the same files make the same zip


def write_scripts(folder: Path, pyodide: Path) -> None:
    """Write what python_cells.js loads: `PARTS.wasm`, say, is base64 of gzip or of a zip."""
    lock = json.loads((pyodide / "pyodide-lock.json").read_text(encoding="utf-8"))
    lock["packages"] = {}  # each would be a request
    worker = f"const LOCK = {json.dumps(lock)};\n"
    worker += (pyodide / "pyodide.js").read_text(encoding="utf-8").rpartition("//#")[0]
    worker += (IN_PAGE / "worker.js").read_text(encoding="utf-8")
    parts = {
        "worker": gzip.compress(worker.encode(), mtime=0),
        "asm": gzip.compress((pyodide / "pyodide.asm.mjs").read_bytes(), mtime=0),
        "wasm": gzip.compress((pyodide / "pyodide.asm.wasm").read_bytes(), mtime=0),
        "stdlib": (pyodide / "python_stdlib.zip").read_bytes(),
        "packages": packages(),
    }
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in parts.items():
        text = base64.b64encode(content).decode()
        script = f'(window.PYTHON_PARTS ??= {{}}).{name} = "{text}";\n'
        (folder / f"{name}.js").write_text(script, encoding="utf-8")


def packages() -> bytes:
    """Return a zip of all packages, as they lie in a folder of Python's path."""
    files = dict(_own_files())
    for name in INSTALLED:
        files |= _installed_files(name)
    files |= {each.relative_to(STAND_INS).as_posix(): each for each in STAND_INS.rglob("*.py")}
    files["run_cell.py"] = IN_PAGE / "run_cell.py"
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, path in sorted(files.items()):
            archive.writestr(zipfile.ZipInfo(name, FIXED), path.read_bytes(), zipfile.ZIP_DEFLATED)
    return content.getvalue()


def _own_files() -> Iterator[tuple[str, Path]]:
    for package in (BOOK.parent / "wmrlib", BOOK / "wmrbook"):
        for path in package.rglob("*"):
            name = path.relative_to(package.parent)
            if path.suffix in KINDS and not LEFT_OUT & set(name.parts):
                yield name.as_posix(), path


def _installed_files(name: str) -> dict[str, Path]:
    found = {}
    for file in distribution(name).files or ():
        code = file.parts[0] == name and file.suffix in KINDS and not LEFT_OUT & set(file.parts)
        if code or "LICENSE" in file.name:
            found[file.as_posix()] = Path(str(file.locate()))
    return found
