# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Publishes "Hello World: <n>" on `chatter`, `rate_hz` times a second."""

from contextlib import suppress

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Talker(Node):
    """Publishes a counter."""

    def __init__(self) -> None:
        super().__init__("talker")
        rate_hz = self.declare_parameter("rate_hz", 2.0).value
        self._count = 0
        self._publisher = self.create_publisher(String, "chatter", 10)
        self._timer = self.create_timer(1.0 / rate_hz, self._say)

    def _say(self) -> None:
        self._count += 1
        message = String(data=f"Hello World: {self._count}")
        self._publisher.publish(message)
        self.get_logger().info(f"Publishing: '{message.data}'")


def main() -> None:
    """Run the node until interrupted."""
    rclpy.init()
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(Talker())


if __name__ == "__main__":
    main()
