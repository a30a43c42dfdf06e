"""ros2 launch wmr_park park.launch.py parameters:=my_robot.yaml"""

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    """The node, with the topics of a usual robot: rename them here."""
    usual = f"{get_package_share_directory('wmr_park')}/config/my_robot.yaml"
    topics = {
        "fix": "fix",
        "imu": "imu",
        "odom": "odom",
        "battery": "battery",
        "goal_pose": "goal_pose",
        "cmd_vel": "cmd_vel",
    }
    return LaunchDescription(
        [
            DeclareLaunchArgument("parameters", default_value=usual),
            Node(
                package="wmr_park",
                executable="park",
                parameters=[LaunchConfiguration("parameters")],
                remappings=list(topics.items()),
            ),
        ]
    )
