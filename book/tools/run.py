"""Run the chapters and store what they show: outputs, and panels that live before anything is run.

    python book/tools/run.py            # every chapter
    python book/tools/run.py 00 04      # these

Nothing random and nothing of this machine is stored: a second run changes only what the code did.
"""

from __future__ import annotations

import argparse
import os
import re
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import kernels
import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError
from nbformat import NotebookNode

BOOK = Path(__file__).resolve().parents[1]
ROOT = BOOK.parent
VIEW = "application/vnd.jupyter.widget-view+json"
WIDGETS = "application/vnd.jupyter.widget-state+json"


def main(numbers: list[str]) -> None:
    """Run the chapters with these two-digit numbers, or all, each in a process of its own."""
    chapters = sorted((ROOT / "notebooks").glob("[0-9][0-9]_*.ipynb"))
    if missing := sorted(set(numbers) - {path.name[:2] for path in chapters}):
        raise SystemExit(f"no chapter {', '.join(missing)}: give two digits, such as 00 04")
    paths = [path for path in chapters if not numbers or path.name[:2] in numbers]
    folders = [*map(str, (ROOT, BOOK, BOOK / "robot")), os.environ.get("PYTHONPATH")]
    os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, folders))  # the kernels inherit it
    failed = 0
    workers = min(len(paths), os.cpu_count() or 1)
    with ProcessPoolExecutor(workers, initializer=kernels.use_files) as pool:
        for path, trouble in zip(paths, pool.map(run, paths), strict=True):
            print(f"{path.name}: {trouble or 'stored'}", flush=True)
            failed += bool(trouble)
    sys.exit(failed)


def run(path: Path) -> str:
    """Run one notebook in its folder and store it; return the error of a cell that fails."""
    notebook = nbformat.read(path, as_version=4)
    notebook.metadata.pop("widgets", None)
    client = NotebookClient(
        notebook,
        timeout=600,
        record_timing=False,
        coalesce_streams=True,
        resources={"metadata": {"path": path.parent}},
    )
    try:
        client.execute()
    except CellExecutionError as error:
        return str(error)
    whole = path.with_suffix(".new")  # a full disk leaves the chapter as it was
    whole.write_text(stored(notebook), encoding="utf-8")
    whole.replace(path)
    return ""


def stored(notebook: NotebookNode) -> str:
    """Return a notebook that was run as text, with its solutions folded and its widgets named."""
    notebook.metadata.language_info.pop("version", None)
    fold(notebook)
    count = 0
    for cell in notebook.cells:
        if cell.cell_type == "code":
            count += 1
            cell.execution_count = count
            for output in cell.outputs:
                if "execution_count" in output:
                    output.execution_count = count
    show_interact(notebook)
    names = {random: f"widget-{place:03}" for place, random in enumerate(slim(notebook), 1)}
    text = nbformat.writes(notebook)
    if names:
        text = re.sub("|".join(names), lambda match: names[match[0]], text)
    return nbformat.writes(nbformat.reads(text, as_version=4)) + "\n"  # sorted by the new names


def fold(notebook: NotebookNode) -> None:
    """Fold the solutions. JupyterLab unfolds what is run, but not below a folded heading.

    A check is folded too, but the section that it stands in is not.
    """
    heading = None
    for cell in notebook.cells:
        if cell.cell_type == "markdown" and cell.source.startswith("#"):
            heading = cell
            heading.metadata.pop("jp-MarkdownHeadingCollapsed", None)
        elif "hide-cell" in cell.metadata.get("tags", ()):
            cell.metadata["jupyter"] = {"source_hidden": True, "outputs_hidden": True}
            if not cell.source.startswith("# Check"):
                heading.metadata["jp-MarkdownHeadingCollapsed"] = True


def show_interact(notebook: NotebookNode) -> None:
    """Give what `interact` shows to hosts that have no widgets, too."""
    models = notebook.metadata.get("widgets", {}).get(WIDGETS, {}).get("state", {})
    for cell in notebook.cells:
        for output in cell.get("outputs", ()):
            view = output.get("data", {}).get(VIEW, {})
            model = models.get(view.get("model_id"), {}).get("state", {})
            if "widget-interact" not in model.get("_dom_classes", ()):
                continue
            names = (child.removeprefix("IPY_MODEL_") for child in model["children"])
            drawn = (models[name]["state"].get("outputs", ()) for name in names)
            pictures = [it["data"]["text/html"] for outputs in drawn for it in outputs]
            output.data["text/html"] = "".join(pictures)


def slim(notebook: NotebookNode) -> dict:
    """Drop what is unset in the widgets' state; return it by random name, in order of creation."""
    widgets = notebook.metadata.get("widgets", {}).get(WIDGETS, {}).get("state", {})
    for widget in widgets.values():
        widget["state"] = {
            name: value for name, value in widget["state"].items() if value is not None
        }
    return widgets


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("chapters", nargs="*", metavar="NN", help="two digits, such as 00 04")
    main(parser.parse_args().chapters)
