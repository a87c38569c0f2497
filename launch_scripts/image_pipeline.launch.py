# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A camera, a filter and a checker of the output, all in the namespace /camera."""

from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    """Return the three nodes with remapped topics."""
    raw = ("image_raw", "/camera/image_raw")
    inverted = ("image_inverted", "/camera/image_inverted")
    return LaunchDescription(
        [
            Node(
                package="rmw_manycore",
                executable="image_source",
                name="image_source",
                parameters=[{"rate_hz": 10.0}],
                remappings=[raw],
            ),
            Node(
                package="rmw_manycore",
                executable="image_filter",
                name="image_filter",
                remappings=[raw, inverted],
            ),
            Node(
                package="rmw_manycore",
                executable="image_sink",
                name="image_sink",
                remappings=[inverted],
            ),
        ]
    )
