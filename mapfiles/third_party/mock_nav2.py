# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Mock of the parts of Nav2 that nav2_simple_commander needs to go to a pose."""

import time
from contextlib import suppress

import rclpy
from geometry_msgs.msg import PoseWithCovarianceStamped
from lifecycle_msgs.msg import State
from lifecycle_msgs.srv import GetState
from nav2_msgs.action import NavigateToPose
from rclpy.action import ActionServer
from rclpy.action.server import ServerGoalHandle
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile

STEPS = 20
STEP_S = 0.1


class MockNav2(Node):
    """An active localizer and navigator; each pose is reached after two seconds."""

    def __init__(self) -> None:
        super().__init__("nav2")
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        pose = self.create_publisher(PoseWithCovarianceStamped, "amcl_pose", latched)
        self.create_subscription(PoseWithCovarianceStamped, "initialpose", pose.publish, 10)
        for name in ("amcl", "bt_navigator"):
            self.create_service(GetState, f"{name}/get_state", self._answer_active)
        self._server = ActionServer(self, NavigateToPose, "navigate_to_pose", self._navigate)

    def _answer_active(
        self, _request: GetState.Request, response: GetState.Response
    ) -> GetState.Response:
        response.current_state = State(id=State.PRIMARY_STATE_ACTIVE, label="active")
        return response

    def _navigate(self, goal: ServerGoalHandle) -> NavigateToPose.Result:
        target = goal.request.pose.pose.position
        self.get_logger().info(f"going to {target.x:.2f}, {target.y:.2f}")
        for step in range(STEPS):
            feedback = NavigateToPose.Feedback()
            feedback.distance_remaining = target.x * (1 - step / STEPS)
            feedback.estimated_time_remaining.sec = round((STEPS - step) * STEP_S)
            goal.publish_feedback(feedback)
            time.sleep(STEP_S)
        goal.succeed()
        return NavigateToPose.Result()


def main() -> None:
    """Spin until interrupted."""
    rclpy.init()
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(MockNav2())


main()
