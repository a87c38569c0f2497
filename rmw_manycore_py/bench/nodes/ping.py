# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Sends messages and measures their round-trip times.

Usage: ping BYTES WARM_UP ITERATIONS
"""

from __future__ import annotations

import array
import json
import sys
import time

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import UInt8MultiArray

HELLO_PERIOD_S = 0.1


class Ping(Node):  # type: ignore[misc]
    """Publishes the next message when the previous answer has arrived."""

    def __init__(self, size_bytes: int, executor: SingleThreadedExecutor) -> None:
        super().__init__("ping")
        executor.add_node(self)
        self._executor = executor
        self._message = UInt8MultiArray(data=array.array("B", bytes(size_bytes)))
        self._publisher = self.create_publisher(UInt8MultiArray, "/ping", 10)
        self._subscription = self.create_subscription(UInt8MultiArray, "/pong", self._hear, 10)
        self._answers: set[int] = set()

    def _hear(self, message: UInt8MultiArray) -> None:
        self._answers.add(message.layout.data_offset)

    def connect(self) -> None:
        """Wait for the first round trip."""
        while not self._answers:
            self._publisher.publish(self._message)
            self._executor.spin_once(HELLO_PERIOD_S)

    def round_trip(self, number: int) -> int:
        """Return the time of one round trip in nanoseconds."""
        self._message.layout.data_offset = number
        start_ns = time.monotonic_ns()
        self._publisher.publish(self._message)
        while number not in self._answers:
            self._executor.spin_once()
        return time.monotonic_ns() - start_ns

    def stop(self) -> None:
        """Stop the other side and wait for its end, so that the message is not lost."""
        self._publisher.publish(UInt8MultiArray())
        while self._publisher.get_subscription_count():
            self._executor.spin_once(HELLO_PERIOD_S)


def main() -> None:
    """Measure the round trips and print them."""
    size_bytes, warm_up, iterations = (int(word) for word in sys.argv[1:])
    rclpy.init()
    node = Ping(size_bytes, SingleThreadedExecutor())
    node.connect()
    samples_ns = [node.round_trip(number) for number in range(1, warm_up + iterations + 1)]
    node.stop()
    print(json.dumps({"samples_ns": samples_ns[warm_up:]}))
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
