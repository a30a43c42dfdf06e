"""The ROS 2 node in a process of its own: a goal, a stop, silence, and its end."""

import math
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

rclpy = pytest.importorskip("rclpy", reason="this test needs rclpy: pip install '.[robot]'")
from geometry_msgs.msg import PoseStamped, Twist  # noqa: E402
from nav_msgs.msg import Odometry  # noqa: E402
from rcl_interfaces.msg import Log  # noqa: E402
from rclpy.executors import SingleThreadedExecutor  # noqa: E402
from sensor_msgs.msg import Imu, NavSatFix  # noqa: E402
from std_srvs.srv import Trigger  # noqa: E402

import wmrlib as wmr  # noqa: E402
import wmrrobot as wr  # noqa: E402

# What reads rclpy's messages imports a module that Python has given up.
pytestmark = pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning")
ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "book" / "robot" / "ros2" / "wmr_park"
YAML = PACKAGE / "config" / "my_robot.yaml"
ORIGIN = wmr.GeoPoint(lat=33.273572, lon=44.373160)  # `start` of that file, and its track width
WIDTH, PERIOD = 0.4, 0.05  # m, s
PATIENT = 300.0  # s of a real clock, after which a test has failed: the node may compile first
GOAL = wmr.Pose(4.0, 1.0, -0.5)
ALONE = {  # on this machine, beside other tests
    "ROS_DOMAIN_ID": str(1 + os.getpid() % 100),
    "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
    "FASTDDS_BUILTIN_TRANSPORTS": "UDPv4",  # shared memory leaves locks behind
}


class Robot:
    """An ideal robot: it publishes its sensors, and rolls as `cmd_vel` says."""

    def __init__(self, *parameters):
        self.context = rclpy.Context()
        rclpy.init(context=self.context)
        self.node = rclpy.create_node("robot", context=self.context)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.node)
        kinds = {"odom": Odometry, "fix": NavSatFix, "imu": Imu, "goal_pose": PoseStamped}
        self.topics = {
            name: self.node.create_publisher(kind, name, 10) for name, kind in kinds.items()
        }
        self.stop = self.node.create_client(Trigger, "stop")
        self.twists, self.words = [], []  # by `cmd_vel`, and by the node's log
        self.node.create_subscription(Twist, "cmd_vel", self.obey, 10)
        self.node.create_subscription(Log, "/rosout", self.hear, 10)
        self.pose, self.now = wmr.Pose(0.0, 0.0, 0.5), 1_000.0  # s
        paths = os.pathsep.join(filter(None, [str(PACKAGE), *sys.path]))
        environment = os.environ | {"PYTHONPATH": paths}
        # The robot keeps step, however slow the machine is: the watchdog is for real time, and no
        # message may be lost.
        reliable = "qos_overrides./{}.subscription.reliability:=reliable"
        given = [*(parameters or ["watchdog:=60.0"]), *map(reliable.format, self.topics)]
        options = [option for parameter in given for option in ("-p", parameter)]
        command = [sys.executable, "-m", "wmr_park.node", "--ros-args", "--params-file", YAML]
        self.process = subprocess.Popen([*command, *options], env=environment)
        self.until(self.is_met)

    def is_met(self):
        met = [it.get_subscription_count() for it in self.topics.values()]
        return all(met) and self.stop.service_is_ready() and self.node.count_publishers("cmd_vel")

    def until(self, true):
        """Listen until something is true."""
        end = time.monotonic() + PATIENT
        while not (value := true()):
            assert time.monotonic() < end, f"it took too long: {self.words}"
            self.executor.spin_once(timeout_sec=0.01)
        return value

    def obey(self, twist):
        self.twists.append((twist.linear.x, twist.angular.z))

    def hear(self, log):
        self.words += [log.msg] if log.name == "wmr_park" else []

    def say(self, topic, message):
        stamp, nanoseconds = message.header.stamp, round(1e9 * self.now)
        stamp.sec, stamp.nanosec = divmod(nanoseconds, 10**9)
        self.topics[topic].publish(message)

    def ask(self, x, y, heading, frame="map"):
        """Publish a goal."""
        goal = PoseStamped()
        goal.header.frame_id = frame
        goal.pose.position.x, goal.pose.position.y = x, y
        facing(goal.pose.orientation, heading)
        self.say("goal_pose", goal)

    def sense(self, with_fix=True):
        """Publish what the sensors say at the end of a period, the odometry last."""
        imu, fix, odom = Imu(), NavSatFix(), Odometry()
        facing(imu.orientation, self.pose.heading)
        imu.angular_velocity.z = self.twists[-1][1] if self.twists else 0.0
        self.say("imu", imu)
        if with_fix:
            point = wmr.point_at(ORIGIN, self.pose.x, self.pose.y)
            fix.latitude, fix.longitude = float(point.lat), float(point.lon)
            fix.status.status, fix.position_covariance_type = 2, 2
            fix.position_covariance[0] = fix.position_covariance[4] = 0.02**2
            self.say("fix", fix)
        odom.header.frame_id, odom.child_frame_id = "odom", "base_link"
        odom.pose.pose.position.x, odom.pose.pose.position.y = self.pose[:2]
        facing(odom.pose.pose.orientation, self.pose.heading)
        self.say("odom", odom)

    def period(self, with_fix=True):
        """A period: the sensors speak, the node commands, the robot rolls. Whether it drives on."""
        count = len(self.twists)
        self.sense(with_fix)
        self.until(lambda: len(self.twists) > count or self.words[-1] == "parked")
        self.pose = wmr.advance(self.pose, *self.twists[-1], PERIOD)
        self.now += PERIOD
        return self.words[-1:] != ["parked"]

    def begin(self):
        """Ask for the goal, and drive until the robot is under way."""
        self.ask(*GOAL)
        self.until(lambda: self.words and self.words[-1].startswith("goal: 4.00 m east"))
        self.period()
        while self.twists[-1][0] < 0.1:
            self.period()
        assert math.dist(self.pose[:2], GOAL[:2]) > 1.0

    def close(self):
        self.process.terminate()
        self.process.wait(PATIENT)
        self.node.destroy_node()
        rclpy.shutdown(context=self.context)


