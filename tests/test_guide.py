"""The lecturer's guide: its snippets, and a term of three weeks by its commands alone."""

import json
import os
import re
import shlex
import subprocess
import sys
import urllib.request
import zipfile
from datetime import datetime
from pathlib import Path

import exchange
import pytest
from damage import command, empty_course
from graded import ROOT, marks, most, notebook, wrong_answers
from test_course import answered, model
from test_hub import ask, ports, until

from wmrbook import questions
from wmrbook.lines import Line, written

GUIDE = (ROOT / "book" / "lecturers.md").read_text(encoding="utf-8")
PYTHON = ".venv/bin/python "
PROSE = re.sub(r"^```.*?^```$", "", GUIDE, flags=re.MULTILINE | re.DOTALL)
SHELL = re.findall(r"^    (\S.*)$", PROSE, re.MULTILINE)
COMMANDS = SHELL + re.findall(r"`((?:cd \S+ && )?[./]*\.venv/bin/\w+ [^`]+)`", GUIDE)
ELSEWHERE = {  # commands of the guide that another test runs
    "build.py --lecturer": "tests/browser/test_book.py",
    "slides.py --questions": "tests/browser/test_votes.py",
    "tools/vote.py": "tests/browser/test_live_vote.py",
    "python3 -m venv": "tests/test_hub.py",
    "chmod -R": "tests/test_hub.py",
    "jupyterhub --config": "tests/test_hub.py",
}
OURS = {each for each in COMMANDS if not any(part in each for part in ELSEWHERE)}
TERM = """zone = "Europe/Berlin"
[due]
ch12 = 2026-10-12
ch01 = 2026-10-19T18:00:00
ch00 = 2026-10-26
[late]
per_day = 0.1
most_days = 2
[extensions]
thursday = 1
s05 = { ch01 = 2026-10-23 }
"""


def block(kind: str, begins: str) -> str:
    """The block of the guide that is of this kind and begins so."""
    blocks = re.findall(rf"^```{kind}\n(.*?)^```", GUIDE, re.MULTILINE | re.DOTALL)
    (found,) = (text for text in blocks if text.startswith(begins))
    return found


