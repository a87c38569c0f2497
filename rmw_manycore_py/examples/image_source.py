# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Publishes 1 MiB images on `image_raw`, `rate_hz` times a second."""

from contextlib import suppress

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import Image

from rmw_manycore_py.examples.picture import make_image, pixels_of_frame


class ImageSource(Node):
    """A camera whose images encode the frame number."""

    def __init__(self) -> None:
        super().__init__("image_source")
        rate_hz = self.declare_parameter("rate_hz", 10.0).value
        self._number = 0
        self._publisher = self.create_publisher(Image, "image_raw", 10)
        self._timer = self.create_timer(1.0 / rate_hz, self._film)

    def _film(self) -> None:
        self._number += 1
        image = make_image(self._number, pixels_of_frame(self._number))
        image.header.stamp = self.get_clock().now().to_msg()
        self._publisher.publish(image)
        self.get_logger().info(f"sent frame {self._number}")


def main() -> None:
    """Run the node until interrupted."""
    rclpy.init()
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(ImageSource())


if __name__ == "__main__":
    main()
