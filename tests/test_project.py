"""What the repository promises of itself: the locked environment, the README's commands, the chapters' form."""

import re
import tomllib
from pathlib import Path

import nbformat
import pytest
from packaging.requirements import Requirement

ROOT = Path(__file__).parent.parent
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
CHAPTERS = sorted((ROOT / "notebooks").glob("*.ipynb"))
README = (ROOT / "README.md").read_text(encoding="utf-8")


def test_the_lock_pins_every_direct_dependency_within_its_range():
    pins = [Requirement(line) for line in (ROOT / "environment.txt").read_text(encoding="utf-8").splitlines() if line[:1].isalnum()]
    locked = {}
    for pin in pins:
        assert str(pin.specifier).startswith("=="), pin
        locked.setdefault(pin.name.lower(), []).append(str(pin.specifier)[2:])
    wanted = [*PROJECT["dependencies"], *(line for extra in PROJECT["optional-dependencies"].values() for line in extra)]
    for requirement in map(Requirement, wanted):
        versions = locked.get(requirement.name.lower(), [])
        assert versions, f"{requirement.name} is not in environment.txt"
        assert all(version in requirement.specifier for version in versions), requirement


def test_the_readmes_commands_name_files_that_exist():
    commands = [line.strip() for line in README.splitlines() if "-m venv" in line]
    assert [("jupyter lab" in line, "pytest" in line) for line in commands] == [(True, False)] * 2 + [(False, True)] * 2
    for line in README.splitlines():
        for name in re.findall(r"^    .*?(?:-r |lab |python |paths=)([\w.\\/-]+[./\\][\w.\\/-]+)", line):
            assert (ROOT / name.replace("\\", "/")).exists(), name


@pytest.mark.parametrize("path", CHAPTERS, ids=lambda path: path.stem)
class TestChapter:
    def test_cells_are_small_and_executed_in_order(self, path):
        code = [cell for cell in nbformat.read(path, as_version=4).cells if cell.cell_type == "code"]
        assert [cell.execution_count for cell in code] == list(range(1, len(code) + 1))
        assert all(len(cell.source.splitlines()) <= 20 for cell in code)

    def test_it_has_objectives_exercises_with_solutions_and_a_summary(self, path):
        prose = "\n".join(cell.source for cell in nbformat.read(path, as_version=4).cells if cell.cell_type == "markdown")
        for part in ("After this chapter you can", "## Exercises", "<summary>Solution</summary>", "## Summary"):
            assert part in prose

    def test_every_picture_has_its_text(self, path):
        outputs = [output for cell in nbformat.read(path, as_version=4).cells for output in cell.get("outputs", ())]
        pictures = [output for output in outputs if "image/png" in output.get("data", {})]
        assert pictures
        for picture in pictures:
            assert len(picture.metadata["image/png"]["alt"]) > 60
            assert picture.data["text/html"].startswith('<img alt="')
