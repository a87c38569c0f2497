# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Prints the time (CLOCK_MONOTONIC) of its first callback, and exits."""

from __future__ import annotations

import json
import time

import rclpy
from rclpy.qos import QoSDurabilityPolicy, QoSProfile
from std_msgs.msg import UInt8MultiArray


def main() -> None:
    """Wait for the transient-local message of the publisher."""
    arrived_ns: list[int] = []
    rclpy.init()
    node = rclpy.create_node("first_message")
    latched = QoSProfile(depth=1, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
    node.create_subscription(
        UInt8MultiArray, "/latched", lambda _: arrived_ns.append(time.monotonic_ns()), latched
    )
    while not arrived_ns:
        rclpy.spin_once(node)
    print(json.dumps({"arrived_ns": arrived_ns[0]}))
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
