"""A robot's sheet: rules that hold for many robots, refusals that name what is wrong, and files."""

import math
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import yaml
from compiled import INCLUDES
from hypothesis import example, given, settings
from hypothesis import strategies as st
from test_c_header import build

sys.path.insert(0, str(Path(__file__).parents[2] / "book" / "robot" / "ros2" / "wmr_park"))

from wmr_park.adapter import DEFAULTS, drive_of, goal_of, typed

import wmrlib as wmr
import wmrrobot as wr
from wmrlib.body import roll
from wmrrobot import printing, sensing, sheets
from wmrrobot.exports import along, at_rest, files
from wmrrobot.sheets import RECEIVERS, Robot, certificate, sheet

WRONG = {
    "track_width = 0 is not allowed: a number from 0.05 to 5 m is needed": {"track_width": 0.0},
    "goal_lat = 133 is not allowed: a number from -90 to 90 degrees is needed: "
    "are latitude and longitude swapped?": {"goal_lat": 133.0},
    "the points are 111 km apart: at most 1 km is allowed": {"goal_lat": 34.273572},
    "dead_band = 0.3 is not allowed: a last turn within 20 deg is needed; "
    "with this width, acceleration and delay it is 36 deg": {"dead_band": 0.3},
    "delay = 2 is not allowed: a last turn within 20 deg is needed; "
    "with this width, acceleration and dead band it is 37 deg": {"delay": 2.0},
    "compass = 21 is not allowed: a number from 0 to 20 degrees is needed": {"compass": 21.0},
    "sigma = nan is not allowed: a finite number is needed": {"sigma": math.nan},
}


@pytest.mark.parametrize("message", WRONG)
def test_a_refusal_names_what_is_wrong(message):
    with pytest.raises(ValueError, match=re.escape(message)) as refusal:
        sheet(Robot(**WRONG[message]))
    assert str(refusal.value) == message


def test_fields_that_are_no_robot_are_refused_by_name():
    with pytest.raises(ValueError, match=r"^robot = \{'track_width': 0.4\} is not allowed"):
        sheet({"track_width": 0.4})


def robots(count, seed=3):
    """Robots of many kinds whose sheet there is."""
    rng = np.random.default_rng(seed)
    while count:
        speed = 10 ** rng.uniform(-0.7, 0.5)
        robot = Robot(
            track_width=rng.uniform(0.15, 1.2),
            max_speed=speed,
            acceleration=10 ** rng.uniform(-0.7, 0.7),
            dead_band=speed * rng.choice([0.0, 0.05, 0.1]),
            period=rng.choice([0.02, 0.05, 0.1]),
            delay=rng.choice([0.0, 0.1, 0.3]),
            fix_period=rng.choice([0.1, 0.2, 1.0]),
            **rng.choice([*RECEIVERS.values()]),
        )
        try:
            sheet(robot)
        except ValueError:
            continue
        count -= 1
        yield robot


def test_a_sheets_numbers_fit_the_robot():
    for robot in robots(200):
        numbers = sheet(robot)
        gains = numbers.gains
        assert 2 < wmr.modes(gains).kappa < 1 + gains.h
        assert numbers.longest_step == wmr.longest_step(gains)
        assert 5 * robot.period <= numbers.longest_step * (1 + 1e-9)
        assert 2 * (robot.period + robot.delay) <= numbers.longest_step * (1 + 1e-9)
        least = numbers.turn.min_rate * robot.track_width / 2  # m/s, of each wheel in the last turn
        assert min(numbers.wheels.min_speed, least) >= 1.2 * robot.dead_band
        fastest = gains.v_max**2 * gains.k_rho / 4  # m/s^2, braking on a straight line
        assert fastest <= robot.acceleration
        assert numbers.turn.max_rate * robot.track_width / 2 <= robot.max_speed
        drive = wr.Drive(place_of(numbers), gains, numbers.wheels, numbers.turn)
        assert drive.end == numbers.turn  # it does not swing
        assert numbers.turn.min_rate * robot.period <= 2 * numbers.turn.tolerance


