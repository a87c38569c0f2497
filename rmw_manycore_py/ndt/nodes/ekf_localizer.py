# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`ekf_localizer`: the current pose of the vehicle, from delayed poses and its speed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from geometry_msgs.msg import (
    PoseStamped,
    PoseWithCovarianceStamped,
    TwistStamped,
    TwistWithCovarianceStamped,
)
from nav_msgs.msg import Odometry
from rclpy.node import Node
from std_srvs.srv import SetBool
from tf2_msgs.msg import TFMessage

from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.geometry.pose_filter import FilterOptions, PoseFilter, State
from rmw_manycore_py.ndt.messages.conversions import (
    PoseError,
    covariance_of,
    matrix_of,
    pose_stamped,
    pose_with_covariance,
    seconds,
    transform_stamped,
)
from rmw_manycore_py.ndt.nodes.support.clock import clock_s
from rmw_manycore_py.ndt.nodes.support.declared import declare, parameter
from rmw_manycore_py.ndt.nodes.support.log_throttle import ThrottledLog
from rmw_manycore_py.ndt.nodes.support.running import run_node
from rmw_manycore_py.ndt.nodes.support.watched import watched

MIN_VARIANCE = 1e-8  # minimum variance of a measurement; zero would be singular


@dataclass(frozen=True)
class EkfParameters:
    """Parameters with Autoware's names, plus the sideways deviation; frequencies in Hz."""

    frequency_hz: float = parameter("predict_frequency", 50.0, min_value=1.0, max_value=1000.0)
    pose_frame: str = parameter("pose_frame_id", "map")
    child_frame: str = parameter("child_frame_id", "base_link")
    stddev_sideways: float = parameter("proc_stddev_sideways_c", 0.5, min_value=0.0)
    stddev_yaw: float = parameter("proc_stddev_yaw_c", 0.005, min_value=0.0)
    stddev_vx: float = parameter("proc_stddev_vx_c", 10.0, min_value=0.0)
    stddev_wz: float = parameter("proc_stddev_wz_c", 5.0, min_value=0.0)
    publish_tf: bool = parameter("publish_tf", True)
    activated: bool = parameter("activated", True)


