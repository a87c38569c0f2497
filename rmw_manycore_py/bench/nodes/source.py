# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Publishes as fast as its window permits, and times batches of acknowledged messages.

Usage: source TOPIC BACK BYTES IN_FLIGHT WARM_UP STRETCH STRETCHES, the last three in messages,
messages and stretches.
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


class Source(Node):  # type: ignore[misc]
    """Keeps at most `in_flight` messages unacknowledged."""

    def __init__(self, topic: str, back: str, size_bytes: int, in_flight: int) -> None:
        super().__init__("source")
        self._message = UInt8MultiArray(data=array.array("B", bytes(size_bytes)))
        self._publisher = self.create_publisher(UInt8MultiArray, topic, in_flight + 2)
        self._subscription = self.create_subscription(UInt8MultiArray, back, self._hear, 100)
        self._in_flight, self._sent = in_flight, 0
        self.arrived = -1  # number of the last acknowledged message

    def _hear(self, message: UInt8MultiArray) -> None:
        self.arrived = max(self.arrived, message.layout.data_offset)

    def connect(self, executor: SingleThreadedExecutor) -> None:
        """Wait for the first acknowledgement, of message 0."""
        while self.arrived < 0:
            self._publisher.publish(self._message)
            executor.spin_once(HELLO_PERIOD_S)

    def send_until(self, arrived: int, executor: SingleThreadedExecutor) -> None:
        """Publish until a message is acknowledged."""
        while self.arrived < arrived:
            while self._sent < self.arrived + self._in_flight:
                self._sent += 1
                self._message.layout.data_offset = self._sent
                self._publisher.publish(self._message)
            executor.spin_once()

    def stop(self, executor: SingleThreadedExecutor) -> None:
        """Stop the sink after all messages, and wait for its end."""
        while self.arrived < self._sent:
            executor.spin_once()
        self._publisher.publish(UInt8MultiArray())
        while self._publisher.get_subscription_count():
            executor.spin_once(HELLO_PERIOD_S)


def main() -> None:
    """Measure the batches and print their times."""
    topic, back, *numbers = sys.argv[1:]
    size_bytes, in_flight, warm_up, stretch, stretches = map(int, numbers)
    rclpy.init()
    executor = SingleThreadedExecutor()
    node = Source(topic, back, size_bytes, in_flight)
    executor.add_node(node)
    node.connect(executor)
    node.send_until(warm_up, executor)
    samples_ns = []
    for number in range(1, stretches + 1):
        start_ns = time.monotonic_ns()
        node.send_until(warm_up + number * stretch, executor)
        samples_ns.append(time.monotonic_ns() - start_ns)
    node.stop(executor)
    print(json.dumps({"samples_ns": samples_ns}))
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
