"""What a class hands in: what is true is ranked, what is not is told, and no line is ever lost."""

import datetime
import random
import re
import subprocess
import sys
from urllib.parse import quote

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wmrlib as wmr
from wmrbook.chapters import challenge
from wmrbook.chapters.challenge.scoreboard import Scoreboard, certificate, verify
from wmrbook.lines import JOINERS, checked

PAPER, GENTLE = wmr.paper.OUTDOOR_GAINS, wmr.GENTLE_GAINS
GOOD = wmr.Gains(0.128, 1.089, 1.42, 7.528)
LINE = "wmr-challenge seed=2026 gains=0.128,1.089,1.420,7.528 score=21.81 name=Ada check=897884f0c1"
UNSEEN = "\u00ad\u034f\u115f\u200b\u200e\u200f\u202a\u202e\u2060\u2066\u2069\u3164\ufeff\U000e0041"
FILLERS = "\u034f\u115f\u1160\u17b4\u17b5\u2800\u3164\uffa0"
visible = st.characters(exclude_categories=("C",), exclude_characters=FILLERS)
names = st.text(visible | st.sampled_from(JOINERS), min_size=1, max_size=60).filter(
    lambda text: any(map(str.isalnum, text))
)


@pytest.fixture
def board(tmp_path):
    return Scoreboard(tmp_path / "class.txt")


def body(line):
    return line.rpartition(" check=")[0]


def ranked(board, **options):
    ranking = board.ranking(**options)
    return [(each.rank, each.entry.name, each.tries) for each in ranking.entries]


# The line to hand in ----------------------------------------------------------------------------


def test_the_line_as_published():
    assert certificate("Ada", GOOD) == LINE == checked(body(LINE))
    dated = certificate("Zoë B", PAPER, seed=7, date=datetime.date(2026, 3, 1))
    gains, name = r"2\.000,1\.000,0\.300,4\.000", "Zo%C3%AB%20B"
    wanted = rf"seed=7 gains={gains} score=\d+\.\d\d name={name} date=2026-03-01"
    assert re.fullmatch(rf"wmr-challenge {wanted} check=[0-9a-f]{{10}}", dated)


@given(names, st.sampled_from([PAPER, GENTLE, GOOD]), st.none() | st.dates())
def test_what_is_certified_verifies(name, gains, date):
    line = certificate(name, gains, date=date)
    assert line.isascii()
    assert line.isprintable()
    verdict = verify(f"  {line}\r\n")
    assert verdict
    assert verdict.entry[1:] == (gains, 2026, challenge.score(gains).total, date)
    assert certificate(verdict.entry.name, gains, date=date) == line


def test_names_and_gains_are_put_in_order():
    assert verify(certificate("  Ada \n von,\tL. ", GOOD)).entry.name == "Ada von, L."
    assert certificate("Zoe\u0308", GOOD) == certificate("Zo\u00eb", GOOD)
    assert verify(certificate("Max", wmr.Gains(1e308, 1.0, 1.0, 1e308))).entry.points == 182.0


def test_every_single_change_is_found():
    line, rng = certificate("Ada L", GENTLE, date=datetime.date(2026, 3, 1)), random.Random(1)
    for k, old in enumerate(line):
        new = rng.choice([each for each in "0123456789abcdefz%., =-" if each != old])
        for middle in (new, "", 2 * old):
            changed = line[:k] + middle + line[k + 1 :]
            assert changed.strip() == line or not verify(changed), changed
    mistyped = verify(LINE.replace("1.089", "1.098"))
    assert (mistyped.ok, mistyped.entry) == (False, None)
    assert "checksum does not fit: a character was changed, lost or added" in repr(mistyped)


def test_an_honest_checksum_does_not_help_a_line_that_is_not_true():
    for change, reason in (
        (("21.81", "21.80"), "Ada states 21.80 points, but the gains give 21.81"),
        (("name=Ada", "name=%FF"), "the line can't be scored"),
        (("name=Ada", "name=%0A"), "the line can't be scored: name = "),
        (("name=Ada", "name=Ada date=2026-02-31"), "the line can't be scored"),
        (("seed=2026", "seed=" + 19 * "9"), "the line can't be scored: seed = 9999999999999999999"),
        (("7.528", "0.000"), r"the line can't be scored: v_max = 0\.0"),
        (("7.528", "9" * 310 + ".000"), "the line can't be scored: v_max = inf"),
        (("seed=2026", "seed=2027"), "Ada states 21.81 points, but the gains give"),
        (("name=Ada", "name="), "this is no line of the challenge"),
        (("1.089", "1.089,1.000"), "this is no line of the challenge"),
        (("seed=2026", "seed=٢٠٢٦"), "this is no line of the challenge"),
        (("wmr-challenge", "wmr-chalenge"), "this is no line of the challenge"),
    ):
        verdict = verify(checked(body(LINE).replace(*change)))
        assert not verdict, change
        assert re.match(reason, verdict.reason)


