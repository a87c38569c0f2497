# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`lane_select`: the lane that the vehicle is on, and its closest waypoint."""

from __future__ import annotations

from typing import Any

from autoware_msgs.msg import Lane, LaneArray
from geometry_msgs.msg import PoseStamped, TwistStamped
from rclpy.node import Node
from std_msgs.msg import Int32

from rmw_manycore_py.ndt.nodes.support.log_throttle import ThrottledLog
from rmw_manycore_py.ndt.nodes.support.running import run_node
from rmw_manycore_py.papers.roslite.laws.lanes import NONE, Waypoints, nearest_lane
from rmw_manycore_py.papers.roslite.messages import LATCHED, place_of, waypoints_of

PERIOD_S = 0.1


class LaneSelect(Node):
    """Publishes `base_waypoints` and `closest_waypoint` at 10 Hz; the stamp is the pose's."""

    def __init__(self) -> None:
        super().__init__("lane_select")
        self._complain = ThrottledLog(self.get_logger().warning)
        self._messages: list[Any] = []
        self._lanes: list[Waypoints] = []
        self._pose: Any = None
        self._velocity: Any = None
        self._lane = self.create_publisher(Lane, "base_waypoints", 1)
        self._closest = self.create_publisher(Int32, "closest_waypoint", 1)
        self.create_subscription(LaneArray, "traffic_waypoints_array", self._on_lanes, LATCHED)
        self.create_subscription(PoseStamped, "current_pose", self._on_pose, 1)
        self.create_subscription(TwistStamped, "current_velocity", self._on_velocity, 1)
        self.create_timer(PERIOD_S, self._select)

    def _on_lanes(self, message: Any) -> None:
        self._messages = list(message.lanes)
        self._lanes = [waypoints_of(lane.waypoints) for lane in message.lanes]

    def _on_pose(self, message: Any) -> None:
        self._pose = message

    def _on_velocity(self, message: Any) -> None:
        self._velocity = message

    def _select(self) -> None:
        if not self._lanes or self._pose is None or self._velocity is None:
            return
        lane, closest = nearest_lane(self._lanes, place_of(self._pose.pose))
        if closest == NONE:
            self._complain("no lane has a waypoint that heads the vehicle's way")
            return
        message = self._messages[lane]
        message.header = self._pose.header
        self._lane.publish(message)
        self._closest.publish(Int32(data=closest))


def main() -> None:
    """Run the node until interrupted."""
    run_node(LaneSelect)


if __name__ == "__main__":
    main()
