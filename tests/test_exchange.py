"""Files that go to students and come back: one student's trouble, or attack, stops nobody else."""

import ctypes
import os
import shutil
import subprocess
import sys
import time
import zipfile
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path

import exchange
import handins
import homes
import incoming
import pytest
import roster
from graded import ROOT
from nbgrader.utils import parse_utc

NAME = "01_gps_to_metres.ipynb"
CELL = '{"metadata": {"nbgrader": {"grade_id": "distance-known"}}}'
POSIX = pytest.mark.skipif(os.name != "posix", reason="this system has no such files")
RACE = 1.5  # s


@pytest.fixture
def course(tmp_path):
    """A course with two assignments and three students."""
    course = tmp_path / "course"
    for assignment, name, cell in ("ch01", NAME, "distance-known"), ("ch02", "02_b.ipynb", "b"):
        folder = course / "source" / assignment
        folder.mkdir(parents=True)
        (folder / name).write_text(CELL.replace("distance-known", cell))
    lines = "username,name,email,id,group", "ada3,Ada Lovelace,,123,Blue", "zoe,Zoë Ōe-Smith,,,Red"
    (course / "students.csv").write_text("\n".join([*lines, "bob,Bob van Dam,,9,"]), "utf-8")
    return course


def work(tmp_path, student: str, name: str = NAME, text: str = CELL) -> Path:
    """A notebook in a student's home."""
    path = tmp_path / "homes" / student / "robot" / "assignments" / "ch01" / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


def collected(tmp_path, course) -> tuple[dict[str, str], str]:
    """What of each student is submitted, and what is said."""
    _, said = exchange.collect(tmp_path / "homes", course)
    files = course.glob(f"submitted/*/ch01/{NAME}")
    return {path.parts[-3]: path.read_text() for path in files}, "\n".join(said)


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
    if os.name == "posix":
        assert "was changed or moved at" in said


def two_gigabytes(path):
    with path.open("wb") as file:
        file.truncate(2 << 30)


def loop(path):
    path.symlink_to(path)


BAD = {
    "fifo": os.mkfifo if os.name == "posix" else None,
    "folder": Path.mkdir,
    "dangling link": lambda path: path.symlink_to("nowhere"),
    "link to itself": loop,
    "link out": lambda path: path.symlink_to(ROOT / "LICENSE"),
    "sparse": two_gigabytes,
    "socket": lambda path: subprocess.run(
        [sys.executable, "-c", f"import socket; socket.socket(1).bind({path.name!r})"],
        check=True,
        cwd=path.parent,
    ),
}


@POSIX
@pytest.mark.parametrize("kind", BAD)
def test_what_is_no_notebook_is_named_and_the_others_are_collected(tmp_path, course, kind):
    path = work(tmp_path, "bad")
    path.unlink()
    BAD[kind](path)
    work(tmp_path, "zed")
    began = time.monotonic()
    found, said = collected(tmp_path, course)
    assert found == {"zed": CELL}
    assert f"bad, ch01: not collected: {NAME}" in said
    assert time.monotonic() - began < 5
    work(tmp_path, "bad", "good.ipynb", "good")
    assert collected(tmp_path, course)[0] == {"zed": CELL, "bad": "good"}


@POSIX
@pytest.mark.parametrize("part", ["robot", "assignments", "ch01"])
@pytest.mark.parametrize("kind", ["fifo", "dangling link", "link to itself", "sparse", "elsewhere"])
def test_a_folder_that_is_none_is_named(tmp_path, course, part, kind):
    path = work(tmp_path, "bad").parent
    while path.name != part:
        path = path.parent
    if kind == "elsewhere":
        shutil.move(path, tmp_path / "aside")
        path.symlink_to(tmp_path / "aside")
    else:
        shutil.rmtree(path)
        BAD[kind](path)
    work(tmp_path, "zed")
    found, said = collected(tmp_path, course)
    assert found == {"zed": CELL}
    assert f"bad: not collected: {part} is no folder" in said


def test_a_folder_of_a_million_files_is_named(tmp_path, course, monkeypatch):
    monkeypatch.setattr(homes, "MOST_NAMES", 3)
    for name in "abcd":
        work(tmp_path, "bad", f"{name}.ipynb")
    work(tmp_path, "zed")
    found, said = collected(tmp_path, course)
    assert (found, said) == ({"zed": CELL}, "bad: not collected: ch01 has more than 3 files")


