"""What is the lecturer's alone, and stands in nothing that students get."""

import json
import re
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[1]
SOLUTION = re.compile("<summary>Solution.*?</details>", re.DOTALL)


@cache
def closed() -> list[str]:
    """Plain words of each solution of an exercise, and of each paragraph of the lecturer's guide.

    They are the lecturer's alone; words that a chapter says too are not.
    """
    chapters = (path.read_text(encoding="utf-8") for path in (ROOT / "notebooks").glob("*.ipynb"))
    cells = ["".join(cell["source"]) for text in chapters for cell in json.loads(text)["cells"]]
    open_letters = letters("".join(SOLUTION.sub("", cell) for cell in cells))
    texts = [solution for cell in cells for solution in SOLUTION.findall(cell)]
    guide = (ROOT / "book/lecturers.md").read_text(encoding="utf-8")
    texts += re.sub("^```.*?^```", "", guide, flags=re.MULTILINE | re.DOTALL).split("\n\n")[1:]
    runs = (run.strip() for solution in texts for run in re.findall("[A-Za-z, ]{31,}", solution))
    return sorted({run for run in runs if len(run) > 30 and letters(run) not in open_letters})


def letters(text: str) -> str:
    return re.sub("[^a-z]", "", text.lower())


def leaks(folder: Path) -> list[str]:
    """What is the lecturer's alone, and stands in a file of the folder."""
    kinds = {".html", ".js", ".ipynb", ".md", ".txt"}
    paths = [it for it in folder.rglob("*") if it.suffix in kinds and "vendor" not in it.parts]
    texts = [" ".join(it.read_text(encoding="utf-8").split()) for it in paths]
    return [run for run in closed() if any(run in text for text in texts)]