class Played:
    """A term of 30 students in a folder of its own; the guide's commands run there."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.homes = folder, folder / "home"
        self.course = empty_course(folder, "ch00", "ch01", "ch12")
        self.names, self.run = [f"s{k:02}" for k in range(1, 31)], set()
        text = "username,name,group"
        for k, name in enumerate(self.names):
            text += f"\n{name},Student {name[1:]} Name,{('tuesday', 'thursday')[k % 2]}"
        (self.course / "students.csv").write_text(text, encoding="utf-8")
        (self.course / "term.toml").write_text(TERM, encoding="utf-8")

    def say(self, part: str, *more: str, **names: str) -> str:
        """Run the command of the guide that has this part; return what it prints."""
        (line,) = {each for each in OURS if part in each}
        self.run.add(line)
        for old, new in (names | {"/home": str(self.homes)}).items():
            line = line.replace(old, new)
        if not line.startswith(PYTHON):
            shell = line.replace("book/course", shlex.quote(str(self.course)))
            subprocess.run(shell, shell=True, check=True, cwd=self.folder)
            return ""
        line = line.removeprefix(PYTHON)
        if line.startswith("-m"):
            words = [sys.executable, *line.split()]
            return subprocess.check_output(words, cwd=self.folder, text=True)
        name, *rest = line.split()
        return command(Path(name).name, self.course, *rest, *more)

    def week(self, now: str) -> dict[str, str]:
        """What the report says, by its parts."""
        parts, title = {}, ""
        for line in self.say("term.py", "--now", now).splitlines()[1:]:
            title = line[:9].strip() or title
            parts[title] = f"{parts.get(title, '')} {line[9:].strip()}".strip()
        return parts

    def solved(self, chapter: str, *wrong: int, **changed: str):
        """The release with the model's answers but for some usual mistakes, as JSON."""
        answers = model(chapter) | {
            it["cell"]: it["source"] for k, it in enumerate(wrong_answers(chapter)) if k in wrong
        }
        return json.dumps(answered(self.course, chapter, answers | changed)).encode()

    def moodle(self, chapter: str, handed_in: dict[str, bytes]) -> Path:
        """A bulk download, as Moodle names its folders."""
        with zipfile.ZipFile(path := self.folder / "moodle.zip", "w") as package:
            for day, (name, text) in enumerate(handed_in.items(), start=9):
                place = f"Student {name[1:]} Name_{name[1:]}77_assignsubmission_file_"
                place += f"/{notebook(chapter).name}"
                package.writestr(zipfile.ZipInfo(place, (2026, 10, day, 12, 0, 0)), text)
        return path

    def at_home(self, chapter: str, name: str, text: bytes, when: str) -> None:
        """Write a notebook into a home of the hub, at a time."""
        path = self.homes / name / "robot" / "assignments" / chapter / notebook(chapter).name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text)
        os.utime(path, (datetime.fromisoformat(when).timestamp(),) * 2)

    def mark(self, chapter: str, name: str, points: float) -> None:
        """Give points by hand for a student's first cell with points, as an assistant does."""
        (line,) = {each for each in OURS if "jupyter lab" in each}
        self.run.add(line)
        (port,) = ports(1)
        lab = line.replace("../../.venv/bin/", f"exec {Path(sys.executable).parent}/")
        lab = lab.replace("book/course", shlex.quote(str(self.course)))
        lab += f" --no-browser --allow-root --port={port} --IdentityProvider.token=mark"
        quiet = dict.fromkeys(("stdout", "stderr"), subprocess.DEVNULL)
        process = subprocess.Popen(lab, shell=True, **quiet)
        try:
            url = f"http://127.0.0.1:{port}/formgrader"
            until(lambda: ask(f"{url}/api/assignments", "mark")[0] == 200)
            there = f"{url}/api/submitted_notebooks/{chapter}/{notebook(chapter).stem}"
            _, those = ask(there, "mark")
            (one,) = (each["id"] for each in those if each["student"] == name)
            with urllib.request.urlopen(f"{url}/submissions/{one}/?token=mark") as page:
                assert "## Task" not in page.read().decode()  # but as a heading
            grade = ask(f"{url}/api/grades?submission_id={one}", "mark")[1][0]["id"]
            done = ask(f"{url}/api/grade/{grade}", "mark", "PUT", {"manual_score": points})
            assert done[0] == 200
        finally:
            process.terminate()
            process.wait(60)