def page(course, student: str) -> str:
    path = course / "feedback" / student / "ch01" / "page.html"
    path.parent.mkdir(parents=True)
    path.write_text(student)
    return student


@POSIX
@pytest.mark.parametrize("kind", ["file", "fifo", "dangling link", "link to itself", "elsewhere"])
def test_pages_come_back_whatever_one_student_has_in_their_place(tmp_path, course, kind):
    for student in "ada", "bad", "zed":
        page(course, student)
        (tmp_path / "homes" / student / "robot").mkdir(parents=True)
    (tmp_path / "aside").mkdir()
    feedback = tmp_path / "homes/bad/robot/feedback"
    make = {"file": Path.touch, "elsewhere": lambda it: it.symlink_to(tmp_path / "aside")} | BAD
    make[kind](feedback)
    copies, said = exchange.give_back(tmp_path / "homes", course / "feedback")
    assert [path.read_text() for path in copies] == ["ada", "zed"]
    assert said[0].startswith("bad, ch01: not returned: feedback is no folder")
    assert not [*(tmp_path / "aside").iterdir()]
    feedback.unlink()
    (feedback / "ch01").mkdir(parents=True)
    make[kind](feedback / "ch01" / "page.html")
    copies, said = exchange.give_back(tmp_path / "homes", course / "feedback")
    assert ([path.read_text() for path in copies], said) == (["ada", "bad", "zed"], [])
    (feedback / "ch01" / "page.html").unlink()
    (feedback / "ch01" / "page.html").mkdir()
    copies, said = exchange.give_back(tmp_path / "homes", course / "feedback")
    assert len(copies) == 2
    assert said[0].startswith("bad, ch01: not returned: ")
    assert [path.name for path in (feedback / "ch01").iterdir()] == ["page.html"]


def test_a_student_without_a_home_is_named(tmp_path, course):
    page(course, "gone")
    (tmp_path / "homes").mkdir()
    _, (said,) = exchange.give_back(tmp_path / "homes", course / "feedback")
    assert said.endswith("gone is no home")


@contextmanager
def exchanged(one: Path, other: Path):
    """Exchange two files, as fast as it goes, in another process."""
    if sys.platform != "linux" or not hasattr(ctypes.CDLL(None), "renameat2"):
        pytest.skip("this system exchanges no files in one step")
    code = "import ctypes, sys\na, b = map(str.encode, sys.argv[1:])"
    code += "\nwhile not ctypes.CDLL(None).renameat2(-100, a, -100, b, 2): pass"
    process = subprocess.Popen([sys.executable, "-c", code, one, other])
    try:
        yield
        assert process.poll() is None
    finally:
        process.kill()
        process.wait()


def test_no_exchange_of_a_notebook_for_a_link_copies_a_foreign_file(tmp_path, course):
    secret = tmp_path / "secret"
    secret.write_text("secret")
    path = work(tmp_path, "bad")
    link = path.with_name("link")
    link.symlink_to(secret)
    end, seen = time.monotonic() + RACE, set()
    with exchanged(path, link):
        while time.monotonic() < end:
            found, said = collected(tmp_path, course)
            assert found.get("bad", CELL) == CELL
            seen.add(bool(said))
    assert len(seen) == 2 or os.cpu_count() == 1  # it did hit both


@pytest.mark.parametrize("what", ["collect", "return", "hand out"])
def test_no_exchange_of_a_folder_for_a_link_leads_out_of_a_home(tmp_path, course, what):
    aside = tmp_path / "aside"
    (aside / "ch01").mkdir(parents=True)
    (aside / "ch01" / NAME).write_text("secret")
    page(course, "bad")
    home = tmp_path / "homes/bad"
    inner = home / "robot" / ("feedback" if what == "return" else "assignments")
    work(tmp_path, "bad")
    (inner / "ch01").mkdir(parents=True, exist_ok=True)
    (home / "robot" / "link").symlink_to(aside)
    package = tmp_path / "students.zip"
    with zipfile.ZipFile(package, "w") as files:
        files.writestr("robot/assignments/ch01/new.txt", "new")
    end = time.monotonic() + RACE
    with exchanged(inner, home / "robot" / "link"):
        while time.monotonic() < end:
            if what == "collect":
                assert collected(tmp_path, course)[0].get("bad", CELL) == CELL
            elif what == "return":
                exchange.give_back(tmp_path / "homes", course / "feedback")
            else:
                exchange.hand_out(home, package)
    assert [path.name for path in (aside / "ch01").iterdir()] == [NAME]


