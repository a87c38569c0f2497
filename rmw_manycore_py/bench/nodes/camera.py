# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Publishes images at a fixed rate, or counts them.

Usage: camera RELIABILITY BYTES HZ COUNT | camera RELIABILITY count COUNT

The camera publishes empty messages until the end of its input, then the images; it reports ready
when all are sent. The counter reports ready at the first empty message. After the end of its input
it exits once COUNT images have come, or none for QUIET_S.
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
QUIET_S = 5.0  # several times what a busy host needs to send an image again


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


def _count(node: Node, qos: QoSProfile, expected: int) -> None:
    is_ready, has_come = threading.Event(), threading.Event()
    images = 0

    def hear(message: UInt8MultiArray) -> None:
        nonlocal images
        images += bool(message.data)
        has_come.set()
        if not is_ready.is_set():
            is_ready.set()
            print("ready", flush=True)

    node.create_subscription(UInt8MultiArray, TOPIC, hear, qos)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    spinner = threading.Thread(target=executor.spin)
    spinner.start()
    sys.stdin.read()
    while images < expected and has_come.wait(QUIET_S):
        has_come.clear()
    executor.shutdown()
    spinner.join()
    print(json.dumps({"images": images}))


def main() -> None:
    """Publish or count."""
    reliability, *rest = sys.argv[1:]
    rclpy.init()
    counts = rest[0] == "count"
    node = rclpy.create_node("counter" if counts else "camera")
    qos = QoSProfile(depth=DEPTH, reliability=ReliabilityPolicy[reliability.upper()])
    _count(node, qos, int(rest[1])) if counts else _send(node, qos, *map(int, rest))
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