class EkfLocalizer(Node):
    """Publishes the predicted current pose at a fixed rate after the initial pose."""

    def __init__(self) -> None:
        super().__init__("ekf_localizer")
        self._p = declare(self, EkfParameters)
        self._is_activated = self._p.activated
        self._complain = ThrottledLog(self.get_logger().warning)
        self._filter = PoseFilter(
            FilterOptions(
                stddev_sideways_c=self._p.stddev_sideways,
                stddev_yaw_c=self._p.stddev_yaw,
                stddev_v_c=self._p.stddev_vx,
                stddev_w_c=self._p.stddev_wz,
            )
        )
        pose = PoseWithCovarianceStamped
        self._odometry = self.create_publisher(Odometry, "ekf_odom", 10)
        self._pose = self.create_publisher(PoseStamped, "ekf_pose", 10)
        self._with_covariance = self.create_publisher(pose, "ekf_pose_with_covariance", 10)
        self._twist = self.create_publisher(TwistStamped, "ekf_twist", 10)
        self._tf = self.create_publisher(TFMessage, "/tf", 100)
        self.create_subscription(
            pose,
            "initialpose",
            self._on_initial_pose,
            10,
            event_callbacks=watched(self, "initialpose"),
        )
        self.create_subscription(
            pose,
            "in_pose_with_covariance",
            self._on_pose,
            10,
            event_callbacks=watched(self, "in_pose_with_covariance"),
        )
        self.create_subscription(
            TwistWithCovarianceStamped,
            "in_twist_with_covariance",
            self._on_twist,
            100,
            event_callbacks=watched(self, "in_twist_with_covariance"),
        )
        self.create_service(SetBool, "trigger_node", self._on_trigger)
        self.create_timer(1.0 / self._p.frequency_hz, self._publish)

    def _on_initial_pose(self, message: Any) -> None:
        measured = self._measured(message)
        if measured is not None:
            self._filter.initialize(clock_s(self), *measured)

    def _on_pose(self, message: Any) -> None:
        measured = self._measured(message)
        if measured is None or not self._is_activated:
            return
        stamp_s = seconds(message.header.stamp)
        if self._is_ahead("pose", stamp_s):
            return
        if not self._filter.is_initialized:
            self._filter.initialize(stamp_s, *measured)
        elif not self._filter.add_pose(stamp_s, *measured):
            self._complain("pose ignored: it is older than the history")

    def _on_twist(self, message: Any) -> None:
        twist = message.twist.twist
        covariance = np.asarray(message.twist.covariance).reshape(6, 6)
        noise = np.diag(np.maximum(np.diag(covariance)[[0, 5]], MIN_VARIANCE))
        v, w = float(twist.linear.x), float(twist.angular.z)
        if not np.isfinite([v, w, *noise.ravel()]).all():
            self._complain("twist ignored: it is not finite")
        elif self._is_activated and self._filter.is_initialized:
            self._add_twist(seconds(message.header.stamp), v, w, noise)

    def _add_twist(self, stamp_s: float, v_m_s: float, w_rad_s: float, noise: Matrix) -> None:
        if self._is_ahead("twist", stamp_s):
            return
        if not self._filter.add_twist(stamp_s, v_m_s, w_rad_s, noise):
            self._complain("twist ignored: it is older than the history")

    def _is_ahead(self, what: str, stamp_s: float) -> bool:
        """Return whether a measurement is too far in the future to be used; warn if so."""
        now_s = clock_s(self)
        self._follow_clock(now_s)
        is_ahead = self._filter.is_ahead(stamp_s, now_s)
        if is_ahead:
            self._complain(
                f"{what} ignored: its stamp is {stamp_s - now_s:.2f} s in the future, check "
                "the clocks"
            )
        return is_ahead

    def _follow_clock(self, now_s: float) -> None:
        if self._filter.follow_clock(now_s):
            self._complain(
                "the clock has jumped back: continuing from the last pose; if the vehicle is "
                "elsewhere now, send a new initialpose"
            )

    def _measured(self, message: Any) -> tuple[Matrix, Matrix] | None:
        """Return pose and covariance of a message; None if it is unusable."""
        covariance = covariance_of(message)
        try:
            if not np.isfinite(covariance).all():
                raise PoseError("the covariance is not finite")
            if message.header.frame_id != self._p.pose_frame:
                raise PoseError(
                    f"the pose is in the frame '{message.header.frame_id}', expected "
                    f"'{self._p.pose_frame}'"
                )
            T = matrix_of(message.pose.pose)
        except PoseError as error:
            self._complain(f"pose ignored: {error}")
            return None
        diagonal = np.maximum(np.diag(covariance), MIN_VARIANCE) - np.diag(covariance)
        return T, covariance + np.diag(diagonal)

    def _on_trigger(self, request: Any, response: Any) -> Any:
        self._is_activated = bool(request.data)
        response.success = True
        return response

    def _publish(self) -> None:
        if not (self._is_activated and self._filter.is_initialized):
            return
        stamp = self.get_clock().now().to_msg()
        self._follow_clock(seconds(stamp))
        state = self._filter.predicted(seconds(stamp))
        T, covariance = state.pose(), state.pose_covariance()
        frame, child = self._p.pose_frame, self._p.child_frame
        full = pose_with_covariance(T, covariance, stamp, frame)
        self._with_covariance.publish(full)
        self._pose.publish(pose_stamped(T, stamp, frame))
        self._publish_motion(state, full)
        if self._p.publish_tf:
            self._tf.publish(TFMessage(transforms=[transform_stamped(T, stamp, frame, child)]))

    def _publish_motion(self, state: State, pose: Any) -> None:
        twist = TwistStamped(header=pose.header)
        twist.header.frame_id = self._p.child_frame
        twist.twist.linear.x, twist.twist.angular.z = (float(value) for value in state.mean[3:])
        self._twist.publish(twist)
        odometry = Odometry(child_frame_id=self._p.child_frame, pose=pose.pose)
        odometry.header.stamp = pose.header.stamp
        odometry.header.frame_id = self._p.pose_frame
        odometry.twist.twist = twist.twist
        odometry.twist.covariance = state.twist_covariance().ravel()
        self._odometry.publish(odometry)


def main() -> None:
    """Run the node until interrupted."""
    run_node(EkfLocalizer)


if __name__ == "__main__":
    main()
