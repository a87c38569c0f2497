# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`ekf_localizer` uses valid measurements only: no NaN, none of other times or clocks."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from geometry_msgs.msg import PoseWithCovarianceStamped, TwistWithCovarianceStamped
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rosgraph_msgs.msg import Clock

from rmw_manycore_py.ndt.geometry.poses import distance_m, from_xyz_rpy
from rmw_manycore_py.ndt.messages.conversions import matrix_of, pose_with_covariance
from support.nodes.ros import spin_until
from support.nodes.scan_matching import COVARIANCE, command
from support.processes.program import Program

HERE = from_xyz_rpy((3.0, -2.0, 1.0), (0.0, 0.0, 0.5))
THERE = from_xyz_rpy((5.0, -2.0, 1.0), (0.0, 0.0, 0.5))


class Vehicle:
    """The sensors around a filter, on the test's clock."""

    def __init__(self, node: Node) -> None:
        self.node = node
        self.now_s = 1000
        self.heard: list[Any] = []
        pose = PoseWithCovarianceStamped
        self.clock = node.create_publisher(Clock, "/clock", 10)
        self.poses = node.create_publisher(pose, "in_pose_with_covariance", 10)
        self.twists = node.create_publisher(
            TwistWithCovarianceStamped, "in_twist_with_covariance", 10
        )
        node.create_subscription(pose, "ekf_pose_with_covariance", self.heard.append, 10)
        ends = (self.clock, self.poses, self.twists)
        spin_until(node, lambda: all(end.get_subscription_count() for end in ends))

    def tick(self) -> None:
        """Advance the clock by 10 ms."""
        self.now_s = round(self.now_s + 0.01, 2)
        self.clock.publish(Clock(clock=self._stamp()))

    def send(self, T: np.ndarray, ahead_s: float = 0) -> None:
        """Publish a pose measured at a time."""
        self.poses.publish(pose_with_covariance(T, COVARIANCE, self._stamp(ahead_s), "map"))

    def send_twist(self, ahead_s: float) -> None:
        """Publish a twist of zero measured at a time."""
        message = TwistWithCovarianceStamped()
        message.header.stamp = self._stamp(ahead_s)
        message.twist.covariance[0] = message.twist.covariance[35] = 0.01
        self.twists.publish(message)

    def drive_to(self, T: np.ndarray) -> None:
        """Publish a pose with the current stamp until the filter has it."""
        self.heard.clear()
        spin_until(self.node, lambda: self.tick() or self.send(T) or self._is_at(T))

    def _is_at(self, T: np.ndarray) -> bool:
        near = (distance_m(matrix_of(m.pose.pose), T) < 0.1 for m in self.heard[-1:])
        stamps = (abs(m.header.stamp.sec - self.now_s) < 5.0 for m in self.heard[-1:])
        return any(near) and any(stamps)

    def _stamp(self, ahead_s: float = 0) -> Time:
        at_s = round(self.now_s + ahead_s, 2)
        return Time(sec=int(at_s), nanosec=round(at_s % 1 * 1e9))


@pytest.fixture
def ekf(start) -> Program:
    return start(command("ekf_localizer", "predict_frequency:=100.0", "use_sim_time:=true"))


@pytest.fixture
def vehicle(node, ekf) -> Vehicle:
    """Return a vehicle whose filter is initialised."""
    vehicle = Vehicle(node)
    vehicle.drive_to(HERE)
    return vehicle


def test_what_is_not_finite_is_passed_over(vehicle, ekf):
    vehicle.send(from_xyz_rpy((float("nan"), 0.0, 0.0)))
    ekf.wait_for("pose ignored: .*not finite")
    vehicle.heard.clear()
    spin_until(vehicle.node, lambda: vehicle.tick() or len(vehicle.heard) > 50)
    for message in vehicle.heard:
        assert distance_m(matrix_of(message.pose.pose), HERE) < 0.1
        assert np.isfinite(message.pose.covariance).all()


def test_measurements_of_the_future_are_passed_over(vehicle, ekf):
    """A single stamp ahead must not make all later ones too old."""
    vehicle.send(HERE, ahead_s=3600)
    ekf.wait_for(r"pose ignored: its stamp is 3\d{3}\.\d\d s in the future")
    vehicle.send_twist(ahead_s=3600)
    ekf.wait_for(r"twist ignored: its stamp is 3\d{3}\.\d\d s in the future")
    vehicle.drive_to(THERE)


def test_old_measurements_are_passed_over_with_a_warning_of_each_kind(vehicle, ekf):
    vehicle.send(THERE, ahead_s=-100)
    ekf.wait_for("pose ignored: it is older than the history")
    vehicle.send_twist(ahead_s=-100)
    ekf.wait_for("twist ignored: it is older than the history")
    vehicle.drive_to(HERE)


def test_a_clock_that_jumps_back(vehicle, ekf):
    """As when a recording starts again: the filter continues from its pose, and follows."""
    vehicle.now_s = 500
    vehicle.drive_to(THERE)
    ekf.wait_for("the clock has jumped back: continuing from the last pose")
    vehicle.drive_to(HERE)


def test_a_speed_that_is_no_longer_measured_becomes_uncertain(node, vehicle):
    """It tells a follower that the wheels or the IMU have stopped."""
    heard: list[Any] = []
    node.create_subscription(Odometry, "ekf_odom", heard.append, 10)

    def variances() -> tuple[float, float]:
        return tuple(heard[-1].twist.covariance[[0, 35]]) if heard else (np.inf, np.inf)

    def is_sure() -> bool:
        return max(variances()) < 0.1

    # Of the next tick, so that the filter has it when it predicts to that.
    spin_until(node, lambda: vehicle.send_twist(0.01) or vehicle.tick() or is_sure())
    before = variances()
    assert min(before) > 0.0
    spin_until(node, lambda: vehicle.tick() or min(variances()) > 10.0 * max(before))
    off_diagonal = heard[-1].twist.covariance.reshape(6, 6)[1:5, 1:5]
    assert not off_diagonal.any()


def test_a_first_pose_of_the_future_is_none(node, ekf):
    vehicle = Vehicle(node)
    spin_until(
        node,
        lambda: vehicle.tick() or vehicle.send(THERE, ahead_s=3600) or "future" in ekf.output,
    )
    assert not vehicle.heard
    vehicle.drive_to(HERE)
