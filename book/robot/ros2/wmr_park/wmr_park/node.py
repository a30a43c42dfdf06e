"""The node: fixes, IMU and odometry in, `cmd_vel` out, and the action `park`.

    ros2 run wmr_park park --ros-args --params-file my_robot.yaml

Each odometry message is a period: `wmr.Drive` decides, and the answer carries its stamp.
"""

from __future__ import annotations

import signal
import time
from typing import Any

import rclpy
from geometry_msgs.msg import Twist, TwistStamped
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.clock import Clock, ClockType
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_sensor_data
from rclpy.qos_overriding_options import QoSOverridingOptions
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import BatteryState, Imu, NavSatFix
from wmr_interfaces.action import Park

import wmrlib as wmr
from wmr_park.adapter import DEFAULTS, Sensors, drive_of, goal_of, typed, yaw


class ParkNode(Node):
    """Drives to one goal at a time; without one it only listens, and others may drive."""

    drive_kind = wmr.Drive

    def __init__(self) -> None:
        super().__init__("wmr_park")
        for name, value in DEFAULTS.items():  # `typed` takes 1 for 1.0, which ROS does not
            self.declare_parameter(name, value, ParameterDescriptor(dynamic_typing=True))
        given = self.given()
        self.drive: wmr.Drive | None = None
        self.sensors: Sensors | None = None
        self.wish: Any = None
        self.stamped, self.frame = given["stamped"], given["base_frame"]
        self.add_on_set_parameters_callback(self.allowed)
        twist = TwistStamped if self.stamped else Twist
        self.command = self.create_publisher(twist, "cmd_vel", 1)
        heard = {"imu": (Imu, self.on_imu), "fix": (NavSatFix, self.on_fix)}
        heard |= {"battery": (BatteryState, self.on_battery), "odom": (Odometry, self.on_odometry)}
        for topic, (message, take) in heard.items():  # parameters may ask for "reliable"
            more = QoSOverridingOptions.with_default_policies()
            options = {"qos_overriding_options": more}
            self.create_subscription(message, topic, take, qos_profile_sensor_data, **options)
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.dog = self.create_timer(given["watchdog"], self.on_silence, clock=steady)
        answers = {"goal_callback": self.on_goal, "cancel_callback": self.on_cancel}
        answers["handle_accepted_callback"] = self.on_accepted
        self.server = ActionServer(self, Park, "park", self.park, **answers)

    def given(self) -> dict[str, Any]:
        """The parameters of now; ValueError names one of another kind."""
        return typed({name: self.get_parameter(name).value for name in DEFAULTS})

    def on_goal(self, request: Park.Goal) -> GoalResponse:
        """Accept a goal in the map frame, or without a frame the parameters'; one at a time."""
        try:
            given = self.given()
            if self.drive:
                raise ValueError("goal is not allowed: the robot is on its way to another")
            frame, pose = request.goal.header.frame_id, request.goal.pose
            if frame not in ("", "map"):
                raise ValueError(f"frame_id = {frame!r} is not allowed: 'map' or '' is needed")
            goal = wmr.Pose(pose.position.x, pose.position.y, yaw(pose.orientation))
            sensors = Sensors(given)
            drive = drive_of(given, goal if frame else goal_of(given), self.drive_kind)
        except (ValueError, IndexError, TypeError) as refusal:  # lists of parameters too
            self.get_logger().error(str(refusal))
            return GoalResponse.REJECT
        self.drive, self.sensors, self.frame = drive, sensors, given["base_frame"]
        return GoalResponse.ACCEPT

    def allowed(self, told: list[Parameter]) -> SetParametersResult:
        """Whether parameters may be set, while it drives too: they count from the next goal on."""
        try:
            typed({it.name: it.value for it in told if it.name in DEFAULTS})
        except ValueError as refusal:
            return SetParametersResult(successful=False, reason=str(refusal))
        return SetParametersResult(successful=True)

    def on_accepted(self, wish: Any) -> None:
        """Drive from the next odometry on. It executes as it ends: so no thread has to wait."""
        self.wish = wish

    def on_cancel(self, wish: Any) -> CancelResponse:
        """Yes, whatever the reason; it ends once the goal is marked as cancelled."""
        self.executor.create_task(self.end)
        return CancelResponse.ACCEPT

    def end(self) -> None:
        """The drive has parked or stopped, or is cancelled."""
        if self.wish:
            wish, self.wish = self.wish, None
            wish.execute()

    def park(self, wish: Any) -> Park.Result:
        """The action's last word."""
        state, reason = self.drive.state, self.drive.reason
        self.drive = self.sensors = None
        if wish.is_cancel_requested:
            self.tell(0.0, 0.0, self.get_clock().now().to_msg())
            wish.canceled()
        else:
            (wish.succeed if state == "parked" else wish.abort)()
        return Park.Result(state=state, reason=reason)

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
        if not self.wish:
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
        self.step(seen, odom.header.stamp)

    def on_silence(self) -> None:
        """No odometry: a period of no length makes the drive wait."""
        if self.wish:
            self.step(wmr.Seen(0.0, 0.0, 0.0), self.get_clock().now().to_msg())

    def step(self, seen: wmr.Seen, stamp: Any) -> None:
        """One period of the drive."""
        v, omega = wmr.wheels_to_twist(*self.drive.step(seen), self.drive.wheels.track_width)
        m = self.drive.memory
        told = Park.Feedback(state=self.drive.state, reason=self.drive.reason)
        told.distance, told.heading_error = float(m.rho), float(m.off)
        self.wish.publish_feedback(told)
        self.tell(v, omega, stamp)
        if told.state in ("parked", "stopped"):
            self.end()

    def tell(self, v: float, omega: float, stamp: Any) -> None:
        """Publish a twist, if asked for with the stamp of the odometry that it answers."""
        message = TwistStamped() if self.stamped else Twist()
        twist = message.twist if self.stamped else message
        if self.stamped:
            message.header.stamp = stamp
            message.header.frame_id = self.frame
        twist.linear.x, twist.angular.z = float(v), float(omega)
        self.command.publish(message)


def main(kind: type[ParkNode] = ParkNode) -> None:
    """Run the node until it is told to end; the last thing that it says is a stop."""
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)  # else it could say nothing more
    for end in signal.SIGINT, signal.SIGTERM, signal.SIGHUP:
        signal.signal(end, signal.default_int_handler)
    node, executor = kind(), SingleThreadedExecutor()
    executor.add_node(node)
    try:
        while rclpy.ok():
            executor.spin_once(timeout_sec=0.1)  # between two of these Python sees a signal
    except KeyboardInterrupt:
        pass
    finally:  # an error too ends with a stop
        for _ in range(3):  # one alone may be lost with the process that sends it
            node.tell(0.0, 0.0, node.get_clock().now().to_msg())
            time.sleep(0.05)
        node.destroy_node()
        rclpy.shutdown()


if __name__ == "__main__":
    main()
