# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`vehicle`: a street, a LiDAR at 10 Hz, and wheels that follow `twist_cmd`.

Stands in for the drivers, waypoint_loader and points_map_loader of Autoware.AI, and measures.
"""

from __future__ import annotations

import struct
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from autoware_msgs.msg import Lane, LaneArray, NDTStat
from geometry_msgs.msg import PoseWithCovarianceStamped, TwistStamped
from rclpy.node import Node
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import Header

from rmw_manycore_py.ndt.geometry.thinning import voxel_centroids
from rmw_manycore_py.ndt.messages.conversions import nanoseconds, pose_of, stamp_of
from rmw_manycore_py.ndt.messages.point_cloud import encode
from rmw_manycore_py.ndt.nodes.support.declared import declare, parameter
from rmw_manycore_py.ndt.nodes.support.running import run_node
from rmw_manycore_py.papers.roslite.laws.lanes import Place
from rmw_manycore_py.papers.roslite.messages import LATCHED, waypoint_messages
from rmw_manycore_py.papers.roslite.vehicle.course import LIDAR, Course, sensor_pose
from rmw_manycore_py.papers.roslite.vehicle.drive_log import DriveLog
from rmw_manycore_py.papers.roslite2.laptop.plant import Plant, PlantOptions
from rmw_manycore_py.process.steady import steady_s

STEP_S, SCAN_PERIOD_S = 0.01, 0.1
LAST_ANSWER_NS = 10**9  # after the last scan
LEAF_M, OBSTACLE_LEAF_M = 1.0, 0.4
# Encapsulation of CDR, then the stamp with which a Lane begins.
STAMP_IN_LANE = struct.Struct("<4xiI")


@dataclass(frozen=True)
class VehicleParameters:
    """Parameters of the node."""

    length_m: float = parameter("length", 330.0, above=0.0)
    waypoints: int = parameter("waypoints", 1000, min_value=2)
    scans: int = parameter("scans", 1000, min_value=1)
    drives: bool = parameter("drives", True)
    report: str = parameter("report", "drive.json")


class Vehicle(Node):
    """Counts scans from the first answer on, writes a report about them, and drives on.

    The answer is a command, or without driving an alignment.
    """

    def __init__(self) -> None:
        super().__init__("vehicle")
        self._p = declare(self, VehicleParameters)
        self._course = Course(self._p.length_m, self._p.waypoints)
        self._lane = self._course.lane()
        self._street = self._course.street()
        self._generator = np.random.default_rng(5)
        start = self._course.start()
        self._plant = Plant(PlantOptions(tread_m=1.5), start.x_m, start.y_m, start.yaw_rad)
        self._log = DriveLog()
        self._is_answered = False
        self._is_reported = False
        self._moved_s = steady_s()
        self._advertise()
        self._subscribe()
        self.create_timer(STEP_S, self._step)
        self.create_timer(SCAN_PERIOD_S, self._look)

    def _advertise(self) -> None:
        self._points = self.create_publisher(PointCloud2, "filtered_points", 1)
        self._obstacles = self.create_publisher(PointCloud2, "points_no_ground", 1)
        header = Header(stamp=self.get_clock().now().to_msg(), frame_id="map")
        lane = Lane(header=header, waypoints=waypoint_messages(self._lane, header))
        self._lanes = self.create_publisher(LaneArray, "lane_waypoints_array", LATCHED)
        self._lanes.publish(LaneArray(lanes=[lane]))
        pose = PoseWithCovarianceStamped(header=header)
        pose.pose.pose = pose_of(sensor_pose(self._place))
        self._initial = self.create_publisher(PoseWithCovarianceStamped, "initialpose", LATCHED)
        self._initial.publish(pose)

    def _subscribe(self) -> None:
        self.create_subscription(TwistStamped, "twist_cmd", self._on_command, 10)
        self.create_subscription(NDTStat, "ndt_stat", self._on_alignment, 10)
        self.create_subscription(Lane, "final_waypoints", self._on_plan, 10, raw=True)

    @property
    def _place(self) -> Place:
        return Place(self._plant.x_m, self._plant.y_m, self._plant.yaw_rad)

    def _on_command(self, message: Any) -> None:
        now_ns = time.time_ns()
        self._is_answered = True
        self._log.commanded(nanoseconds(message.header.stamp), now_ns)
        if self._p.drives:
            twist = message.twist
            self._plant.command(steady_s(), twist.linear.x, twist.angular.z)

    def _on_alignment(self, message: Any) -> None:
        self._is_answered |= not self._p.drives
        if nanoseconds(message.header.stamp) in self._log.commands_ns:
            self._log.loops.append((message.exe_time, message.iteration))

    def _on_plan(self, serialized: bytes) -> None:
        seconds, nanosec = STAMP_IN_LANE.unpack_from(serialized)
        self._log.planned(seconds * 10**9 + nanosec, time.time_ns())

    def _step(self) -> None:
        """Advance by the elapsed time, since timers may be late."""
        now_s = steady_s()
        step_s = now_s - self._moved_s
        self._plant.advance(now_s, step_s)
        self._log.driven_m += abs(self._plant.speed_m_s) * step_s
        self._moved_s = now_s

    def _look(self) -> None:
        scan = LIDAR.scan(self._street, sensor_pose(self._place), self._generator)
        stamp_ns = time.time_ns()  # the scan is complete
        if len(self._log.commands_ns) >= self._p.scans:
            self._report_once(stamp_ns)
        elif self._is_answered:
            self._log.sent(stamp_ns)
            self._log.lateral_m.append(self._lateral_m())
        stamp = stamp_of(stamp_ns)
        self._points.publish(encode(voxel_centroids(scan, (LEAF_M,) * 3), stamp, "velodyne"))
        thin = voxel_centroids(scan, (OBSTACLE_LEAF_M,) * 3)
        self._obstacles.publish(encode(thin, stamp, "velodyne"))

    def _report_once(self, now_ns: int) -> None:
        if not self._is_reported and now_ns - max(self._log.commands_ns) > LAST_ANSWER_NS:
            self._is_reported = True
            self._log.figures().write(Path(self._p.report))

    def _lateral_m(self) -> float:
        """Return how far the vehicle is from the nearest waypoint."""
        return float(self._lane.distances_m(self._place).min())


def main() -> None:
    """Drive until interrupted."""
    run_node(Vehicle)


if __name__ == "__main__":
    main()
