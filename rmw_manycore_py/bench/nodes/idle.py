# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Idle node with one publisher and one subscription, until the end of its input.

Usage: idle NAME
"""

from __future__ import annotations

import sys
import threading

import rclpy
from rclpy.executors import SingleThreadedExecutor
from std_msgs.msg import UInt8MultiArray


def main() -> None:
    """Wait for messages that never arrive."""
    name = sys.argv[1]
    rclpy.init()
    node = rclpy.create_node(name)
    node.create_publisher(UInt8MultiArray, name, 1)
    node.create_subscription(UInt8MultiArray, name, lambda _: None, 1)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    spinning = threading.Thread(target=executor.spin)
    spinning.start()
    print("ready", flush=True)
    sys.stdin.read()
    executor.shutdown()
    spinning.join()
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
