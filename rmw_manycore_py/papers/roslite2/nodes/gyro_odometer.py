# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`gyro_odometer`: combines wheel speed and gyroscope turn rate into one twist."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from geometry_msgs.msg import TwistStamped, TwistWithCovarianceStamped, Vector3
from rclpy.node import Node
from sensor_msgs.msg import Imu

from rmw_manycore_py.ndt.messages.conversions import seconds
from rmw_manycore_py.ndt.nodes.support.clock import clock_s
from rmw_manycore_py.ndt.nodes.support.declared import declare, parameter
from rmw_manycore_py.ndt.nodes.support.log_throttle import ThrottledLog
from rmw_manycore_py.ndt.nodes.support.running import run_node
from rmw_manycore_py.ndt.nodes.support.watched import watched
from rmw_manycore_py.papers.roslite2.laws.odometry import gyro_covariance, is_stale, is_standing


@dataclass(frozen=True)
class OdometerParameters:
    """Autoware's parameters."""

    timeout_s: float = parameter("message_timeout_sec", 0.2, above=0.0)


class GyroOdometer(Node):
    """Publishes a twist per IMU message: raw (`_raw`), and with zero rates at standstill.

    The axes of the IMU must be those of the vehicle.
    """

    def __init__(self) -> None:
        super().__init__("gyro_odometer")
        self._p = declare(self, OdometerParameters)
        self._complain = ThrottledLog(self.get_logger().error)
        self._twist: Any = None  # newest twist of the vehicle
        self._imu_s: float | None = None
        self._raw = self.create_publisher(TwistStamped, "twist_raw", 10)
        self._corrected = self.create_publisher(TwistStamped, "twist", 10)
        self._raw_full = self.create_publisher(
            TwistWithCovarianceStamped, "twist_with_covariance_raw", 10
        )
        self._corrected_full = self.create_publisher(
            TwistWithCovarianceStamped, "twist_with_covariance", 10
        )
        self.create_subscription(
            TwistWithCovarianceStamped,
            "vehicle/twist_with_covariance",
            self._on_twist,
            100,
            event_callbacks=watched(self, "vehicle/twist_with_covariance"),
        )
        self.create_subscription(
            Imu, "imu", self._on_imu, 100, event_callbacks=watched(self, "imu")
        )

    def _on_twist(self, message: Any) -> None:
        self._twist = message
        if self._imu_s is None:
            self._complain("no message on imu yet")
        elif is_stale(self._imu_s, clock_s(self), self._p.timeout_s):
            self._complain(self._stale("imu", self._imu_s))

    def _on_imu(self, imu: Any) -> None:
        self._imu_s = seconds(imu.header.stamp)
        if self._twist is None:
            self._complain("no message on vehicle/twist_with_covariance yet")
            return
        stamp_s = seconds(self._twist.header.stamp)
        if is_stale(stamp_s, clock_s(self), self._p.timeout_s):
            self._complain(self._stale("vehicle/twist_with_covariance", stamp_s))
            return
        self._publish(imu, self._raw, self._raw_full, imu.angular_velocity)
        linear = self._twist.twist.twist.linear
        stands = is_standing(imu.angular_velocity.z, linear.x)
        turn = Vector3() if stands else imu.angular_velocity
        self._publish(imu, self._corrected, self._corrected_full, turn)

    def _publish(self, imu: Any, publisher: Any, full_publisher: Any, turn: Any) -> None:
        twist = TwistStamped(header=imu.header)
        twist.twist.linear = self._twist.twist.twist.linear
        twist.twist.angular = turn
        publisher.publish(twist)
        full = TwistWithCovarianceStamped(header=imu.header)
        full.twist.twist = twist.twist
        about_x, about_y, about_z = map(float, imu.angular_velocity_covariance[::4])
        speed_variance = float(self._twist.twist.covariance[0])
        covariance = gyro_covariance(speed_variance, (about_x, about_y, about_z))
        full.twist.covariance = np.array(covariance)
        full_publisher.publish(full)

    def _stale(self, topic: str, stamp_s: float) -> str:
        age_s = clock_s(self) - stamp_s
        return (
            f"the newest message on {topic} is {age_s:.2f} s old, expected at most "
            f"{self._p.timeout_s:g} s: no twist is published; check the sensor and the clocks"
        )


def main() -> None:
    """Run the node until interrupted."""
    run_node(GyroOdometer)


if __name__ == "__main__":
    main()
