"""The lawn as a ROS 2 node: it publishes what sensors say, waits for `cmd_vel`, and obeys.

It reads a drive a line, as JSON, and writes what it came to.
"""

from __future__ import annotations

import json
import math
import sys
import time
from typing import Any

import drive_faults
import rclpy
from geometry_msgs.msg import TwistStamped
from nav_msgs.msg import Odometry
from rclpy.executors import SingleThreadedExecutor
from sensor_msgs.msg import BatteryState, Imu, NavSatFix
from wmr_interfaces.action import Park
from world import PERIOD, WHEELS, Faults, World, positions

import wmrlib as wmr
from wmrlib import odometry, paper

BEGIN = 1_000_000_000  # s since 1970, at the start of a drive
STANDS = 6.0  # s, after which a robot that stands has come to its end: a blocked wheel shows later
PATIENT = 20.0  # s, of a real clock, until a command
ORIGIN = paper.GPS_POINT_1
STATUS = {1: 0, 2: 1, 4: 2, 5: 2}  # NavSatStatus of NMEA's qualities; any other is no fix
KINDS = {"imu": Imu, "fix": NavSatFix, "battery": BatteryState, "odom": Odometry}


class Lawn:
    """Publishers, and what the node has answered."""

    def __init__(self) -> None:
        rclpy.init()
        self.node, self.executor = rclpy.create_node("lawn"), SingleThreadedExecutor()
        self.executor.add_node(self.node)
        self.unasked: list[list[float]] = []
        self.asked = None
        made = ((name, self.node.create_publisher(kind, name, 10)) for name, kind in KINDS.items())
        self.publishers = dict(made)
        feedback = "park/_action/feedback", self.hear, 10
        self.node.create_subscription(Park.Impl.FeedbackMessage, *feedback)
        self.node.create_subscription(TwistStamped, "cmd_vel", self.obey, 10)

    def meet(self) -> None:
        """Wait for the node: what it says before that is not heard."""
        for _ in range(round(PATIENT / 0.01)):
            heard = min(it.get_subscription_count() for it in self.publishers.values())
            if heard and self.node.count_publishers("cmd_vel"):
                break
            self.executor.spin_once(timeout_sec=0.01)

    def begin(self, wheels: wmr.Wheels) -> None:
        """Forget the drive before."""
        self.meet()
        self.wheels, self.place, self.told = wheels, odometry.Place(), (0.0, 0.0)
        self.state, self.heard, self.asked, self.now = "", 0, None, 0.0

    def obey(self, command: TwistStamped) -> None:
        v, omega = command.twist.linear.x, command.twist.angular.z
        if (command.header.stamp.sec, command.header.stamp.nanosec) != self.asked:
            self.unasked.append([v, omega])  # a stop, with a time of its own
            return
        self.told = wmr.twist_to_wheels(v, omega, self.wheels.track_width)
        self.heard += 1

    def hear(self, message: Any) -> None:
        self.state = message.feedback.state

    def over(self) -> bool:
        """Whether the node's drive has ended, and answers no more."""
        return self.state in ("parked", "stopped")

    def say(self, name: str, clock: float, **fields: Any) -> Any:
        """Publish a message with the stamp of a clock."""
        message, nanoseconds = KINDS[name](**fields), round(1e9 * clock)
        stamp = message.header.stamp
        stamp.sec, stamp.nanosec = BEGIN + nanoseconds // 10**9, nanoseconds % 10**9
        if name == "odom":
            self.asked = stamp.sec, stamp.nanosec
            message.header.frame_id, message.child_frame_id = "odom", "base_link"
            message.pose.pose.position.x = self.place.x
            message.pose.pose.position.y = self.place.y
            set_yaw(message.pose.pose.orientation, self.place.heading)
        self.publishers[name].publish(message)

    def ask(
        self, seen: wmr.Seen, clock: float, fixed: float, turned: float, pause: float = 0.0
    ) -> None:
        """Publish a period, the odometry last, which ends it, and wait for the command.

        Topics do not wait for one another: without a pause [s] before it the odometry may overtake
        a fix, which then counts in the next period.
        """
        around = (seen.right - seen.left) / self.wheels.track_width
        odometry.carry(self.place, 0.5 * (seen.left + seen.right), around)
        heard, imu = self.heard, Imu()
        none = [-1.0, *[0.0] * 8]
        if seen.fresh:
            set_yaw(imu.orientation, seen.heading)
            heading = {"orientation": imu.orientation, "angular_velocity_covariance": none}
            self.say("imu", fixed, **heading)
            self.say("fix", fixed, **fix_of(seen))
        imu.angular_velocity.z = turned / PERIOD
        gyro = {"angular_velocity": imu.angular_velocity, "orientation_covariance": none}
        self.say("imu", clock, **gyro)
        self.say("battery", clock, voltage=seen.battery)
        time.sleep(pause)
        self.say("odom", clock)
        for _ in range(round(PATIENT / 0.01)):
            self.executor.spin_once(timeout_sec=0.01)
            if self.heard > heard:
                return
        raise RuntimeError("the node does not answer")

    def drive(self, case: drive_faults.Case, seed: int = 1) -> dict:
        """A case of drive_faults.py until the robot stands, in the way that its `run` drives."""
        world, at_fault, stands, fixed = World(seed, case.fence), None, 0.0, 0.0
        self.begin(WHEELS)
        before = world.pose.heading
        until = max((t for t in (case.begin, case.end) if t < math.inf), default=0.0) + STANDS
        while world.now < until or (stands < STANDS and world.now < drive_faults.LONGEST):
            wrong = case.begin <= world.now + 1e-9 < case.end
            faults = Faults(**case.wrong) if wrong else Faults()
            if at_fault is None and (wrong or not world.inside(*world.pose[:2])):
                at_fault, world.clock_error = world.rolled, faults.clock
            if not self.over():
                turned = float(wmr.wrap_angle(world.pose.heading - before))
                before, seen = world.pose.heading, world.see(faults)
                strays = world.time - PERIOD - world.now  # the receiver's time from the right one
                fixed = fixed if faults.stuck_message else world.clock + strays - seen.age
                self.ask(seen, world.clock, fixed, turned)
            world.power = self.state != "stopped"
            world.roll((0.0, 0.0) if self.over() else self.told, faults)
            stands = stands + PERIOD if max(map(abs, world.speeds)) < 1e-6 else 0.0
        blind = world.rolled - (world.rolled if at_fault is None else at_fault)
        return {"pose": world.pose, "blind": blind, "time": world.now, "state": self.state}

    def exact(self, start: wmr.Pose, width: float, longest: float) -> dict:
        """A drive without errors until it ends: the pose at the end of each period."""
        self.begin(wmr.Wheels(width))
        return {"poses": positions(self, start, PERIOD, longest), "state": self.state}

    def step(self, seen: wmr.Seen) -> tuple[float, float]:
        """A period of it: the wheels' speeds, as a `Drive` says them."""
        self.ask(seen, self.now, self.now, seen.right - seen.left, pause=0.01)
        self.now += PERIOD
        return self.told

    def listen(self, seconds: float) -> list[list[float]]:
        """Publish nothing; what is commanded all the same, in m/s and rad/s."""
        self.unasked = []
        for _ in range(round(seconds / 0.01)):
            self.executor.spin_once(timeout_sec=0.01)
        return self.unasked


