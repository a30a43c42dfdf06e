"""What comes in as a zip: what can't be used is refused by its name and stops nobody else."""

import subprocess
import sys
import zipfile
from datetime import UTC, datetime
from pathlib import Path

import incoming
import pytest
import roster
from graded import ROOT
from nbgrader.utils import parse_utc
from test_exchange import CELL, NAME, small_course  # noqa: F401

LINK = 0o120777 << 16


def zipped(tmp_path, names: dict) -> Path:
    """A zip with notebooks of these names, an hour apart; each has its text, or CELL."""
    path = tmp_path / "all.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as package:
        for k, (name, text) in enumerate(names.items()):
            info = zipfile.ZipInfo(name, (2026, 11, 3, 12 + k % 12, 30, 0))
            info.external_attr = LINK if "link" in name else 0
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
    assert (course / "submitted/ada3/ch01/timestamp.txt").exists()  # it is the same notebook
    unzipped(course, zipped(tmp_path, {names[0]: f"{CELL} "}))
    assert not (course / "submitted/ada3/ch01/timestamp.txt").exists()
    _, said = unzipped(course, zipped(tmp_path, dict.fromkeys(CANVAS, "")))
    assert "times" not in said
    assert [path.parts[-3] for path in course.glob("submitted/*/*/timestamp.txt")] == ["bob"]


def test_the_newest_of_several_counts_and_cells_say_which_assignment(tmp_path, course):
    other = CELL.replace("distance-known", "b")
    names = {
        "lovelaceada_5_70_01_gps_to_metres-1.ipynb": '{"newer": 1}',
        "lovelaceada_5_60_01_gps_to_metres.ipynb": '{"older": 1}',
        "lovelaceada_5_61_01_gps_to_metres-7.ipynb": other,
        "vandambob_9_62_notes.pdf": "pdf",
        "vandambob_9_63_mine.ipynb": "{}",
    }
    path = zipped(tmp_path, names)
    found, said = unzipped(course, path)
    assert found == {"ada3/ch01": '{"newer": 1}', "ada3/ch02": other}
    assert "2 notebooks, 01_gps_to_metres.ipynb, 01_gps_to_metres-1.ipynb; " in said
    assert "bob: mine.ipynb: not stored: of which assignment is it?" in said
    assert unzipped(course, path, assignment="ch01")[0]["bob/ch01"] == "{}"
    only = zipped(tmp_path, {"vandambob_9_62_notes.pdf": "pdf"})
    assert unzipped(course, only) == ({}, "bob: no notebook, but notes.pdf")
    with pytest.raises(ValueError, match="--assignment ch7: there are ch01, ch02"):
        incoming.unzip(path, course, "ch7")


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
        "Bob van Dam_2_assignsubmission_file_/link.ipynb": "/etc/passwd",
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
        ('"user"name\nada', "expected after"),
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
    for broken in course / "students.csv", tmp_path / "none.zip":
        with pytest.raises(ValueError, match=broken.name):
            incoming.unzip(broken, course)
    (course / "students.csv").unlink()
    path = zipped(tmp_path, dict.fromkeys(MOODLE, ""))
    command = [sys.executable, ROOT / "book/course/exchange.py", "unzip", path, "--course", course]
    done = subprocess.run(command, capture_output=True, text=True)
    assert "students.csv is needed to know who is who: a CSV, username," in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("content", [" \n", "<!DOCTYPE html>", "\0\0"])
def test_what_is_no_notebook_replaces_none(tmp_path, course, content):
    name = next(iter(MOODLE))
    (before,) = unzipped(course, zipped(tmp_path, {name: ""}))[0].items()
    assert unzipped(course, zipped(tmp_path, {name: content}))[0] == {}
    (kept,) = (course / "submitted" / before[0]).glob("*.ipynb")
    assert kept.read_text("utf-8") == before[1]
