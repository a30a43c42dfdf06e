"""What the repository promises a user or a reader: locks, commands, links, numbers, panels."""

import os
import re
import shutil
import subprocess
import sys
import tomllib
from importlib.metadata import packages_distributions
from pathlib import Path

import build
import nbformat
import pytest
import stills as take
from lecturers import closed
from packaging.requirements import Requirement
from pybtex.database import parse_file

from wmrbook import live, stages
from wmrbook.panel import Explorer, stills

ROOT = Path(__file__).parent.parent
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
BOOK = ROOT / "book"
CHAPTERS = {
    path.stem: nbformat.read(path, as_version=4)
    for path in sorted((ROOT / "notebooks").glob("*.ipynb"))
}
VIEW = "application/vnd.jupyter.widget-view+json"
STATE = "application/vnd.jupyter.widget-state+json"
CHECK = "book/lab/check_python.py"
TEXTS = [*ROOT.glob("*.md"), *BOOK.glob("*.md"), *(BOOK / "robot").rglob("README.md")]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def pins(lock):
    """Each package of a lock with its version; one may stand there for several Pythons."""
    lines = (ROOT / lock).read_text(encoding="utf-8").splitlines()
    requirements = [Requirement(line) for line in lines if line[:1].isalnum()]
    assert all(str(row.specifier).startswith("==") for row in requirements)
    return {(row.name.lower(), str(row.specifier)[2:]) for row in requirements}


@pytest.mark.parametrize(
    ("lock", "extras"),
    [
        ("environment.txt", ["book", "chapters"]),
        ("tests/environment.txt", ["book", "chapters", "site", "test"]),
    ],
)
def test_a_lock_pins_every_direct_dependency_within_its_range(lock, extras):
    assert pins(lock) <= pins("tests/environment.txt")
    optional = PROJECT["optional-dependencies"]
    wanted = [*PROJECT["dependencies"], *(line for extra in extras for line in optional[extra])]
    for requirement in map(Requirement, set(wanted) - {"wmrlib[chapters]"}):
        versions = [version for name, version in pins(lock) if name == requirement.name.lower()]
        assert versions, f"{requirement.name} is not in {lock}"
        assert all(version in requirement.specifier for version in versions), requirement


def test_the_readmes_commands_name_files_that_exist():
    commands = [line.strip() for line in README.splitlines() if "-m venv .venv && " in line]
    kinds = [("jupyter lab" in line, "pytest" in line) for line in commands]
    assert kinds == [(True, False)] * 2 + [(False, True)] * 2
    for command in commands[:2]:  # it needs no network
        assert f"\n\n    {command.split(' && ')[-1]}\n" in README
    checks = {command.split(" && ")[0] for command in commands}
    assert checks == {f"python3 {CHECK}", "py " + CHECK.replace("/", "\\")}
    shell = "\n".join(line for line in README.splitlines() if line.startswith("    "))
    named = re.findall(r"(?:-r |python3? |py |config=|paths=)(\w[\w.\\/-]+)", shell)
    named = [name.replace("\\", "/") for name in named]
    assert {"environment.txt", "book/lab/jupyter_lab_config.py"} < set(named)
    assert [name for name in named if not (ROOT / name).exists()] == []


