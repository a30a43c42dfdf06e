"""Each chapter begins by installing the library, but only where it is missing."""

import importlib.metadata
import importlib.util
import json
import shutil
import subprocess
from pathlib import Path
from types import SimpleNamespace

import first_cell
import pages
import pytest

from wmrbook import data

ROOT = Path(__file__).parents[1]
CHAPTERS = sorted((ROOT / "notebooks").glob("[0-9][0-9]_*.ipynb"))
ADDRESS = "https://example.org/someone/robot"


@pytest.fixture
def run(monkeypatch):
    """Run the cell where the library comes, or doesn't, with `pip`; return what pip was told."""

    def run_cell(address="", *, there=False, comes=True, says=""):
        commands = []

        def install(command, **options):
            commands.append(command)
            return SimpleNamespace(returncode=not comes, stderr=says)

        def find(name):
            return (name == "wmrbook" and (there or (comes and commands))) or None

        monkeypatch.setattr(subprocess, "run", install)
        monkeypatch.setattr(importlib.util, "find_spec", find)
        exec(first_cell.source(address), {})
        return commands

    return run_cell


@pytest.mark.parametrize("path", CHAPTERS, ids=lambda path: path.stem)
def test_each_chapter_has_the_cell_of_now(path):
    """Else run book/tools/first_cell.py."""
    text = path.read_text(encoding="utf-8")
    title, cell, *_ = json.loads(text)["cells"]
    assert title["source"][0].startswith("# ")
    assert "".join(cell["source"]) == first_cell.source(first_cell.address())
    assert (cell["metadata"], cell["execution_count"]) == (first_cell.METADATA, 1)
    assert first_cell.with_cell(json.loads(text)) == json.loads(text)


@pytest.mark.parametrize("address", ["", ADDRESS])
def test_where_the_library_is_there_it_does_nothing(run, address, capsys):
    assert run(address, there=True) == []
    assert capsys.readouterr().out == ""


def test_a_missing_library_is_installed_from_the_repository(run, capsys):
    (command,) = run(ADDRESS)
    assert command[1:4] == ["-m", "pip", "install"]
    assert command[-1] == f"wmrlib[chapters] @ {ADDRESS}/archive/HEAD.zip"
    assert capsys.readouterr().out.endswith("It is installed.\n")


def test_without_an_address_it_says_what_to_install(run):
    with pytest.raises(ModuleNotFoundError, match=r'Download the book .*pip install "\.\[book\]"'):
        run()


def test_where_pip_fails_its_reason_is_shown_and_what_to_do(run, capsys):
    with pytest.raises(ModuleNotFoundError, match=f"Download {ADDRESS} and"):
        run(ADDRESS, comes=False, says="no network")
    assert "no network" in capsys.readouterr().out


def test_what_was_loaded_before_it_was_renewed_asks_for_a_restart(run, monkeypatch):
    monkeypatch.setattr(importlib.metadata, "version", lambda name: "99")
    with pytest.raises(ImportError, match="Restart the kernel"):
        run(ADDRESS)


def test_a_chapter_finds_its_data_from_any_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert len(data.NAMES) == 3
    assert all(data.path(name).is_file() for name in data.NAMES)
    with pytest.raises(ValueError, match=r"name = 'log.nmea' is not allowed.*ublox5-standing.nmea"):
        data.path("log.nmea")


def test_a_page_offers_colab_once_the_repository_has_an_address():
    name = "notebooks/04_lyapunov.ipynb"
    assert "Colab" not in pages.how_to_run(name, "")
    assert "Colab" not in pages.how_to_run(name, ADDRESS)  # it opens what GitHub has
    button = "https://colab.research.google.com/github/someone/robot/blob/main/" + name
    assert f'href="{button}"' in pages.how_to_run(name, "https://github.com/someone/robot")


@pytest.mark.skipif(not shutil.which("git"), reason="this test needs git")
def test_git_for_windows_leaves_every_byte_as_it_is(tmp_path):
    """It would turn line ends into CRLF, and so the receivers' logs and the C headers."""
    folders = "notebooks", "wmrlib", "book/wmrbook", "book/robot", "book/deck", ".ci"
    paths = [path for name in folders for path in (ROOT / name).rglob("*") if path.is_file()]
    kinds = {path.suffix: path for path in paths if "__pycache__" not in path.parts}
    assert {".ipynb", ".nmea", ".ubx", ".h", ".py", ".js", ""} <= kinds.keys()
    kinds["attributes"] = ROOT / ".gitattributes"
    for path in kinds.values():
        shutil.copy(path, tmp_path)

    def git(*command):
        options = "-c", "core.autocrlf=true", "-c", "core.safecrlf=false"
        subprocess.run(["git", *options, *command], cwd=tmp_path, check=True, capture_output=True)

    git("init")
    git("add", "--all")
    for path in kinds.values():
        (tmp_path / path.name).unlink()
    git("checkout", "--", ".")
    for path in kinds.values():
        assert (tmp_path / path.name).read_bytes() == path.read_bytes(), path
