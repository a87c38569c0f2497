# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`waypoint_filter`: the part of the lane ahead; the relaying state of astar_avoid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from autoware_msgs.msg import Lane
from geometry_msgs.msg import PoseStamped
from rclpy.node import Node
from std_msgs.msg import Int32

from rmw_manycore_py.ndt.nodes.support.declared import declare, parameter
from rmw_manycore_py.ndt.nodes.support.running import run_node

PERIOD_S = 0.1


@dataclass(frozen=True)
class FilterParameters:
    """Parameters of the node."""

    size: int = parameter("safety_waypoints_size", 100, min_value=2)


class WaypointFilter(Node):
    """Publishes `safety_waypoints` at 10 Hz: those of the lane from the closest one on."""

    def __init__(self) -> None:
        super().__init__("waypoint_filter")
        self._p = declare(self, FilterParameters)
        self._lane: Any = None
        self._closest: Any = None
        self._pose: Any = None
        self._output = self.create_publisher(Lane, "safety_waypoints", 1)
        self.create_subscription(Lane, "base_waypoints", self._on_lane, 1)
        self.create_subscription(Int32, "closest_waypoint", self._on_closest, 1)
        self.create_subscription(PoseStamped, "current_pose", self._on_pose, 1)
        self.create_timer(PERIOD_S, self._filter)

    def _on_lane(self, message: Any) -> None:
        self._lane = message

    def _on_closest(self, message: Any) -> None:
        self._closest = message.data

    def _on_pose(self, message: Any) -> None:
        self._pose = message

    def _filter(self) -> None:
        if self._lane is None or self._closest is None or self._pose is None:
            return
        if not 0 <= self._closest < len(self._lane.waypoints):  # of another lane
            return
        ahead = self._lane.waypoints[self._closest : self._closest + self._p.size]
        self._output.publish(
            Lane(header=self._lane.header, increment=self._lane.increment, waypoints=ahead)
        )


def main() -> None:
    """Run the node until interrupted."""
    run_node(WaypointFilter)


if __name__ == "__main__":
    main()
