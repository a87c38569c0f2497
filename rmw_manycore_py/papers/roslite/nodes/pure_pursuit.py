# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`pure_pursuit`: speed and yaw rate that lead to a point of the lane ahead."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from autoware_msgs.msg import ControlCommandStamped, Lane
from geometry_msgs.msg import PoseStamped, TwistStamped
from rclpy.node import Node

from rmw_manycore_py.ndt.nodes.support.declared import declare, parameter
from rmw_manycore_py.ndt.nodes.support.running import run_node
from rmw_manycore_py.papers.roslite.laws.lanes import Waypoints
from rmw_manycore_py.papers.roslite.laws.pure_pursuit import PursuitRule, pursue
from rmw_manycore_py.papers.roslite.messages import place_of, waypoints_of

PERIOD_S = 1.0 / 30.0


@dataclass(frozen=True)
class PursuitParameters:
    """Parameters of the node."""

    ratio_s: float = parameter("lookahead_distance_ratio", 2.0, above=0.0)
    min_m: float = parameter("minimum_lookahead_distance", 6.0, above=0.0)
    wheel_base_m: float = parameter("wheel_base", 2.7, above=0.0)


class PurePursuit(Node):
    """Publishes `twist_raw` and `ctrl_raw` at 30 Hz.

    Their stamp is that of the pose, so that a command can be attributed to a scan; Autoware's is
    the time of the command.
    """

    def __init__(self) -> None:
        super().__init__("pure_pursuit")
        p = declare(self, PursuitParameters)
        self._rule = PursuitRule(p.ratio_s, p.min_m, wheel_base_m=p.wheel_base_m)
        self._lane: Waypoints | None = None
        self._pose: Any = None
        self._speed_m_s: float | None = None
        self._twist = self.create_publisher(TwistStamped, "twist_raw", 10)
        self._control = self.create_publisher(ControlCommandStamped, "ctrl_raw", 10)
        self.create_subscription(Lane, "final_waypoints", self._on_lane, 1)
        self.create_subscription(PoseStamped, "current_pose", self._on_pose, 1)
        self.create_subscription(TwistStamped, "current_velocity", self._on_velocity, 1)
        self.create_timer(PERIOD_S, self._pursue)

    def _on_lane(self, message: Any) -> None:
        self._lane = waypoints_of(message.waypoints) if message.waypoints else None

    def _on_pose(self, message: Any) -> None:
        self._pose = message

    def _on_velocity(self, message: Any) -> None:
        self._speed_m_s = message.twist.linear.x

    def _pursue(self) -> None:
        if self._lane is None or self._pose is None or self._speed_m_s is None:
            return
        found = pursue(self._lane, place_of(self._pose.pose), self._speed_m_s, self._rule)
        twist = TwistStamped(header=self._pose.header)
        twist.twist.linear.x = found.speed_m_s
        twist.twist.angular.z = found.yaw_rate_rad_s
        self._twist.publish(twist)
        control = ControlCommandStamped(header=self._pose.header)
        control.cmd.linear_velocity = found.speed_m_s
        control.cmd.linear_acceleration = found.acceleration_m_s2
        control.cmd.steering_angle = found.steering_rad
        self._control.publish(control)


def main() -> None:
    """Run the node until interrupted."""
    run_node(PurePursuit)


if __name__ == "__main__":
    main()