@pytest.mark.skipif(os.name != "posix" or os.geteuid() != 0, reason="only root gives files away")
def test_what_root_writes_into_a_home_is_its_owners(tmp_path, course):
    page(course, "ada")
    home = tmp_path / "homes" / "ada"
    home.mkdir(parents=True)
    os.chown(home, 4321, 4322)
    exchange.give_back(tmp_path / "homes", course / "feedback")
    owners = {(p.stat().st_uid, p.stat().st_gid) for p in [home, *home.rglob("*")]}
    assert owners == {(4321, 4322)}
    secret = tmp_path / "secret"
    secret.write_text("secret")
    path = work(tmp_path, "ada")
    path.unlink()
    path.hardlink_to(secret)
    found, said = collected(tmp_path, course)
    assert (found, "somebody else's" in said) == ({}, True)


def test_what_is_handed_out_replaces_nothing(tmp_path):
    home = tmp_path / "home"
    home.mkdir()
    package = tmp_path / "students.zip"
    with zipfile.ZipFile(package, "w") as files:
        files.writestr("robot/a/mine.txt", "first")
        files.writestr("robot/b/more.txt", "more")
        files.writestr("../out.txt", "out")
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
    copies, said = exchange.give_back(tmp_path / "homes", course / "feedback")
    assert ([path.read_text() for path in copies], said) == (["ada"], [])
    shutil.rmtree(tmp_path / "homes/ada/robot/feedback")
    (tmp_path / "homes/ada/robot/feedback").symlink_to(tmp_path)
    assert exchange.give_back(tmp_path / "homes", course / "feedback")[0] == []


def zipped(tmp_path, names: dict, when=None) -> Path:
    """A zip with notebooks of these names; each has its text, or CELL, and its time."""
    path = tmp_path / "all.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as package:
        for k, (name, text) in enumerate(names.items()):
            info = zipfile.ZipInfo(name, (2026, 11, 3, 12 + k % 12, 30, 0))
            info.external_attr = getattr(text, "attr", 0)
            package.writestr(info, text or CELL, zipfile.ZIP_DEFLATED)
    return path


def unzipped(course, path, **more) -> tuple[dict[str, str], str]:
    """{folder of a hand-in: its notebook}, and what is said."""
    copies, said = incoming.unzip(path, course, **more)
    found = {path.parent.relative_to(course / "submitted").as_posix(): path for path in copies}
    assert all(path.name in (NAME, "02_b.ipynb") for path in copies)
    return {key: path.read_text() for key, path in found.items()}, "\n".join(said)


MOODLE = {
    "Ada Lovelace_123456_assignsubmission_file_/my work.ipynb": "ada3",
    "Ada Lovelace_123456_assignsubmission_file/01_gps_to_metres (1).ipynb": "ada3",
    "Lovelace, Ada_7_assignsubmission_file_01_gps_to_metres.ipynb": "ada3",
    "Blue-Ada Lovelace_7_assignsubmission_file_/a/b.ipynb": "ada3",
    "Zoe\u0308 O\u0304e-Smith_7_assignsubmission_file_/a.ipynb": "zoe",
    "ZOË ŌE-SMITH_7_assignsubmission_file_/a.ipynb": "zoe",
    "van Dam Bob_7_assignsubmission_file_/a.ipynb": "bob",
    "bob_7_assignsubmission_file_/a.ipynb": "bob",
}
CANVAS = {
    "lovelaceada_12345_67890_01_gps_to_metres.ipynb": "ada3",
    "lovelaceada_LATE_12345_67890_01_gps_to_metres-1.ipynb": "ada3",
    "somebodyelse_123_67890_x.ipynb": "ada3",
    "ōesmithzoë_1_2_a.ipynb": "zoe",
    "vandambob_1_2_a.ipynb": "bob",
    "dambobvan_1_2_a.ipynb": "bob",
}


