"""What a log tells of a robot, against simulated robots that are known."""

import math
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import wmrlib as wmr
import wmrrobot as wr
from wmrlib.body import roll
from wmrrobot.commissioning import dead_band, latency, wheel_response

DT, STEP = 0.05, 0.002  # s, m


def driven(commanded, wheels):
    """How fast the left wheel went in each period, with its encoder's steps."""
    went, body = [], (0.0,) * 4
    for command in commanded:
        v, omega, body = roll(command, 0.0, body, wheels, DT)
        went.append(v - 0.5 * wheels.track_width * omega)
    return np.array(went)


def test_a_slow_ramp_finds_the_dead_band():
    up = np.linspace(0.0, 0.4, 400)
    commanded = np.concatenate([up, up[::-1], -up, -up[::-1]])
    for dead in (0.03, 0.08, 0.2):
        wheels = wmr.Wheels(0.5, dead_band=dead, encoder_step=STEP)
        measured = dead_band(commanded, driven(commanded, wheels), 0.5 * STEP / DT)
        assert measured.stood == pytest.approx(dead, abs=0.045)
        assert measured.turned == pytest.approx(dead, abs=0.01)
    with pytest.raises(ValueError, match="a ramp on which the wheel stands, and turns,"):
        dead_band(commanded, np.zeros(commanded.size), 0.5 * STEP / DT)


STEPS = np.repeat([0.0, 0.1, 0.0, 0.3, 0.0, 1.0, -1.0, 0.2, 0.0, 2.0, 0.0], 40)


@settings(max_examples=6, deadline=None)
@given(st.floats(0.03, 0.4), st.sampled_from([0.5, 1.0, 3.0]), st.integers(0, 99))
def test_steps_find_lag_and_acceleration(lag, acceleration, seed):
    assume(lag * acceleration > 0.05)  # or the lag is not to be seen
    wheels = wmr.Wheels(0.5, acceleration=acceleration, lag=lag)
    went = driven(STEPS, wheels) + 0.005 * np.random.default_rng(seed).standard_normal(STEPS.size)
    measured = wheel_response(STEPS, went, DT)
    assert measured.lag == pytest.approx(lag, rel=0.12, abs=0.01)
    assert measured.acceleration == pytest.approx(acceleration, rel=0.12)
    assert measured.misses == pytest.approx(0.005, rel=0.5)


def test_wheels_that_do_as_they_are_told_have_no_lag():
    ideal = wheel_response(STEPS, STEPS, DT)
    assert (ideal.lag, ideal.acceleration) == (0.0, math.inf)


def log_of(age, sigma, seed, stops=True, memory=100.0):
    """A drive straight on: the wheels' metres, and fixes at 5 Hz that come late and wander."""
    t = np.arange(0.0, 60.0, DT)
    speed = np.where((t % 20.0 < 12.0) | (not stops), 1.0, 0.0) * np.minimum(t, 1.0)
    way = np.concatenate([[0.0], np.cumsum(speed[:-1]) * DT])
    t_fix, random = np.arange(0.0, 60.0, 0.2), np.random.default_rng(seed)
    keep, error = math.exp(-0.2 / memory), [0.0]
    for fresh in random.standard_normal(t_fix.size - 1):
        error.append(keep * error[-1] + math.sqrt(1.0 - keep**2) * 0.2 * fresh)
    noise = sigma * random.standard_normal(t_fix.size)
    return t, way, t_fix, np.interp(t_fix - age, t, way) + noise + np.array(error)


@settings(max_examples=25, deadline=None)
@given(st.floats(0.05, 1.5), st.integers(0, 10**6))
def test_stops_find_how_late_fixes_are(age, seed):
    measured = latency(*log_of(age, 0.02, seed), 0.02)
    assert measured.age == pytest.approx(age, abs=0.2)
    assert measured.scale == pytest.approx(1.0, abs=0.05)
    still = latency(*log_of(age, 0.02, seed, memory=1e9), 0.02)
    assert measured.low <= measured.age <= measured.high
    assert still.age == pytest.approx(age, abs=0.05)


def test_a_steady_drive_does_not_tell_the_latency():
    t, way, t_fix, far = log_of(0.5, 0.05, 1, stops=False)
    with pytest.raises(ValueError, match="a drive that stops and starts again"):
        latency(t + 10.0, way, t_fix + 10.0, far, 5.0)
    with pytest.raises(ValueError, match="a drive of 1 m at least"):
        latency(t, way, t_fix, np.zeros(t_fix.size), 0.1)
    with pytest.raises(ValueError, match="mismatched lengths: t has shape"):
        latency(t, way[1:], t_fix, far, 0.1)


PAGE = (Path(__file__).parents[2] / "book" / "commissioning.md").read_text(encoding="utf-8")
ROWS = ((-5, 0, 0), (-5, 0, 30), (-5, 0, -30), (-5, 2, 0), (-5, -2, 0))  # chapter 11's
ROWS += ((5, 0, 0), (-0.5, 0, 0), (0, 0, 0))


def test_the_pages_bench_in_c_has_the_rows_of_chapter_11(tmp_path, find_tool):
    robot = wr.Robot(max_speed=0.8)
    (bench,) = re.findall(r"```c\n(.*?)```", PAGE, re.DOTALL)
    (tmp_path / "bench.c").write_text(bench)
    subprocess.run([sys.executable, "-m", "wmrrobot", "--c", tmp_path], check=True)
    (tmp_path / "my_robot.h").write_text(wr.files(robot)["my_robot.h"])
    command = [find_tool("compiler"), "-std=c99", "-Wall", "-Werror", "bench.c", "-o", "bench"]
    subprocess.run([*command, "-lm"], cwd=tmp_path, check=True)
    printed = subprocess.check_output([tmp_path / "bench"], text=True).split()
    gains, wheels = wr.sheet(robot).gains, wmr.Wheels(robot.track_width, max_speed=0.8)
    for number, (x, y, degrees) in enumerate(ROWS, 1):
        pose = wmr.Pose(float(x), float(y), math.radians(degrees))
        error = wmr.polar_error(pose, wmr.Pose(0.0, 0.0, 0.0))
        v, omega = wmr.limit_wheels(*wmr.control_law(*error, gains), wheels)
        expected = wmr.twist_to_wheels(v, omega, robot.track_width)
        row = [float(word) for word in printed[3 * number - 3 : 3 * number]]
        assert row == pytest.approx([number, *expected], abs=0.006)


def test_the_pages_cells_run_and_its_drive_parks(capsys):
    names = {}
    for cell in re.findall(r"```{code-cell} ipython3\n(.*?)```", PAGE, re.DOTALL):
        exec(cell, names)
    *states, last = capsys.readouterr().out.splitlines()[-5:]
    assert [line.split()[0] for line in states] == ["wait", "drive", "turn", "parked"]
    assert last.startswith("parked, ")
    assert names["far"] < 2.0 * names["settings"].radius
    assert abs(names["off"]) <= names["settings"].turn.tolerance
