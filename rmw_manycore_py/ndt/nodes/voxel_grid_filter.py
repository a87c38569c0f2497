# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`voxel_grid_filter`: downsamples scans to one point per voxel, like Autoware's filter."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import PointCloud2

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt.geometry.thinning import voxel_centroids
from rmw_manycore_py.ndt.messages.point_cloud import CloudError, decode, encode
from rmw_manycore_py.ndt.messages.point_times import TimesError, decode_timed, time_field
from rmw_manycore_py.ndt.nodes.support.declared import declare, parameter
from rmw_manycore_py.ndt.nodes.support.running import run_node

REPEAT_S = 1.0


@dataclass(frozen=True)
class FilterParameters:
    """Autoware's parameters; metres."""

    x_m: float = parameter("voxel_size_x", 0.3, min_value=0.01, max_value=100.0)
    y_m: float = parameter("voxel_size_y", 0.3, min_value=0.01, max_value=100.0)
    z_m: float = parameter("voxel_size_z", 0.1, min_value=0.01, max_value=100.0)


class VoxelGridFilter(Node):
    """Filters `input` to `output`, keeping stamp and frame.

    If points have times, `output` has the field `time`: seconds after the stamp, float32.
    """

    def __init__(self) -> None:
        super().__init__("voxel_grid_filter")
        p = declare(self, FilterParameters)
        self._voxel_m = (p.x_m, p.y_m, p.z_m)
        sensor = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
        self._output = self.create_publisher(PointCloud2, "output", 5)
        self.create_subscription(PointCloud2, "input", self._on_scan, sensor)

    def _on_scan(self, message: Any) -> None:
        try:
            output = self._thinned(message)
        except (CloudError, ManycoreError) as error:
            self.get_logger().warning(f"scan dropped: {error}", throttle_duration_sec=REPEAT_S)
            return
        self._output.publish(output)

    def _thinned(self, message: Any) -> Any:
        """Return a cloud with the centroids of the voxels, and the mean time of their points.

        Deskewing moves points in proportion to their times, so it moves the centroid like the mean
        of the moved points.
        """
        header, field = message.header, time_field(message)
        points, times_s = (decode(message), None) if field is None else decode_timed(message, field)
        if isinstance(times_s, TimesError):
            self.get_logger().warning(f"left out: {times_s}", throttle_duration_sec=REPEAT_S)
        if times_s is None or isinstance(times_s, TimesError):
            return encode(voxel_centroids(points, self._voxel_m), header.stamp, header.frame_id)
        means = voxel_centroids(np.column_stack((points, times_s)), self._voxel_m)
        thinned = means[:, :3].astype(points.dtype)
        return encode(thinned, header.stamp, header.frame_id, {"time": means[:, 3]})


def main() -> None:
    """Run the node until interrupted."""
    run_node(VoxelGridFilter)


if __name__ == "__main__":
    main()
