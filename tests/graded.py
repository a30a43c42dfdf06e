"""An assignment of the course run in this process."""

import contextlib
import json
import linecache
import re
import tomllib
from functools import cache
from pathlib import Path
from typing import Any

from wmrlib import Gains

ROOT = Path(__file__).parents[1]
ASSIGNMENTS = sorted(path.name for path in (ROOT / "book/course/source").iterdir() if path.is_dir())
STUB = 'raise NotImplementedError("write your answer here")'
SOLUTION = re.compile("<summary>Solution.*?</details>", re.DOTALL)
BEGIN, END = "### BEGIN SOLUTION", "### END SOLUTION"


def notebook(chapter: str) -> Path:
    """The lecturer's notebook, with the model answers."""
    (path,) = (ROOT / "book/course/source" / chapter).glob("*.ipynb")
    return path


@cache
def cells(chapter: str) -> dict[str, tuple[str, int]]:
    """{id: (source, points)} of the code cells; a cell that is not graded has 0 points."""
    found = {}
    for cell in json.loads(notebook(chapter).read_text(encoding="utf-8"))["cells"]:
        if cell["cell_type"] == "code":
            settings = cell["metadata"]["nbgrader"]
            points = settings.get("points", 0) if settings["grade"] else 0
            found[settings["grade_id"]] = "".join(cell["source"]), points
    return found


@cache
def tasks(chapter: str) -> dict[str, list[str]]:
    """{id of the cell with the answer: ids of the cells that grade it}; none grades the name."""
    found: dict[str, list[str]] = {}
    for name, (source, points) in cells(chapter).items():
        if BEGIN in source:
            found[name] = graded = []
        elif points:
            graded.append(name)
    return found


def graded(chapter: str, key: str) -> list[str]:
    """The graded cells of a task, or those whose id is `key` or begins with it."""
    every = [name for names in tasks(chapter).values() for name in names]
    return tasks(chapter).get(key) or [
        name for name in every if name == key or name.startswith(key + "-")
    ]


def task_of(chapter: str, key: str) -> str:
    """The cell with the answer that these graded cells grade."""
    wanted = set(graded(chapter, key))
    (found,) = (name for name, names in tasks(chapter).items() if wanted & set(names))
    return found


@cache
def answers(chapter: str) -> dict:
    """The right and wrong answers in the chapter's file of data."""
    return tomllib.loads((ROOT / f"tests/data/course/{chapter}.toml").read_text(encoding="utf-8"))


@cache
def wrong_answers(chapter: str) -> list[dict]:
    """The usual mistakes: cell, source, hint, and exactly the graded cells that it loses."""
    found = []
    for loses, table in answers(chapter)["mistake"].items():
        cell = task_of(chapter, loses.split()[0])
        model, _ = cells(chapter)[cell]
        for hint, wrong in table.items():
            source = edited(model, wrong) if " => " in wrong else f"{target(model)} = {wrong}"
            row = {"name": hint, "hint": hint, "loses": loses.split()}
            found.append({**row, "cell": cell, "source": source})
    return found


def target(model: str) -> str:
    """The name that a cell with an answer makes."""
    return re.match(r"(?:def )?(\w+)", model)[1]


def whole(chapter: str, key: str, answer: str) -> str:
    """The cell that a right or another wrong answer in the file of data stands for."""
    task, data = task_of(chapter, key), answers(chapter)
    model, frames = cells(chapter)[task][0], data.get("frame", {})
    name = target(model)
    if " => " in answer:
        answer = edited(model, answer)
    elif not re.search(rf"^(def )?{name}\b *[(=]", answer, re.M):
        frame = frames.get(key) or frames.get(task) or name + " = {}"
        answer = frame.replace("{}", answer)
    return data.get("setup", "") + answer


def edited(source: str, edits: str) -> str:
    """The source after one or several edits, `old => new || old => new`."""
    for edit in edits.split(" || "):
        old, new = edit.split(" => ")
        assert old in source, edit
        source = source.replace(old, new)
    return source


def released(source: str) -> str:
    """What a student gets in the place of a cell with an answer."""
    before, begin, rest = source.partition(BEGIN)
    return before + STUB + rest.partition(END)[2] if begin else source