@given(st.text())
def test_verify_never_raises_for_a_text(text):
    assert not verify(text)
    assert not verify(LINE + text) or not text.strip()


def test_no_name_holds_what_is_not_seen_or_turns_the_table_round():
    wanted = "name = .* is not allowed: 1 to 60 readable characters"
    for unseen in UNSEEN:
        for name in (f"Ada{unseen}", f"Eve{unseen}adA", unseen):
            with pytest.raises(ValueError, match=wanted) as error:
                certificate(name, GOOD)
            assert unseen not in str(error.value) or unseen.isprintable()
        assert not verify(checked(body(LINE).replace("Ada", quote(f"Ada{unseen}"))))


# The board --------------------------------------------------------------------------------------


def test_the_best_of_each_name_is_ranked_and_ties_share_a_rank(board):
    tries = (("Bob", PAPER), ("ada", GENTLE), ("Ada", GOOD), ("Cy", GENTLE), ("Bob", GENTLE))
    for name, gains in (*tries, ("Ada", PAPER), ("Dee", PAPER)):
        board.add(name, gains)
    board.add("Ada", GENTLE, seed=7)
    ranking = board.ranking()
    assert ranked(board) == [(1, "Ada", 3), (2, "Bob", 2), (2, "Cy", 1), (4, "Dee", 1)]
    assert [each.entry.points for each in ranking.entries] == [21.81, 25.78, 25.78, 52.28]
    assert (ranking.refused, ranking.others, ranking.seed) == ((), 1, 2026)
    other = board.ranking(7)
    assert other.entries[0].entry.points == challenge.score(GENTLE, challenge.from_seed(7)).total
    assert (len(other.entries), other.others) == (1, 7)


def test_other_drives_decide_a_tie_and_nothing_else(board):
    """A class with an optimiser: all but Bob have the best score that is known."""
    best = {"Ada": (1.088, 1.338), "Cy": (1.088, 1.339), "Dee": (1.088, 1.339)}
    for name, (k_alpha, h) in best.items():
        board.add(name, wmr.Gains(0.114, k_alpha, h, 8.903))
    board.add("Bob", wmr.Gains(0.128, 1.089, 1.42, 7.528))
    assert [(each.rank, each.entry.points) for each in board.ranking().entries] == [
        *[(1, 21.74)] * 3,
        (4, 21.81),
    ]
    by_100, by_7 = (ranked(board, decider=seed) for seed in (100, 7))
    assert by_100 == [(1, "Cy", 1), (1, "Dee", 1), (3, "Ada", 1), (4, "Bob", 1)]
    assert by_7 == [(1, "Ada", 1), (2, "Cy", 1), (2, "Dee", 1), (4, "Bob", 1)]
    assert "; ties decided by seed 100>" in repr(board.ranking(decider=100))
    with pytest.raises(ValueError, match="seed = -1 is not allowed"):
        board.ranking(decider=-1)


def test_names_with_joiners_are_written_with_them_and_ranked_as_without(board):
    persian = "\u0639\u0644\u06cc\u200c\u0631\u0636\u0627"
    assert verify(board.add(persian, PAPER)).entry.name == persian
    board.add(persian.replace("\u200c", ""), PAPER)
    assert ranked(board) == [(1, persian, 2)]


def test_what_it_says(board):
    empty = "<Ranking: seed 2026; 0 names ranked, 0 lines refused, 0 of other seeds>"
    assert repr(board.ranking()) == empty  # the file is not there
    board.path.write_bytes(b"")
    assert repr(board.ranking()) == empty
    board.add("Zoë, B", GOOD)
    assert repr(board).startswith("<Scoreboard: '")
    assert repr(board.ranking()).splitlines() == [
        "<Ranking: seed 2026; 1 name ranked, 0 lines refused, 0 of other seeds>",
        "rank   points  tries   k_rho, k_alpha, h, v_max      name",
        "   1    21.81      1   0.128, 1.089, 1.42, 7.528     Zoë, B",
    ]
    board.path.write_text("rubbish\n")
    assert "0 names ranked, 1 line refused" in repr(board.ranking())


def test_only_a_true_line_is_taken(board):
    assert board.add_line(f" {LINE} \n")
    assert not board.add_line(LINE.replace("1.089", "1.098"))
    assert board.path.read_bytes() == f"{LINE}\n".encode()


