# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Changes the `gain` of the node `controller` through its parameter services."""

from contextlib import suppress

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.parameter_client import AsyncParameterClient
from rclpy.task import Future

GAINS = (2.5, 5.0, 7.5, 99.0)  # the controller rejects the last one, which is out of range


class Tuner(Node):
    """Sets one gain after the other, `rate_hz` times a second."""

    def __init__(self) -> None:
        super().__init__("tuner")
        rate_hz = self.declare_parameter("rate_hz", 2.0).value
        self._attempts = 0
        self._client = AsyncParameterClient(self, "controller")
        self._answer: Future | None = None
        self._timer = self.create_timer(1.0 / rate_hz, self._tune)

    def _tune(self) -> None:
        if self._answer is not None and not self._answer.done():
            return
        if not self._client.services_are_ready():
            self.get_logger().info("waiting for controller")
            return
        gain = GAINS[self._attempts % len(GAINS)]
        self._attempts += 1
        self._answer = self._client.set_parameters([Parameter("gain", value=gain)])
        self._answer.add_done_callback(lambda answer: self._report(gain, answer))

    def _report(self, gain: float, answer: Future) -> None:
        verdict = "accepted" if answer.result().results[0].successful else "refused"
        self.get_logger().info(f"gain {gain} was {verdict}")


def main() -> None:
    """Run the node until interrupted."""
    rclpy.init()
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(Tuner())


if __name__ == "__main__":
    main()