def test_all_but_the_latest_robots_park_and_the_bounds_are_above_what_they_bound():
    for robot in robots(12):
        result = certificate(robot, runs=200)
        assert result.parked == 200, robot
        for values, rms, bound in (
            (result.place, result.place_rms, result.place_bound),
            (result.heading, result.heading_rms, result.heading_bound),
        ):
            assert rms == pytest.approx(math.sqrt(np.mean(values**2)))
            assert np.mean(values < bound) >= 0.95
            assert bound > np.quantile(values, 0.95)


def test_place_follows_the_receiver_and_heading_the_compass():
    results = {name: certificate(Robot(**numbers)) for name, numbers in RECEIVERS.items()}
    for name, numbers in RECEIVERS.items():
        radius = sheet(Robot(**numbers)).radius
        expected = math.hypot(math.sqrt(2) * numbers["sigma"], radius)
        assert 0.5 * expected < results[name].place_rms < 1.2 * expected
    still, shaky = (certificate(Robot(compass=degrees)) for degrees in (0.0, 10.0))
    assert still.heading_rms < sheet(Robot()).turn.tolerance
    assert shaky.heading_rms == pytest.approx(math.radians(10.0), rel=0.15)
    assert shaky.place_rms == pytest.approx(still.place_rms, rel=0.15)


def test_a_bound_holds_with_the_confidence_that_is_claimed():
    for runs in (100, 400, 1000):
        sure = sheets.sure(runs)
        below = [math.comb(runs, k) * 0.95**k * 0.05 ** (runs - k) for k in range(sure)]
        assert sum(below) >= 0.95 > sum(below[:-1])
    assert sheets.sure(20) > 20  # too few to be sure of anything


def test_a_late_and_slow_robot_parks_from_behind_too():
    """Its pose is late, but the odometry knows where it is by now."""
    wheels = {"max_speed": 0.8, "acceleration": 0.2, "dead_band": 0.04}
    robot = Robot(**wheels, memory=30.0, period=0.2, delay=0.8, fix_period=0.1)
    for kind in (robot, Robot()):
        towards, round_about = (certificate(kind, spread=spread) for spread in (0.5, 1.0))
        assert towards.parked == round_about.parked == 400
        assert round_about.place_bound == pytest.approx(towards.place_bound, rel=0.1)


def test_drives_that_the_checks_stop_leave_no_bound():
    """A compass that is 46 degrees off, or that turns an arm of 7 m, is taken for a fault."""
    result = certificate(Robot(antenna_ahead=5.0, antenna_left=5.0, compass=20.0), runs=200)
    assert 0.5 * 200 < result.parked < sheets.sure(200)
    assert result.place_bound == result.heading_bound == math.inf
    assert np.isfinite([result.place_rms, result.heading_rms, result.time]).all()


@pytest.mark.parametrize("fix_period", [1.0, 3.0])
def test_a_poor_compass_parks_with_rare_fixes(fix_period):
    """It leads the odometry astray until the next fix, which is no jump."""
    robot = Robot(compass=10.0, fix_period=fix_period, delay=0.0)
    assert certificate(robot, runs=100).parked >= 99


@pytest.mark.parametrize("seed", [-1, 2**64, 1.5])
def test_a_seed_that_is_none_is_refused(seed):
    with pytest.raises(ValueError, match=f"^seed = {re.escape(str(seed))} is not allowed"):
        certificate(Robot(), seed=seed)


def test_yaml_has_floats_where_a_number_happens_to_be_whole():
    """ROS 2 refuses a whole number where a parameter is a float."""
    text = files(Robot(track_width=2.0, dead_band=0.0))["my_robot.yaml"]
    read = yaml.safe_load(text)["/**"]["ros__parameters"]
    assert (read["track_width"], read["min_speed"]) == (2.0, 0.0)
    flat = [*read["gains"].values(), *read["last_turn"].values()]
    flat += [read["track_width"], read["min_speed"], read["dead_band"]]
    assert {type(value) for value in flat} == {float}


