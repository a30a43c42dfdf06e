"""The line to hand in and the class's file: what is true is ranked, what is not is told, and no line is ever lost."""

import datetime
import hashlib
import os
import random
import re
import subprocess
import sys
import types
from concurrent.futures import ThreadPoolExecutor
from urllib.parse import quote

import pytest
from hypothesis import given
from hypothesis import strategies as st

import wmrlib as wmr
from wmrbook import challenge
from wmrbook.challenge import scoreboard
from wmrbook.challenge.scoreboard import Scoreboard, certificate, verify

PAPER = wmr.Gains(2.0, 1.0, 0.3, 4.0)
GENTLE = wmr.Gains(0.2, 2.0, 2.0, 4.0)
PLAIN = {
    "NUMBA_DISABLE_JIT": "1",
    "PYTHONDONTWRITEBYTECODE": "1",
}  # no file is written but the board's
GOOD = wmr.Gains(0.128, 1.089, 1.42, 7.528)
LINE = certificate("Ada", GOOD)
UNSEEN = "\u00ad\u034f\u115f\u200b\u200e\u200f\u202a\u202e\u2060\u2066\u2069\u3164\ufeff\U000e0041"
FILLERS = "\u034f\u115f\u1160\u17b4\u17b5\u2800\u3164\uffa0"
seen = st.characters(exclude_categories=("C",), exclude_characters=FILLERS) | st.sampled_from(
    "\u200c\u200d"
)
names = st.text(seen, min_size=1, max_size=60).filter(lambda text: any(map(str.isalnum, text)))


@pytest.fixture
def board(tmp_path):
    return Scoreboard(tmp_path / "class.txt")


def signed(text):
    """A line with an honest checksum, whatever it says."""
    return f"{text} check={hashlib.sha256(text.encode()).hexdigest()[:10]}"


def body(line):
    return line.rpartition(" check=")[0]


# The line to hand in --------------------------------------------------------------------------------------------------


def test_the_line_as_published():
    assert (
        signed("wmr-challenge seed=2026 gains=0.128,1.089,1.420,7.528 score=21.81 name=Ada") == LINE
    )
    dated = certificate("Zoë B", PAPER, seed=7, date=datetime.date(2026, 3, 1))
    assert re.fullmatch(
        r"wmr-challenge seed=7 gains=2\.000,1\.000,0\.300,4\.000 score=\d+\.\d\d name=Zo%C3%AB%20B date=2026-03-01 check=[0-9a-f]{10}",
        dated,
    )


@given(names, st.sampled_from([PAPER, GENTLE, GOOD]), st.none() | st.dates())
def test_what_is_certified_verifies(name, gains, date):
    line = certificate(name, gains, date=date)
    assert line.isascii()
    assert line.isprintable()
    verdict = verify(f"  {line}\r\n")
    assert verdict
    assert (verdict.entry.gains, verdict.entry.seed, verdict.entry.date) == (gains, 2026, date)
    assert verdict.entry.points == challenge.score(gains).total
    assert certificate(verdict.entry.name, gains, date=date) == line


def test_every_single_change_is_found():
    line, rng = certificate("Ada L", GENTLE, date=datetime.date(2026, 3, 1)), random.Random(1)
    for k, character in enumerate(line):
        other = rng.choice([each for each in "0123456789abcdefz%., =-" if each != character])
        for changed in (
            line[:k] + other + line[k + 1 :],
            line[:k] + line[k + 1 :],
            line[:k] + character + line[k:],
        ):
            if changed.strip() != line:
                assert not verify(changed), changed


def test_a_mistyped_digit_is_a_matter_of_the_checksum():
    verdict = verify(LINE.replace("1.089", "1.098"))
    assert (verdict.ok, verdict.entry) == (False, None)
    assert (
        repr(verdict)
        == "<Verdict: the checksum does not fit: a character was changed, lost or added>"
    )


