"""The example's main loop: what it drives, by which of its checks, and on a board."""

import math
import re
import subprocess
import sys

import avr
import numpy as np
import pytest
from compiled import INCLUDES
from test_c_header import build
from world import positions

import wmrlib as wmr
import wmrrobot as wr
from wmrrobot import printing

FOLDER = printing.C_DRIVE.parent
SOURCE = (FOLDER / "example.c").read_text(encoding="utf-8")
compiler = pytest.mark.needs("compiler")


def drive_of_the_example():
    """The same drive in Python: the number of periods, and the pose at the end."""
    east, north = wmr.local_position(wmr.paper.GPS_POINT_1, wmr.paper.GPS_POINT_2)
    start, goal = wmr.Pose(0.0, 0.0, math.radians(72)), wmr.Pose(east, north, math.radians(-60))
    gains, wheels = wmr.Gains(0.2, 2.0, 2.0, 4.0), wmr.Wheels(0.5, 2.0, min_speed=0.1)
    drive = wr.Drive(goal, gains, wheels, rules=wr.Rules(arrival_radius=0.05))
    poses = positions(drive, start, 0.05, 200.0)
    return len(poses) - 1, tuple(poses[-1])


@compiler
@pytest.mark.parametrize(("real", "tolerance"), [("double", 2e-9), ("float", 2e-3)])
def test_the_examples_drive_is_wmrlibs(tmp_path, real, tolerance):
    program = build(FOLDER / "example.c", tmp_path, *INCLUDES, f"-DWMR_REAL={real}")
    printed = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    periods, *reached = map(float, printed.splitlines()[-1].split())
    count, pose = drive_of_the_example()
    assert abs(periods - count) <= (0 if real == "double" else 1)
    assert reached == pytest.approx(list(pose), abs=tolerance)


@pytest.mark.needs("avr", "simavr")
def test_it_parks_on_an_avr_in_time():
    board, (count, pose) = avr.drive_of_the_example(), drive_of_the_example()
    assert abs(board.periods - count) <= 1
    assert board.pose == pytest.approx(pose, abs=2e-3)
    assert board.flash < 20_000  # of 32 kB, and a third of it is printf
    assert board.memory < board.ram < 1_000  # of 2 kB
    assert board.milliseconds == pytest.approx(4.0, abs=0.3)  # as chapter 11 says


# What the loop itself has to do, with a scripted robot.

BOARD = """#include <stdlib.h>
static uint32_t turn = 0, late = 0;
static wmr_pose robot = {{0, 0, 1}};
static WMR_REAL rolled[2] = {{0, 0}};
static uint32_t clock_ms(void) {{ return turn * PERIOD_MS + late; }}
static void wait_for_timer(void) {{ late = 0; if (++turn == 120) exit(0); }}
static void feed_watchdog(void) {{ printf("fed %d\\n", (int)turn); }}
static void cut_power(void) {{ printf("cut %d\\n", (int)turn); }}
static WMR_REAL battery_volts(void) {{ return turn < 20 ? 24 : {battery}; }}
static int is_inside(WMR_REAL x, WMR_REAL y) {{ return turn < 20 || {inside}; }}
static int read_fix(robot_fix *fix) {{
  robot_fix seen = {{robot, 1000 + PERIOD_MS * turn, 20, 1, 0}};
  if (turn >= 20) {{ {receiver} }}
  *fix = seen;
  return 1;
}}
static void read_encoders(int32_t *left, int32_t *right) {{
  *left = (int32_t)((uint32_t)(rolled[0] / COUNT_M) + {begin});
  *right = (int32_t)((uint32_t)(rolled[1] / COUNT_M) + {begin});
}}
static void set_wheels(wmr_wheels wheels, WMR_REAL seconds) {{
  const WMR_REAL left = wheels.left * seconds, right = wheels.right * seconds;
  wmr_carry(&robot, (left + right) / 2, (right - left) / MY_TRACK_WIDTH);
  rolled[0] += left, rolled[1] += right;
  late = turn < 20 ? PERIOD_MS : PERIOD_MS + 1; /* how long the turn takes */
  if (wheels.left + wheels.right > 0) printf("drives %d\\n", (int)turn);
}}
"""
STOPS = "drives", range(2, 29)  # after the patience of the rules
WRONG = {  # what goes wrong in turn 20, and what is to happen in which turns
    "sound": ({}, "drives", range(2, 120)),
    "counters that are not 0": ({"begin": "40000u"}, "drives", range(2, 120)),
    "counters at their end": ({"begin": "0x7fffff00u"}, "drives", range(2, 120)),
    "silent": ({"receiver": "*fix = seen; return 0;"}, *STOPS),
    "no fix": ({"receiver": "seen.quality = 0;"}, *STOPS),
    "worse than a metre": ({"receiver": "seen.error = 2;"}, *STOPS),
    "old": ({"receiver": "seen.age = 301;"}, *STOPS),
    "frozen": ({"receiver": "seen.time = 1950;"}, *STOPS),
    "backwards": ({"receiver": "seen.time = 2900 - 50 * turn;"}, *STOPS),
    "anew": ({"receiver": "seen.time = 10 * turn;"}, "drives", [*range(2, 29), *range(43, 120)]),
    "battery": ({"battery": "21"}, "drives", range(2, 30)),
    "fence": ({"inside": "y < 40"}, "drives", range(2, 20)),
    "crossed": ({"inside": "y > 10"}, "drives", range(2, 20)),
    "power": ({"battery": "21"}, "cut", range(30, 120)),
    "late turns": ({}, "fed", range(20)),
}


