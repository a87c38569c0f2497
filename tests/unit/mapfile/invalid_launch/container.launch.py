from launch import LaunchDescription
from launch_ros.actions import ComposableNodeContainer


def generate_launch_description():
    return LaunchDescription(
        [
            ComposableNodeContainer(
                name="c",
                namespace="",
                package="rclcpp_components",
                executable="component_container",
            ),
        ]
    )
# expected: container.launch.py:8: expected nodes with an executable of their own, found a container of composable nodes
