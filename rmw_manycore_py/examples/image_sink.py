# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Checks every byte of the images on `image_inverted` and counts missing frames."""

from contextlib import suppress

import numpy as np
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import Image

from rmw_manycore_py.examples.picture import pixels_of_frame


class ImageSink(Node):
    """Logs each frame as good or damaged, and the number of frames lost since the first."""

    def __init__(self) -> None:
        super().__init__("image_sink")
        self._last_number: int | None = None
        self._lost = 0
        self._subscription = self.create_subscription(Image, "image_inverted", self._check, 10)

    def _check(self, image: Image) -> None:
        number = int(image.header.frame_id)
        if self._last_number is not None:
            self._lost += number - self._last_number - 1
        self._last_number = number
        pixels = np.frombuffer(image.data, dtype=np.uint8)
        verdict = "good" if np.array_equal(pixels, ~pixels_of_frame(number)) else "damaged"
        self.get_logger().info(f"frame {number} is {verdict}, {self._lost} lost")


def main() -> None:
    """Run the node until interrupted."""
    rclpy.init()
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(ImageSink())


if __name__ == "__main__":
    main()
