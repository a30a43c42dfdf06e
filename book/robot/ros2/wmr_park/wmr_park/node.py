"""The node: a goal, fixes, IMU and odometry in, `cmd_vel` out, and the service `stop`.

    ros2 run wmr_park park --ros-args --params-file my_robot.yaml

Each odometry message is a period, and `wr.Drive` decides what is commanded for the next.
"""

from __future__ import annotations

import math
import signal
import time
from typing import Any

import rclpy
from geometry_msgs.msg import PoseStamped, Twist
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from rclpy.clock import Clock, ClockType
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_sensor_data
from rclpy.qos_overriding_options import QoSOverridingOptions
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import BatteryState, Imu, NavSatFix
from std_srvs.srv import Trigger

import wmrlib as wmr
import wmrrobot as wr
from wmr_park.adapter import DEFAULTS, Sensors, drive_of, goal_of, typed, yaw


class ParkNode(Node):
    """Drives to the last goal; without one it only listens, and others may drive."""

    def __init__(self) -> None:
        super().__init__("wmr_park")
        for name, value in DEFAULTS.items():  # `typed` takes 1 for 1.0, which ROS does not
            self.declare_parameter(name, value, ParameterDescriptor(dynamic_typing=True))
        watchdog = self.given()["watchdog"]
        self.drive: wr.Drive | None = None
        self.sensors: Sensors | None = None
        self.last_message = ""
        self.add_on_set_parameters_callback(self.allowed)
        self.command = self.create_publisher(Twist, "cmd_vel", 1)
        self.create_subscription(PoseStamped, "goal_pose", self.on_goal, 1)
        subscriptions = {"imu": (Imu, self.on_imu), "fix": (NavSatFix, self.on_fix)}
        subscriptions |= {
            "battery": (BatteryState, self.on_battery),
            "odom": (Odometry, self.on_odometry),
        }
        for topic, (message, take) in subscriptions.items():  # parameters may ask for "reliable"
            more = QoSOverridingOptions.with_default_policies()
            options = {"qos_overriding_options": more}
            self.create_subscription(message, topic, take, qos_profile_sensor_data, **options)
        self.create_service(Trigger, "stop", self.on_stop)
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.dog = self.create_timer(watchdog, self.on_silence, clock=steady)

    def given(self) -> dict[str, Any]:
        """The parameters of now; ValueError names one of another kind."""
        return typed({name: self.get_parameter(name).value for name in DEFAULTS})

    def allowed(self, parameters: list[Parameter]) -> SetParametersResult:
        """Whether parameters may be set, while it drives too: they count from the next goal on."""
        try:
            typed(
                {
                    parameter.name: parameter.value
                    for parameter in parameters
                    if parameter.name in DEFAULTS
                }
            )
        except ValueError as refusal:
            return SetParametersResult(successful=False, reason=str(refusal))
        return SetParametersResult(successful=True)

    def on_goal(self, goal: PoseStamped) -> None:
        """Drive to a goal in the map frame, or without a frame to the parameters'.

        It takes the place of the goal before. One that is not allowed changes nothing.
        """
        try:
            given, frame = self.given(), goal.header.frame_id
            if frame not in ("", "map"):
                raise ValueError(f"frame_id = {frame!r} is not allowed: 'map' or '' is needed")
            position, heading = goal.pose.position, yaw(goal.pose.orientation)
            target = wmr.Pose(position.x, position.y, heading) if frame else goal_of(given)
            sensors, drive = Sensors(given), drive_of(given, target)
        except (ValueError, IndexError, TypeError) as refusal:  # lists of parameters too
            self.get_logger().error(str(refusal))
            return
        self.drive, self.sensors, self.last_message = drive, sensors, ""
        east, north, degrees = target.x, target.y, math.degrees(target.heading)
        self.get_logger().info(f"goal: {east:.2f} m east, {north:.2f} m north, {degrees:.0f} deg")

    def on_stop(self, _: Trigger.Request, answer: Trigger.Response) -> Trigger.Response:
        """Forget the goal, and command a stop, whether it drives or not."""
        answer.success = True
        answer.message = "the goal is forgotten" if self.drive else "there was no goal"
        self.drive = self.sensors = None
        self.tell(0.0, 0.0)
        return answer

    def on_imu(self, imu: Imu) -> None:
        """Keep it until a fix or a period needs it."""
        if self.sensors:
            self.sensors.take_imu(imu)

    def on_fix(self, fix: NavSatFix) -> None:
        """Keep it until the period ends."""
        if self.sensors:
            self.sensors.fixes.append(fix)

    def on_battery(self, battery: BatteryState) -> None:
        """Keep its voltage."""
        if self.sensors:
            self.sensors.battery = battery.voltage

    def on_odometry(self, odom: Odometry) -> None:
        """A period has ended: decide, and command the next."""
        if not self.drive:
            return
        given, frames = self.sensors.given, (odom.header.frame_id, odom.child_frame_id)
        if frames != (given["odom_frame"], given["base_frame"]):
            self.get_logger().error(f"odometry from {frames} is ignored", once=True)
            return
        try:
            seen = self.sensors.seen(odom, self.drive.goal)
        except (ValueError, ArithmeticError, IndexError) as nonsense:
            self.get_logger().error(f"not used: {nonsense}", throttle_duration_sec=1.0)
            return  # and if no better one comes, that is silence
        self.dog.reset()
        self.step(seen)

    def on_silence(self) -> None:
        """No odometry: a period of no length makes the drive wait."""
        if self.drive:
            self.step(wr.Seen(0.0, 0.0, 0.0))

    def step(self, seen: wr.Seen) -> None:
        """One period of the drive: what it commands, and its state and reason when they change."""
        self.tell(*wmr.wheels_to_twist(*self.drive.step(seen), self.drive.wheels.track_width))
        message = ": ".join(filter(None, (self.drive.state, self.drive.reason)))
        if message != self.last_message:
            self.get_logger().info(message)
        self.last_message = message
        if self.drive.state in ("parked", "stopped"):
            self.drive = self.sensors = None

    def tell(self, v: float, omega: float) -> None:
        """Publish a twist, in m/s and rad/s."""
        twist = Twist()
        twist.linear.x, twist.angular.z = float(v), float(omega)
        self.command.publish(twist)


def main() -> None:
    """Run the node until it is told to end; the last thing that it says is a stop."""
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)  # else it could say nothing more
    for end in signal.SIGINT, signal.SIGTERM, signal.SIGHUP:
        signal.signal(end, signal.default_int_handler)
    node, executor = ParkNode(), SingleThreadedExecutor()
    executor.add_node(node)
    try:
        while rclpy.ok():
            executor.spin_once(timeout_sec=0.1)  # between two of these Python sees a signal
    except KeyboardInterrupt:
        pass
    finally:  # an error too ends with a stop
        for _ in range(3):  # one alone may be lost with the process that sends it
            node.tell(0.0, 0.0)
            time.sleep(0.05)
        node.destroy_node()
        rclpy.shutdown()


if __name__ == "__main__":
    main()
