"""The ROS 2 node, driven by three processes: faults, the action, the filter, and silence."""

import math
import os
import re
import signal
import sys
from pathlib import Path

import pytest

if not os.environ.get("WMR_INTERFACES"):  # which CI sets: there it must be present
    pytest.importorskip("rclpy", reason="this test needs rclpy: pip install '.[robot]' on Linux")
ROS2 = Path(__file__).parents[2] / "book" / "robot" / "ros2"
sys.path.insert(0, str(ROS2))

import three  # noqa: E402
from three import CASE, CASES, Three, adapter, by_c, interfaces, parameters  # noqa: E402

import wmrlib as wmr  # noqa: E402
from wmrbook.robot_io import files  # noqa: E402
from wmrbook.robot_sheet import Robot, sheet  # noqa: E402

SUCCEEDED, CANCELED, ABORTED = 4, 5, 6
STATUS = {"parked": SUCCEEDED, "stopped": ABORTED}
PERIOD_M = 0.06  # m that the robot rolls in a period, by which a stamp's nanoseconds may round
SHARED = os.environ.get("WMR_INTERFACES")
DOMAIN = 40 + 2 * int(os.environ.get("PYTEST_XDIST_WORKER", "gw0")[2:])
NAMED = {case.name: case for case in CASES}
YAML = ROS2 / "wmr_park" / "config" / "my_robot.yaml"


@pytest.fixture(scope="module")
def prefix(tmp_path_factory):
    return interfaces.build(Path(SHARED) if SHARED else tmp_path_factory.mktemp("interfaces"))


@pytest.fixture(scope="module")
def robot(prefix):
    with Three(prefix, DOMAIN) as processes:
        yield processes


def driven(robot, name, **more):
    """A case over ROS: where it ended, its words, and how far it was from the goal."""
    told = parameters(NAMED.get(name, CASES[0])) | more
    ran = robot.run(told, CASE.goal, {"case": name})
    steps = robot.steps()
    ran["end"] = ": ".join(filter(None, steps[-1][2:]))
    ran["distance"] = math.dist(ran["pose"][:2], CASE.goal[:2])
    return ran, steps, told


@pytest.mark.parametrize("name", [case.name for case in three.SHOWN])
def test_a_fault_comes_to_what_it_must_and_each_step_is_the_c_headers(robot, name):
    ran, steps, told = driven(robot, name)
    case = NAMED[name]
    assert ran["end"] == three.OTHERWISE.get(name, case.must)
    far = ran["distance"] if case.must == "parked" else ran["blind"]
    assert far <= case.within + (PERIOD_M if case.within else 1e-9)
    assert ran["answer"]["status"] == STATUS.get(ran["answer"]["state"], CANCELED)
    assert ": ".join(filter(None, (ran["answer"]["state"], ran["answer"]["reason"]))) == ran["end"]
    assert by_c(told, CASE.goal, steps) == []
    steps[-1][1][0] += 1e-6
    assert by_c(told, CASE.goal, steps) == [len(steps) - 1]


def test_without_a_fault_the_action_succeeds_and_its_feedback_tells_the_states(robot):
    ran, _, _ = driven(robot, "")
    assert ran["answer"] == {
        "state": "parked",
        "reason": "",
        "status": SUCCEEDED,
        "states": ["wait", "drive", "turn", "parked"],
    }
    off = wmr.wrap_angle(ran["pose"][2] - CASE.goal.heading)
    assert ran["distance"] < 0.3
    assert abs(off) < math.radians(4.0)


ENDS = {"": "parked", "one fix 30 m off": "parked", "silent": "wait", "position frozen": "wait"}
ENDS |= {"x is NaN": "wait", "a jump of 30 m": "wait", "swapped on the way": "wait"}
# The filter has believed the jump in the end, and its heading with it: now a person must look.
ENDS |= {"a jump, and back": "stopped", "cables swapped": "stopped"}


@pytest.mark.parametrize("name", ENDS)
def test_with_the_filter_a_robot_parks_or_stands(robot, name):
    ran, steps, told = driven(robot, name, filter=True)
    assert ran["end"].split(":")[0] == ENDS[name]
    if ran["end"] == "parked":
        assert ran["distance"] < 0.4
    else:
        within = max(NAMED[name].within, three.drive_faults.SILENCE)
        assert ran["blind"] <= within + PERIOD_M
    assert by_c(told, CASE.goal, steps) == []


@pytest.mark.parametrize(
    ("told", "goal"),
    [
        ({"start": [math.nan, 0.0]}, None),
        ({"goal": [133.0, 44.0]}, None),
        ({"gains.k_rho": -1.0}, CASE.goal),
        ({"law": "kanayama"}, CASE.goal),
        ({"track_width": "half a metre"}, CASE.goal),
        ({}, (math.nan, 0.0, 0.0)),
    ],
)
def test_what_is_not_allowed_is_refused_with_the_goal(robot, told, goal):
    with pytest.raises(ValueError, match=r"refused|is not allowed"):
        robot.run(parameters(CASES[0]) | told, goal, {"case": ""})


