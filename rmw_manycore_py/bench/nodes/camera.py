# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Publishes images at a fixed rate, or counts them.

Usage: camera RELIABILITY BYTES HZ COUNT | camera RELIABILITY count

The camera publishes empty messages until the end of its input, then the images; it reports ready
when all are sent. The counter reports ready at the first empty message, and exits at the end of its
input.
"""

from __future__ import annotations

import array
import json
import sys
import threading
import time

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from std_msgs.msg import UInt8MultiArray

TOPIC = "/images"
HELLO_PERIOD_S = 0.1
DEPTH = 10


def _send(node: Node, qos: QoSProfile, size_bytes: int, rate_hz: int, count: int) -> None:
    publisher = node.create_publisher(UInt8MultiArray, TOPIC, qos)
    is_asked = threading.Event()

    def listen() -> None:
        sys.stdin.read()
        is_asked.set()

    threading.Thread(target=listen, daemon=True).start()
    while not is_asked.wait(HELLO_PERIOD_S):
        publisher.publish(UInt8MultiArray())
    image = UInt8MultiArray(data=array.array("B", bytes(size_bytes)))
    start_s = time.monotonic()
    for number in range(count):
        time.sleep(max(start_s + number / rate_hz - time.monotonic(), 0))
        publisher.publish(image)
    print("ready", flush=True)
    threading.Event().wait()  # stay for retransmissions


def _count(node: Node, qos: QoSProfile) -> None:
    is_ready = threading.Event()
    images = 0

    def hear(message: UInt8MultiArray) -> None:
        nonlocal images
        images += bool(message.data)
        if not is_ready.is_set():
            is_ready.set()
            print("ready", flush=True)

    node.create_subscription(UInt8MultiArray, TOPIC, hear, qos)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    spinner = threading.Thread(target=executor.spin)
    spinner.start()
    sys.stdin.read()
    executor.shutdown()
    spinner.join()
    print(json.dumps({"images": images}))


def main() -> None:
    """Publish or count."""
    reliability, *rest = sys.argv[1:]
    rclpy.init()
    node = rclpy.create_node("counter" if rest == ["count"] else "camera")
    qos = QoSProfile(depth=DEPTH, reliability=ReliabilityPolicy[reliability.upper()])
    _count(node, qos) if rest == ["count"] else _send(node, qos, *map(int, rest))
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
