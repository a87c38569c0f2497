# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Time of a node's clock."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rclpy.node import Node


def clock_s(node: Node) -> float:
    """Return the time of a node's clock (ROS or simulated) in seconds."""
    return float(node.get_clock().now().nanoseconds) / 1e9
