# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`pointcloud_map_loader`: publishes a map from files, and serves its cells on request.

It publishes the whole map or the area around the vehicle, and offers the services of Autoware's map
loader.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from builtin_interfaces.msg import Time
from geometry_msgs.msg import PoseWithCovarianceStamped
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import PointCloud2

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.geometry.precision import why_coarse
from rmw_manycore_py.ndt.geometry.thinning import voxel_centroids
from rmw_manycore_py.ndt.maps.map_area import MapArea
from rmw_manycore_py.ndt.maps.map_tiles import TiledMap, open_map
from rmw_manycore_py.ndt.messages.conversions import PoseError, matrix_of
from rmw_manycore_py.ndt.messages.point_cloud import encode
from rmw_manycore_py.ndt.nodes.map_cell_services import MapCellServices
from rmw_manycore_py.ndt.nodes.support.declared import declare, parameter
from rmw_manycore_py.ndt.nodes.support.running import run_node

DOWNSAMPLED_TOPIC = "output/debug/downsampled_pointcloud_map"


@dataclass(frozen=True)
class LoaderParameters:
    """Autoware's parameters where they exist; metres."""

    whole: bool = parameter("enable_whole_load", True)
    partial: bool = parameter("enable_partial_load", True)
    selected: bool = parameter("enable_selected_load", False)
    paths: tuple[str, ...] = parameter("pcd_paths_or_directory", (), texts=True)
    metadata: str = parameter("pcd_metadata_path", "")
    downsampled: bool = parameter("enable_downsampled_whole_load", False)
    downsampled_leaf_m: float = parameter("leaf_size", 3.0, above=0.0)
    leaf_m: float = parameter("map_leaf_size", 0.0, min_value=0.0)
    map_topic: str = parameter("map_topic", "pointcloud_map")
    map_frame: str = parameter("map_frame", "map")
    radius_m: float = parameter("map_radius", 150.0, above=0.0)
    update_distance_m: float = parameter("update_distance", 20.0, above=0.0)


class PointcloudMapLoader(Node):
    """Publishes `pointcloud_map` (transient local), and serves its cells."""

    def __init__(self) -> None:
        super().__init__("pointcloud_map_loader")
        self._p = declare(self, LoaderParameters)
        if len(self._p.paths) != 1:
            raise ManycoreError(
                "parameter pcd_paths_or_directory: expected a map file or a folder of tiles, found "
                f"{', '.join(self._p.paths) or 'none'}",
                EXIT_BAD_INPUT,
            )
        # Autoware's launch files name a metadata file even if there is none.
        metadata = Path(self._p.metadata).expanduser() if self._p.metadata else None
        tiles = open_map(
            Path(self._p.paths[0]).expanduser(),
            self._p.leaf_m,
            metadata if metadata is not None and metadata.is_file() else None,
        )
        MapCellServices(self, tiles, self._p.map_frame, self._p.partial, self._p.selected)
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._publisher = self.create_publisher(PointCloud2, self._p.map_topic, kept)
        self._area = MapArea(tiles, self._p.radius_m, self._p.update_distance_m)
        if self._p.downsampled:
            points = voxel_centroids(_whole(tiles), (self._p.downsampled_leaf_m,) * 3)
            self._downsampled = self.create_publisher(PointCloud2, DOWNSAMPLED_TOPIC, kept)
            self._downsampled.publish(encode(points, Time(), self._p.map_frame))
        if self._p.whole:
            self._publish(_whole(tiles))
        else:
            self.create_subscription(
                PoseWithCovarianceStamped, "ekf_pose_with_covariance", self._on_pose, 1
            )

    def _on_pose(self, message: Any) -> None:
        try:
            T = matrix_of(message.pose.pose)
            points = self._area.update(float(T[0, 3]), float(T[1, 3]))
        except (PoseError, ManycoreError) as error:
            self.get_logger().error(str(error), throttle_duration_sec=1.0)
            return
        if points is not None:
            self._publish(points)
            self._area.accept(self._area.asked)

    def _publish(self, points: Points) -> None:
        if warning := why_coarse(points):
            self.get_logger().warning(f"the map is coarse: {warning}")
        self.get_logger().info(f"publishing a map of {len(points)} points")
        self._publisher.publish(encode(points, Time(), self._p.map_frame))


def _whole(tiles: TiledMap) -> Points:
    return tiles.around(0.0, 0.0, float("inf"))[1]


def main() -> None:
    """Run the node until interrupted."""
    run_node(PointcloudMapLoader)


if __name__ == "__main__":
    main()