def set_yaw(quaternion: Any, heading: float) -> None:
    """Turn a quaternion about the vertical."""
    quaternion.z, quaternion.w = math.sin(0.5 * heading), math.cos(0.5 * heading)


def fix_of(seen: wmr.Seen) -> dict[str, Any]:
    """What a `NavSatFix` says of it."""
    lost, fix = not math.isfinite(seen.x), NavSatFix()
    point = wmr.point_at(ORIGIN, 0.0 if lost else seen.x, seen.y)
    fix.status.status = STATUS.get(seen.quality, -1)
    return {
        "latitude": math.nan if lost else float(point.lat),
        "longitude": float(point.lon),
        "status": fix.status,
        "position_covariance": [seen.error**2, 0.0, 0.0, 0.0, seen.error**2, 0.0, 0.0, 0.0, 0.0],
        "position_covariance_type": 2 if seen.error else 0,
    }


def main() -> None:
    """Answer the lines of standard input."""
    lawn, cases = Lawn(), {case.name: case for case in drive_faults.CASES}
    lawn.meet()
    cases[""] = drive_faults.Case("", {}, "parked", 0.3)
    for line in sys.stdin:
        wish = json.loads(line)
        if "case" in wish:
            ended = lawn.drive(cases[wish["case"]])
        elif "listen" in wish:
            ended = lawn.listen(wish["listen"])
        else:
            ended = lawn.exact(wmr.Pose(*wish["start"]), wish["width"], wish["longest"])
        print(json.dumps(ended), flush=True)


if __name__ == "__main__":
    main()
