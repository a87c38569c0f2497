# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Toggles the lamp through the service `switch_lamp`, `rate_hz` times a second."""

from contextlib import suppress

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.task import Future
from std_srvs.srv import SetBool


class LampSwitch(Node):
    """Requests the opposite state after each response."""

    def __init__(self) -> None:
        super().__init__("lamp_switch")
        rate_hz = self.declare_parameter("rate_hz", 2.0).value
        self._wanted = False
        self._client = self.create_client(SetBool, "switch_lamp")
        self._answer: Future | None = None
        self._timer = self.create_timer(1.0 / rate_hz, self._press)

    def _press(self) -> None:
        if self._answer is not None and not self._answer.done():
            return
        if not self._client.service_is_ready():
            self.get_logger().info("waiting for switch_lamp")
            return
        self._wanted = not self._wanted
        self._answer = self._client.call_async(SetBool.Request(data=self._wanted))
        self._answer.add_done_callback(self._report)

    def _report(self, answer: Future) -> None:
        response = answer.result()
        verdict = "changed" if response.success else "unchanged"
        self.get_logger().info(f"answer: {response.message} ({verdict})")


def main() -> None:
    """Run the node until interrupted."""
    rclpy.init()
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(LampSwitch())


if __name__ == "__main__":
    main()
