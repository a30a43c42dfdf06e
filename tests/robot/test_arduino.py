"""The Arduino library: what is in it, and its sketch on a simulated Uno, which parks a robot."""

import math
import re
import zipfile

import arduino_board
import numpy as np
import pytest
from arduino_board import Board, Inputs, compiled, library
from arduino_run import COUNT, FAULTS, NEAR, SETTINGS, STEP, Lawn, drive

import wmrlib as wmr
from wmrlib import symbolic
from wmrrobot import files, printing
from wmrrobot.drive import REASONS
from wmrrobot.sheets import Robot, sheet

uno = pytest.mark.needs("arduino", "avr", "compiler", "libsimavr")


def test_the_zip_is_a_library_with_what_is_printed(tmp_path):
    arduino_board.write_zip(tmp_path / "library.zip")
    with zipfile.ZipFile(tmp_path / "library.zip") as archive:
        names = {name.partition("/")[2]: archive.read(name).decode() for name in archive.namelist()}
        assert {name.partition("/")[0] for name in archive.namelist()} == {"WmrPark"}
    assert names["src/wmr_law.h"] == symbolic.c_header()
    assert names["src/wmr_drive.h"] == printing.c_drive()
    assert names["src/wmr_filter.h"] == printing.c_filter_header()
    assert names["examples/Park/my_robot.h"] == files(Robot())["my_robot.h"]
    assert "name=WmrPark\n" in names["library.properties"]


def test_table_drawing_and_sketch_have_the_same_pins():
    texts = library()
    table = texts["README.md"].partition("| pin | goes to |")[2].partition("Pull")[0]
    sketch = texts["examples/Park/Park.ino"]
    wheels = re.findall(r"^Wheel \w+\({(\d+), (\d+), (\d+), (\d+),", sketch, re.MULTILINE)
    pins = [*re.findall(r"_PIN = (\w+)", sketch), *(pin for wheel in wheels for pin in wheel)]
    pins = sorted([*(pin if pin[0] == "A" else f"D{pin}" for pin in pins), "D0", "D1", "A4", "A5"])
    assert len(pins) == 15
    assert sorted(re.findall(r"\b[AD]\d+\b", table)) == pins
    assert sorted(re.findall(r">([AD]\d+)<", texts["wiring.svg"])) == pins


@uno
def test_it_parks_in_time_and_fits():
    program, ran = compiled(NEAR, SETTINGS), drive()
    assert program.flash <= 30_720  # of a Nano's old loader; an Uno's leaves 32,256
    assert ran.end == "parked"
    assert ran.place < 0.1
    assert abs(ran.heading) < math.radians(10.0)
    assert ran.resets == 0
    assert ran.longest < 0.8 * NEAR.period
    assert ran.untouched >= 64  # bytes of RAM
    told = sheet(NEAR)
    start = wmr.Pose(1.0, -2.0, math.atan2(told.y, told.x) - 1.2)
    aside = drive(NEAR._replace(antenna_ahead=0.3, antenna_left=-0.1), start, seed=2)
    assert (aside.end, aside.resets) == ("parked", 0)
    assert aside.place < 0.1


@uno
@pytest.mark.slow
@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_stops_it_or_passes(name):
    fault, must = FAULTS[name]
    ran = drive(fault=fault)
    assert ran.end == must
    assert ran.power == must.startswith("wait")
    assert ran.resets == fault.hangs
    far = {"emergency stop": 0.15, "pressed for 0.1 s": 0.15, "no compass": 0.0}.get(name, 1.5)
    assert ran.rolled <= far or must == "parked"


def test_the_readme_numbers_the_reasons_as_the_log_does():
    text = library()["README.md"].partition("## The log")[2].partition("\n## ")[0]
    listed = re.findall(r"(\d+) ([a-z ]+)[,.]", text.partition("most often:")[2])
    assert len(listed) == 9
    for number, reason in listed:
        assert REASONS[int(number)] == reason


def bench(swapped=False, seconds=34.0, by_hand=(0.0, 0.0)):
    """The lines of the bench test; its compass reads 1,000 ahead and 300 to the left, and iron.

    In its 38th second somebody turns the wheels `by_hand`, so far [m].
    """
    changes = (*SETTINGS, ("const bool BENCH = false", "const bool BENCH = true"))
    lawn, board = Lawn(NEAR, wmr.Pose(0.0, 0.0, 0.0), 1), Board(compiled(NEAR, changes))
    counted, text = np.zeros(2), b""
    for k in range(round(seconds / STEP)):
        duties = board.pins()[:2]
        counted += 2.0 / COUNT * np.array(lawn.roll(duties[::-1] if swapped else duties))
        if 37.0 <= k * STEP < 38.0:
            counted += 2.0 / COUNT * STEP * np.array(by_hand)
        text += board.run(STEP, Inputs(tuple(counted), (1600.0, -100.0)))
    return [list(map(int, line.split())) for line in text.decode().splitlines()]


def is_sound(rows):
    """Whether each wheel rolls what chapter 11's table tells it, and the heading is right."""
    gains, wheels = sheet(NEAR).gains, wmr.Wheels(NEAR.track_width, NEAR.max_speed)
    poses = [
        (-5, 0, 0),
        (-5, 0, 30),
        (-5, 0, -30),
        (-5, 2, 0),
        (-5, -2, 0),
        (5, 0, 0),
        (-0.5, 0, 0),
    ]
    told = [(0.2, 0.0), (0.0, 0.2), (-0.2, 0.2)]
    for x, y, degrees in [*poses, (0, 0, 0)]:
        pose = wmr.Pose(float(x), float(y), math.radians(degrees))
        error = wmr.polar_error(pose, wmr.Pose(0.0, 0.0, 0.0))
        twist = wmr.limit_wheels(*wmr.control_law(*error, gains), wheels)
        told.append(wmr.twist_to_wheels(*twist, wheels.track_width))
    mm = 1000.0 * np.array(told)
    field = 1600, -100, 85 - math.degrees(math.atan2(300, 1000))  # as it reads, and the heading
    wanted = np.column_stack([mm, mm, np.tile(field, (len(mm), 1))])
    off = np.abs(np.array(rows)[:, :7] - wanted)
    return (off < [1.5, 1.5, 30, 30, 1, 1, 1]).all()


@uno
def test_the_bench_test_shows_the_signs():
    assert is_sound(bench())
    assert not is_sound(bench(swapped=True))


@uno
def test_after_the_bench_test_wheels_turned_by_hand_are_counted():
    rows = np.array(bench(seconds=43.0, by_hand=(0.314, -0.1)))
    assert not rows[11:, :2].any()
    np.testing.assert_allclose(rows[-2:, 2:4], [[314, -100]] * 2, atol=3)
