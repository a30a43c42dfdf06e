"""Files that go to students and come back: one student's trouble, or attack, stops nobody else."""

import ctypes
import os
import shutil
import subprocess
import sys
import time
import zipfile
from datetime import UTC, datetime
from pathlib import Path

import exchange
import handins
import homes
import pytest
from nbgrader.utils import parse_utc

NAME = "01_gps_to_metres.ipynb"
CELL = '{"metadata": {"nbgrader": {"grade_id": "distance-known"}}}'
POSIX = pytest.mark.skipif(os.name != "posix", reason="this system has no such files")
RACE = 0.7  # s
LINKS = {"dangling link": "nowhere", "link to itself": "", "link out": "aside"}
KINDS = {  # what may be in the place of a file or a folder
    "fifo": getattr(os, "mkfifo", None),
    "sparse": lambda path: path.touch() or os.truncate(path, 2 << 30),
    **{kind: lambda path, to=to: path.symlink_to(to or path.name) for kind, to in LINKS.items()},
}


@pytest.fixture(name="course")
def small_course(tmp_path):
    """A course with two assignments and three students."""
    course = tmp_path / "course"
    for assignment, name, cell in ("ch01", NAME, "distance-known"), ("ch02", "02_b.ipynb", "b"):
        path = course / "source" / assignment / name
        path.parent.mkdir(parents=True)
        path.write_text(CELL.replace("distance-known", cell))
    lines = "username,name,email,id,group", "ada3,Ada Lovelace,,123,Blue", "zoe,Zoë Ōe-Smith,,,Red"
    (course / "students.csv").write_text("\n".join([*lines, "bob,Bob van Dam,,9,"]), "utf-8")
    return course


def work(tmp_path, student: str, name: str = NAME, text: str = CELL) -> Path:
    """A notebook in a student's home."""
    path = tmp_path / "homes" / student / "robot" / "assignments" / "ch01" / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


def page(course, student: str) -> None:
    path = course / "feedback" / student / "ch01" / "page.html"
    path.parent.mkdir(parents=True)
    path.write_text(student)


def collected(tmp_path, course) -> tuple[dict[str, str], str]:
    """What of each student is submitted, and what is said."""
    _, said = exchange.collect(tmp_path / "homes", course)
    files = course.glob(f"submitted/*/ch01/{NAME}")
    return {path.parts[-3]: path.read_text() for path in files}, "\n".join(said)


def returned(tmp_path, course) -> tuple[list[str], str]:
    """The pages that students get, and what is said."""
    copies, said = exchange.give_back(tmp_path / "homes", course / "feedback")
    return [path.read_text() for path in copies], "\n".join(said)


def spoil(path: Path, kind: str) -> None:
    """Put something of this kind in the place of a file or a folder, which is then aside."""
    aside = path.with_name("aside")
    path.rename(aside) if path.exists() else aside.mkdir()
    KINDS[kind](path)


def test_the_newest_notebook_is_collected_with_its_time_and_all_are_named(tmp_path, course):
    old, new = work(tmp_path, "ada", text="old"), work(tmp_path, "ada", "mine (1).ipynb", "new")
    os.utime(old, (0, 1_700_000_000))
    os.utime(new, (0, 1_700_086_400.25))
    found, said = collected(tmp_path, course)
    assert found == {"ada": "new"}
    assert f"ada, ch01: 2 notebooks, {NAME}, mine (1).ipynb; mine (1).ipynb was taken" in said
    stamp = (course / "submitted/ada/ch01/timestamp.txt").read_text().strip()
    assert parse_utc(stamp) == datetime.fromtimestamp(1_700_086_400, UTC).replace(tzinfo=None)
    os.utime(old, (0, 1_700_090_000))
    assert collected(tmp_path, course)[0] == {"ada": "old"}
    assert "was changed or moved at" in said or os.name != "posix"
    path, odd = handins.find(old.parent, NAME)  # as one who has copied the folder by hand
    assert (path.name, odd) == (NAME, [f"{NAME} was taken of {NAME}, mine (1).ipynb"])


@pytest.mark.parametrize(("more", "blanks"), [("", 1), ("#", 1), ("", 10**6)])
def test_what_nobody_began_is_not_collected(tmp_path, course, more, blanks):
    """Nor read where it is longer than any release."""
    text = '{"cells": [{"source": ["name = \\"\\"", "\\n"]}, {"source": ""}]}'
    (course / "release" / "ch01").mkdir(parents=True)
    (course / "release" / "ch01" / NAME).write_text(text)
    own = text.replace(r"\"\"", r"\"ada\"").replace(r"\n", r"\n" + more)
    own = own.replace(" ", " " * blanks, 1)
    work(tmp_path, "ada", text=own)
    assert collected(tmp_path, course) == ({"ada": own} if more or blanks > 1 else {}, "")


@POSIX
@pytest.mark.parametrize("part", ["robot", "assignments", "ch01", NAME])
@pytest.mark.parametrize("kind", [*KINDS, "folder"])
def test_what_is_no_notebook_is_named_and_the_others_are_collected(
    tmp_path, course, monkeypatch, part, kind
):
    path = work(tmp_path, "bad")
    work(tmp_path, "zed")
    if kind == "folder" and part == NAME:
        path.unlink()
        path.mkdir()
    elif kind == "folder":  # of a million files
        monkeypatch.setattr(homes, "MOST_NAMES", 1)
        work(tmp_path, "bad", "b.ipynb")
        part = "ch01"
    else:
        spoil(next(each for each in (path, *path.parents) if each.name == part), kind)
    found, said = collected(tmp_path, course)
    assert (found, said.count("\n")) == ({"zed": CELL}, 0)
    assert said.startswith("bad")
    assert f": not collected: {part} " in said
    if part == NAME:
        work(tmp_path, "bad", "good.ipynb", "good")
        assert collected(tmp_path, course)[0] == {"zed": CELL, "bad": "good"}


