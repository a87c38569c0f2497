# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Publishes messages and measures the time to take each one.

Usage: copies BYTES WARM_UP MESSAGES
"""

from __future__ import annotations

import array
import json
import sys
import time

import rclpy
from std_msgs.msg import UInt8MultiArray

DEPTH = 2
WAIT_S = 0.01


def main() -> None:
    """Measure what rclpy's executor calls and print it."""
    size_bytes, warm_up, messages = (int(word) for word in sys.argv[1:])
    rclpy.init()
    node = rclpy.create_node("copies")
    publisher = node.create_publisher(UInt8MultiArray, "/copies", DEPTH)
    subscription = node.create_subscription(UInt8MultiArray, "/copies", lambda _: None, DEPTH)
    while not publisher.get_subscription_count():
        rclpy.spin_once(node, timeout_sec=WAIT_S)
    message = UInt8MultiArray(data=array.array("B", bytes(size_bytes)))
    samples_ns = []
    for _ in range(warm_up + messages):
        publisher.publish(message)
        taken = None
        while taken is None:
            begin_ns = time.perf_counter_ns()
            taken = subscription.handle.take_message(UInt8MultiArray, False)
        samples_ns.append(time.perf_counter_ns() - begin_ns)
    print(json.dumps({"samples_ns": samples_ns[warm_up:]}))
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
