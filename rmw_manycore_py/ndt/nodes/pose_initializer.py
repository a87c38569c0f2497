# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`pose_initializer`: from a rough pose to a matched one, and everything activated at it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from geometry_msgs.msg import PoseWithCovarianceStamped
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.task import Future
from std_msgs.msg import String
from std_srvs.srv import SetBool
from tier4_localization_msgs.srv import PoseWithCovarianceStamped as AlignService

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.ndt.nodes.conversions import PoseError, matrix_of, pose_with_covariance
from rmw_manycore_py.ndt.nodes.declared import declare, parameter
from rmw_manycore_py.ndt.nodes.running import run_node
from rmw_manycore_py.ndt.poses import from_quaternion

VARIANCES = (1.0, 1.0, 0.01, 0.01, 0.01, 0.2)  # m^2, rad^2
AT_ORIGIN = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)  # x, y, z, quaternion
DIAGONAL = tuple(VARIANCES[i] if i == j else 0.0 for i in range(6) for j in range(6))
RETRY_S = 1.0
UNINITIALIZED, INITIALIZING, INITIALIZED = "UNINITIALIZED", "INITIALIZING", "INITIALIZED"


@dataclass(frozen=True)
class InitializerParameters:
    """Autoware's."""

    user_defined: bool = parameter("user_defined_initial_pose.enable", False)
    pose: tuple[float, ...] = parameter("user_defined_initial_pose.pose", AT_ORIGIN, length=7)
    ekf_enabled: bool = parameter("ekf_enabled", True)
    ndt_enabled: bool = parameter("ndt_enabled", True)
    covariance: tuple[float, ...] = parameter("output_pose_covariance", DIAGONAL, length=36)
    map_frame: str = parameter("map_frame", "map")


class PoseInitializer(Node):
    """Waits for `initialpose` (as RViz sends it) or starts at the pose of its parameters.

    Stops matcher and filter, has the pose matched by `ndt_align`, publishes it on `initialpose3d`,
    starts both again. What fails is tried again with the same pose, once a second.
    """

    def __init__(self) -> None:
        super().__init__("pose_initializer")
        self._p = declare(self, InitializerParameters)
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._state = self.create_publisher(String, "initialization_state", kept)
        self._output = self.create_publisher(PoseWithCovarianceStamped, "initialpose3d", kept)
        self._align = self.create_client(AlignService, "ndt_align")
        self._triggers = [
            self.create_client(SetBool, name)
            for name, enabled in (
                ("ekf_trigger_node", self._p.ekf_enabled),
                ("ndt_trigger_node", self._p.ndt_enabled),
            )
            if enabled
        ]
        self._wanted: Any = None
        self._is_busy = False
        self.create_subscription(
            PoseWithCovarianceStamped, "initialpose", self._on_initial_pose, 10
        )
        self.create_timer(RETRY_S, self._try)
        self._publish_state(UNINITIALIZED)
        if self._p.user_defined:
            self._on_initial_pose(self._user_defined())

    def _user_defined(self) -> Any:
        quaternion = np.asarray(self._p.pose[3:], np.float64)
        if np.linalg.norm(quaternion) < 1e-3:
            raise ManycoreError(
                "parameter user_defined_initial_pose.pose: expected x, y, z and a quaternion",
                EXIT_BAD_INPUT,
            )
        T = np.eye(4)
        T[:3, 3] = self._p.pose[:3]
        T[:3, :3] = from_quaternion(quaternion)
        covariance = np.asarray(self._p.covariance, np.float64).reshape(6, 6)
        return pose_with_covariance(
            T, covariance, self.get_clock().now().to_msg(), self._p.map_frame
        )

    def _on_initial_pose(self, message: Any) -> None:
        try:
            matrix_of(message.pose.pose)
        except PoseError as error:
            self.get_logger().error(f"initialpose: {error}")
            return
        if not any(message.pose.covariance):
            message.pose.covariance = np.asarray(self._p.covariance, np.float64)
        self._wanted = message
        self._publish_state(INITIALIZING)
        self._try()

    def _try(self) -> None:
        """Start over with the wanted pose, if there is one and all services are there."""
        if self._wanted is None or self._is_busy:
            return
        needed = [*self._triggers, *([self._align] if self._p.ndt_enabled else [])]
        missing = [client.srv_name for client in needed if not client.service_is_ready()]
        if missing:
            self.get_logger().info(f"waiting for {', '.join(missing)}", throttle_duration_sec=5.0)
            return
        self._is_busy = True
        for client in self._triggers:
            client.call_async(SetBool.Request(data=False))
        if not self._p.ndt_enabled:
            self._finish(self._wanted)
            return
        request = AlignService.Request(pose_with_covariance=self._wanted)
        self._align.call_async(request).add_done_callback(self._on_aligned)

    def _on_aligned(self, future: Future) -> None:
        response = future.result()
        if response is None or not response.success:
            self._is_busy = False
            self.get_logger().warning("the pose could not be matched: see /diagnostics; next try")
            return
        if not response.reliable:
            self.get_logger().warning("the matched pose has a low score")
        pose = response.pose_with_covariance
        pose.pose.covariance = np.asarray(self._p.covariance, np.float64)
        self._finish(pose)

    def _finish(self, pose: Any) -> None:
        pose.header.stamp = self.get_clock().now().to_msg()
        self._output.publish(pose)
        for client in self._triggers:
            client.call_async(SetBool.Request(data=True))
        self._wanted = None
        self._is_busy = False
        self._publish_state(INITIALIZED)

    def _publish_state(self, state: str) -> None:
        self._state.publish(String(data=state))
        self.get_logger().info(state)


def main() -> None:
    """Run the node until it is interrupted."""
    run_node(PoseInitializer)


if __name__ == "__main__":
    main()
