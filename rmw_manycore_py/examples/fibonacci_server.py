# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Action server `fibonacci`: computes the sequence, one step per `1 / rate_hz` seconds."""

from contextlib import suppress

import rclpy
from rclpy.action import ActionServer, CancelResponse
from rclpy.action.server import ServerGoalHandle
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.task import Future
from test_msgs.action import Fibonacci


class FibonacciServer(Node):
    """Publishes each step as feedback; goals can be cancelled between steps."""

    def __init__(self) -> None:
        super().__init__("fibonacci_server")
        rate_hz = self.declare_parameter("rate_hz", 5.0).value
        self._ticks: list[Future] = []
        self._timer = self.create_timer(1.0 / rate_hz, self._tick)
        self._server = ActionServer(
            self,
            Fibonacci,
            "fibonacci",
            execute_callback=self._compute,
            cancel_callback=lambda _goal: CancelResponse.ACCEPT,
        )

    def _tick(self) -> None:
        waiting, self._ticks = self._ticks, []
        for tick in waiting:
            tick.set_result(None)

    def _next_tick(self) -> Future:
        self._ticks.append(Future())
        return self._ticks[-1]

    async def _compute(self, goal: ServerGoalHandle) -> Fibonacci.Result:
        self.get_logger().info(f"computing {goal.request.order} steps")
        sequence = [0, 1]
        while len(sequence) <= goal.request.order:
            await self._next_tick()
            if goal.is_cancel_requested:
                goal.canceled()
                self.get_logger().info(f"cancelled at {sequence[-1]}")
                return Fibonacci.Result(sequence=sequence)
            sequence.append(sequence[-2] + sequence[-1])
            goal.publish_feedback(Fibonacci.Feedback(sequence=sequence))
        goal.succeed()
        self.get_logger().info(f"finished at {sequence[-1]}")
        return Fibonacci.Result(sequence=sequence)


def main() -> None:
    """Run the node until interrupted."""
    rclpy.init()
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(FibonacciServer())


if __name__ == "__main__":
    main()
