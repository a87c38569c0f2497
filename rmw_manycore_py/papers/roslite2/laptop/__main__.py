# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`whill_laptop`: the laptop as a node on the platform, for runs in virtual time.

Writes what happened, and ends: at the end of the course, or once the path is lost.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import rclpy
from rclpy.node import Node
from sensor_msgs.msg import PointCloud2

from rmw_manycore_py.ndt.geometry.thinning import voxel_centroids
from rmw_manycore_py.ndt.messages.conversions import stamp_of
from rmw_manycore_py.ndt.messages.point_cloud import encode
from rmw_manycore_py.ndt.nodes.support.declared import declare, parameter
from rmw_manycore_py.ndt.nodes.support.running import run_node
from rmw_manycore_py.papers.roslite2.course.directory import read_course
from rmw_manycore_py.papers.roslite2.laptop import topics
from rmw_manycore_py.papers.roslite2.laptop.drive_log import DriveLog
from rmw_manycore_py.papers.roslite2.laptop.laptop import Laptop
from rmw_manycore_py.papers.roslite2.laptop.lidar_process import VOXEL_M
from rmw_manycore_py.papers.roslite2.laptop.plant import Plant

NOTE_S = 0.1


@dataclass(frozen=True)
class LaptopParameters:
    """Parameters of the node."""

    course: str = parameter("course", ".")
    report: str = parameter("report", "drive.json")
    seed: int = parameter("seed", 1, min_value=0)
    lost_m: float = parameter("lost", 1.0, above=0.0)  # beside the path
    stood_s: float = parameter("stood", 20.0, above=0.0)  # with or without a first motion


class LaptopNode(Node):
    """Drives the course."""

    def __init__(self) -> None:
        super().__init__("whill_laptop")
        self._p = declare(self, LaptopParameters)
        course = read_course(Path(self._p.course))
        self._view = course.view
        self._generator = np.random.default_rng(self._p.seed)
        self._points = self.create_publisher(PointCloud2, topics.POINTS, 5)
        self._log = DriveLog(float(course.trajectory.along_m()[-1]))
        self._laptop = Laptop(self, course, self._log, self._look)
        self.create_timer(NOTE_S, self._note)

    def _look(self, stamp_ns: int, plant: Plant) -> None:
        points = self._view.scan(plant.x_m, plant.y_m, plant.yaw_rad, self._generator)
        thin = voxel_centroids(points, (VOXEL_M,) * 3)
        self._points.publish(encode(thin, stamp_of(stamp_ns), "base_link"))

    def _note(self) -> None:
        self._laptop.note()
        lateral_m = abs(self._log.moments[-1].lateral_m)
        if self._laptop.has_arrived():
            self._end("arrived")
        elif lateral_m > self._p.lost_m:
            self._end(f"the path is lost: {lateral_m:.2f} m beside it")
        elif self._laptop.stood_s > self._p.stood_s:
            self._end(f"the vehicle stands, {self._laptop.left_m:.0f} m before the end")

    def _end(self, how: str) -> None:
        moment = self._log.moments[-1]
        print(
            f"{how}, after {len(self._log.scans)} scans, at {moment.x_m:.6f} {moment.y_m:.6f}",
            flush=True,
        )
        rclpy.shutdown()

    def destroy_node(self) -> None:
        """Write the report first."""
        figures = {**asdict(self._log.summary()), "latencies_ms": self._log.latencies_ms()}
        Path(self._p.report).write_text(json.dumps(figures))
        super().destroy_node()


def main() -> None:
    """Drive until the end, or interrupted."""
    run_node(LaptopNode)


if __name__ == "__main__":
    main()
