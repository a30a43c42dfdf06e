"""The Python that a page carries: Pyodide, sympy, z3 and what the book's cells import beside them.

A page from the disk may not fetch, but it may load scripts: each part is one, in base64. Pyodide
(MPL-2.0) comes unchanged from npm, sympy and mpmath with their licences out of this environment.
In the place of wmrlib stands what plain_symbolic.py prints, and of wmrbook two modules that need no
more. z3 (MIT) comes from PyPI, as the wheel for Pyodide that book/in_page/z3.txt names, and is
loaded only for a cell that asks it.
"""

from __future__ import annotations

import base64
import gzip
import io
import json
import re
import shutil
import subprocess
import sys
import tempfile
import time
import zipfile
from contextlib import suppress
from hashlib import sha256
from importlib.metadata import distribution
from pathlib import Path

import plain_symbolic

BOOK = Path(__file__).resolve().parents[1]
IN_PAGE = BOOK / "in_page"
INSTALLED = ("sympy", "mpmath")
OWN = "equations.py", "chapters/__init__.py", "chapters/strict.py"  # of wmrbook
# What no cell needs; all would be too large for a page.
LEFT_OUT = re.compile(
    r".*\b(tests|benchmarks|__pycache__)/|sympy/(physics/(?!units)\w+/|parsing/\w+/|stats/)"
)
Z3 = IN_PAGE / "z3.txt"  # the version and the hash of a wheel
Z3_LICENCE = IN_PAGE / "z3_LICENSE.txt"  # which the wheel lacks
Z3_PLATFORM = "pyemscripten_2026_0_wasm32"
Z3_FILES = re.compile(r"z3/\w+\.py|z3/lib/libz3\.so|.*/METADATA")
DAY = 24 * 3600.0  # s
FIXED = (1980, 1, 1, 0, 0, 0)  # the same files make the same zip


def write_scripts(folder: Path, modules: Path) -> None:
    """Write what python_cells.js loads: `PYTHON_PARTS.wasm`, say, is base64 of gzip or of a zip.

    `modules` is the folder where npm keeps what is installed.
    """
    pyodide = modules / "pyodide"
    lock = json.loads((pyodide / "pyodide-lock.json").read_text(encoding="utf-8"))
    lock["packages"] = {}  # each would be a request
    # From the disk only a classic worker starts, which Pyodide knows by this name and refuses.
    worker = f"self.importScripts = undefined;\nconst LOCK = {json.dumps(lock)};\n"
    worker += (pyodide / "pyodide.js").read_text(encoding="utf-8").rpartition("//#")[0]
    worker += (IN_PAGE / "worker.js").read_text(encoding="utf-8")
    stdlib = (pyodide / "python_stdlib.zip").read_bytes()
    zips = {"stdlib": stdlib, "packages": packages(), "z3": z3(modules)}
    stdlib, own, solver = compiled(modules, zips)
    parts = {
        "worker": gzip.compress(worker.encode(), mtime=0),
        "asm": gzip.compress((pyodide / "pyodide.asm.mjs").read_bytes(), mtime=0),
        "wasm": gzip.compress((pyodide / "pyodide.asm.wasm").read_bytes(), mtime=0),
        "stdlib": stdlib,
        "packages": own,
        "z3": solver,
    }
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in parts.items():
        text = base64.b64encode(content).decode()
        script = f'(window.PYTHON_PARTS ??= {{}}).{name} = "{text}";\n'
        (folder / f"{name}.js").write_text(script, encoding="utf-8")


def compiled(modules: Path, zips: dict[str, bytes]) -> list[bytes]:
    """Return the zips with their modules compiled, which is done once for the same files."""
    pyodide, script = modules / "pyodide" / "pyodide.mjs", IN_PAGE / "compile.mjs"
    digest = sha256(b"".join([pyodide.read_bytes(), script.read_bytes(), *zips.values()]))
    folder = modules / ".python" / digest.hexdigest()[:16]
    if not folder.is_dir():
        folder.parent.mkdir(exist_ok=True)
        for old in folder.parent.iterdir():
            if old.stat().st_mtime < time.time() - DAY:
                shutil.rmtree(old, ignore_errors=True)
        node = shutil.which("node") or shutil.which("node", path=Path(sys.executable).parent)
        with tempfile.TemporaryDirectory() as given:
            made = Path(tempfile.mkdtemp(dir=folder.parent))  # two builds may run at once
            command = [node or "node", script, pyodide.as_uri()]
            for name, content in zips.items():
                Path(given, name).write_bytes(content)
                command += [Path(given, name), made / name]
            subprocess.run(command, check=True)
            for name in zips:
                (made / name).write_bytes(_zipped(_files_of(made / name), zipfile.ZIP_DEFLATED))
        with suppress(OSError):  # another build was first
            made.rename(folder)
    return [(folder / name).read_bytes() for name in zips]


def packages() -> bytes:
    """Return a zip of all packages, not compressed, as they lie in a folder of Python's path."""
    files = own_files() | {"run_cell.py": (IN_PAGE / "run_cell.py").read_bytes()}
    for package in INSTALLED:
        files |= _installed_files(package)
    return _zipped(files)


def own_files() -> dict[str, bytes]:
    """Return the modules that stand in the page for wmrlib and wmrbook, by path."""
    files = {f"wmrbook/{name}": (BOOK / "wmrbook" / name).read_bytes() for name in OWN}
    files["wmrlib/symbolic.py"] = plain_symbolic.module().encode()
    return files | {"wmrlib/__init__.py": b"", "wmrbook/__init__.py": b""}


def z3(modules: Path) -> bytes:
    """Return z3 as a zip, out of a wheel that pip fetches once; the wheel has its library twice."""
    digest = sha256(Z3.read_bytes()).hexdigest()[:16]
    folder = modules / ".z3" / digest
    if not folder.is_dir():
        folder.parent.mkdir(exist_ok=True)
        made = Path(tempfile.mkdtemp(dir=folder.parent))
        command = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--dest", made]
        command += ["--only-binary", ":all:", "--platform", Z3_PLATFORM, "--require-hashes"]
        subprocess.run([*command, "-r", Z3], check=True)
        with suppress(OSError):  # another build was first
            made.rename(folder)
    (wheel,) = folder.glob("*.whl")
    files = {name: it for name, it in _files_of(wheel).items() if Z3_FILES.fullmatch(name)}
    return _zipped(files | {"z3/LICENSE": Z3_LICENCE.read_bytes()})


def _files_of(path: Path) -> dict[str, bytes]:
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def _zipped(files: dict[str, bytes], compression: int = zipfile.ZIP_STORED) -> bytes:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        for name, text in sorted(files.items()):
            archive.writestr(zipfile.ZipInfo(name, FIXED), text, compression, compresslevel=9)
    return content.getvalue()


def _installed_files(package: str) -> dict[str, bytes]:
    files = {}
    for file in distribution(package).files or ():
        name = file.as_posix()
        code = file.parts[0] == package and file.suffix == ".py" and not LEFT_OUT.match(name)
        if code or "LICENSE" in file.name:
            files[name] = Path(str(file.locate())).read_bytes()
    return files
