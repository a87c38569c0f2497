# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`pose_initializer`: refines a rough pose by matching, and activates the stack at it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from autoware_internal_localization_msgs.srv import PoseWithCovarianceStamped as AlignService
from geometry_msgs.msg import PoseWithCovarianceStamped
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.task import Future
from std_msgs.msg import String
from std_srvs.srv import SetBool

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.ndt.geometry.poses import from_quaternion
from rmw_manycore_py.ndt.messages.conversions import (
    PoseError,
    matrix_of,
    pose_with_covariance,
    seconds,
)
from rmw_manycore_py.ndt.nodes.support.declared import declare, parameter
from rmw_manycore_py.ndt.nodes.support.running import run_node
from rmw_manycore_py.process.steady import steady_s

VARIANCES = (1.0, 1.0, 0.01, 0.01, 0.01, 0.2)  # m^2, rad^2
AT_ORIGIN = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)  # x, y, z, quaternion
GNSS_VARIANCES = (*VARIANCES[:5], 10.0)  # GNSS does not measure the heading
ANYWHERE_M = 1e6  # standard deviation without a pose; maps in UTM or MGRS are far from 0
RETRY_S = 1.0
ANSWER_TIMEOUT_S = 60.0  # 200 alignments of 300 ms: slow host, large scans
UNINITIALIZED, INITIALIZING, INITIALIZED = "UNINITIALIZED", "INITIALIZING", "INITIALIZED"


def _diagonal(variances: Sequence[float]) -> tuple[float, ...]:
    """Return a covariance (36) of x, y, z, roll, pitch, yaw, row by row."""
    return tuple(np.diag(variances).ravel().tolist())


@dataclass(frozen=True)
class InitializerParameters:
    """Autoware's parameters, and `search_map`."""

    user_defined: bool = parameter("user_defined_initial_pose.enable", False)
    pose: tuple[float, ...] = parameter("user_defined_initial_pose.pose", AT_ORIGIN, length=7)
    ekf_enabled: bool = parameter("ekf_enabled", True)
    ndt_enabled: bool = parameter("ndt_enabled", True)
    gnss_enabled: bool = parameter("gnss_enabled", False)
    gnss_timeout_s: float = parameter("gnss_pose_timeout", 3.0, above=0.0)
    gnss_covariance: tuple[float, ...] = parameter(
        "gnss_particle_covariance", _diagonal(GNSS_VARIANCES), length=36
    )
    covariance: tuple[float, ...] = parameter(
        "output_pose_covariance", _diagonal(VARIANCES), length=36
    )
    map_frame: str = parameter("map_frame", "map")
    searches_map: bool = parameter("search_map", False)


class PoseInitializer(Node):
    """Waits for `initialpose` (as sent by RViz), or starts at the pose of its parameters or GNSS.

    With `search_map` the matcher searches its map, from the pose of the parameters on.

    Deactivates matcher and filter, has the pose matched by `ndt_align`, publishes it on
    `initialpose3d`, and reactivates both. Failures are retried once a second with the newest pose.
    GNSS is used until another pose arrives or one was matched.
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
        self._tried: Any = None  # the pose being matched
        self._call: Future | None = None  # pending call of ndt_align
        self._called_s = 0.0
        self._heeds_gnss = self._p.gnss_enabled and not self._p.user_defined
        self.create_subscription(
            PoseWithCovarianceStamped, "initialpose", self._on_initial_pose, 10
        )
        if self._heeds_gnss:
            self.create_subscription(
                PoseWithCovarianceStamped, "gnss_pose_cov", self._on_gnss_pose, 1
            )
        self.create_timer(RETRY_S, self._try)
        self._publish_state(UNINITIALIZED)
        if self._p.user_defined or self._p.searches_map:
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
        if self._p.searches_map:
            covariance[:2, :2] = np.diag([ANYWHERE_M**2] * 2)
        return pose_with_covariance(
            T, covariance, self.get_clock().now().to_msg(), self._p.map_frame
        )

    def _on_initial_pose(self, message: Any) -> None:
        if not any(message.pose.covariance):
            message.pose.covariance = np.asarray(self._p.covariance, np.float64)
        if self._want("initialpose", message):
            self._heeds_gnss = False
            self._publish_state(INITIALIZING)
            self._try()

    def _on_gnss_pose(self, message: Any) -> None:
        """Keep the newest pose until one is matched; the timer starts the next attempt."""
        if not self._heeds_gnss or self._tried is not None:
            return
        age_s = seconds(self.get_clock().now().to_msg()) - seconds(message.header.stamp)
        if age_s > self._p.gnss_timeout_s:
            self.get_logger().warning(
                f"gnss_pose_cov: the pose is {age_s:.1f} s old, ignored",
                throttle_duration_sec=RETRY_S,
            )
            return
        message.pose.covariance = np.asarray(self._p.gnss_covariance, np.float64)
        is_first = self._wanted is None
        if self._want("gnss_pose_cov", message) and is_first:
            self._publish_state(INITIALIZING)

    def _want(self, topic: str, message: Any) -> bool:
        """Store a pose for the next attempt, if valid."""
        try:
            matrix_of(message.pose.pose)
        except PoseError as error:
            self.get_logger().error(f"{topic}: {error}", throttle_duration_sec=RETRY_S)
            return False
        self._wanted = message
        return True

    def _try(self) -> None:
        """Start an attempt if there is a pose and all services are available."""
        self._forget_unanswered_call()
        if self._wanted is None or self._tried is not None:
            return
        needed = [*self._triggers, *([self._align] if self._p.ndt_enabled else [])]
        missing = [client.srv_name for client in needed if not client.service_is_ready()]
        if missing:
            self.get_logger().info(f"waiting for {', '.join(missing)}", throttle_duration_sec=5.0)
            return
        self._tried = self._wanted
        for client in self._triggers:
            client.call_async(SetBool.Request(data=False))
        if not self._p.ndt_enabled:
            self._finish(self._wanted)
            return
        request = AlignService.Request(pose_with_covariance=self._wanted)
        self._called_s = steady_s()
        self._call = self._align.call_async(request)
        self._call.add_done_callback(self._on_aligned)

    def _forget_unanswered_call(self) -> None:
        """Allow a new attempt: a killed or restarted matcher does not answer."""
        is_late = steady_s() - self._called_s > ANSWER_TIMEOUT_S
        if self._call is None or (self._align.service_is_ready() and not is_late):
            return
        self._align.remove_pending_request(self._call)
        self._call = self._tried = None
        self.get_logger().warning(
            "ndt_align does not answer, trying again: is the matcher running?"
        )

    def _on_aligned(self, future: Future) -> None:
        self._call = None
        response = future.result()
        if response is None or not response.success:
            self._tried = None
            self.get_logger().warning(
                "the pose could not be matched, trying again: see /diagnostics"
            )
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
        self._heeds_gnss = False
        is_newest = self._wanted is self._tried
        self._tried = None
        if is_newest:
            self._wanted = None
            self._publish_state(INITIALIZED)

    def _publish_state(self, state: str) -> None:
        self._state.publish(String(data=state))
        self.get_logger().info(state)


def main() -> None:
    """Run the node until interrupted."""
    run_node(PoseInitializer)


if __name__ == "__main__":
    main()
