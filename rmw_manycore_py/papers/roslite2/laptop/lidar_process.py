# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""LiDAR driver process: reads lines with stamp and pose, publishes scans on DDS."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import IO

import numpy as np

from rmw_manycore_program import own_program
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.process.parent_death import dies_with_this_process

VOXEL_M = 0.4  # downsampling of published scans, as Autoware does before matching
READY = "ready"


class LidarProcess:
    """Starts the driver and triggers scans at given poses."""

    def __init__(self, course: Path, seed: int) -> None:
        self._process = subprocess.Popen(
            own_program(
                "rmw_manycore_py.papers.roslite2.laptop.lidar_process", str(course), str(seed)
            ),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            preexec_fn=dies_with_this_process(),
        )

    @property
    def pid(self) -> int:
        """The process id."""
        return self._process.pid

    def wait_until_ready(self) -> None:
        """Block until the driver can publish."""
        line = _stream(self._process.stdout).readline().strip()
        if line != READY:
            raise ManycoreError("the LiDAR's driver ended before it was ready: see above")

    def look(self, stamp_ns: int, x_m: float, y_m: float, yaw_rad: float) -> None:
        """Trigger a scan at a pose and its publication with a stamp."""
        try:
            stream = _stream(self._process.stdin)
            stream.write(f"{stamp_ns} {x_m:.6f} {y_m:.6f} {yaw_rad:.6f}\n")
            stream.flush()
        except OSError as error:
            raise ManycoreError(f"the LiDAR's driver ended unexpectedly: {error}") from error

    def close(self) -> None:
        """Stop the driver."""
        self._process.kill()
        self._process.communicate()


def _stream(stream: IO[str] | None) -> IO[str]:
    assert stream is not None
    return stream


def main() -> None:
    """Publish a scan for each line of standard input."""
    import signal

    import rclpy
    from sensor_msgs.msg import PointCloud2

    from rmw_manycore_py.ndt.geometry.thinning import voxel_centroids
    from rmw_manycore_py.ndt.messages.conversions import stamp_of
    from rmw_manycore_py.ndt.messages.point_cloud import encode
    from rmw_manycore_py.papers.roslite2.course.directory import read_course
    from rmw_manycore_py.papers.roslite2.laptop.topics import POINTS

    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C: the laptop ends this process
    view = read_course(Path(sys.argv[1])).view
    generator = np.random.default_rng(int(sys.argv[2]))
    rclpy.init()
    node = rclpy.create_node("lidar_driver")
    publisher = node.create_publisher(PointCloud2, POINTS, 5)
    print(READY, flush=True)
    for line in sys.stdin:
        stamp, x_m, y_m, yaw_rad = line.split()
        points = view.scan(float(x_m), float(y_m), float(yaw_rad), generator)
        thin = voxel_centroids(points, (VOXEL_M,) * 3)
        publisher.publish(encode(thin, stamp_of(int(stamp)), "base_link"))
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
