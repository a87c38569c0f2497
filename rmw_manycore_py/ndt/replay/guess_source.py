# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""How a replay informs the matcher of a scan's pose: by guesses, or by inputs of a filter."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from geometry_msgs.msg import PoseWithCovarianceStamped, TwistWithCovarianceStamped
from rclpy.node import Node

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.messages.conversions import pose_with_covariance, stamp_of
from rmw_manycore_py.ndt.replay.prediction import MEASURED, Prediction

MAP_FRAME = "map"
# Period of initial poses. The initializer matches many guesses for each, which takes ten seconds on
# a busy host; a new one restarts it.
FIRST_POSE_PERIOD_S = 20.0
ROUGH = np.diag([0.25, 0.25, 0.01, 0.0001, 0.0001, 0.1])  # m^2, rad^2
ANYWHERE = np.diag([1e6, 1e6, 0.01, 0.0001, 0.0001, 10.0])  # the stack searches the map
LEAD_IN_S = (0.5, 0.4, 0.3, 0.2, 0.1)  # before the first scan; a matcher looks back 0.4 s
SPEED_VARIANCE, TURN_VARIANCE = 0.04, 0.01  # (m/s)^2, (rad/s)^2


class GuessSource(Protocol):
    """Sends everything except scans."""

    def advertise(self, node: Node) -> None:
        """Create the publishers."""

    def send_first(self, stamp_ns: int) -> None:
        """Send the inputs of the first scan, while waiting for its answer."""

    def lead_in(self, stamp_ns: int) -> None:
        """Send what precedes the first scan, whose stamp this is, on a drive that goes on."""

    def send(self, index: int, time_s: float, stamp_ns: int) -> Matrix | None:
        """Send the inputs of a scan; return the guess if there is one."""

    def result(self, index: int, time_s: float, T_map_sensor: Matrix) -> None:
        """Take the pose found for a scan."""


@dataclass(frozen=True)
class Approach:
    """The drive up to the first scan, with the speed and turn rate that follow it.

    :param T: pose of the first scan.
    :param motion: from the first scan to the second, which takes `period_s`.
    """

    T: Matrix
    motion: Matrix
    period_s: float

    def at(self, before_s: float) -> Matrix:
        """Return the pose at a time before the first scan."""
        T: Matrix = self.T @ poses.part_of_motion(self.motion, -before_s / self.period_s)
        return T


class Guesses:
    """Sends guesses of a prediction, like the EKF of a laptop.

    :param lead_in: None if the motion up to the first scan is unknown.
    """

    def __init__(
        self, first_pose: Matrix, prediction: Prediction, lead_in: Approach | None = None
    ) -> None:
        self._first_pose = first_pose
        self._prediction = prediction
        self._lead_in = lead_in

    def advertise(self, node: Node) -> None:
        """Create the publisher."""
        self._publisher = node.create_publisher(
            PoseWithCovarianceStamped, "ekf_pose_with_covariance", 10
        )

    def send_first(self, stamp_ns: int) -> None:
        """Send the initial pose."""
        self._publish(stamp_ns, self._first_pose)

    def lead_in(self, stamp_ns: int) -> None:
        """Send guesses of a vehicle that drives already, else the first scans are not deskewed."""
        if self._lead_in is None:
            return
        for before_s in LEAD_IN_S:
            self._publish_one(stamp_ns - round(1e9 * before_s), self._lead_in.at(before_s))

    def send(self, index: int, time_s: float, stamp_ns: int) -> Matrix:
        """Send the prediction."""
        guess = self._prediction.guess(index, time_s)
        self._publish(stamp_ns, guess)
        return guess

    def result(self, index: int, time_s: float, T_map_sensor: Matrix) -> None:
        """Pass the result to the prediction."""
        self._prediction.result(index, time_s, T_map_sensor)

    def _publish(self, stamp_ns: int, guess: Matrix) -> None:
        """Publish a guess for the time of the scan, twice, since a matcher interpolates."""
        for time_ns in (stamp_ns - 1_000_000, stamp_ns):
            self._publish_one(time_ns, guess)

    def _publish_one(self, time_ns: int, guess: Matrix) -> None:
        message = pose_with_covariance(guess, MEASURED, stamp_of(time_ns), MAP_FRAME)
        self._publisher.publish(message)


class StackInputs:
    """An initial pose and the speed, for a stack on the platform that makes its own guesses."""

    def __init__(
        self,
        first_pose: Matrix,
        motions: Sequence[Matrix],
        periods_s: Matrix,
        covariance: Matrix = ROUGH,
    ) -> None:
        self._first_pose = first_pose
        self._covariance = covariance
        self._motions = motions
        self._periods_s = periods_s
        self._next_first_s = 0.0

    def advertise(self, node: Node) -> None:
        """Create the publishers."""
        self._initial = node.create_publisher(PoseWithCovarianceStamped, "initialpose", 10)
        self._twist = node.create_publisher(
            TwistWithCovarianceStamped, "in_twist_with_covariance", 10
        )

    def send_first(self, stamp_ns: int) -> None:
        """Send the initial pose periodically, and zero speed."""
        self._publish_twist(stamp_ns, 0.0, 0.0)
        if time.monotonic() >= self._next_first_s and self._initial.get_subscription_count():
            self._next_first_s = time.monotonic() + FIRST_POSE_PERIOD_S
            first, stamp = self._first_pose, stamp_of(stamp_ns)
            message = pose_with_covariance(first, self._covariance, stamp, MAP_FRAME)
            self._initial.publish(message)

    def lead_in(self, stamp_ns: int) -> None:
        """Send nothing: a speed would move the stack's filter away from the first pose."""

    def send(self, index: int, time_s: float, stamp_ns: int) -> None:  # noqa: ARG002
        """Send speed and turn rate from this scan to the next."""
        if not self._motions:
            self._publish_twist(stamp_ns, 0.0, 0.0)
            return
        nearest = min(index, len(self._motions) - 1)
        motion, period_s = self._motions[nearest], float(self._periods_s[nearest])
        v, w = poses.velocities(motion)
        self._publish_twist(stamp_ns, float(v[0]) / period_s, float(w[2]) / period_s)

    def result(self, index: int, time_s: float, T_map_sensor: Matrix) -> None:
        """Ignore the result: the stack has it."""

    def _publish_twist(self, stamp_ns: int, speed_m_s: float, turn_rad_s: float) -> None:
        message = TwistWithCovarianceStamped()
        message.header.stamp = stamp_of(stamp_ns)
        message.header.frame_id = "base_link"
        message.twist.twist.linear.x, message.twist.twist.angular.z = speed_m_s, turn_rad_s
        message.twist.covariance[0], message.twist.covariance[35] = SPEED_VARIANCE, TURN_VARIANCE
        self._twist.publish(message)