@POSIX
@pytest.mark.parametrize("kind", KINDS)
def test_pages_come_back_whatever_one_student_has_in_their_place(tmp_path, course, kind):
    for student in "ada", "bad", "gone", "zed":
        page(course, student)
        (tmp_path / "homes" / student / "robot").mkdir(parents=True)
    (tmp_path / "homes/gone").rename(tmp_path / "gone")
    feedback = tmp_path / "homes/bad/robot/feedback"
    spoil(feedback, kind)
    pages, said = returned(tmp_path, course)
    assert pages == ["ada", "zed"]
    assert said.startswith("bad, ch01: not returned: feedback is no folder")
    assert said.endswith("gone is no home")
    assert not [*feedback.with_name("aside").iterdir()]
    feedback.unlink()
    (feedback / "ch01").mkdir(parents=True)
    spoil(place := feedback / "ch01" / "page.html", kind)
    assert returned(tmp_path, course)[0] == ["ada", "bad", "zed"]
    place.unlink()
    place.mkdir()
    pages, said = returned(tmp_path, course)
    assert pages == ["ada", "zed"]
    assert said.startswith("bad, ch01: not returned: ")
    assert {path.name for path in place.parent.iterdir()} == {"page.html", "aside"}


@pytest.mark.parametrize("what", ["a file", "collect", "return", "hand out"])
def test_no_exchange_for_a_link_leads_out_of_a_home(tmp_path, course, what):
    """While a file or folder and a link beside it change places, as fast as it goes."""
    if sys.platform != "linux" or not hasattr(ctypes.CDLL(None), "renameat2"):
        pytest.skip("this system exchanges no files in one step")
    path, aside = work(tmp_path, "bad"), tmp_path / "aside"
    home, to = path.parents[3], aside
    (aside / "ch01").mkdir(parents=True)
    (aside / "ch01" / NAME).write_text("secret")
    page(course, "bad")
    with zipfile.ZipFile(package := tmp_path / "students.zip", "w") as files:
        files.writestr("robot/assignments/ch01/new.txt", "new")
    one, does = path.parents[1], lambda: collected(tmp_path, course)[1]
    if what == "a file":
        one, to = path, aside / "ch01" / NAME
    elif what == "return":
        one = home / "robot" / "feedback"
        does = lambda: exchange.give_back(home.parent, course / "feedback")[1]  # noqa: E731
        (one / "ch01").mkdir(parents=True)
    elif what == "hand out":
        does = lambda: exchange.hand_out(home, package)  # noqa: E731
    (link := one.with_name("link")).symlink_to(to)
    code = "import ctypes, sys\na, b = map(str.encode, sys.argv[1:])"
    code += "\nwhile not ctypes.CDLL(None).renameat2(-100, a, -100, b, 2): pass"
    end, seen = time.monotonic() + RACE, set()
    process = subprocess.Popen([sys.executable, "-c", code, one, link])
    try:
        while time.monotonic() < end:
            seen.add(bool(does()))
            submitted = course.glob(f"submitted/bad/ch01/{NAME}")
            assert {each.read_text() for each in submitted} <= {CELL}
        assert process.poll() is None
    finally:
        process.kill()
        process.wait()
    assert [path.name for path in (aside / "ch01").iterdir()] == [NAME]
    assert len(seen) == 2 or os.cpu_count() == 1  # it did hit both


@pytest.mark.skipif(os.name != "posix" or os.geteuid() != 0, reason="only root gives files away")
def test_what_root_writes_into_a_home_is_its_owners(tmp_path, course):
    page(course, "ada")
    home = tmp_path / "homes" / "ada"
    home.mkdir(parents=True)
    os.chown(home, 4321, 4322)
    returned(tmp_path, course)
    owners = {(p.stat().st_uid, p.stat().st_gid) for p in [home, *home.rglob("*")]}
    assert owners == {(4321, 4322)}
    (secret := tmp_path / "secret").write_text("secret")
    path = work(tmp_path, "ada")
    path.unlink()
    path.hardlink_to(secret)
    found, said = collected(tmp_path, course)
    assert (found, "somebody else's" in said) == ({}, True)


def test_what_is_handed_out_replaces_nothing(tmp_path):
    (home := tmp_path / "home").mkdir()
    with zipfile.ZipFile(package := tmp_path / "students.zip", "w") as files:
        for name in "robot/a/mine.txt", "robot/b/more.txt", "../out.txt":
            files.writestr(name, "first")
    assert len(exchange.hand_out(home, package)) == 1
    (home / "robot/a/mine.txt").write_text("answer")
    shutil.rmtree(home / "robot/b")
    (home / "robot/b").touch()
    said = exchange.hand_out(home, package)
    assert (home / "robot/a/mine.txt").read_text() == "answer"
    assert any("robot/b/more.txt" in line for line in said)
    assert not (tmp_path / "out.txt").exists()


def test_without_descriptors_as_on_windows_the_same_files_go_both_ways(
    tmp_path, course, monkeypatch
):
    monkeypatch.setattr(homes, "SAFE", False)
    work(tmp_path, "ada")
    page(course, "ada")
    assert collected(tmp_path, course) == ({"ada": CELL}, "")
    assert returned(tmp_path, course) == (["ada"], "")
    shutil.rmtree(tmp_path / "homes/ada/robot/feedback")
    (tmp_path / "homes/ada/robot/feedback").symlink_to(tmp_path)
    assert returned(tmp_path, course)[0] == []