def test_a_track_gives_the_way_and_the_scatter(tmp_path):
    """Of a made log whose way and errors are known."""
    errors = np.random.default_rng(2).normal(0.0, 0.4, (2, 4000))
    base, path = wmr.GeoPoint(lat=-33.1, lon=151.2), tmp_path / "rest.gpx"
    wmr.write_gpx(path, wmr.point_at(base, *errors))
    track = wmr.read_track(path)
    robot = at_rest(Robot(), track)
    assert robot.sigma == pytest.approx(math.sqrt(errors.var(axis=1).mean()), abs=0.005)
    assert robot == Robot(sigma=robot.sigma)
    robot = along(Robot(), track)
    for name, k in (("start", 0), ("goal", -1)):
        assert getattr(robot, f"{name}_lat") == track.points.lat[k]
        assert getattr(robot, f"{name}_lon") == track.points.lon[k]
    assert robot._replace(**{name: getattr(Robot(), name) for name in robot._fields[:4]}) == Robot()
    wmr.write_gpx(path, base)
    with pytest.raises(ValueError, match=r"track = <Track: 1 position.* at least 2 positions are"):
        at_rest(Robot(), wmr.read_track(path))


COUNT, LAG = 0.0005, 0.1  # m a count, as in example.c; s that a simulated wheel lags
SCRIPT = """
static double row[9];
static void load(void) { for (int k = 0; k < 9; ++k) if (scanf("%lf", row + k) != 1) exit(0); }
static uint32_t clock_ms(void) { if (row[0] == 0) load(); return (uint32_t)row[0]; }
static void wait_for_timer(void) { load(); }
static void feed_watchdog(void) {}
static void cut_power(void) {}
static WMR_REAL battery_volts(void) { return 24; }
static int is_inside(WMR_REAL x, WMR_REAL y) { return x == x && y == y; }
static int read_fix(robot_fix *fix) {
  const wmr_pose pose = {row[4], row[5], row[6]};
  fix->pose = pose, fix->time = (uint32_t)row[7], fix->age = (uint32_t)row[8];
  fix->quality = 4, fix->error = MY_SIGMA;
  return row[3] != 0;
}
static void read_encoders(int32_t *left, int32_t *right) {
  *left = (int32_t)row[1], *right = (int32_t)row[2];
}
static void set_wheels(wmr_wheels wheels, WMR_REAL seconds) {
  printf("%.12f %.12f %d\\n", wheels.left, wheels.right, seconds > 0);
}
"""


def driven(robot, seed, shaky):
    """What example.c reads in each period of a drive by the sheet, and the wheels' speeds.

    The compass errs anew in each fix, by `shaky` rad.
    """
    rng, numbers, ms = np.random.default_rng(seed), sheet(robot), round(1000 * robot.period)
    drive = wr.Drive(place_of(numbers), numbers.gains, numbers.wheels, numbers.turn, numbers.rules)
    truth, body = [wmr.Pose(0.0, 0.0, math.atan2(numbers.y, numbers.x) + 0.5)], (0.0,) * 4
    every, late = round(robot.fix_period / robot.period), round(robot.delay / robot.period)
    wheels, arm = numbers.wheels._replace(lag=LAG), (robot.antenna_ahead, robot.antenna_left)
    counts, last, rolled, rows, speeds = [0, 0], 0, [0.0, 0.0], [], []
    while drive.state not in ("parked", "stopped"):
        k = len(rows)
        now, before = 1000 + ms * k, counts
        counts = [round(metres / COUNT) for metres in rolled]
        left, right = (COUNT * (new - old) for new, old in zip(counts, before, strict=True))
        seen, row = wr.Seen(0.001 * ms, left, right, 24.0), [now, *counts] + [0] * 6
        if k % every == 0 and k >= late:
            x, y, heading = truth[k - late]
            error = rng.normal(0, robot.sigma, 2)
            x, y = (np.array(sensing.antenna(x, y, heading, *arm)) + error).tolist()
            heading = float(wmr.wrap_angle(heading + rng.normal(0, shaky)))
            time, age = now - late * ms, late * ms
            row[3:] = 1, x, y, heading, time, age
            later, last = 0.001 * (time - last), time
            seen = seen._replace(fresh=1, x=x, y=y, heading=heading, age=0.001 * age, later=later)
            seen = seen._replace(antenna_ahead=arm[0], antenna_left=arm[1], error=robot.sigma)
        rows.append(row)
        speeds.append(drive.step(seen))
        twist = wmr.wheels_to_twist(*speeds[-1], robot.track_width)
        *twist, body = roll(*twist, body, wheels, robot.period)
        moved = wmr.twist_to_wheels(*twist, robot.track_width)
        rolled = [old + robot.period * speed for old, speed in zip(rolled, moved, strict=True)]
        truth.append(wmr.advance(truth[-1], *twist, robot.period))
    return rows, speeds, drive