@pytest.fixture
def on_board(tmp_path):
    """What a loop prints on a board with what is wrong there."""

    def run(text, **wrong):
        sound = {"battery": "24", "inside": "(x - x + y - y == 0)", "receiver": "", "begin": "0u"}
        (tmp_path / "board.h").write_text(BOARD.format(**sound | wrong))
        (tmp_path / "example.c").write_text(text)
        options = *INCLUDES, f"-I{tmp_path}", '-DHARDWARE="board.h"', "-Wno-unused"
        options += "-fsanitize=undefined", "-fno-sanitize-recover"
        program = build(tmp_path / "example.c", tmp_path, *options)
        return subprocess.run([program], check=True, capture_output=True, text=True).stdout

    return run


@compiler
@pytest.mark.parametrize("name", WRONG)
def test_the_loop_sees_what_goes_wrong(on_board, name):
    wrong, what, turns = WRONG[name]
    seen = re.findall(rf"{what} (\d+)", on_board(SOURCE, **wrong))
    assert [int(turn) for turn in seen] == list(turns)


@compiler
def test_a_robot_that_the_loop_leaves_stands(on_board):
    assert "cut 60" in on_board(SOURCE.replace("count < MOST", "count < 60")).splitlines()


@compiler
def test_the_command_puts_all_that_the_example_needs_into_a_folder(tmp_path):
    folder = tmp_path / "robot"
    subprocess.run([sys.executable, "-m", "wmrrobot", "--c", folder], check=True)
    compile_line = re.search(r"cc .*example\.c -o example -lm", SOURCE)[0]
    subprocess.run(compile_line.split(), cwd=folder, check=True)
    assert subprocess.check_output([folder / "example"], text=True).startswith("too few good fixes")
    robot = wr.Robot(antenna_ahead=0.3)
    (folder / "my_robot.h").write_text(wr.files(robot)["my_robot.h"], encoding="utf-8")
    subprocess.run([*compile_line.split(), "-DMY_ROBOT"], cwd=folder, check=True)
    sure, ends = wr.certificate(robot), []
    for seed in range(1, 31):
        printed = subprocess.check_output([folder / "example", str(seed)], text=True)
        ends += re.findall(r"^parked: (.*) m and (.*) deg from the goal", printed, re.MULTILINE)
    places, headings = np.array(ends, dtype=float).T
    assert len(places) == 30
    assert np.mean(places < sure.place_bound) >= 0.9
    assert np.mean(np.radians(headings) < sure.heading_bound) >= 0.9
