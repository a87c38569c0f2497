# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`vehicle_velocity_converter`: converts the reported speed to a twist with covariance."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from autoware_vehicle_msgs.msg import VelocityReport
from geometry_msgs.msg import TwistWithCovarianceStamped
from rclpy.node import Node

from rmw_manycore_py.ndt.nodes.support.declared import declare, parameter
from rmw_manycore_py.ndt.nodes.support.running import run_node
from rmw_manycore_py.ndt.nodes.support.watched import watched
from rmw_manycore_py.papers.roslite2.laws.odometry import velocity_covariance


@dataclass(frozen=True)
class ConverterParameters:
    """Autoware's parameters."""

    stddev_vx_m_s: float = parameter("velocity_stddev_xx", 0.2, min_value=0.0)
    stddev_wz_rad_s: float = parameter("angular_velocity_stddev_zz", 0.1, min_value=0.0)
    frame: str = parameter("frame_id", "base_link")
    speed_scale: float = parameter("speed_scale_factor", 1.0, above=0.0)


class VehicleVelocityConverter(Node):
    """Converts `velocity_status` to `twist_with_covariance`, message by message."""

    def __init__(self) -> None:
        super().__init__("vehicle_velocity_converter")
        self._p = declare(self, ConverterParameters)
        covariance = velocity_covariance(self._p.stddev_vx_m_s, self._p.stddev_wz_rad_s)
        self._covariance = np.array(covariance)
        self._output = self.create_publisher(
            TwistWithCovarianceStamped, "twist_with_covariance", 10
        )
        self.create_subscription(
            VelocityReport,
            "velocity_status",
            self._on_report,
            100,
            event_callbacks=watched(self, "velocity_status"),
        )

    def _on_report(self, report: Any) -> None:
        if report.header.frame_id != self._p.frame:
            self.get_logger().warning(
                f"velocity_status: expected the frame '{self._p.frame}', found "
                f"'{report.header.frame_id}'",
                throttle_duration_sec=1.0,
            )
        message = TwistWithCovarianceStamped(header=report.header)
        twist = message.twist.twist
        twist.linear.x = report.longitudinal_velocity * self._p.speed_scale
        twist.linear.y = report.lateral_velocity
        twist.angular.z = report.heading_rate
        message.twist.covariance = self._covariance
        self._output.publish(message)


def main() -> None:
    """Run the node until interrupted."""
    run_node(VehicleVelocityConverter)


if __name__ == "__main__":
    main()
