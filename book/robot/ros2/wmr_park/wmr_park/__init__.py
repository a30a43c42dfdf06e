"""The book's pose-to-pose drive as a ROS 2 node."""