def test_an_honest_checksum_does_not_help_a_wrong_score():
    verdict = verify(signed(body(LINE).replace("21.81", "11.81")))
    assert not verdict
    assert verdict.reason == "Ada states 11.81 points, but the gains give 21.81"
    assert not verify(signed(body(LINE).replace("21.81", "21.80")))


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (("name=Ada", "name=%FF"), "the line can't be scored"),
        (("name=Ada", "name=%0A"), "the line can't be scored: name = "),
        (("name=Ada", "name=Ada date=2026-02-31"), "the line can't be scored"),
        (
            ("seed=2026", "seed=9999999999999999999"),
            "the line can't be scored: seed = 9999999999999999999",
        ),
        (("7.528", "0.000"), r"the line can't be scored: v_max = 0\.0"),
        (("7.528", "9" * 310 + ".000"), "the line can't be scored: v_max = inf"),
        (("seed=2026", "seed=2027"), "Ada states 21.81 points, but the gains give"),
        (("name=Ada", "name="), "this is no line of the challenge"),
        (("1.089", "1.089,1.000"), "this is no line of the challenge"),
        (("seed=2026", "seed=٢٠٢٦"), "this is no line of the challenge"),
        (("wmr-challenge", "wmr-chalenge"), "this is no line of the challenge"),
    ],
)
def test_a_line_with_an_honest_checksum_that_says_what_can_not_be(change, reason):
    verdict = verify(signed(body(LINE).replace(*change)))
    assert not verdict
    assert re.match(reason, verdict.reason)


@given(st.text())
def test_verify_never_raises_for_a_text(text):
    assert not verify(text)
    assert not verify(LINE + text) or not text.strip()


def test_names_are_put_in_order():
    assert verify(certificate("  Ada \n von,\tL. ", GOOD)).entry.name == "Ada von, L."
    assert certificate("Zoe\u0308", GOOD) == certificate("Zo\u00eb", GOOD)


def test_a_gain_of_minus_nothing_is_nothing():
    line = certificate("Ada", wmr.Gains(0.3, 1.0, -0.0))
    assert "gains=0.300,1.000,0.000,4.000" in line
    assert verify(line)


@pytest.mark.parametrize("unseen", UNSEEN, ids=lambda character: f"U+{ord(character):04X}")
def test_no_name_holds_what_is_not_seen_or_turns_the_table_round(unseen):
    for name in (f"Ada{unseen}", f"Eve{unseen}adA", unseen):
        with pytest.raises(
            ValueError, match=r"name = .* is not allowed: 1 to 60 readable characters"
        ) as error:
            certificate(name, GOOD)
        assert unseen not in str(error.value) or unseen.isprintable()
    assert not verify(signed(body(LINE).replace("name=Ada", f"name={quote('Ada' + unseen)}")))


def test_huge_gains_are_certified_too():
    assert verify(certificate("Max", wmr.Gains(1e308, 1.0, 1.0, 1e308))).entry.points == 182.0


# The board ------------------------------------------------------------------------------------------------------------


def test_the_best_of_each_name_is_ranked_and_ties_share_a_rank(board):
    for name, gains in (
        ("Bob", PAPER),
        ("ada", GENTLE),
        ("Ada", GOOD),
        ("Cy", GENTLE),
        ("Bob", GENTLE),
        ("Ada", PAPER),
        ("Dee", PAPER),
    ):
        board.add(name, gains)
    ranking = board.ranking()
    assert [(each.rank, each.entry.name, each.tries) for each in ranking.entries] == [
        (1, "Ada", 3),
        (2, "Bob", 2),
        (2, "Cy", 1),
        (4, "Dee", 1),
    ]
    assert [each.entry.points for each in ranking.entries] == [21.81, 25.78, 25.78, 52.28]
    assert (ranking.refused, ranking.others, ranking.seed) == ((), 0, 2026)


def test_names_with_joiners_are_written_with_them_and_ranked_as_without(board):
    persian = "\u0639\u0644\u06cc\u200c\u0631\u0636\u0627"
    assert verify(board.add(persian, PAPER)).entry.name == persian
    board.add(persian.replace("\u200c", ""), PAPER)
    assert [(each.entry.name, each.tries) for each in board.ranking().entries] == [(persian, 2)]