def place_of(numbers):
    return wmr.Pose(numbers.x, numbers.y, numbers.heading)


FILED = [
    (Robot(goal_lat=33.2737), 4.0),
    (Robot(goal_lat=33.2737, antenna_ahead=0.3, antenna_left=-0.1), 3.0),
    (Robot(goal_lat=33.2737, delay=0.3, dead_band=0.0, max_speed=2.0, track_width=0.7), 2.0),
    (Robot(goal_lat=33.2737, fix_period=0.5, period=0.1, sigma=0.2, memory=60.0), 4.0),
]


@pytest.mark.needs("compiler")
@pytest.mark.parametrize(("robot", "shaky"), FILED)
@pytest.mark.parametrize(("real", "near", "ties"), [("double", 1e-5, 0), ("float", 1e-3, 2)])
def test_the_c_file_makes_the_steps_that_the_sheet_makes(robot, shaky, real, near, ties, tmp_path):
    """It is compiled with example.c, and reads what a drive by the sheet has read."""
    (tmp_path / "my_robot.h").write_text(files(robot)["my_robot.h"], encoding="utf-8")
    (tmp_path / "board.h").write_text(f"#include <stdlib.h>\n{SCRIPT}", encoding="utf-8")
    options = *INCLUDES, f"-I{tmp_path}", "-DMY_ROBOT", '-DHARDWARE="board.h"'
    options += f"-DWMR_REAL={real}", "-Wno-double-promotion", "-Wno-float-conversion"
    program = build(printing.C_EXAMPLE, tmp_path, *options)
    rows, speeds, drive = driven(robot, 1, math.radians(shaky))
    assert drive.state == "parked"
    script = "\n".join(" ".join(map(repr, row)) for row in [*rows, rows[-1]])
    printed = subprocess.run([program], input=script, capture_output=True, text=True, check=True)
    steps = re.findall(r"^(\S+) (\S+) 1$", printed.stdout, re.MULTILINE)
    apart = np.abs(np.array(steps, dtype=float) - speeds).max(axis=1)
    assert (apart > near).sum() <= ties  # of a silence and the patience, which a float rounds
    assert printed.stdout.splitlines()[-1].startswith(
        f"{len(rows)} "
    )  # it parked with the last one


UNUSUAL = {
    "a drive of half an hour": Robot(max_speed=0.05, dead_band=0.003, acceleration=0.3),
    "a fast loop of a slow robot": Robot(period=0.01, max_speed=0.3, dead_band=0.02),
    "an antenna ahead and a bad compass": Robot(antenna_ahead=0.3, compass=10.0),
    "an antenna behind on the right": Robot(antenna_ahead=-1.2, antenna_left=-0.8, compass=5.0),
    "a pose that is very late": Robot(delay=2.0, period=0.1, dead_band=0.0),
    "a late pose of a fast robot": Robot(
        delay=1.2, period=0.1, dead_band=0.0, max_speed=3.0, acceleration=3.0
    ),
}


