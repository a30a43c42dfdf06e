"""One robot, four programs: the same drive, within what each arithmetic allows."""

import json
import os
import sys
from importlib.util import find_spec
from pathlib import Path

import four
import numpy as np
import pytest

pytestmark = pytest.mark.needs("avr", "npm", "simavr")
SHARED = os.environ.get("WMR_INTERFACES")
MOST = {"JavaScript": 1e-10, "C on AVR": 1e-3, "ROS 2": 1e-7}  # m and rad, from Python's poses


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    build = Path(SHARED) if SHARED else tmp_path_factory.mktemp("interfaces")
    return four.compared(build, 30 + int(os.environ.get("PYTEST_XDIST_WORKER", "gw0")[2:]))


def test_all_that_can_run_here_drive_alike(found):
    ros = {"ROS 2"} if SHARED or find_spec("rclpy") else set()
    assert set(found["programs"]) == {"Python", "JavaScript", "C on AVR"} | ros
    for a, b, *far in found["apart"]:
        assert max(far) < MOST[b] + MOST.get(a, 0.0), (a, b)
    avr = next(far for a, b, *far in found["apart"] if (a, b) == ("Python", "C on AVR"))
    assert min(avr) > 1e-6  # 32 bits show


def test_the_stored_table_is_that_of_now(found):
    stored = json.loads((Path(four.__file__).parents[1] / "four.json").read_text(encoding="utf-8"))
    assert list(stored["programs"]) == ["Python", "JavaScript", "C on AVR", "ROS 2"]
    for name, row in found["programs"].items():
        assert stored["programs"][name] == row
    assert all(max(far) < MOST[b] + MOST.get(a, 0.0) for a, b, *far in stored["apart"])


def test_places_are_compared_from_the_first_move_and_to_the_last_end():
    stays, moves = [0.0, 0.0, 3.0], [1.0, 0.0, 3.0]
    late, soon = four.driven([stays, stays, stays, moves]), four.driven([stays, moves, moves])
    assert four.apart(late, soon) == (0.0, 0.0)
    other = [1.0, 0.5, 3.25 - 2.0 * np.pi]
    assert four.apart(soon, np.array([stays, moves, other])) == pytest.approx((0.5, 0.25))


def test_the_command_prints_each_pair_and_writes_the_table(found, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(four, "compared", lambda *_: found)
    monkeypatch.setattr(sys, "argv", ["four.py", f"--json={tmp_path / 'four.json'}"])
    four.main()
    printed = capsys.readouterr().out.splitlines()
    count = len(found["programs"])
    assert len(printed) == count + count * (count - 1) // 2 + len(found["left_out"])
    assert json.loads((tmp_path / "four.json").read_text(encoding="utf-8")) == found
