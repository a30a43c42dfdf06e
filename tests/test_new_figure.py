"""A live figure added to a copy by the steps of CONTRIBUTING.md lives, is true and has a place."""

import json

import pytest
from recipes import blocks, check, copied, put, run

pytestmark = [pytest.mark.slow, pytest.mark.needs("npm", "browser")]


def test_the_recipe_leaves_every_test_of_live_figures_green(tmp_path):
    copy, (drawing, function, truth) = copied(tmp_path / "copy"), blocks("To add a live figure")
    live = copy / "book" / "wmrbook" / "live"
    drawings = copy / "book" / "wmrbook" / "panel" / "kit" / "live"
    (drawings / "half_round.js").write_text(drawing, encoding="utf-8")
    put(live / "robot.py", f"{function}\n\n", "def one_step() -> Live:")
    put(live / "__init__.py", '"half_round", ', '"one_step", "turning_centre"]')
    truths = copy / "tests" / "browser" / "test_live_truth.py"
    put(truths, f"{truth}\n\n", "TRUTH = {")
    chapter = copy / "notebooks" / "02_the_robot.ipynb"
    notebook = json.loads(chapter.read_text(encoding="utf-8"))
    shown = [cell for cell in notebook["cells"] if "live." in "".join(cell["source"])]
    cell = json.loads(json.dumps(shown[-1])) | {"id": "half-round", "source": "live.half_round()"}
    notebook["cells"].insert(notebook["cells"].index(shown[-1]) + 1, cell)
    chapter.write_text(json.dumps(notebook), encoding="utf-8")
    run(copy, "book/tools/kit.py")
    run(copy, "book/tools/run.py", "02")
    browser = ("tests/browser/test_live.py", "tests/browser/test_live_truth.py")
    check(copy, *browser, "-k", "half_round")
    check(copy, "tests/test_project.py", "-k", "move or stored")
