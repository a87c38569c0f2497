from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription(
        [
            Node(package="p", executable="e", colour="red"),
        ]
    )
# expected: unknown_option.launch.py:8: colour: expected an option of a node or executable, found 'colour'