@pytest.mark.parametrize("name", MOODLE | CANVAS)
def test_each_name_of_a_download_is_mapped_to_its_student(tmp_path, course, name):
    found, said = unzipped(course, zipped(tmp_path, {name: ""}))
    assert found == {f"{(MOODLE | CANVAS)[name]}/ch01": CELL}
    assert ("Canvas says that it is late" in said) == ("_LATE_" in name)


def test_times_are_kept_only_where_the_zip_has_those_of_the_files(tmp_path, course):
    names = [name for name in MOODLE if "_7_" not in name or "bob" in name]
    unzipped(course, zipped(tmp_path, dict.fromkeys(names, "")))
    stamp = (course / "submitted/ada3/ch01/timestamp.txt").read_text().strip()
    wanted = datetime(2026, 11, 3, 13, 30).astimezone(UTC).replace(tzinfo=None)
    assert parse_utc(stamp) == wanted
    _, said = unzipped(course, zipped(tmp_path, dict.fromkeys(names[:1], "")))
    assert "no times but that of its making" in said
    assert not (course / "submitted/ada3/ch01/timestamp.txt").exists()
    _, said = unzipped(course, zipped(tmp_path, dict.fromkeys(CANVAS, "")))
    assert "times" not in said
    assert not [*course.glob("submitted/*/*/timestamp.txt")]


def test_the_newest_of_several_counts_and_cells_say_which_assignment(tmp_path, course):
    other = CELL.replace("distance-known", "b")
    names = {
        "lovelaceada_5_70_01_gps_to_metres-1.ipynb": "newer",
        "lovelaceada_5_60_01_gps_to_metres.ipynb": "older",
        "lovelaceada_5_61_01_gps_to_metres-7.ipynb": other,
        "vandambob_9_62_notes.pdf": "pdf",
        "vandambob_9_63_mine.ipynb": "{}",
    }
    path = zipped(tmp_path, names)
    found, said = unzipped(course, path)
    assert found == {"ada3/ch01": "newer", "ada3/ch02": other}
    assert "2 notebooks, 01_gps_to_metres.ipynb, 01_gps_to_metres-1.ipynb; " in said
    assert "bob: mine.ipynb: not stored: of which assignment is it?" in said
    assert unzipped(course, path, assignment="ch01")[0]["bob/ch01"] == "{}"
    only = zipped(tmp_path, {"vandambob_9_62_notes.pdf": "pdf"})
    assert unzipped(course, only) == ({}, "bob: no notebook, but notes.pdf")
    with pytest.raises(ValueError, match="--assignment ch7: there are ch01, ch02"):
        incoming.unzip(path, course, "ch7")


class Link(str):
    attr = 0o120777 << 16


def test_what_is_wrong_in_a_zip_is_refused_by_its_name_and_stops_nobody(
    tmp_path, course, monkeypatch
):
    monkeypatch.setattr(incoming, "MOST_BYTES", 100_000)
    good = "Ada Lovelace_1_assignsubmission_file_/a.ipynb"
    names = {
        good: "",
        "Bob van Dam_2_assignsubmission_file_/../../../../x.ipynb": "",
        "/Bob van Dam_2_assignsubmission_file_/y.ipynb": "",
        "C:/Bob van Dam_2_assignsubmission_file_/z.ipynb": "",
        "..\\Bob van Dam_2_assignsubmission_file_/w.ipynb": "",
        "Bob van Dam_2_assignsubmission_file_/link.ipynb": Link("/etc/passwd"),
        "Bob van Dam_2_assignsubmission_file_/bomb.ipynb": " " * 200_000,
        "Bob van Dam_2_assignsubmission_file_/\x1b[2Jred.ipynb": "",
        "Eve_2_assignsubmission_file_/e.ipynb": "",
        "readme.txt": "",
    }
    path = zipped(tmp_path, names)
    twice = "Bob van Dam_2_assignsubmission_file_/twice.ipynb"
    with zipfile.ZipFile(path, "a") as package:
        package.writestr(twice, "one")
        with pytest.warns(UserWarning, match="Duplicate"):
            package.writestr(twice, "two")
    data = path.read_bytes()
    lie = (200_000).to_bytes(4, "little")
    assert data.count(lie) == 2
    found, said = unzipped(course, path)
    assert found == {"ada3/ch01": CELL}
    for name in [*names][1:]:
        assert name.rpartition("/")[2].replace("\x1b", "") in said.replace("\x1b", "")
    assert said.count("refused: ") == 9
    assert "Eve (1 files): not stored: nobody in students.csv has this name" in said
    assert sorted(p.name for p in tmp_path.rglob("*.ipynb")) == sorted([NAME, NAME, "02_b.ipynb"])
    # One that says it is small: no more than it says is unpacked, and its sum is wrong.
    path.write_bytes(data.replace(lie, (1000).to_bytes(4, "little")))
    found, said = unzipped(course, path)
    assert found == {"ada3/ch01": CELL}
    assert "bob: bomb.ipynb: " in said