@pytest.mark.needs("compiler")
@pytest.mark.parametrize("name", UNUSUAL)
def test_an_unusual_robot_parks_by_its_file_on_the_simulated_robot(name, tmp_path):
    """It has the errors of the sheet, and a lag and a compass that scatters, which it has not."""
    text = files(UNUSUAL[name])["my_robot.h"]
    (tmp_path / "my_robot.h").write_text(text, encoding="utf-8")
    strict = "cc", "-std=c99", "-O1", "-Wall", "-Wextra", "-Werror", "-DMY_ROBOT", f"-I{tmp_path}"
    program = tmp_path / "example"
    sources = *INCLUDES, printing.C_EXAMPLE, "-o", program, "-lm"
    subprocess.run([*strict, *sources], check=True)
    for seed in range(1, 21 if UNUSUAL[name].max_speed > 0.1 else 3):
        printed = subprocess.check_output([program, str(seed)], text=True)
        assert re.search("^parked: ", printed, re.MULTILINE), (seed, printed)


@settings(max_examples=20, deadline=None)
@given(st.sampled_from([*robots(20)]), st.floats(-1.0, 1.0), st.floats(0.0, 20.0))
def test_the_ros_file_is_the_drive_of_the_sheet(robot, ahead, compass):
    robot = robot._replace(antenna_ahead=ahead, antenna_left=-ahead, compass=compass)
    numbers, flat = sheet(robot), {}
    parameters = yaml.safe_load(files(robot)["my_robot.yaml"])["/**"]["ros__parameters"]
    for name, value in parameters.items():
        many = value.items() if isinstance(value, dict) else ()
        flat |= {f"{name}.{part}": number for part, number in many} or {name: value}
    read = DEFAULTS | typed({name: value for name, value in flat.items() if name != "period"})
    drive = drive_of(read, goal_of(read))
    for parts in (
        (drive.goal, place_of(numbers)),
        (drive.gains, numbers.gains),
        (drive.wheels, numbers.wheels),
        (drive.end, numbers.turn),
        (drive.rules, numbers.rules),
        (read["antenna"], (ahead, -ahead)),
        ((read["compass_sigma"],), (math.radians(max(compass, 0.1)),)),
    ):
        assert tuple(parts[0]) == pytest.approx(tuple(parts[1]), rel=1e-5, abs=1e-6)


@settings(max_examples=10, deadline=None)
@given(
    robot=st.builds(
        Robot,
        goal_lat=st.floats(33.2739, 33.2790),
        track_width=st.floats(0.1, 1.5),
        max_speed=st.floats(0.2, 3.0),
        acceleration=st.floats(0.2, 5.0),
        dead_band=st.floats(0.0, 0.1),
        period=st.floats(0.06, 0.5),
        delay=st.floats(0.0, 1.0),
        sigma=st.floats(0.0, 3.0),
    )
)
@example(robot=Robot(period=0.2))
@example(robot=Robot(max_speed=0.2, dead_band=0.0))
@example(robot=Robot(goal_lat=33.2790))
@example(robot=Robot(**RECEIVERS["GPS alone"]))
def test_a_perfect_robot_parks_by_the_drive_that_the_sheet_describes(robot):
    try:
        numbers = sheet(robot)
    except ValueError:
        return
    wheels = numbers.wheels._replace(dead_band=0.0)
    goal, dt = place_of(numbers), robot.period
    drive = wr.Drive(goal, numbers.gains, wheels, numbers.turn, numbers.rules)
    pose, body, rolled = (
        wmr.Pose(0.0, 0.0, math.atan2(numbers.y, numbers.x)),
        (0.0,) * 4,
        (0.0, 0.0),
    )
    for _ in range(math.ceil(1.2 * numbers.rules.longest_drive / dt)):
        fix = {"fresh": 1, "error": robot.sigma, "later": dt, "age": 0.0}
        speeds = drive.step(wr.Seen(dt, *rolled, **pose._asdict(), **fix))
        if drive.state in ("parked", "stopped"):
            break
        twist = wmr.wheels_to_twist(*speeds, robot.track_width)
        *twist, body = roll(*twist, body, wheels, dt)
        rolled = [dt * speed for speed in wmr.twist_to_wheels(*twist, robot.track_width)]
        pose = wmr.advance(pose, *twist, dt)
    assert drive.state == "parked", (drive.reason, numbers)
    assert math.dist(pose[:2], goal[:2]) <= 2.0 * numbers.radius