def test_seeds_are_ranked_apart(board):
    board.add("Ada", GOOD)
    board.add("Ada", GENTLE, seed=7)
    assert board.ranking().others == board.ranking(7).others == 1
    assert (
        board.ranking(7).entries[0].entry.points
        == challenge.score(GENTLE, challenge.from_seed(7)).total
    )


def test_a_file_that_is_not_there_and_an_empty_one_have_no_entries(board):
    assert board.ranking().entries == ()
    assert (
        repr(board.ranking())
        == "<Ranking: seed 2026; 0 names ranked, 0 lines refused, 0 of other seeds>"
    )
    board.path.write_bytes(b"")
    assert board.ranking().entries == ()
    assert board.add("Ada", GOOD) == LINE
    assert board.path.read_bytes() == f"{LINE}\n".encode()


DAMAGED = (
    b"\n# our class, 2026\r\n"
    + LINE[:60].encode()
    + b"\r\n\xff\xfe\x00 rubbish\n"
    + LINE.replace("21.81", "1.81").encode()
    + b"\n"
)


def test_what_is_damaged_is_told_with_its_line_and_never_lost(board):
    board.path.write_bytes(
        DAMAGED + signed(body(LINE).replace("21.81", "1.81")).encode()
    )  # no newline at the end
    before = board.path.read_bytes()
    board.add("Bob", GENTLE)
    ranking = board.ranking()
    assert [each.entry.name for each in ranking.entries] == ["Bob"]
    assert [each.line for each in ranking.refused] == [3, 4, 5, 6]
    assert [each.reason[:24] for each in ranking.refused] == [
        "this is no line of the c",
        "this is no line of the c",
        "the checksum does not fi",
        "Ada states 1.81 points, ",
    ]
    assert ranking.refused[0].text == LINE[:60]
    assert board.path.read_bytes() == before + b"\n" + certificate("Bob", GENTLE).encode() + b"\n"
    assert "line 6 is not ranked: Ada states 1.81 points, but the gains give 21.81" in repr(ranking)


