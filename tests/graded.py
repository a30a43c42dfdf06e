"""An assignment of the course run in this process: which graded cells fail, and with what hint; and nbgrader, as a lecturer runs it."""

import json
import os
import subprocess
import sys
import tomllib
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[1]
ASSIGNMENTS = sorted(path.name for path in (ROOT / "book/course/source").iterdir() if path.is_dir())
STUB = 'raise NotImplementedError("write your answer here")'
BEGIN, END = "### BEGIN SOLUTION", "### END SOLUTION"


@cache
def cells(chapter: str) -> list[tuple[str, str, int]]:
    """(id, source, points) of the code cells; points is 0 for a cell that is not graded."""
    (path,) = (ROOT / "book/course/source" / chapter).glob("*.ipynb")
    notebook = json.loads(path.read_text(encoding="utf-8"))
    code = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    settings = [cell["metadata"]["nbgrader"] for cell in code]
    return [
        (s["grade_id"], "".join(c["source"]), s.get("points", 0) if s["grade"] else 0)
        for c, s in zip(code, settings, strict=True)
    ]


@cache
def wrong_answers(chapter: str) -> list[dict]:
    return tomllib.loads((ROOT / f"tests/data/course/{chapter}.toml").read_text(encoding="utf-8"))[
        "answer"
    ]


def released(source: str) -> str:
    """What a student gets in the place of a cell with an answer."""
    if BEGIN not in source:
        return source
    before, _, rest = source.partition(BEGIN)
    return before + STUB + rest.partition(END)[2]


def grade(
    chapter: str, answers: dict[str, str] | None = None, *, empty: bool = False, graded: str = ""
) -> dict[str, str | None]:
    """Run the assignment with `answers` (from a cell's id to its source) in the place of the model's; {graded id: error or None}.

    graded: run only those graded cells whose id begins so.
    """
    names, found = {"__name__": "__main__"}, {}
    answers = answers or {}
    assert set(answers) <= {name for name, _, _ in cells(chapter)}
    for name, source, points in cells(chapter):
        if points and not name.startswith(graded):
            continue
        source = answers.get(name, released(source) if empty else source)
        try:
            exec(compile(source, f"<{name}>", "exec"), names)
            if points:
                found[name] = None
        except Exception as error:
            if points:
                found[name] = f"{type(error).__name__}: {error}"
            elif not answers and not empty:
                raise
    return found


def assert_loses(chapter: str, wrong: dict) -> None:
    """Exactly the graded cells that `wrong` names fail, one of them with its hint, and none by anything but a hint."""
    found = grade(chapter, {wrong["cell"]: wrong["source"]})
    lost = {name: error for name, error in found.items() if error is not None}
    assert list(lost) == wrong["loses"], lost
    assert all(error.startswith("Hint: ") for error in lost.values()), lost
    assert any(wrong["hint"] in error for error in lost.values()), lost


def assert_model_and_release(chapter: str) -> None:
    """The model answers pass everything, and the empty release nothing."""
    assert set(grade(chapter).values()) == {None}
    assert None not in grade(chapter, empty=True).values()
    for error in grade(chapter, empty=True).values():
        assert "not written yet" in error or "no value yet" in error


def lost(chapter: str, cell: str, source: str) -> dict[str, str]:
    """The graded cells of this answer that fail with it, and their hints."""
    found = grade(chapter, {cell: source}, graded=f"{cell}-")
    assert found
    return {name: error for name, error in found.items() if error is not None}


def nbgrader(folder: Path, *arguments: str) -> None:
    """Run one of its commands in the folder of a course."""
    environment = os.environ | {
        "PATH": os.pathsep.join(
            [str(Path(sys.executable).parent), os.environ.get("PATH", "")]
        ),  # it calls alembic by name
        "PYTHONPATH": os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH")])),
    }
    command = [sys.executable, "-m", "nbgrader", *arguments]
    done = subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, timeout=600
    )
    assert done.returncode == 0, done.stderr
