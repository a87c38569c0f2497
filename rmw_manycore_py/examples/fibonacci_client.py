# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Sends goals to the action `fibonacci` in sequence, and cancels every third one."""

from contextlib import suppress

import rclpy
from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.task import Future
from test_msgs.action import Fibonacci


class FibonacciClient(Node):
    """Requests `order` steps and logs feedback and result."""

    def __init__(self) -> None:
        super().__init__("fibonacci_client")
        self._order = self.declare_parameter("order", 5).value
        self._goals = 0
        self._busy = False
        self._client = ActionClient(self, Fibonacci, "fibonacci")
        self._timer = self.create_timer(0.2, self._send_goal)

    def _send_goal(self) -> None:
        if self._busy:
            return
        if not self._client.server_is_ready():
            self.get_logger().info("waiting for fibonacci")
            return
        self._busy = True
        self._goals += 1
        goal = Fibonacci.Goal(order=self._order)
        accepted = self._client.send_goal_async(goal, feedback_callback=self._show_feedback)
        accepted.add_done_callback(self._follow)

    def _show_feedback(self, message: Fibonacci.Impl.FeedbackMessage) -> None:
        self.get_logger().info(f"goal {self._goals} feedback: {list(message.feedback.sequence)}")

    def _follow(self, accepted: Future) -> None:
        goal = accepted.result()
        goal.get_result_async().add_done_callback(self._show_result)
        if self._goals % 3 == 0:
            goal.cancel_goal_async()

    def _show_result(self, finished: Future) -> None:
        answer = finished.result()
        verdict = "succeeded" if answer.status == GoalStatus.STATUS_SUCCEEDED else "cancelled"
        self.get_logger().info(f"goal {self._goals} {verdict}: {list(answer.result.sequence)}")
        self._busy = False


def main() -> None:
    """Run the node until interrupted."""
    rclpy.init()
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(FibonacciClient())


if __name__ == "__main__":
    main()
