# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`simple_trajectory_follower`: commands steering and speed along a trajectory."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from autoware_control_msgs.msg import Control
from autoware_planning_msgs.msg import Trajectory as TrajectoryMessage
from builtin_interfaces.msg import Time
from nav_msgs.msg import Odometry
from rclpy.node import Node

from rmw_manycore_py.ndt.messages.conversions import seconds
from rmw_manycore_py.ndt.nodes.support.clock import clock_s
from rmw_manycore_py.ndt.nodes.support.declared import declare, parameter
from rmw_manycore_py.ndt.nodes.support.log_throttle import ThrottledLog
from rmw_manycore_py.ndt.nodes.support.running import run_node
from rmw_manycore_py.ndt.nodes.support.watched import watched
from rmw_manycore_py.papers.roslite2.laws.following import (
    acceleration_m_s2,
    lateral_deviation_m,
    steering_rad,
    yaw_deviation_rad,
)
from rmw_manycore_py.papers.roslite2.laws.odometry import is_stale
from rmw_manycore_py.papers.roslite2.laws.trajectory import Trajectory
from rmw_manycore_py.papers.roslite2.messages import planar_pose, trajectory_of

PERIOD_S = 0.03


@dataclass(frozen=True)
class FollowerParameters:
    """Autoware's parameters first; then conditions for stopping, which Autoware's node lacks."""

    use_external_speed: bool = parameter("use_external_target_vel", False)
    external_speed_m_s: float = parameter("external_target_vel", 0.0, min_value=0.0)
    lateral_m: float = parameter("lateral_deviation", 0.0)

    timeout_s: float = parameter("kinematics_timeout", 0.3, above=0.0)
    max_distance_m: float = parameter("max_distance", 3.0, above=0.0)
    max_stddev_m: float = parameter("max_position_stddev", 0.8, above=0.0)
    max_stddev_m_s: float = parameter("max_speed_stddev", 1.0, above=0.0)
    doubt_s: float = parameter("max_speed_stddev_time", 0.5, min_value=0.0)


class SimpleTrajectoryFollower(Node):
    """Publishes a command every 30 ms once it has `input/kinematics` and `input/trajectory`."""

    def __init__(self) -> None:
        super().__init__("simple_trajectory_follower")
        self._p = declare(self, FollowerParameters)
        self._complain = ThrottledLog(self.get_logger().warning)
        self._odometry: Any = None
        self._trajectory: Trajectory | None = None
        self._message: Any = None  # message of the current trajectory
        self._sure_s = 0.0  # when the speed was last certain enough
        self._output = self.create_publisher(Control, "output/control_cmd", 1)
        self.create_subscription(
            Odometry,
            "input/kinematics",
            self._on_kinematics,
            1,
            event_callbacks=watched(self, "input/kinematics"),
        )
        self.create_subscription(
            TrajectoryMessage,
            "input/trajectory",
            self._on_trajectory,
            1,
            event_callbacks=watched(self, "input/trajectory"),
        )
        self.create_timer(PERIOD_S, self._command)

    def _on_kinematics(self, message: Any) -> None:
        self._odometry = message

    def _on_trajectory(self, message: Any) -> None:
        if self._message is not None and _is_same(message, self._message):
            return
        if not message.points:
            self._complain("input/trajectory ignored: expected points, found none")
            return
        self._message, self._trajectory = message, trajectory_of(message)

    def _command(self) -> None:
        if self._odometry is None or self._trajectory is None:
            missing = "input/kinematics" if self._odometry is None else "input/trajectory"
            self._complain(f"waiting for {missing}: no command is published")
            return
        reason = self._reason_to_stand(self._trajectory)
        if reason:
            self._complain(f"{reason}: commanding standstill")
        self._publish(self._trajectory, must_stand=bool(reason))

    def _reason_to_stand(self, trajectory: Trajectory) -> str:
        """Return why the pose cannot be used for driving; "" if it can."""
        stamp_s, now_s = seconds(self._odometry.header.stamp), clock_s(self)
        if is_stale(stamp_s, now_s, self._p.timeout_s):
            return (
                f"input/kinematics is {now_s - stamp_s:.2f} s old, expected at most "
                f"{self._p.timeout_s:g} s (is ekf_localizer running? has a clock jumped?)"
            )
        place = self._odometry.pose.pose.position
        distance_m = trajectory.distance_m(place.x, place.y)
        if not distance_m <= self._p.max_distance_m:
            return (
                f"the trajectory is {distance_m:.1f} m away, expected at most "
                f"{self._p.max_distance_m:g} m"
            )
        return self._reason_to_doubt()

    def _reason_to_doubt(self) -> str:
        """Return why the estimate is too uncertain for driving; "" if it is not."""
        of_pose, of_twist = self._odometry.pose.covariance, self._odometry.twist.covariance
        stddev_m = math.sqrt(max(of_pose[0], of_pose[7], 0.0))
        if not stddev_m <= self._p.max_stddev_m:
            return (
                f"the standard deviation of the position is {stddev_m:.2f} m, expected at most "
                f"{self._p.max_stddev_m:g} m (are scans coming, and poses?)"
            )
        stddev_m_s = math.sqrt(max(of_twist[0], 0.0))
        now_s = clock_s(self)
        if stddev_m_s <= self._p.max_stddev_m_s:
            self._sure_s = now_s
        if not abs(now_s - self._sure_s) <= self._p.doubt_s:
            return (
                f"the standard deviation of the speed is {stddev_m_s:.2f} m/s, expected at most "
                f"{self._p.max_stddev_m_s:g} m/s (are wheels and IMU reporting?)"
            )
        return ""

    def _publish(self, trajectory: Trajectory, must_stand: bool) -> None:
        pose, speed_m_s = planar_pose(self._odometry.pose.pose), self._odometry.twist.twist.linear.x
        nearest = trajectory.nearest(pose.x_m, pose.y_m)
        base = trajectory.pose(nearest)
        wanted_m_s = trajectory.speed(nearest)
        if self._p.use_external_speed:
            wanted_m_s = self._p.external_speed_m_s
        command = Control(stamp=self.get_clock().now().to_msg())
        command.lateral.stamp = command.longitudinal.stamp = command.stamp
        target_m_s = 0.0 if must_stand else wanted_m_s
        command.longitudinal.velocity = target_m_s
        command.longitudinal.acceleration = acceleration_m_s2(speed_m_s, target_m_s)
        if not must_stand:
            lateral_m = lateral_deviation_m(base, pose.x_m, pose.y_m) - self._p.lateral_m
            yaw_rad = yaw_deviation_rad(base, pose.yaw_rad)
            command.lateral.steering_tire_angle = steering_rad(lateral_m, yaw_rad, speed_m_s)
        self._output.publish(command)


def _is_same(message: Any, before: Any) -> bool:
    """Return whether two messages hold the same trajectory; equal stamps skip the comparison."""
    has_stamp = message.header.stamp != Time()
    return bool((has_stamp and message.header == before.header) or message.points == before.points)


def main() -> None:
    """Run the node until interrupted."""
    run_node(SimpleTrajectoryFollower)


if __name__ == "__main__":
    main()
