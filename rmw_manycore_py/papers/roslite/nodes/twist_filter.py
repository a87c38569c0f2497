# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`twist_filter`: commands limited by their lateral acceleration."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from autoware_msgs.msg import ControlCommandStamped
from geometry_msgs.msg import TwistStamped
from rclpy.node import Node

from rmw_manycore_py.ndt.nodes.support.declared import declare, parameter
from rmw_manycore_py.ndt.nodes.support.running import run_node
from rmw_manycore_py.papers.roslite.laws.twist import FilterRule, TwistFilter


@dataclass(frozen=True)
class TwistParameters:
    """Parameters of the node."""

    lateral_m_s2: float = parameter("lateral_accel_limit", 5.0, above=0.0)
    gain_speed: float = parameter("lowpass_gain_linear_x", 0.0, min_value=0.0, max_value=1.0)
    gain_yaw_rate: float = parameter("lowpass_gain_angular_z", 0.0, min_value=0.0, max_value=1.0)


class TwistFilterNode(Node):
    """Publishes `twist_cmd` and `ctrl_cmd` for each `twist_raw` and `ctrl_raw`."""

    def __init__(self) -> None:
        super().__init__("twist_filter")
        p = declare(self, TwistParameters)
        self._filter = TwistFilter(FilterRule(p.lateral_m_s2, p.gain_speed, p.gain_yaw_rate))
        self._twist = self.create_publisher(TwistStamped, "twist_cmd", 10)
        self._control = self.create_publisher(ControlCommandStamped, "ctrl_cmd", 10)
        self.create_subscription(TwistStamped, "twist_raw", self._on_twist, 10)
        self.create_subscription(ControlCommandStamped, "ctrl_raw", self._control.publish, 10)

    def _on_twist(self, message: Any) -> None:
        twist = message.twist
        twist.linear.x, twist.angular.z = self._filter(twist.linear.x, twist.angular.z)
        self._twist.publish(message)


def main() -> None:
    """Run the node until interrupted."""
    run_node(TwistFilterNode)


if __name__ == "__main__":
    main()
