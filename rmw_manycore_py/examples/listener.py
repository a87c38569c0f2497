# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Logs the messages on `chatter`."""

from contextlib import suppress

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Listener(Node):
    """Logs every message."""

    def __init__(self) -> None:
        super().__init__("listener")
        self._subscription = self.create_subscription(String, "chatter", self._hear, 10)

    def _hear(self, message: String) -> None:
        self.get_logger().info(f"I heard: '{message.data}'")


def main() -> None:
    """Run the node until interrupted."""
    rclpy.init()
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(Listener())


if __name__ == "__main__":
    main()
