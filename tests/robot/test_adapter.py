"""What the ROS 2 node makes of messages, without ROS: signs, frames, stamps."""

import math
import sys
from array import array
from pathlib import Path
from types import SimpleNamespace as Message

import pytest
from hypothesis import given
from hypothesis import strategies as st

sys.path.insert(0, str(Path(__file__).parents[2] / "book" / "robot" / "ros2" / "wmr_park"))

from wmr_park import adapter
from wmr_park.adapter import DEFAULTS, SOON, Sensors, typed, yaw

import wmrlib as wmr
import wmrrobot as wr
from wmrrobot import monitor

START = [33.273572, 44.373160]
GOAL = wmr.Pose(3.0, 0.0, 0.0)


def at(seconds, **fields):
    """A message with a stamp."""
    whole = math.floor(seconds)
    stamp = Message(sec=whole, nanosec=round(1e9 * (seconds - whole)))
    return Message(header=Message(stamp=stamp), **fields)


def facing(heading):
    return Message(x=0.0, y=0.0, z=math.sin(heading / 2), w=math.cos(heading / 2))


def odometry(seconds, x, y, heading):
    pose = Message(position=Message(x=x, y=y), orientation=facing(heading))
    return at(seconds, pose=Message(pose=pose))


def sensors(seconds=0.9, fixed=0.9, **more):
    """Sensors that have seen one odometry, a heading of 2 rad and a fix 3 m east, 4 m north."""
    found = Sensors(DEFAULTS | {"start": START, "filter": False} | more)
    found.seen(odometry(1.0, 5.0, 6.0, 1.0), GOAL)
    imu = {"orientation": facing(2.0), "orientation_covariance": [0.0]}
    turning = {"angular_velocity_covariance": [-1.0]}
    found.take_imu(at(seconds, **imu, **turning))
    point = wmr.point_at(wmr.GeoPoint(lat=START[0], lon=START[1]), 3.0, 4.0)
    status, variance = Message(status=0), [0.04, 0, 0, 0, 0.01, 0, 0, 0, 0]
    fields = {"status": status, "position_covariance": variance, "position_covariance_type": 2}
    found.fixes.append(at(fixed, latitude=point.lat, longitude=point.lon, **fields))
    return found


def test_odometry_on_an_arc_is_what_the_wheels_rolled():
    left, right, width = 0.04, 0.06, DEFAULTS["track_width"]
    pose = wmr.Pose(5.0, 6.0, 1.0)
    pose = wmr.advance(pose, *wmr.wheels_to_twist(left / 0.05, right / 0.05, width), 0.05)
    seen = sensors().seen(odometry(1.05, *pose), GOAL)
    assert (seen.seconds, seen.left, seen.right) == pytest.approx((0.05, left, right))


def test_a_fix_is_east_and_north_with_its_age_error_and_heading():
    seen = sensors().seen(odometry(1.05, 5.0, 6.0, 1.0), GOAL)
    assert (seen.x, seen.y, seen.heading) == pytest.approx((3.0, 4.0, 2.0), abs=1e-6)
    assert (seen.fresh, seen.quality) == (1, 1)
    assert (seen.age, seen.error) == pytest.approx((0.15, 0.2))


def test_an_antenna_ahead_is_not_the_middle_of_the_wheels():
    seen = sensors(antenna=[1.0, 0.0]).seen(odometry(1.05, 5.0, 6.0, 1.0), GOAL)
    m = monitor.Memory()
    monitor.bring_up(m, seen)
    middle = 3.0 - math.cos(2.0), 4.0 - math.sin(2.0)
    assert (m.fix.x, m.fix.y) == pytest.approx(middle, abs=1e-6)


def test_a_heading_from_another_time_and_a_quaternion_that_is_none_are_no_numbers():
    assert math.isnan(sensors(0.1).seen(odometry(1.05, 5.0, 6.0, 1.0), GOAL).heading)
    assert math.isnan(yaw(Message(x=0.0, y=0.0, z=0.0, w=0.0)))


def test_outside_its_fence_a_goal_and_a_fix_are_said_to_be():
    seen = sensors(fence=[0.0, 0.0, 2.0, 9.0]).seen(odometry(1.05, 5.0, 6.0, 1.0), GOAL)
    assert (seen.goal_inside, seen.inside) == (0, 0)


def test_a_receiver_whose_clock_is_far_ahead_is_told_to_the_drive():
    seen = sensors(fixed=1.06 + SOON).seen(odometry(1.05, 5.0, 6.0, 1.0), GOAL)
    assert seen.fresh
    assert seen.age < 0.0  # which it refuses


def test_whole_numbers_are_numbers_and_what_is_of_another_kind_is_named():
    assert typed({"start": array("q", [33, 44]), "track_width": 1}) == {
        "start": [33.0, 44.0],
        "track_width": 1.0,
    }
    wrong = {"start": 33.0, "track_width": "0.5", "filter": 1, "law": ["corrected"], "goal": ["x"]}
    for name, value in wrong.items():
        with pytest.raises(ValueError, match=f"{name} = .* is not allowed"):
            typed({name: value})
    assert repr(typed(DEFAULTS)) == repr(DEFAULTS)


@given(st.lists(st.tuples(st.floats(0.0, 1.0), st.floats(-0.3, 0.4)), max_size=40))
def test_no_fix_is_used_twice_or_goes_back_and_only_a_clock_of_its_own_is_told(fixes):
    """Each fix comes at a time, and was measured some time before or, as it says, after."""
    found = Sensors(DEFAULTS | {"start": START, "filter": False})
    sample, used = sensors().fixes[0], []
    for k in range(40):
        now = 0.05 * k
        for comes, late in fixes:
            if now - 0.05 < comes <= now:
                fix = Message(**vars(sample))
                fix.header = at(10.0 + comes - late).header
                found.fixes.append(fix)
        before = found.fixed
        seen = found.seen(odometry(10.0 + now, 0.0, 0.0, 0.0), GOAL)
        if seen.fresh:
            used.append(found.fixed)
            assert seen.age >= 0.0 or seen.age < -SOON
            assert before is not found.fixed
    assert len(used) == len(set(map(id, used))) <= len(fixes)
    told = [late for comes, late in fixes if late > 0.0]
    assert bool(used) >= bool(told)  # one of a steady receiver is never starved


def test_the_parameters_beside_the_node_are_what_my_robot_prints():
    file = Path(adapter.__file__).parents[1] / "config" / "my_robot.yaml"
    assert file.read_text(encoding="utf-8") == wr.files(wr.Robot())["my_robot.yaml"]
