# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Publishes large messages for several readers, or takes them.

Usage: readers source BYTES COUNT READERS | readers reader COUNT

A reader prints the CPU time of each take, with its conversion. The source waits for its readers.
"""

from __future__ import annotations

import array
import json
import sys
import time

import numpy as np
import rclpy
from std_msgs.msg import UInt8MultiArray

TOPIC = "/readers"
DEPTH = 10
LOOK_S = 0.001
PERIOD_S = 0.1  # so that a message finds its readers asleep


def _publish(size_bytes: int, count: int, readers: int) -> None:
    node = rclpy.create_node("source")
    publisher = node.create_publisher(UInt8MultiArray, TOPIC, DEPTH)
    message = UInt8MultiArray(data=array.array("B", bytes(size_bytes)))
    while publisher.get_subscription_count() != readers:
        time.sleep(LOOK_S)
    for _ in range(count):
        publisher.publish(message)
        time.sleep(PERIOD_S)
    while publisher.get_subscription_count():
        time.sleep(LOOK_S)
    print(json.dumps({"copies_ns": _copies_ns(size_bytes, count)}))
    node.destroy_node()


def _copies_ns(size_bytes: int, count: int) -> list[int]:
    source, target = np.ones(size_bytes, np.uint8), np.ones(size_bytes, np.uint8)
    found = []
    for _ in range(count):
        begin_ns = time.thread_time_ns()
        np.copyto(target, source)
        found.append(time.thread_time_ns() - begin_ns)
    return found


def _take(count: int) -> None:
    node = rclpy.create_node("reader")
    subscription = node.create_subscription(UInt8MultiArray, TOPIC, lambda _: None, DEPTH)
    samples_ns: list[int] = []
    while len(samples_ns) < count:
        begin_ns = time.thread_time_ns()
        taken = subscription.handle.take_message(UInt8MultiArray, False)
        spent_ns = time.thread_time_ns() - begin_ns
        if taken is None:
            time.sleep(LOOK_S)
        else:
            samples_ns.append(spent_ns)
    print(json.dumps({"samples_ns": samples_ns}))
    node.destroy_node()


def main() -> None:
    """Publish or take."""
    kind, *words = sys.argv[1:]
    rclpy.init()
    _publish(*map(int, words)) if kind == "source" else _take(int(words[0]))
    rclpy.shutdown()


if __name__ == "__main__":
    main()