def test_what_is_damaged_is_told_with_its_line_and_never_lost(board):
    forged = checked(body(LINE).replace("21.81", "1.81"))
    head = f"\n# our class, 2026\r\n{LINE[:60]}\r\n".encode()
    stale = LINE.replace("21.81", "1.81")
    before = head + b"\xff\xfe\x00 rubbish\n" + f"{stale}\n{forged}".encode()  # no newline
    board.path.write_bytes(before)
    board.add("Bob", GENTLE)
    ranking = board.ranking()
    assert ranked(board) == [(1, "Bob", 1)]
    assert [each.line for each in ranking.refused] == [3, 4, 5, 6]
    reasons = "this is no line", "this is no line", "the checksum", "Ada states 1.81 points"
    for refused, reason in zip(ranking.refused, reasons, strict=True):
        assert refused.reason.startswith(reason)
    assert ranking.refused[0].text == LINE[:60]
    assert board.path.read_bytes() == before + f"\n{certificate('Bob', GENTLE)}\n".encode()
    assert "line 6 is not ranked: Ada states 1.81 points, but the gains give 21.81" in repr(ranking)


@settings(max_examples=50)
@given(st.binary(max_size=200))
def test_whatever_is_in_the_file_stays_and_the_next_line_is_read(tmp_path_factory, content):
    board = Scoreboard(tmp_path_factory.mktemp("board") / "class.txt")
    board.path.write_bytes(content)
    if not content.startswith((b"\xff\xfe", b"\xfe\xff")):
        board.add("Ada", GOOD)
        assert board.path.read_bytes().startswith(content)
        assert ranked(board) == [(1, "Ada", 1)]


def test_files_that_an_editor_saved_anew_or_that_were_joined(board):
    for encoding in ("utf-8", "utf-8-sig", "utf-16"):
        board.path.write_bytes(f"# Zoë's class\r\n{LINE}\r\n".encode(encoding))
        assert ranked(board) == [(1, "Ada", 1)]
    with pytest.raises(ValueError, match="is in UTF-16, to which no line is added"):
        board.add("Bob", PAPER)
    parts = [LINE, certificate("Bob", PAPER), certificate("Cy", GENTLE)]
    board.path.write_bytes(b"".join(f"{part}\n".encode("utf-8-sig") for part in parts))
    assert ranked(board) == [(1, "Ada", 1), (2, "Cy", 1), (3, "Bob", 1)]


# Several writers --------------------------------------------------------------------------------


def test_a_line_that_is_written_in_part_is_an_error(board):
    """As on a full disk: the file may not grow beyond 30 bytes."""
    resource = pytest.importorskip("resource")
    code = (
        "import resource, sys, wmrlib\n"
        "from wmrbook.chapters.challenge.scoreboard import Scoreboard\n"
        "line = sys.argv[2]\n"
        f"resource.setrlimit({resource.RLIMIT_FSIZE}, (30, 30))\n"
        "try:\n    Scoreboard(sys.argv[1])._append(line)\n"
        "except OSError as error:\n    print(error.strerror)"
    )
    command = [sys.executable, "-c", code, str(board.path), LINE]
    told = subprocess.run(command, capture_output=True, text=True)
    assert told.stdout == "File too large\n", told.stderr
    assert board.path.stat().st_size == 30
    board.add("Bob", PAPER)
    assert ranked(board) == [(1, "Bob", 1)]


def test_threads_of_several_processes_lose_no_line(board):
    board.path.write_text("# no newline at the end")
    code = (
        "import sys; from concurrent.futures import ThreadPoolExecutor\n"
        "from wmrlib.paper import OUTDOOR_GAINS\n"
        "from wmrbook.chapters.challenge.scoreboard import Scoreboard\n"
        "board = Scoreboard(sys.argv[1])\n"
        "add = lambda k: board.add(f'{sys.argv[2]} {k}', OUTDOOR_GAINS)\n"
        "with ThreadPoolExecutor(4) as pool: [*pool.map(add, range(50))]"
    )
    command = [sys.executable, "-c", code, str(board.path)]
    writers = [subprocess.Popen([*command, f"process {n}"]) for n in range(3)]
    assert [writer.wait(120) for writer in writers] == [0, 0, 0]
    first, *lines = board.path.read_text().splitlines()
    assert first == "# no newline at the end"
    expected = [certificate(f"process {n} {k}", PAPER) for n in range(3) for k in range(50)]
    assert sorted(lines) == sorted(expected)


def test_bad_input():
    for make, message in (
        *(
            (lambda name=name: certificate(name, GOOD), "name = .* is not allowed")
            for name in ("", " \n", "...", "a" * 61, "A\x1b[2J", "\ud800a", None)
        ),
        (lambda: certificate("Ada", (1, 2, 3)), "a Gains is needed, not a tuple"),
        (lambda: certificate("Ada", GOOD, seed=-1), "seed = -1 is not allowed"),
        (lambda: certificate("Ada", GOOD, date="2026-03-01"), "a date is needed, not a str"),
        (lambda: verify(b"line"), "a str is needed, not a bytes"),
        (lambda: Scoreboard("nowhere.txt").ranking(2.5), r"seed = 2\.5 is not allowed"),
    ):
        with pytest.raises(ValueError, match=message):
            make()
