from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([Node(package="demo", executable="talker", remappings=[("one",)])])
# expected: remapping_of_one.launch.py:6: expected launch code that is understood here, found ValueError: not enough values to unpack (expected 2, got 1)