def park(robot):
    """Ask a robot without a fault to park; whether it will."""
    robot.ask(robot.goals, ["set", parameters(CASES[0])])
    return robot.ask(robot.goals, ["park", list(map(float, CASE.goal))])


def test_while_it_drives_another_goal_and_a_parameter_of_another_kind_are_refused(robot):
    assert not robot.ask(robot.lawn, {"listen": 0.0})  # from here on it hears
    assert park(robot)
    assert not robot.ask(robot.goals, ["another", list(map(float, CASE.goal))])
    said = robot.ask(robot.goals, ["set", {"base_frame": 3}])
    assert said == "base_frame = 3 is not allowed: like 'base_link' is needed"
    assert robot.ask(robot.goals, ["cancel"])
    assert robot.ask(robot.goals, ["result"])["status"] == CANCELED
    assert robot.ask(robot.lawn, {"listen": 1.0})[-1] == [0.0, 0.0]


def test_the_parameters_are_my_robots_and_drive_it(prefix):
    assert YAML.read_text(encoding="utf-8") == files(Robot())["my_robot.yaml"]
    told, width = sheet(Robot()), Robot().track_width
    with Three(prefix, DOMAIN + 1, "--params-file", str(YAML), "-p", "watchdog:=60") as robot:
        wish = {"start": [0.0, 0.0, 1.3], "width": width, "longest": 200.0}
        ran = robot.run({"filter": False}, None, wish)
    assert ran["state"] == "parked"
    x, y, heading = ran["poses"][-1]
    assert math.hypot(x - told.x, y - told.y) < 2 * told.radius
    assert abs(wmr.wrap_angle(heading - told.heading)) < told.turn.tolerance


WRONG = """
import sys, time, rclpy
from nav_msgs.msg import Odometry
rclpy.init()
node, wrong = rclpy.create_node("wrong"), Odometry()
publisher = node.create_publisher(Odometry, "odom", 10)
wrong.header.frame_id, wrong.child_frame_id = "odom", "base_link"
wrong.pose.pose.orientation.w = float(sys.argv[1])
while not publisher.get_subscription_count():
    time.sleep(0.05)
publisher.publish(wrong)
time.sleep(0.5)
"""


@pytest.fixture
def driving(prefix):
    """A robot on its way, whose lawn falls silent now and is told to listen."""
    with Three(prefix, DOMAIN + 1, "-p", "watchdog:=5") as robot:
        park(robot)
        wish = {"start": list(CASE.start), "width": 0.5, "longest": 3.0}
        ran = robot.ask(robot.lawn, wish)
        assert ran["state"] == "drive"
        assert ran["poses"][-1][1] > 0.2  # it drove
        robot.tell(robot.lawn, {"listen": 8.0})
        yield robot


@pytest.mark.parametrize("end", ["2.0", "nan", signal.SIGHUP])
def test_a_message_of_nonsense_is_no_message_and_a_lost_terminal_stops_the_robot(driving, end):
    if isinstance(end, str):
        with driving.begin("-c", WRONG, end) as other:
            other.wait(20.0)
    else:
        driving.node.send_signal(end)
    assert {*map(tuple, driving.answer(driving.lawn))} == {(0.0, 0.0)}
    assert (driving.node.poll() is None) == isinstance(end, str)


def test_silence_stops_the_robot_and_so_does_the_end_of_the_node(driving):
    assert {*map(tuple, driving.answer(driving.lawn))} == {(0.0, 0.0)}
    assert driving.steps()[-1][2:] == ["wait", "clock jumped"]
    driving.tell(driving.lawn, {"listen": 4.0})
    driving.node.terminate()
    assert driving.answer(driving.lawn)[-1] == [0.0, 0.0]
    assert driving.node.wait(20.0) == 0


def test_the_package_names_what_it_imports_and_installs():
    package = (ROS2 / "wmr_park" / "package.xml").read_text(encoding="utf-8")
    source = (ROS2 / "wmr_park" / "wmr_park" / "node.py").read_text(encoding="utf-8")
    for name in re.findall(r"^from (\w+)\.(?:msg|action) import", source, re.MULTILINE):
        assert f"<depend>{name}</depend>" in package
    setup = (ROS2 / "wmr_park" / "setup.py").read_text(encoding="utf-8")
    for file in re.findall(r'"((?:launch|config|resource)/[^"]+)"', setup):
        assert (ROS2 / "wmr_park" / file).exists(), file
    assert set(adapter.DEFAULTS) > set(wmr.Wheels._fields)