@cache
def given(chapter: str, student: str = "Ada") -> dict:
    """The names that the notebook's other cells make for a student, with the model's answers.

    What an assistant alone looks at is left out.
    `scaled` makes gains of the paper's robot those of the student's.
    """
    names = {"__name__": "__main__"}
    for name, (source, points) in cells(chapter).items():
        if not points and (name == "name" or tasks(chapter).get(name) != []):
            run_cell(
                source.replace('name = "model"', f"name = {student!r}"),
                f"<{chapter} {name}>",
                names,
            )
    if hasattr(names.get("mine"), "metre"):
        metre, second = names["mine"].metre, names["mine"].second
        names["scaled"] = lambda k_rho, k_alpha, h, v_max=4.0: Gains(
            k_rho / metre, k_alpha / second, h, v_max * metre / second
        )
    return names


def run_cell(source: str, name: str, names: dict) -> None:
    """Run a cell; as in Jupyter, `inspect` finds its source."""
    linecache.cache[name] = len(source), None, source.splitlines(keepends=True), name
    exec(compile(source, name, "exec"), names)


def lost(chapter: str, key: str, answer: Any, student="Ada", by="") -> dict[str, str]:
    """How those of the graded cells `key` that fail with this answer do so.

    The answer, a cell or what it makes, is made with the numbers of `by`, if another's.
    """
    names, found = dict(given(chapter, by or student)), {}
    if isinstance(answer, str):
        with contextlib.suppress(Exception):  # then the graded cells fail
            run_cell(answer, f"<{chapter} answer>", names)
    else:
        names[target(cells(chapter)[task_of(chapter, key)][0])] = answer
    if "mine" in names:
        names["mine"] = given(chapter, student)["mine"]
    for name in graded(chapter, key):
        try:
            run_cell(cells(chapter)[name][0], f"<{chapter} {name}>", names)
        except Exception as error:
            found[name] = f"{type(error).__name__}: {error}"
    return found


@cache
def closed() -> list[str]:
    """Plain words of each solution of an exercise, and of each paragraph of the lecturer's guide.

    They are the lecturer's alone.
    """
    chapters = (path.read_text(encoding="utf-8") for path in (ROOT / "notebooks").glob("*.ipynb"))
    cells = ("".join(cell["source"]) for text in chapters for cell in json.loads(text)["cells"])
    texts = [each for cell in cells for each in SOLUTION.findall(cell)]
    guide = (ROOT / "book/lecturers.md").read_text(encoding="utf-8")
    texts += re.sub("^```.*?^```", "", guide, flags=re.MULTILINE | re.DOTALL).split("\n\n")[1:]
    runs = (run.strip() for each in texts for run in re.findall("[A-Za-z, ]{31,}", each))
    return sorted({run for run in runs if len(run) > 30})


def leaks(folder: Path) -> list[str]:
    """What is the lecturer's alone, and stands in a file of the folder."""
    kinds = {".html", ".js", ".ipynb", ".md", ".txt"}
    paths = [it for it in folder.rglob("*") if it.suffix in kinds and "vendor" not in it.parts]
    texts = [" ".join(it.read_text(encoding="utf-8").split()) for it in paths]
    return [each for each in closed() if any(each in text for text in texts)]


@cache
def exercises() -> dict[str, dict[str, str]]:
    """Of each check of wmrbook.grading.exercises: `answer` and `more`, and an edit a hint."""
    return tomllib.loads((ROOT / "tests/data/exercises.toml").read_text(encoding="utf-8"))


def mistold(name: str) -> list[tuple[str, str]]:
    """Words that the check of an exercise should say, and what it says instead."""
    from wmrbook.grading import exercises as checks

    (_, model), *edits = exercises()[name].items()
    found, sources = [], {words: edited(model, edit) for words, edit in edits}
    for words, source in {"Right": model, **sources}.items():
        told = getattr(checks, name)(*_answers(name, source))
        if words not in told or told.startswith("Hint: ") == (words == "Right"):
            found.append((words, told))
    return found


def right(name: str) -> list:
    """The right answers of an exercise: one, or two."""
    return _answers(name, exercises()[name]["answer"])


def _answers(name: str, source: str) -> list:
    names = {}
    run_cell(source, f"<{name}>", names)
    return [names[it] for it in ("answer", "more") if it in names]
