"""What the repository promises of itself: the locks, the README's commands, the chapters' form."""

import re
import tomllib
from pathlib import Path

import nbformat
import pytest
from packaging.requirements import Requirement
from pybtex.database import parse_file

ROOT = Path(__file__).parent.parent
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
BOOK = ROOT / "book"
CHAPTERS = sorted((ROOT / "notebooks").glob("*.ipynb"))
README = (ROOT / "README.md").read_text(encoding="utf-8")


def pins(lock):
    """Each package of a lock with its version; one may stand there for several Pythons."""
    lines = (ROOT / lock).read_text(encoding="utf-8").splitlines()
    found = [Requirement(line) for line in lines if line[:1].isalnum()]
    assert all(str(each.specifier).startswith("==") for each in found)
    return {(each.name.lower(), str(each.specifier)[2:]) for each in found}


@pytest.mark.parametrize(
    ("lock", "extras"),
    [("environment.txt", ["book"]), ("tests/environment.txt", ["book", "site", "test"])],
)
def test_a_lock_pins_every_direct_dependency_within_its_range(lock, extras):
    assert pins(lock) <= pins("tests/environment.txt")
    optional = PROJECT["optional-dependencies"]
    wanted = [*PROJECT["dependencies"], *(line for extra in extras for line in optional[extra])]
    for requirement in map(Requirement, wanted):
        versions = [version for name, version in pins(lock) if name == requirement.name.lower()]
        assert versions, f"{requirement.name} is not in {lock}"
        assert all(version in requirement.specifier for version in versions), requirement


def test_the_readmes_commands_name_files_that_exist():
    commands = [line.strip() for line in README.splitlines() if "-m venv" in line]
    assert [("jupyter lab" in line, "pytest" in line) for line in commands] == [
        (True, False)
    ] * 2 + [(False, True)] * 2
    for line in README.splitlines():
        for name in re.findall(
            r"^    .*?(?:-r |lab |python |paths=)([\w.\\/-]+[./\\][\w.\\/-]+)", line
        ):
            assert (ROOT / name.replace("\\", "/")).exists(), name


def prose(path):
    return "\n".join(
        cell.source
        for cell in nbformat.read(path, as_version=4).cells
        if cell.cell_type == "markdown"
    )


def test_each_of_the_papers_equations_is_at_home_in_one_chapter():
    homes = [
        int(number)
        for path in CHAPTERS
        for number in re.findall(r"\\tag\{[\d.]+, paper (\d+)\}", prose(path))
    ]
    assert sorted(homes) == list(range(1, 27))


def test_every_work_that_is_cited_is_in_the_bibliography_and_every_work_there_is_cited():
    works = parse_file(BOOK / "references.bib").entries
    text = "\n".join(
        [*map(prose, CHAPTERS), *(path.read_text(encoding="utf-8") for path in BOOK.glob("*.md"))]
    )
    cited = set(re.findall(r"\]\((https?://[^)\s]+)\)", text))
    addresses = {
        key: f"https://doi.org/{it.fields['doi']}" if "doi" in it.fields else it.fields.get("url")
        for key, it in works.items()
    }
    assert cited <= set(addresses.values())
    for key, work in works.items():
        by_name = f"{work.persons['author'][0].last_names[0]}" in text
        assert addresses[key] in cited if addresses[key] else by_name, f"{key} is cited nowhere"


@pytest.mark.parametrize("path", CHAPTERS, ids=lambda path: path.stem)
class TestChapter:
    def test_cells_are_small_and_executed_in_order(self, path):
        code = [
            cell for cell in nbformat.read(path, as_version=4).cells if cell.cell_type == "code"
        ]
        assert [cell.execution_count for cell in code] == list(range(1, len(code) + 1))
        assert all(len(cell.source.splitlines()) <= 20 for cell in code)

    def test_it_has_objectives_and_a_summary(self, path):
        for part in ("After this chapter you can", "## Exercises", "## Summary"):
            assert part in prose(path)

    def test_each_exercise_has_its_number_and_a_folded_solution(self, path):
        exercises = re.split(r"^### Exercise ", prose(path), flags=re.MULTILINE)[1:]
        assert len(exercises) >= 3
        for count, exercise in enumerate(exercises, start=1):
            assert exercise.startswith(f"{int(path.name[:2])}.{count}: ")
            assert (
                exercise.count("<details><summary>Solution</summary>\n\n")
                == exercise.count("\n\n</details>")
                == 1
            )

    def test_its_equations_are_numbered_in_order(self, path):
        tags = re.findall(r"\\tag\{(\d+)\.(\d+)", prose(path))
        assert tags == [(str(int(path.name[:2])), str(count)) for count in range(1, len(tags) + 1)]

    def test_every_picture_has_its_text(self, path):
        outputs = [
            output
            for cell in nbformat.read(path, as_version=4).cells
            for output in cell.get("outputs", ())
        ]
        pictures = [output for output in outputs if "image/png" in output.get("data", {})]
        assert pictures
        for picture in pictures:
            assert len(picture.metadata["image/png"]["alt"]) > 60
            assert picture.data["text/html"].startswith('<img alt="')
