# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A camera, a filter behind it, and a detector, written as most programs of rclpy are.

Usage: cameras camera WIDTH HEIGHT HZ COUNT | cameras filter | cameras detector SOURCE

The camera sends images without rows until the end of its input, then COUNT images. The detector
reports ready at the first image, and exits when none has come for QUIET_S after the end of its
input. SOURCE is the node whose images it takes.
"""

from __future__ import annotations

import array
import json
import statistics
import sys
import threading
import time

import numpy as np
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from sensor_msgs.msg import Image

RAW, FILTERED = "/camera/image", "/camera/filtered"
SOURCES = {"camera": RAW, "filter": FILTERED}
DEPTH = 10
CHANNELS = 3
HELLO_PERIOD_S = 0.1
QUIET_S = 3.0
MAX_BRIGHTNESS = 250


class Camera(Node):  # type: ignore[misc]
    """Publishes images of a bright square that moves."""

    def __init__(self, width: int, height: int) -> None:
        super().__init__("camera")
        self._publisher = self.create_publisher(Image, RAW, DEPTH)
        self._image = Image(height=height, width=width, encoding="rgb8", step=CHANNELS * width)
        self._image.data = array.array("B", bytes(height * width * CHANNELS))
        pixels = np.frombuffer(self._image.data, np.uint8)
        self._pixels = pixels.reshape((height, width, CHANNELS))

    def run(self, rate_hz: float, count: int) -> None:
        """Send images without rows until the end of the input, then `count` images."""
        is_asked = threading.Event()

        def listen() -> None:
            sys.stdin.read()
            is_asked.set()

        threading.Thread(target=listen, daemon=True).start()
        while not is_asked.wait(HELLO_PERIOD_S):
            self._publisher.publish(Image())
        start_s = time.monotonic()
        for number in range(count):
            time.sleep(max(start_s + number / rate_hz - time.monotonic(), 0))
            self._shoot(number)

    def _shoot(self, number: int) -> None:
        height, width = self._image.height, self._image.width
        row, column = number % (height // 2), number % (width // 2)
        self._pixels[row : row + height // 4, column : column + width // 4] = 200
        self._image.header.stamp = self.get_clock().now().to_msg()
        self._publisher.publish(self._image)


class Filter(Node):  # type: ignore[misc]
    """Clips pixels that are too bright, in the image that it publishes again."""

    def __init__(self) -> None:
        super().__init__("filter")
        self._publisher = self.create_publisher(Image, FILTERED, DEPTH)
        self._subscription = self.create_subscription(Image, RAW, self._hear, DEPTH)

    def _hear(self, image: Image) -> None:
        pixels = np.frombuffer(image.data, np.uint8)
        np.minimum(pixels, MAX_BRIGHTNESS, out=pixels)
        self._publisher.publish(image)


class Detector(Node):  # type: ignore[misc]
    """Looks for something bright in each image."""

    def __init__(self, topic: str) -> None:
        super().__init__("detector")
        self._subscription = self.create_subscription(Image, topic, self._hear, DEPTH)
        self.ages_ms: list[float] = []
        self.has_come = threading.Event()
        self._ready_s: float | None = None  # CPU time then

    def _hear(self, image: Image) -> None:
        if image.height and np.frombuffer(image.data, np.uint8).max():
            stamp = image.header.stamp
            now_ns = self.get_clock().now().nanoseconds
            self.ages_ms.append((now_ns - stamp.sec * 10**9 - stamp.nanosec) / 1e6)
        self.has_come.set()
        if self._ready_s is None:
            self._ready_s = time.process_time()
            print("ready", flush=True)

    def run(self) -> None:
        """Count the detections, and print them with the CPU time that they took."""
        executor = SingleThreadedExecutor()
        executor.add_node(self)
        spinner = threading.Thread(target=executor.spin)
        spinner.start()
        sys.stdin.read()
        while self.has_come.wait(QUIET_S):
            self.has_come.clear()
        cpu_s = time.process_time() - (self._ready_s or 0)
        executor.shutdown()
        spinner.join()
        ages_ms = self.ages_ms or [float("nan")]
        found = {"detections": len(self.ages_ms), "cpu_s": cpu_s}
        print(json.dumps({**found, "age_ms": statistics.median(ages_ms)}))


def main() -> None:
    """Run one of the nodes."""
    kind, *words = sys.argv[1:]
    rclpy.init()
    if kind == "camera":
        width, height, rate_hz, count = map(int, words)
        camera = Camera(width, height)
        camera.run(rate_hz, count)
        print("ready", flush=True)
        threading.Event().wait()  # stay for retransmissions
    elif kind == "filter":
        rclpy.spin(Filter())
    else:
        Detector(SOURCES[words[0]]).run()


if __name__ == "__main__":
    main()
