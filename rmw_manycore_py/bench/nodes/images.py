# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Sends images there and back, and reads each with numpy at either end.

Usage: images ping BYTES WARM_UP ITERATIONS | images pong BYTES

Also measures what a copy and a read of as many bytes take.
"""

from __future__ import annotations

import array
import json
import sys
import time

import numpy as np
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from sensor_msgs.msg import Image

PING, PONG = "/ping_image", "/pong_image"
DEPTH = 10
HELLO_PERIOD_S = 0.1


def read(image: Image) -> int:
    """Look at each byte."""
    return int(np.frombuffer(image.data, np.uint64).sum())


class End(Node):  # type: ignore[misc]
    """One end, with an image of its own."""

    def __init__(self, name: str, own: str, other: str, size_bytes: int) -> None:
        super().__init__(name)
        self.image = Image(data=array.array("B", bytes(size_bytes)))
        self.publisher = self.create_publisher(Image, own, DEPTH)
        self._subscription = self.create_subscription(Image, other, self._hear, DEPTH)
        self.spinner = SingleThreadedExecutor()
        self.spinner.add_node(self)
        self.number = -1  # of the last image that came; 0 asks to end

    def _hear(self, image: Image) -> None:
        read(image)
        self.number = image.header.stamp.sec

    def send(self, number: int) -> None:
        """Publish the image."""
        self.image.header.stamp.sec = number
        self.publisher.publish(self.image)


def _ping(size_bytes: int, warm_up: int, iterations: int) -> None:
    end = End("ping", PING, PONG, size_bytes)
    while end.number < 0:
        end.send(1)
        end.spinner.spin_once(HELLO_PERIOD_S)
    samples_ns = []
    for number in range(2, warm_up + iterations + 2):
        begin_ns = time.perf_counter_ns()
        end.send(number)
        while end.number != number:
            end.spinner.spin_once()
        samples_ns.append(time.perf_counter_ns() - begin_ns)
    while end.publisher.get_subscription_count():
        end.send(0)
        end.spinner.spin_once(HELLO_PERIOD_S)
    result = {"samples_ns": samples_ns[warm_up:], **_machine(size_bytes, iterations)}
    print(json.dumps(result))


def _machine(size_bytes: int, iterations: int) -> dict[str, list[int]]:
    source, target = np.ones(size_bytes, np.uint8), np.ones(size_bytes, np.uint8)
    times: dict[str, list[int]] = {"copy_ns": [], "read_ns": []}
    for _ in range(iterations):
        begin_ns = time.perf_counter_ns()
        np.copyto(target, source)
        copied_ns = time.perf_counter_ns()
        target.view(np.uint64).sum()
        times["copy_ns"].append(copied_ns - begin_ns)
        times["read_ns"].append(time.perf_counter_ns() - copied_ns)
    return times


def _pong(size_bytes: int) -> None:
    end = End("pong", PONG, PING, size_bytes)
    while end.number != 0:
        end.number = -1
        end.spinner.spin_once()
        if end.number > 0:
            end.send(end.number)


def main() -> None:
    """Run one end."""
    kind, *words = sys.argv[1:]
    rclpy.init()
    _ping(*map(int, words)) if kind == "ping" else _pong(int(words[0]))
    rclpy.shutdown()


if __name__ == "__main__":
    main()
