# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Acknowledges messages by number, and finally reports how many were missing.

Usage: sink TOPIC BACK IN_FLIGHT; it ends when an empty message comes.
"""

from __future__ import annotations

import json
import sys

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import UInt8MultiArray


class Sink(Node):  # type: ignore[misc]
    """Answers each message with its number."""

    def __init__(self, topic: str, back: str, in_flight: int) -> None:
        super().__init__("sink")
        self._publisher = self.create_publisher(UInt8MultiArray, back, 100)
        self._subscription = self.create_subscription(
            UInt8MultiArray, topic, self._hear, in_flight + 2
        )
        self._last = 0
        self.lost = 0
        self.ended = False

    def _hear(self, message: UInt8MultiArray) -> None:
        self.ended = not message.data
        number = message.layout.data_offset
        if not self.ended:
            self.lost += max(number - self._last - 1, 0)
            self._last = number
            answer = UInt8MultiArray()
            answer.layout.data_offset = number
            self._publisher.publish(answer)


def main() -> None:
    """Answer until the source stops."""
    topic, back, in_flight = sys.argv[1:]
    rclpy.init()
    node = Sink(topic, back, int(in_flight))
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    while not node.ended:
        executor.spin_once()
    print(json.dumps({"lost": node.lost}))
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