@pytest.mark.parametrize("path", TEXTS, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_a_texts_links_lead_to_files_that_exist(path):
    text = re.sub(r"^```.*?^```", "", path.read_text(encoding="utf-8"), flags=re.M | re.S)
    links = re.findall(r"\]\((?!https?:|#|mailto:)([^)#\s]+)", text)
    places = (path.parent, ROOT)  # the book's pages are built beside the notebooks
    assert [it for it in links if not any((place / it).exists() for place in places)] == []


def test_the_guide_and_the_solutions_are_not_in_what_is_handed_out(tmp_path):
    build.copy_sources(tmp_path)
    paths = [*tmp_path.glob("*.md"), *tmp_path.glob("notebooks/*.ipynb")]
    text = "\n".join(path.read_text(encoding="utf-8") for path in paths).replace("\\n", "\n")
    text = " ".join(text.split())
    assert "## Exercises" in text
    for leak in "](lecturers.md", "<summary>Solution", "### BEGIN", *closed():
        assert leak not in text, leak
    for path in tmp_path.glob("notebooks/*.ipynb"):
        for cell in nbformat.read(path, as_version=4).cells:
            check = cell.source.startswith("# Check")
            assert check or "hide-cell" not in cell.metadata.get("tags", ()), cell.source


def test_a_python_is_refused_unless_pyproject_allows_it():
    sys.path.insert(0, str(BOOK / "lab"))
    import check_python

    allowed = Requirement(f"python{PROJECT['requires-python']}").specifier
    for minor in range(6, 20):
        message = check_python.refusal((3, minor, 0), "HERE")
        assert (message is None) == (f"3.{minor}" in allowed)
        assert not message or (
            "Python 3.11 to 3.14, and this is 3." in message and "(HERE)" in message
        )


@pytest.mark.skipif(os.name == "nt", reason="Windows has no LC_ALL")
def test_a_folder_that_this_python_cannot_read_is_refused_in_a_sentence(tmp_path):
    """Without it the new environment's Python ends with a fatal error, see check_python.py."""
    for name, encoding, fits in (
        ("M\u00fcller", "C.UTF-8", True),
        ("ascii", "C", True),
        ("M\u00fcller", "C", sys.version_info >= (3, 13)),
    ):
        for file in (CHECK, "pyproject.toml"):
            (tmp_path / name / file).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / file, tmp_path / name / file)
        variables = os.environ | {"LC_ALL": encoding}
        command = [sys.executable, tmp_path / name / CHECK]
        done = subprocess.run(command, env=variables, capture_output=True, encoding="utf-8")
        message = done.stderr.splitlines()
        assert (done.returncode, len(message)) == ((0, 0) if fits else (1, 1))
        assert fits or (f"({tmp_path / name})" in message[0] and "LC_ALL=C.UTF-8" in message[0])