def facing(quaternion, heading):
    quaternion.z, quaternion.w = math.sin(0.5 * heading), math.cos(0.5 * heading)


@pytest.fixture
def begin(monkeypatch):
    """Start the node and its robot, with these parameters."""
    robots = []
    for name, value in ALONE.items():
        monkeypatch.setenv(name, value)

    def start(*parameters):
        robots.append(Robot(*parameters))
        return robots[-1]

    yield start
    for robot in robots:
        robot.close()


def test_fix_odometry_and_goal_lead_to_a_drive_that_parks(begin):
    robot = begin()
    robot.begin()
    while robot.period():
        assert robot.now < 1_060.0
    assert robot.twists[-1] == (0.0, 0.0)
    assert math.dist(robot.pose[:2], GOAL[:2]) < 0.06  # arrival_radius is 0.05
    assert abs(wmr.wrap_angle(robot.pose.heading - GOAL.heading)) < 0.07  # last_turn.tolerance
    assert {"wait", "drive", "turn", "parked"} <= {word.split(":")[0] for word in robot.words}


def test_with_the_file_of_my_robot_it_makes_the_steps_that_the_sheet_makes(begin):
    """The readings are those that the node has; its filter is off, for it is not in the sheet."""
    robot, numbers = begin("watchdog:=60.0", "filter:=false"), wr.sheet(wr.Robot())
    drive = wr.Drive(GOAL, numbers.gains, numbers.wheels, numbers.turn, numbers.rules)
    robot.ask(*GOAL)
    robot.until(lambda: robot.words and robot.words[-1].startswith("goal: 4.00 m east"))
    on, seconds, rolled = True, 0.0, (0.0, 0.0)  # the first odometry ends no period
    parked = 0  # periods
    while on:
        fix = {"fresh": 1, "error": 0.02, "later": PERIOD, **robot.pose._asdict()}
        on = robot.period()
        twist = wmr.wheels_to_twist(*drive.step(wr.Seen(seconds, *rolled, **fix)), WIDTH)
        assert robot.twists[-1] == pytest.approx(twist, abs=1e-4)
        left, right = wmr.twist_to_wheels(*robot.twists[-1], WIDTH)
        seconds, rolled = PERIOD, (PERIOD * left, PERIOD * right)
        parked += drive.state == "parked"
    assert 1 <= parked <= 5  # until its log says so too


def test_stop_halts_it_and_forgets_the_goal(begin):
    robot = begin()
    robot.begin()
    for message in "the goal is forgotten", "there was no goal":
        answer = robot.stop.call_async(Trigger.Request())
        count = len(robot.twists)
        robot.until(lambda: answer.done() and len(robot.twists) > count)  # noqa: B023
        assert (answer.result().success, answer.result().message) == (True, message)
        assert robot.twists[-1] == (0.0, 0.0)


def test_silence_of_the_receiver_stops_it_until_it_speaks_again(begin):
    robot = begin()
    robot.begin()
    silent = robot.now
    while robot.twists[-1] != (0.0, 0.0):
        robot.period(with_fix=False)
    assert 0.5 < robot.now - silent < 1.0  # `patience` is 0.7 s
    for _ in range(20):
        robot.period(with_fix=False)
        assert robot.twists[-1] == (0.0, 0.0)
    assert robot.words[-1] == "wait: no fix"
    while robot.twists[-1][0] < 0.1:
        robot.period()


def test_silence_of_the_odometry_stops_it(begin):
    robot = begin("watchdog:=3.0")
    robot.begin()
    robot.until(lambda: robot.twists[-1] == (0.0, 0.0))


@pytest.mark.parametrize("end", [signal.SIGTERM, signal.SIGHUP])
def test_the_end_of_the_node_is_a_stop(begin, end):
    robot = begin()
    robot.begin()
    robot.process.send_signal(end)
    robot.until(lambda: robot.twists[-1] == (0.0, 0.0))
    assert robot.process.wait(PATIENT) == 0


def test_a_goal_that_is_not_allowed_is_refused_with_its_reason(begin):
    robot = begin()
    for goal, reason in (
        ((4.0, 1.0, 0.0, "odom"), "frame_id = 'odom' is not allowed: 'map' or '' is needed"),
        ((math.nan, 1.0, 0.0), "x = nan is not allowed"),
    ):
        robot.ask(*goal)
        robot.until(lambda: robot.words and robot.words[-1].startswith(reason))  # noqa: B023
    robot.ask(0.0, 0.0, 0.0, frame="")  # the parameters' own
    robot.until(lambda: robot.words[-1].startswith("goal: 9.67 m east, 57.27 m north, -60 deg"))