@pytest.mark.slow
def test_a_term_of_three_weeks_is_played_by_the_guides_commands_alone(tmp_path, monkeypatch):
    """30 students, few of whom hand in: each takes seconds. See what the commands are told."""
    monkeypatch.setenv("TZ", "UTC")  # a zip's times have no zone
    term = Played(tmp_path)
    term.say("book/course/package.py")
    assert {path.stem for path in (term.course / "students").iterdir()} == {*term.names}

    # First week, from Moodle, one a day from the 9th on. Three make the same mistake, two are
    # alike, one file is none.
    class_of = {name: term.solved("ch12", *[0] * (k < 3)) for k, name in enumerate(term.names[:4])}
    own = model("ch12")["degrees"].replace("size", "my_size").replace("point", "my_point")
    class_of |= dict.fromkeys(("s05", "s06"), term.solved("ch12", degrees=own)) | {"s07": b"{"}
    term.say("unzip", **{"moodle.zip": str(term.moodle("ch12", class_of))})
    said = term.week("2026-10-16T08:00+02:00")
    late = "s05 by 1 day, s06 by 1 day, s07 by 3 days"
    assert said["came in"].startswith(f"ch12: 7 of 30; late: {late}; missing: s08, s09,")
    assert said["who"].startswith("nothing yet of: s08, s09,")
    assert said["graded"] == "ch12: 6, 8.2 points on average"  # of ten, three lose three, two one
    assert "ch12 s07: refused: " in said["look at"]
    assert "ch12 s05, s06: alike in 12.2 (Degrees out of a sentence), " in said["look at"]
    assert "only there: my_point, my_size" in said["look at"]
    assert said["look at"].count("alike") == 1
    hint = wrong_answers("ch12")[0]["hint"]
    assert re.match(r"ch12 3 of 6 failed 12\.1 \(Is this sentence whole\?\): ", said["wrong"])
    assert hint in said["wrong"]
    assert "(chapter 1, by 19 Oct)" in said["vote on"]

    # Second week, from the hub. Thursday's group has a day more, s05 until the 23rd.
    for name, when in {
        "s01": "2026-10-19T17:00+02:00",
        "s02": "2026-10-20T17:00+02:00",  # of thursday's group
        "s03": "2026-10-20T19:00+02:00",  # in the second day
        "s04": "2026-10-23T08:00+02:00",  # of thursday's; later than anything counts
        "s05": "2026-10-23T12:00+02:00",
    }.items():
        term.at_home("ch01", name, term.solved("ch01"), when)
    term.say("collect")
    said = term.week("2026-10-24T08:00+02:00")
    assert "late: s03 by 2 days, s04 by 3 days;" in said["came in"]
    assert said["graded"].startswith("ch01: 5")
    all_of = most("ch01")
    wanted = dict.fromkeys(("s01", "s02", "s05"), f"{all_of}") | {"s03": f"{0.8 * all_of:g}"}
    wanted |= {"s04": "0", "s06": ""}
    assert {name: marks(term.course)[name]["ch01"] for name in wanted} == wanted
    term.say("return")
    assert [*(term.homes / "s03" / "robot" / "feedback" / "ch01").glob("*.html")]

    # An assistant marks by hand, and an extension is granted: nothing runs again.
    term.mark("ch01", "s05", 0.5)
    text = (term.course / "term.toml").read_text("utf-8")
    (term.course / "term.toml").write_text(f"{text}s03 = 2\n", encoding="utf-8")
    assert "graded" not in term.week("2026-10-24T08:00+02:00")
    assert marks(term.course)["s03"]["ch01"] == f"{all_of}"
    assert float(marks(term.course)["s05"]["ch01"]) < all_of

    # Third week: the hub hands out named copies. One student types another name.
    for name in "s06", "s07":
        (term.homes / name).mkdir(parents=True)
        exchange.hand_out(term.homes / name, term.course / "students.zip")
        (path,) = (term.homes / name / "robot" / "assignments" / "ch00").iterdir()
        given = path.read_text("utf-8")
        assert f'name = \\"{name}\\"' in given
        text = given.replace('name = \\"s07\\"', 'name = \\"Student 07\\"')
        text = text.replace('raise NotImplementedError(\\"write your answer here\\")', "pass", 1)
        term.at_home("ch00", name, text.encode(), "2026-10-26T20:00+01:00")
    assert term.say("collect").endswith("7 files\n")  # five of ch01, and none that nobody began
    said = term.week("2026-10-27T08:00+01:00")
    assert 'ch00 s07: its name is "Student 07"' in said["look at"]
    assert "ch00 s06" not in said["look at"]
    assert "2 of 2 failed 0.1" in said["wrong"]

    # One again, all again, the tests of understanding, and the end.
    assert " s07 " in (again := term.say("--student", NAME="s07", ch01="ch00"))
    assert " s06 " not in again
    assert term.say("--all", ch01="ch00").count(f"/{most('ch00'):g}") == 2
    asked = questions.tested()
    keys, mark = "".join(each.key for each in asked), questions.fingerprint(asked)
    sheets = ("pre", "-" * len(keys)), ("post", keys)
    both = [("test", f"{when}-{mark}", who, told) for when, told in sheets for who in ("Ada", "Bo")]
    sent = [written(Line(*each)) for each in both]
    (tmp_path / "class.txt").write_text("\n".join(sent), encoding="utf-8")
    for part in "questions form", "questions histogram", "questions gain":
        term.say(part)
    term.say("tar -czf")
    term.say("rm -r")
    assert {"students.csv", "term.toml"} < {path.name for path in term.course.iterdir()}
    assert term.say("grade.py ch01 --all").startswith("No hand-ins of ch01. A student's goes to ")
    assert term.run == OURS
    assert all(any(part in line for line in COMMANDS) for part in ELSEWHERE)


def test_the_guides_scoreboard_ranks(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    *code, last = block("python", "from wmrbook").strip().splitlines()
    names = {}
    exec("\n".join(code), names)
    ranking = eval(last, names)
    assert "Ada" in str(ranking)
