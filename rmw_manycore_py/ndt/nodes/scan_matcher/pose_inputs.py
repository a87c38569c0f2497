# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Subscriptions of a scan matcher to poses: guesses and, optionally, regularization poses."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from geometry_msgs.msg import PoseWithCovarianceStamped
from rclpy.node import Node

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.messages.conversions import PoseError, matrix_of, seconds
from rmw_manycore_py.ndt.nodes.scan_matcher.diagnostics import Diagnostics
from rmw_manycore_py.ndt.nodes.scan_matcher.guesses import Guesses
from rmw_manycore_py.ndt.nodes.scan_matcher.parameters import MatcherParameters, OwnParameters
from rmw_manycore_py.ndt.nodes.scan_matcher.pose_buffer import PoseBuffer

UNLIMITED = 1000.0  # Autoware's limit for regularization poses, in s and m


class PoseInputs:
    """Subscribes to both, validates them and reports problems.

    :param is_activated: guesses are ignored while it returns False.
    :param guess_arrived: called with each guess T_map_base (4, 4) after it is added to `guesses`.
    """

    def __init__(
        self,
        node: Node,
        parameters: MatcherParameters,
        own: OwnParameters,
        is_activated: Callable[[], bool],
        guess_arrived: Callable[[Matrix], None],
    ) -> None:
        self._p = parameters
        self._is_activated = is_activated
        self._guess_arrived = guess_arrived
        self.guesses = Guesses(
            parameters.initial_pose_timeout_s,
            parameters.initial_pose_distance_m,
            newest_holds=own.behaviour == "autoware",
        )
        self._regularization = PoseBuffer(UNLIMITED, UNLIMITED)
        self._guess_report = Diagnostics(node, "initial_pose_subscriber_status")
        self._regularization_report = Diagnostics(node, "regularization_pose_subscriber_status")
        pose = PoseWithCovarianceStamped
        node.create_subscription(pose, "ekf_pose_with_covariance", self._on_guess, 100)
        if parameters.regularization:
            node.create_subscription(
                pose, "regularization_pose_with_covariance", self._on_regularization, 10
            )

    def regularization_at(
        self, stamp_s: float, guess: Matrix, report: Diagnostics
    ) -> Matrix | None:
        """Return the regularization pose at a scan's time; None if there is none to use."""
        pose = self._regularization.newest_at(stamp_s) if self._p.regularization else None
        if pose is None:
            return None
        distance_m = poses.distance_m(pose.T, guess)
        if distance_m > UNLIMITED:  # it would outweigh the scan
            report.warn(f"the regularization pose is {distance_m:.0f} m from the guess: not used")
            return None
        return pose.T

    def _on_guess(self, message: Any) -> None:
        report = self._guess_report
        report.clear()
        report.value("topic_time_stamp", seconds(message.header.stamp))
        report.value("is_activated", self._is_activated())
        expected = message.header.frame_id == self._p.map_frame
        if not self._is_activated():
            report.note("Node is not activated: call trigger_node_srv")
        else:
            report.value("is_expected_frame_id", expected)
            if not expected:
                report.error(
                    f"the initial pose is in the frame '{message.header.frame_id}', expected "
                    f"'{self._p.map_frame}': check the publisher of ekf_pose_with_covariance"
                )
            elif (T := _usable(message, report)) is not None:
                self.guesses.push(seconds(message.header.stamp), T)
                self._guess_arrived(T)
        report.publish(message.header.stamp)

    def _on_regularization(self, message: Any) -> None:
        report = self._regularization_report
        report.clear()
        report.value("topic_time_stamp", seconds(message.header.stamp))
        if (T := _usable(message, report)) is not None:
            self._regularization.push(seconds(message.header.stamp), T)
        report.publish(message.header.stamp)


def _usable(message: Any, report: Diagnostics) -> Matrix | None:
    try:
        return matrix_of(message.pose.pose)
    except PoseError as error:
        report.error(f"pose ignored: {error}")
        return None
