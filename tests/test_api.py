"""The API reference: it builds without a warning, and has an entry for each public name."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from sphinx.util.inventory import InventoryFile

import wmrlib as wmr
import wmrrobot as wr

BOOK = Path(__file__).resolve().parents[1] / "book"
CHAPTER = """# A chapter

It calls `wmr.simulate`, `simulate(start, goal)` and `paper.outdoor`, but not `rho`.

```python
import wmrlib as wmr
import wmrrobot as wr
wmr.simulate(a, wmr.paper.outdoor().goal, nothing.simulate)
wr.Drive(goal, gains, wheels)
```
"""


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    folder = tmp_path_factory.mktemp("api")
    source, html = folder / "source", folder / "html"
    source.mkdir()
    for page in ("api.md", "api_robot.md"):
        shutil.copy(BOOK / page, source)
    # Docstrings name the paper's equations, which link to the chapters.
    equations = [f"$$\nx \\tag{{1.{n}, paper {n}}}\n$$\n" for n in range(1, 27)]
    index = "\n".join([CHAPTER, *equations, "```{toctree}\napi\napi_robot\n```\n"])
    (source / "index.md").write_text(index, encoding="utf-8")
    command = [sys.executable, "-m", "sphinx", "-c", BOOK, "--fail-on-warning", "--nitpicky", "-q"]
    paths = os.pathsep.join(map(str, (BOOK.parent, BOOK, BOOK / "robot", BOOK / "tools")))
    settings = os.environ | {"PYTHONPATH": paths}
    subprocess.run([*command, source, html], cwd=source, env=settings, check=True)
    return html


def test_every_public_name_has_an_entry(site):
    inventory = InventoryFile.loads((site / "objects.inv").read_bytes(), uri="")
    entries = {name for names in inventory.data.values() for name in names}
    assert {f"wmrlib.{name}" for name in wmr.__all__} <= entries
    assert {f"wmrrobot.{name}" for name in wr.__all__} <= entries
    page = (site / "api.html").read_text(encoding="utf-8")
    assert page.count("Raises<span") > 20
    assert ":raises" not in page  # a section that was not understood


def test_sentences_and_code_link_to_the_entries(site):
    chapter = (site / "index.html").read_text(encoding="utf-8")
    assert chapter.count('href="api.html#wmrlib.simulate"') == 3
    assert chapter.count('href="api.html#wmrlib.paper.outdoor"') == 2
    assert chapter.count('href="api_robot.html#wmrrobot.Drive"') == 1
    assert chapter.count('href="api_robot.html"><span class="nn">wmrrobot<') == 1
