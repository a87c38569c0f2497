# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Serves map cells with the services of Autoware's map loader.

A cell is a tile; its id is the path of its file.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from autoware_map_msgs.msg import (
    PointCloudMapCellMetaData,
    PointCloudMapCellMetaDataWithID,
    PointCloudMapCellWithID,
    PointCloudMapMetaData,
)
from autoware_map_msgs.srv import (
    GetDifferentialPointCloudMap,
    GetPartialPointCloudMap,
    GetSelectedPointCloudMap,
)
from builtin_interfaces.msg import Time
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt.maps.map_tiles import Tile, TiledMap
from rmw_manycore_py.ndt.messages.point_cloud import encode


class MapCellServices:
    """Serves the tiles of a map; skips unreadable ones with an error in the log.

    :param partial: also serve all tiles of an area, regardless of those the client has.
    :param selected: also serve tiles by id.
    """

    def __init__(
        self, node: Node, tiles: TiledMap, map_frame: str, partial: bool, selected: bool
    ) -> None:
        self._node = node
        self._tiles = tiles
        self._map_frame = map_frame
        self._by_id = {str(tile.path): tile for tile in tiles.tiles}
        serve = node.create_service
        serve(GetDifferentialPointCloudMap, "service/get_differential_pcd_map", self._differential)
        if partial:
            serve(GetPartialPointCloudMap, "service/get_partial_pcd_map", self._partial)
        if selected:
            serve(GetSelectedPointCloudMap, "service/get_selected_pcd_map", self._selected)
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        topic = "output/pointcloud_map_metadata"
        self._metadata = node.create_publisher(PointCloudMapMetaData, topic, kept)
        self._metadata.publish(self._all_cells())

    def _differential(self, request: Any, response: Any) -> Any:
        """Return the tiles of an area that the client lacks, and the ids it no longer needs."""
        wanted = {str(tile.path): tile for tile in self._around(request.area)}
        held = set(request.cached_ids)
        new = (tile for name, tile in wanted.items() if name not in held)
        response.new_pointcloud_with_ids = list(self._cells(new))
        response.ids_to_remove = [name for name in request.cached_ids if name not in wanted]
        return self._framed(response)

    def _partial(self, request: Any, response: Any) -> Any:
        response.new_pointcloud_with_ids = list(self._cells(self._around(request.area)))
        return self._framed(response)

    def _selected(self, request: Any, response: Any) -> Any:
        tiles = [self._by_id[name] for name in request.cell_ids if name in self._by_id]
        missing = [name for name in request.cell_ids if name not in self._by_id]
        if missing:
            self._node.get_logger().warning(f"no such cell: {', '.join(missing)}")
        response.new_pointcloud_with_ids = list(self._cells(tiles))
        return self._framed(response)

    def _around(self, area: Any) -> list[Tile]:
        x, y, radius_m = area.center_x, area.center_y, area.radius
        return [tile for tile in self._tiles.tiles if tile.is_within(x, y, radius_m)]

    def _cells(self, tiles: Iterable[Tile]) -> Iterator[Any]:
        for tile in tiles:
            try:
                points = self._tiles.tile_points(tile)
            except ManycoreError as error:
                self._node.get_logger().error(str(error), throttle_duration_sec=1.0)
                continue
            yield PointCloudMapCellWithID(
                cell_id=str(tile.path),
                pointcloud=encode(points, Time(), self._map_frame),
                metadata=self._extent(tile),
            )

    def _framed(self, response: Any) -> Any:
        response.header.frame_id = self._map_frame
        return response

    def _all_cells(self) -> Any:
        cells = [
            PointCloudMapCellMetaDataWithID(cell_id=name, metadata=self._extent(tile))
            for name, tile in self._by_id.items()
        ]
        message = PointCloudMapMetaData(metadata_list=cells)
        message.header.stamp = self._node.get_clock().now().to_msg()
        return self._framed(message)

    def _extent(self, tile: Tile) -> Any:
        lower, upper = tile.lower, tile.upper
        if tile.is_everywhere:
            points = self._tiles.tile_points(tile)
            lower, upper = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
        return PointCloudMapCellMetaData(
            min_x=float(lower[0]),
            min_y=float(lower[1]),
            max_x=float(upper[0]),
            max_y=float(upper[1]),
        )
