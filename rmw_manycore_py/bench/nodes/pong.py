# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Returns every message until an empty one arrives."""

from __future__ import annotations

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import UInt8MultiArray


class Pong(Node):  # type: ignore[misc]
    """Publishes each message it receives."""

    def __init__(self) -> None:
        super().__init__("pong")
        self._publisher = self.create_publisher(UInt8MultiArray, "/pong", 10)
        self._subscription = self.create_subscription(UInt8MultiArray, "/ping", self._hear, 10)
        self.ended = False

    def _hear(self, message: UInt8MultiArray) -> None:
        self.ended = not message.data
        if not self.ended:
            self._publisher.publish(message)


def main() -> None:
    """Answer until the empty message."""
    rclpy.init()
    node = Pong()
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    while not node.ended:
        executor.spin_once()
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
