# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Wheelchair, operator and observer of a node, and how far they have come."""

from __future__ import annotations

import time

from rclpy.node import Node

from rmw_manycore_py.papers.roslite2.course.directory import Course
from rmw_manycore_py.papers.roslite2.laptop.drive_log import (
    STANDING_M_S,
    Command,
    DriveLog,
    Moment,
)
from rmw_manycore_py.papers.roslite2.laptop.observer import Observer
from rmw_manycore_py.papers.roslite2.laptop.operator import Operator
from rmw_manycore_py.papers.roslite2.laptop.plant import Plant, PlantOptions
from rmw_manycore_py.papers.roslite2.laptop.wheelchair import Look, Wheelchair
from rmw_manycore_py.process.steady import steady_s

ARRIVED_M = 0.5


class Laptop:
    """All of the laptop but the LiDAR.

    :param look: publishes a scan; called with stamp [ns] and plant.
    """

    def __init__(self, node: Node, course: Course, log: DriveLog, look: Look) -> None:
        self._course, self._log, self._look = course, log, look
        first = course.trajectory.pose(0)
        self.plant = Plant(PlantOptions(), first.x_m, first.y_m, first.yaw_rad)
        self._along_m = course.trajectory.along_m()
        self._observer = Observer(node, log)
        self.wheelchair = Wheelchair(node, self.plant, self._scan, self._heard)
        self.operator = Operator(node, self.plant, lambda: self._observer.kinematics_s)
        self._moved_s = steady_s()

    @property
    def is_moving(self) -> bool:
        """Return whether the vehicle moves."""
        return abs(self.plant.speed_m_s) > STANDING_M_S

    @property
    def stood_s(self) -> float:
        """Return the time since it moved, or since the begin."""
        return steady_s() - self._moved_s

    @property
    def left_m(self) -> float:
        """Return the distance to the end of the course."""
        last = self._course.trajectory.pose(len(self._course.trajectory) - 1)
        return float(((self.plant.x_m - last.x_m) ** 2 + (self.plant.y_m - last.y_m) ** 2) ** 0.5)

    def has_arrived(self) -> bool:
        """Return whether it stands at the end of the course; the log has the answer, too."""
        self._log.is_finished = not self.is_moving and self.left_m < ARRIVED_M
        return self._log.is_finished

    def note(self) -> None:
        """Add the current moment to the log."""
        plant, trajectory = self.plant, self._course.trajectory
        nearest = trajectory.nearest(plant.x_m, plant.y_m)
        lateral_m = trajectory.lateral_error_m(plant.x_m, plant.y_m)
        place = (plant.x_m, plant.y_m, plant.speed_m_s, float(self._along_m[nearest]), lateral_m)
        self._log.moments.append(Moment(time.time(), *place))
        if self.is_moving:
            self._moved_s = steady_s()

    def _scan(self, stamp_ns: int, plant: Plant) -> None:
        self._observer.sent(stamp_ns)
        self._look(stamp_ns, plant)

    def _heard(self, command: Command) -> None:
        self._log.commands.append(command)
        self._observer.on_command(command.time_s)