@given(st.binary(max_size=200))
def test_whatever_is_in_the_file_stays_and_the_next_line_is_read(tmp_path_factory, content):
    board = Scoreboard(tmp_path_factory.mktemp("board") / "class.txt")
    board.path.write_bytes(content)
    if content[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return
    board.add("Ada", GOOD)
    assert board.path.read_bytes().startswith(content)
    assert [each.entry.name for each in board.ranking().entries] == ["Ada"]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_a_file_that_an_editor_saved_anew(board, encoding):
    board.path.write_bytes(f"# Zoë's class\r\n{LINE}\r\n".encode(encoding))
    assert [each.entry.name for each in board.ranking().entries] == ["Ada"]
    if encoding == "utf-16":
        with pytest.raises(ValueError, match="is in UTF-16, to which no line is added"):
            board.add("Bob", PAPER)


def test_joined_files_make_one_board(board):
    parts = [certificate("Ada", GOOD), certificate("Bob", PAPER), certificate("Cy", GENTLE)]
    board.path.write_bytes(b"".join(f"{part}\n".encode("utf-8-sig") for part in parts))
    assert [each.entry.name for each in board.ranking().entries] == ["Ada", "Cy", "Bob"]


def test_only_a_true_line_is_taken(board):
    assert board.add_line(f" {LINE} \n")
    assert not board.add_line(LINE.replace("1.089", "1.098"))
    assert board.path.read_text() == f"{LINE}\n"


def test_what_it_says(board):
    board.add("Zoë, B", GOOD)
    assert repr(board).startswith("<Scoreboard: '")
    assert repr(board.ranking()).splitlines() == [
        "<Ranking: seed 2026; 1 name ranked, 0 lines refused, 0 of other seeds>",
        "rank   points  tries   k_rho, k_alpha, h, v_max      name",
        "   1    21.81      1   0.128, 1.089, 1.42, 7.528     Zoë, B",
    ]


def test_one_line_refused_is_one_line(board):
    board.path.write_text("rubbish\n")
    assert repr(board.ranking()).startswith(
        "<Ranking: seed 2026; 0 names ranked, 1 line refused, 0 of other seeds>"
    )


def test_a_line_that_is_written_in_part_is_an_error(board):
    """As on a full disk: the file may not grow beyond 30 bytes."""
    pytest.importorskip("resource")
    code = (
        "import resource, sys, wmrlib as w\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (30, 30))\n"
        "try:\n    w.scoreboard.Scoreboard(sys.argv[1]).add('Ada', w.Gains(2.0, 1.0, 0.3))\n"
        "except OSError as error:\n    print(error.strerror, error.filename)"
    )
    told = subprocess.run(
        [sys.executable, "-c", code, str(board.path)],
        capture_output=True,
        text=True,
        env=os.environ | PLAIN,
    )
    assert told.stdout == f"the line could not be written whole {board.path}\n", told.stderr
    assert board.path.stat().st_size == 30
    board.add("Bob", PAPER)
    assert [each.entry.name for each in board.ranking().entries] == ["Bob"]


def test_threads_lose_no_line(board):
    lines = [certificate(f"thread {k}", PAPER) for k in range(200)]
    with ThreadPoolExecutor(8) as pool:
        assert all(pool.map(board.add_line, lines))
    assert sorted(board.path.read_text().splitlines()) == sorted(lines)


def test_processes_lose_no_line(board):
    board.path.write_text("# no newline at the end")
    code = (
        "import sys, wmrlib as w; board = w.scoreboard.Scoreboard(sys.argv[1])\n"
        "for k in range(50): board.add(f'{sys.argv[2]} {k}', w.Gains(2.0, 1.0, 0.3))"
    )
    writers = [
        subprocess.Popen([sys.executable, "-c", code, str(board.path), f"process {n}"])
        for n in range(3)
    ]
    assert [writer.wait(60) for writer in writers] == [0, 0, 0]
    lines = board.path.read_text().splitlines()
    assert lines[0] == "# no newline at the end"
    assert sorted(lines[1:]) == sorted(
        certificate(f"process {n} {k}", PAPER) for n in range(3) for k in range(50)
    )
    assert len(board.ranking().entries) == 150


def test_where_there_is_no_fcntl_a_byte_of_the_file_is_locked(board, monkeypatch):
    """Windows, as far as it can be played here."""
    calls = []
    msvcrt = types.SimpleNamespace(
        LK_LOCK=1, LK_UNLCK=0, locking=lambda descriptor, mode, size: calls.append((mode, size))
    )
    monkeypatch.setitem(sys.modules, "fcntl", None)
    monkeypatch.setitem(sys.modules, "msvcrt", msvcrt)
    board.add("Ada", GOOD)
    board.add("Bob", PAPER)
    assert calls == [(1, 1), (0, 1)] * 2
    assert board.path.read_text() == f"{LINE}\n{certificate('Bob', PAPER)}\n"


@pytest.mark.parametrize(
    ("make", "message"),
    [
        *(
            (lambda name=name: certificate(name, GOOD), "name = .* is not allowed")
            for name in ("", " \n", "...", "a" * 61, "A\x1b[2J", "\ud800a", None)
        ),
        (lambda: certificate("Ada", (1, 2, 3)), "a Gains is needed, not a tuple"),
        (lambda: certificate("Ada", GOOD, seed=-1), "seed = -1 is not allowed"),
        (lambda: certificate("Ada", GOOD, date="2026-03-01"), "a date is needed, not a str"),
        (lambda: verify(b"line"), "a str is needed, not a bytes"),
        (lambda: Scoreboard("nowhere.txt").ranking(2.5), r"seed = 2\.5 is not allowed"),
    ],
)
def test_bad_input(make, message):
    with pytest.raises(ValueError, match=message):
        make()


def test_all_that_is_public_is_there():
    assert set(scoreboard.__all__) <= set(dir(scoreboard))
