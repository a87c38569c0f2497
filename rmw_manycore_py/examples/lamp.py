# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A lamp with the service `switch_lamp`."""

from contextlib import suppress

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_srvs.srv import SetBool


class Lamp(Node):
    """Service server that stores whether the lamp is on."""

    def __init__(self) -> None:
        super().__init__("lamp")
        self._is_on = False
        self._service = self.create_service(SetBool, "switch_lamp", self._switch)

    def _switch(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        response.success = self._is_on != request.data
        self._is_on = request.data
        response.message = f"the lamp is {'on' if self._is_on else 'off'}"
        self.get_logger().info(response.message)
        return response


def main() -> None:
    """Run the node until interrupted."""
    rclpy.init()
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(Lamp())


if __name__ == "__main__":
    main()