@pytest.mark.slow
def test_the_benchmarks_find_what_they_measure():
    """They run by hand, so only this notices a name that has moved."""
    folder = ROOT / "tests" / "benchmarks"
    names = sorted(path.stem for path in folder.glob("*.py"))
    command = [sys.executable, "-c", f"import {', '.join(names)}"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_no_house_imports_a_private_module_of_another_and_no_test_uses_one():
    """A test may import what it tests: an integrator's table, say."""
    private = re.compile(r"^\s*from (wmr\w+)(?:\.\w+)*(?:\.(_\w+)| import (_\w+)\b)", re.MULTILINE)
    tested = {("test_plots.py", "_drawing")}
    tested |= {("test_simulation.py", "_dop853"), ("test_sweeping.py", "_dop853")}
    folders = ("wmrlib", "book", "tests")
    paths = [path for name in folders for path in (ROOT / name).rglob("*.py")]
    for path in paths:
        if "node_modules" in path.parts or "_build" in path.parts:
            continue
        for house, *names in private.findall(path.read_text(encoding="utf-8")):
            name = "".join(names)
            assert house in path.parts or (path.name, name) in tested, (path, name)


def test_without_sympy_the_expressions_say_what_to_install():
    code = "import sys; sys.modules['sympy'] = None; import wmrlib.symbolic"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    wanted = 'wmrlib.symbolic needs sympy: pip install ".[book]" in the repository'
    assert done.stderr.splitlines()[-1] == f"ImportError: {wanted}"


def test_without_the_books_packages_each_chapters_first_cell_says_what_to_install():
    """That wmrbook is imported first is ruff's to check: see notebooks/ruff.toml."""
    optional = map(Requirement, PROJECT["optional-dependencies"]["chapters"])
    names = {requirement.name for requirement in optional}
    packages = {it for it, of in packages_distributions().items() if names & set(of)}
    cells = [cell for name in CHAPTERS for cell in code(name)]
    sources = [*BOOK.glob("wmrbook/**/*.py")]
    text = "\n".join([cell.source for cell in cells] + [it.read_text("utf-8") for it in sources])
    used = packages & set(re.findall(r"^ *(?:import|from) (\w+)", text, re.MULTILINE))
    used.discard("z3")  # only chapter 13's helper imports it, when a proof is asked of it
    assert {"control", "sympy"} < used
    hidden = "import sys\n" + "\n".join(f"sys.modules[{it!r}] = None" for it in packages)
    tried = [
        f"try:\n    exec({code(name)[1].source!r})\nexcept ImportError as error:\n    print(error)"
        for name in CHAPTERS
    ]
    command = [sys.executable, "-c", "\n".join([hidden, *tried])]
    printed = subprocess.run(
        command, capture_output=True, text=True, check=True
    ).stdout.splitlines()
    assert len(printed) == len(CHAPTERS)
    (line,) = set(printed)
    named = re.fullmatch(r'wmrbook needs (.*): pip install "\.\[book\]" in the repository', line)
    assert set(named[1].split(", ")) == used


def prose(chapter):
    cells = CHAPTERS[chapter].cells
    return "\n".join(cell.source for cell in cells if cell.cell_type == "markdown")


def code(chapter):
    return [cell for cell in CHAPTERS[chapter].cells if cell.cell_type == "code"]


def outputs(chapter, kind):
    stored = [output for cell in code(chapter) for output in cell.outputs]
    return [output for output in stored if kind in output.get("data", {})]


def test_each_of_the_papers_equations_is_at_home_in_one_chapter():
    tags = re.findall(r"\\tag\{[\d.]+, paper (\d+)\}", "".join(map(prose, CHAPTERS)))
    assert sorted(map(int, tags)) == list(range(1, 27))


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
        by_name = work.persons["author"][0].last_names[0] in text
        assert addresses[key] in cited if addresses[key] else by_name, f"{key} is cited nowhere"


def test_a_solutions_code_is_folded_and_stands_below_a_folded_heading():
    for name, notebook in CHAPTERS.items():
        heading = None
        for cell in notebook.cells:
            if cell.cell_type == "markdown" and cell.source.startswith("#"):
                heading = cell
            check = cell.source.startswith("# Check")  # folded, in a section that is not
            solution = "hide-cell" in cell.metadata.get("tags", ()) and not check
            folded = heading.metadata.get("jp-MarkdownHeadingCollapsed", False)
            under_heading = cell.source.startswith(
                "<details>"
            )  # where an answer's cell stands above it
            assert cell is heading or (solution or under_heading) == folded, (
                f"{name}: {cell.source}"
            )
            if solution:
                assert re.match("### Exercise |#### Solution$", heading.source)
                assert cell.metadata.jupyter == {"source_hidden": True, "outputs_hidden": True}


def test_a_chapters_equations_are_numbered_in_order():
    for name in CHAPTERS:
        tags = re.findall(r"\\tag\{(\d+)\.(\d+)", prose(name))
        wanted = [(str(int(name[:2])), str(count)) for count in range(1, len(tags) + 1)]
        assert tags == wanted, name


def test_the_stored_panels_are_those_of_now():
    """Else run book/tools/run.py: without their state a reader sees no panel before it is run."""
    things = [
        getattr(house, name)()
        for house in (live, stages)
        for name in set(house.__all__) - house.PARTS
    ]
    now = {it.program: (it.contract, it._esm) for it in (Explorer(), *things)}
    for name, notebook in CHAPTERS.items():
        state = notebook.metadata.get("widgets", {}).get(STATE, {}).get("state", {})
        shown = {output.data[VIEW]["model_id"] for output in outputs(name, VIEW)}
        assert shown <= set(state), name
        shown = {it for it in shown if state[it]["model_name"] == "AnyModel"}
        drawn = [it["state"] for it in state.values() if it["model_name"] == "AnyModel"]
        assert len(drawn) == len(shown)
        for it in drawn:
            fresh = now[it["program"]] == (it["contract"], it["_esm"])
            assert fresh, f"{name}: book/tools/run.py stores {it['program']} anew"


def test_each_panel_that_the_book_offers_has_a_picture_and_no_other_is_kept():
    """Else run book/tools/stills.py."""
    wanted = {stills.digest(*it) for it in (*take.offered(), *take.stored())}
    assert {path.stem for path in stills.FOLDER.glob("*.html")} == wanted


def test_what_moves_stands_in_one_chapter_and_its_prediction_is_still_open():
    placed = []
    for name, notebook in CHAPTERS.items():
        here = re.findall(r"\blive\.(\w+)\(\)", "\n".join(it.source for it in code(name)))
        placed += here
        widgets = notebook.metadata.get("widgets", {}).get(STATE, {}).get("state", {}).values()
        states = [it["state"] for it in widgets if "ask" in it["state"].get("setup", ())]
        assert len(states) == len(here), name
        assert all(it["state"]["guess"] is None for it in states), name
    assert sorted(placed) == sorted(set(live.__all__) - live.PARTS)
