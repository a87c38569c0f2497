# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`velocity_set`: speeds with which the vehicle stops before obstacles on its lane."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from autoware_msgs.msg import Lane
from geometry_msgs.msg import PoseStamped
from rclpy.node import Node
from sensor_msgs.msg import PointCloud2

from rmw_manycore_py.ndt.messages.point_cloud import CloudError, decode
from rmw_manycore_py.ndt.nodes.support.declared import declare, parameter
from rmw_manycore_py.ndt.nodes.support.log_throttle import ThrottledLog
from rmw_manycore_py.ndt.nodes.support.running import run_node
from rmw_manycore_py.papers.roslite.laws.lanes import NONE
from rmw_manycore_py.papers.roslite.laws.obstacles import (
    StopRule,
    blocked_waypoint,
    points_on_map,
    stopped_before,
)
from rmw_manycore_py.papers.roslite.messages import place_of, set_speeds, waypoints_of

PERIOD_S = 0.1


@dataclass(frozen=True)
class VelocityParameters:
    """Parameters of the node."""

    range_m: float = parameter("stop_range", 1.3, above=0.0)
    min_points: int = parameter("threshold_points", 10, min_value=1)
    distance_m: float = parameter("stop_distance_obstacle", 10.0, min_value=0.0)
    deceleration_m_s2: float = parameter("deceleration_obstacle", 0.8, above=0.0)
    bottom_m: float = parameter("detection_height_bottom", -1.7)
    top_m: float = parameter("detection_height_top", 0.2)


class VelocitySet(Node):
    """Publishes `final_waypoints` at 10 Hz."""

    def __init__(self) -> None:
        super().__init__("velocity_set")
        p = declare(self, VelocityParameters)
        self._rule = StopRule(
            p.range_m, p.min_points, p.bottom_m, p.top_m, p.distance_m, p.deceleration_m_s2
        )
        self._complain = ThrottledLog(self.get_logger().warning)
        self._lane: Any = None
        self._points = np.zeros((0, 3), np.float32)
        self._pose: Any = None
        self._output = self.create_publisher(Lane, "final_waypoints", 1)
        self.create_subscription(Lane, "safety_waypoints", self._on_lane, 1)
        self.create_subscription(PointCloud2, "points_no_ground", self._on_points, 1)
        self.create_subscription(PoseStamped, "current_pose", self._on_pose, 1)
        self.create_timer(PERIOD_S, self._set)

    def _on_lane(self, message: Any) -> None:
        self._lane = message

    def _on_points(self, message: Any) -> None:
        try:
            self._points = decode(message).astype(np.float32)
        except CloudError as error:
            self._complain(f"points_no_ground ignored: {error}")

    def _on_pose(self, message: Any) -> None:
        self._pose = message

    def _set(self) -> None:
        if self._lane is None or self._pose is None:
            return
        message, self._lane = self._lane, None
        lane = waypoints_of(message.waypoints)
        obstacles_m = points_on_map(self._points, place_of(self._pose.pose), self._rule)
        blocked = blocked_waypoint(lane, obstacles_m, self._rule)
        if blocked != NONE:
            set_speeds(message.waypoints, stopped_before(lane, blocked, self._rule).speed_m_s)
        self._output.publish(message)


def main() -> None:
    """Run the node until interrupted."""
    run_node(VelocitySet)


if __name__ == "__main__":
    main()
