# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A controller whose parameter `gain` can be changed at run time, within 0 to 10."""

from contextlib import suppress

import rclpy
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.parameter import Parameter


class Controller(Node):
    """Logs each change of its gain."""

    def __init__(self) -> None:
        super().__init__("controller")
        allowed = FloatingPointRange(from_value=0.0, to_value=10.0)
        description = ParameterDescriptor(
            description="Proportional gain", floating_point_range=[allowed]
        )
        gain = self.declare_parameter("gain", 1.0, description).value
        self.add_post_set_parameters_callback(self._report)
        self.get_logger().info(f"gain is {gain}")

    def _report(self, parameters: list[Parameter]) -> None:
        for parameter in parameters:
            self.get_logger().info(f"{parameter.name} is now {parameter.value}")


def main() -> None:
    """Run the node until interrupted."""
    rclpy.init()
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(Controller())


if __name__ == "__main__":
    main()
