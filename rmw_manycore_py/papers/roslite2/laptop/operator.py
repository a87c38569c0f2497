# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Simulated operator at the laptop: engages, sets initial poses, and clears stops."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np
from autoware_vehicle_msgs.msg import Engage
from geometry_msgs.msg import PoseWithCovarianceStamped
from rclpy.node import Node
from std_srvs.srv import Trigger
from tier4_external_api_msgs.msg import Heartbeat

from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy, perturbed
from rmw_manycore_py.ndt.messages.conversions import pose_with_covariance, stamp_of
from rmw_manycore_py.papers.roslite2.laptop import topics
from rmw_manycore_py.papers.roslite2.laptop.drive_log import STANDING_M_S
from rmw_manycore_py.papers.roslite2.laptop.plant import Plant
from rmw_manycore_py.process.steady import steady_s

PERIOD_S = 0.1  # heartbeat period
ENGAGE_S, CLEAR_S = 1.0, 2.0  # retry periods
INITIAL_POSE_S = 30.0  # exceeds a search on a busy host, which a new pose restarts
LOST_S = 2.0  # time without kinematics
STUCK_S = 10.0  # time standing with kinematics, which may be wrong or too uncertain
POINTED_M, POINTED_RAD = 0.3, 0.05  # error of an initial pose set on a map
VARIANCES = (0.25, 0.25, 0.01, 0.01, 0.01, 0.03)


class Operator:
    """Acts ten times a second."""

    def __init__(self, node: Node, plant: Plant, newest_kinematics_s: Callable[[], float | None]):
        self._node = node
        self._plant = plant
        self._newest_kinematics_s = newest_kinematics_s
        self._generator = np.random.default_rng(3)
        self._moved_s = steady_s()  # last motion of the vehicle
        self._done_s: dict[str, float] = {}  # time of each last action
        self._heartbeat = node.create_publisher(Heartbeat, topics.HEARTBEAT, 1)
        self._engage = node.create_publisher(Engage, topics.ENGAGE, 1)
        self._pose = node.create_publisher(PoseWithCovarianceStamped, topics.INITIAL_POSE, 1)
        self._clear = node.create_client(Trigger, topics.CLEAR_STOP)
        node.create_timer(PERIOD_S, self._act)

    @property
    def sees_kinematics(self) -> bool:
        """Return whether the stack publishes kinematics."""
        newest_s = self._newest_kinematics_s()
        return newest_s is not None and time.time() - newest_s < LOST_S

    @property
    def pointed(self) -> bool:
        """Return whether an initial pose was sent."""
        return "pose" in self._done_s

    def _act(self) -> None:
        stamp = stamp_of(time.time_ns())
        self._heartbeat.publish(Heartbeat(stamp=stamp))
        if self._is_due("engage", ENGAGE_S):
            self._engage.publish(Engage(stamp=stamp, engage=True))
        if abs(self._plant.speed_m_s) > STANDING_M_S:
            self._moved_s = steady_s()
            return
        is_stuck = steady_s() - self._moved_s > STUCK_S
        is_wanted = is_stuck or not self.sees_kinematics
        is_heard = self._pose.get_subscription_count() > 0
        if is_wanted and is_heard and self._is_due("pose", INITIAL_POSE_S):
            self._pose.publish(self._pointed(stamp))
        is_served = self.sees_kinematics and self._clear.service_is_ready()
        if is_served and self._is_due("clear", CLEAR_S):
            self._clear.call_async(Trigger.Request())

    def _is_due(self, what: str, period_s: float) -> bool:
        """Return whether an action may be repeated; if so, count it as done."""
        now_s = steady_s()
        is_due = now_s - self._done_s.get(what, -np.inf) >= period_s
        if is_due:
            self._done_s[what] = now_s
        return bool(is_due)

    def _pointed(self, stamp: Any) -> Any:
        plant = self._plant
        pose = from_xyz_rpy((plant.x_m, plant.y_m, 0.0), (0.0, 0.0, plant.yaw_rad))
        pointed = perturbed(pose, POINTED_M, 0.0, self._generator)
        pointed[2, 3] = 0.0
        pointed = pointed @ from_xyz_rpy((0.0, 0.0, 0.0), (0.0, 0.0, POINTED_RAD))
        return pose_with_covariance(pointed, np.diag(VARIANCES), stamp, "map")
