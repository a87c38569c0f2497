# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Inverts the images of `image_raw` and publishes them on `image_inverted`."""

from contextlib import suppress

import numpy as np
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import Image


class ImageFilter(Node):
    """Publishes the negative of every image."""

    def __init__(self) -> None:
        super().__init__("image_filter")
        self._publisher = self.create_publisher(Image, "image_inverted", 10)
        self._subscription = self.create_subscription(Image, "image_raw", self._invert, 10)

    def _invert(self, image: Image) -> None:
        pixels = np.frombuffer(image.data, dtype=np.uint8)
        np.invert(pixels, out=pixels)
        self._publisher.publish(image)
        self.get_logger().info(f"inverted frame {image.header.frame_id}")


def main() -> None:
    """Run the node until interrupted."""
    rclpy.init()
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(ImageFilter())


if __name__ == "__main__":
    main()