@pytest.mark.parametrize("encoding", ["utf-8", "cp1252"])
def test_a_name_in_an_encoding_that_the_zip_does_not_tell(tmp_path, course, encoding):
    raw = "Zoë Ōe-Smith_7_assignsubmission_file_/a.ipynb".encode(encoding, errors="replace")
    path = zipped(tmp_path, {"x" * len(raw): ""})
    path.write_bytes(path.read_bytes().replace(b"x" * len(raw), raw))
    found, said = unzipped(course, path)
    assert found == ({"zoe/ch01": CELL} if encoding == "utf-8" else {})
    assert ("in an encoding" in said) == (encoding != "utf-8")


def test_two_students_of_one_name_are_told_apart_by_canvas_number_alone(tmp_path, course):
    with (course / "students.csv").open("a", encoding="utf-8") as file:
        file.write("\nada4,Ada Lovelace,,124,")
    name = "lovelaceada_{}_1_a.ipynb"
    found, said = unzipped(course, zipped(tmp_path, {name.format(124): "", name.format(5): ""}))
    assert found == {"ada4/ch01": CELL}
    assert "not stored: it may be ada3, ada4; put it into" in said


@pytest.mark.parametrize(
    ("text", "wrong"),
    [
        ("name,id\nAda,1", "username is needed"),
        ("", "username is needed"),
        ("username\n", "no student"),
        ("username\n../x", r"line 2: the user name '../x'; letters"),
        ("username\nada\nbob\nADA", "line 4: the user name 'ADA' stands there twice"),
        (b"username\n\xe9", "save it as CSV UTF-8"),
    ],
)
def test_a_roster_that_can_not_be_read_says_where(tmp_path, text, wrong):
    path = tmp_path / "students.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(ValueError, match=wrong) as raised:
        roster.read(path)
    assert str(path) in str(raised.value)


def test_a_roster_is_read_as_spreadsheets_write_it(tmp_path):
    path = tmp_path / "students.csv"
    path.write_bytes("\ufeffGroup; Username ;more;name\r\nA;ada;x;Ada\r\n;;;\r\n;zoë\r\n".encode())
    ada, zoe = roster.read(path)
    assert ada == roster.Student("ada", "Ada", "", "", "A")
    assert zoe == roster.Student("zoë")
    assert roster.of(tmp_path) == [ada, zoe]
    assert roster.of(tmp_path / "nowhere") == []


def test_without_a_roster_or_a_zip_the_command_says_what_is_needed(tmp_path, course):
    command = [sys.executable, ROOT / "book/course/exchange.py", "unzip", "--course", course]
    path = zipped(tmp_path, dict.fromkeys(MOODLE, ""))
    done = subprocess.run([*command, path], capture_output=True, text=True)
    assert (done.returncode, done.stdout.splitlines()[-1]) == (0, "3 files")
    for broken in course / "students.csv", tmp_path / "none.zip":
        done = subprocess.run([*command, broken], capture_output=True, text=True)
        assert (done.returncode, str(broken) in done.stderr) == (1, True)
        assert "Traceback" not in done.stderr
    (course / "students.csv").unlink()
    done = subprocess.run([*command, path], capture_output=True, text=True)
    assert "students.csv is needed to know who is who: a CSV, username," in done.stderr


def test_two_notebooks_in_a_folder_are_named_even_if_one_has_the_right_name(tmp_path):
    for name in NAME, "mine.ipynb":
        (tmp_path / name).write_text(CELL)
    path, odd = handins.find(tmp_path, NAME)
    assert (path.name, odd) == (NAME, [f"{NAME} was taken of {NAME}, mine.ipynb"])
