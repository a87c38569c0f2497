# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`lane_rule`: lanes on which the vehicle stops at the end."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from autoware_msgs.msg import LaneArray
from rclpy.node import Node

from rmw_manycore_py.ndt.nodes.support.declared import declare, parameter
from rmw_manycore_py.ndt.nodes.support.running import run_node
from rmw_manycore_py.papers.roslite.laws.lanes import braked
from rmw_manycore_py.papers.roslite.messages import LATCHED, set_speeds, waypoints_of


@dataclass(frozen=True)
class RuleParameters:
    """Parameters of the node."""

    acceleration_m_s2: float = parameter("acceleration", 1.0, above=0.0)


class LaneRule(Node):
    """Publishes `traffic_waypoints_array` for each `lane_waypoints_array`."""

    def __init__(self) -> None:
        super().__init__("lane_rule")
        self._p = declare(self, RuleParameters)
        self._output = self.create_publisher(LaneArray, "traffic_waypoints_array", LATCHED)
        self.create_subscription(LaneArray, "lane_waypoints_array", self._on_lanes, LATCHED)

    def _on_lanes(self, message: Any) -> None:
        for lane in message.lanes:
            if lane.waypoints:
                ruled = waypoints_of(lane.waypoints)
                ruled = braked(ruled, len(ruled) - 1, self._p.acceleration_m_s2)
                set_speeds(lane.waypoints, ruled.speed_m_s)
        self._output.publish(message)


def main() -> None:
    """Run the node until interrupted."""
    run_node(LaneRule)


if __name__ == "__main__":
    main()
